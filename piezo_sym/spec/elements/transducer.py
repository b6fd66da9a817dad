"""Transducer: the power-preserving coupling of an electrical and a mechanical pair of nodes."""

from typing import Annotated, Literal, final

from piezo_sym.spec.elements.base import BodyName, Element, Law, Letters, Pair, Refers
from piezo_sym.spec.elements.ports import Coupling, Domain, Port


@final
class Transducer(Element):
    """A piezoelectric transducer, the relations of Assumption 2: F = ratio*V, i = ratio*v.

    It draws ratio*v from its first electrical node and pushes its first mechanical node with
    ratio*V.  The ratio [C/m = N/V] may depend on the temperature T of the body it names.
    """

    kind: Literal["transducer"] = "transducer"
    electrical: Pair
    mechanical: Pair
    ratio: Annotated[Law, Letters({"T": "K"}, unit="C/m")]
    temperature: Annotated[BodyName | None, Refers("thermal_mass")] = None

    def ports(self, name: str) -> tuple[Port, ...]:
        """Return the coupling."""
        return (
            Coupling(
                first=self.electrical,
                first_domain=Domain.ELECTRICAL,
                second=self.mechanical,
                second_domain=Domain.MECHANICAL,
                ratio=self.law("ratio"),
                name=f"alpha_{name}",
                body=self.temperature,
                gyrates=True,
            ),
        )
