"""Ambient: heat exchange of a body with an environment of given temperature."""

from typing import Annotated, Literal, final

from piezo_sym.spec.elements.base import BodyName, Element, InputName, Law, Letters
from piezo_sym.spec.elements.ports import Exchange, Port


@final
class Ambient(Element):
    """The paper's third input, eq. (8): lam*(T_e/T - 1) into the body's entropy.

    The input T_e [K] is the environment's temperature; the conjugate output is y = T, so that the
    power put in is lam*(T_e - T) [W].
    """

    kind: Literal["ambient"] = "ambient"
    body: BodyName
    conductance: Annotated[Law, Letters({}, unit="W/K")]
    input: InputName

    def ports(self, name: str) -> tuple[Port, ...]:
        """Return the exchange."""
        del name
        return (Exchange(self.body, self.law("conductance"), self.input),)
