"""Exponentials less one keep their digits: trees, and generated modules near zero."""

from fractions import Fraction

import mpmath as mp
import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from piezo_sym import generate
from piezo_sym.algebra.symbols import to_sympy
from piezo_sym.codegen.differences import sharp
from piezo_sym.expressions.parse import parse_law
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import Add, Call, Div, Mul, Neg, Num, Sym, rebuild, walk
from piezo_sym.module_cache import load_module
from piezo_sym.run.engine.engine import engine_of
from piezo_sym.spec.load import parse

SPEC = """
[model]
name = "diode"
[parameters]
M = {{ value = 1.0, unit = "kg" }}
F = {{ value = 0.7, unit = "N" }}
w = {{ value = 0.3, unit = "m/s" }}
T_0 = {{ value = 300.0, unit = "K" }}
c = {{ value = 5.0, unit = "J/K" }}
[domain]
assume = ["F >= 0", "w > 0"]
[elements]
body = {{ kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }}
"""
PAIR = """
m{0} = {{ kind = "mass", at = "tip{0}", mass = "M" }}
d{0} = {{ kind = "damper", between = ["tip{0}", "wall"], force = "{1}", heats = "body" }}
"""
#: Laws that vanish with v.
LAWS = (
    "F*(exp(v/w) - 1)",
    "F*(1 - exp(-v/w))",
    "F*exp(v/w) - F",
    "F - exp(-v/w)*F",
    "F/w*(v + w*(exp(v/w) - 1))",
    "F*T_0/T*(-1 + exp(v/w))",
    "F*(exp(v/w) - 1 + 1 - exp(-v/w))",
    "F*(exp(v/w) - 1) if v > 0 else F*(exp(2*v/w) - 1)",
)
NAMES = {"F": 0.7, "w": 0.3, "T_0": 300.0, "T": 300.0}


def exactly(law, v):
    """Return a law and its slope in v, to 50 digits, at the numbers given."""
    symbols = {name: sp.Symbol(name, real=True) for name in (*NAMES, "v")}
    tree = to_sympy(parse_law(law, "law"), symbols)
    values = [mp.mpf(value) for value in (*NAMES.values(), v)]
    with mp.workdps(50):
        return [
            sp.lambdify(list(symbols.values()), e, "mpmath")(*values)
            for e in (tree, tree.diff(symbols["v"]))
        ]


@pytest.fixture(scope="module")
def module(tmp_path_factory):
    """The generated module of masses that the laws brake, one each."""
    pairs = "".join(PAIR.format(n, law) for n, law in enumerate(LAWS))
    model = parse(SPEC.format() + pairs)
    return load_module(generate(model, tmp_path_factory.mktemp("out"), allow_unproved=True)[0])


@pytest.mark.some(1)
@pytest.mark.parametrize("v", [1e-12, -1e-12, 1e-25, 0.3e-6, 0.1, 2.0])
def test_laws_keep_their_digits_near_zero(module, v):
    x = np.array([0.0, *[v] * len(LAWS)])
    for twin in (module, engine_of(module)):
        forces = -twin.rhs(x, np.zeros(0), module.Parameters())[1:]
        slopes = -np.diag(twin.jacobian(x, np.zeros(0), module.Parameters()))[1:]
        for law, *found in zip(LAWS, forces, slopes, strict=True):
            for value, wanted in zip(found, exactly(law, v), strict=True):
                assert abs(mp.mpf(float(value)) / wanted - 1) < 1e-15, law


@pytest.mark.parametrize(
    ("text", "answer"),
    [
        ("exp(x) - 1", "expm1(x)"),
        ("1 - exp(x)", "-expm1(x)"),
        ("-exp(x) + y + 1", "-expm1(x) + y"),
        ("2*exp(x) - 2", "2*expm1(x)"),
        ("exp(x)/y - 1/y", "expm1(x)/y"),
        ("y/w*exp(x) - y/w", "y/w*expm1(x)"),
        ("exp(x) - 1 + exp(y) - 1", "expm1(x) + expm1(y)"),
        ("exp(exp(x) - 1) - 1", "expm1(expm1(x))"),
        ("exp(x)*exp(y) - exp(x)", "exp(x)*expm1(y)"),
        ("(y if exp(x) - 1 < y else 1 - exp(x))", "y if expm1(x) < y else -expm1(x)"),
        ("exp(x) + 1", "exp(x) + 1"),
        ("exp(x) - 2", "exp(x) - 2"),
        ("y*exp(x) - 1", "y*exp(x) - 1"),
        ("1/exp(x) - 1", "1/exp(x) - 1"),
        ("exp(x)**2 - 1", "exp(x)**2 - 1"),
    ],
)
def test_differences(text, answer):
    assert spell(sharp(parse_law(text, "law"))) == answer


letters = st.sampled_from("xyw").map(Sym)
factors = (
    letters
    | letters.map(lambda z: Call("exp", (z,)))
    | st.integers(1, 3).map(lambda n: Num(Fraction(n)))
)
terms = st.recursive(
    factors,
    lambda part: st.builds(Mul, part, part) | st.builds(Div, part, letters) | st.builds(Neg, part),
    max_leaves=4,
)
sums = st.lists(terms, min_size=2, max_size=3).map(lambda parts: Add(tuple(parts)))


def plain(node):
    """Return a tree with expm1 written out."""
    inner = rebuild(node, plain)
    if isinstance(inner, Call) and inner.function == "expm1":
        return Add((Call("exp", inner.args), Num(Fraction(-1))))
    return inner


@given(sums, terms, st.sampled_from("xyw"))
def test_a_sharp_tree_is_the_same_function(total, factor, letter):
    """Sums in which a term comes with and without an exponential, among others."""
    exponential = Call("exp", (Sym(letter),))
    tree = Add((*total.terms, Mul(factor, exponential), Neg(factor)))
    symbols = {name: sp.Symbol(name, positive=True) for name in "xyw"}
    found = sharp(tree)
    assert sp.expand(to_sympy(plain(found), symbols) - to_sympy(tree, symbols)) == 0
    assert any(isinstance(node, Call) and node.function == "expm1" for node in walk(found))
