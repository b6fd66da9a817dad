"""Path functionals: elements whose effort depends on the way that their coordinate goes.

Input: a model's `Path` records.  Output: what the slopes for Newton's method know of them.  An
elastic-plastic stop has an inner state z and the effort f = stiffness*z; z goes with the coordinate
while |z| < limit, and where it would leave, it stays and all that is done becomes heat.  A stage is
given weighted means of effort, rate of z and heat, exact along the step (run/engine/stop.c), and in
which part of the step z goes with the coordinate.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import final

from piezo_sym.codegen.jacobian import Given
from piezo_sym.codegen.program import Described
from piezo_sym.expressions.calculus import add, mul, neg
from piezo_sym.expressions.tree import ONE, Expr, Sym


@final
@dataclass(frozen=True)
class Path:
    """A stop, or one in each lane of a bank.

    Attributes
    ----------
    coordinate, inner : states; the rate of the coordinate uses neither rates nor heats of paths,
        that of the inner state is `rate`, and its energy is stiffness*inner**2/2.
    bank : of the inner state; the coordinate is shared, or of the same bank.
    stiffness : in parameters.
    limit : of the inner state, positive, in parameters and states as they are where a step begins.
    effort, rate, heat, share : the names of what stages are given.
    """

    coordinate: str
    inner: str
    bank: str | None
    stiffness: Expr
    limit: Expr
    effort: str
    rate: str
    heat: str
    share: str

    def given(self) -> Iterator[Described]:
        """Yield what stages are given, in the order of the engine."""
        for name in (self.effort, self.rate, self.heat, self.share):
            yield Described(name, "", "", self.bank)


def slopes_of(paths: Sequence[Path]) -> Iterator[Given]:
    """Yield how efforts depend on coordinates: as in a spring, while the inner state moves."""
    for path in paths:
        slope = mul(path.stiffness, Sym(path.share))
        yield Given(path.effort, path.coordinate, slope)


def in_motion(paths: Sequence[Path], rates: Mapping[str, Expr]) -> dict[str, Expr]:
    """Return what rates and heats of paths are in the mean, from the rates of coordinates.

    Newton's method learns from it how they depend on the state.
    """
    found = {}
    for path in paths:
        share, rate = Sym(path.share), rates[path.coordinate]
        found[path.rate] = mul(share, rate)
        found[path.heat] = mul(add(ONE, neg(share)), mul(Sym(path.effort), rate))
    return found
