"""Voltage source: an input that sets the voltage between two nodes."""

from typing import Literal, final

from piezo_sym.spec.elements.base import Element, InputName, Pair
from piezo_sym.spec.elements.ports import Domain, Port, Source, Variable


@final
class VoltageSource(Element):
    """A voltage between two nodes, V_in of eq. (12); the conjugate output is its current."""

    kind: Literal["voltage_source"] = "voltage_source"
    between: Pair
    input: InputName

    def ports(self, name: str) -> tuple[Port, ...]:
        """Return the port: the voltage across it is the input."""
        return (
            Source(
                input=self.input,
                branch=self.between,
                domain=Domain.ELECTRICAL,
                imposes=Variable.ACROSS,
                units=("V", "A"),
                doc=f"current given by voltage_source '{name}'",
            ),
        )
