"""Facts on functions hold at every real number; laws as quotients are the laws themselves."""

import random
import re
from fractions import Fraction
from operator import eq, ge, gt, le, lt, ne

import mpmath
import pytest
from hypothesis import given
from hypothesis import strategies as st

from piezo_sym.expressions.functions import FUNCTIONS as FUNCTIONS_OF
from piezo_sym.expressions.parse import parse_law
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import ONE, Cmp, Div, Expr, Mul, Num, Pow, Sym, names, walk
from piezo_sym.proofs.rational import (
    Part,
    Ratio,
    cleared,
    facts_on,
    facts_on_two,
    parts_of,
    ratio,
    signed,
)
from tests.spec.spec_laws import laws, steady

POINTS = 3000
COMPARED = {"<": lt, ">": gt, "<=": le, ">=": ge, "=": eq, "!=": ne}
X = Sym("x")
SMOOTH = [name for name, record in FUNCTIONS_OF.items() if record.transcendental]
ROOTS = [Fraction(n, d) for n, d in ((1, 2), (1, 3), (2, 3), (3, 2), (-1, 2), (-2, 3), (5, 4))]
PARTS = [Part("y", f, X, Ratio(X)) for f in SMOOTH]
PARTS += [Part("y", "root", X, Ratio(X), e) for e in ROOTS]


def points(part):
    """Return arguments of every size, near zero and near the ends of what is known."""
    draw = random.Random(f"{part.function} {part.exponent}")
    found = [mpmath.mpf(n) / 2 for n in range(-12, 13)]
    found += [at + s * mpmath.mpf(10) ** -e for at in (-3, -1, 0, 1, 3) for s in (1, -1)
              for e in range(1, 20, 3)]  # fmt: skip
    while len(found) < POINTS:
        size = mpmath.mpf(10) ** draw.uniform(-12, 3)
        found.append(draw.choice([-1, 1]) * size * (1 + mpmath.mpf(draw.random())))
    lowest = {"log": 0, "root": 0}.get(part.function)
    within = [x for x in found if lowest is None or x > lowest]
    zero = part.function == "root" and part.exponent > 0
    return [*within, mpmath.mpf(0)] if zero else within


def facts_of(part):
    return facts_on(part.function, part.exponent, part.argument, Sym(part.name))


def value_of(part, x):
    if part.function == "root":
        e = part.exponent
        return x ** (mpmath.mpf(e.numerator) / e.denominator)
    return getattr(mpmath, part.function)(x)


def exact(tree):
    """Return a polynomial's text with its numbers as quotients of mpmath's."""
    match tree:
        case Num(value):
            return f"(mpf({value.numerator})/mpf({value.denominator}))"
        case Sym(name):
            return name
        case Mul(left, right):
            return f"({exact(left)}*{exact(right)})"
        case Pow(base, exponent):
            return f"({exact(base)}**{exponent.numerator})"
    if type(tree).__name__ == "Neg":
        return f"(-{exact(tree.arg)})"
    return "(" + "+".join(exact(term) for term in tree.terms) + ")"


@pytest.mark.some(2)
@pytest.mark.parametrize("part", PARTS, ids=lambda p: f"{p.function} {p.exponent}")
def test_each_fact_holds_at_every_point(part):
    with mpmath.workdps(50):
        for n, clause in enumerate(facts_of(part)):
            sides = [(c.op, exact(c.left), exact(c.right)) for c in clause]
            made = [(op, compiled(left), compiled(right)) for op, left, right in sides]
            for x in points(part):
                y = value_of(part, x)
                assert any(near(op, left(x, y), right(x, y)) for op, left, right in made), (n, x)


@pytest.mark.some(4)
@pytest.mark.parametrize("part", PARTS, ids=lambda p: f"{p.function} {p.exponent}")
def test_what_relates_two_values_holds_at_all_pairs(part):
    two = (X, Sym("y")), (Sym("a"), Sym("b"))
    clauses = list(facts_on_two(part.function, part.exponent, *two))
    assert bool(clauses) == (part.exponent > 0)
    draw, found = random.Random(1), points(part)
    with mpmath.workdps(50):
        pairs = [(draw.choice(found), draw.choice(found)) for _ in range(POINTS)]
        for x, a in [*pairs, *((x, x) for x in found[:50])]:
            named = {"x": x, "a": a, "y": value_of(part, x), "b": value_of(part, a)}
            for clause in clauses:
                assert any(
                    COMPARED[c.op](
                        *(named.get(getattr(s, "name", ""), 0) for s in (c.left, c.right))
                    )
                    for c in clause
                ), (x, a)


def compiled(text):
    return eval(f"lambda x, y: {text}", {"mpf": mpmath.mpf})


def near(op, left, right):
    """Return whether a comparison holds, but for the last digits."""
    slack = mpmath.mpf(10) ** -35 * (abs(left) + abs(right) + mpmath.mpf(10) ** -60)
    if op == "=":
        return abs(left - right) <= slack
    if op in ("<", ">"):  # what is strict up to the last digit that is carried
        return left - right < slack if op == "<" else right - left < slack
    return left - right <= slack if op == "<=" else right - left <= slack


