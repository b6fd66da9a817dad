"""Bodies that are held at a temperature, of a store whose other states may change it as well.

Input: a search for a state of rest, its start, the bodies held.  Output: the state of rest at which
they have these temperatures, or a `RunError`; the Jacobian at constant temperatures.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, final

import numpy as np

from piezo_sym.analysis.rest import RestSearch
from piezo_sym.analysis.settling import Rest
from piezo_sym.errors import RunError
from piezo_sym.run.checks import FloatArray, known_keys, positive
from piezo_sym.run.guard import place
from piezo_sym.run.module import GeneratedModule
from piezo_sym.run.parameters import set_temperature, temperature_slopes

#: A relative difference of temperatures that is round-off; the most searches until then.
ROUND_OFF, MOST_SEARCHES = 1e-12, 60


@final
@dataclass(frozen=True)
class Held:
    """Bodies that are held: their rows among the bodies (k,), those of their entropies, T (k,)."""

    bodies: list[int]
    entropies: list[int]
    temperatures: FloatArray

    @classmethod
    def of(
        cls,
        module: GeneratedModule,
        p: Any,
        x: FloatArray,
        given: Mapping[str, float] | None,
        where: str,
    ) -> Held:
        """Return the bodies held at `given` temperatures; their entropies in x (n,) are set."""
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
        module, p, rows = search.module, search.system.parameters, self.entropies
        rest = Rest.near(search, start)
        slope = self._slopes(module, p, rest.x)[:, rows] if rows else np.empty((0, 0))
        off = self._off(module, p, rest.x)
        for _ in range(MOST_SEARCHES):
            if np.max(np.abs(off), initial=0.0) <= ROUND_OFF:
                return rest
            move = -np.linalg.lstsq(slope, off)[0]  # beside a greatest temperature it is singular
            start[rows] += move
            rest, before = Rest.near(search, start), off
            off = self._off(module, p, rest.x)
            slope += np.outer(off - before - slope @ move, move) / (move @ move)
        n = int(np.argmax(np.abs(off)))
        name, T = module.BODIES[self.bodies[n]].name, self.temperatures[n]
        what = f"no state of rest is found at which '{name}' has {T:.9g} K"
        remedy = "hold it at another temperature, or give other inputs"
        raise RunError(what, place(search.system), remedy=remedy)

    def jacobian(self, module: GeneratedModule, p: Any, x: FloatArray, full: FloatArray) -> Any:
        """Return the Jacobian (n, n) of the rates at constant temperatures, given the full one."""
        slopes, rows = self._slopes(module, p, x), self.entropies
        return full - full[:, rows] @ np.linalg.solve(slopes[:, rows], slopes)

    def _slopes(self, module: GeneratedModule, p: Any, x: FloatArray) -> FloatArray:
        """Return the relative change (k, n) of each temperature with each state."""
        slopes = temperature_slopes(module, p, x)[self.bodies]
        return np.asarray(slopes / self.temperatures[:, None])

    def _off(self, module: GeneratedModule, p: Any, x: FloatArray) -> FloatArray:
        found = np.asarray(module.temperatures(x, p))[self.bodies]
        return np.asarray(found / self.temperatures - 1)
