"""Networks drawn in a line per element, and what a refusal of one must be like."""

import pytest

from piezo_sym import PiezoError, derive
from piezo_sym.spec.load import parse
from tests.clock import within

HEAD = """
[model]
name = "case"
[parameters]
R   = { value = 2.0,   unit = "ohm" }
C   = { value = 0.1,   unit = "F" }
L   = { value = 0.3,   unit = "H" }
m   = { value = 1.5,   unit = "kg" }
k   = { value = 2.0,   unit = "N/m" }
d   = { value = 0.7,   unit = "N*s/m" }
a   = { value = 0.7,   unit = "C/m" }
T_0 = { value = 300.0, unit = "K" }
c   = { value = 2.0,   unit = "J/K" }
lam = { value = 2.0,   unit = "W/K" }
[inputs]
V   = { unit = "V" }
F   = { unit = "N" }
w   = { unit = "m/s" }
I   = { unit = "A" }
T_e = { unit = "K", default = 300.0 }
[elements]
"""


def line(name, kind, **fields):
    parts = [f'kind = "{kind}"', *(f"{key} = {value!r}" for key, value in fields.items())]
    return f"{name} = {{ {', '.join(parts)} }}\n"


def capacitor(name, *nodes):
    return line(name, "capacitor", between=[*nodes], capacitance="C")


def inductor(name, *nodes):
    return line(name, "inductor", between=[*nodes], inductance="L")


def resistor(name, *nodes, heats="body", **law):
    return line(name, "resistor", between=[*nodes], heats=heats, **(law or {"voltage": "R*i"}))


def spring(name, *nodes):
    return line(name, "spring", between=[*nodes], stiffness="k")


def mass(name, node):
    return line(name, "mass", at=node, mass="m")


def damper(name, *nodes, **law):
    return line(name, "damper", between=[*nodes], heats="body", **(law or {"force": "d*v"}))


def bank(name, *nodes, count=2):
    law = {"inductance": "L", "voltage": "R*i"}
    return line(name, "hysteron", between=[*nodes], count=count, heats="body", **law)


def voltage(name, *nodes, of="V"):
    return line(name, "voltage_source", between=[*nodes], input=of)


def current(name, *nodes, of="I"):
    return line(name, "current_source", between=[*nodes], input=of)


def force(name, node):
    return line(name, "force_source", at=node, input="F")


def velocity(name, node):
    return line(name, "velocity_source", at=node, input="w")


def transducer(name, electrical, mechanical, ratio="a", **body):
    nodes = {"electrical": [*electrical], "mechanical": [*mechanical]}
    return line(name, "transducer", ratio=ratio, **nodes, **body)


def coupling(name, kind, first, second, ratio="2"):
    return line(name, kind, first=[*first], second=[*second], ratio=ratio)


BODY = line("body", "thermal_mass", temperature="T_0*exp(S/c)", state="S")
OTHER = line("other", "thermal_mass", temperature="T_0*exp(S/c)", state="S2")
LC = capacitor("C1", "a", "gnd") + inductor("L1", "a", "gnd")


def spec(elements):
    needs_body = "heats = 'body'" in elements and BODY not in elements
    return HEAD + elements + (BODY if needs_body else "")


def refused(elements):
    with within(2), pytest.raises(PiezoError) as caught:
        derive(parse(spec(elements)))
    assert caught.value.exit_code == 2
    assert caught.value.remedy or caught.value.expected
    return caught.value
