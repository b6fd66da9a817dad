"""Dissipative starts: less ringing after a jump, both balances exact, their loss booked."""

from pathlib import Path

import numpy as np
import pytest

from piezo_sym import load, simulate, sine, step, sweep
from piezo_sym.errors import UsageError
from piezo_sym.modules import module_of
from piezo_sym.run.collocation import FixedStep, collocate
from piezo_sym.run.engine.engine import engine_of
from piezo_sym.run.inputs import read_inputs
from piezo_sym.run.system import DrivenModule
from piezo_sym.spec.load import parse

SPECS = sorted((Path(__file__).parents[1] / "networks" / "specs").glob("*.toml"))
SCALES = {"q": 2e-3, "p": 5e-3, "Q_C": 5e-4, "phi": 6e-3, "S": 5e-2}
JUMP = {"V_in": 100.0}


def run(model="piezo_stack", **options):
    given = {"duration": 2e-3, "method": "discrete_gradient", "dissipative_start": True}
    return simulate(model, **{**given, **options})


def error(found, wanted):
    return max(
        np.max(np.abs(found[name].values[-1] - wanted[name].values[-1])) / SCALES[name]
        for name in SCALES
    )


@pytest.fixture(scope="module")
def exact():
    """What DOP853 says 2 ms after a jump of the voltage; it shares no step with the engine."""
    return simulate("piezo_stack", inputs=JUMP, duration=2e-3, rtol=1e-12, method="DOP853", times=2)


@pytest.mark.parametrize(
    ("h", "without", "within"), [(2e-4, 1.1e-2, 1.3e-4), (1e-4, 2.8e-4, 3.8e-5), (5e-6, 7e-7, 4e-6)]
)
def test_errors_after_a_jump_are_those_of_the_prototype(exact, h, without, within):
    plain = run(inputs=JUMP, step=h, times=2, dissipative_start=False)
    start = run(inputs=JUMP, step=h, times=2)
    assert without / 2 < error(plain, exact) < 2 * without
    assert within / 2 < error(start, exact) < 2 * within


def closes(found):
    energy = np.abs(found.energy.values).max()
    gross = sum(np.abs(found[n].values).max() for n in found if n.startswith("supplied_"))
    bound = 1e-12 * (np.ptp(found.energy.values) + gross) + 200 * np.spacing(energy)
    assert np.all(np.abs(found.energy_residual) <= bound)
    for name in found.data_vars:
        if name.startswith("produced_"):
            assert np.all(np.diff(found[name].values, axis=0) >= 0)


@pytest.mark.parametrize("options", [{"step": 1e-4}, {"step": 1e-5}])
def test_energy_is_exact_and_the_loss_closes_the_entropy_balance(options):
    inputs = {"V_in": step(0.0113, -30.0, 100.0)}
    found = run(inputs=inputs, duration=0.02, times=101, parameters={"lam": 0.0}, **options)
    closes(found)
    assert float(found.heat_numerical[-1]) > 1e-9
    produced = sum(
        found[n].sum([d for d in found[n].dims if d != "time"])
        for n in found
        if n.startswith("produced_")
    )
    gained = found.entropy - found.entropy[0]
    assert np.allclose(gained, produced, rtol=1e-12, atol=1e-15)


def test_only_jumps_lose_anything():
    corners = (np.array([0.0, 0.005, 0.01, 0.015, 0.02]), np.array([0.0, 40.0, -20.0, 60.0, 60.0]))
    inputs = {"V_in": corners, "F_ext": step(0.0125, 0.0, 50.0)}
    found = run(inputs=inputs, duration=0.02, step=1e-4, times=201)
    losses = np.diff(found.heat_numerical.values)
    assert np.flatnonzero(losses).tolist() == [0, 125]
    assert np.all(losses[[0, 125]] > 0)


def test_a_moving_input_that_jumps_is_followed():
    given = {"inputs": {"V_in": sine(100, 100, phase=np.pi / 4)}, "duration": 1e-3, "times": 2}
    wanted = simulate("piezo_stack", rtol=1e-12, method="DOP853", **given)
    errors = [error(run(step=2e-4, dissipative_start=on, **given), wanted) for on in (False, True)]
    assert errors[1] < errors[0] / 5


