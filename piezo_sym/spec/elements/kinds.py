"""The table of kinds: a row each, made of forms in domains.

A new kind is a row here, a row in ``tests/networks/kinds.py`` and a line in the checker's table.
"""

from piezo_sym.spec.elements.base import Form, Kind
from piezo_sym.spec.elements.domains import (
    ELECTRICAL,
    HYDRAULIC,
    ROTATION,
    TRANSLATION,
    PhysicalDomain,
    PowerVariable,
)
from piezo_sym.spec.elements.forms import coupling, dissipation, imposed
from piezo_sym.spec.elements.storage import SHARED_ENERGY
from piezo_sym.spec.elements.stores import Store, store, yielding
from piezo_sym.spec.elements.thermal import AMBIENT, BODY, CONDUCTION, HEAT_SOURCE, THERMOCOUPLE

ACROSS, THROUGH = PowerVariable.ACROSS, PowerVariable.THROUGH
_SPRING = Store(TRANSLATION, THROUGH, "stiffness", "N/m", "k", stiff=True, slips=True)
_CAPACITOR = Store(ELECTRICAL, ACROSS, "capacitance", "F", "C", slips=True)
_INDUCTOR = Store(ELECTRICAL, THROUGH, "inductance", "H", "L")


def _kind(name: str, about: str, *forms: Form) -> Kind:
    return Kind(name, about, forms)


def _within(domain: PhysicalDomain) -> Form:
    """Return the coupling of two pairs of one domain."""
    return coupling("ratio", "n", ("first", domain), ("second", domain, "1"))


