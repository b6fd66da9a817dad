"""Runs of some systems, as C leaves them.

Input: none; `collocation` and `discrete` make `Runs`.  Output: the `Trajectory` of each.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias, final

from numpy.typing import NDArray

from piezo_sym.errors import RunError
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.ledger import Trajectory
from piezo_sym.run.system import DrivenModule, DrivenModules

METHOD = "discrete_gradient"
#: Told the time that runs have reached, now and then; what it raises ends them.
Watch: TypeAlias = Callable[[float], object]


@final
@dataclass(frozen=True)
class Runs:
    """Runs of some systems, and why those that did not come through stopped.

    Attributes
    ----------
    systems : with equal inputs and sizes.
    start : their states (runs, n) at t = 0.
    times : the sample times (nt,).
    states, sums : at samples, (runs, nt, n) and (runs, nt, rows), rows in the order of
        `System.rates`, and then heat and entropy that dissipative starts produce.
    numerical : whether sums have those last two rows.
    work : of each run, its steps, Newton's iterations, and steps refused (runs, 3).
    errors : of each run, its error, or None.
    """

    systems: DrivenModules
    start: FloatArray
    times: FloatArray
    states: FloatArray
    sums: FloatArray
    work: NDArray[Any]
    errors: Sequence[RunError | None]
    numerical: bool = False

    def trajectory(self, k: int) -> Trajectory:
        """Return run k; raise its error, which holds what was reached, if it stopped."""
        if error := self.errors[k]:
            error.reached = self.so_far(k).until(self.times)
            raise error
        return self.so_far(k)

    def so_far(self, k: int) -> Trajectory:
        """Return run k, whose samples are nan beyond what it reached."""
        sums = self.sums[k].T
        steps, evaluations, halvings = (int(number) for number in self.work[k])
        return Trajectory(
            start=self.start[k],
            states=self.states[k].T,
            inputs=self.systems[k].inputs.at_samples(self.times),
            integrals=sums[:-2] if self.numerical else sums,
            steps=steps,
            evaluations=evaluations,
            halvings=halvings,
            numerical=sums[-2:] if self.numerical else None,
        )


def stuck(system: DrivenModule, t: float, x: FloatArray) -> RunError:
    """Return the error of a run that cannot go on: it says when and where."""
    why = "no step stays in the domain, or a law that jumps holds the state there"
    remedy = "look at inputs and state; allow more room in [domain]; tanh(v/w) for sign(v)"
    names = [record.name for record in system.module.STATES]
    rows = system.rows(system.module.STATES)
    values = ", ".join(f"{n} = {x[row.start]:.6g}" for n, row in zip(names, rows, strict=True))
    what = f"{METHOD} cannot go on from t = {t:.6g} s at {values}: {why}"
    return RunError(what, f"model '{system.module.NAME}'", remedy=remedy)
