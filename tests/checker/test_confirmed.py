import json

import pytest
from stated import PIEZO_STACK, ROOT, SPECS, mass, refused, run, stated

MODELS = ROOT / "piezo_sym" / "models"
SHIPPED = sorted(MODELS.glob("*.toml"))

SOME = {
    "a1_two_bodies",
    "geared_motor",
    "heater",
    "hydraulic_cylinder",
    "output_resistance_of_a_bank",
    "seebeck_generator",
    "series_across_a_capacitor",
    "transducer_between_moving_nodes",
    "two_sources_on_one_input",
}


@pytest.mark.long  # `verify --recheck` asks the program, too
def test_the_shipped_spec_is_confirmed_by_the_program_itself(tmp_path):
    code, out, _ = run(tmp_path, PIEZO_STACK, stated(PIEZO_STACK))
    *lines, last = out.splitlines()
    assert code == 0
    assert [line for line in lines if not line.startswith("confirmed ")] == ["stated program"]
    assert "confirmed passive hysteron" in lines
    count = len(lines) - 1
    assert last == f"{count} of {count} rows confirmed; printed text is not read here"
    assert (code, out) == run(tmp_path, PIEZO_STACK, stated(PIEZO_STACK))[:2]


def committed(name):
    """Return what is committed with a shipped model."""
    path = ROOT / "generated" / name / "proofs.json"
    return json.loads(path.read_text(encoding="utf-8"))


@pytest.mark.some(4)
@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_every_row_of_every_shipped_model_is_confirmed(path):
    assert refused(path.read_text(encoding="utf-8"), committed(path.stem)) == {}


@pytest.mark.some(3)
@pytest.mark.parametrize(
    ("name", "old", "new", "row"),
    [
        ("electromagnet", "(g + x)/(2*mu", "(g + 2*x)/(2*mu", ("system", "")),
        ("electromagnet", 'rate = "voltage", ', 'rate = "current", ', ("system", "")),
        ("gas_piston", "**(-R/c_v)", "**(R/c_v)", ("system", "")),
        ("gas_piston", '"V_0 + A*q > 0", ', "", ("temperature", "gas")),
        ("gas_piston", "exp(S/(N*c_v))", "exp(-S/(N*c_v))", ("temperature", "gas")),
        ("hydraulic_cylinder", "max(q - x_s, 0)", "max(q - x_s, -x_s)", ("system", "")),
    ],
)
def test_a_slip_in_a_law_of_states_is_not_confirmed(name, old, new, row):
    text = (MODELS / f"{name}.toml").read_text(encoding="utf-8")
    assert text.count(old) == 1
    assert row in refused(text.replace(old, new), committed(name))


STOP = """[model]
name = "stop"
[parameters]
k = { value = 1.0, unit = "N/m" }
w = { value = 1.0, unit = "m" }
M = { value = 1.0, unit = "kg" }
[elements]
m = { kind = "mass", at = "a", mass = "M", state = "p" }
s = { kind = "spring", between = ["a", "wall"], energy = "k*max(q - w, 0)**2/2", state = "q" }
"""


@pytest.mark.parametrize("step", ["", " + (k*w**2 if q > w else 0)"])
def test_an_energy_with_a_kink_is_confirmed_and_one_that_jumps_is_not(step):
    proofs = stated(STOP)
    proofs["system"]["energy"] = f"p**2/(2*M) + k*max(q - w, 0)**2/2{step}"
    assert refused(STOP, proofs).keys() == ({("energy", "")} if step else set())


@pytest.mark.some(3)
@pytest.mark.parametrize("path", [p for p in SPECS if p.stem in SOME], ids=lambda p: p.stem)
def test_networks_are_confirmed(path):
    text = path.read_text(encoding="utf-8")
    assert refused(text, stated(text)) == {}


@pytest.mark.long
@pytest.mark.parametrize("path", SPECS, ids=lambda p: p.stem)
def test_every_network_is_confirmed(path):
    text = path.read_text(encoding="utf-8")
    assert refused(text, stated(text)) == {}


COUPLED = """[model]
name = "coupled"
[parameters]
n = { value = 2.0, unit = "1" }
M = { value = 1.0, unit = "kg" }
k = { value = 1.0, unit = "N/m" }
L = { value = 1.0, unit = "H" }
C = { value = 1.0, unit = "F" }
[elements]
m = { kind = "mass", at = "a", mass = "M" }
lever = { kind = "lever", first = ["a", "b"], second = ["a", "wall"], ratio = "n" }
s = { kind = "spring", between = ["b", "wall"], stiffness = "k" }
c = { kind = "capacitor", between = ["e", "gnd"], capacitance = "C" }
t = { kind = "transformer", first = ["f", "gnd"], second = ["e", "gnd"], ratio = "n" }
l = { kind = "inductor", between = ["f", "gnd"], inductance = "L" }
"""


def test_levers_and_transformers_are_confirmed():
    assert refused(COUPLED, stated(COUPLED)) == {}


@pytest.mark.parametrize("element", ["lever", "t"])
def test_another_ratio_is_not_confirmed(element):
    lines = COUPLED.splitlines()
    (place,) = (n for n, line in enumerate(lines) if line.startswith(f"{element} ="))
    lines[place] = lines[place].replace('"n"', '"1/n"')
    assert ("system", "") in refused("\n".join(lines), stated(COUPLED))


LOADED = """[model]
name = "loaded"
[parameters]
R = { value = 1.0, unit = "ohm" }
L = { value = 1.0, unit = "H" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 2.0, unit = "J/K" }
[inputs]
V = { unit = "V" }
[domain]
assume = ["R > 0", "L > 0", "T_0 > 0"]
[elements]
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)" }
supply = { kind = "voltage_source", between = ["in", "gnd"], input = "V" }
l = { kind = "inductor", between = ["a", "gnd"], inductance = "L" }
[elements.r]
kind = "resistor"
between = ["in", "a"]
voltage = "R*sqrt(T/T_0)*i"
heats = "body"
[elements.load]
kind = "resistor"
between = ["a", "gnd"]
current = "v/(R*sqrt(T/T_0) + R)"
heats = "body"
"""


def test_divisors_with_roots_are_those_of_the_network():
    assert refused(LOADED, stated(LOADED)) == {}


@pytest.mark.parametrize(
    "law",
    [
        "a_1*v*(2 + cos(v/v_1))",
        "F_1*(tanh(v/v_1) if v > 0 else exp(v/v_1) - 1)",
        "a_1*v + (sqrt(a/a_1)*a_1*v if a > 0 else 0)",
        "F_1*saturate(v/v_1, 1)*(1 + sin(v/v_1)/2)",
    ],
)
def test_laws_with_functions_and_guards_are_confirmed(law):
    text = mass(law)
    rows = {(row["id"], row["element"]): row["verdict"] for row in stated(text)["obligations"]}
    assert rows["passive", "damper"] == "PROVED"
    assert refused(text, stated(text)) == {}
