"""Spring: stores elastic energy."""

from typing import Annotated, ClassVar, Literal, final

from piezo_sym.expressions.calculus import add, neg
from piezo_sym.expressions.tree import Cmp, Mul, Sym
from piezo_sym.spec.elements.base import (
    Element,
    Law,
    Letters,
    Pair,
    StateName,
    positive,
    state_symbol,
)
from piezo_sym.spec.elements.ports import Domain, Port, Storage, Variable


@final
class Spring(Element):
    """A spring between two nodes, eqs. (9), (10) and the fourth term of (6).

    State q [m], the extension of its first node relative to its second; co-state the force
    F = stiffness*(q - rest) [N] with which it pulls its first node back; energy the integral of F.
    """

    letter: ClassVar[str] = "q"

    kind: Literal["spring"] = "spring"
    between: Pair
    stiffness: Annotated[Law, Letters({"q": "m"}, unit="N/m")]
    rest: Annotated[Law, Letters({}, unit="m")] = "0"
    state: StateName = None

    def ports(self, name: str) -> tuple[Port, ...]:
        """Return the store: the force through it is given, its extension follows the velocity."""
        force = Mul(self.law("stiffness"), add(Sym("q"), neg(self.law("rest"))))
        return (
            Storage(
                state=state_symbol(self, name),
                letter="q",
                law=force,
                costate=f"F_{name}",
                branch=self.between,
                domain=Domain.MECHANICAL,
                imposes=Variable.THROUGH,
                units=("m", "N"),
                doc=f"extension of spring '{name}'",
            ),
        )

    def requires(self) -> tuple[Cmp, ...]:
        """Stiffness is positive."""
        return (positive(self.law("stiffness")),)
