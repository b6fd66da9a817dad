"""What must hold of a run in C, whatever the network: both balances, no entropy taken, the states.

Input: a module, and what `simulate` takes.
"""

from pathlib import Path

import numpy as np

from piezo_sym.build import render
from piezo_sym.module_cache import load_module
from piezo_sym.run import simulate

METHOD = "discrete_gradient"


def written(model, folder, **options):
    """Write a model's files, and return its module."""
    for name, text in render(model, **options).items():
        (Path(folder) / name).parent.mkdir(exist_ok=True)
        (Path(folder) / name).write_text(text, encoding="utf-8")
    return load_module(Path(folder) / model.name / f"{model.name}.py")


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
    """Check the energy balance at all samples, by what went through ports or became heat."""
    energy = found.energy.values
    heat = sum(float(np.abs(found[n].values[-1]).sum()) for n in found if n.startswith("heat_"))
    bound = 1e-12 * (np.ptp(energy) + gross(found) + heat)
    bound += rounded(found.attrs["accepted_steps"], np.abs(energy).max())
    assert np.abs(found.energy_residual.values).max() <= bound


def check_production(found):
    """Check that no process takes entropy between two samples, and that the heats say the same."""
    made = produced(found)
    assert np.all(np.isfinite(made))
    assert np.all(np.diff(made, axis=0) >= 0)


def last_state(found, module):
    """Return the state (n,) at the end of a run."""
    return np.hstack([np.atleast_1d(found[record.name].values[-1]) for record in module.STATES])


def check_entropy(found, module, start):
    """Check that all entropy at the end was there, was produced, or was brought in."""
    p, last = module.Parameters(), last_state(found, module)
    before, after = (float(module.entropy(x, p)) for x in (start, last))
    exchanged = [found[n].values[-1] for n in found if n.startswith("entropy_exchanged_")]
    terms = np.concatenate([produced(found)[-1], exchanged])
    size = max(abs(before), abs(after), *np.abs(terms), *np.abs(start), *np.abs(last))
    bound = 1e-12 * np.abs(terms).sum() + rounded(found.attrs["accepted_steps"], size)
    assert abs(after - before - terms.sum()) <= bound


def check_run(module, start, **options):
    """Check a run, and return it."""
    found = simulate(module, method=METHOD, **options)
    check_energy(found)
    check_production(found)
    check_entropy(found, module, start)
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
