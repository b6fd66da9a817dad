"""Every record of a law function, against mpmath: what it says is so, wherever it is used.

A function that is added to `expressions.functions` is in these tests by that alone.
"""

import ast
import ctypes
import subprocess
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from flint import ctx
from hypothesis import given
from hypothesis import strategies as st

from piezo_sym.algebra.symbols import to_sympy
from piezo_sym.codegen.c.style import c_piece, c_style, helpers
from piezo_sym.codegen.numpy.style import numpy_text
from piezo_sym.expressions.calculus import clause, derivative, rule
from piezo_sym.expressions.dimensions import dimension, matches
from piezo_sym.expressions.exact_eval import evaluate, value_of
from piezo_sym.expressions.functions import FUNCTIONS, RECORDS
from piezo_sym.expressions.parse import parse_law
from piezo_sym.expressions.tidying import reflected
from piezo_sym.expressions.tree import (
    COMPARED,
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
)
from piezo_sym.proofs.signs import intervals, jets
from tests.codegen.c_compilers import COMPILERS

SMOOTH = [name for name, record in RECORDS.items() if record.transcendental]
#: A table has a file of its own: it is of any number of arguments.
PLAIN = [name for name, record in RECORDS.items() if not record.knots]
KINKED = [name for name in PLAIN if not RECORDS[name].smooth]
X, W = Sym("x"), Sym("w")
SIZES = [*(s * 10.0**n for n in range(-12, 3) for s in (1, -1)), 0.0, 0.3, -0.7, 1.0, 2.5, -3.0]
REALS = st.floats(-30, 30, allow_nan=False).map(Fraction)


#: Of a function of two arguments, the second one.
SECOND = {"w": Fraction(1, 2)}


def function_of(name):
    """Return a function as mpmath has it; a power that of the exponent 1/2."""
    return mpmath.sqrt if name == "pow" else getattr(mpmath, name)


def call(name):
    return Call(name, (X, W)[: len(RECORDS[name].slopes)])


def defined(name, x):
    return x > 0 if RECORDS[name].domain else True


def points(name):
    return [Fraction(x) for x in SIZES if defined(name, x)]


def number(x):
    return mpmath.mpf(x.numerator) / x.denominator


def precise(node, words):
    """Return the value of a tree with the digits of mpmath's context."""
    match node:
        case Num(value):
            return number(value)
        case Sym(name):
            return words[name]
        case Neg(arg):
            return -precise(arg, words)
        case Add(terms):
            return mpmath.fsum(precise(term, words) for term in terms)
        case Mul(left, right):
            return precise(left, words) * precise(right, words)
        case Div(left, right):
            return precise(left, words) / precise(right, words)
        case Pow(base, exponent):
            return precise(base, words) ** number(exponent)
        case If(then, condition, other):
            return precise(then if holds(condition, words) else other, words)
        case Call(name, args) if RECORDS[name].choices:
            return precise(rule(RECORDS[name].choices, args[0], args[-1]), words)
        case Call(name, args):
            known = mpmath.power if name == "pow" else getattr(mpmath, name)
            return known(*(precise(arg, words) for arg in args))
    raise TypeError(node)


def holds(condition, words):
    difference = precise(condition.left, words) - precise(condition.right, words)
    return COMPARED[condition.op](difference, 0)


@pytest.fixture(autouse=True)
def _digits():
    with mpmath.workdps(50):
        yield


@pytest.mark.parametrize("name", SMOOTH)
def test_its_slope_is_the_derivative(name):
    slope = derivative(call(name), "x")
    for x in points(name):
        found = precise(slope, {"x": number(x), "w": mpmath.mpf("0.5")})
        wanted = mpmath.diff(function_of(name), number(x), h=mpmath.mpf(10) ** -20)
        assert mpmath.almosteq(found, wanted, 1e-12), x


@pytest.mark.parametrize("name", [n for n in FUNCTIONS if RECORDS[n].integral])
def test_its_integral_has_it_as_derivative(name):
    whole = derivative(rule(RECORDS[name].integral, X, W, value=call(name)), "x")
    for x in points(name):
        words = {"x": number(x), "w": mpmath.mpf("0.5")}
        assert mpmath.almosteq(precise(whole, words), precise(call(name), words))