@pytest.mark.some(3)
@pytest.mark.parametrize("part", PARTS, ids=lambda p: f"{p.function} {p.exponent}")
def test_the_facts_say_something(part):
    """A wrong value of y, by a tenth, breaks a clause somewhere."""
    with mpmath.workdps(50):
        made = [
            [(c.op, compiled(exact(c.left)), compiled(exact(c.right))) for c in clause]
            for clause in facts_of(part)
        ]
        for factor in (mpmath.mpf("0.9"), mpmath.mpf("1.1")):
            assert any(
                not any(near(op, left(x, y), right(x, y)) for op, left, right in clause)
                for x in points(part)[:400]
                for y in [value_of(part, x) * factor]
                for clause in made
            ), factor


def fraction(tree, values):
    """Return the exact value of a tree's text, by Python."""
    text = spell(tree).replace(" ", "")
    return eval(_wrapped(text), {"F": Fraction}, dict(values))


def _wrapped(text):
    exponents = re.sub(r"\*\*\((-?\d+)\)", r"**\1", text)
    return re.sub(
        r"(?<![A-Za-z_0-9.])(?<!\*\*)(?<!\*\*-)(\d+\.?\d*(?:e[+-]?\d+)?)", r"F('\1')", exponents
    )


def is_rational(tree):
    kinds = (Num, Sym, Mul, Div, Pow)
    whole = all(not isinstance(n, Pow) or n.exponent.denominator == 1 for n in walk(tree))
    named = {type(n).__name__ for n in walk(tree)} <= {k.__name__ for k in kinds} | {"Neg", "Add"}
    return whole and named


RATIONAL = laws(kinks=False, exponents=(2, 3, -1, -2)).filter(is_rational)
NUMBERS = st.builds(Fraction, st.integers(-20, 20), st.integers(1, 9))
VALUES = st.fixed_dictionaries({name: NUMBERS for name in ("x", "y", "w")})


def polynomial(tree):
    return not any(
        isinstance(n, Div) or (isinstance(n, Pow) and n.exponent < 0) for n in walk(tree)
    )


@steady
@given(RATIONAL, VALUES)
def test_a_quotient_has_the_value_of_the_law(tree, values):
    made = ratio(tree)
    assert polynomial(made.top)
    assert polynomial(made.bottom)
    try:
        wanted = fraction(tree, values)
    except ZeroDivisionError:
        return
    top, bottom = fraction(made.top, values), fraction(made.bottom, values)
    assert bottom != 0
    assert top / bottom == wanted
    sign = fraction(signed(made), values)
    assert (sign > 0) - (sign < 0) == (wanted > 0) - (wanted < 0)


@pytest.mark.long
@steady
@given(RATIONAL, RATIONAL, st.sampled_from(sorted(COMPARED)), VALUES)
def test_a_cleared_comparison_holds_where_the_comparison_does(left, right, op, values):
    made = cleared(Cmp(op, left, right))
    try:
        difference = fraction(left, values) - fraction(right, values)
    except ZeroDivisionError:
        return
    after = fraction(made.left, values) - fraction(made.right, values)
    assert COMPARED[op](after, 0) == COMPARED[op](difference, 0)


FUNCTIONS = """
sqrt(x**2 + 1)*y; exp(x/y)/w; sqrt(sqrt(x**2) + w**2); (x**2 + 1)**(1/3)*x; tanh(x/w) + x
sin(x + cos(y/w)); log(1 + x**2)/(1 + exp(-x)); (1 + x**2)**(-3/2)
"""


@pytest.mark.some(2)
@pytest.mark.parametrize(
    "text", [t.strip() for line in FUNCTIONS.split("\n") for t in line.split(";") if t]
)
def test_with_functions_as_symbols_a_law_is_the_same(text):
    """Each symbol takes the value of its function: the quotient is the law, the facts hold."""
    tree = parse_law(text, "test")
    parts = parts_of([tree], frozenset(names(tree)))
    made = ratio(parts.without_functions(tree))
    draw = random.Random(text)
    with mpmath.workdps(50):
        for _ in range(200):
            values = {name: mpmath.mpf(draw.uniform(-5, 5)) for name in ("x", "y", "w")}
            for part in parts.parts:
                inner = fill(part.value.top, values) / fill(part.value.bottom, values)
                if isinstance(part.argument, Sym):
                    values[part.argument.name] = inner
                values[part.name] = value_of(part, inner)
            facts = [[(c.op, fill(c.left, values), fill(c.right, values)) for c in clause]
                     for clause in parts.facts()]  # fmt: skip
            assert all(any(near(*c) for c in clause) for clause in facts)
            wanted = direct(text, values)
            assert mpmath.almosteq(
                fill(made.top, values) / fill(made.bottom, values), wanted, 1e-30
            )


def fill(tree: Expr, values):
    if tree == ONE:
        return mpmath.mpf(1)
    return eval(exact(tree), {"mpf": mpmath.mpf}, values)


def direct(text, values):
    library = {n: getattr(mpmath, n) for n in ("exp", "log", "sin", "cos", "tanh", "sqrt")}
    text = text.replace("(1/3)", "(mpf(1)/3)").replace("(-3/2)", "(-mpf(3)/2)")
    return eval(text, library | {"mpf": mpmath.mpf}, values)
