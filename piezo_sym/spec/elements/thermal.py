"""The thermal forms: a body; between two conduction and current; environment, heat."""

from typing import Any

from piezo_sym.expressions.tree import Cmp, Sym, names, rename
from piezo_sym.spec.elements.base import ENTROPY_UNIT, Form, positive, state_symbol
from piezo_sym.spec.elements.domains import ELECTRICAL, THERMAL
from piezo_sym.spec.elements.marks import BodyName, BodyPair, InputName, Pair, law_field
from piezo_sym.spec.elements.ports import (
    Body,
    Branch,
    Conductor,
    Coupling,
    Exchange,
    HeatInput,
    Port,
    body_node,
)


def _body(element: Any, name: str, _: Branch) -> tuple[Port, ...]:
    state, doc = state_symbol(element, name), f"entropy of {element.kind} '{name}'"
    law = rename(element.law("temperature"), {element.letter: state})
    return (Body(state, law, f"T_{name}", doc),)


def _all_positive(element: Any, _: str) -> tuple[Cmp, ...]:
    """Return that every parameter of the temperature law is positive."""
    words = names(element.law("temperature"))
    return tuple(positive(Sym(word)) for word in words if word != element.letter)


def _thermocouple(element: Any, name: str, branch: Branch) -> tuple[Port, ...]:
    """Return the coupling: a transformer between the branch and the temperatures."""
    first, second = map(body_node, element.bodies)
    port = Coupling(
        first=branch,
        first_domain=ELECTRICAL,
        second=(second, first),
        second_domain=THERMAL,
        ratio=element.law("seebeck"),
        field="seebeck",
        name=f"seebeck_{name}",
        gyrates=False,
    )
    return (port,)


#: A body with a temperature, eqs. (8), (13) and f_h(S) of (6).
BODY = Form(
    fields={"temperature": law_field("K", {"S": ENTROPY_UNIT}, "T_0*exp(S/c_0)")},
    doc="State S [J/K], its entropy; co-state its temperature T = temperature(S) [K]; energy "
    "the integral of T, the f_h(S) that the paper leaves to be deduced.",
    ports=_body,
    letter="S",
    unit=lambda _: ENTROPY_UNIT,
    requires=_all_positive,
)
#: The irreversible process of a heat exchanger, that of Definition 1.
CONDUCTION = Form(
    fields={
        "between": (BodyPair, ..., ["stack", "mount"]),
        "conductance": law_field("W/K", {"T_1": "K", "T_2": "K"}, "lam", sees=True),
    },
    doc="The heat flow q = conductance*(T_1 - T_2) [W] runs from the first body to the second; "
    "J couples their entropies, the driving force is T_1 - T_2 and "
    "gamma = conductance/(T_1 T_2). The conductance may use T_1 and T_2, with powers and roots, as "
    "lam*((T_1 + T_2)/(2*T_0))**(1/2), but must not jump.",
    ports=lambda element, name, _: (
        Conductor(element.between[0], element.between[1], element.law("conductance"), f"s_{name}"),
    ),
)
#: A current that carries entropy between two bodies: the effects of Seebeck and Peltier.
THERMOCOUPLE = Form(
    fields={
        "between": (Pair, ..., [ELECTRICAL.node, ELECTRICAL.reference]),
        "bodies": (BodyPair, ..., ["cold", "hot"]),
        "seebeck": law_field("V/K", {"T_1": "K", "T_2": "K"}, "s", sees=True),
    },
    doc="The voltage of its first node relative to its second is seebeck*(T_2 - T_1) [V]; a "
    "current i from its first to its second node takes the entropy seebeck*i [W/K] out of "
    "body 1 and brings it into body 2. It is reversible: resistance and conduction are "
    "elements of their own.",
    ports=_thermocouple,
)
#: The paper's third input, eq. (8): lam*(T_e/T - 1) into a body's entropy.
AMBIENT = Form(
    fields={
        "body": (BodyName, ..., "body"),
        "conductance": law_field("W/K", {"T": "K", "T_e": "K"}, "lam", sees=True),
        "input": (InputName, ..., "T_e"),
    },
    doc="The input T_e [K] is the environment's temperature, conductance*(T_e/T - 1) [W/K] the "
    "entropy that flows into the body; the conjugate output is y = T, so that the power "
    "put in is conductance*(T_e - T) [W]. The conductance may use T and T_e, with powers and "
    "roots, as sigma*(T + T_e)*(T**2 + T_e**2) for radiation, but must not jump.",
    ports=lambda element, *_: (Exchange(element.body, element.law("conductance"), element.input),),
)
HEAT_SOURCE = Form(
    fields={"into": (BodyName, ..., "body"), "input": (InputName, ..., "P_in")},
    doc="Its input is the heat P [W] that flows into the body, whose entropy rises by P/T; the "
    "conjugate output is y = T, the power put in is P. The rows exergy and environment "
    "hold for P = 0.",
    ports=lambda element, *_: (HeatInput(element.into, element.input),),
)
