"""The mechanical kinds: spring, mass, damper, lever, sources of force and velocity."""

from typing import Annotated, ClassVar, Literal, final

from piezo_sym.spec.elements.base import (
    BodyName,
    Element,
    InputName,
    Jumps,
    Law,
    Letters,
    Node,
    Pair,
    StateName,
)
from piezo_sym.spec.elements.forms import Dissipation, Imposed, PairCoupling, Store
from piezo_sym.spec.elements.ports import PhysicalDomain, PowerVariable


@final
class Spring(Element):
    """A spring between two nodes, eqs. (9), (10) and the fourth term of (6).

    State q [m], the extension of its first node relative to its second; co-state the force
    F = stiffness*(q - rest) [N] with which it pulls its first node back; energy the integral of F.

    Example: stack = { kind = "spring", between = ["tip", "wall"], stiffness = "k", rest = "q_l" }
    """

    forms: ClassVar = (Store(PhysicalDomain.MECHANICAL, PowerVariable.THROUGH, "stiffness"),)
    letter: ClassVar[str] = "q"

    kind: Literal["spring"] = "spring"
    between: Pair
    stiffness: Annotated[Law, Letters({"q": "m"}, unit="N/m")]
    rest: Annotated[Law, Letters({}, unit="m")] = "0"
    state: StateName = None


@final
class Mass(Element):
    """A mass at a node, eq. (10) and the third term of (6).

    State p [kg*m/s], the momentum; co-state the velocity v = p/mass [m/s] of its node; energy the
    integral of v, p**2/(2*mass).

    Example: tip = { kind = "mass", at = "tip", mass = "M", state = "p" }
    """

    forms: ClassVar = (Store(PhysicalDomain.MECHANICAL, PowerVariable.ACROSS, "mass"),)
    letter: ClassVar[str] = "p"

    kind: Literal["mass"] = "mass"
    at: Node
    mass: Annotated[Law, Letters({"p": "kg*m/s"}, unit="kg")]
    state: StateName = None


@final
class Damper(Element):
    """A damper between two nodes, the damping term of eq. (10).

    Either its force = force(v, T) [N] opposes v = v_a - v_b [m/s], the velocity of its first node
    relative to its second, or its velocity = velocity(f, T) [m/s] follows the force f [N] through
    it; force times velocity heats a body.

    Example: drag = { kind = "damper", between = ["tip", "wall"], force = "d*v", heats = "body" }
    """

    forms: ClassVar = (Dissipation(PhysicalDomain.MECHANICAL),)
    one_of: ClassVar[tuple[str, ...]] = ("force", "velocity")

    kind: Literal["damper"] = "damper"
    between: Pair
    force: Annotated[Law | None, Letters({"v": "m/s", "T": "K"}, unit="N")] = None
    velocity: Annotated[Law | None, Letters({"f": "N", "T": "K"}, unit="m/s")] = None
    heats: BodyName
    discontinuous: Jumps = False


@final
class Lever(Element):
    """An ideal lever: v_1 = ratio*v_2 and F_2 = -ratio*F_1 between two pairs of nodes.

    Example: arm = { kind = "lever", first = ["stack", "wall"], second = ["tip", "wall"],
    ratio = "n" }
    """

    forms: ClassVar = (
        PairCoupling(("first", PhysicalDomain.MECHANICAL), ("second", PhysicalDomain.MECHANICAL)),
    )

    kind: Literal["lever"] = "lever"
    first: Pair
    second: Pair
    ratio: Annotated[Law, Letters({}, unit="1")]


@final
class ForceSource(Element):
    """A force on a node, F_ext of eq. (10); the conjugate output is the node's velocity.

    Example: load = { kind = "force_source", at = "tip", input = "F_ext" }
    """

    forms: ClassVar = (Imposed(PhysicalDomain.MECHANICAL, PowerVariable.THROUGH),)

    kind: Literal["force_source"] = "force_source"
    at: Node
    input: InputName


@final
class VelocitySource(Element):
    """A velocity given to a node; the conjugate output is the force that it takes.

    Example: stage = { kind = "velocity_source", at = "base", input = "v_base" }
    """

    forms: ClassVar = (Imposed(PhysicalDomain.MECHANICAL, PowerVariable.ACROSS),)

    kind: Literal["velocity_source"] = "velocity_source"
    at: Node
    input: InputName


MECHANICAL = (Spring, Mass, Damper, Lever, ForceSource, VelocitySource)
