"""Path functionals: elements whose effort depends on the way that their coordinate goes.

Input: a model's `Path` records.  Output: what the slopes for Newton's method know of them.  An
elastic-plastic stop has an inner state z and the effort f = stiffness*z; z goes with the coordinate
while |z| < limit, and where it would leave, it stays, the rest slips and all that is done becomes
heat.  A stage is given weighted means of effort, rate of the slip and heat, exact along the step
(run/engine/stop.c), and in which part of the step z goes with the coordinate.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import final

from piezo_sym.codegen.program import Described
from piezo_sym.expressions.calculus import add, mul, neg
from piezo_sym.expressions.tree import ONE, Expr, Sym


@final
@dataclass(frozen=True)
class Path:
    """A stop, or one in each lane of a bank.

    Attributes
    ----------
    inner : a state, whose rate is `drive` less `slip` and whose energy is stiffness*inner**2/2.
    bank : of the inner state.
    drive : the rate of the coordinate, of quantities of a stage that no path gives.
    own : whether each lane has a drive of its own.
    stiffness : in parameters.
    limit : of the inner state, positive, in parameters and states as they are where a step begins.
    effort, slip, heat, share : the names of what stages are given.
    """

    inner: str
    bank: str | None
    drive: Expr
    own: bool
    stiffness: Expr
    limit: Expr
    effort: str
    slip: str
    heat: str
    share: str

    def given(self) -> Iterator[Described]:
        """Yield what stages are given, in the order of the engine."""
        for name in (self.effort, self.slip, self.heat, self.share):
            yield Described(name, "", "", self.bank)


def in_motion(paths: Sequence[Path]) -> dict[str, Expr]:
    """Return what efforts, slips and heats of paths are in the mean, from states and drives.

    Newton's method learns from it how they depend on the state.
    """
    found: dict[str, Expr] = {}
    for path in paths:
        effort = mul(path.stiffness, Sym(path.inner))
        slip = mul(add(ONE, neg(Sym(path.share))), path.drive)
        found |= {path.effort: effort, path.slip: slip, path.heat: mul(effort, slip)}
    return found
