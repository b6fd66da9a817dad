"""The compiled module against its NumPy twin and SymPy's mathematics with 40 digits.

Errors are measured against the sum of the absolute terms of a row, as for NumPy.
"""

import shutil
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given, settings

from piezo_sym import Model, load
from piezo_sym.build import render
from piezo_sym.module_cache import load_module
from piezo_sym.run.engine import library as libraries
from piezo_sym.run.engine.compiler import FLAGS, compilers
from piezo_sym.run.engine.engine import OFFERED, engine_of

from .c_compilers import COMPILERS
from .test_numpy_against_sympy import MODULE, SIZES, TOLERANCE, assert_close, exact, mp, points

PLAIN = {"energy", "entropy", "temperatures"}


@pytest.fixture(scope="module", params=COMPILERS)
def engine(request, tmp_path_factory):
    """The engine of each compiler, of the files of `MODULE` in a folder of their own."""
    name = Path(MODULE.__file__).stem
    folder = tmp_path_factory.mktemp(request.param) / name
    shutil.copytree(Path(MODULE.__file__).parent, folder)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("CC", " ".join(COMPILERS[request.param]))
        found = engine_of(load_module(folder / f"{name}.py"))
        chosen = next(compilers())
    assert chosen.command[-1].endswith(COMPILERS[request.param][-1])
    assert Path(found.library._name).parent.name in keys(found.module, chosen)
    return found


def keys(module, compiler):
    """Return the places in the cache of what one compiler makes of a module."""
    texts = [Path(module.__file__).with_suffix(ending).read_text() for ending in (".h", ".c")]
    sources = libraries.Sources(module.NAME, *texts)
    texts = sources.files().values()
    ways = [libraries._flags(sources, flags) for flags in FLAGS]
    return {libraries._key(texts, compiler, flags) for flags in ways}


def arguments(name, x, u, p):
    if name == "initial_state":
        return (u if np.ndim(u) == 1 else u[:, 0], p)
    return (x, p) if name in PLAIN else (x, u, p)


def lanes_at(r, draw):
    """Return a state with currents on both sides of both kinks and on them, and its parameters."""
    p = MODULE.Parameters(hysteron_count=r)
    currents = draw.choice([-4.0, -p.i_0, -0.2, 0.0, 0.3, p.i_0, 2.0, 5.0], r)
    entropy = p.c_0 * np.log1p(draw.choice([1e-3, 1.0, 50.0]) / p.T_0)
    x = np.array([*draw.uniform(-1, 1, 3) * [2e-3, 5e-3, 5e-4], *(currents * p.L), entropy])
    return x, np.array([*draw.uniform(-1, 1, 2) * [50, 150], 300.0]), p


@given(points())
@settings(max_examples=150)
def test_rates(engine, point):
    x, u, p = point
    assert_close(engine.rhs(x, u, p), exact("rhs", x, u, p), exact("rhs size", x, u, p))


@given(points())
@settings(max_examples=60)
def test_jacobian_on_both_sides_of_every_kink(engine, point):
    x, u, p = point
    assume(np.all(np.abs(np.abs(x[3:-1] / p.L) - p.i_0) > 1e-9))
    wanted = exact("jacobian", x, u, p)
    assert_close(engine.jacobian(x, u, p), list(wanted), list(exact("jacobian size", x, u, p)))


@given(points())
@settings(max_examples=50)
def test_outputs_energy_and_production(engine, point):
    x, u, p = point
    y = exact("y", x, u, p)
    currents = sum(abs(mp.mpf(float(flux))) for flux in x[3:-1]) / mp.mpf(p.L)
    assert_close(engine.outputs(x, u, p), y, [abs(y[0]), currents, abs(y[2])])
    energy, sigma = exact("U", x, u, p), exact("sigma", x, u, p)
    assert_close(engine.energy(x, p), [energy], [energy])
    assert_close(engine.entropy_production(x, u, p).sum(), [sigma], [sigma])


@pytest.mark.parametrize("side", [-1, 1])
@pytest.mark.parametrize("offset", [-1e-12, 0.0, 1e-12])
def test_rates_at_the_kinks(engine, side, offset):
    p = MODULE.Parameters()
    x = np.array([1e-4, 1e-3, 1e-5, side * (p.i_0 + offset) * p.L, 0.2 * p.L, 0.05])
    u = np.array([0.0, 10.0, 300.0])
    assert_close(engine.rhs(x, u, p), exact("rhs", x, u, p), exact("rhs size", x, u, p))


@pytest.mark.parametrize("r", [*SIZES, 8, 64, 1000])
@pytest.mark.parametrize("name", OFFERED)
def test_both_twins_give_the_same(engine, r, name):
    """Rows of one term are the same to a few roundings; sums to the sizes of their terms."""
    draw = np.random.default_rng(r)
    for _ in range(10):
        x, u, p = lanes_at(r, draw)
        at = arguments(name, x, u, p)
        found, wanted = getattr(engine, name)(*at), getattr(MODULE, name)(*at)
        assert np.shape(found) == np.shape(wanted)
        np.testing.assert_allclose(found, wanted, rtol=1e-11, atol=size_of(name, x, u, p))


def size_of(name, x, u, p):
    """Return what rounding may cost in a row that adds up terms of a bank, or of both signs."""
    magnitude = np.abs(x), np.abs(u)
    terms = {"rhs": np.abs(MODULE.rhs(*magnitude, p)), "outputs": MODULE.outputs(*magnitude, p)}
    if name == "jacobian":
        return TOLERANCE * np.abs(MODULE.jacobian(x, u, p)).max()
    return TOLERANCE * np.max(terms[name]) if name in terms else 0.0


