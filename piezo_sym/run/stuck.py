"""The error of a run whose steps became too short: why no step leads on.

Input: a `DrivenModule`, the time, the state and the samples until then.  Output: a `RunError`.
"""

from collections.abc import Iterator

import numpy as np

from piezo_sym.errors import STICKING, RunError, listing, quote
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.guard import edge_ahead, place, remedies
from piezo_sym.run.module import UNPROVED, by_name, is_unproved, row_names
from piezo_sym.run.system import DrivenModule

#: A state [SI] beyond this size has grown without bound; so has one this many times as large as
#: before, or as its first rate would make it, that would grow so many times more in as long again.
GROWN, GROWTH, FASTER = 1e100, 1e6, 10.0
#: The part of the time so far, and then of the run, in which the state is looked at ahead.
AHEAD = 1e-9
#: What to write for laws with infinite slopes, and for laws with terms that overflow.
STEEP = "write x/(x**2 + x_0**2)**(1/4) for sign(x)*sqrt(abs(x)), 1 - tanh(x)**2 for 1/cosh(x)**2"
#: The least part of the largest energy that a negative one counts as.
PART = 1e-2


def stuck_error(
    system: DrivenModule, method: str, t: float, x: FloatArray, samples: FloatArray, *, jumps: bool
) -> RunError:
    """Return the error of a run that stopped at t [s] in x (n,); of `samples` (nt, n) some nan.

    `jumps` says whether a law of the model jumps.
    """
    module, u = system.module, system.inputs.at_samples(np.array([t]))[:, 0]
    why = "no step stays in the domain"
    remedy = "look at inputs and state; allow more room in [domain]"
    if jumps:
        why += ", or a law that jumps (sign) holds the state at its jump"
        remedy += f"; {STICKING}"
    past, duration = t - system.inputs.start, system.inputs.duration
    edge = edge_ahead(system, x, u, AHEAD * past, AHEAD * duration)
    if is_unproved(module):
        why = f"each step leaves the domain or consumes entropy, and the model is {UNPROVED}"
        remedy = "mend what `piezo-sym verify` refutes; or take method LSODA, which goes on"
    elif edge[0]:
        why = edge[1] + _fallen(system, x, u)
        remedy = f"change {listing(remedies(system, edge[0]))}"
    elif growing := list(_growing(system, t, x, samples)):
        why = f"{listing(map(quote, growing))} grow{'s' * (len(growing) == 1)} without bound"
        why += _fallen(system, x, u)
        remedy = "check the signs of laws: a spring pulls back by k*q, not by -k*q"
    elif steep := system.steep(t, x):
        why = f"the slopes of its laws by {listing(map(quote, steep))} are infinite there"
        why, remedy = f"{why}, or nearly", STEEP
    names = [record.name for record in module.STATES]
    rows = system.rows(module.STATES)
    values = ", ".join(f"{n} = {x[row.start]:.6g}" for n, row in zip(names, rows, strict=True))
    what = f"{method} cannot go on from t = {t:.6g} s at {values}: {why}"
    return RunError(what, place(system), remedy=remedy)


def _growing(system: DrivenModule, t: float, x: FloatArray, samples: FloatArray) -> Iterator[str]:
    """Yield the names of states that grow without bound, in finite time or as an exponential."""
    start, names = system.inputs.start, row_names(system.module.STATES, system.parameters)
    u = system.inputs.at_samples(np.array([start, t]))
    with np.errstate(all="ignore"):
        first = system.module.rhs(samples[0], u[:, 0], system.parameters)
        rates = system.module.rhs(x, u[:, 1], system.parameters)
        known = np.fmax(np.fmax.reduce(np.abs(samples)), np.abs(first) * (t - start))
        larger = (known > 0) & (np.abs(x) > GROWTH * known)  # what rested has no size
        larger &= (rates * x > 0) & (np.abs(rates) * (t - start) > FASTER * np.abs(x))
    yield from (names[n] for n in np.flatnonzero(larger | (np.abs(x) > GROWN)))


def _fallen(system: DrivenModule, x: FloatArray, u: FloatArray) -> str:
    """Return which element's energy has fallen far below zero, for a message."""
    module, p = system.module, system.parameters
    with np.errstate(all="ignore"):
        values = by_name(module.ELEMENTS, p, module.elements(x, u, p))
    energies = {n: float(np.min(v)) for n, v in values.items() if n.endswith(".energy")}
    name = min(energies, key=energies.__getitem__, default="")
    largest = max(map(abs, energies.values()), default=0.0)  # may be inf
    if not name or energies[name] >= 0 or -energies[name] < PART * largest:
        return ""
    fallen = f"the energy of '{name.removesuffix('.energy')}' has fallen to {energies[name]:.3g} J"
    return f"; {fallen}: passivity bounds no state whose energy has no lower bound"
