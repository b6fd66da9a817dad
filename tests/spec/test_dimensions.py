"""Dimensions of laws: each rule, and laws whose values scale as their dimension says.

The oracle for a dimension is its meaning: in other base units, every value of a law is multiplied
by the product of the powers of the base units' sizes.  Values are found by Python's arithmetic.
"""

from fractions import Fraction

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from spec_laws import laws, python_value, steady

from piezo_sym.expressions.dimensions import BASES, NONE, dimension, faults, matches, times
from piezo_sym.expressions.parse import parse_condition, parse_law
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import (
    ZERO,
    Add,
    Call,
    Cmp,
    Div,
    If,
    Mul,
    Neg,
    Num,
    Pow,
    Sym,
    names,
)
from piezo_sym.expressions.units import parse_unit
from piezo_sym.spec.unit_text import unit_text

UNITS = {"v": "m/s", "w": "m/s", "i": "A", "T": "K", "T_0": "K", "n": "1", "d": "N*s/m", "q": "m"}
WORDS = {name: parse_unit(unit).dimension for name, unit in UNITS.items()}


def found(text, words=WORDS):
    """Return the unit of a law without faults, None if it fits any, else the faulty terms."""
    tree = parse_law(text, "law")
    wrong = faults(matches(tree), words)
    if wrong:
        return [spell(rule.node) for rule in wrong]
    size = dimension(tree, words)
    return None if size is None else unit_text(size)


RIGHT = {
    "v": "m/s",
    "-v": "m/s",
    "2*v": "m/s",
    "v*2/3": "m/s",
    "d*v": "N",
    "v/w": "1",
    "v**2": "m**2/s**2",
    "v**(-1)": "s/m",
    "v**0": "1",
    "v**(1/2)": "m**(1/2)/s**(1/2)",
    "sqrt(v**2 + w**2)": "m/s",
    "sqrt(d*v*w/d)": "m/s",
    "v - w + v": "m/s",
    "2 + n": "1",
    "exp(v/w)": "1",
    "log(T/T_0)": "1",
    "sin(n) + cos(2) - tanh(v/w)": "1",
    "sign(v)": "1",
    "sign(v)*T": "K",
    "abs(v)": "m/s",
    "min(v, w)": "m/s",
    "max(T, T_0)": "K",
    "deadzone(v, w)": "m/s",
    "saturate(v, 2*w)": "m/s",
    "v if T > T_0 else w": "m/s",
    "0": None,
    "-0": None,
    "0 - 0 + 0": None,
    "0*v": None,
    "v*0": None,
    "0/v": None,
    "0**2": None,
    "sqrt(0)*v": None,
    "abs(0)": None,
    "min(0, -0)": None,
    "0 if v > w else 0": None,
    "0**0": "1",
    "exp(0)": "1",
    "sign(0)": "1",
    "0*v + T": "K",
    "0 + v": "m/s",
    "v - 0": "m/s",
    "0 if T > T_0 else v": "m/s",
    "v if v > 0 else 0": "m/s",
    "max(0, v)": "m/s",
    "deadzone(v, 0)": "m/s",
    "tanh(0*v)": "1",
}
WRONG = {
    "v + 2": ["v + 2"],
    "2 - v": ["2 - v"],
    "v + 2 + T": ["v + 2 + T"],
    "v + T": ["v + T"],
    "0 + v + T": ["0 + v + T"],
    "1 - 1 + v": ["1 - 1 + v"],
    "tanh(i)": ["tanh(i)"],
    "exp(T)": ["exp(T)"],
    "log(2*T)": ["log(2*T)"],
    "sin(v)": ["sin(v)"],
    "cos(v)": ["cos(v)"],
    "n*(v + 2)**2 + v": ["v + 2"],
    "min(v, T)": ["min(v, T)"],
    "max(v, 1)": ["max(v, 1)"],
    "deadzone(v, i)": ["deadzone(v, i)"],
    "saturate(v, 1)": ["saturate(v, 1)"],
    "v if T > T_0 else i": ["v if T > T_0 else i"],
    "exp(v)*exp(i)": ["exp(v)", "exp(i)"],
    "exp(v) + exp(v)": ["exp(v)"],
    "exp(log(T) + 1)": ["log(T)"],
    "sqrt(v) + v": ["sqrt(v) + v"],
    "sign(v) + v": ["sign(v) + v"],
    "abs(v) + 1": ["abs(v) + 1"],
}


@pytest.mark.parametrize(("text", "unit"), RIGHT.items())
def test_a_law_that_fits_has_its_unit(text, unit):
    assert found(text) == unit


@pytest.mark.parametrize(("text", "terms"), WRONG.items())
def test_a_law_that_does_not_fit_shows_its_smallest_faulty_terms(text, terms):
    assert found(text) == terms


def test_both_sides_of_a_comparison_have_one_unit():
    def wrong(text):
        return faults(matches(parse_condition(text, "c")), WORDS)

    assert not wrong("T > T_0")
    assert not wrong("v >= 0")
    assert not wrong("2*T > T_0 + T")
    assert [rule.node for rule in wrong("T > v")] == [parse_condition("T > v", "c")]
    assert [rule.node for rule in wrong("T > 290")] == [parse_condition("T > 290", "c")]
    assert len(wrong("T + v > T + i")) == 2


def test_the_condition_of_a_choice_is_looked_at():
    tree = parse_law("v if T > 290 else w", "law")
    assert [rule.node for rule in faults(matches(tree), WORDS)] == [tree.condition]


# Random laws of a wanted dimension.

