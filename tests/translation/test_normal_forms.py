"""Normal forms against plain numbers: an expression and its normal form have one value."""

import ast
import math
from fractions import Fraction
from types import SimpleNamespace
from unittest.mock import patch

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from piezo_sym.translation import field as translation_field
from piezo_sym.translation.change import put, spelled
from piezo_sym.translation.expressions import PLAIN, Expressions
from piezo_sym.translation.field import GeneratorField, NotShownError, Value
from piezo_sym.translation.numerator import vanishes, vanishes_with
from piezo_sym.translation.signs import assume as known_positive
from piezo_sym.translation.witness import UNDECIDED, WitnessPoint
from piezo_sym.translation.zero import is_zero

SMOOTH = ("exp", "log", "sqrt", "sin", "cos", "tanh", "expm1", "atan", "sinh", "cosh", "erf")
CALLS = (*SMOOTH, "abs", "sign")
TWO = ("minimum", "maximum")
NAMES = {"a": 2, "b": 1, "x": 0, "y": 0}
LEAVES = st.sampled_from([*NAMES, "2", "3", "0.5", "1"])


def _grown(inner):
    pairs = st.tuples(st.sampled_from("+-*/"), inner, inner)
    return st.one_of(
        pairs.map(lambda p: f"({p[1]} {p[0]} {p[2]})"),
        st.tuples(st.sampled_from(CALLS), inner).map(lambda p: f"{p[0]}({p[1]})"),
        st.tuples(st.sampled_from(TWO), inner, inner).map(lambda p: f"{p[0]}({p[1]}, {p[2]})"),
        st.tuples(inner, st.sampled_from(["2", "3", "(-1)", "(1/2)", "(3/2)"])).map("**".join),
        st.tuples(*[inner] * 4).map(lambda p: f"where({p[1]} > {p[2]}, {p[0]}, {p[3]})"),
    )


TEXTS = st.recursive(LEAVES, _grown, max_leaves=7)
FUNCTIONS = {name: getattr(math, name) for name in SMOOTH}
FUNCTIONS |= {"abs": abs, "minimum": min, "maximum": max}
FUNCTIONS["sign"] = lambda z: float((z > 0) - (z < 0))


def reader():
    field = GeneratorField()
    names = {name: field.name(name, sign=sign) for name, sign in NAMES.items()}
    calls = {name: name for name in (*CALLS, *TWO)} | {"where": "choice"}
    leaf = lambda node: (names[node.id], PLAIN)  # noqa: E731
    return field, Expressions(field, {}, leaf, calls, False)


def number(node, at):
    """Return the value of an expression at a point, by Python's own numbers."""
    match node:
        case ast.Constant(value):
            return float(value)
        case ast.Name(name):
            return float(at[name])
        case ast.UnaryOp(ast.USub(), arg):
            return -number(arg, at)
        case ast.BinOp(left, operator, right):
            a, b = number(left, at), number(right, at)
            symbol = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/"}.get(type(operator))
            return (
                {"+": a + b, "-": a - b, "*": a * b}[symbol]
                if symbol in {"+", "-", "*"}
                else (a / b if symbol else math.pow(a, b))
            )
        case ast.Call(ast.Name("where"), [ast.Compare(left, _, [right]), then, other]):
            return number(then if number(left, at) > number(right, at) else other, at)
        case ast.Call(ast.Name(name), args):
            return float(FUNCTIONS[name](*(number(arg, at) for arg in args)))
    raise TypeError(node)


@given(TEXTS, st.tuples(*[st.fractions(-4, 4, max_denominator=7)] * 4))
def test_a_normal_form_has_the_value_of_its_text(text, point):
    at = dict(zip(NAMES, point, strict=True)) | {"a": abs(point[0]) + 1, "b": abs(point[1])}
    node = ast.parse(text, mode="eval").body
    try:
        wanted = number(node, at)
    except (ArithmeticError, ValueError):
        assume(False)
    assume(abs(wanted) < 1e9)
    field, read = reader()
    try:
        numbers = {name: (Fraction(value),) for name, value in at.items()}
        found = WitnessPoint(SimpleNamespace(field=field), numbers).value(read(node)[0], {})
    except (*UNDECIDED, NotShownError):  # such as a power whose exponent is a root
        assume(False)
    assert float(found) == pytest.approx(wanted, rel=1e-6, abs=1e-6)


