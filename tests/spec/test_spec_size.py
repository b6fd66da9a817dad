"""Laws that grow: refused by what would explode, just above each limit and not below it."""

import pytest
from spec_tools import refused_law

from piezo_sym.expressions.parse import parse_law

TERMS = "has too many terms when it is multiplied out; expected at most 512"
KINKS = "nests functions with kinks too deeply; expected at most 18 branches"
NESTED = "nests functions too deeply; expected at most 8 in each other"
NUMBERS = "has numbers that multiply to too large or too long ones"
CONSTANT = "nests functions of numbers too deeply"
LIMITS = {
    "factors": ("*".join(["(x+y)"] * 9), "*".join(["(x+y)"] * 10), TERMS),
    "a power": ("(x+y+z)**16", "(x+y+z+w)**16", TERMS),
    "a negative power": ("1/(x+y+z)**(-16)", "(x+y+z+w)**(-16)", TERMS),
    "a root of a power": ("((x+y)**15)**0.5", "((x+y+z+w)**15)**0.5", TERMS),
    "inside a function": ("tanh((x+y)**16)", "tanh((x+y+z+w)**16)", TERMS),
    "quotients": ("/".join(["(x+y)"] * 9), "/".join(["(x+y)"] * 10), TERMS),
    "the log of a product": ("log(2*3*x)**16", "log(2*3*5*7*x)**16", TERMS),
    "one kink": ("abs(abs(abs(abs(x))))", "abs(abs(abs(abs(abs(x)))))", KINKS),
    "a kink of a sum": ("abs(sign(x)+sign(y))", "abs(sign(x)+sign(y)+sign(z))", KINKS),
    "a choice by kinks": (
        "x if sign(x) + sign(y) < 1 else y",
        "x if sign(x) + sign(y) + sign(z) < 1 else y",
        KINKS,
    ),
    "a kink of choices": (
        "abs(" + "+".join(["(x if x<y else z)"] * 3) + ")",
        "abs(" + "+".join(["(x if x<y else z)"] * 4) + ")",
        KINKS,
    ),
    "functions": ("tanh(" * 8 + "x" + ")" * 8, "tanh(" * 9 + "x" + ")" * 9, NESTED),
    "functions of numbers": (
        "x*" + "sqrt(2+" * 4 + "1" + ")" * 4,
        "x*" + "sqrt(2+" * 5 + "1" + ")" * 5,
        CONSTANT,
    ),
    "a product of numbers": ("x*1e150*1e150", "x*1e150*1e151", NUMBERS),
    "a quotient of numbers": ("x/1e150/1e150", "x*1e-150/1e151", NUMBERS),
    "a power of a number": ("(1e18*x)**16", "(1e19*x)**16", NUMBERS),
    "digits": (
        f"(x + 0.{'3' * 38})**16",
        f"(x*0.{'7' * 38} + 0.{'3' * 38})**16",
        NUMBERS,
    ),
}


@pytest.mark.parametrize(("good", "bad", "said"), LIMITS.values(), ids=LIMITS)
def test_a_limit_lets_pass_what_is_below_and_names_itself_above(good, bad, said):
    parse_law(good, "law")
    message = refused_law(bad)
    assert said in message
    assert "expected " in message
