"""The thermal kinds: a body, conduction between two, and exchange with the environment."""

from typing import Annotated, ClassVar, Literal, final

from piezo_sym.expressions.tree import Cmp, Sym, names, rename
from piezo_sym.spec.elements.base import (
    BodyName,
    Element,
    InputName,
    Law,
    Letters,
    StateName,
    positive,
    state_symbol,
)
from piezo_sym.spec.elements.ports import Body, Conductor, Exchange, Port


@final
class ThermalMass(Element):
    """A body, eqs. (8), (13) and f_h(S) of (6).

    State S [J/K], its entropy; co-state its temperature T = temperature(S) [K]; energy the integral
    of T, the f_h(S) that the paper leaves to be deduced.

    Example: body = { kind = "thermal_mass", temperature = "T_0*exp(S/c_0)", state = "S" }
    """

    letter: ClassVar[str] = "S"

    kind: Literal["thermal_mass"] = "thermal_mass"
    temperature: Annotated[Law, Letters({"S": "J/K"}, unit="K")]
    state: StateName = None

    def ports(self, name: str) -> tuple[Port, ...]:
        """Return the body."""
        state = state_symbol(self, name)
        return (
            Body(
                state=state,
                law=rename(self.law("temperature"), {"S": state}),
                temperature=f"T_{name}",
                doc=f"entropy of thermal_mass '{name}'",
            ),
        )

    def requires(self) -> tuple[Cmp, ...]:
        """Every parameter of the temperature law is positive."""
        return tuple(
            positive(Sym(word)) for word in names(self.law("temperature")) if word != self.letter
        )


@final
class Conduction(Element):
    """Heat conduction between two bodies, the irreversible process of a heat exchanger.

    The heat flow q = conductance*(T_1 - T_2) [W] runs from the first body to the second; J couples
    their entropies, the driving force is T_1 - T_2 and gamma = conductance/(T_1 T_2).

    Example: contact = { kind = "conduction", between = ["stack", "mount"], conductance = "lam" }
    """

    kind: Literal["conduction"] = "conduction"
    between: tuple[BodyName, BodyName]
    conductance: Annotated[Law, Letters({}, unit="W/K")]

    def ports(self, name: str) -> tuple[Port, ...]:
        """Return the process."""
        return (
            Conductor(
                first=self.between[0],
                second=self.between[1],
                conductance=self.law("conductance"),
                output=f"s_{name}",
            ),
        )


@final
class Ambient(Element):
    """The paper's third input, eq. (8): lam*(T_e/T - 1) into the body's entropy.

    The input T_e [K] is the environment's temperature; the conjugate output is y = T, so that the
    power put in is lam*(T_e - T) [W].

    Example: air = { kind = "ambient", body = "body", conductance = "lam", input = "T_e" }
    """

    kind: Literal["ambient"] = "ambient"
    body: BodyName
    conductance: Annotated[Law, Letters({}, unit="W/K")]
    input: InputName

    def ports(self, name: str) -> tuple[Port, ...]:
        """Return the exchange."""
        del name
        return (Exchange(self.body, self.law("conductance"), self.input),)


THERMAL = (ThermalMass, Conduction, Ambient)
