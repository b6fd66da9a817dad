"""Thermal mass: a body that stores heat."""

from typing import Annotated, ClassVar, Literal, final

from piezo_sym.expressions.tree import Cmp, Sym, names
from piezo_sym.spec.elements.base import (
    Element,
    Law,
    Letters,
    StateName,
    positive,
    state_symbol,
)
from piezo_sym.spec.elements.ports import Body, Port


@final
class ThermalMass(Element):
    """A body, eqs. (8), (13) and f_h(S) of (6).

    State S [J/K], its entropy; co-state its temperature T = temperature(S) [K]; energy the integral
    of T, the f_h(S) that the paper leaves to be deduced.
    """

    letter: ClassVar[str] = "S"

    kind: Literal["thermal_mass"] = "thermal_mass"
    temperature: Annotated[Law, Letters({"S": "J/K"}, unit="K")]
    state: StateName = None

    def ports(self, name: str) -> tuple[Port, ...]:
        """Return the body."""
        return (
            Body(
                state=state_symbol(self, name),
                letter="S",
                law=self.law("temperature"),
                temperature=f"T_{name}",
                doc=f"entropy of thermal_mass '{name}'",
            ),
        )

    def requires(self) -> tuple[Cmp, ...]:
        """Every parameter of the temperature law is positive."""
        return tuple(
            positive(Sym(word)) for word in names(self.law("temperature")) if word != self.letter
        )
