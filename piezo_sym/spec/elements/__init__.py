"""The kinds of elements: one file each, one row here.

Adding a kind is a file beside this one, its class in `KINDS`, and a test.
"""

from collections.abc import Mapping

from piezo_sym.spec.elements.ambient import Ambient
from piezo_sym.spec.elements.base import Element
from piezo_sym.spec.elements.capacitor import Capacitor
from piezo_sym.spec.elements.conduction import Conduction
from piezo_sym.spec.elements.current_source import CurrentSource
from piezo_sym.spec.elements.damper import Damper
from piezo_sym.spec.elements.force_source import ForceSource
from piezo_sym.spec.elements.hysteron import Hysteron
from piezo_sym.spec.elements.inductor import Inductor
from piezo_sym.spec.elements.lever import Lever
from piezo_sym.spec.elements.mass import Mass
from piezo_sym.spec.elements.resistor import Resistor
from piezo_sym.spec.elements.spring import Spring
from piezo_sym.spec.elements.thermal_mass import ThermalMass
from piezo_sym.spec.elements.transducer import Transducer
from piezo_sym.spec.elements.transformer import Transformer
from piezo_sym.spec.elements.velocity_source import VelocitySource
from piezo_sym.spec.elements.voltage_source import VoltageSource

KINDS: Mapping[str, type[Element]] = {
    "spring": Spring,
    "mass": Mass,
    "capacitor": Capacitor,
    "inductor": Inductor,
    "resistor": Resistor,
    "hysteron": Hysteron,
    "damper": Damper,
    "transducer": Transducer,
    "transformer": Transformer,
    "lever": Lever,
    "thermal_mass": ThermalMass,
    "conduction": Conduction,
    "ambient": Ambient,
    "force_source": ForceSource,
    "voltage_source": VoltageSource,
    "current_source": CurrentSource,
    "velocity_source": VelocitySource,
}

__all__ = [
    "KINDS",
    "Ambient",
    "Capacitor",
    "Conduction",
    "CurrentSource",
    "Damper",
    "Element",
    "ForceSource",
    "Hysteron",
    "Inductor",
    "Lever",
    "Mass",
    "Resistor",
    "Spring",
    "ThermalMass",
    "Transducer",
    "Transformer",
    "VelocitySource",
    "VoltageSource",
]