@pytest.mark.parametrize("text", ["(b + 2*x*b + a*(1 + 2*x))", "(a - 2*a*x + b*y - 2*b*x*y)"])
@pytest.mark.parametrize("point", [(2, 3, 5, 7), (1, 2, -3, 4)])
def test_factors_of_a_sum_lose_no_number(text, point):
    """The last term of a product need not be the product of last terms: 1/(f g) had lost a 2."""
    at = dict(zip(NAMES, map(Fraction, point), strict=True))
    field, read = reader()
    numbers = {name: (value,) for name, value in at.items()}
    for whole in (f"1/{text}", f"where({text} > 0, 1.0, 2.0)"):
        node = ast.parse(whole, mode="eval").body
        found = WitnessPoint(SimpleNamespace(field=field), numbers).value(read(node)[0], {})
        assert float(found) == pytest.approx(number(node, at))


#: Values without signs, for which a numerator can be taken.
RATIOS = st.recursive(
    LEAVES,
    lambda inner: st.one_of(
        st.tuples(st.sampled_from("+-*/"), inner, inner).map(lambda p: f"({p[1]} {p[0]} {p[2]})"),
        st.tuples(st.sampled_from(["exp", "sqrt"]), inner).map(lambda p: f"{p[0]}({p[1]})"),
        st.tuples(inner, st.sampled_from(["(-2)", "(1/3)", "(-3/2)"])).map("**".join),
    ),
    max_leaves=8,
)


def cleared(value):
    """Return a value times its denominators that are sums, multiplied one after the other."""
    gens = value.field.gens
    while True:
        below = ((g, e) for mono in value.terms for g, e in mono if gens[g].kind == "power")
        g, e = min(below, key=lambda factor: factor[1], default=(0, 0))
        if e >= 0:
            return value
        value = value * Value(value.field, {((g, math.ceil(-e)),): 1})


@given(RATIOS, RATIOS, st.sampled_from(["{0}", "1/(1/({0}) + 1/({1})) - ({0})*({1})/({0} + {1})"]))
def test_a_numerator_has_no_terms_where_the_product_with_all_denominators_has_none(one, other, law):
    _, read = reader()
    try:
        value = spelled(read.numeric(ast.parse(law.format(one, other), mode="eval").body)[0])
        expected = not cleared(value).terms
    except NotShownError:
        assume(False)
    assert vanishes(value) == expected


@pytest.mark.parametrize("abbreviated", [False, True])
@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("(x - y)*exp(x)/(x*y + 1)", True),
        ("(x - y)*sqrt(x + y)/a", True),
        ("x**3 - y**3", True),
        ("(x - y)*exp(x)/(x - y)", False),
        ("(x - y)/(x**2 - y**2)", False),
        ("(x - y)/(1 - sqrt(1 + x - y))", False),
        ("(x - y)*(a*(x - y) + 1/b)/(x - y)**2", False),
    ],
)
def test_what_vanishes_with_a_difference_is_not_divided_by_it(text, shown, abbreviated):
    field, read = reader()
    value, other = (read.numeric(ast.parse(t, mode="eval").body)[0] for t in (text, "x - y"))
    value = field.generator("letter", value) if abbreviated else value
    assert vanishes_with(value, other) == shown