@pytest.mark.parametrize("name", SMOOTH)
def test_its_facts_hold(name):
    clauses = [clause(text, X, Sym("y")) for text in RECORDS[name].facts]
    near = [Fraction(n, 7) for n in range(-70, 71)]
    with mpmath.workdps(400):
        for x in [*near, *(Fraction(x) for x in SIZES if abs(x) <= 10)]:
            words = {"x": number(x), "y": mpmath.mpf(0)}
            if defined(name, x):
                words["y"] = function_of(name)(words["x"])
            for told in clauses:
                assert any(holds(c, words) for c in told), (x, told)


@pytest.mark.parametrize("name", SMOOTH)
def test_parity_bounds_sign_and_growth(name):
    record, function = RECORDS[name], function_of(name)
    values = {number(x): function(number(x)) for x in points(name)}
    turn = {"odd": -1, "even": 1}.get(record.parity)
    low, high = (mpmath.mpf(b) if isinstance(b, float) else number(b) for b in record.bounds)
    for x, y in values.items():
        assert turn is None or function(-x) == turn * y
        assert low <= y <= high
        assert record.sign != ">" or y > 0
    rising = sorted(x for x in values if record.parity != "even" or x >= 0)
    if record.rises:
        with mpmath.workdps(200):
            found = [function(x) for x in rising if abs(x) < 10]
        assert found == sorted(set(found))
    if record.known:
        assert function(mpmath.mpf(record.known[0])) == record.known[1]


@pytest.mark.some(2)
@pytest.mark.parametrize("name", [n for n in FUNCTIONS if RECORDS[n].transcendental])
@given(low=REALS, width=REALS.map(abs), share=st.fractions(0, 1, max_denominator=50))
def test_values_lie_in_every_enclosure(name, low, width, share):
    x = low + share * width
    value = getattr(mpmath, name)(number(x)) if defined(name, x) else None
    box = intervals.hull(intervals.rational(low), intervals.rational(low + width))
    found = intervals.of(name, box)
    assert found is None or found.lo <= value <= found.hi


@pytest.mark.some(3)
@pytest.mark.parametrize("name", [name for name in SMOOTH if name != "pow"])
@given(at=st.floats(-4, 4).map(Fraction))
def test_jets_hold_the_taylor_series(name, at):
    at = abs(at) + Fraction(1, 4) if RECORDS[name].domain else at
    found = jets.of(name, intervals.rational(at), 5)
    series = mpmath.taylor(getattr(mpmath, name), number(at), 4)
    for part, wanted in zip(found, series, strict=True):
        slack = 1e-9 * (1 + abs(wanted))
        assert part.lo - slack <= wanted <= part.hi + slack
    assert abs(found[0].hi - found[0].lo) <= 1e-13 * max(1, abs(found[0].hi))


@pytest.mark.parametrize("name", SMOOTH)
def test_exact_values_are_sharp(name):
    for x in points(name):
        try:
            found = value_of(call(name), {"x": x, **SECOND})
        except ArithmeticError:  # too large to be looked at
            assert abs(x) > 10
            continue
        value = function_of(name)(number(x))
        if isinstance(found, Fraction):
            assert number(found) == value
            continue
        with ctx.workprec(200):
            ends = found.lower().man_exp(), found.upper().man_exp()
        low, high = (mpmath.ldexp(*map(int, end)) for end in ends)
        assert low <= value <= high
        assert high - low <= abs(value) * mpmath.mpf(10) ** -30


@pytest.mark.parametrize("name", [n for n in FUNCTIONS if n in PLAIN])
def test_units_are_those_of_its_kind(name):
    record, metre = RECORDS[name], (Fraction(1), *[Fraction(0)] * 6)
    none = tuple(0 * power for power in metre)
    faults = [rule for rule in matches(call(name)) if rule.gap({"x": metre, "w": none}) != none]
    assert bool(faults) == (record.units == "pure" or len(record.slopes) > 1)
    wanted = {"equal": metre, "power": tuple(power / 2 for power in metre)}
    assert dimension(call(name), {"x": metre, "w": metre}) == wanted.get(record.units, none)


