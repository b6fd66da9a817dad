"""Banks of cells, side by side and in series, as the checker reads them; and slips in these."""

import pytest
from stated import refused, stated

from piezo_sym.checker.laws import InputError
from piezo_sym.spec.load import parse

HEAD = """
[model]
name = "banks"
[parameters]
m   = { value = 1.5, unit = "kg" }
k   = { value = 2.0, unit = "N/m" }
k_c = { value = [1.0, 2.0, 4.0], unit = "N/m" }
d_c = { value = [3.0, 5.0, 7.0], unit = "N*s/m" }
L   = { value = 2.0, unit = "H" }
C   = { value = [1.0, 2.0], unit = "F" }
v_c = { value = 2.0, unit = "V" }
T_0 = { value = 300.0, unit = "K" }
c   = { value = 2.0, unit = "J/K" }
[domain]
assume = ["d_c > 0"]
[inputs]
F = { unit = "N" }
V = { unit = "V" }
[elements]
body   = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
mass   = { kind = "mass", at = "tip", mass = "m", state = "p" }
load   = { kind = "force_source", at = "tip", input = "F" }
link   = { kind = "spring", between = ["tip", "a"], stiffness = "k", state = "q" }
supply = { kind = "voltage_source", between = ["in", "gnd"], input = "V" }
coil   = { kind = "inductor", between = ["in", "e"], inductance = "L" }
stop   = { kind = "stop", between = ["e", "gnd"], capacitance = "C", limit = "v_c", \
heats = "body", count = 2 }
"""
CELLS = """
[banks.cell]
count = 3
series = ["a", "wall"]
[banks.cell.elements]
spring = { kind = "spring", between = ["a", "mid"], stiffness = "k_c", state = "q_c" }
damper = { kind = "damper", between = ["a", "mid"], force = "d_c*v", heats = "body" }
more   = { kind = "damper", between = ["mid", "wall"], velocity = "f/d_c", heats = "body" }
"""
PARALLEL = """
hold   = { kind = "spring", between = ["a", "wall"], stiffness = "k" }
end    = { kind = "mass", at = "a", mass = "m" }
[banks.cell]
count = 3
[banks.cell.elements]
spring = { kind = "spring", between = ["a", "mid"], stiffness = "k_c", state = "q_c" }
damper = { kind = "damper", between = ["mid", "wall"], force = "d_c*v", heats = "body" }
"""


def written(cells):
    """Return the spec with its banks written out, which is what the checker is given."""
    return parse((HEAD + cells).replace("\\\n", "")).flatten().to_toml()


@pytest.mark.parametrize("cells", [CELLS, PARALLEL], ids=["series", "parallel"])
def test_banks_are_confirmed(cells):
    text = written(cells)
    assert refused(text, stated(text)) == {}


@pytest.mark.some(3)
@pytest.mark.parametrize(
    ("cells", "old", "new"),
    [
        (CELLS, 'series = ["a", "wall"]', 'series = ["wall", "a"]'),
        (CELLS, 'velocity = "f/d_c"', 'velocity = "2*f/d_c"'),
        (CELLS, 'between = ["a", "cell.mid"]\ncount = 3', 'between = ["cell.mid", "a"]\ncount = 3'),
        (CELLS, 'capacitance = "C"', 'capacitance = "2*C"'),
        (PARALLEL, 'between = ["a", "cell.mid"]', 'between = ["tip", "cell.mid"]'),
        (PARALLEL, 'force = "d_c*v"', 'force = "2*d_c*v"'),
        (PARALLEL, '"cell.mid", "wall"]', '"cell.mid", "tip"]'),
    ],
)
def test_a_slip_in_a_bank_is_not_confirmed(cells, old, new):
    text = written(cells)
    assert old in text
    assert ("system", "") in refused(text.replace(old, new, 1), stated(text))


def is_confirmed(text, proofs):
    """Return whether every row is confirmed; a spec that cannot be read confirms none."""
    try:
        return not refused(text, proofs)
    except InputError:
        return False


@pytest.mark.some(3)
@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("count = 3", "count = 4"),
        ('bank = "cell"', 'bank = "body"'),
        ('bank = "cell"', 'bank = "other"'),
        ('series = ["a", "wall"]', 'series = ["tip", "wall"]'),
        ('series = ["a", "wall"]', ""),
        ('mass = "m"', 'mass = "m"\nbank = "cell"'),
    ],
)
def test_what_is_no_bank_confirms_nothing(old, new):
    text = written(CELLS)
    assert old in text
    assert is_confirmed(text, stated(text))
    assert not is_confirmed(text.replace(old, new, 1), stated(text))
