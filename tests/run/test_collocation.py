"""Collocation: order 2s, both balances to round-off at every sample, kinks located.

References: the module's own rates and Jacobian, SciPy's DOP853 at 1e-13, a closed form, and for
case P the state that three solvers agree on.
"""

import re
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from piezo_sym import sine
from piezo_sym.errors import RunError, UsageError
from tests.run.collocations import Steps, prepared, residuals, through
from tests.run.test_run_edge import LEAK

SPECS = Path(__file__).parents[1] / "networks" / "specs"
ALL = ["piezo_stack", *sorted(SPECS.glob("*.toml"))]
NAMES = [Path(spec).stem for spec in ALL]
CASE_P = {"inputs": {"V_in": sine(100, 100)}}
ANSWER = [-9.523507638450e-04, 3.453828489837e-03, -3.900998920056e-05]
ANSWER += [5.224415297332e-03, 5.224415297332e-03, 1.341141665114e-01]
SCALES = np.array([2e-3, 5e-3, 5e-4, 6e-3, 6e-3, 5e-2])
#: Smooth systems: (spec, duration, steps of the coarsest run, options).
SMOOTH = [
    (SPECS / "a2_oscillator.toml", 5.0, 10, {}),
    (SPECS / "a5_thermistor.toml", 2e-3, 80, {}),
    ("piezo_stack", 1e-2, 60, {"parameters": {"i_0": 0.0}, **CASE_P}),
]


def moved(system, x):
    """Return a state with every entry moved; entropies by a part of what a kelvin needs."""
    by = 1e-3 * np.random.default_rng(7).uniform(0.5, 1.0, x.size)
    for record, rows in zip(system.module.STATES, system.rows(system.module.STATES), strict=True):
        by[rows] *= 1e-3 if record.unit == "J/K" else 1.0
    return x + by


#: Two banks, a border, and the paper's actuator by every number of stages; the others by three.
STAGES = [(spec, 3) for spec in ALL]
STAGES += [
    (spec, stages)
    for spec in ("piezo_stack", SPECS / "output_resistance_of_a_bank.toml")
    for stages in (1, 2, 4, 5)
]


@pytest.mark.some(1)
@pytest.mark.parametrize(
    ("spec", "stages"), STAGES, ids=[f"{Path(spec).stem}-{stages}" for spec, stages in STAGES]
)
def test_a_short_step_goes_where_the_rates_lead(spec, stages):
    """One step of a thousandth of the fastest time constant, against another solver."""
    system, x = prepared(spec)
    x = moved(system, x)
    u, p, m = system.inputs.segments[0].at(0.0), system.parameters, system.module
    h = 1e-3 / max(np.linalg.norm(m.jacobian(x, u, p), np.inf), 1.0)
    steps = Steps(system, x, stages, h)
    assert steps.take(1)
    found = solve_ivp(
        lambda _, y: m.rhs(y, u, p), (0.0, steps.t), x, method="DOP853", rtol=1e-13, atol=1e-18
    )
    moved_by = np.abs(found.y[:, -1] - x).max()
    error = np.abs(steps.x - found.y[:, -1]).max()
    assert error <= 1e-13 * np.abs(x).max() + (1e-6 if stages == 1 else 1e-9) * moved_by


@pytest.mark.some(2)
@pytest.mark.parametrize(
    "spec", [s for s in ALL if Path(s).stem != "dry_friction"], ids=lambda spec: Path(spec).stem
)
def test_newtons_method_has_the_right_matrix(spec):
    """A step of a part of the fastest time constant: with a wrong entry it would take a dozen."""
    system, x = prepared(spec)
    x = moved(system, x)
    u, p, m = system.inputs.segments[0].at(0.0), system.parameters, system.module
    steps = Steps(system, x, 3, 0.25 / max(np.linalg.norm(m.jacobian(x, u, p), np.inf), 1.0))
    assert steps.take(1)
    assert steps.iterations <= 8