SIZES = st.tuples(*[st.integers(-2, 2) if k < 3 else st.just(0) for k in range(len(BASES))]).map(
    lambda powers: tuple(Fraction(p) for p in powers)
)
SCALE = 2.0**6  # powers of two scale without rounding, so that no kink is crossed by it


def name_of(size, n):
    """Return a name that tells its dimension."""
    powers = "_".join(str(p).replace("-", "m").replace("/", "d") for p in size)
    return f"x{n}_{powers}"


def reasonable(size):
    return all(abs(p) <= 4 and 12 % p.denominator == 0 for p in size)


@st.composite
def fitting(draw, size, depth=3):
    """Draw a law of the dimension `size`, and put the dimension of each name into it."""
    if depth == 0 or draw(st.integers(0, 9)) == 0:
        if size == NONE and draw(st.booleans()):
            return Num(Fraction(draw(st.integers(1, 9)), draw(st.sampled_from([1, 2, 5]))))
        return Sym(name_of(size, draw(st.integers(0, 2))))
    ways = ["sum", "product", "quotient", "power", "root", "same", "two", "choice", "minus"]
    way = draw(st.sampled_from([*ways, *(["pure", "sign"] if size == NONE else [])]))
    other = draw(SIZES)

    def law(wanted):
        return draw(fitting(wanted, depth - 1))

    match way:
        case "sum":
            parts = [law(size) for _ in range(draw(st.integers(2, 3)))]
            return Add((*parts, *draw(st.sampled_from([(), (ZERO,), (Neg(ZERO),)]))))
        case "product":
            return Mul(law(other), law(times(size, other, -1)))
        case "quotient":
            return Div(law(times(size, other)), law(other))
        case "power":
            exponent = Fraction(draw(st.sampled_from([2, 3, -1, -2])))
            base = tuple(p / exponent for p in size)
            return Pow(law(base), exponent) if reasonable(base) else law(size)
        case "root":
            return Call("sqrt", (law(times(size, size)),))
        case "same":
            return Call("abs", (law(size),))
        case "two":
            function = draw(st.sampled_from(["min", "max", "deadzone", "saturate"]))
            return Call(function, (law(size), law(size)))
        case "choice":
            test = Cmp(draw(st.sampled_from(["<", "<=", ">", ">="])), law(other), law(other))
            return If(law(size), test, draw(st.sampled_from([ZERO, law(size)])))
        case "pure":
            function = draw(st.sampled_from(["exp", "log", "sin", "cos", "tanh"]))
            return Call(function, (law(NONE),))
        case "sign":
            return Call("sign", (law(other),))
    return Neg(law(size))


def sizes_in(tree):
    """Return the dimension of each name, read from the name."""

    def read(text):
        return Fraction(text.replace("m", "-").replace("d", "/"))

    return {name: tuple(read(p) for p in name.split("_")[1:]) for name in names(tree)}


def factor(size, scales):
    total = 1.0
    for power, scale in zip(size, scales, strict=True):
        total *= scale ** float(power)
    return total


def scales_as(tree, words, size, values, scales):
    """Check that in other base units the value is what the dimension `size` says."""
    text = spell(tree)
    scaled = {name: values[name] * factor(words[name], scales) for name in values}
    try:
        here, there = python_value(text, values), python_value(text, scaled)
    except (ArithmeticError, ValueError, TypeError):  # no real value there
        assume(False)
    assume(abs(here) < 1e60)
    assert there == pytest.approx(here * factor(size, scales), rel=1e-7, abs=0)


drawn_scales = st.lists(st.sampled_from([1 / SCALE, 1.0, SCALE]), min_size=7, max_size=7)


@steady
@given(data=st.data(), size=SIZES, scales=drawn_scales)
def test_a_law_made_to_fit_fits_and_scales(data, size, scales):
    tree = data.draw(fitting(size))
    words = sizes_in(tree)
    assert faults(matches(tree), words) == ()
    assert dimension(tree, words) in (size, None)
    numbers = st.integers(1, 64).map(lambda n: n / 16)
    values = {name: data.draw(numbers) for name in words}
    scales_as(tree, words, size, values, scales)


@steady
@given(
    tree=laws(terms=3),
    units=st.lists(st.sampled_from(["1", "1", "m", "s"]), min_size=3, max_size=3),
    numbers=st.lists(st.integers(1, 64), min_size=3, max_size=3),
    scales=drawn_scales,
)
def test_any_law_that_is_said_to_fit_scales(tree, units, numbers, scales):
    sizes = {n: parse_unit(unit).dimension for n, unit in zip("xyw", units, strict=True)}
    words = {name: sizes[name] for name in names(tree)}
    assume(any(words.values()) and faults(matches(tree), words) == ())
    size = dimension(tree, words)
    values = {name: n / 16 for name, n in zip("xyw", numbers, strict=True) if name in words}
    scales_as(tree, words, NONE if size is None else size, values, scales)


@steady
@given(data=st.data(), size=SIZES, other=SIZES)
def test_a_term_of_another_unit_is_found_wherever_it_stands(data, size, other):
    assume(size != other)
    tree = data.draw(fitting(size))
    assume(dimension(tree, sizes_in(tree)) is not None)
    intruder = Sym(name_of(other, 9))
    places = [
        Add((tree, intruder)),
        Call("min", (intruder, tree)),
        Call("exp", (Div(tree, intruder),)),
        If(tree, Cmp("<", tree, tree), intruder),
        If(tree, Cmp("<", tree, intruder), tree),
    ]
    around = data.draw(st.sampled_from([Neg, lambda x: Mul(x, x), lambda x: Call("sign", (x,))]))
    for broken in places:
        (rule,) = faults(matches(around(broken)), sizes_in(around(broken)))
        assert rule.node in (broken, getattr(broken, "condition", None))
