"""The thermal forms: a body; between two conduction and current; environment, heat."""

from dataclasses import dataclass
from typing import Any, ClassVar, final

from piezo_sym.expressions.tree import Cmp, Sym, names, rename
from piezo_sym.spec.elements.base import Form, State, positive, state_symbol
from piezo_sym.spec.elements.domains import ELECTRICAL, THERMAL
from piezo_sym.spec.elements.marks import BodyName, BodyPair, Fields, InputName, Pair, law_field
from piezo_sym.spec.elements.ports import (
    Body,
    Branch,
    Conductor,
    Coupling,
    Exchange,
    HeatInput,
    body_node,
)


@final
@dataclass(frozen=True)
class ThermalMass(Form):
    """A body with a temperature, eqs. (8), (13) and f_h(S) of (6)."""

    letter: ClassVar[str] = "S"

    @property
    def fields(self) -> Fields:
        """Its law."""
        return {"temperature": law_field("K", {"S": "J/K"}, "T_0*exp(S/c_0)")}

    @property
    def doc(self) -> str:
        """State, co-state, energy."""
        return (
            "State S [J/K], its entropy; co-state its temperature T = temperature(S) [K]; energy "
            "the integral of T, the f_h(S) that the paper leaves to be deduced."
        )

    def port(self, element: Any, name: str, branch: Branch) -> Body:
        """Return the body."""
        del branch
        state = state_symbol(element, name)
        return Body(
            state=state,
            law=rename(element.law("temperature"), {self.letter: state}),
            temperature=f"T_{name}",
            doc=f"entropy of {element.kind} '{name}'",
        )

    def states(self, element: Any, name: str) -> tuple[State, ...]:
        """Return its entropy."""
        return (State(state_symbol(element, name), "J/K", is_entropy=True),)

    def requires(self, element: Any) -> tuple[Cmp, ...]:
        """Every parameter of the temperature law is positive."""
        words = names(element.law("temperature"))
        return tuple(positive(Sym(word)) for word in words if word != self.letter)


@final
@dataclass(frozen=True)
class Conduction(Form):
    """Heat conduction between two bodies, the irreversible process of a heat exchanger."""

    @property
    def fields(self) -> Fields:
        """Its bodies and its conductance."""
        bodies = (BodyPair, ..., ["stack", "mount"])
        conductance = law_field("W/K", {"T_1": "K", "T_2": "K"}, "lam", sees=True)
        return {"between": bodies, "conductance": conductance}

    @property
    def doc(self) -> str:
        """The process of Definition 1."""
        return (
            "The heat flow q = conductance*(T_1 - T_2) [W] runs from the first body to the second; "
            "J couples their entropies, the driving force is T_1 - T_2 and "
            "gamma = conductance/(T_1 T_2)."
        )

    def port(self, element: Any, name: str, branch: Branch) -> Conductor:
        """Return the process."""
        del branch
        first, second = element.between
        return Conductor(first, second, element.law("conductance"), f"s_{name}")


@final
@dataclass(frozen=True)
class Thermocouple(Form):
    """A current that carries entropy between two bodies: the effects of Seebeck and Peltier."""

    @property
    def fields(self) -> Fields:
        """Its nodes, bodies and Seebeck coefficient."""
        return {
            "between": (Pair, ..., [ELECTRICAL.node, ELECTRICAL.reference]),
            "bodies": (BodyPair, ..., ["cold", "hot"]),
            "seebeck": law_field("V/K", {"T_1": "K", "T_2": "K"}, "s", sees=True),
        }

    @property
    def doc(self) -> str:
        """Its two equations."""
        return (
            "The voltage of its first node relative to its second is seebeck*(T_2 - T_1) [V]; a "
            "current i from its first to its second node takes the entropy seebeck*i [W/K] out of "
            "body 1 and brings it into body 2. It is reversible: resistance and conduction are "
            "elements of their own."
        )

    def port(self, element: Any, name: str, branch: Branch) -> Coupling:
        """Return the coupling: a transformer between the branch and the temperatures."""
        first, second = map(body_node, element.bodies)
        return Coupling(
            first=branch,
            first_domain=ELECTRICAL,
            second=(second, first),
            second_domain=THERMAL,
            ratio=element.law("seebeck"),
            field="seebeck",
            name=f"seebeck_{name}",
            gyrates=False,
        )


@final
@dataclass(frozen=True)
class Ambient(Form):
    """The paper's third input, eq. (8): lam*(T_e/T - 1) into a body's entropy."""

    @property
    def fields(self) -> Fields:
        """Its body, conductance and input."""
        conductance = law_field("W/K", {"T": "K", "T_e": "K"}, "lam", sees=True)
        body, outside = (BodyName, ..., "body"), (InputName, ..., "T_e")
        return {"body": body, "conductance": conductance, "input": outside}

    @property
    def doc(self) -> str:
        """Its flow and its output."""
        return (
            "The input T_e [K] is the environment's temperature, conductance*(T_e/T - 1) [W/K] the "
            "entropy that flows into the body; the conjugate output is y = T, so that the power "
            "put in is conductance*(T_e - T) [W]."
        )

    def port(self, element: Any, name: str, branch: Branch) -> Exchange:
        """Return the exchange."""
        del name, branch
        return Exchange(element.body, element.law("conductance"), element.input)


@final
@dataclass(frozen=True)
class HeatSource(Form):
    """Heat that an input gives to a body."""

    @property
    def fields(self) -> Fields:
        """Its body and its input."""
        return {"into": (BodyName, ..., "body"), "input": (InputName, ..., "P_in")}

    @property
    def doc(self) -> str:
        """Its flow and its output."""
        return (
            "Its input is the heat P [W] that flows into the body, whose entropy rises by P/T; the "
            "conjugate output is y = T, the power put in is P. The rows exergy and environment "
            "hold for P = 0."
        )

    def port(self, element: Any, name: str, branch: Branch) -> HeatInput:
        """Return the port."""
        del name, branch
        return HeatInput(element.into, element.input)
