"""Path functionals: stops, exact along a step, close balances and follow the stop operator."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from piezo_sym import sine
from piezo_sym.run.collocation import FixedStep, collocate
from piezo_sym.run.engine.batch import Batch, Stepping
from piezo_sym.run.engine.engine import engine_of
from piezo_sym.run.inputs import read_inputs
from piezo_sym.run.parameters import read_parameters
from piezo_sym.run.simulate import simulate
from piezo_sym.run.system import DrivenModule

from .c_compilers import COMPILERS
from .hand_made_stops import LED, LIMIT, MASS, MAXWELL, RATIOS, RUBBING, SLIPS, STIFF
from .test_c_text import STRICT, called
from .test_step_alone import Alone
from .tiers import tiers

WAYS = [{"rtol": r} for r in (1e-4, 1e-6, 1e-9)] + [{"step": 5e-3, "order": n} for n in (2, 4, 6)]


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Models by their names."""
    models = (MASS, MAXWELL, LED, RUBBING)
    return {one.name: one.module(tmp_path_factory.mktemp(one.name)) for one in models}


def check_balances(run, process):
    energy = run.energy.values
    scale = np.ptp(energy) + np.abs(run.supplied_pull.values).max()
    assert np.abs(run.energy_residual).max() <= 1e-12 * scale + 4 * np.spacing(energy.max())
    assert np.abs(run.entropy_residual).max() <= 1e-12 * np.abs(run.S).max()
    produced = run[f"produced_{process}"].values
    # with a tolerance a sample ends a step of its own, which is as exact as asked for
    rounding = 1e-3 * run.attrs.get("rtol", 0.0) * produced.max()
    assert np.diff(produced, axis=0).min() >= -rounding
    assert np.all(produced[-1] > 0)


@pytest.mark.some(1)
@pytest.mark.parametrize("way", tiers(WAYS, 1, 5), ids=str)
@pytest.mark.parametrize("name", ["stopped", "maxwell", "rubbing"])
def test_balances_close(made, name, way):
    model = {"stopped": "stop", "maxwell": "slips", "rubbing": "rub"}
    run = simulate(made[name], duration=0.5, inputs={"F": sine(15.0, 6.0)}, times=40, **way)
    check_balances(run, model[name])
    assert run.attrs["newton_iterations"] < 15 * run.attrs["accepted_steps"]


def stop_operator(places, r, z=0.0):
    """Return z of a stop at places that a coordinate goes to without a turn between."""
    found = [z]
    for step in np.diff(places):
        found.append(np.clip(found[-1] + step, -r, r))
    return np.array(found)


@pytest.mark.parametrize("order", tiers([4, 6, 10], 1))
def test_a_stop_that_is_led_follows_the_stop_operator(made, order):
    """Rates are joined by straight lines: each step has a turn, at a time that is known."""
    rng = np.random.default_rng(order)
    t, v = np.arange(21) * 0.1, 0.2 * rng.uniform(0.1, 1.0, 21) * (-1.0) ** np.arange(21)
    turns = t[:-1] - v[:-1] * 0.1 / np.diff(v)
    times = np.sort([*t, *turns])
    gone = np.diff(times) * (np.interp(times[1:], t, v) + np.interp(times[:-1], t, v)) / 2
    run = simulate(made["led"], duration=2.0, inputs={"v": (t, v)}, step=0.1, order=order, times=t)
    assert run.attrs["accepted_steps"] == 20
    for lane, ratio in enumerate(RATIOS):
        wanted = stop_operator(ratio * np.cumsum([0.0, *gone]), LIMIT)[::2]
        assert np.abs(run.z.values[:, lane] - wanted).max() <= 1e-12 * LIMIT
        assert np.abs(wanted).max() == LIMIT
    work = np.abs(run.supplied_drive.values).max()
    assert np.abs(run.energy_residual).max() <= 1e-12 * work + 4 * np.spacing(240.0)


