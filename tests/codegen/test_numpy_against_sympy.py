"""The generated module against SymPy's own mathematics, evaluated with 40 digits.

The reference is the system with its banks written out, derived by another road than the program;
its Jacobian is SymPy's derivative.  Errors are measured against the sum of the absolute terms of a
row, so that cancellation between terms is not blamed on the code.
"""

from functools import cache

import mpmath as mp
import numpy as np
import pytest
import sympy as sp
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from piezo_sym import derive, load
from piezo_sym.modules import module_of

DIGITS = 40
TOLERANCE = 1e-12
SIZES = (1, 2, 5)
MODULE = module_of("piezo_stack")
SCALES = {"q": 2e-3, "p": 5e-3, "Q_C": 5e-4, "phi": 6e-3}


@cache
def reference(r: int):
    """Exact functions of (x, u, parameters): rows, their absolute terms, and the Jacobian."""
    model = load("piezo_stack")
    iphs = derive(model).expand({"hysteron": r})
    symbols = {s.name: s for s in iphs.rhs.free_symbols | iphs.U.free_symbols}
    names = [s.name for s in iphs.x] + [*model.inputs, *model.parameters]
    arguments = [symbols.get(name, sp.Symbol(name)) for name in names]
    rows = [sp.expand(row) for row in iphs.rhs]
    sizes = [sp.Add(*(sp.Abs(term) for term in sp.Add.make_args(row))) for row in rows]
    jacobian = sp.Matrix(rows).jacobian(list(iphs.x))
    size = jacobian.applyfunc(lambda e: sp.Add(*(abs(t) for t in sp.Add.make_args(sp.expand(e)))))
    names = ("rhs", "U", "y", "sigma")
    exact = {"rhs": rows, "U": iphs.U, "y": list(iphs.y), "sigma": iphs.sigma}
    made = {name: sp.lambdify(arguments, exact[name], "mpmath") for name in names}
    made["rhs size"] = sp.lambdify(arguments, sizes, "mpmath")
    made["jacobian"] = sp.lambdify(arguments, jacobian, "mpmath")
    made["jacobian size"] = sp.lambdify(arguments, size, "mpmath")
    return made


def exact(name: str, x, u, p):
    """Return a reference value at exactly the floating-point numbers given."""
    values = [*x, *u, *(getattr(p, f.name) for f in MODULE.PARAMETERS)]
    with mp.workdps(DIGITS):
        return reference(p.hysteron_count)[name](*(mp.mpf(float(v)) for v in values))


def assert_close(found, wanted, size) -> None:
    for a, b, s in zip(np.ravel(found), wanted, size, strict=True):
        assert abs(mp.mpf(float(a)) - b) <= TOLERANCE * max(s, mp.mpf("1e-300")), (a, b, s)


unit = st.floats(-1, 1)


@st.composite
def points(draw):
    """Draw (x, u, parameters) with T - T_0 from 1 mK up, currents inside and outside the kinks."""
    r = draw(st.sampled_from(SIZES))
    p = MODULE.Parameters(hysteron_count=r)
    currents = [draw(st.floats(-6, 6) | st.floats(-0.6, 0.6)) for _ in range(r)]
    head = [draw(unit) * SCALES[name] for name in ("q", "p", "Q_C")]
    entropy = p.c_0 * np.log1p(draw(st.floats(1e-3, 80)) / p.T_0)
    u = np.array([draw(unit) * 50, draw(unit) * 150, draw(st.floats(296.2, 400))])
    return np.array([*head, *(i * p.L for i in currents), entropy]), u, p


@given(points())
@settings(max_examples=150, deadline=None)
def test_rates(point):
    x, u, p = point
    assert_close(MODULE.rhs(x, u, p), exact("rhs", x, u, p), exact("rhs size", x, u, p))


@given(points())
@settings(max_examples=100, deadline=None)
def test_jacobian_on_both_sides_of_every_kink(point):
    x, u, p = point
    currents = np.abs(x[3:-1] / p.L)
    assume(np.all(np.abs(currents - p.i_0) > 1e-9))
    wanted = exact("jacobian", x, u, p)
    assert_close(MODULE.jacobian(x, u, p), list(wanted), list(exact("jacobian size", x, u, p)))


