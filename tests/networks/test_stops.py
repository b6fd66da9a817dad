"""Stops: exact along the path of a step, against the stop operator, and what is refused."""

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from piezo_sym import derive, simulate, sine, verify
from piezo_sym.errors import NetworkError, SpecError
from piezo_sym.modules import module_of
from piezo_sym.proofs import Verdict
from piezo_sym.run.engine.batch import Batch
from piezo_sym.spec.load import parse
from piezo_sym.verification import process

#: Those who run a model and those who look at its rows need the same report.
pytestmark = pytest.mark.usefixtures("known_reports")

HEAD = """
[model]
name = "{name}"
[parameters]
m   = {{ value = 0.5,    unit = "kg" }}
L   = {{ value = 0.1,    unit = "H" }}
k   = {{ value = 3000.0, unit = "N/m" }}
C   = {{ value = 1e-3,   unit = "F" }}
d   = {{ value = 2.0,    unit = "N*s/m" }}
V_c = {{ value = 3.0,    unit = "V" }}
F_c = {{ value = {limits}, unit = "N" }}
T_0 = {{ value = 300.0,  unit = "K" }}
c   = {{ value = 0.8,    unit = "J/K" }}
[inputs]
{input} = {{ unit = "{unit}" }}
[elements]
body = {{ kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }}
"""
LIMITS = (3.0, 6.0, 12.0, 24.0, 48.0)
STOP = 'stop = {{ kind = "stop", between = ["a", "wall"], {}, heats = "body", state = "z" }}\n'
BANK = STOP.format('count = 5, stiffness = "k", limit = "F_c"')
LED = 'lead = { kind = "velocity_source", at = "a", input = "v" }\n' + BANK
MASS = (
    'push = { kind = "force_source", at = "a", input = "F" }\n'
    'block = { kind = "mass", at = "a", mass = "m", state = "p" }\n'
) + STOP.format('stiffness = "k", limit = "F_c"')
BLOCK = MASS.replace('stiffness = "k"', 'count = 5, stiffness = "k"')
COIL = (
    'feed = { kind = "voltage_source", between = ["a", "gnd"], input = "V" }\n'
    'coil = { kind = "inductor", between = ["a", "b"], inductance = "L", state = "phi" }\n'
    'stop = { kind = "stop", between = ["b", "gnd"], capacitance = "C", limit = "V_c",'
    ' heats = "body", state = "z" }\n'
)
#: Capacitors in series, Goldfarb and Celanovic's: they share the charge.
CHARGED = (
    'lead = { kind = "current_source", between = ["a", "gnd"], input = "i" }\n'
    'stop = { kind = "stop", between = ["a", "gnd"], count = 5, capacitance = "C", limit = "F_c",'
    ' heats = "body", state = "z" }\n'
)


@cache
def model(name):
    elements, limits, driven = {
        "led": (LED, list(LIMITS), ("v", "m/s")),
        "mass": (MASS, 3.0, ("F", "N")),
        "coil": (COIL, 3.0, ("V", "V")),
        "charged": (CHARGED, list(LIMITS), ("i", "A")),
        "block": (BLOCK, list(LIMITS), ("F", "N")),
    }[name]
    names = {"name": f"stop_{name}", "limits": limits, "input": driven[0], "unit": driven[1]}
    head = (
        HEAD.replace('{limits}, unit = "N"', '{limits}, unit = "V"') if name == "charged" else HEAD
    )
    return parse(head.format(**names) + elements)


def stop_operator(path, r, z=0.0):
    """Return z of a stop at places of its coordinate, between which it does not turn."""
    found = [z]
    for step in np.diff(path):
        found.append(np.clip(found[-1] + step, -r, r))
    return np.array(found)