def ends(spec, duration, counts, stages, options):
    """Return the states after runs of equal steps."""
    system, x = prepared(spec, duration, **options)
    for count in counts:
        steps = Steps(system, x, stages, duration / count)
        assert steps.finish()
        yield steps.x


@pytest.mark.some(1)
@pytest.mark.parametrize("stages", [pytest.param(1, marks=pytest.mark.long), 2, 3])
@pytest.mark.parametrize(
    ("spec", "duration", "count", "options"), SMOOTH, ids=[Path(row[0]).stem for row in SMOOTH]
)
def test_order_is_twice_the_stages(spec, duration, count, options, stages):
    counts = [count, 2 * count, 4 * count]
    (wanted,) = ends(spec, duration, [16 * count], 5, options)
    errors = [
        np.linalg.norm((x - wanted) / (np.abs(wanted) + 1e-6 * np.abs(wanted).max()))
        for x in ends(spec, duration, counts, stages, options)
    ]
    kept = [e for e in errors if e > 1e-12]
    orders = -np.diff(np.log2(kept))
    assert kept == [] or errors[-1] <= 1e-12 or orders[-1] >= 2 * stages - 0.3


@pytest.mark.some(4)
@pytest.mark.parametrize("stages", [3, 5])
@pytest.mark.parametrize("rtol", [1e-3, 1e-5, 1e-7, 1e-9])
def test_case_p_is_as_accurate_as_asked(rtol, stages):
    system, found = through("piezo_stack", 0.1, 101, rtol=rtol, stages=stages, **CASE_P)
    error = np.max(np.abs(found.states[:, -1] - ANSWER) / SCALES)
    assert error <= 10 * rtol
    energy, entropy, produced = residuals(system, found)
    assert np.abs(energy).max() <= 1e-12
    assert np.abs(entropy).max() <= 1e-15
    assert np.diff(produced, axis=1).min() >= 0


@pytest.mark.some(4)
@pytest.mark.parametrize("spec", ALL, ids=NAMES)
def test_balances_close_at_every_sample(spec):
    duration = {"a5_thermistor": 2e-3, "a10_maxwell_slip": 1e-2}.get(Path(spec).stem, 0.05)
    system, found = through(spec, duration, 33, rtol=1e-5)
    energy, entropy, produced = residuals(system, found)
    p, m = system.parameters, system.module
    size = np.abs(m.energy(found.states, p)).max() + np.abs(found.integrals).max()
    assert np.abs(energy).max() <= 1e-14 * size
    assert np.abs(entropy).max() <= 1e-14 * (np.abs(m.entropy(found.states, p)).max() + 1e-3)
    assert np.all(np.diff(produced, axis=1) >= 0)


def test_a_function_is_asked_for_its_times():
    wave = sine(100, 100)
    _, known = through("piezo_stack", 0.02, 21, inputs={"V_in": wave})
    _, asked = through("piezo_stack", 0.02, 21, inputs={"V_in": lambda t: float(wave(t))})
    assert np.abs((asked.states - known.states) / SCALES[:, None]).max() <= 1e-5


def test_what_a_function_raises_is_raised():
    with pytest.raises(UsageError, match=r"the function fails at t = .* ZeroDivisionError"):
        through("piezo_stack", 0.02, inputs={"V_in": lambda t: 1.0 if t < 0.011 else 1 / 0})


def test_a_run_that_leaves_the_domain_says_when(tmp_path):
    """C dT/dt = lam (T_e - T): the time is known in closed form."""
    (tmp_path / "leak.toml").write_text(LEAK)
    start = 296.15 * np.exp(0.03 / 5)
    known = 5 / 2 * np.log((start - 290) / (296.15 - 290))
    with pytest.raises(RunError) as error:
        through(tmp_path / "leak.toml", 20.0)
    assert float(re.search(r"t = ([\d.]+) s", str(error.value))[1]) == pytest.approx(
        known, rel=1e-5
    )
