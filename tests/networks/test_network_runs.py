"""Networks run in C: both balances, no entropy taken, and the states of another kind of solver."""

import re
import tempfile
from pathlib import Path

import numpy as np
import pytest
from agreement import point
from network_tableau import state
from runs import METHOD, check_run, distance, jumps, written
from strategy import assume, derivable, explore

from piezo_sym import Model, load, sine
from piezo_sym.errors import RunError
from piezo_sym.modules import module_of
from piezo_sym.run import simulate
from piezo_sym.run.module import rows
from piezo_sym.spec.load import parse

SPECS = sorted(Path(__file__).with_name("specs").glob("*.toml"))
#: What a run is asked for, and how far its states may be from the reference.
ACCURACIES = ((("rtol", 1e-6), 2e-5), (("rtol", 1e-8), 2e-7), (("step", 1e-3), 1e-3))
STOPS = ("limit", "stiffness", "capacitance")
FINISHED, STOPPED = "finished", "stopped"


def initial(module, x):
    """Return a state as `simulate` takes it."""
    places = zip(module.STATES, rows(module.STATES, module.Parameters()), strict=True)
    return {r.name: x[at].tolist() if r.bank else float(x[at.start]) for r, at in places}


def held(spec, module, x):
    """Return a state in which no stop is beyond its limit."""
    p, x = module.Parameters(), x.copy()
    stops = {state(n, e): e for n, e in spec["elements"].items() if e["kind"] == "stop"}
    for record, at in zip(module.STATES, rows(module.STATES, p), strict=True):
        if stop := stops.get(record.name):
            size = {n: np.asarray(getattr(p, stop[n])) for n in STOPS if n in stop}
            most = size["limit"] * size.get("capacitance", 1.0) / size.get("stiffness", 1.0)
            x[at] = np.clip(x[at], -most, most)
    return x


def driven(spec, u, seed):
    """Return signals with the amplitudes u; temperatures stay as they are."""
    rng = np.random.default_rng(seed)
    units = [entry["unit"] for entry in spec["inputs"].values()]
    return {
        name: float(v) if unit == "K" else sine(float(v), float(rng.uniform(0.2, 2)))
        for name, v, unit in zip(spec["inputs"], u, units, strict=True)
    }


def attempted(run):
    """Return a run, or the time at which it says that it cannot go on."""
    try:
        return run()
    except RunError as error:
        return stopped_at(error)


def stopped_at(error):
    """Return the time at which a run says that it cannot go on."""
    message = str(error)
    assert message.isprintable()
    return float(re.search(r" t = (\S+) s", message)[1])


def check(spec, seed):
    """Run a network from some state with every accuracy, and return how that came out."""
    pumped = any(e["kind"] == "thermoelectric" for e in spec["elements"].values())
    assume(not (pumped and jumps(spec)))  # it may slide along the jump, step by tiny step
    iphs = derivable(spec)
    x, u = point(spec, iphs.expand().x, seed)
    with tempfile.TemporaryDirectory() as folder:
        module = written(iphs.model, folder, allow_unproved=True)
        x = held(spec, module, x)
        options = {"initial": initial(module, x), "inputs": driven(spec, u, seed)}
        options |= {"duration": 1.0, "times": 21}
        wanted = attempted(lambda: simulate(module, rtol=1e-10, **options))
        for (name, value), bound in ACCURACIES:
            given = {name: value, **options}
            found = attempted(lambda g=given: check_run(module, x, **g))
            if isinstance(wanted, float):
                assert found == pytest.approx(wanted, abs=1e-2)
            elif not (isinstance(found, float) and jumps(spec)):
                assert distance(found, wanted, module) <= bound
    return STOPPED if isinstance(wanted, float) else FINISHED


SHORT = {"duration": 1e-3, "times": 11}


@pytest.fixture(scope="module", params=SPECS, ids=lambda path: path.stem)
def reference(request):
    """A model, its module, and a run that the others are measured against."""
    model = load(request.param)
    module = module_of(model)
    return model, module, simulate(module, rtol=1e-12, **SHORT)


@pytest.mark.some(2)
@pytest.mark.parametrize("accuracy", [{"rtol": 1e-6}, {"rtol": 1e-9}, {"step": 1e-6}], ids=str)
def test_specs(reference, accuracy):
    model, module, wanted = reference
    u = np.array([entry.si for entry in model.inputs.values()])
    start = module.initial_state(u, module.Parameters())
    found = check_run(module, start, **accuracy, **SHORT)
    assert distance(found, wanted, module) <= 20 * accuracy.get("rtol", 1e-6)


RUBBING = """
[model]
name = "rubbing"
[parameters]
m   = { value = 2.0,   unit = "kg" }
F_c = { value = 3.0,   unit = "N" }
T_0 = { value = 300.0, unit = "K" }
c   = { value = 2.0,   unit = "J/K" }
[inputs]
F = { unit = "N" }
[domain]
assume = ["F_c >= 0"]
[initial]
p = 1.0
[elements]
push  = { kind = "force_source", at = "a", input = "F" }
block = { kind = "mass", at = "a", mass = "m", state = "p" }
body  = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
[elements.dry]
kind = "damper"
between = ["a", "wall"]
force = "F_c*sign(v)"
heats = "body"
discontinuous = true
"""


@pytest.mark.long
@pytest.mark.parametrize("accuracy", [{"rtol": 1e-6}, {"step": 1e-3}], ids=str)
def test_friction_is_right_until_the_block_sticks(accuracy):
    """It slows down by 2 N and stands at 0.5 s, where sign(v) has no value that holds it."""
    module, options = module_of(parse(RUBBING)), {"inputs": {"F": 1.0}, "times": 6}
    found = check_run(module, [1.0, 0.0], duration=0.49, **accuracy, **options)
    assert np.allclose(found.p, 1 - 2 * found.time, rtol=0, atol=1e-12)
    with pytest.raises(RunError, match=r"friction that sticks is a 'stop', or F_c\*tanh") as stop:
        simulate(module, duration=1.0, method=METHOD, **accuracy, **options)
    assert 0.5 - 1 / 32 <= stopped_at(stop.value) <= 0.5 + 1e-9  # where it stands


@pytest.mark.some(1)
@pytest.mark.parametrize("accuracy", [{"rtol": 1e-6}, {"step": 1e-2}], ids=str)
def test_a_run_never_takes_entropy_even_of_a_model_that_would(accuracy, tmp_path):
    """A damper that drives, generated though it is refuted: its first step is not taken."""
    data = load(next(path for path in SPECS if "a2" in path.stem)).model_dump()
    data["domain"]["assume"] = []
    data["parameters"]["d"]["value"] = -0.4
    module = written(Model(**data), tmp_path, allow_unproved=True)
    free = simulate(module, duration=1.0, rtol=1e-8, times=11, method="LSODA")
    assert free.produced_damper[-1] < 0
    with pytest.raises(RunError, match="cannot go on from t = 0 s"):
        simulate(module, duration=1.0, method=METHOD, **accuracy)


def test_networks():
    assert explore(1, check, part=2) == [FINISHED]  # one that is small


@pytest.mark.long
def test_many_networks():
    # runs that leave their domain are those of tests/run/test_run_edge.py
    assert explore(150, check).count(FINISHED) >= 75
