"""Of many states of rest, that of bodies at given temperatures, and that to which a run leads.

Input: a module with its parameters and constant inputs, the state at the start, the free states,
the temperatures of the bodies `Held`, of stores whose other states may change them as well.
Output: `Rest`: a state of rest, the search that found it, and the length of the run.

What a stop or Bouc-Wen's law has slipped stays, so rest depends on the way there.  The steps of the
search are longer than the motion, which damps it: less slips than in an overshoot.  So the search
begins at the end of runs, each ten times longer than those before, until its rest stays the same.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from piezo_sym.analysis.rest import COUNTS, ROUND_OFF, RestSearch
from piezo_sym.errors import RunError
from piezo_sym.run import simulate
from piezo_sym.run.checks import FloatArray, known_keys, positive
from piezo_sym.run.guard import place
from piezo_sym.run.module import by_name
from piezo_sym.run.parameters import set_temperature, temperature_slopes
from piezo_sym.run.system import DrivenModule

#: The rtol of runs; how far the rest may differ between two runs, over the sizes of the states.
RTOL, SAME = 1e-7, 1e-5
#: The length of the first run, in periods of the slowest oscillation, or without one in times of
#: the fastest motion; length of a run over that of the last; the most runs, and steps of one.
PERIODS, TIMES, LONGER, MOST_RUNS, MOST_STEPS = 3.0, 100.0, 10.0, 8, 20_000
#: A relative difference of temperatures that is round-off; the most searches until then.
SAME_T, MOST_SEARCHES = 1e-12, 60


@final
@dataclass(frozen=True)
class Rest:
    """A state of rest.

    Attributes
    ----------
    search : the search that found it.
    x : the state (n,).
    size : the greatest magnitude of each state on the way there (n,).
    directions : to other states of rest (n, k), but for those where stops slip.
    after : the length of the run [s] whose end decides between states of rest; 0 if there is one
        alone, or the start is one; nan if no run decides.
    """

    search: RestSearch
    x: FloatArray
    size: FloatArray
    directions: FloatArray
    after: float = 0.0

    @classmethod
    def near(cls, search: RestSearch, start: FloatArray, size: FloatArray | float = 0.0) -> Rest:
        """Return the rest that a search finds from `start` (n,), with sizes of at least `size`."""
        search, x, reached = search.find(start)
        size = np.maximum(reached, size)
        return cls(search, x, size, search.undetermined(x, size))

    def memory(self) -> FloatArray:
        """Return the size of each state (n,) that depends on the way to rest, nan for others."""
        size = np.where(self.directions.any(axis=1), self.size, np.nan)
        for own, effort, limit in self.search.efforts(self.x):
            part = np.divide(limit, effort, out=np.zeros_like(effort), where=effort > 0)
            size[own] = np.abs(self.x[own]) * part  # the state at which the stop yields
        return size

    def is_at(self, x: FloatArray) -> bool:
        """Return whether the state x (n,) is this rest, apart from motions too small to slip."""
        slope = self.search.jacobian(self.x)
        return not np.any(np.abs(x - self.x) > SAME * self.scales(slope, np.linalg.eigvals(slope)))

    def scales(self, slope: FloatArray, eigenvalues: NDArray[np.inexact[Any]]) -> FloatArray:
        """Return the scale of each state (n,); `slope` (n, n) is that of the rates.

        That of a momentum is its size in motions in which the other states change by their sizes.
        """
        fastest = float(np.max(np.abs(eigenvalues), initial=0.0)) or 1.0
        heat = self.search.heating_sizes(self.x) / COUNTS
        return np.asarray(np.maximum.reduce([self.size, heat, np.abs(slope) @ self.size / fastest]))


@final
@dataclass(frozen=True)
class Held:
    """Bodies that are held: their rows among the bodies (k,), those of their entropies, T (k,)."""

    bodies: list[int]
    entropies: list[int]
    temperatures: FloatArray

    @classmethod
    def of(cls, system: DrivenModule, x: FloatArray, given: Any, where: str) -> Held:
        """Return the bodies held at `given` temperatures; their entropies in x (n,) are set."""
        module, p = system.module, system.parameters
        names = [record.name for record in module.BODIES]
        values = known_keys(given, names, where)
        bodies = [names.index(name) for name in values]
        rows = [
            set_temperature(module, p, x, body, values[names[body]], f"{where}.{names[body]}")
            for body in bodies
        ]
        return cls(bodies, rows, np.array([positive(T, where) for T in values.values()]))

    def rest(self, search: RestSearch, start: FloatArray) -> Rest:
        """Return the rest near `start` (n,), whose entropies are changed until the bodies have T.

        By Broyden's method: the search for rest moves the other states, on which T may depend.
        """
        rest, rows = Rest.near(search, start), self.entropies
        slope = self._slopes(search, rest.x)[:, rows] if rows else np.empty((0, 0))
        off = self._off(search, rest.x)
        for _ in range(MOST_SEARCHES):
            if np.max(np.abs(off), initial=0.0) <= SAME_T:
                return rest
            move = -np.linalg.lstsq(slope, off)[0]  # beside a greatest temperature it is singular
            start[rows] += move
            rest, before = Rest.near(search, start), off
            off = self._off(search, rest.x)
            slope += np.outer(off - before - slope @ move, move) / (move @ move)
        n = int(np.argmax(np.abs(off)))
        name, T = search.module.BODIES[self.bodies[n]].name, self.temperatures[n]
        what = f"no state of rest is found at which '{name}' has {T:.9g} K"
        remedy = "hold it at another temperature, or give other inputs"
        raise RunError(what, place(search.system), remedy=remedy)

    def jacobian(self, search: RestSearch, x: FloatArray) -> Any:
        """Return the Jacobian (n, n) of the rates at constant temperatures."""
        full, slopes, rows = search.jacobian(x), self._slopes(search, x), self.entropies
        return full - full[:, rows] @ np.linalg.solve(slopes[:, rows], slopes)

    def _slopes(self, search: RestSearch, x: FloatArray) -> FloatArray:
        """Return the relative change (k, n) of each temperature with each state."""
        slopes = temperature_slopes(search.module, search.system.parameters, x)[self.bodies]
        return np.asarray(slopes / self.temperatures[:, None])

    def _off(self, search: RestSearch, x: FloatArray) -> FloatArray:
        found = np.asarray(search.module.temperatures(x, search.system.parameters))[self.bodies]
        return np.asarray(found / self.temperatures - 1)


def followed(rest: Rest, search: RestSearch, start: FloatArray) -> Rest:
    """Return the rest to which a run from the state `start` (n,) leads.

    That is `rest`, found from there by `search`, if it is the only one.  No run holds a body.
    """
    size, open_ = rest.memory(), rest.directions
    if np.isnan(size).all() or rest.is_at(start):
        return rest
    module, p, length = search.module, search.system.parameters, _first_length(rest, start)
    options: dict[str, Any] = {"rtol": RTOL, "times": 2, "parameters": vars(p)}
    options["initial"] = by_name(module.STATES, p, start)
    options["inputs"] = by_name(module.INPUTS, p, search.u)
    for _ in range(MOST_RUNS if search.free.size == start.size else 0):
        run, before = simulate(module, duration=length, **options), rest
        last = [np.atleast_1d(run[state.name].values[-1]) for state in module.STATES]
        end = np.concatenate(last)
        rest = Rest.near(search, end, before.size)
        size, open_ = np.fmax(size, rest.memory()), np.hstack([open_, rest.directions])
        if rest.is_at(end) or not np.any(np.abs(rest.x - before.x) > SAME * size):
            return replace(rest, after=length, directions=open_)
        if run.attrs.get("accepted_steps", 0) > MOST_STEPS:
            break
        length *= LONGER
    return replace(rest, after=np.nan, directions=open_)


def _first_length(rest: Rest, start: FloatArray) -> float:
    """Return some periods [s] of the slowest oscillation, or some times of the fastest motion."""
    slopes = [rest.search.jacobian(x) for x in (start, rest.x)]
    values = np.concatenate([np.linalg.eigvals(slope) for slope in slopes])
    fastest = float(np.max(np.abs(values), initial=0.0)) or 1.0
    turning = np.abs(values.imag)
    slowest = np.min(turning, where=turning > ROUND_OFF * fastest, initial=np.inf)
    return max(PERIODS * 2 * np.pi / float(slowest), TIMES / fastest)