@given(points())
@settings(max_examples=50, deadline=None)
def test_outputs_energy_and_production(point):
    x, u, p = point
    y = exact("y", x, u, p)
    sizes = [abs(y[0]), sum(abs(mp.mpf(float(i))) for i in x[3:-1]) / mp.mpf(p.L), abs(y[2])]
    assert_close(MODULE.outputs(x, u, p), y, sizes)
    energy = exact("U", x, u, p)
    assert_close(MODULE.energy(x, p), [energy], [energy])
    sigma = exact("sigma", x, u, p)
    assert_close(MODULE.entropy_production(x, u, p).sum(), [sigma], [sigma])


@pytest.mark.parametrize("side", [-1, 1])
@pytest.mark.parametrize("offset", [-1e-12, 0.0, 1e-12])
def test_rates_at_the_kinks(side, offset):
    p = MODULE.Parameters()
    x = np.array([1e-4, 1e-3, 1e-5, side * (p.i_0 + offset) * p.L, 0.2 * p.L, 0.05])
    u = np.array([0.0, 10.0, 300.0])
    assert_close(MODULE.rhs(x, u, p), exact("rhs", x, u, p), exact("rhs size", x, u, p))


@given(points(), st.integers(1, 4))
@settings(max_examples=30, deadline=None)
def test_batches_give_what_single_states_give(point, width):
    x, u, p = point
    batch = np.stack([x * (1 + 0.01 * n) for n in range(width)], axis=1)
    for name in ("rhs", "jacobian", "outputs", "supply", "heat", "entropy_production", "margins"):
        function = getattr(MODULE, name)
        together = function(batch, u, p)
        for n in range(width):
            single = function(batch[:, n], u, p)
            size = np.abs(single).max()
            assert np.allclose(together[..., n], single, rtol=1e-13, atol=1e-13 * size), name


def test_a_large_batch_goes_in_blocks_and_gives_the_same():
    rng = np.random.default_rng(3)
    p = MODULE.Parameters()
    x = rng.uniform(0.5, 1.5, (6, 40_000)) * np.array(
        [[1e-3], [5e-3], [1e-4], [2e-3], [1e-4], [0.05]]
    )
    u = rng.uniform(1, 2, (3, 40_000)) * np.array([[1.0], [50.0], [200.0]])
    whole = MODULE.rhs(x, u, p)
    parts = [MODULE.rhs(x[:, n : n + 1000], u[:, n : n + 1000], p) for n in range(0, 40_000, 1000)]
    assert np.array_equal(whole, np.concatenate(parts, axis=1))


def test_lanes_with_values_of_their_own():
    u = np.array([0.0, 20.0, 300.0])
    x = np.array([0.0, 0.0, 1e-5, 1e-3, 2e-3, 0.05])
    listed = MODULE.Parameters(L=(1e-3, 2e-3), i_0=(0.5, 0.25))
    both = MODULE.rhs(x, u, listed)
    for lane, (inductance, threshold) in enumerate(((1e-3, 0.5), (2e-3, 0.25))):
        same = MODULE.rhs(x, u, MODULE.Parameters(L=inductance, i_0=threshold))
        assert both[3 + lane] == same[3 + lane]


def test_power_put_in_is_the_rate_of_the_energy():
    rng = np.random.default_rng(7)
    p = MODULE.Parameters(hysteron_count=3)
    for _ in range(20):
        x = rng.normal(size=7) * [1e-3, 5e-3, 1e-4, 3e-3, 3e-3, 3e-3, 0] + [0, 0, 0, 0, 0, 0, 0.05]
        u = np.array([rng.normal(), 100 * rng.normal(), 310.0])
        slope = (
            p.k * (x[0] - p.q_l),
            x[1] / p.M,
            x[2] / p.C,
            *(x[3:6] / p.L),
            MODULE.temperatures(x, p)[0],
        )
        terms = np.array(slope) * MODULE.rhs(x, u, p)
        assert abs(terms.sum() - MODULE.supply(x, u, p).sum()) <= 1e-12 * np.abs(terms).sum()
