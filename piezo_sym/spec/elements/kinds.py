"""The table of kinds: a row each, made of forms in domains.

A new kind is a row here, a row in ``tests/networks/kinds.py`` and a line in the checker's table.
"""

from piezo_sym.spec.elements.base import Kind
from piezo_sym.spec.elements.couplings import PairCoupling
from piezo_sym.spec.elements.domains import (
    ELECTRICAL,
    TRANSLATION,
    PowerVariable,
)
from piezo_sym.spec.elements.forms import Dissipation, Imposed, Store
from piezo_sym.spec.elements.thermal import Ambient, Conduction, ThermalMass

ACROSS, THROUGH = PowerVariable.ACROSS, PowerVariable.THROUGH
_INDUCTOR = Store(ELECTRICAL, THROUGH, "inductance", "H", "L")

TRANSLATIONAL = (
    Kind(
        "spring",
        "A spring between two nodes, eqs. (9), (10) and the fourth term of (6).",
        (Store(TRANSLATION, THROUGH, "stiffness", "N/m", "k", stiff=True),),
    ),
    Kind(
        "mass",
        "A mass at a node, eq. (10) and the third term of (6).",
        (Store(TRANSLATION, ACROSS, "mass", "kg", "M", at=True),),
    ),
    Kind(
        "damper",
        "A damper between two nodes, the damping term of eq. (10).",
        (Dissipation(TRANSLATION, (THROUGH, ACROSS), "d*v"),),
    ),
    Kind(
        "lever",
        "An ideal lever between two pairs of nodes.",
        (PairCoupling(("first", TRANSLATION), (("second", TRANSLATION),), "ratio", ("1",), "n"),),
    ),
    Kind(
        "force_source",
        "A force on a node, F_ext of eq. (10).",
        (Imposed(TRANSLATION, THROUGH, "F_ext", at=True),),
    ),
    Kind(
        "velocity_source",
        "A velocity given to a node.",
        (Imposed(TRANSLATION, ACROSS, "v_in", at=True),),
    ),
)
ELECTRIC = (
    Kind(
        "capacitor",
        "A capacitor between two nodes, eq. (11) and the first term of (6).",
        (Store(ELECTRICAL, ACROSS, "capacitance", "F", "C"),),
    ),
    Kind(
        "inductor",
        "An inductor between two nodes, the storage half of a hysteron, eq. (12).",
        (_INDUCTOR,),
    ),
    Kind(
        "resistor",
        "A resistor between two nodes, V_R of section 3.2.",
        (Dissipation(ELECTRICAL, (ACROSS, THROUGH), "R*i"),),
    ),
    Kind(
        "hysteron",
        "A hysteron, an inductor and a resistor in series: eq. (12), Assumption 2.",
        (_INDUCTOR, Dissipation(ELECTRICAL, (ACROSS,), "rho/(T - T_0)*deadzone(i, i_0)")),
        bank=True,
    ),
    Kind(
        "transformer",
        "An ideal transformer between two pairs of nodes.",
        (PairCoupling(("first", ELECTRICAL), (("second", ELECTRICAL),), "ratio", ("1",), "n"),),
    ),
    Kind(
        "voltage_source",
        "A voltage between two nodes, V_in of eq. (12).",
        (Imposed(ELECTRICAL, ACROSS, "V_in"),),
    ),
    Kind(
        "current_source",
        "A current given into a node.",
        (Imposed(ELECTRICAL, THROUGH, "i_in"),),
    ),
)
COUPLINGS = (
    Kind(
        "transducer",
        "A piezoelectric transducer, the relations of Assumption 2: F = ratio*V, i = ratio*v.",
        (
            PairCoupling(
                ("electrical", ELECTRICAL),
                (("translation", TRANSLATION), ("mechanical", TRANSLATION)),
                "ratio",
                ("C/m", "C/m"),
                "a*T/T_0",
                gyrates=True,
                warm=True,
            ),
        ),
    ),
)
THERMAL = (
    Kind("thermal_mass", "A body with a temperature, eqs. (8), (13).", (ThermalMass(),)),
    Kind("conduction", "Heat conduction between two bodies, a heat exchanger.", (Conduction(),)),
    Kind("ambient", "Heat exchange with the environment: the third input, eq. (8).", (Ambient(),)),
)
TABLE = (*TRANSLATIONAL, *ELECTRIC, *COUPLINGS, *THERMAL)
