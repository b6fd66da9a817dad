"""The table of kinds: a row each, made of forms in domains.

A new kind is a row here, a row in ``tests/networks/kinds.py`` and a line in the checker's table.
"""

from piezo_sym.spec.elements.base import Kind
from piezo_sym.spec.elements.couplings import PairCoupling
from piezo_sym.spec.elements.domains import (
    ELECTRICAL,
    HYDRAULIC,
    ROTATION,
    TRANSLATION,
    PhysicalDomain,
    PowerVariable,
)
from piezo_sym.spec.elements.forms import Dissipation, Imposed, Store
from piezo_sym.spec.elements.storage import SharedEnergy
from piezo_sym.spec.elements.thermal import (
    Ambient,
    Conduction,
    HeatSource,
    ThermalMass,
    Thermocouple,
)
from piezo_sym.spec.elements.yielding import Yielding

ACROSS, THROUGH = PowerVariable.ACROSS, PowerVariable.THROUGH
_SPRING = Store(TRANSLATION, THROUGH, "stiffness", "N/m", "k", stiff=True, slips=True)
_CAPACITOR = Store(ELECTRICAL, ACROSS, "capacitance", "F", "C", slips=True)
_INDUCTOR = Store(ELECTRICAL, THROUGH, "inductance", "H", "L")


def _within(domain: PhysicalDomain) -> tuple[PairCoupling]:
    """Return the coupling of two pairs of one domain."""
    return (PairCoupling("ratio", "n", ("first", domain), (("second", domain, "1"),)),)


def _pair(domain: PhysicalDomain, unit: str) -> tuple[str, PhysicalDomain, str]:
    """Return the second pair of a coupling that goes by its domain, and the unit of the ratio."""
    return (domain.name, domain, unit)


