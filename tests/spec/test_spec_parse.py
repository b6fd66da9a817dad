"""Texts that are no laws: refused in one line, quickly, and never run."""

import pytest
from spec_tools import refusal, refused_edit, refused_law

from piezo_sym.expressions.parse import parse_condition, parse_law
from piezo_sym.expressions.text import spell

HOSTILE = {
    "__import__('os').system('id')": "has ''' at column 12",
    "T.__class__": "has '.' at column 2",
    "9**9**9": "too large a power",
    "1e999999999": "at most 40 digits and 1e+-300",
    "lambda: 1": "has ':' at column 7",
    "[x for x in range(3)]": "has '[' at column 1",
    "exp(x for x in y)": "not of the law language",
    "i if i else 0": "chooses by no comparison",
    "i<1<2": "is a comparison",
    "1 if i<1<2 else 0": "chains comparisons",
    "T:=3": "has ':' at column 2",
    "exp(": "not a complete law",
    "exp(1,2)": "gives exp 2 arguments; expected 1",
    "exp()": "gives exp 0 arguments; expected 1",
    "min(v)": "gives min 1 arguments; expected 2",
    "i**T": "a power that is not a number",
    "(i+1)**1000000": "too large a power",
    "i**17": "too large a power",
    "i**(1/17)": "too large a power",
    "i**(1/0)": "too large a power",
    "1" * 5000: "is 5000 characters long",
    "1" * 41: "at most 40 digits",
    "(" * 5000 + "i" + ")" * 5000: "characters long",
    "(" * 41 + "i" + ")" * 41: "nested too deeply",
    "-" * 3000 + "i": "characters long",
    "-" * 9 + "i": "nested too deeply",
    "- " * 9 + "i": "nested too deeply",
    "(" * 41: "nested too deeply",
    "*".join(["i"] * 60): "nested too deeply",
    "+".join(["i"] * 501): "is 1001 characters long",
    "sqrt(-1)": "without a finite real value",
    "1/0": "divides by '0'",
    "v/0": "divides by '0'",
    "v/(1 - 1)": "divides by '1 - 1'",
    "0**(-1)": "without a finite real value",
    "v + log(0)": "constant part 'log(0)'",
    "(-8)**(1/3)": "without a finite real value",
    "\uff34": "U+FF34",
    "i\u200b": "U+200B",
    "\u03bb*v": "U+03BB",
    "i\x00": "U+0000",
    "i\n": "U+000A",
    "i\tv": "U+0009",
    "i # note": "has '#' at column 3",
    "i;v": "has ';' at column 2",
    "1_000": "runs into '_'",
    "0x10": "runs into 'x'",
    "1j": "runs into 'j'",
    "1e": "runs into 'e'",
    "0.5v": "runs into 'v'",
    "1e-301": "1e+-300",
    "0.0001e-300": "1e+-300",
    "007": "not a complete law",
    "True": "'True' where a number should be",
    "None": "'None' where a number should be",
    "'i'": "has ''' at column 1",
    '"i"': "has '\"' at column 1",
    "i@T": "has '@' at column 2",
    "i//2": "operator that laws do not have",
    "i%2": "has '%' at column 2",
    "i[0]": "has '[' at column 2",
    "i^2": "has '^' at column 2",
    "~i": "has '~' at column 1",
    "i and T": "not of the law language",
    "not i": "not of the law language",
    "i < T": "is a comparison",
    "1 + (i < T)": "uses a comparison as a number",
    "1 if i in T else 0": "compares in a way that laws do not have",
    "1 if i is T else 0": "compares in a way that laws do not have",
    "1 if i == 0 else 0": "has '=' at column 8",
    "factorial(10000)": "calls 'factorial'",
    "print(1)": "calls 'print'",
    "exit()": "calls 'exit'",
    "exp(exp(exp(exp(1000))))": "constant part 'exp(1000)'",
    "exp(*i)": "not of the law language",
    "exp(**i)": "not of the law language",
    "(i)(2)": "calls 'i'",
    "exp(1)(2)": "not of the law language",
    "i, T": "not of the law language",
    "()": "not of the law language",
    "await i": "not of the law language",
    "yield": "has a keyword of Python, 'yield'",
    "i T": "not a complete law",
    "i +": "not a complete law",
    "*i": "not",
    "((1+i)**16)**16": "too high a degree",
    "(((1+i)**16)**16)**16": "too high a degree",
    "exp(((1+i)**16)**3)": "too high a degree",
    "": "is empty",
    "   ": "is empty",
}


