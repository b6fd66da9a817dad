"""Transformer: the power-preserving coupling of two electrical pairs of nodes."""

from typing import Annotated, Literal, final

from piezo_sym.spec.elements.base import Element, Law, Letters, Pair
from piezo_sym.spec.elements.ports import Coupling, Domain, Port


@final
class Transformer(Element):
    """An ideal transformer: v_1 = ratio*v_2 and i_2 = -ratio*i_1 between two pairs of nodes."""

    kind: Literal["transformer"] = "transformer"
    first: Pair
    second: Pair
    ratio: Annotated[Law, Letters({}, unit="1")]

    def ports(self, name: str) -> tuple[Port, ...]:
        """Return the coupling."""
        return (
            Coupling(
                first=self.first,
                first_domain=Domain.ELECTRICAL,
                second=self.second,
                second_domain=Domain.ELECTRICAL,
                ratio=self.law("ratio"),
                name=f"n_{name}",
                body=None,
                gyrates=False,
            ),
        )
