"""The ports between an element and its network.

Input: nothing; these are the types.  Output: frozen records that `network` connects and `iphs`
reads.  They hold the laws of elements, and know nothing of matrices.
"""

from dataclasses import dataclass
from typing import ClassVar, final

from piezo_sym.expressions.tree import Expr
from piezo_sym.spec.elements.domains import THERMAL, PhysicalDomain, PowerVariable

Branch = tuple[str, str]


@final
@dataclass(frozen=True)
class Storage:
    """An energy store: its state x, and its co-state dU/dx imposed on a branch."""

    state: str  # symbol of the state
    law: Expr  # the co-state dU/dx as a function of states and parameters
    costate: str  # name of the co-state, such as ``v_mass``
    branch: Branch
    domain: PhysicalDomain
    imposes: PowerVariable  # which variable the co-state is; the state's rate is the other one
    units: tuple[str, str]  # of the state and of the co-state
    doc: str  # one line on the state
    #: U as a function of states, the same for all stores that share it; None for the integral of
    #: `law` over the state.
    energy: Expr | None = None


@final
@dataclass(frozen=True)
class DissipativePort:
    """An irreversible process: output W = law(z, T), power W*z turned into heat of a body."""

    #: The letter of the conjugate variable z in `law`; T is the heated body's temperature.
    letter: str
    law: Expr
    field: str  # the name of the law in the spec, for messages
    output: str  # name of W, such as ``V_hysteron``
    effort: str  # name of z, used where z is not just a co-state
    branch: Branch
    domain: PhysicalDomain
    imposes: PowerVariable  # which variable W is; z is the other one
    heats: str  # the element whose body takes the heat
    written: Expr | None = None  # the law of the spec, in its own letter, if `law` is its inverse
    #: rate_letter, rate, state: for a slip, the letter of the driving rate in `law`, the name of
    #: that rate, and the state x of the store that slips: x' = rate - W.
    rate_letter: str = ""
    rate: str = ""
    state: str = ""
    #: For a stop, the largest effort; `rhs` evaluates `law`, steps follow the exact path.
    limit: Expr | None = None


@final
@dataclass(frozen=True)
class Coupling:
    """A power-preserving coupling of two branches.

    If it `gyrates`, through_1 = ratio*across_2 and through_2 = -ratio*across_1; else it is a
    transformer, across_1 = ratio*across_2 and through_2 = -ratio*through_1.  The ratio may depend
    on states and temperatures.
    """

    first: Branch
    first_domain: PhysicalDomain
    second: Branch
    second_domain: PhysicalDomain
    ratio: Expr
    field: str
    name: str
    gyrates: bool


@final
@dataclass(frozen=True)
class Source:
    """A port: an input imposed on a branch; y is conjugate, y*u is the power put in.

    A through source pushes its input into its first node; an across source sets e_a - e_b.
    """

    input: str
    branch: Branch
    domain: PhysicalDomain
    imposes: PowerVariable
    input_unit: str
    output_unit: str
    doc: str


@final
@dataclass(frozen=True)
class Body:
    """A body: its state is the entropy S, its temperature dU/dS = law; `energy` as in `Storage`.

    If couplings carry entropy in or out of it, it has a branch with T across and S' through.
    """

    domain: ClassVar[PhysicalDomain] = THERMAL
    imposes: ClassVar[PowerVariable] = PowerVariable.ACROSS
    units: ClassVar[tuple[str, str]] = ("J/K", "K")

    state: str
    law: Expr
    temperature: str
    doc: str
    energy: Expr | None = None


def body_node(element: str) -> str:
    """Return the node of a body in the thermal domain (no spec can write the colon)."""
    return f"{element}:body"


@final
@dataclass(frozen=True)
class Exchange:
    """Heat exchange with an environment: input conductance*(T_e/T - 1), y = T."""

    body: str
    conductance: Expr
    input: str
    input_unit: ClassVar[str] = "K"


@final
@dataclass(frozen=True)
class HeatInput:
    """Heat P from an input into a body: its entropy rises by P/T; y = T, power P."""

    body: str
    input: str
    input_unit: ClassVar[str] = "W"


@final
@dataclass(frozen=True)
class Conductor:
    """Heat conduction between two bodies: entropy conductance*(T_1 - T_2)/T_1 leaves the first."""

    #: first, second: elements of the two bodies.
    first: str
    second: str
    conductance: Expr
    output: str  # name of the entropy flow out of the first body


Port = Storage | DissipativePort | Coupling | Source | Body | Exchange | HeatInput | Conductor