def balanced(run):
    energy = run.energy.values
    put_in = next(name for name in run if name.startswith("supplied_"))
    scale = np.ptp(energy) + np.abs(run[put_in].values).max()
    assert np.abs(run.energy_residual).max() <= 1e-12 * scale + 4 * np.spacing(energy.max())
    assert np.abs(run.entropy_residual).max() <= 1e-12 * np.abs(run.S).max()
    assert np.diff(run.heat_stop.values, axis=0).min() >= 0


@pytest.mark.some(2)
@pytest.mark.parametrize("name", ["led", "mass", "coil", "charged"])
def test_every_row_is_proved(name):
    rows = {(row.id, row.element): row.verdict for row in process.examined(model(name)).rows}
    assert rows["passive", "stop"] is rows["rate-independent", "stop"] is Verdict.PROVED
    assert set(rows.values()) == {Verdict.PROVED}


def led(t, speeds, name="led", **how):
    (given,) = model(name).inputs
    return simulate(model(name), inputs={given: (t, speeds)}, duration=t[-1], **how)


@pytest.mark.some(1)
@pytest.mark.parametrize(("name", "size"), [("led", 3000.0), ("charged", 1e3)])
@settings(max_examples=8)
@given(
    speeds=st.lists(st.floats(-1.0, 1.0), min_size=4, max_size=12),
    order=st.sampled_from([4, 6, 10]),
)
def test_a_stop_that_is_led_is_the_stop_operator(name, size, speeds, order):
    """Speeds are joined by straight lines: steps have turns inside, at times that are known.

    A step of order 2 goes along a straight line, in which there is no turn.
    """
    t, v = 0.05 * np.arange(len(speeds)), np.array(speeds)
    with np.errstate(divide="ignore", invalid="ignore"):
        turns = t[:-1] - v[:-1] * 0.05 / np.diff(v)
    inside = turns[(turns > t[:-1]) & (turns < t[1:])]
    times = np.union1d(t, inside)
    gone = np.diff(times) * (np.interp(times[1:], t, v) + np.interp(times[:-1], t, v)) / 2
    run = led(t, v, name, step=0.05, order=order, times=t)
    for lane, F_c in enumerate(LIMITS):
        wanted = stop_operator(np.cumsum([0.0, *gone]), F_c / size)[np.isin(times, t)]
        assert np.abs(run.z.values[:, lane] - wanted).max() <= 1e-12
    balanced(run)


def test_a_cycle_dissipates_what_is_known():
    """4 F_c (X - F_c/k) a cycle, and nothing where the limit is not reached."""
    t = np.array([0.0, 0.5, 1.5, 2.5, 3.5, 4.5])
    run = led(t, 0.04 * np.array([0.0, 1.0, -1.0, 1.0, -1.0, 1.0]), step=0.25, times=np.arange(5.0))
    for lane, F_c in enumerate(LIMITS):
        wanted = 4 * F_c * max(0.01 - F_c / 3000.0, 0.0)
        lost = run.heat_stop.values[4, lane] - run.heat_stop.values[2, lane]
        assert lost == pytest.approx(wanted, rel=1e-12, abs=1e-15)


def triangle(turns):
    """Return times and speeds of a path that goes from turn to turn at 1 m/s."""
    lengths = np.abs(np.diff(turns))
    ends = np.cumsum([0.0, *lengths])
    short = 1e-9 * lengths.min()
    t = np.sort(np.concatenate([ends[:-1] + short, ends[1:] - short]))
    return ends, t, np.repeat(np.sign(np.diff(turns)), 2)


def total(turns):
    """Return the force of all stops at the turns of a path."""
    return sum(3000.0 * stop_operator(turns, F_c / 3000.0) for F_c in LIMITS)


def force_at(turns, rtol=1e-9):
    times, t, v = triangle(np.array(turns))
    t, v = np.array([0.0, *t, times[-1]]), np.array([v[0], *v, v[-1]])
    run = led(t, v, rtol=rtol, times=times)
    balanced(run)
    return 3000.0 * run.z.values.sum(axis=1)


