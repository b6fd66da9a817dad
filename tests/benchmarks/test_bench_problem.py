"""What competitors are given is the model: its explicit rates are those of the generated module."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import sympy as sp

from piezo_sym import PiezoError, chirp, load, sine, step
from piezo_sym.bench.problem import TIME
from tests.benchmarks.case_p import problem_of
from tests.benchmarks.kinks import switched, twins
from tests.benchmarks.ours import states, whole
from tests.benchmarks.peers.peer import scaled

SPECS = sorted((Path(__file__).parents[1] / "networks" / "specs").glob("*.toml"))
MODELS = ["piezo_stack", *SPECS]
NOW = 0.0123


def names(spec):
    return getattr(spec, "stem", spec)


@pytest.fixture(scope="module", params=MODELS, ids=names)
def problem(request):
    model = load(request.param)
    driven = {
        name: sine(0.5, 3.0, 1.0 + 300.0 * (i.unit == "K")) for name, i in model.inputs.items()
    }
    return problem_of(model, driven, 0.1)


@pytest.fixture(scope="module")
def path(problem):
    """States of a run, so that no exponential is out of range."""
    return states(problem, whole(problem, 1e-4, 11, "LSODA"))


def drawn(problem, path, number):
    """States on both sides of those of a run, and the inputs at `NOW`."""
    draw = np.random.default_rng(number)
    x = path[:, 3 + number] * draw.uniform(-3, 3, problem.start.size)
    return x, np.array([float(signal(NOW)) for signal in problem.system.inputs.signals])


def at(expressions, problem, x, **more):
    known = dict(zip(problem.states, x, strict=True)) | {TIME: NOW}
    return np.array([float(e.subs({**known, **more}).evalf(25)) for e in expressions])


@pytest.mark.some(4)
@pytest.mark.parametrize("number", range(4))
def test_explicit_rates_are_the_modules(problem, path, number):
    x, u = drawn(problem, path, number)
    expected = problem.module.rhs(x, u, problem.system.parameters)
    size = np.abs(expected) + 1e-6 * np.max(np.abs(expected)) + 1e-9
    assert np.all(np.abs(at(problem.rates, problem, x) - expected) <= 1e-9 * size)


@pytest.mark.some(4)
def test_scaled_rates_are_those_of_scaled_states(problem, path):
    x, _ = drawn(problem, path, 0)
    scale = np.random.default_rng(1).uniform(0.1, 3, x.size)
    found = at(scaled(replace(problem, scale=scale)), problem, x / scale)
    np.testing.assert_allclose(found * scale, at(problem.rates, problem, x), rtol=1e-9, atol=1e-9)


@pytest.mark.some(12)
@pytest.mark.parametrize("number", range(4))
def test_switches_choose_what_pieces_say(problem, path, number):
    smooth = switched(problem.rates)
    assert not any(rate.has(sp.Piecewise) for rate in smooth.rates)
    x, _ = drawn(problem, path, number)
    gaps = at(smooth.gaps.values(), problem, x)
    switches = {symbol: float(gap > 0) for symbol, gap in zip(smooth.gaps, gaps, strict=True)}
    known = dict(zip(problem.states, x, strict=True)) | {TIME: NOW} | switches
    found = np.array([float(rate.subs(known).evalf(25)) for rate in smooth.rates])
    np.testing.assert_allclose(found, at(problem.rates, problem, x), rtol=1e-12, atol=1e-12)


CONDITIONS = [
    lambda a, b: sp.And(a > 0, b > 0),
    lambda a, b: sp.Or(a > 0, b > 1),
    lambda a, b: sp.Not(sp.And(a > 0, b > 0), evaluate=False),
    lambda a, b: sp.Or(a < b, sp.And(a > 1, b < 2)),
]


@pytest.mark.some(2)
@pytest.mark.parametrize("condition", CONDITIONS)
def test_switches_know_and_or_and_not(condition):
    a, b = sp.symbols("a b", real=True)
    pieces = sp.Piecewise((a + 7 * b, condition(a, b)), (3 - a, a > b), (a * b, True))
    smooth = switched([pieces])
    for x in np.random.default_rng(0).uniform(-3, 3, (40, 2)):
        known = dict(zip((a, b), x, strict=True))
        switches = {s: float(bool(gap.subs(known) > 0)) for s, gap in smooth.gaps.items()}
        found = float(smooth.rates[0].subs({**known, **switches}))
        assert found == pytest.approx(float(pieces.subs(known)), rel=1e-12)


def test_equal_hysterons_are_twins():
    problem = problem_of(load("piezo_stack"), {}, 0.1, {"hysteron": 4})
    found = twins(problem.states, problem.rates, problem.start)
    first, *others = (s for s in problem.states if str(s).startswith("phi"))
    assert found == dict.fromkeys(others, first)


def test_hysterons_that_start_apart_are_none():
    problem = problem_of(load("piezo_stack"), {}, 0.1)
    start = problem.start.copy()
    start[4] += 1e-6
    assert twins(problem.states, problem.rates, start) == {}


def test_unequal_hysterons_are_none():
    problem = problem_of(load("piezo_stack"), {}, 0.1)
    rates = list(problem.rates)
    rates[4] = rates[4] * (1 + 1e-9)
    assert twins(problem.states, rates, problem.start) == {}


def test_the_papers_actuator_is_driven_as_in_case_p():
    problem = problem_of(load("piezo_stack"), {}, 0.1)
    assert problem.inputs == {"V_in": sine(100, 100)}
    assert problem.scale.tolist() == [2e-3, 5e-3, 5e-4, 6e-3, 6e-3, 5e-2]


def test_any_other_run_of_it_is_not_case_p():
    problem = problem_of(load("piezo_stack"), {"V_in": sine(100, 99)}, 0.1)
    assert problem.scale.tolist() == [1.0] * 6


@pytest.mark.parametrize("signal", [step(0.1, 0, 1), chirp(1, 1, 2, 1), lambda t: t])
def test_other_signals_are_refused(signal):
    with pytest.raises(PiezoError, match="input 'V_in' is neither; expected a number or sine"):
        problem_of(load("piezo_stack"), {"V_in": signal}, 0.1)
