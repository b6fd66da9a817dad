"""Mass: stores kinetic energy."""

from typing import Annotated, ClassVar, Literal, final

from piezo_sym.expressions.tree import Cmp, Div, Sym
from piezo_sym.spec.elements.base import (
    Element,
    Law,
    Letters,
    Node,
    StateName,
    positive,
    state_symbol,
)
from piezo_sym.spec.elements.ports import Domain, Port, Storage, Variable


@final
class Mass(Element):
    """A mass at a node, eq. (10) and the third term of (6).

    State p [kg*m/s], the momentum; co-state the velocity v = p/mass [m/s] of its node; energy the
    integral of v, p**2/(2*mass).
    """

    letter: ClassVar[str] = "p"

    kind: Literal["mass"] = "mass"
    at: Node
    mass: Annotated[Law, Letters({"p": "kg*m/s"}, unit="kg")]
    state: StateName = None

    def ports(self, name: str) -> tuple[Port, ...]:
        """Return the store: the node's velocity is given, momentum follows the force."""
        return (
            Storage(
                state=state_symbol(self, name),
                letter="p",
                law=Div(Sym("p"), self.law("mass")),
                costate=f"v_{name}",
                branch=(self.at, Domain.MECHANICAL.reference),
                domain=Domain.MECHANICAL,
                imposes=Variable.ACROSS,
                units=("kg*m/s", "m/s"),
                doc=f"momentum of mass '{name}'",
            ),
        )

    def requires(self) -> tuple[Cmp, ...]:
        """Mass is positive."""
        return (positive(self.law("mass")),)
