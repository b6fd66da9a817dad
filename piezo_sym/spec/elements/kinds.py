"""The table of kinds: one row per kind, made of forms in domains.

A new kind is a row here, a row in ``tests/networks/kinds.py`` and a line in the checker's table.
"""

from piezo_sym.spec.elements.base import Form
from piezo_sym.spec.elements.domains import (
    ELECTRICAL,
    HYDRAULIC,
    ROTATION,
    TRANSLATION,
    PowerVariable,
)
from piezo_sym.spec.elements.forms import coupling, dissipation, imposed, series
from piezo_sym.spec.elements.storage import SHARED_ENERGY
from piezo_sym.spec.elements.stores import Size, store, yielding
from piezo_sym.spec.elements.thermal import AMBIENT, BODY, CONDUCTION, HEAT_SOURCE, THERMOCOUPLE

ACROSS, THROUGH = PowerVariable.ACROSS, PowerVariable.THROUGH
_STIFFNESS = Size(TRANSLATION, THROUGH, "stiffness", "N/m", "k", stiff=True, slips=True)
_CAPACITANCE = Size(ELECTRICAL, ACROSS, "capacitance", "F", "C", slips=True)
_TORSION = Size(ROTATION, THROUGH, "stiffness", "N*m/rad", "k", stiff=True)
_SPRING, _CAPACITOR, _TORSION_SPRING = map(store, (_STIFFNESS, _CAPACITANCE, _TORSION))
_STOP = yielding(_STIFFNESS, _CAPACITANCE)
_MASS = store(Size(TRANSLATION, ACROSS, "mass", "kg", "M"))
_INDUCTOR = store(Size(ELECTRICAL, THROUGH, "inductance", "H", "L"))
_INERTIA = store(Size(ROTATION, ACROSS, "inertia", "kg*m**2", "I"))
_ACCUMULATOR = store(Size(HYDRAULIC, ACROSS, "capacitance", "m**3/Pa", "C"))
_INERTANCE = store(Size(HYDRAULIC, THROUGH, "inertance", "Pa*s**2/m**3", "L"))
_DAMPER = dissipation(TRANSLATION, "d*v", THROUGH, ACROSS)
_RESISTOR = dissipation(ELECTRICAL, "R*i", ACROSS, THROUGH)
_HYSTERESIS = dissipation(ELECTRICAL, "rho/(T - T_0)*deadzone(i, i_0)", ACROSS)
_BEARING = dissipation(ROTATION, "d*omega", THROUGH, ACROSS)
_ORIFICE = dissipation(HYDRAULIC, "c*dp", THROUGH, ACROSS)
_FORCE, _VELOCITY = imposed(TRANSLATION, THROUGH, "F_ext"), imposed(TRANSLATION, ACROSS, "v_in")
_CURRENT, _VOLTAGE = imposed(ELECTRICAL, THROUGH, "i_in"), imposed(ELECTRICAL, ACROSS, "V_in")
_TORQUE = imposed(ROTATION, THROUGH, "tau_load")
_ANGULAR_VELOCITY = imposed(ROTATION, ACROSS, "omega_in")
_FLOW, _PRESSURE = imposed(HYDRAULIC, THROUGH, "Q_in"), imposed(HYDRAULIC, ACROSS, "p_in")
_LEVER = coupling("ratio", "n", TRANSLATION, (TRANSLATION, "1"))
_TRANSFORMER = coupling("ratio", "n", ELECTRICAL, (ELECTRICAL, "1"))
_GEAR = coupling("ratio", "n", ROTATION, (ROTATION, "1"))
_TRANSDUCER = coupling(
    "ratio",
    "a*T/T_0",
    ELECTRICAL,
    (TRANSLATION, "C/m"),
    alias="mechanical",
    gyrates=True,
    warm=True,
)
_MOTOR = coupling("constant", "k", ELECTRICAL, (TRANSLATION, "N/A"), (ROTATION, "N*m/A"))
_RACK = coupling("radius", "r", TRANSLATION, (ROTATION, "m"))
_CYLINDER = coupling("area", "A", HYDRAULIC, (TRANSLATION, "m**2"), gyrates=True)
_PUMP = coupling("displacement", "D", ROTATION, (HYDRAULIC, "m**3/rad"), gyrates=True)

