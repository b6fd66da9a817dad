"""Lever: the power-preserving coupling of two mechanical pairs of nodes."""

from typing import Annotated, Literal, final

from piezo_sym.spec.elements.base import Element, Law, Letters, Pair
from piezo_sym.spec.elements.ports import Coupling, Domain, Port


@final
class Lever(Element):
    """An ideal lever: v_1 = ratio*v_2 and F_2 = -ratio*F_1 between two pairs of nodes."""

    kind: Literal["lever"] = "lever"
    first: Pair
    second: Pair
    ratio: Annotated[Law, Letters({}, unit="1")]

    def ports(self, name: str) -> tuple[Port, ...]:
        """Return the coupling."""
        return (
            Coupling(
                first=self.first,
                first_domain=Domain.MECHANICAL,
                second=self.second,
                second_domain=Domain.MECHANICAL,
                ratio=self.law("ratio"),
                name=f"n_{name}",
                body=None,
                gyrates=False,
            ),
        )
