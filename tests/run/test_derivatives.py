"""Steps taken again are the same to the bit; their derivatives are those of closed forms."""

from dataclasses import replace

import numpy as np
import pytest
from collocations import prepared
from derivatives import Derivatives
from replay import Taped

from piezo_sym import simulate, sine
from piezo_sym.run.collocation import OVER_NOISE, stepping
from piezo_sym.run.engine.batch import Stepping
from piezo_sym.run.engine.engine import engine_of
from tests.networks.test_specs import SPECS

DRIVE = {"V_in": sine(100, 100)}
OSCILLATOR = next(path for path in SPECS if path.stem == "a2_oscillator")
#: With jumps, and every smooth function.
SOME = ("dry_friction", "smooth_functions")
SOME = [path for path in SPECS if path.stem in SOME]


def taped(spec, duration, rtol=1e-8, step=None, stages=None, scale=None, quiet=False, **options):
    """Return a run on tape, and its steps."""
    system, x = prepared(spec, duration, **options)
    how = Stepping(stages or 3, 1.0, step, step, fixed=step) if step else None
    how = how or stepping(system, rtol, stages)
    engine, inputs = engine_of(system.module), system.inputs
    noise = system.noise(x, np.abs(x)) if quiet else 0.0
    if quiet:  # as `collocate` has it, where all states are at rest
        scale = system.scale(OVER_NOISE * noise / how.tolerance)
    run = Taped(engine, system.parameters, x, inputs, how, scale, noise)
    return run, run.run()


@pytest.mark.parametrize("way", [{"rtol": 1e-4}, {"step": 3e-5, "stages": 2}])
def test_steps_taken_again_are_the_same_to_the_bit(way):
    run, steps = taped("piezo_stack", 0.02, inputs=DRIVE, **way)
    ends = [*(step.x for step in steps[1:]), run.x]
    assert len(steps) > 20
    assert steps[-1].t + steps[-1].h == pytest.approx(0.02, rel=1e-14)
    backwards = reversed(list(zip(steps, ends, strict=True)))
    assert all(np.array_equal(run.replay(step).end, end) for step, end in backwards)


def test_steps_of_states_at_rest_taken_again_are_the_same_to_the_bit():
    """Their noise ends Newton's method, in the run and again; without it the run would not end."""
    whole = simulate("peltier_cooler", duration=100.0, times=2)
    run, steps = taped("peltier_cooler", 100.0, rtol=1e-5, quiet=True)
    ends = [*(step.x for step in steps[1:]), run.x]
    assert 5 < len(steps) < 2 * whole.attrs["accepted_steps"]
    assert all(
        np.array_equal(run.replay(step).end, end) for step, end in zip(steps, ends, strict=True)
    )


@pytest.mark.long
@pytest.mark.parametrize("spec", SOME, ids=lambda path: path.stem)
def test_steps_of_other_networks_can_be_taken_again(spec):
    run, steps = taped(spec, 0.01, 1e-6)
    ends = [*(step.x for step in steps[1:]), run.x]
    assert all(
        np.array_equal(run.replay(step).end, end) for step, end in zip(steps, ends, strict=True)
    )


def pade(z, stages):
    """Return R(z) of a Gauss method for a matrix z: the diagonal approximant of exp."""
    top = bottom = term = np.eye(len(z))
    for k in range(1, stages + 1):
        part = (stages - k + 1) / (k * (2 * stages - k + 1))
        term = part * term @ z
        top, bottom = top + term, bottom + (-1) ** k * term
    return np.linalg.solve(bottom, top)


@pytest.mark.some(1)
@pytest.mark.parametrize("stages", [1, 2, 3, 4, 5])
def test_a_linear_step_has_the_derivative_of_its_closed_form(stages):
    run, (step, *_) = taped(OSCILLATOR, 1.0, step=0.3, stages=stages)
    found = Derivatives(run, step, run.replay(step))
    names = [record.name for record in run.engine.module.STATES]
    q, p = names.index("q"), names.index("p")
    at, zero = run.parameters, np.zeros(len(names))
    k, m, d = at.k, at.m, at.d
    wanted = pade(step.h * np.array([[0.0, 1 / m], [-k, -d / m]]), stages)
    for column, state in enumerate((q, p)):
        direction = zero.copy()
        direction[state] = 1.0
        end = found.tangent(x=direction).end
        assert np.allclose(end[[q, p]], wanted[:, column], rtol=0, atol=1e-14)


