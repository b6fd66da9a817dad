"""Damper: turns mechanical power into heat."""

from typing import Annotated, ClassVar, Literal, final

from piezo_sym.spec.elements.base import BodyName, Element, Jumps, Law, Letters, Pair
from piezo_sym.spec.elements.ports import Domain, Port, Resistor, Variable


@final
class Damper(Element):
    """A damper between two nodes, the damping term of eq. (10).

    Either its force = force(v, T) [N] opposes v = v_a - v_b [m/s], the velocity of its first node
    relative to its second, or its velocity = velocity(f, T) [m/s] follows the force f [N] through
    it; force times velocity heats a body.
    """

    one_of: ClassVar[tuple[str, ...]] = ("force", "velocity")

    kind: Literal["damper"] = "damper"
    between: Pair
    force: Annotated[Law | None, Letters({"v": "m/s", "T": "K"}, unit="N")] = None
    velocity: Annotated[Law | None, Letters({"f": "N", "T": "K"}, unit="m/s")] = None
    heats: BodyName
    discontinuous: Jumps = False

    def ports(self, name: str) -> tuple[Port, ...]:
        """Return the process: the force through it given the velocity, or the reverse."""
        given = self.force is not None
        return (
            Resistor(
                letter="v" if given else "f",
                law=self.law("force" if given else "velocity"),
                field="force" if given else "velocity",
                output=f"{'F' if given else 'v'}_{name}",
                effort=f"{'v' if given else 'F'}_{name}",
                branch=self.between,
                domain=Domain.MECHANICAL,
                imposes=Variable.THROUGH if given else Variable.ACROSS,
                heats=self.heats,
            ),
        )
