"""Damper: turns mechanical power into heat."""

from __future__ import annotations

from typing import Annotated, Literal, final

from pydantic import StrictBool

from piezo_sym.spec.elements.base import BodyName, Element, Law, Letters, Pair
from piezo_sym.spec.elements.ports import Domain, Port, Resistor, Variable


@final
class Damper(Element):
    """A damper between two nodes, the damping term of eq. (10).

    Its force F = force(v, T) [N] opposes v = v_a - v_b [m/s], the velocity of its first node
    relative to its second, and F*v heats a body.
    """

    kind: Literal["damper"] = "damper"
    between: Pair
    force: Annotated[Law, Letters(("v", "T"))]
    heats: BodyName
    discontinuous: StrictBool = False

    def ports(self, name: str) -> tuple[Port, ...]:
        """Return the process: force through it, given the velocity across it."""
        return (
            Resistor(
                letter="v",
                law=self.law("force"),
                field="force",
                output=f"F_{name}",
                effort=f"v_{name}",
                branch=self.between,
                domain=Domain.MECHANICAL,
                imposes=Variable.THROUGH,
                heats=self.heats,
            ),
        )
