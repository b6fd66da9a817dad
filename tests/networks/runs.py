"""What must hold of a run in C, whatever the network: both balances, no entropy taken, the states.

Input: a module, and what `simulate` takes.  The balances are those of the step: the last call of
the engine shows the state and the ledger that belong together.
"""

import inspect
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from piezo_sym.build import render
from piezo_sym.modules import load_module
from piezo_sym.run import simulate
from piezo_sym.run.engine import Engine

METHOD = "discrete_gradient"


def written(model, folder, **options):
    """Write a model's files, and return its module."""
    for name, text in render(model, **options).items():
        (Path(folder) / name).parent.mkdir(exist_ok=True)
        (Path(folder) / name).write_text(text, encoding="utf-8")
    return load_module(Path(folder) / model.name / f"{model.name}.py")


@dataclass
class Last:
    """What the last call of the engine has left: the state and the ledger."""

    engine: Engine = None
    x: np.ndarray = None
    ledger: np.ndarray = None

    def exchanged(self):
        """Return the entropy that each heat exchange brought in: the last sums of the ledger."""
        rows = self.ledger.size // 2
        return self.ledger[rows - self.engine.exchanges : rows]


@contextmanager
def watched(monkeypatch):
    """Let a `Last` know of every call of `Engine.run`."""
    last, run = Last(), Engine.run
    signature = inspect.signature(run)

    def seen(*args, **options):
        given = signature.bind(*args, **options).arguments
        last.engine, last.x, last.ledger = given["self"], given["x"], given["ledger"]
        return run(*args, **options)

    with monkeypatch.context() as patch:
        patch.setattr(Engine, "run", seen)
        yield last


def produced(found):
    """Return the entropy that each process has produced, (nt, processes), lanes side by side."""
    names = [name for name in found.data_vars if name.startswith("produced_")]
    parts = [found[name].values.reshape(found.sizes["time"], -1) for name in names]
    return np.hstack([np.zeros((found.sizes["time"], 0)), *parts])


def gross(found):
    """Return the energy that went through the ports, in and out, between samples."""
    ports = [found[name].values for name in found.data_vars if name.startswith("supplied_")]
    return float(sum(np.abs(np.diff(port)).sum() for port in ports))


def rounded(steps, size):
    """Return what rounding a sum may cost: 4 ulp, and what the roundings of each step add up to.

    Each step rounds its new state; nothing drives these errors to one side.
    """
    return (4 + np.sqrt(steps)) * np.spacing(size)


def check_energy(found):
    """Check the energy balance at all samples."""
    energy = found.energy.values
    bound = 1e-12 * (np.ptp(energy) + gross(found))
    bound += rounded(found.attrs["accepted_steps"], np.abs(energy).max())
    assert np.abs(found.energy_residual.values).max() <= bound


def check_production(found):
    """Check that no process takes entropy between two samples, and that the heats say the same."""
    made = produced(found)
    assert np.all(np.isfinite(made))
    assert np.all(np.diff(made, axis=0) >= 0)


def check_entropy(found, module, start, last):
    """Check that all entropy at the end was there, was produced, or was brought in."""
    p = module.Parameters()
    before, after = (float(module.entropy(x, p)) for x in (start, last.x))
    terms = np.concatenate([produced(found)[-1], last.exchanged()])
    size = max(abs(before), abs(after), *np.abs(terms), *np.abs(start), *np.abs(last.x))
    bound = 1e-12 * np.abs(terms).sum() + rounded(found.attrs["accepted_steps"], size)
    assert abs(after - before - terms.sum()) <= bound


def check_run(monkeypatch, module, start, **options):
    """Check a run, and return it."""
    with watched(monkeypatch) as last:
        found = simulate(module, method=METHOD, **options)
    check_energy(found)
    check_production(found)
    check_entropy(found, module, start, last)
    return found


def distance(found, wanted, module):
    """Return how far two runs are apart, relative to the largest magnitude of each state."""
    names = [record.name for record in module.STATES]
    return max(
        np.abs(found[n].values - wanted[n].values).max() / (np.abs(wanted[n].values).max() + 1e-9)
        for n in names
    )


def jumps(spec):
    """Return whether a law jumps: where a state would have to slide along it, a run may stop."""
    return any("sign(" in str(value) for e in spec["elements"].values() for value in e.values())