#: What each kind is, on one line, and its form.
TABLE: dict[str, tuple[str, Form]] = {
    "spring": ("A spring between two nodes, eqs. (9), (10) and the fourth term of (6).", _SPRING),
    "mass": ("A mass at a node, eq. (10) and the third term of (6).", _MASS),
    "damper": ("A damper between two nodes, the damping term of eq. (10).", _DAMPER),
    "stop": (
        "An elastic-plastic element between two nodes: hysteresis at any rate, also the slowest.",
        _STOP,
    ),
    "lever": ("An ideal lever between two pairs of nodes.", _LEVER),
    "force_source": ("A force on a node, F_ext of eq. (10).", _FORCE),
    "velocity_source": ("A velocity given to a node.", _VELOCITY),
    "capacitor": ("A capacitor between two nodes, eq. (11) and the first term of (6).", _CAPACITOR),
    "inductor": (
        "An inductor between two nodes, the storage half of a hysteron, eq. (12).",
        _INDUCTOR,
    ),
    "resistor": ("A resistor between two nodes, V_R of section 3.2.", _RESISTOR),
    "hysteron": (
        "A hysteron, an inductor and a resistor in series: eq. (12), Assumption 2.",
        series(_INDUCTOR, _HYSTERESIS),
    ),
    "transformer": ("An ideal transformer between two pairs of nodes.", _TRANSFORMER),
    "voltage_source": ("A voltage between two nodes, V_in of eq. (12).", _VOLTAGE),
    "current_source": ("A current given into a node.", _CURRENT),
    "inertia": ("A moment of inertia at a node, the rotor of a machine.", _INERTIA),
    "torsion_spring": ("A torsion spring between two nodes, an elastic shaft.", _TORSION_SPRING),
    "rotational_damper": ("A rotational damper between two nodes, a bearing.", _BEARING),
    "gear": ("An ideal gear between two pairs of nodes.", _GEAR),
    "torque_source": ("A torque on a node.", _TORQUE),
    "angular_velocity_source": ("An angular velocity given to a node.", _ANGULAR_VELOCITY),
    "accumulator": (
        "A hydraulic accumulator between two nodes, or the compressibility of a volume.",
        _ACCUMULATOR,
    ),
    "inertance": (
        "A hydraulic inertance between two nodes, the fluid in a line that moves.",
        _INERTANCE,
    ),
    "orifice": ("An orifice between two nodes, a valve or the friction of a line.", _ORIFICE),
    "flow_source": ("A flow given into a node.", _FLOW),
    "pressure_source": ("A pressure between two nodes.", _PRESSURE),
    "transducer": (
        "A piezoelectric transducer, the relations of Assumption 2: F = ratio*V, i = ratio*v.",
        _TRANSDUCER,
    ),
    "motor": (
        "A voice coil or an electrical machine, without its coil, resistance and rotor.",
        _MOTOR,
    ),
    "rack": ("A rack and pinion, or a drum with its rope.", _RACK),
    "cylinder": ("A hydraulic cylinder: the pressure pushes its piston.", _CYLINDER),
    "pump": ("A displacement pump, or a hydraulic motor.", _PUMP),
    "storage": (
        "A store with one energy of several states: variable inductance, gas and the like.",
        SHARED_ENERGY,
    ),
    "thermal_mass": ("A body with a temperature, eqs. (8), (13).", BODY),
    "conduction": ("Heat conduction between two bodies, a heat exchanger.", CONDUCTION),
    "thermoelectric": (
        "Thermoelectric couples, a Peltier cooler or a generator, without resistance.",
        THERMOCOUPLE,
    ),
    "ambient": ("Heat exchange with the environment: the third input, eq. (8).", AMBIENT),
    "heat_source": ("Heat into a body, a heater or a heat sink.", HEAT_SOURCE),
}
