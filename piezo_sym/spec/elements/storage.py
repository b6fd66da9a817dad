"""The form of a storage: one energy of several states, each driven by a variable of a branch.

It is for couplings inside matter: variable inductance, variable capacitance, gas.  At most one of
the states is an entropy; the element then is a body.
"""

from typing import Annotated, Any, Literal, final

from pydantic import Field

from piezo_sym.expressions.energies import slope
from piezo_sym.expressions.tree import Expr, names
from piezo_sym.spec.elements.base import Fault, Form, Frozen
from piezo_sym.spec.elements.domains import DOMAINS, THERMAL, PhysicalDomain, PowerVariable
from piezo_sym.spec.elements.marks import Law, Letters, Pair
from piezo_sym.spec.elements.ports import Body, Branch, Port, Storage
from piezo_sym.spec.table import Table

ENTROPY = "entropy"
#: For each rate, the domain of the state, and which variable its co-state is.
RATES: dict[str, tuple[PhysicalDomain, PowerVariable]] = {
    domain.variable(which).name: (domain, which.other)
    for domain in DOMAINS
    for which in PowerVariable
}
RATES[ENTROPY] = (THERMAL, PowerVariable.ACROSS)
Rate: Any = Literal[tuple(RATES)]


@final
class StateOf(Frozen):
    """A state of a storage: the variable of a branch that is its rate."""

    rate: Annotated[
        Rate,
        Field(description="What the state is the integral of; one state may be the entropy."),
    ]
    between: Annotated[Pair | None, Field(description="Two nodes; none for the entropy.")] = None

    @property
    def unit(self) -> str:
        """Its unit."""
        domain, imposes = RATES[self.rate]
        return domain.variable(imposes).state_unit


def _port(element: Any, name: str, symbol: str, state: StateOf, energy: Expr) -> Port:
    law = slope(energy, symbol)
    if state.rate == ENTROPY or state.between is None:
        return Body(symbol, law, f"T_{name}", f"entropy of {element.kind} '{name}'", energy)
    domain, imposes = RATES[state.rate]
    costate = domain.variable(imposes)
    return Storage(
        state=symbol,
        law=law,
        costate=f"{costate.prefix}_{symbol}",
        branch=state.between,
        domain=domain,
        imposes=imposes,
        units=(costate.state_unit, costate.unit),
        doc=f"{costate.state} of {element.kind} '{name}'",
        energy=energy,
    )


def _ports(element: Any, name: str, _: Branch) -> tuple[Port, ...]:
    """Return a port for each state; all share the energy."""
    energy, states = element.law("energy"), element.states.items()
    return tuple(_port(element, name, symbol, state, energy) for symbol, state in states)


def _fault(element: Any) -> Fault | None:
    """Return the first fault of its states: two entropies, a branch too many or few, no energy."""
    states = element.states
    entropies = [symbol for symbol, state in states.items() if state.rate == ENTROPY]
    if len(entropies) > 1:
        what = f"{' and '.join(map(repr, entropies))} are both entropies"
        remedy = "leave one out, or make a thermal_mass of it"
        return ".states", what, "one state with the rate entropy at most", remedy
    used = names(element.law("energy"))
    for symbol, state in states.items():
        where = f".states.{symbol}"
        if state.rate == ENTROPY and state.between:
            remedy = "leave between out: its heat comes from elements that say heats = '...'"
            return where, "an entropy has no branch", "rate alone", remedy
        if state.rate != ENTROPY and not state.between:
            return where, "is on no branch", "two nodes", "add between = ['first', 'second']"
        if symbol not in used:
            remedy = f"use {symbol} in the energy, or leave the state out"
            return where, "the energy does not depend on it", "an energy of every state", remedy
    return None


_STATES = Annotated[
    Table[StateOf],
    Field(
        min_length=1,
        description="Its states, by symbol, in order.",
        json_schema_extra={"minProperties": 1},
    ),
]
_WORDS = ", ".join(rate for rate in RATES if rate != ENTROPY)
_SAMPLE = {
    "phi": {"rate": "voltage", "between": ["coil", "gnd"]},
    "x": {"rate": "velocity", "between": ["armature", "wall"]},
}
SHARED_ENERGY = Form(
    fields={
        "energy": (Annotated[Law, Letters({}, "J", own=True)], ..., "phi**2*(g + x)/(2*mu*A*N**2)"),
        "states": (_STATES, ..., _SAMPLE),
    },
    doc="Its energy U [J] is a law of all of its states. Each has a rate, the across variable "
    "of its branch (`between`: first node relative to second) or the through variable "
    f"inside it, from the first node to the second: {_WORDS}; its co-state dU/dx is the "
    "conjugate variable of the branch. A state with the rate entropy makes it a body with "
    "the temperature T = dU/dS, which others may heat; there is one at most.",
    ports=_ports,
    fault=_fault,
)
