"""Current source: an input that pushes a current from its second node into its first."""

from typing import Literal, final

from piezo_sym.spec.elements.base import Element, InputName, Pair
from piezo_sym.spec.elements.ports import Domain, Port, Source, Variable


@final
class CurrentSource(Element):
    """A current pushed into the first node; the conjugate output is the voltage between them."""

    kind: Literal["current_source"] = "current_source"
    between: Pair
    input: InputName

    def ports(self, name: str) -> tuple[Port, ...]:
        """Return the port: the current through it is the input."""
        return (
            Source(
                input=self.input,
                branch=self.between,
                domain=Domain.ELECTRICAL,
                imposes=Variable.THROUGH,
                units=("A", "V"),
                doc=f"voltage at current_source '{name}'",
            ),
        )