def test_five_stops_under_a_decaying_triangle():
    turns = [0.0] + [(-1) ** n * 0.03 * 0.8**n for n in range(12)]
    assert force_at(turns) == pytest.approx(total(turns), abs=1e-6)


def test_madelung():
    """Minor loops close, larger ones wipe them out, and between equal turns they are congruent."""
    inner = [0.004, 0.012, 0.004, 0.012]
    up, down = force_at([0.0, 0.03, *inner, 0.03]), force_at([0.0, -0.03, *inner, -0.03])
    assert up[3] == pytest.approx(up[5], abs=1e-6)
    assert up[1] == pytest.approx(up[6], abs=1e-6)
    assert up[4] - up[3] == pytest.approx(down[4] - down[3], abs=1e-6)
    assert abs(up[3] - down[3]) > 1.0


def by_events(times, given, stiff, limit):
    """Return (momentum, z) by SciPy from bend to bend: between these the law is linear.

    `given` : the drive; inertia is 0.5 kg or 0.1 H, `stiff` is dF/dz.
    """
    inertia, drive = given

    def rates(t, x, yields):
        speed = x[0] / inertia
        return [drive(t) - stiff * x[1], 0.0 if yields else speed]

    def bend(_t, x, yields):
        return x[0] * np.sign(x[1]) if yields else limit / stiff - abs(x[1])

    bend.terminal, bend.direction = True, -1
    how = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-16, "max_step": 2e-3, "events": bend}
    begin, x, yields, found = 0.0, [0.0, 0.0], False, [np.zeros(2)]
    while begin < times[-1]:
        one = solve_ivp(rates, (begin, times[-1]), x, args=(yields,), dense_output=True, **how)
        found += [one.sol(t) for t in times[(times > begin) & (times <= one.t[-1])]]
        begin, x, yields = one.t[-1], one.y[:, -1], not yields
        x[1] = np.clip(x[1], -limit / stiff, limit / stiff)
    return np.array(found)


@pytest.mark.some(1)
@pytest.mark.parametrize("rtol", [1e-4, 1e-8])
@pytest.mark.parametrize("name", ["mass", "coil"])
def test_a_mass_and_a_coil_follow_their_events(name, rtol):
    inertia, stiff, word, state = {
        "mass": (0.5, 3000.0, "F", "p"),
        "coil": (0.1, 1e3, "V", "phi"),
    }[name]
    times = np.linspace(0.0, 0.4, 31)
    how = {"duration": 0.4, "times": times, "rtol": rtol}
    run = simulate(model(name), inputs={word: sine(20.0, 7.0)}, **how)
    wanted = by_events(times, (inertia, lambda t: 20 * np.sin(14 * np.pi * t)), stiff, 3.0)
    for n, name_of in enumerate((state, "z")):
        error = np.abs(run[name_of].values - wanted[:, n]).max()
        assert error <= 50 * rtol * np.abs(wanted[:, n]).max()
    balanced(run)


def test_rhs_at_the_limit_is_the_projected_rate():
    """Beyond the limit nothing goes, back from it all goes."""
    module = module_of(model("mass"))
    for p, z, rate in ((0.5, 1e-3, 0.0), (-0.5, 1e-3, -1.0), (-0.5, -1e-3, 0.0), (0.5, 5e-4, 1.0)):
        _, _, found = module.rhs(np.array([0.0, p, z]), np.array([0.0]), module.Parameters())
        assert found == rate


def test_without_a_limit_there_is_no_force():
    """A limit of 0: the mass goes as if it were free, and nothing is lost."""
    how = {"duration": 0.1, "times": [0.0, 0.1], "step": 1e-3}
    run = simulate(model("mass"), inputs={"F": 2.0}, parameters={"F_c": 0.0}, **how)
    assert run.p.values[-1] == pytest.approx(0.2, rel=1e-12)
    assert np.abs(run.z.values).max() <= 1e-18
    assert np.abs(run.heat_stop.values).max() <= 1e-30


