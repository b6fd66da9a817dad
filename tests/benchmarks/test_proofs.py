"""How long proofs take: with the number of elements, and for the actuator.  ``-s`` shows times."""

import re
import time

import pytest

from piezo_sym import derive, load, verify
from piezo_sym.proofs import decide
from piezo_sym.proofs.solvers import solver
from piezo_sym.spec.load import parse

HEAD = """
[model]
name = "many"
[parameters]
R = { value = 1.0, unit = "ohm" }
i_0 = { value = 0.1, unit = "A" }
d = { value = 1.0, unit = "N*s/m" }
v_0 = { value = 0.1, unit = "m/s" }
L = { value = 1.0, unit = "H" }
m = { value = 1.0, unit = "kg" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 1.0, unit = "J/K" }
[inputs]
V = { unit = "V" }
[domain]
assume = ["R > 0", "i_0 > 0", "d > 0", "v_0 > 0"]
[elements]
supply = { kind = "voltage_source", between = ["in", "gnd"], input = "V" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)" }
"""
COIL = """
coil_{n} = {{ kind = "inductor", between = ["in", "n{n}"], inductance = "L" }}
load_{n} = {{ kind = "resistor", between = ["n{n}", "gnd"], voltage = "{law}", heats = "body" }}
"""
MASS = """
mass_{n} = {{ kind = "mass", at = "n{n}", mass = "m" }}
load_{n} = {{ kind = "damper", between = ["n{n}", "wall"], force = "{law}", heats = "body" }}
"""
#: Each with a number in it, so that no two elements have the same law.
SHAPES = (
    "{n}*A*z",
    "A*z*(1 + {n}*T/T_0)",
    "A*{n}*deadzone(z, w)",
    "A*saturate({n}*z, w)",
    "A*z/(1 + (z/({n}*w))**2)",
    "A*z if abs(z) < {n}*w else A*({n}*z - {n}*w*({n} - 1)*sign(z))",
    "A*z*abs(z)/({n}*w)",
    "A*w*tanh(z/({n}*w))",
    "A*z*T_0/T*{n}",
    "A*w*sign(z)*sqrt(abs(z)/({n}*w))",
    "A*z + A*z**3/({n}*w**2)",
    "A*max({n}*z, z)",
)
MOST_SECONDS = 20
MOST_SECONDS_OF_THE_ACTUATOR = 3


def network(count):
    """Return a network of so many resistors and dampers, no two of them of one law."""
    parts = []
    for n in range(count):
        shape = SHAPES[n % len(SHAPES)].format(n=n + 2)
        electrical = n // len(SHAPES) % 2 == 0
        words = ("R", "i", "i_0") if electrical else ("d", "v", "v_0")
        law = named(shape, dict(zip("Azw", words, strict=True)))
        parts.append((COIL if electrical else MASS).format(n=n, law=law))
    return HEAD + "".join(parts)


def named(shape, words):
    """Return a shape with its single letters replaced: A scale, z letter, w width."""
    return re.sub(r"\b[Azw]\b", lambda found: words[found.group()], shape)


def seconds(count):
    iphs = derive(parse(network(count)))
    start = time.perf_counter()
    report = decide(iphs)
    spent = time.perf_counter() - start
    report.raise_if_not_proved()
    assert sum(row.id == "passive" for row in report.rows) == count
    return spent


def test_no_two_elements_have_the_same_law():
    laws = [line.split('"')[-4] for line in network(64).splitlines() if line.startswith("load_")]
    assert len(laws) == len(set(laws)) == 64


@pytest.mark.long
def test_time_grows_with_the_number_of_elements():
    seconds(4)  # the solver starts
    few, many = seconds(16), seconds(64)
    print(f"16 elements {few:.2f} s, 64 elements {many:.2f} s")
    assert many <= 6 * few


@pytest.mark.long
def test_sixty_four_elements_take_seconds():
    assert seconds(64) <= MOST_SECONDS


@pytest.mark.long
def test_the_actuator_takes_seconds():
    solver("z3").worker.close()
    start = time.perf_counter()
    assert verify(derive(load("piezo_stack"))).proved
    spent = time.perf_counter() - start
    print(f"{spent:.2f} s")
    assert spent <= MOST_SECONDS_OF_THE_ACTUATOR
