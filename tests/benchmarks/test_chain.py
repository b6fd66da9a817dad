"""A chain of actuators: work and text grow with the number of elements, not with its square.

Link n: a mass on a spring and a damper, a bank of hysterons that feeds a capacitor, a transducer,
and a body of its own, in contact with the next one.  ``pytest -s`` shows times and sizes.
"""

import ast
from time import process_time

import pytest

from piezo_sym import derive
from piezo_sym.codegen import lower, numpy_module
from piezo_sym.proofs import decide
from piezo_sym.spec.load import parse

HEAD = """
[model]
name = "chain"
[parameters]
M = { value = 1.0, unit = "kg" }
k = { value = 1.0, unit = "N/m" }
d = { value = 1.0, unit = "N*s/m" }
C = { value = 1.0, unit = "F" }
L = { value = 1.0, unit = "H" }
rho = { value = 1.0, unit = "ohm" }
i_0 = { value = 0.1, unit = "A" }
a = { value = 1.0, unit = "C/m" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 1.0, unit = "J/K" }
lam = { value = 1.0, unit = "W/K" }
[inputs]
V = { unit = "V" }
[domain]
assume = ["d >= 0", "rho >= 0", "lam >= 0"]
[elements]
supply = { kind = "voltage_source", between = ["in", "gnd"], input = "V" }
"""
LINK = """
s{n} = {{ kind = "spring", between = ["m{n}", "{before}"], stiffness = "k" }}
m{n} = {{ kind = "mass", at = "m{n}", mass = "M" }}
d{n} = {{ kind = "damper", between = ["m{n}", "{before}"], force = "d*v", heats = "b{n}" }}
h{n} = {{ kind = "hysteron", between = ["in", "c{n}"], count = 3, inductance = "L", \
voltage = "rho*deadzone(i, i_0)", heats = "b{n}" }}
c{n} = {{ kind = "capacitor", between = ["c{n}", "gnd"], capacitance = "C" }}
t{n} = {{ kind = "transducer", electrical = ["c{n}", "gnd"], mechanical = ["m{n}", "{before}"], \
ratio = "a*T/T_0", temperature = "b{n}" }}
b{n} = {{ kind = "thermal_mass", temperature = "T_0*exp(S/c)" }}
"""
CONTACT = 'k{n} = {{ kind = "conduction", between = ["b{n}", "b{after}"], conductance = "lam" }}\n'
MOST_SECONDS = 30


def chain(links):
    parts = [LINK.format(n=n, before=f"m{n - 1}" if n else "wall") for n in range(links)]
    parts += [CONTACT.format(n=n, after=n + 1) for n in range(links - 1)]
    return HEAD + "".join(parts)


def printed(links):
    """Return the text of a chain's module."""
    return numpy_module(lower(derive(parse(chain(links))), ""))


def measured(links):
    """Return the seconds of each stage, and the module's text."""
    start = process_time()
    iphs = derive(parse(chain(links)))
    derived = process_time()
    decide(iphs).raise_if_not_proved()
    proved = process_time()
    text = numpy_module(lower(iphs, ""))
    return (derived - start, proved - derived, process_time() - proved), text


def test_a_chains_module_grows_with_its_length():
    (_, short), long = measured(4), printed(16)
    print(f"4 links: {len(short)} characters, 16 links: {len(long)}")
    assert len(long) <= 4 * 1.2 * len(short)


@pytest.mark.long
def test_a_chain_of_a_hundred_is_derived_and_generated():
    (derived, proved, made), text = measured(100)
    print(f"derive {derived:.1f} s, verify {proved:.1f} s, generate {made:.1f} s; {len(text)}")
    ast.parse(text)
    assert derived + made <= MOST_SECONDS  # the bound that users are promised; about 6 here
