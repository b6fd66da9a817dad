"""Faults inside of components and cells: at the place, and in the names, in which they are written.

Names such as `left_R` are ours; whoever wrote the component knows its element `out` and its `R`.
"""

import tomllib

import pytest

from piezo_sym import Model, PiezoError, derive, verify
from piezo_sym.cli import run

LEAK = """
[model]
name = "leak"
[parameters]
C = { value = 1e-6, unit = "F" }
R = { value = 100.0, unit = "ohm*m" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 2.0, unit = "J/K" }
[domain]
assume = ["R > 0", "c > C"]
[elements]
store = { kind = "capacitor", between = ["cap", "gnd"], capacitance = "C", state = "Q" }
out = { kind = "resistor", between = ["cap", "gnd"], current = "v/R", heats = "body" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
"""
HEAD = '[model]\nname = "whole"\n'
LEFT = '[components.left]\nspec = "leak.toml"\n'
GIVEN = f"""{HEAD}
[parameters]
R_1 = {{ value = 1.0, unit = "ohm*m" }}
{LEFT}parameters = {{ R = "R_1" }}
"""
CELLS = """
[banks.pair]
count = 2
[banks.pair.elements]
r = { kind = "resistor", between = ["left.cap", "gnd"], voltage = "left_R*i", heats = "left_body" }
"""
OUT = (
    "elements.out.current: v/R is A/m, a current [A] is needed; check the unit of R: ohm would fit"
)
CONDITION = "domain.assume[1]: c is J/K and C is F in c > C, equal units are needed"


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "leak.toml").write_text(LEAK)
    (tmp_path / "middle.toml").write_text(HEAD.replace("whole", "middle") + LEFT)
    return tmp_path


@pytest.mark.parametrize("text", [HEAD + LEFT, GIVEN], ids=["own", "given"])
def test_a_wrong_unit_is_said_in_the_names_of_the_component(folder, capsys, text):
    path = folder / "whole.toml"
    path.write_text(text)
    assert run(["verify", str(path)]) == 1
    said = capsys.readouterr().out
    assert f"units of left_out: components.left: {OUT}\n" in said
    assert f"units: components.left: {CONDITION};" in said


def test_two_names_that_are_given_one_of_ours_stay_those_of_the_component(folder, capsys):
    more = LEAK.replace("R = {", 'G = { value = 1.0, unit = "ohm*m" }\nR = {')
    (folder / "leak.toml").write_text(more.replace("v/R", "v*G/R**2"))
    path = folder / "whole.toml"
    path.write_text(GIVEN.replace('R = "R_1"', 'R = "R_1", G = "R_1"').replace("R_1", "T_0"))
    assert run(["verify", str(path)]) == 1
    out = capsys.readouterr().out
    assert "components.left: elements.out.current: v*" in out
    assert "T_0" not in out.partition("elements.out.current: ")[2].partition(" is ")[0]


def test_a_parameter_of_its_own_is_declared_in_the_file_of_the_component(folder, capsys):
    (folder / "leak.toml").write_text(LEAK.replace('current = "v/R"', 'current = "c"'))
    path = folder / "whole.toml"
    path.write_text(HEAD + LEFT.replace("left", "a").replace("leak", "middle"))
    assert run(["verify", str(path)]) == 1
    said = "give one in A of its own here, declared in [parameters] of 'leak.toml'\n"
    assert said in capsys.readouterr().out


def test_one_in_a_component_of_a_component(folder, capsys):
    path = folder / "whole.toml"
    path.write_text(HEAD + LEFT.replace("left", "a").replace("leak", "middle"))
    assert run(["generate", str(path), "--out", str(folder)]) == 1
    assert f"components.a: components.left: {OUT};" in capsys.readouterr().err


def test_one_in_a_cell_of_a_bank(folder, capsys):
    path = folder / "whole.toml"
    path.write_text(HEAD + LEFT + CELLS)
    assert run(["verify", str(path)]) == 1
    assert "units of pair_r: banks.pair.elements.r.voltage: left_R*i is" in capsys.readouterr().out


def test_a_node_of_two_domains_names_the_line_that_makes_it_one():
    mass = '[elements]\nmass = { kind = "mass", at = "tip", mass = "m" }\n'
    data = tomllib.loads(f'{HEAD}[parameters]\nm = {{ value = 1.0, unit = "kg" }}\n{mass}')
    leak = {"spec": Model(**tomllib.loads(LEAK)), "nodes": {"cap": "tip"}}
    model = Model(**data, components={"left": leak})
    around = Model(model={"name": "around"}, components={"a": {"spec": model}})
    for made, front in ((model, ""), (around, "components.a: ")):
        with pytest.raises(PiezoError) as caught:
            derive(made)
        said = f"electrical in {front}components.left.nodes.cap; expected a node of one domain"
        assert str(caught.value).startswith(f"{front}elements.mass: node '")
        assert said in str(caught.value)


def test_an_element_alone_at_a_node_is_named_as_it_is_written():
    out = LEAK.replace('"gnd"], current', '"in"], current').replace('"ohm*m"', '"ohm"')
    model = Model(model={"name": "m"}, components={"left": {"spec": Model(**tomllib.loads(out))}})
    said = r"^components\.left: elements\.out: connects to 'left.in'"
    with pytest.raises(PiezoError, match=said):
        derive(model)


def test_where_it_was_written_makes_no_difference_between_models():
    leak = Model(**tomllib.loads(LEAK.replace('"ohm*m"', '"ohm"').replace(', "c > C"', "")))
    flat = Model(model={"name": "m"}, components={"left": {"spec": leak}}).flatten()
    alike = Model(**tomllib.loads(flat.to_toml()))
    assert flat == alike
    assert hash(flat) == hash(alike)
    assert verify(derive(flat)).proved
