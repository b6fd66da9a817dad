"""The physical domains: one row each, with its two variables and the states of its stores.

Input: nothing; this is data.  Output: `DOMAINS`.  Across/through: a branch (a, b) has across e_a -
e_b, and its through variable flows from a to b inside the element.  Messages, units and names of
quantities of a domain are read from its row.
"""

from dataclasses import dataclass
from enum import Enum
from typing import final


@final
class PowerVariable(Enum):
    """The two variables of a branch."""

    ACROSS = "across"
    THROUGH = "through"

    @property
    def other(self) -> "PowerVariable":
        """The conjugate variable."""
        return PowerVariable.THROUGH if self is PowerVariable.ACROSS else PowerVariable.ACROSS


@final
@dataclass(frozen=True)
class PhysicalVariable:
    """The across or through variable of a domain."""

    name: str  # also that of the field for a dissipative law which gives it
    #: unit, letter: its unit, and its letter in laws.
    unit: str
    letter: str
    prefix: str  # with which names of such quantities begin, ``F`` in ``F_spring``
    sense: str  # its sign convention along a branch, in words
    #: state, state_unit, state_letter: the state of a store whose co-state it is.
    state: str
    state_unit: str
    state_letter: str

    @property
    def word(self) -> str:
        """Its name in a sentence."""
        return self.name.replace("_", " ")


@final
@dataclass(frozen=True)
class PhysicalDomain:
    """A physical domain."""

    name: str  # in messages, and of the fields for a coupling's pairs of nodes
    reference: str  # the node at which the across variable is zero
    node: str  # another node, for examples
    #: across, through: its two variables.
    across: PhysicalVariable
    through: PhysicalVariable
    #: Which of them bond graphs call the effort; the other is the flow.
    effort: PowerVariable = PowerVariable.ACROSS

    @property
    def mechanical(self) -> bool:
        """Whether inertias and sources have one node, the other being the reference."""
        return self.effort is PowerVariable.THROUGH

    def variable(self, which: PowerVariable) -> PhysicalVariable:
        """Return the across or the through variable of this domain."""
        return self.across if which is PowerVariable.ACROSS else self.through


_RELATIVE = "of its first node relative to its second"
_FLOWS = "from its first node to its second"

ELECTRICAL = PhysicalDomain(
    "electrical",
    "gnd",
    "in",
    PhysicalVariable("voltage", "V", "v", "V", _RELATIVE, "charge", "C", "Q"),
    PhysicalVariable("current", "A", "i", "i", _FLOWS, "flux linkage", "Wb", "phi"),
)
TRANSLATION = PhysicalDomain(
    "translation",
    "wall",
    "tip",
    PhysicalVariable("velocity", "m/s", "v", "v", _RELATIVE, "momentum", "kg*m/s", "p"),
    PhysicalVariable(
        "force", "N", "f", "F", "that pulls its first node back", "extension", "m", "q"
    ),
    PowerVariable.THROUGH,
)
ROTATION = PhysicalDomain(
    "rotation",
    "frame",
    "shaft",
    PhysicalVariable(
        "angular_velocity", "rad/s", "omega", "omega", _RELATIVE, "angular momentum", "N*m*s", "L"
    ),
    PhysicalVariable(
        "torque", "N*m", "tau", "tau", "that turns its first node back", "twist", "rad", "theta"
    ),
    PowerVariable.THROUGH,
)
HYDRAULIC = PhysicalDomain(
    "hydraulic",
    "tank",
    "line",
    PhysicalVariable("pressure", "Pa", "dp", "dp", _RELATIVE, "volume", "m**3", "V"),
    PhysicalVariable("flow", "m**3/s", "flow", "flow", _FLOWS, "pressure impulse", "Pa*s", "G"),
)

DOMAINS = (TRANSLATION, ELECTRICAL, ROTATION, HYDRAULIC)
#: The domain in which entropy flows between bodies.  No spec can write its nodes, so only elements
#: that name bodies are connected to them.
THERMAL = PhysicalDomain(
    "thermal",
    ":zero",
    ":body",
    PhysicalVariable("temperature", "K", "T", "T", _RELATIVE, "entropy", "J/K", "S"),
    PhysicalVariable("entropy_flow", "W/K", "s", "s", _FLOWS, "thermal impulse", "K*s", "T"),
)
REFERENCES = {domain.reference: domain for domain in (*DOMAINS, THERMAL)}