@pytest.mark.parametrize("name", [n for n in FUNCTIONS if n in PLAIN])
def test_sympy_has_the_same_function(name):
    import sympy as sp

    x, w = sp.symbols("x w", real=True)
    expr = to_sympy(call(name), {"x": x, "w": w})
    for value in (Fraction(3, 10), Fraction(9, 4), Fraction(-7, 5)):
        if defined(name, value) and (value > 0 or RECORDS[name].domain != "x >= 0"):
            found = expr.subs({x: sp.Rational(value.numerator, value.denominator), w: 1})
            wanted = precise(call(name), {"x": number(value), "w": mpmath.mpf(1)})
            assert abs(float(found) - wanted) < 1e-14


@pytest.mark.parametrize("name", [n for n in FUNCTIONS if n in PLAIN])
def test_a_mirrored_function_has_the_value_of_the_mirrored_argument(name):
    tree = reflected(call(name), "x")
    for x in (0.4, 1.7, -0.6):
        words = {"x": x, "w": 1.0}
        if defined(name, -x) and (x < 0 or RECORDS[name].domain != "x >= 0"):
            assert evaluate(tree, words) == evaluate(call(name), {"x": -x, "w": 1.0})


def drawn(name):
    values = [float(x) for x in points(name) if abs(x) <= 100]
    return [x for x in values if x >= 0 or not RECORDS[name].domain]


def wanted(name, width=0.5):
    words = {"w": mpmath.mpf(width)}
    return [precise(call(name), {**words, "x": mpmath.mpf(x)}) for x in drawn(name)]


def close(found, name):
    pairs = zip(found, wanted(name), strict=True)
    return all(abs(a - b) <= 1e-12 * max(abs(b), mpmath.mpf(10) ** -300) for a, b in pairs)


@pytest.mark.parametrize("name", PLAIN)
def test_numpy_computes_it(name):
    record, words = RECORDS[name], {"np": np, "w": 0.5, "x": np.array(drawn(name))}
    for line in record.numpy_helper:
        exec(line, words)
    text = numpy_text(call(name))
    assert ast.parse(text, mode="eval")
    assert close(eval(text, words), name)


@pytest.mark.parametrize("compiler", COMPILERS)
def test_c_computes_it(tmp_path, compiler):
    style = c_style({"x": "x", "w": "w"}, {}, "")
    texts = {name: c_piece(call(name), style)[0] for name in PLAIN}
    head = "double f_{}(double x, double w) {{ (void)w; return {}; }}"
    bodies = [head.format(name, text) for name, text in texts.items()]
    source = "\n".join(["#include <math.h>", *helpers("\n".join(bodies)), *bodies])
    (tmp_path / "f.c").write_text(source)
    flags = ["-std=c99", "-O2", "-shared", "-fPIC", "-Wall", "-Werror", "-o"]
    command = [*COMPILERS[compiler], *flags, str(tmp_path / "f.so"), str(tmp_path / "f.c"), "-lm"]
    subprocess.run(command, check=True)
    library = ctypes.CDLL(str(tmp_path / "f.so"))
    for name in PLAIN:
        function = library[f"f_{name}"]
        function.restype, function.argtypes = ctypes.c_double, [ctypes.c_double] * 2
        assert close([function(x, 0.5) for x in drawn(name)], name), name


KINKED_VALUES = {
    "abs": abs,
    "sign": lambda x: (x > 0) - (x < 0),
    "min": min,
    "max": max,
    "saturate": lambda x, w: min(max(x, -w), w),
    "deadzone": lambda x, w: max(x - w, 0) + min(x + w, 0),
}


@pytest.mark.parametrize("name", KINKED)
def test_branches_and_formula_are_the_function(name):
    record = RECORDS[name]
    for x in (*SIZES, 0.5, -0.5):
        for w in (0.0, 0.5, 2.0):
            words, value = {"x": x, "w": w}, KINKED_VALUES[name](*(x, w)[: len(record.slopes)])
            assert evaluate(rule(record.choices, X, W), words) == value
            assert not record.formula or evaluate(rule(record.formula, X, W), words) == value
    assert isinstance(parse_law(record.choices, "here"), If)


def test_a_domain_is_what_a_premise_says():
    for name in SMOOTH:
        if RECORDS[name].domain:
            (inside,) = clause(RECORDS[name].domain, X, X)
            assert inside == Cmp(">=" if name == "pow" else ">", X, Num(Fraction(0)))
            outside = ("x <= 0 | ", "x < 0 | ") if name == "pow" else "x <= 0 | "
            assert all(text.startswith(outside) for text in RECORDS[name].facts)