TABLE = (
    Kind(
        "spring",
        (_SPRING,),
        "A spring between two nodes, eqs. (9), (10) and the fourth term of (6).",
    ),
    Kind(
        "mass",
        (Store(TRANSLATION, ACROSS, "mass", "kg", "M", at=True),),
        "A mass at a node, eq. (10) and the third term of (6).",
    ),
    Kind(
        "damper",
        (Dissipation(TRANSLATION, (THROUGH, ACROSS), "d*v"),),
        "A damper between two nodes, the damping term of eq. (10).",
    ),
    Kind(
        "stop",
        (Yielding((_SPRING, _CAPACITOR)),),
        "An elastic-plastic element between two nodes, with hysteresis of any slowness.",
    ),
    Kind("lever", _within(TRANSLATION), "An ideal lever between two pairs of nodes."),
    Kind(
        "force_source",
        (Imposed(TRANSLATION, THROUGH, "F_ext", at=True),),
        "A force on a node, F_ext of eq. (10).",
    ),
    Kind(
        "velocity_source",
        (Imposed(TRANSLATION, ACROSS, "v_in", at=True),),
        "A velocity given to a node.",
    ),
    Kind(
        "capacitor",
        (_CAPACITOR,),
        "A capacitor between two nodes, eq. (11) and the first term of (6).",
    ),
    Kind(
        "inductor",
        (_INDUCTOR,),
        "An inductor between two nodes, the storage half of a hysteron, eq. (12).",
    ),
    Kind(
        "resistor",
        (Dissipation(ELECTRICAL, (ACROSS, THROUGH), "R*i"),),
        "A resistor between two nodes, V_R of section 3.2.",
    ),
    Kind(
        "hysteron",
        (_INDUCTOR, Dissipation(ELECTRICAL, (ACROSS,), "rho/(T - T_0)*deadzone(i, i_0)")),
        "A hysteron, an inductor and a resistor in series: eq. (12), Assumption 2.",
    ),
    Kind("transformer", _within(ELECTRICAL), "An ideal transformer between two pairs of nodes."),
    Kind(
        "voltage_source",
        (Imposed(ELECTRICAL, ACROSS, "V_in"),),
        "A voltage between two nodes, V_in of eq. (12).",
    ),
    Kind(
        "current_source",
        (Imposed(ELECTRICAL, THROUGH, "i_in"),),
        "A current given into a node.",
    ),
    Kind(
        "inertia",
        (Store(ROTATION, ACROSS, "inertia", "kg*m**2", "I", at=True),),
        "A moment of inertia at a node, the rotor of a machine.",
    ),
    Kind(
        "torsion_spring",
        (Store(ROTATION, THROUGH, "stiffness", "N*m/rad", "k", stiff=True),),
        "A torsion spring between two nodes, an elastic shaft.",
    ),
    Kind(
        "rotational_damper",
        (Dissipation(ROTATION, (THROUGH, ACROSS), "d*omega"),),
        "A rotational damper between two nodes, a bearing.",
    ),
    Kind("gear", _within(ROTATION), "An ideal gear between two pairs of nodes."),
    Kind(
        "torque_source",
        (Imposed(ROTATION, THROUGH, "tau_load", at=True),),
        "A torque on a node.",
    ),
    Kind(
        "angular_velocity_source",
        (Imposed(ROTATION, ACROSS, "omega_in", at=True),),
        "An angular velocity given to a node.",
    ),
    Kind(
        "accumulator",
        (Store(HYDRAULIC, ACROSS, "capacitance", "m**3/Pa", "C"),),
        "A hydraulic accumulator between two nodes, or the compressibility of a volume.",
    ),
    Kind(
        "inertance",
        (Store(HYDRAULIC, THROUGH, "inertance", "Pa*s**2/m**3", "L"),),
        "A hydraulic inertance between two nodes, the fluid in a line that moves.",
    ),
    Kind(
        "orifice",
        (Dissipation(HYDRAULIC, (THROUGH, ACROSS), "c*dp"),),
        "An orifice between two nodes, a valve or the friction of a line.",
    ),
    Kind("flow_source", (Imposed(HYDRAULIC, THROUGH, "Q_in"),), "A flow given into a node."),
    Kind(
        "pressure_source",
        (Imposed(HYDRAULIC, ACROSS, "p_in"),),
        "A pressure between two nodes.",
    ),
    Kind(
        "transducer",
        (
            PairCoupling(
                "ratio",
                "a*T/T_0",
                ("electrical", ELECTRICAL),
                (_pair(TRANSLATION, "C/m"), ("mechanical", TRANSLATION, "C/m")),
                gyrates=True,
                warm=True,
            ),
        ),
        "A piezoelectric transducer, the relations of Assumption 2: F = ratio*V, i = ratio*v.",
    ),
    Kind(
        "motor",
        (
            PairCoupling(
                "constant",
                "k",
                ("electrical", ELECTRICAL),
                (_pair(TRANSLATION, "V*s/m"), _pair(ROTATION, "V*s/rad")),
            ),
        ),
        "A voice coil or an electrical machine, without its coil, resistance and rotor.",
    ),
    Kind(
        "rack",
        (PairCoupling("radius", "r", ("translation", TRANSLATION), (_pair(ROTATION, "m"),)),),
        "A rack and pinion, or a drum with its rope.",
    ),
    Kind(
        "cylinder",
        (
            PairCoupling(
                "area", "A", ("hydraulic", HYDRAULIC), (_pair(TRANSLATION, "m**2"),), gyrates=True
            ),
        ),
        "A hydraulic cylinder: the pressure pushes its piston.",
    ),
    Kind(
        "pump",
        (
            PairCoupling(
                "displacement",
                "D",
                ("rotation", ROTATION),
                (_pair(HYDRAULIC, "m**3/rad"),),
                gyrates=True,
            ),
        ),
        "A displacement pump, or a hydraulic motor.",
    ),
    Kind(
        "storage",
        (SharedEnergy(),),
        "A store with one energy of several states: variable inductance, gas and the like.",
    ),
    Kind("thermal_mass", (ThermalMass(),), "A body with a temperature, eqs. (8), (13)."),
    Kind("conduction", (Conduction(),), "Heat conduction between two bodies, a heat exchanger."),
    Kind(
        "thermoelectric",
        (Thermocouple(),),
        "Thermoelectric couples, a Peltier cooler or a generator, without resistance.",
    ),
    Kind(
        "ambient",
        (Ambient(),),
        "Heat exchange with the environment: the third input, eq. (8).",
    ),
    Kind("heat_source", (HeatSource(),), "Heat into a body, a heater or a heat sink."),
)
