"""Velocity source: an input that moves a node."""

from typing import Literal, final

from piezo_sym.spec.elements.base import Element, InputName, Node
from piezo_sym.spec.elements.ports import Domain, Port, Source, Variable


@final
class VelocitySource(Element):
    """A velocity given to a node; the conjugate output is the force that it takes."""

    kind: Literal["velocity_source"] = "velocity_source"
    at: Node
    input: InputName

    def ports(self, name: str) -> tuple[Port, ...]:
        """Return the port: the velocity across it is the input."""
        return (
            Source(
                input=self.input,
                branch=(self.at, Domain.MECHANICAL.reference),
                domain=Domain.MECHANICAL,
                imposes=Variable.ACROSS,
                units=("m/s", "N"),
                doc=f"force given by velocity_source '{name}'",
            ),
        )