@pytest.mark.parametrize(
    "steps", [{"step": 1e-3}, pytest.param({"rtol": 1e-4}, marks=pytest.mark.long)], ids=str
)
def test_ten_thousand_stops_run(steps):
    """After a large way they all stand at their limits, first at one, then at the other."""
    limits = np.linspace(1.0, 50.0, 10_000)
    given = {"stop_count": 10_000, "F_c": limits.tolist(), "k": 1e3}
    inputs, times = {"v": sine(5.0, 5.0)}, [0.0, 0.1, 0.2]
    how = {"duration": 0.2, "parameters": given, "times": times}
    run = simulate(model("led"), inputs=inputs, **how, **steps)
    for n, sign in ((1, 1), (2, -1)):
        near = steps.get("rtol", 1e-10)
        assert run.z.values[n] == pytest.approx(sign * limits / 1e3, rel=near)
    balanced(run)


def test_many_that_yield_in_one_step_are_the_stop_operator():
    """More than are computed side by side, each at a place of its own, and a turn in each step."""
    limits = np.linspace(0.5, 40.0, 150)
    t, v = np.arange(6) * 0.05, np.array([0.4, -0.5, 0.7, -0.9, 0.3, -0.2])
    turns = t[:-1] - v[:-1] * 0.05 / np.diff(v)
    times = np.union1d(t, turns)
    gone = np.diff(times) * (np.interp(times[1:], t, v) + np.interp(times[:-1], t, v)) / 2
    given = {"stop_count": 150, "F_c": limits.tolist(), "k": 3000.0}
    run = led(t, v, step=0.05, order=6, times=t, parameters=given)
    for lane, F_c in enumerate(limits):
        wanted = stop_operator(np.cumsum([0.0, *gone]), F_c / 3000.0)[np.isin(times, t)]
        assert np.abs(run.z.values[:, lane] - wanted).max() <= 1e-12
    assert np.abs(run.energy_residual).max() <= 1e-12 * np.ptp(run.energy.values)


def test_the_survey_of_scales_stays_within_limits(monkeypatch):
    """It crept from one yield to the next, which took most of a run's time, and then beyond."""
    largest = []
    monkeypatch.setattr(
        Batch,
        "survey",
        lambda batch, h, of=Batch.survey: (of(batch, h), largest.append(batch.largest.copy())),
    )
    limits = np.linspace(1.0, 40.0, 300) / 300
    given = {"stop_count": 300, "k": 10.0, "F_c": limits.tolist()}
    simulate(model("block"), duration=1.2, inputs={"F": sine(40.0, 1.7)}, parameters=given, times=2)
    assert np.all(largest[0][0, 2:] <= limits / 10.0 * (1 + 1e-12))


@cache
def block_on(n, rtol):
    """Return a run of a mass on n stops."""
    limits = (np.linspace(1.0, 40.0, n) / n).tolist() if n > 1 else 10.0
    given = {"stop_count": n, "k": 3000.0 / n, "F_c": limits}
    how = {"duration": 0.6, "times": 40, "inputs": {"F": sine(40.0, 1.7)}}
    return simulate(model("block"), rtol=rtol, parameters=given, **how)


@pytest.mark.some(1)
@pytest.mark.parametrize("rtol", [1e-3, 1e-5, 1e-7])
def test_steps_do_not_grow_with_the_number_of_stops(rtol):
    """A yield is located where it matters: of many, each is a small part of the mass's force."""
    steps = []
    for n in (1, 20, 300):
        run, exact = block_on(n, rtol), block_on(n, 1e-9)
        for name in ("p", "z"):
            error = np.abs(run[name] - exact[name]).max("time") / np.abs(exact[name]).max("time")
            assert float(error.max()) <= 10 * rtol
        balanced(run)
        steps.append(run.attrs["accepted_steps"])
    assert steps[2] <= 3 * steps[1] <= 15 * steps[0]