@pytest.mark.long
@pytest.mark.parametrize("r", [LIMIT, 4e-3, 1.0])
def test_a_large_cycle_costs_what_is_known(made, r):
    """4 F_c (X - F_c/k) a cycle, and nothing where the limit is not reached."""
    t = np.array([0.0, 0.5, 1.5, 2.5, 3.5, 4.5])
    v = 0.04 * np.array([0.0, 1.0, -1.0, 1.0, -1.0, 1.0])
    turns = np.array([0.0, 1.0, 2.0, 3.0, 4.0])
    run = simulate(
        made["led"],
        duration=4.5,
        inputs={"v": (t, v)},
        times=turns,
        step=0.25,
        order=4,
        parameters={"r": r},
    )
    X = np.ptp(run.q.values[1:], axis=0) / 2
    wanted = 4 * STIFF * r * np.maximum(X - r, 0.0)
    assert run.heat_stop.values[4] - run.heat_stop.values[2] == pytest.approx(wanted, rel=1e-12)


def force(t):
    return 20.0 * np.sin(2 * np.pi * 7.0 * t)


def by_events(times):
    """Return q and z of the mass by SciPy, from bend to bend: between these the law is linear."""
    p = MASS.parameters

    def rates(t, x, yields):
        q, speed, z = x
        total = force(t) - p["k"] * q - p["d"] * speed - p["k_s"] * z
        return [speed, total / p["m"], 0.0 if yields else speed]

    def bend(_t, x, yields):
        return x[1] * np.sign(x[2]) if yields else LIMIT - abs(x[2])

    bend.terminal, bend.direction = True, -1
    accuracy = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-16, "max_step": 2e-3}
    begin, x, yields, found = times[0], [0.0, 0.0, 0.0], False, [np.zeros(2)]
    while begin < times[-1]:
        span = begin, times[-1]
        one = solve_ivp(rates, span, x, args=(yields,), events=bend, dense_output=True, **accuracy)
        inside = times[(times > begin) & (times <= one.t[-1])]
        found += [one.sol(t)[[0, 2]] for t in inside]
        begin, x, yields = one.t[-1], one.y[:, -1], not yields
        x[2] = np.clip(x[2], -LIMIT, LIMIT)
    return np.array(found)


@pytest.mark.parametrize("rtol", tiers([1e-4, 1e-6, 1e-8, 1e-10], 1, 3))
def test_a_mass_moves_as_events_say(made, rtol):
    times, inputs = np.linspace(0.0, 0.5, 37), {"F": sine(20.0, 7.0)}
    run = simulate(made["stopped"], duration=0.5, inputs=inputs, times=times, rtol=rtol)
    wanted = by_events(times)
    for n, name in enumerate("qz"):
        size = np.abs(wanted[:, n]).max()
        assert np.abs(run[name].values - wanted[:, n]).max() <= 10 * rtol * size
    assert run.attrs["accepted_steps"] < 200
    assert run.attrs["newton_iterations"] < 15 * run.attrs["accepted_steps"]


def test_fixed_steps_over_bends_converge(made):
    times, errors = np.array([0.0, 0.3]), []
    wanted = by_events(times)[-1, 0]
    for step in (2e-3, 5e-4):
        how = {"step": step, "order": 4, "times": times}
        run = simulate(made["stopped"], duration=0.3, inputs={"F": sine(20.0, 7.0)}, **how)
        errors.append(abs(run.q.values[-1] - wanted))
    assert errors[1] < errors[0] / 10
    assert errors[1] < 1e-5 * np.abs(wanted)


def test_lanes_do_what_single_stops_do(made):
    """Each of them follows its own operator of the coordinate that all share."""
    parameters = {"a": 0.0}
    how = {"step": 2e-3, "order": 6, "parameters": parameters}
    run = simulate(made["maxwell"], duration=0.5, inputs={"F": sine(15.0, 6.0)}, **how)
    fine = {"step": 2e-3 / 64, "order": 6, "parameters": parameters}
    whole = simulate(made["maxwell"], duration=0.5, inputs={"F": sine(15.0, 6.0)}, **fine)
    for lane, r in enumerate(SLIPS):
        wanted = stop_operator(whole.q.values, r)
        assert whole.z.values[-1, lane] == pytest.approx(wanted[-1], abs=1e-4 * r)
    assert np.abs(run.z - whole.z.interp(time=run.time)).max() < 1e-2 * SLIPS[-1]


