"""The state at the end of a run, as far as it is known, and the scale of its errors.

Input: a `Problem`.  Output: `Reference`: known numbers for case P; for any other problem this
package's own tight run, and its distance to a looser one and, if asked, to LSODA's; LSODA's alone
where the own one cannot go on.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, final

import numpy as np

from piezo_sym.errors import RunError
from piezo_sym.run.collocation import METHOD
from tests.benchmarks.case_p import case_p
from tests.benchmarks.ours import states, whole

if TYPE_CHECKING:
    from piezo_sym.bench.problem import Problem
    from piezo_sym.run.checks import FloatArray

#: Methods and tolerances: a run that is taken for the truth, and what it is compared with.
OWN, OWN_LOOSER = (METHOD, 1e-9), (METHOD, 1e-8)
SCIPY, SCIPY_LOOSER = ("LSODA", 1e-12), ("LSODA", 1e-10)
SAMPLES = 201


@final
@dataclass(frozen=True)
class Reference:
    """A problem with its scale, its state (n,) at the end, and how far that is known."""

    problem: Problem
    state: FloatArray
    good_to: float
    source: str

    def error(self, x: FloatArray) -> float:
        """Return the error of a state (n,) at the end, in units of the scale."""
        return self.problem.error(x, self.state)

    @property
    def line(self) -> str:
        """What errors are, in one line."""
        return f"at the end, against {self.source}, good to {self.good_to:.0e}"


def reference_of(problem: Problem, independent: bool) -> Reference:
    """Return the reference of a problem.

    Parameters
    ----------
    independent : whether LSODA at 1e-10 has a say, too, which takes long on a long run.
    """
    case = case_p(problem.model.sha256, problem.inputs)
    known = case.known(problem.duration, problem.start.size - 4) if case else None
    if known:
        return Reference(problem, *known, "the known numbers of case P")
    try:
        path, others = _ran(problem, OWN), [OWN_LOOSER, *([SCIPY_LOOSER] if independent else [])]
        source = f"an own run at rtol {OWN[1]:g}{', LSODA beside it' if independent else ''}"
    except RunError:  # no step is small enough for so tight a tolerance
        path, others = _ran(problem, SCIPY), [SCIPY_LOOSER]
        source = f"LSODA at rtol {SCIPY[1]:g}"
    if not case:
        problem = replace(problem, scale=problem.system.scale(np.max(np.abs(path), axis=1)))
    ends = [_ran(problem, other)[:, -1] for other in others]
    good = max(problem.error(end, path[:, -1]) for end in ends)
    return Reference(problem, path[:, -1], good, source)


def _ran(problem: Problem, how: tuple[str, float]) -> FloatArray:
    """Return the states (n, nt) of a run by a method and a tolerance."""
    method, rtol = how
    return states(problem, whole(problem, rtol, SAMPLES, method))
