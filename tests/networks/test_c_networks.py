"""Compiled modules of networks agree with NumPy, with SymPy's 40 digits, and with the raw laws."""

import tempfile
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from agreement import (
    check_against_sympy,
    check_against_tableau,
    check_batch,
    check_entropy,
    point,
)
from strategy import derivable, explore
from test_specs import points

from piezo_sym import derive, load
from piezo_sym.codegen import collocation_of, lower, printed
from piezo_sym.module_cache import load_module
from piezo_sym.modules import module_of
from piezo_sym.run.collocation import FixedStep, collocate
from piezo_sym.run.engine.batch import is_lossy
from piezo_sym.run.engine.engine import OFFERED, engine_of
from piezo_sym.run.inputs import read_inputs
from piezo_sym.run.system import DrivenModule
from piezo_sym.spec.tables import banks

SPECS = sorted(Path(__file__).with_name("specs").glob("*.toml"))
PLAIN = {"energy", "entropy", "temperatures"}
AGREEMENT = 1e-11


def twins(iphs, folder):
    """Return a module, written into a folder, and the same with its functions compiled."""
    program = lower(iphs, "verdict")
    texts = printed(program, collocation_of(iphs))
    for ending, text in texts.items():
        (Path(folder) / f"{program.name}{ending}").write_text(text, encoding="utf-8")
    return twin(load_module(Path(folder) / f"{program.name}.py"))


def twin(module):
    """Return a module, and the same with its functions compiled."""
    engine = engine_of(module)
    compiled = {name: getattr(engine, name) for name in OFFERED}
    return module, SimpleNamespace(
        **{**vars(module), **compiled}, engine=engine, starts=is_lossy(engine)
    )


def check_twins(first, second, x, u):
    """Check that both give the same rows, to the size of the largest row."""
    p = first.Parameters()
    for name in OFFERED:
        given = (u, p) if name == "initial_state" else (x, p) if name in PLAIN else (x, u, p)
        wanted, found = getattr(first, name)(*given), getattr(second, name)(*given)
        assert np.shape(found) == np.shape(wanted), name
        size = np.abs(wanted).max(initial=1e-30)
        assert np.allclose(found, wanted, rtol=AGREEMENT, atol=AGREEMENT * size), name


def check(spec, seed):
    """Check the compiled module of a network at two states."""
    iphs = derivable(spec)
    systems = [iphs.expand(), *([iphs] if banks(iphs.model) else [])]
    places = [point(spec, systems[0].x, seed + n) for n in range(2)]
    with tempfile.TemporaryDirectory() as folder:
        module, compiled = twins(iphs, folder)
        for x, u in places:
            check_twins(module, compiled, x, u)
            for system in systems:
                check_against_sympy(compiled, system, x, u)
            check_against_tableau(compiled, spec, x, u)
            check_entropy(compiled, spec, x, u)
        check_batch(compiled, places)
        check_start(module, compiled, places[0])


def check_start(module, compiled, place):
    """Check both balances of a run that begins with dissipative quarters, from any state."""
    if not compiled.starts:
        return
    (x, u), h = place, 0.01
    p = module.Parameters()
    inputs = dict(zip((record.name for record in module.INPUTS), map(float, u), strict=True))
    system = DrivenModule(module, p, read_inputs(module, inputs, 3 * h))
    times = np.array([0.0, h, 3 * h])
    runs = collocate([system], compiled.engine, x[None], times, FixedStep(h), starts=True)
    if runs.errors[0]:
        return
    sums, states, ports = runs.sums[0], runs.states[0].T, len(module.OUTPUTS)
    processes = sum(part.stop - part.start for part in system.rows(module.PROCESSES))
    energy, entropy = (f(states, p) - f(x, p) for f in (module.energy, module.entropy))
    powers = sums[:, :ports]
    size = np.abs(module.energy(states, p)).max() + np.abs(powers).max(initial=0.0)
    parts = np.delete(sums[:, ports + processes :], -2, axis=1)
    assert np.abs(energy - powers.sum(axis=1)).max() <= 1e-12 * size
    bound = 1e-12 * (np.abs(module.entropy(states, p)).max() + np.abs(parts).max(initial=0.0))
    assert np.abs(entropy - parts.sum(axis=1)).max() <= bound + 1e-15
    assert np.all(np.diff(sums[:, -2:], axis=0) >= 0)


@pytest.mark.some(4)
@pytest.mark.parametrize("path", SPECS, ids=lambda path: path.stem)
def test_specs(path):
    model = load(path)
    module, compiled = twin(module_of(model))
    exact = derive(model).expand()
    for x, u, _ in points(model, exact):
        check_twins(module, compiled, x, u)
        check_against_sympy(compiled, exact, x, u)


def test_networks():
    assert len(explore(2, check)) >= 2


@pytest.mark.long
def test_many_networks():
    assert len(explore(200, check)) >= 200