def batch(module, count):
    """Return runs of a bank of so many stops, that differ in stiffness."""
    limits = np.geomspace(1e-4, 1e-2, count)
    systems = []
    for factor in np.linspace(0.8, 1.2, 5):
        given = {"slip_count": count, "r": limits.tolist(), "k_s": (3200 * factor / count)}
        inputs = read_inputs(module, {"F": sine(15.0, 6.0)}, 0.2)
        systems.append(DrivenModule(module, read_parameters(module, given), inputs))
    x = np.array([[0.0, 0.0, *[0.0] * count, 0.01]] * 5)
    return systems, engine_of(module), x, np.linspace(0.0, 0.2, 5)


@pytest.mark.parametrize("count", tiers([8, 40], 0))
@pytest.mark.parametrize("how", tiers([1e-5, FixedStep(2e-3, 4)], 0))
def test_runs_beside_others_have_the_numbers_that_they_have_alone(made, count, how):
    """In vectors of runs, and, where banks are large, of lanes."""
    given = batch(made["maxwell"], count)

    def runs(together):
        return collocate(*given, how, side_by_side=together)

    alone, together = runs(False), runs(True)
    assert alone.errors == together.errors == (None,) * 5
    assert np.array_equal(alone.states, together.states)
    assert np.array_equal(alone.sums, together.sums)
    assert np.ptp(alone.states[:, -1, 0]) > 0


def test_what_a_step_keeps_grows_with_the_lanes(made):
    sizes = []
    for count in (8, 16, 24):
        systems, engine, x, times = batch(made["maxwell"], count)
        stepping = Stepping(3, 1e-6, 1e-3, 1e-2)
        parameters = [system.parameters for system in systems]
        inputs = systems[0].inputs
        one = Batch(engine, parameters, x, inputs, times, stepping, "one")
        sizes.append(one._space.size)
    assert sizes[2] - sizes[1] == sizes[1] - sizes[0] > 0


def test_stops_that_are_nearly_rigid_need_few_iterations(made):
    """Their stiffness is h**2 k_s/m = 150: Newton's method has to know of it."""
    run = simulate(
        made["stopped"],
        duration=0.5,
        inputs={"F": sine(20.0, 7.0)},
        step=5e-3,
        order=4,
        parameters={"k_s": 3e6, "r": 4e-6},
    )
    assert run.attrs["halvings"] == 0
    assert run.attrs["newton_iterations"] <= 15 * run.attrs["accepted_steps"]
    assert run.heat_stop.values[-1] > 0.1


@pytest.mark.long
def test_a_dissipative_start_takes_stops_too(made):
    """With efforts of a step's end: a stop that just yields is as one that just does not."""

    def heats(r, steps):
        how = {"step": 2e-2, "times": steps + 1, "dissipative_start": True}
        given = {"inputs": {"F": 15.0}, "parameters": {"r": r}, **how}
        return simulate(made["stopped"], duration=2e-2 * steps, **given)

    run = heats(5e-4, 10)
    check_balances(run, "stop")
    assert np.all(np.diff(run.heat_numerical.values) >= 0)
    free = heats(1.0, 1)
    for part in (1 + 1e-7, 1 - 1e-7):
        run = heats(np.abs(free.z.values[-1]) * part, 1)
        wanted = float(free.heat_numerical[-1])
        assert float(run.heat_numerical[-1]) == pytest.approx(wanted, rel=1e-5)


def test_a_step_in_c_alone_takes_stops_too(made, tmp_path):
    module, h = made["stopped"], 2e-3
    step, x = Alone(module, tmp_path), np.array([0.0, 0.0, 0.0, 0.01])
    source = module.__file__.replace(".py", "_step.c")
    for command in COMPILERS.values():
        assert called([*command, *STRICT, "-c", source], tmp_path) == ""
    for _ in range(100):
        assert step(x, np.array([10.0]), h)
    run = simulate(module, duration=100 * h, inputs={"F": 10.0}, step=h, times=2)
    for value, name in zip(x, ("q", "p", "z", "S"), strict=True):
        assert value == pytest.approx(run[name].values[-1], rel=1e-10, abs=1e-13)
    assert abs(x[2]) == pytest.approx(LIMIT, rel=0.5)