@pytest.mark.parametrize(("text", "reason"), HOSTILE.items(), ids=lambda value: ascii(value)[:30])
def test_refused(text, reason):
    assert reason in refused_law(text)


KEYWORDS = ["lambda", "in", "is", "as", "def", "global", "with", "from", "class", "del"]


@pytest.mark.parametrize("word", KEYWORDS)
def test_a_keyword_is_no_name(word):
    message = refused_law(f"{word}*v")
    assert f"has a keyword of Python, '{word}'; call it '{word}_0'" in message


UNFINISHED = {
    "R_e*(1 + al*(T - T_0)*i": "close the bracket that opens at column 5",
    "exp(v": "close the bracket that opens at column 4",
    "d*v)": "the ')' at column 4 closes no bracket",
    "d*v if v > 0": "an 'else' is missing, as in 'd*v if v > 0 else 0'",
    "0,4*v": "has a decimal comma; write 0.4, with a point",
    "(d + 0,25)*v": "write 0.25, with a point",
    "max(v, 0,5)": "write 0.5, with a point",
}


@pytest.mark.parametrize(("text", "remedy"), UNFINISHED.items())
def test_what_is_missing_in_a_law_is_said(text, remedy):
    assert remedy in refused_law(text)


def test_a_decimal_comma_in_a_condition_is_told_to_be_a_point():
    error = refusal(parse_condition, "v > 0,4*v", "domain.assume[0]")
    assert "write 0.4, with a point" in str(error)


def test_a_power_of_another_language_is_told_how_it_is_written_here():
    assert "write ** for a power" in refused_law("R*i + R_3*i^3")


@pytest.mark.parametrize("text", [text for text in HOSTILE if text.isprintable()])
def test_refused_inside_a_law(text):
    refused_law(f"d*v + ({text})*2")


@pytest.mark.parametrize("text", ["expp(i)", "Exp(i)", "dead_zone(i, 1)", "ln(i)", "arctan(i)"])
def test_an_unknown_function_is_answered_with_known_ones(text):
    offers = ("did you mean 'exp'", "deadzone", "did you mean 'log'", "did you mean 'atan'")
    assert any(offer in refused_law(text) for offer in offers)


@pytest.mark.parametrize(
    ("law", "answer"),
    [
        ("__import__('os').system('id')", "column"),
        ("d*w", "unknown name 'w'; "),
        ("dd*v", "did you mean 'd'?"),
        ("d*i", "'i' has no meaning here; expected the letters v, T"),
        ("d*phi", "'phi' has no meaning here"),
        ("d*V_in", "'V_in' is an input, and this law sees none"),
        ("d*__debug__", "unknown name '__debug__'"),
        ("i@v", "has '@'"),
    ],
)
def test_refused_in_a_spec_with_its_place(law, answer):
    message = refused_edit(('"d*v"', f'"{law}"'))
    assert message.startswith("spec: elements.damper.force: ")
    assert answer in message


def test_nothing_in_a_law_is_run(tmp_path, capsys):
    mark = tmp_path / "mark"
    for text in (
        f"__import__('pathlib').Path('{mark}').touch()",
        f"open('{mark}', 'w')",
        "print(1)",
        "exit()",
        "exp(print(1))",
    ):
        refused_law(text)
    assert not mark.exists()
    assert capsys.readouterr() == ("", "")


@pytest.mark.parametrize(
    "text",
    [
        "T",
        "T > 1 > 0",
        "T == 1",
        "T != 1",
        "d*v",
        "T > 1 and T < 2",
        "(T > 1) > 0",
        "T >",
        "",
        "T > 1/0",
        "T > v/0",
        "sqrt(-1) > T",
        "(((1 + T)**16)**16) > 0",
    ],
)
def test_refused_conditions(text):
    error = refusal(parse_condition, text, "domain.assume[0]")
    assert str(error).startswith("domain.assume[0]: ")


def test_a_condition_is_read():
    condition = parse_condition("T >= T_0 + 1", "domain.assume[0]")
    assert (condition.op, spell(condition.left), spell(condition.right)) == (">=", "T", "T_0 + 1")


def test_parameters_in_an_exponent_are_exp_and_log():
    written = parse_law("(1 + A*q/V)**(-R/c)", "law")
    assert written == parse_law("exp(-R/c*log(1 + A*q/V))", "law")
