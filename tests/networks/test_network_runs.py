"""Networks run in C: both balances, no entropy taken, and the states of another kind of solver."""

import re
import tempfile
from collections import Counter
from pathlib import Path

import numpy as np
import platformdirs
import pytest
from agreement import point
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from runs import check_run, distance, written
from strategy import networks

from piezo_sym import derive, load, sine
from piezo_sym.errors import PiezoError, RunError
from piezo_sym.run import simulate
from piezo_sym.run.module import rows
from piezo_sym.spec.model import Model

SPECS = sorted(Path(__file__).with_name("specs").glob("*.toml"))
#: What a run is asked for, and how far its states may be from the reference.
ACCURACIES = ((("rtol", 1e-6), 2e-5), (("rtol", 1e-8), 2e-7), (("step", 1e-3), 1e-3))
FINISHED, STOPPED = "finished", "stopped"


@pytest.fixture(scope="module", autouse=True)
def cache(tmp_path_factory):
    """A cache of our own: nothing is taken from a user's."""
    folder = tmp_path_factory.mktemp("cache")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(platformdirs, "user_cache_dir", lambda name: str(folder / name))
        yield folder


def initial(module, x):
    """Return a state as `simulate` takes it."""
    places = zip(module.STATES, rows(module.STATES, module.Parameters()), strict=True)
    return {r.name: x[at].tolist() if r.bank else float(x[at.start]) for r, at in places}


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
        message = str(error)
        assert message.isprintable()
        return float(re.search(r" t = (\S+) s", message)[1])


def jumps(spec):
    """Return whether a law jumps: where a state would have to slide along it, a run may stop."""
    return any(element.get("discontinuous") for element in spec["elements"].values())


def check(spec, iphs, seed):
    """Run a network from some state with every accuracy, and return how that came out."""
    x, u = point(spec, iphs, seed)
    with tempfile.TemporaryDirectory() as folder:
        module = written(iphs.model, folder, allow_unproved=True)
        options = {"initial": initial(module, x), "inputs": driven(spec, u, seed)}
        options |= {"duration": 1.0, "times": 21}
        wanted = attempted(lambda: simulate(module, rtol=1e-10, **options))
        for (name, value), bound in ACCURACIES:
            given = {name: value, **options}
            with pytest.MonkeyPatch.context() as patch:
                found = attempted(lambda g=given, p=patch: check_run(p, module, x, **g))
            if isinstance(wanted, float):
                assert found == pytest.approx(wanted, abs=1e-2)
            elif not (isinstance(found, float) and jumps(spec)):
                assert distance(found, wanted, module) <= bound
    return STOPPED if isinstance(wanted, float) else FINISHED


def explore(number):
    """Check a number of random networks that can be derived; count how their runs came out."""
    outcomes = Counter()

    @settings(max_examples=number, suppress_health_check=list(HealthCheck), database=None)
    @given(networks(), st.integers(0, 10**6))
    def each(spec, seed):
        try:
            iphs = derive(Model(**spec))
        except PiezoError:
            assume(False)
        outcomes[check(spec, iphs, seed)] += 1

    each()
    return outcomes


@pytest.mark.parametrize("path", SPECS, ids=lambda path: path.stem)
@pytest.mark.parametrize("accuracy", [{"rtol": 1e-6}, {"rtol": 1e-9}, {"step": 1e-6}], ids=str)
def test_specs(path, accuracy, tmp_path, monkeypatch):
    model = load(path)
    module = written(model, tmp_path)
    u = np.array([entry.si for entry in model.inputs.values()])
    start = module.initial_state(u, module.Parameters())
    options = {"duration": 1e-3, "times": 11}
    found = check_run(monkeypatch, module, start, **accuracy, **options)
    wanted = simulate(module, rtol=1e-12, **options)
    assert distance(found, wanted, module) <= 20 * accuracy.get("rtol", 1e-6)


def test_networks():
    outcomes = explore(8)
    assert outcomes[FINISHED] >= 4


@pytest.mark.long
def test_many_networks():
    outcomes = explore(150)
    assert outcomes[FINISHED] >= 75
    assert outcomes[STOPPED] >= 1