def test_long_steps_no_longer_ring_after_a_jump():
    given = {"inputs": {"V_in": step(0.01, 0.0, 100.0)}, "duration": 0.0118, "times": 60}
    wanted = simulate("piezo_stack", rtol=1e-10, method="DOP853", **given)
    rings = [
        float(np.abs(run(step=2e-4, dissipative_start=on, **given).p - wanted.p)[55:].max())
        for on in (False, True)
    ]
    assert rings[1] < rings[0] / 10


def ledger(model, h, duration, **inputs):
    """Return states and ledgers at the samples of a run, straight from the engine, and both sums.

    Entropy: what was gained, and what processes, exchanges and losses brought.
    """
    module = module_of(model)
    p = module.Parameters()
    system = DrivenModule(module, p, read_inputs(module, inputs, duration))
    x = module.initial_state(system.inputs.segments[0].at(0.0), p)
    times = np.linspace(0.0, duration, 5)
    runs = collocate([system], engine_of(module), x[None], times, FixedStep(h), starts=True)
    assert runs.errors == (None,)
    sums, states = runs.sums[0], runs.states[0]
    ports = len(module.OUTPUTS)
    processes = sum(part.stop - part.start for part in system.rows(module.PROCESSES))
    booked = ports + 2 * processes
    produced, numerical = sums[:, ports + processes : booked], sums[:, -1]
    exchanged, supplied = sums[:, booked:-2], sums[:, :ports].sum(axis=1)
    gained = module.energy(states.T, p) - module.energy(x, p)
    entropy = module.entropy(states.T, p) - module.entropy(x, p)
    brought = produced.sum(axis=1) + exchanged.sum(axis=1) + numerical
    size = np.abs(module.energy(states.T, p)).max() + np.abs(sums[:, :ports]).max(initial=0)
    assert np.abs(gained - supplied).max() <= 1e-13 * size
    assert np.abs(entropy - brought).max() <= 1e-13 * (1e-3 + np.abs(brought).max())
    assert np.all(np.diff(produced, axis=0) >= 0)
    assert np.all(np.diff(numerical) >= 0)
    return states, numerical


def test_members_of_a_batch_start_as_they_do_alone():
    module = module_of("piezo_stack")
    inputs = read_inputs(module, {"V_in": step(3e-4, 0.0, 100.0)}, 2e-3)
    systems = [DrivenModule(module, module.Parameters(L=L), inputs) for L in (1e-3, 5e-4, 2e-3)]
    x = module.initial_state(inputs.segments[0].at(0.0), systems[0].parameters)
    times = np.linspace(0.0, 2e-3, 5)
    engine = engine_of(module)
    together = collocate(systems, engine, np.tile(x, (3, 1)), times, FixedStep(1e-4), starts=True)
    for k, system in enumerate(systems):
        alone = collocate([system], engine, x[None], times, FixedStep(1e-4), starts=True)
        one, other = together.trajectory(k), alone.trajectory(0)
        assert np.array_equal(one.states, other.states)
        assert np.all(np.diff(one.numerical, axis=1)[:, 1:] >= 0)
        assert one.numerical[0, -1] > 0


STORES = {"spring", "mass", "capacitor", "inductor", "hysteron"}


def lossy(model):
    kinds = {element.kind for element in model.elements.values()}
    return bool(kinds & STORES) and "thermal_mass" in kinds


@pytest.mark.some(1)
@pytest.mark.parametrize("path", [p for p in SPECS if lossy(load(p))], ids=lambda path: path.stem)
@pytest.mark.parametrize("h", [1e-6, 1e-4])
def test_every_network_closes_both_balances_after_a_jump(path, h):
    model = load(path)
    first = next((name for name, entry in model.inputs.items() if entry.unit != "K"), None)
    inputs = {first: step(11.5 * h, 0.0, 3.0)} if first else {}
    _, numerical = ledger(model, h, 40 * h, **inputs)
    assert numerical[-1] >= numerical[0] == 0.0


@pytest.mark.long
@pytest.mark.parametrize("stiffness", ["k*(1 + (q/l)**2)", "k*(1 + (q/l)**2)**4"])
def test_a_spring_that_grows_stiff_loses_too(tmp_path, stiffness):
    states, numerical = ledger(written(tmp_path, stiffness), 0.05, 2.0)
    assert numerical[1] > 0
    assert np.ptp(states[:, 0]) > 0.5


def test_where_energy_is_not_convex_a_quarter_is_an_ordinary_step(tmp_path):
    model = written(tmp_path, "k*(1 - 1.9*q/l + (q/l)**2)", start="q = 0.45\np = 6.0")
    states, numerical = ledger(model, 0.05, 0.5)
    assert np.all(np.isfinite(states))
    assert np.all(numerical == 0)


