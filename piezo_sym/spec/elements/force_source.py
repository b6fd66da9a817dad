"""Force source: an input that pushes a node."""

from typing import Literal, final

from piezo_sym.spec.elements.base import Element, InputName, Node
from piezo_sym.spec.elements.ports import Domain, Port, Source, Variable


@final
class ForceSource(Element):
    """A force on a node, F_ext of eq. (10); the conjugate output is the node's velocity."""

    kind: Literal["force_source"] = "force_source"
    at: Node
    input: InputName

    def ports(self, name: str) -> tuple[Port, ...]:
        """Return the port: the force through it is the input."""
        return (
            Source(
                input=self.input,
                branch=(self.at, Domain.MECHANICAL.reference),
                domain=Domain.MECHANICAL,
                imposes=Variable.THROUGH,
                units=("N", "m/s"),
                doc=f"velocity at force_source '{name}'",
            ),
        )
