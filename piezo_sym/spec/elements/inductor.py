"""Inductor: stores magnetic energy."""

from typing import Annotated, ClassVar, Literal, final

from piezo_sym.expressions.tree import Cmp, Div, Sym
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
class Inductor(Element):
    """An inductor between two nodes, the storage half of a hysteron, eq. (12).

    State phi [Wb], the flux linkage; co-state the current i = phi/inductance [A] from its first
    node to its second; energy the integral of i, phi**2/(2*inductance).
    """

    letter: ClassVar[str] = "phi"

    kind: Literal["inductor"] = "inductor"
    between: Pair
    inductance: Annotated[Law, Letters({"phi": "Wb"}, unit="H")]
    state: StateName = None

    def ports(self, name: str) -> tuple[Port, ...]:
        """Return the store: the current through it is given, flux follows the voltage."""
        return (
            Storage(
                state=state_symbol(self, name),
                letter="phi",
                law=Div(Sym("phi"), self.law("inductance")),
                costate=f"i_{name}",
                branch=self.between,
                domain=Domain.ELECTRICAL,
                imposes=Variable.THROUGH,
                units=("Wb", "A"),
                doc=f"flux linkage of inductor '{name}'",
            ),
        )

    def requires(self) -> tuple[Cmp, ...]:
        """Inductance is positive."""
        return (positive(self.law("inductance")),)