def test_what_cannot_be_is_refused():
    base = HEAD.format(name="stop_no", limits=3.0, input="F", unit="N")
    loose = base + MASS.replace('between = ["a", "wall"]', 'between = ["a", "b"]')
    pot = 'pot = { kind = "damper", between = ["b", "wall"], velocity = "f/d", heats = "body" }\n'
    with pytest.raises(NetworkError, match="put a mass at its node"):
        derive(parse(loose + pot))
    near = 'near = { kind = "spring", between = ["b", "wall"], stiffness = "k" }\n'
    between = MASS.replace('between = ["a", "wall"]', 'between = ["a", "b"]')
    for elements in (near + between, between + near):
        with pytest.raises(NetworkError, match="'stop' slips"):
            derive(parse(base + elements))
    with pytest.raises(SpecError, match="values given are outside the domain"):
        parse(base + MASS + "[initial]\nz = 2e-3\n")
    with pytest.raises(SpecError, match="exactly one of stiffness, capacitance"):
        parse(base + MASS.replace('stiffness = "k"', 'stiffness = "k", capacitance = "C"'))
    chain = 'between = ["b", "gnd"], count = 3'
    fed = COIL.replace("V_c", "F_c").replace('between = ["b", "gnd"]', chain)
    ohm = fed.replace('kind = "inductor"', 'kind = "resistor"').replace(
        'inductance = "L", state = "phi"', 'voltage = "d*i", heats = "body"'
    )
    with pytest.raises(NetworkError, match="put an inductor in series"):
        derive(parse(base + ohm.replace('"V"', '"F"')))
    rows = verify(derive(parse(base + MASS.replace('limit = "F_c"', 'limit = "V_c"')))).rows
    assert {row.id: row.verdict for row in rows}["units"] is Verdict.REFUTED


LEVER = """
[model]
name = "led_by_its_own_state"
[parameters]
m = { value = 1.0, unit = "kg" }
k = { value = 30.0, unit = "N/m" }
F_c = { value = 1.0, unit = "N" }
L = { value = 0.1, unit = "m" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 1.0, unit = "J/K" }
[inputs]
F = { unit = "N" }
[domain]
assume = ["L > 0"]
[elements]
mass = { kind = "mass", at = "a", mass = "m", state = "p" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
load = { kind = "force_source", at = "a", input = "F" }
[elements.arm]
kind = "lever"
first = ["a", "wall"]
second = ["b", "wall"]
ratio = "1 + z**2/L**2"
[elements.block]
kind = "stop"
between = ["b", "wall"]
stiffness = "k"
limit = "F_c"
heats = "body"
state = "z"
"""
MORE_STOPS = """
[elements.more]
kind = "stop"
between = ["b", "wall"]
stiffness = "k"
limit = "F_c"
heats = "body"
count = 4
state = "y"
"""


@pytest.mark.some(1)
@pytest.mark.parametrize("more", ["", MORE_STOPS], ids=["alone", "beside a bank"])
def test_what_drives_stops_may_depend_on_the_state_of_one(more):
    """Their drive is the mass's velocity times a ratio that the stop's own state changes."""
    model = parse(LEVER + more)
    assert {row.verdict for row in process.examined(model).rows} == {Verdict.PROVED}
    how = {"inputs": {"F": sine(3.0, 1.0)}, "duration": 3.0, "times": 301}
    other = simulate(model, method="LSODA", rtol=1e-9, **how)
    for rtol in (1e-4, 1e-6):
        run = simulate(model, rtol=rtol, **how)
        for name in ("p", "z", "S"):
            size = np.abs(other[name].values).max()
            assert np.abs(run[name].values - other[name].values).max() <= 10 * rtol * size
        assert np.abs(run.energy_residual).max() <= 1e-14 * run.energy.max()