def test_a_power_of_what_a_name_stands_for_is_worked_out_once():
    """In a Jacobian the same power is a factor of hundreds of terms."""
    field = GeneratorField()
    a, *names = (field.name(f"n{n}") for n in range(13))
    power, long = field.whole_power(a, 3), field.total(names)
    value, (g,) = field.total(name * power for name in names), a.parts
    field.work = 0
    found = put(value, {g: long})
    one = field.whole_power(long, 3)
    assert found == field.total(name * one for name in names)
    assert field.work < 4 * len(names) * len(one.terms)


def test_questions_of_zero_end_however_many_cases_a_row_has():
    """Work on numerators counts like that on values: a row with many cases is too large."""
    field, read = reader()
    value = read(ast.parse("sqrt(a + x)*(1 + x*y)**3/(a + b)", mode="eval").body)[0]
    limit = patch.object(translation_field, "MOST_WORK", field.work + 1_000)
    with limit, pytest.raises(NotShownError, match="too large"):
        assert not any(vanishes(value) for _ in range(1_000))


LARGEST = "maximum(x, -x)"


@pytest.mark.parametrize(
    ("text", "same"),
    [
        (f"{LARGEST} + log(0.5 + 0.5*exp(-2*{LARGEST}))", True),
        ("x + log(0.5 + 0.5*exp(-2*x))", True),
        ("log(0.5*exp(2*x) + 0.5) - x", True),
        ("log((1 + exp(2*x))/2) - x", True),
        (f"{LARGEST} + log(0.5 + 0.5*exp(2*{LARGEST}))", False),
        (f"{LARGEST} + log(0.5 + 0.5*exp(-{LARGEST}))", False),
        (f"{LARGEST} + log(0.5 + 0.4*exp(-2*{LARGEST}))", False),
        (f"{LARGEST} + log(1 + exp(-2*{LARGEST}))", False),
        (f"{LARGEST} + log(0.5 - 0.5*exp(-2*{LARGEST}))", False),
        ("minimum(x, -x) + log(0.5 + 0.5*exp(-2*maximum(x, -x)))", False),
        ("x + log(0.5 + 0.5*exp(-2*y))", False),
        ("x + log(0.5 + 0.5*exp(-2*x)*exp(y))", False),
    ],
)
def test_the_energy_of_a_tanh_without_overflow_is_the_logarithm_of_cosh(text, same):
    _, read = reader()
    value, other = (read.numeric(ast.parse(t, mode="eval").body)[0] for t in (text, "log(cosh(x))"))
    assert is_zero(value - other) == same
    if "0.5 - 0.5" in text:  # no value at some points
        return
    trees = [ast.parse(t, mode="eval").body for t in (text, "log(cosh(x))")]
    sides = [[number(t, {"x": x, "y": 1.0}) for x in (-2.0, -0.3, 0.4, 3.0)] for t in trees]
    assert (sides[0] == pytest.approx(sides[1], rel=1e-12)) == same


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        ("log(a/(a - x))", "log(a) - log(a - x)", True),
        ("log((x - a)/(y - a))", "log(a - x) - log(a - y)", True),
        ("log(1 - x/a)", "log(2*a - 2*x) - log(2*a)", True),
        ("log(x/(x - 2*a))", "log(x) - log(x - 2*a)", False),  # at 0 < x < a neither has a value
        ("log(x/(x - 2*a))", "log(x) - log(2*a - x)", False),
        ("log(x/y)", "log(x) - log(y)", False),
        ("log(x**2)", "2*log(x)", False),
        ("log((x - a)*x)", "log(x - a) + log(x)", False),
        ("log(a/(a - x))", "log(a) + log(a - x)", False),
        ("log((x - a)**3*y)", "3*log(a - x) + log(y)", False),
    ],
)
def test_a_logarithm_is_split_only_where_the_domain_gives_each_factor_a_sign(one, other, same):
    _, read = reader()
    for margin in ("a - x", "a - y"):
        known_positive(read(ast.parse(margin, mode="eval").body)[0], 2)
    value, split = (read.numeric(ast.parse(text, mode="eval").body)[0] for text in (one, other))
    assert is_zero(value - split) == same