@pytest.mark.some(1)
@pytest.mark.parametrize(
    "spec", ["piezo_stack", *SOME], ids=lambda spec: getattr(spec, "stem", spec)
)
def test_tangents_are_differences_of_steps(spec):
    """Along all at once: states, a parameter, inputs, and the step's length."""
    run, steps = taped(spec, 0.01, 1e-6)
    step = steps[len(steps) // 2]
    solved = run.replay(step)
    found = Derivatives(run, step, solved)
    draw = np.random.default_rng(1)
    x = draw.uniform(-1, 1, step.x.size) * run.scale
    h = 0.3 * step.h
    ends = []
    for e in (1e-4, -1e-4):
        moved = run.replay(replace(step, x=step.x + e * x, h=step.h + e * h))
        ends.append(moved.end)
    u = (run.replay(replace(step, h=step.h + 1e-4 * h)).u - solved.u) / 1e-4
    wanted = (ends[0] - ends[1]) / 2e-4
    slopes = found.tangent(x=x, h=h, u=u)
    size = np.abs(wanted) + run.scale + 1e-300
    assert np.all(np.abs(slopes.end - wanted) <= 1e-5 * size)
    weights = draw.uniform(-1, 1, step.x.size) / (run.scale + 1e-300)
    gradient = found.gradient(weights, x=x, h=h, u=u)
    assert gradient == pytest.approx(weights @ slopes.end, rel=1e-9, abs=1e-12)


def final(inductance, switch=None):
    """Return the end of a run of case P, or when it first crosses a switch."""
    run, steps = taped("piezo_stack", 0.003, 1e-12, inputs=DRIVE, parameters={"L": inductance})
    if switch is None:
        return run.x
    crossed = next(n for n, s in enumerate(steps) if np.any(s.branches != steps[0].branches))
    return steps[crossed].t


def test_sensitivities_along_a_run_are_differences_of_runs():
    """Through kinks, too, where states' sensitivities do not jump."""
    inductance = 1e-3
    run, steps = taped("piezo_stack", 0.003, 1e-12, inputs=DRIVE, parameters={"L": inductance})
    assert any(np.any(s.branches != steps[0].branches) for s in steps)
    by = np.zeros(steps[0].x.size)
    for step in steps:
        by = Derivatives(run, step, run.replay(step)).tangent(x=by, parameters={"L": 1.0}).end
    e = 1e-4 * inductance
    wanted = (final(inductance + e) - final(inductance - e)) / (2 * e)
    assert np.all(np.abs(by - wanted) <= 1e-6 * np.abs(wanted).max() + 1e-5 * np.abs(wanted))


@pytest.mark.long
def test_a_sensitivity_by_the_exponent_of_a_power_is_a_difference_of_runs():
    """Of Bouc-Wen's n, from rest: where the power is zero, so is its slope."""
    slips = next(path for path in SPECS if path.stem == "slips")
    ends = [taped(slips, 0.3, 1e-12, parameters={"n": 1.5 + e})[0].x for e in (1e-4, -1e-4)]
    run, steps = taped(slips, 0.3, 1e-12, parameters={"n": 1.5})
    by = np.zeros(steps[0].x.size)
    for step in steps:
        by = Derivatives(run, step, run.replay(step)).tangent(x=by, parameters={"n": 1.0}).end
    wanted = (ends[0] - ends[1]) / 2e-4
    assert np.abs(wanted).max() > 1e-3
    assert np.all(np.abs(by - wanted) <= 1e-5 * np.abs(wanted).max())


def test_the_time_of_an_event_moves_as_runs_say():
    inductance = 1e-3
    run, steps = taped("piezo_stack", 0.003, 1e-12, inputs=DRIVE, parameters={"L": inductance})
    first = next(n for n, s in enumerate(steps) if np.any(s.branches != steps[0].branches))
    by = np.zeros(steps[0].x.size)
    for step in steps[: first - 1]:
        by = Derivatives(run, step, run.replay(step)).tangent(x=by, parameters={"L": 1.0}).end
    last = steps[first - 1]
    found = Derivatives(run, last, run.replay(last))
    switch = int(np.flatnonzero(steps[first].branches[0] != last.branches[0])[0])
    slope = 2 * np.pi * 100 * 100 * np.cos(2 * np.pi * 100 * (last.t + found.places * last.h))
    changes = slope * [[0.0, 1.0, 0.0]]
    moved = found.event(switch, changes, x=by, parameters={"L": 1.0})
    e = 1e-4 * inductance
    wanted = (final(inductance + e, 0) - final(inductance - e, 0)) / (2 * e)
    assert moved == pytest.approx(wanted, rel=1e-4)
