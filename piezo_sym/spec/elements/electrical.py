"""The electrical kinds, hysteron among them, and the transducer to a mechanical pair of nodes."""

from typing import Annotated, ClassVar, Literal, final

from piezo_sym.spec.elements.base import (
    BodyName,
    Count,
    Element,
    InputName,
    Jumps,
    Law,
    Letters,
    Pair,
    Refers,
    StateName,
)
from piezo_sym.spec.elements.forms import Dissipation, Imposed, PairCoupling, Store
from piezo_sym.spec.elements.ports import PhysicalDomain, PowerVariable


@final
class Capacitor(Element):
    """A capacitor between two nodes, eq. (11) and the first term of (6).

    State Q [C], the charge that has flowed in at its first node; co-state the voltage
    V = Q/capacitance [V]; energy the integral of V, Q**2/(2*capacitance).

    Example: cap = { kind = "capacitor", between = ["cap", "gnd"], capacitance = "C", state = "Q" }
    """

    forms: ClassVar = (Store(PhysicalDomain.ELECTRICAL, PowerVariable.ACROSS, "capacitance"),)
    letter: ClassVar[str] = "Q"

    kind: Literal["capacitor"] = "capacitor"
    between: Pair
    capacitance: Annotated[Law, Letters({"Q": "C"}, unit="F")]
    state: StateName = None


@final
class Inductor(Element):
    """An inductor between two nodes, the storage half of a hysteron, eq. (12).

    State phi [Wb], the flux linkage; co-state the current i = phi/inductance [A] from its first
    node to its second; energy the integral of i, phi**2/(2*inductance).

    Example: coil = { kind = "inductor", between = ["in", "coil"], inductance = "L" }
    """

    forms: ClassVar = (Store(PhysicalDomain.ELECTRICAL, PowerVariable.THROUGH, "inductance"),)
    letter: ClassVar[str] = "phi"

    kind: Literal["inductor"] = "inductor"
    between: Pair
    inductance: Annotated[Law, Letters({"phi": "Wb"}, unit="H")]
    state: StateName = None


@final
class Resistor(Element):
    """A resistor between two nodes, V_R of section 3.2.

    Either its voltage = voltage(i, T) [V] drops along the current i [A] from its first node to
    its second, or its current = current(v, T) [A] flows under the voltage v [V] of its first node
    relative to its second; voltage times current heats a body.

    Example: wire = { kind = "resistor", between = ["in", "cap"], voltage = "R*i", heats = "body" }
    """

    forms: ClassVar = (Dissipation(PhysicalDomain.ELECTRICAL),)
    one_of: ClassVar[tuple[str, ...]] = ("voltage", "current")

    kind: Literal["resistor"] = "resistor"
    between: Pair
    voltage: Annotated[Law | None, Letters({"i": "A", "T": "K"}, unit="V")] = None
    current: Annotated[Law | None, Letters({"v": "V", "T": "K"}, unit="A")] = None
    heats: BodyName
    discontinuous: Jumps = False


@final
class Hysteron(Element):
    """A hysteron between two nodes, eq. (12), the second term of (6), Assumption 2.

    State phi [Wb], the flux linkage of its inductor; co-state the current i = phi/inductance [A];
    energy phi**2/(2*inductance).  Its resistor drops V = voltage(i, T) [V] along the current, and
    V*i heats a body.  With `count` it is a bank of lanes j = 1..count in parallel.

    Example: hysteron = { kind = "hysteron", between = ["in", "cap"], count = 2, inductance = "L",
    voltage = "rho/(T - T_0)*deadzone(i, i_0)", heats = "body", state = "phi" }
    """

    forms: ClassVar = (
        Store(PhysicalDomain.ELECTRICAL, PowerVariable.THROUGH, "inductance"),
        Dissipation(PhysicalDomain.ELECTRICAL),
    )
    letter: ClassVar[str] = "phi"

    kind: Literal["hysteron"] = "hysteron"
    between: Pair
    count: Count | None = None
    inductance: Annotated[Law, Letters({"phi": "Wb"}, unit="H")]
    voltage: Annotated[Law, Letters({"i": "A", "T": "K"}, unit="V")]
    heats: BodyName
    discontinuous: Jumps = False
    state: StateName = None


@final
class Transformer(Element):
    """An ideal transformer: v_1 = ratio*v_2 and i_2 = -ratio*i_1 between two pairs of nodes.

    Example: step_up = { kind = "transformer", first = ["in", "gnd"], second = ["out", "gnd"],
    ratio = "n" }
    """

    forms: ClassVar = (
        PairCoupling(("first", PhysicalDomain.ELECTRICAL), ("second", PhysicalDomain.ELECTRICAL)),
    )

    kind: Literal["transformer"] = "transformer"
    first: Pair
    second: Pair
    ratio: Annotated[Law, Letters({}, unit="1")]


@final
class Transducer(Element):
    """A piezoelectric transducer, the relations of Assumption 2: F = ratio*V, i = ratio*v.

    It draws ratio*v from its first electrical node and pushes its first mechanical node with
    ratio*V.  The ratio [C/m = N/V] may depend on the temperature T of the body it names.

    Example: piezo = { kind = "transducer", electrical = ["cap", "gnd"],
    mechanical = ["tip", "wall"], ratio = "a*T/T_0", temperature = "body" }
    """

    forms: ClassVar = (
        PairCoupling(
            ("electrical", PhysicalDomain.ELECTRICAL),
            ("mechanical", PhysicalDomain.MECHANICAL),
            gyrates=True,
        ),
    )

    kind: Literal["transducer"] = "transducer"
    electrical: Pair
    mechanical: Pair
    ratio: Annotated[Law, Letters({"T": "K"}, unit="C/m")]
    temperature: Annotated[BodyName | None, Refers("thermal_mass")] = None


@final
class VoltageSource(Element):
    """A voltage between two nodes, V_in of eq. (12); the conjugate output is its current.

    Example: supply = { kind = "voltage_source", between = ["in", "gnd"], input = "V_in" }
    """

    forms: ClassVar = (Imposed(PhysicalDomain.ELECTRICAL, PowerVariable.ACROSS),)

    kind: Literal["voltage_source"] = "voltage_source"
    between: Pair
    input: InputName


@final
class CurrentSource(Element):
    """A current pushed into the first node; the conjugate output is the voltage between them.

    Example: drive = { kind = "current_source", between = ["cap", "gnd"], input = "i_in" }
    """

    forms: ClassVar = (Imposed(PhysicalDomain.ELECTRICAL, PowerVariable.THROUGH),)

    kind: Literal["current_source"] = "current_source"
    between: Pair
    input: InputName


ELECTRICAL = (
    Capacitor,
    Inductor,
    Resistor,
    Hysteron,
    Transformer,
    Transducer,
    VoltageSource,
    CurrentSource,
)