TABLE = (
    _kind(
        "spring",
        "A spring between two nodes, eqs. (9), (10) and the fourth term of (6).",
        store(_SPRING),
    ),
    _kind(
        "mass",
        "A mass at a node, eq. (10) and the third term of (6).",
        store(Store(TRANSLATION, ACROSS, "mass", "kg", "M", at=True)),
    ),
    _kind(
        "damper",
        "A damper between two nodes, the damping term of eq. (10).",
        dissipation(TRANSLATION, "d*v", THROUGH, ACROSS),
    ),
    _kind(
        "stop",
        "An elastic-plastic element between two nodes, with hysteresis of any slowness.",
        yielding(_SPRING, _CAPACITOR),
    ),
    _kind("lever", "An ideal lever between two pairs of nodes.", _within(TRANSLATION)),
    _kind(
        "force_source",
        "A force on a node, F_ext of eq. (10).",
        imposed(TRANSLATION, THROUGH, "F_ext", at=True),
    ),
    _kind(
        "velocity_source",
        "A velocity given to a node.",
        imposed(TRANSLATION, ACROSS, "v_in", at=True),
    ),
    _kind(
        "capacitor",
        "A capacitor between two nodes, eq. (11) and the first term of (6).",
        store(_CAPACITOR),
    ),
    _kind(
        "inductor",
        "An inductor between two nodes, the storage half of a hysteron, eq. (12).",
        store(_INDUCTOR),
    ),
    _kind(
        "resistor",
        "A resistor between two nodes, V_R of section 3.2.",
        dissipation(ELECTRICAL, "R*i", ACROSS, THROUGH),
    ),
    _kind(
        "hysteron",
        "A hysteron, an inductor and a resistor in series: eq. (12), Assumption 2.",
        store(_INDUCTOR),
        dissipation(ELECTRICAL, "rho/(T - T_0)*deadzone(i, i_0)", ACROSS),
    ),
    _kind("transformer", "An ideal transformer between two pairs of nodes.", _within(ELECTRICAL)),
    _kind(
        "voltage_source",
        "A voltage between two nodes, V_in of eq. (12).",
        imposed(ELECTRICAL, ACROSS, "V_in"),
    ),
    _kind("current_source", "A current given into a node.", imposed(ELECTRICAL, THROUGH, "i_in")),
    _kind(
        "inertia",
        "A moment of inertia at a node, the rotor of a machine.",
        store(Store(ROTATION, ACROSS, "inertia", "kg*m**2", "I", at=True)),
    ),
    _kind(
        "torsion_spring",
        "A torsion spring between two nodes, an elastic shaft.",
        store(Store(ROTATION, THROUGH, "stiffness", "N*m/rad", "k", stiff=True)),
    ),
    _kind(
        "rotational_damper",
        "A rotational damper between two nodes, a bearing.",
        dissipation(ROTATION, "d*omega", THROUGH, ACROSS),
    ),
    _kind("gear", "An ideal gear between two pairs of nodes.", _within(ROTATION)),
    _kind("torque_source", "A torque on a node.", imposed(ROTATION, THROUGH, "tau_load", at=True)),
    _kind(
        "angular_velocity_source",
        "An angular velocity given to a node.",
        imposed(ROTATION, ACROSS, "omega_in", at=True),
    ),
    _kind(
        "accumulator",
        "A hydraulic accumulator between two nodes, or the compressibility of a volume.",
        store(Store(HYDRAULIC, ACROSS, "capacitance", "m**3/Pa", "C")),
    ),
    _kind(
        "inertance",
        "A hydraulic inertance between two nodes, the fluid in a line that moves.",
        store(Store(HYDRAULIC, THROUGH, "inertance", "Pa*s**2/m**3", "L")),
    ),
    _kind(
        "orifice",
        "An orifice between two nodes, a valve or the friction of a line.",
        dissipation(HYDRAULIC, "c*dp", THROUGH, ACROSS),
    ),
    _kind("flow_source", "A flow given into a node.", imposed(HYDRAULIC, THROUGH, "Q_in")),
    _kind("pressure_source", "A pressure between two nodes.", imposed(HYDRAULIC, ACROSS, "p_in")),
    _kind(
        "transducer",
        "A piezoelectric transducer, the relations of Assumption 2: F = ratio*V, i = ratio*v.",
        coupling(
            "ratio",
            "a*T/T_0",
            ("electrical", ELECTRICAL),
            ("translation", TRANSLATION, "C/m"),
            ("mechanical", TRANSLATION, "C/m"),
            gyrates=True,
            warm=True,
        ),
    ),
    _kind(
        "motor",
        "A voice coil or an electrical machine, without its coil, resistance and rotor.",
        coupling(
            "constant",
            "k",
            ("electrical", ELECTRICAL),
            ("translation", TRANSLATION, "V*s/m"),
            ("rotation", ROTATION, "V*s/rad"),
        ),
    ),
    _kind(
        "rack",
        "A rack and pinion, or a drum with its rope.",
        coupling("radius", "r", ("translation", TRANSLATION), ("rotation", ROTATION, "m")),
    ),
    _kind(
        "cylinder",
        "A hydraulic cylinder: the pressure pushes its piston.",
        coupling(
            "area",
            "A",
            ("hydraulic", HYDRAULIC),
            ("translation", TRANSLATION, "m**2"),
            gyrates=True,
        ),
    ),
    _kind(
        "pump",
        "A displacement pump, or a hydraulic motor.",
        coupling(
            "displacement",
            "D",
            ("rotation", ROTATION),
            ("hydraulic", HYDRAULIC, "m**3/rad"),
            gyrates=True,
        ),
    ),
    _kind(
        "storage",
        "A store with one energy of several states: variable inductance, gas and the like.",
        SHARED_ENERGY,
    ),
    _kind("thermal_mass", "A body with a temperature, eqs. (8), (13).", BODY),
    _kind("conduction", "Heat conduction between two bodies, a heat exchanger.", CONDUCTION),
    _kind(
        "thermoelectric",
        "Thermoelectric couples, a Peltier cooler or a generator, without resistance.",
        THERMOCOUPLE,
    ),
    _kind("ambient", "Heat exchange with the environment: the third input, eq. (8).", AMBIENT),
    _kind("heat_source", "Heat into a body, a heater or a heat sink.", HEAT_SOURCE),
)
