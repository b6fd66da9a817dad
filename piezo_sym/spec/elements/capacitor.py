"""Capacitor: stores electrical energy."""

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
class Capacitor(Element):
    """A capacitor between two nodes, eq. (11) and the first term of (6).

    State Q [C], the charge that has flowed in at its first node; co-state the voltage
    V = Q/capacitance [V]; energy the integral of V, Q**2/(2*capacitance).
    """

    letter: ClassVar[str] = "Q"

    kind: Literal["capacitor"] = "capacitor"
    between: Pair
    capacitance: Annotated[Law, Letters({"Q": "C"}, unit="F")]
    state: StateName = None

    def ports(self, name: str) -> tuple[Port, ...]:
        """Return the store: the voltage across it is given, charge follows the current."""
        return (
            Storage(
                state=state_symbol(self, name),
                letter="Q",
                law=Div(Sym("Q"), self.law("capacitance")),
                costate=f"V_{name}",
                branch=self.between,
                domain=Domain.ELECTRICAL,
                imposes=Variable.ACROSS,
                units=("C", "V"),
                doc=f"charge of capacitor '{name}'",
            ),
        )

    def requires(self) -> tuple[Cmp, ...]:
        """Capacitance is positive."""
        return (positive(self.law("capacitance")),)