def written(folder, stiffness, start="q = 1.0"):
    """Return A2's oscillator with a spring of this stiffness."""
    text = SPECS[0].with_name("a2_oscillator.toml").read_text(encoding="utf-8")
    changes = {
        'stiffness = "k"': f'stiffness = "{stiffness}"',
        "[parameters]": '[parameters]\nl = { value = 1.0, unit = "m" }',
        "q = 1.0": start,
        'assume = ["d >= 0"]': 'assume = ["d >= 0", "l > 0"]',
    }
    for old, new in changes.items():
        assert text.count(old) == 1
        text = text.replace(old, new)
    path = folder / "oscillator.toml"
    path.write_text(text, encoding="utf-8")
    return load(path)


@pytest.mark.parametrize(
    "path", [p for p in SPECS if not lossy(load(p))], ids=lambda path: path.stem
)
def test_a_model_without_a_store_or_a_body_is_refused(path):
    with pytest.raises(
        UsageError, match=f"'{load(path).name}' has no thermal_mass .*, or no storage"
    ):
        run(load(path), duration=1e-3)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"method": "Radau"}, "method Radau has no dissipative start"),
        ({"dissipative_start": "yes"}, "'yes' is no truth value"),
        ({"rtol": 1e-5}, "a run with a tolerance follows what a jump sets off"),
    ],
)
def test_refusals(options, words):
    with pytest.raises(UsageError, match=words):
        run(**options)


SLIP = """
[model]
name = "slip"
[parameters]
k = { value = 2.77, unit = "N/m" }
l = { value = 1.0, unit = "m" }
r = { value = 0.5, unit = "m/N**2/s" }
C = { value = 1.0, unit = "F" }
T_0 = { value = 1.0, unit = "K" }
c = { value = 1.0, unit = "J/K" }
[inputs]
I = { unit = "A" }
[domain]
assume = ["T_spare > T_0", "T_body > T_0", "r > 0", "l > 0"]
[initial]
S_spare = 0.3
S_body = 0.6
q_spring = -1.45
[elements]
spare = { kind = "thermal_mass", temperature = "T_0*exp(S/c)" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)" }
spring = { kind = "spring", between = ["tip", "wall"], stiffness = "k*(1 + q**2/l**2)" }
slip = { kind = "damper", between = ["tip", "wall"], velocity = "r*f*abs(f)", heats = "body" }
feed = { kind = "current_source", between = ["gnd", "e"], input = "I" }
store = { kind = "capacitor", between = ["e", "gnd"], capacitance = "C" }
"""


@pytest.mark.long
@pytest.mark.parametrize("h", [0.01, 0.005])
def test_a_state_that_stands_still_again_does_not_end_the_iteration_of_others(h):
    """A start's loss heats `spare`, which nothing heats later; both steps after it are exact."""
    found = run(parse(SLIP), duration=20 * h, step=h)
    spare = found.S_spare.values
    assert spare[1] > spare[0]
    assert spare[1] == spare[-1]
    assert np.abs(found.energy_residual).max() <= 1e-14 * found.energy.max()


def test_nor_does_a_charge_whose_source_stops_in_vectors():
    feed, springs = {"I": step(0.03, 1e-3, 0.0)}, {"k": np.linspace(0.5, 20, 64)}
    found = sweep(parse(SLIP), over=springs, inputs=feed, duration=0.2, step=0.01)
    assert np.all(np.abs(found.energy_residual) <= 1e-14 * found.energy.max("time"))


@pytest.mark.some(3)
@pytest.mark.parametrize("rtol", [1e-5, 1e-9])
@pytest.mark.parametrize("duration", [0.5, 10.0, 1e4])
def test_a_model_at_rest_is_not_resolved_below_round_off(duration, rtol):
    """The Seebeck voltages of 15 V cancel but for 1 ulp, and the temperatures change by 1 ulp."""
    run = simulate("peltier_cooler", duration=duration, rtol=rtol, times=11)
    assert run.attrs["accepted_steps"] < 200
    assert np.abs(run.phi).max() < 1e-3 * 15.0 / 2.0 * 1e-12  # L I, with I = 1e-12 of V/R
    assert max(np.abs(run.S_c).max(), np.abs(run.S_h).max()) < 1e-12 * 200.0
    assert np.abs(run.energy_residual).max() < 1e-12 * float(run.energy[0])
