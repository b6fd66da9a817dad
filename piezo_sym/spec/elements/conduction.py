"""Conduction: heat flow between two bodies in contact."""

from typing import Annotated, Literal, final

from piezo_sym.spec.elements.base import BodyName, Element, Law, Letters
from piezo_sym.spec.elements.ports import Conductor, Port


@final
class Conduction(Element):
    """Heat conduction between two bodies, the irreversible process of a heat exchanger.

    The heat flow q = conductance*(T_1 - T_2) [W] runs from the first body to the second; J couples
    their entropies, the driving force is T_1 - T_2 and gamma = conductance/(T_1 T_2).
    """

    kind: Literal["conduction"] = "conduction"
    between: tuple[BodyName, BodyName]
    conductance: Annotated[Law, Letters({}, unit="W/K")]

    def ports(self, name: str) -> tuple[Port, ...]:
        """Return the process."""
        return (
            Conductor(
                first=self.between[0],
                second=self.between[1],
                conductance=self.law("conductance"),
                output=f"s_{name}",
            ),
        )