@pytest.mark.parametrize("name", OFFERED)
@pytest.mark.parametrize("batch", [(1,), (3,), (2, 3), (0,)])
def test_a_batch_gives_what_single_states_give(engine, name, batch):
    draw = np.random.default_rng(3)
    x, u, p = lanes_at(5, draw)
    x = x.reshape(-1, *(1,) * len(batch)) * draw.uniform(0.5, 1, (len(x), *batch))
    for inputs in (u, u.reshape(-1, *(1,) * len(batch)) * draw.uniform(0.9, 1, (3, *batch))):
        if name == "initial_state" and inputs.ndim > 1:
            continue
        together = getattr(engine, name)(*arguments(name, x, inputs, p))
        assert together.shape == getattr(MODULE, name)(*arguments(name, x, inputs, p)).shape
        for at in np.ndindex(*batch) if name != "initial_state" else ():
            one = inputs[(slice(None), *at)] if inputs.ndim > 1 else inputs
            single = getattr(engine, name)(*arguments(name, x[(slice(None), *at)], one, p))
            assert np.array_equal(together[(..., *at)], single)


def test_lanes_with_values_of_their_own(engine):
    u = np.array([0.0, 20.0, 300.0])
    x = np.array([0.0, 0.0, 1e-5, 1e-3, 2e-3, 0.05])
    for listed in ((1e-3, 2e-3), [1e-3, 2e-3], np.array([1e-3, 2e-3])):
        p = MODULE.Parameters(L=listed, i_0=(0.5, 0.25))
        np.testing.assert_allclose(engine.rhs(x, u, p), MODULE.rhs(x, u, p), rtol=1e-14)
        assert engine.margins(x, u, p)[4] == 0.25


def test_wrong_sizes_are_refused(engine):
    p, u = MODULE.Parameters(), np.array([0.0, 20.0, 300.0])
    with pytest.raises(ValueError, match=r"states have shape \(5,\), but there are 6"):
        engine.rhs(np.zeros(5), u, p)
    with pytest.raises(ValueError, match=r"inputs have shape \(2,\), but there are 3"):
        engine.rhs(np.ones(6), u[:2], p)
    with pytest.raises(ValueError, match="a bank of 2 lanes has 3 values"):
        engine.rhs(np.ones(6), u, MODULE.Parameters(L=(1.0, 2.0, 3.0)))


def test_the_dead_zone_divides_by_nothing(engine):
    """At T = T_0 the law's quotient is infinite, and the voltage of an idle hysteron is 0."""
    x = np.array([0.0, 0.0, 0.0, 1e-4, -1e-4, 0.0])
    u = np.array([0.0, 20.0, 300.0])
    assert list(engine.rhs(x, u, MODULE.Parameters())[3:5]) == [20.0, 20.0]


@pytest.mark.parametrize("row", range(5))
def test_what_is_not_a_number_is_not_hidden(engine, row):
    x, u, p = lanes_at(2, np.random.default_rng(0))
    x[row] = np.nan
    hidden = np.isnan(MODULE.rhs(x, u, p)) & ~np.isnan(engine.rhs(x, u, p))
    assert not hidden.any()
    assert np.isnan(engine.energy(x, p))


def test_an_entropy_that_is_not_a_number_leaves_idle_hysterons_alone(engine):
    x, u = np.array([0.0, 1e-3, 1e-5, 1e-4, 2e-3, np.nan]), np.array([0.0, 20.0, 300.0])
    found = engine.rhs(x, u, MODULE.Parameters())
    assert np.array_equal(np.isnan(found), [False, True, True, False, True, True])


def made(model, folder):
    """Write a model's files, and return its module and engine."""
    for name, text in render(model).items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    module = load_module(folder / model.name / f"{model.name}.py")
    return module, engine_of(module)


def test_a_listed_start_is_each_lane_s_own(tmp_path):
    data = load("piezo_stack").model_dump()
    data["initial"]["phi"] = [1e-4, -2e-4]
    module, other = made(Model(**data), tmp_path)
    u, p = np.array([0.0, 20.0, 300.0]), module.Parameters()
    assert np.array_equal(other.initial_state(u, p), module.initial_state(u, p))
    beyond = other.initial_state(u, module.Parameters(hysteron_count=3))
    assert np.array_equal(np.isnan(beyond), [False, False, False, False, False, True, False])


def test_rates_of_many_lanes_are_those_of_sympy(engine):
    """64 lanes, by the rows of 2: a lane's row is free of the others, sums are added up exactly."""
    x, u, p = lanes_at(64, np.random.default_rng(5))
    found = engine.rhs(x, u, p)
    pair = MODULE.Parameters(hysteron_count=1)
    ones = [np.array([*x[:3], flux, x[-1]]) for flux in x[3:-1]]
    rows = [exact("rhs", one, u, pair) for one in ones]
    sizes = [exact("rhs size", one, u, pair) for one in ones]
    none = np.array([*x[:3], 0.0, x[-1]])
    rest, rest_size = exact("rhs", none, u, pair), exact("rhs size", none, u, pair)
    with mp.workdps(40):
        total = [rest[n] + sum(row[n] - rest[n] for row in rows) for n in (0, 1, 2, 4)]
        size = [rest_size[n] + sum(s[n] for s in sizes) for n in (0, 1, 2, 4)]
    assert_close(found[[0, 1, 2, -1]], total, size)
    assert_close(found[3:-1], [row[3] for row in rows], [s[3] for s in sizes])
