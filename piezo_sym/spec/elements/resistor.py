"""Resistor: turns electrical power into heat."""

from typing import Annotated, ClassVar, Literal, final

from piezo_sym.spec.elements.base import BodyName, Element, Jumps, Law, Letters, Pair
from piezo_sym.spec.elements.ports import Domain, Port, Variable
from piezo_sym.spec.elements.ports import Resistor as ResistorPort


@final
class Resistor(Element):
    """A resistor between two nodes, V_R of section 3.2.

    Either its voltage = voltage(i, T) [V] drops along the current i [A] from its first node to
    its second, or its current = current(v, T) [A] flows under the voltage v [V] of its first node
    relative to its second; voltage times current heats a body.
    """

    one_of: ClassVar[tuple[str, ...]] = ("voltage", "current")

    kind: Literal["resistor"] = "resistor"
    between: Pair
    voltage: Annotated[Law | None, Letters({"i": "A", "T": "K"}, unit="V")] = None
    current: Annotated[Law | None, Letters({"v": "V", "T": "K"}, unit="A")] = None
    heats: BodyName
    discontinuous: Jumps = False

    def ports(self, name: str) -> tuple[Port, ...]:
        """Return the process: the voltage across it given the current, or the reverse."""
        given = self.voltage is not None
        return (
            ResistorPort(
                letter="i" if given else "v",
                law=self.law("voltage" if given else "current"),
                field="voltage" if given else "current",
                output=f"{'V' if given else 'i'}_{name}",
                effort=f"{'i' if given else 'v'}_{name}",
                branch=self.between,
                domain=Domain.ELECTRICAL,
                imposes=Variable.ACROSS if given else Variable.THROUGH,
                heats=self.heats,
            ),
        )
