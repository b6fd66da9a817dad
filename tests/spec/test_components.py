"""Models made of models: written out, named with their component, refused in one line."""

import os
import pickle
import tomllib
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from piezo_sym import Model, PiezoError, derive, load
from piezo_sym.spec import flatten
from piezo_sym.spec.load import parse
from piezo_sym.spec.source import shipped
from tests.clock import within

HEAD = '[model]\nname = "whole"\n'
CELL = """
[model]
name = "cell"
[parameters]
k = { value = 4.0, unit = "N/m", doc = "stiffness" }
d = { value = 1.0, unit = "N*s/m" }
m = { value = 2.0, unit = "kg" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 2.0, unit = "J/K" }
lam = { value = 0.5, unit = "W/K" }
[inputs]
F = { unit = "N", default = 1.0 }
T_e = { unit = "K", default = 310.0 }
[domain]
assume = ["d >= 0", "T > T_0", "T_e > T_0", "lam >= 0", "abs(F) < 1e5"]
[initial]
S = "c*log(T_e/T_0)"
q = 1e-3
[elements]
spring = { kind = "spring", between = ["tip", "inner"], stiffness = "k*(1 + 0*q**2)", state = "q" }
mount = { kind = "spring", between = ["inner", "base"], stiffness = "2.0*k" }
mass = { kind = "mass", at = "tip", mass = "m" }
middle = { kind = "mass", at = "inner", mass = "m/1e1" }
damper = { kind = "damper", between = ["tip", "base"], force = "d*v*T/T_0", heats = "body" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
air = { kind = "ambient", body = "body", conductance = "lam", input = "T_e" }
load = { kind = "force_source", at = "tip", input = "F" }
"""
TWO = """
[parameters]
d_1 = { value = 0.003, unit = "N*s/mm" }
[inputs]
T_room = { unit = "K", default = 320.0 }
[initial]
one_q = 0.5
[components.one]
spec = "cell.toml"
nodes = { base = "wall", tip = "x" }
parameters = { d = "d_1", k = 5.0 }
inputs = { T_e = "T_room" }
[components.two]
spec = "cell.toml"
nodes = { base = "x" }
without = ["load", "air"]
[elements]
bridge = { kind = "conduction", between = ["one_body", "two_body"], conductance = "one_lam" }
"""
#: TWO, written out by hand.
FLAT = """
[parameters]
d_1 = { value = 0.003, unit = "N*s/mm" }
one_k = { value = 5.0, unit = "N/m", doc = "stiffness" }
one_m = { value = 2.0, unit = "kg" }
one_T_0 = { value = 300.0, unit = "K" }
one_c = { value = 2.0, unit = "J/K" }
one_lam = { value = 0.5, unit = "W/K" }
two_k = { value = 4.0, unit = "N/m", doc = "stiffness" }
two_d = { value = 1.0, unit = "N*s/m" }
two_m = { value = 2.0, unit = "kg" }
two_T_0 = { value = 300.0, unit = "K" }
two_c = { value = 2.0, unit = "J/K" }
two_lam = { value = 0.5, unit = "W/K" }
[inputs]
T_room = { unit = "K", default = 320.0 }
one_F = { unit = "N", default = 1.0 }
two_T_e = { unit = "K", default = 310.0 }
[domain]
assume = ["d_1 >= 0", "T_one_body > one_T_0", "T_room > one_T_0", "one_lam >= 0",
  "abs(one_F) < 1e5",
  "two_d >= 0", "T_two_body > two_T_0", "two_T_e > two_T_0", "two_lam >= 0"]
[initial]
one_S = "one_c*log(T_room/one_T_0)"
one_q = 0.5
two_S = "two_c*log(two_T_e/two_T_0)"
two_q = 1e-3
[elements.one_spring]
kind = "spring"
between = ["x", "one.inner"]
stiffness = "one_k*(1 + 0*q**2)"
state = "one_q"
[elements.one_mount]
kind = "spring"
between = ["one.inner", "wall"]
stiffness = "2.0*one_k"
state = "one_q_mount"
[elements.one_mass]
kind = "mass"
at = "x"
mass = "one_m"
state = "one_p_mass"
[elements.one_middle]
kind = "mass"
at = "one.inner"
mass = "one_m/1e1"
state = "one_p_middle"
[elements.one_damper]
kind = "damper"
between = ["x", "wall"]
force = "d_1*v*T/one_T_0"
heats = "one_body"
[elements.one_body]
kind = "thermal_mass"
temperature = "one_T_0*exp(S/one_c)"
state = "one_S"
[elements.one_air]
kind = "ambient"
body = "one_body"
conductance = "one_lam"
input = "T_room"
[elements.one_load]
kind = "force_source"
at = "x"
input = "one_F"
[elements.two_spring]
kind = "spring"
between = ["two.tip", "two.inner"]
stiffness = "two_k*(1 + 0*q**2)"
state = "two_q"
[elements.two_mount]
kind = "spring"
between = ["two.inner", "x"]
stiffness = "2.0*two_k"
state = "two_q_mount"
[elements.two_mass]
kind = "mass"
at = "two.tip"
mass = "two_m"
state = "two_p_mass"
[elements.two_middle]
kind = "mass"
at = "two.inner"
mass = "two_m/1e1"
state = "two_p_middle"
[elements.two_damper]
kind = "damper"
between = ["two.tip", "x"]
force = "two_d*v*T/two_T_0"
heats = "two_body"
[elements.two_body]
kind = "thermal_mass"
temperature = "two_T_0*exp(S/two_c)"
state = "two_S"
[elements.bridge]
kind = "conduction"
between = ["one_body", "two_body"]
conductance = "one_lam"
"""


@pytest.fixture
def whole(tmp_path):
    """Return a function that loads a spec which may have cell.toml as a component."""
    (tmp_path / "cell.toml").write_text(CELL)

    def loaded(text, name="whole.toml"):
        (tmp_path / name).write_text(HEAD + text)
        return load(tmp_path / name)

    loaded.folder = tmp_path
    return loaded


def test_components_are_what_a_user_would_write_by_hand(whole):
    flat, hand = whole(TWO).flatten(), parse(HEAD + FLAT)
    for table in type(flat).model_fields:
        assert getattr(flat, table) == getattr(hand, table), table
    assert flat == hand
    assert not flat.components
    assert flat.flatten() is flat


def test_a_model_and_its_flat_one_are_the_same_spec(whole):
    model = whole(TWO)
    assert model.sha256 == model.flatten().sha256 == parse(model.flatten().to_toml()).sha256
    assert derive(model).model == derive(model.flatten()).model == model.flatten()
    assert pickle.loads(pickle.dumps(model)) == model


def test_the_text_of_a_model_gives_an_equal_one_in_the_same_folder(whole):
    model = whole(TWO)
    text = model.to_toml()
    assert tomllib.loads(text)["components"]["one"] == {
        "spec": "cell.toml",
        "nodes": {"base": "wall", "tip": "x"},
        "parameters": {"d": "d_1", "k": 5.0},
        "inputs": {"T_e": "T_room"},
    }
    assert whole(text.removeprefix(HEAD), "again.toml") == model


def test_python_gives_models_or_shipped_names(whole):
    cell = load(whole.folder / "cell.toml")
    data = tomllib.loads(HEAD + TWO)
    for row in data["components"].values():
        row["spec"] = cell
    made = Model(**data)
    assert made == whole(TWO)
    assert made.to_toml() == made.flatten().to_toml()  # no text can name the component
    one = {"spec": "piezo_stack", "without": ["load"]}
    assert Model(model={"name": "m"}, components={"left": one}).to_toml() == (
        '[model]\nname = "m"\n\n[components.left]\nspec = "piezo_stack"\nwithout = ["load"]\n'
    )


def test_components_of_components(whole):
    (whole.folder / "pair.toml").write_text(HEAD.replace("whole", "pair") + TWO)
    model = whole(
        """
        [parameters]
        k_s = { value = 7.0, unit = "N/m" }
        [components.in]
        spec = "pair.toml"
        nodes = { x = "y", "two.tip" = "z" }
        parameters = { two_k = "k_s", one_k = 1 }
        inputs = { }
        without = ["two_middle", "two_mount", "bridge"]
        [elements.link]
        kind = "spring"
        between = ["z", "in.two.inner"]
        stiffness = "in_two_k + k_s"
        """.replace("in_two_k", "in_two_m*0*k_s/in_two_m")
    ).flatten()
    assert "in_two_k" not in model.parameters
    assert model.parameters["in_one_k"].value == 1
    assert model.elements["in_two_spring"].stiffness == "k_s*(1 + 0*q**2)"
    assert model.elements["in_two_spring"].between == ("z", "in.two.inner")
    assert model.elements["in_one_damper"].between == ("y", "wall")
    assert model.elements["in_one_damper"].force == "in_d_1*v*T/in_one_T_0"
    assert model.domain.assume[1] == "T_in_one_body > in_one_T_0"
    assert model.initial["in_one_q"] == 0.5
    assert [*model.elements][-1] == "link"


def test_the_temperature_of_the_only_body_has_a_name_as_well(whole):
    model = whole('[components.a]\nspec = "cell.toml"\nnodes = { base = "wall" }\n')
    assert model.flatten().domain.assume[1] == "T_a_body > a_T_0"
    assert [str(symbol) for symbol in derive(model).S.free_symbols] == ["a_S"]


def test_inputs_go_with_the_elements_that_used_them(whole):
    text = '[components.a]\nspec = "cell.toml"\nnodes = { base = "wall" }\nwithout = '
    model = whole(text + '["load", "air", "body", "damper"]').flatten()
    assert not model.inputs  # T_e stood in the initial value of a state that is gone, too
    assert model.domain.assume == ("a_d >= 0", "a_lam >= 0")
    assert dict(model.initial) == {"a_q": 1e-3}
    assert [*whole(text + '["load"]').flatten().inputs] == ["a_T_e"]
    assert [*whole(text + '["air"]').flatten().inputs] == ["a_F", "a_T_e"]  # S starts with it


def test_shipped_specs_are_components_by_name():
    for name in shipped():
        alone = load(name)
        model = Model(model={"name": "m"}, components={"a": {"spec": name}}).flatten()
        assert [*model.elements] == [f"a_{element}" for element in alone.elements]
        assert derive(model).expand().x.shape == derive(alone).expand().x.shape


ONE = '[components.one]\nspec = "cell.toml"\nnodes = { base = "wall" }\n'
REFUSED = {
    '[components.one]\nspec = "cel.toml"': "components.one.spec: 'cel.toml' is no file there",
    '[components.one]\nspec = "piezo_stak"': "did you mean 'piezo_stack'?",
    '[components.one]\nspec = "../cell.toml"': "'../cell.toml' leads out of the spec's folder",
    '[components.one]\nspec = "/etc/hosts"': "'/etc/hosts' leads out of the spec's folder",
    '[components.one]\nspec = "out.toml"': "'out.toml' leads out of the spec's folder",
    '[components.one]\nspec = "pipe.toml"': "'pipe.toml' is no file there",
    '[components.one]\nspec = "loop.toml"': "'loop.toml' is no file there",
    '[components.one]\nspec = "."': "'.' is no file there",
    '[components.one]\nspec = ""': "'' is no file there",
    '[components.one]\nspec = "a\\u0000"': "'a\\x00' is no file there",
    "[components.one]\nspec = 3": "components.one.spec: 3 is no spec; expected a shipped name",
    '[components.one]\nnodes = { tip = "x" }': "components.one.spec: is missing; add it",
    '[components]\none = "cell.toml"': "components.one: 'cell.toml' does not fit",
    ONE.replace("nodes", "node"): "components.one.node: unknown key 'node'; did you mean 'nodes'?",
    ONE + "node = 3": "components.one.node: unknown key 'node'; did you mean 'nodes'?",
    ONE.replace("base", "bse"): "components.one.nodes.bse: 'bse' is no node of 'cell'; did you mea",
    ONE.replace("base", "gnd"): "'gnd' is a reference, the same node in all models; leave it out",
    ONE.replace("base", "wall"): "'wall' is a reference, the same node in all models; leave it out",
    ONE.replace("wall", "a b"): "components.one.nodes.base: 'a b' is not a label",
    ONE + "parameters = { dd = 1 }": "components.one.parameters.dd: 'dd' is no parameter of 'cell'",
    ONE + "parameters = { d = 'd_0' }": "components.one.parameters.d: 'd_0' is no parameter of this"
    " spec; expected a number in the component's unit, N*s/m, or a parameter; declare it in "
    "[parameters]: d_0 = { value = 1.0, "
    'unit = "N*s/m" }',
    ONE + "parameters = { d = '2*d' }": "'2*d' is no parameter of this spec; expected a number in "
    "the component's unit, N*s/m, or a parameter",
    ONE + "parameters = { d = 'M' }\n[parameters]\nM = { value = 1.0, unit = 'kg' }": "components."
    "one.parameters.d: 'M' is a mass [kg]; expected a quantity in N*s/m",
    ONE + "parameters = { d = true }": "components.one.parameters.d: 'True' does not fit",
    ONE + "parameters = { d = [1.0, 2.0] }": "components.one: parameters.d.value: a list is given",
    ONE + "parameters = { k = -1 }": "components.one: elements.spring: the values given are outside"
    " the domain: one_k = -1",
    ONE + "parameters = { d = -1 }": "components.one: domain.assume[0]: the values given are outsid"
    "e the domain: one_d = -1",
    ONE + "inputs = { T = 'T_r' }": "components.one.inputs.T: 'T' is no input of 'cell'; known: F, "
    "T_e",
    ONE
    + "inputs = { T_e = 'T_r' }": "components.one.inputs.T_e: 'T_r' is no input of this spec; ex"
    'pected an input; declare it in [inputs]: T_r = { unit = "K" }',
    ONE
    + "inputs = { T_e = 'F' }\n[inputs]\nF = { unit = 'N' }": "components.one.inputs.T_e: 'F' is"
    " a force [N]; expected a temperature [K]",
    ONE + "without = ['lod']": "components.one.without: 'lod' is no element of 'cell'; did you mean"
    " 'load'?",
    ONE
    + "without = ['body']": "components.one.without: elements.damper.heats, elements.air.body na"
    "me 'body', which is left out; leave out 'damper', 'air' too",
    ONE
    + "without = ['body', 'air']": "components.one.without: elements.damper.heats names 'body', "
    "which is left out; leave out 'damper' too",
    ONE
    + "without = ['spring', 'mount', 'mass', 'middle', 'damper', 'body', 'air', 'load']": "leave"
    "s out all elements",
    ONE
    + "[parameters]\none_d = { value = 1.0, unit = 'kg' }": "components.one: parameters.d: would"
    " be called 'one_d', like parameters.one_d; rename one of them, or the component",
    ONE
    + "[inputs]\none_F = { unit = 'N' }": "components.one: inputs.F: would be called 'one_F', l",
    ONE
    + "[inputs]\none_d = { unit = 'N' }": "'one_d' is already that of components.one: parameters.d",
    ONE
    + "[parameters]\none_q = { value = 1.0, unit = 'm' }": "components.one: elements.spring: sym"
    "bol 'one_q' is already that of parameters.one_q",
    ONE
    + "[elements]\none_body = { kind = 'mass', at = 'tip', mass = 'one_m' }": "elements.one_body:"
    " would be called 'one_body', like components.one: elements.body",
    ONE
    + ONE.replace(
        "components.one", "components.One"
    ): "components.One: elements.spring: 'One_spring' and 'one_spring' differ only by case",
    ONE.replace(".one", ".a-b"): "components.a-b: 'a-b' is not a name",
    ONE.replace(".one", '."1 x"'): "components.1 x: '1 x' is not a name",
    ONE.replace(".one", f".{'a' * 36}"): "is not a label; expected up to 40 letters",
    ONE + "[initial]\none_x = 1.0": "initial.one_x: 'one_x' is no state of this spec",
    ONE.replace(
        "cell", "bad"
    ): "whole.toml: components.one: bad.toml: elements.spring.stiffness: unk"
    "nown name 'K'; did you mean",
    ONE.replace(
        "cell", "itself"
    ): "components.one: itself.toml: components.part: other.toml: compone"
    "nts.part: 'itself.toml' is a component of itself: itself.toml -> other.toml -> itself.toml; "
    "expected components without a cycle; leave it out of 'other.toml', or move what both need to a"
    " third file",
    ONE.replace("cell", "whole"): "'whole.toml' is a component of itself: whole.toml -> whole.toml",
}


@pytest.mark.parametrize("text", REFUSED)
def test_what_does_not_fit_is_refused_in_one_line(whole, text):
    folder = whole.folder
    (folder / "bad.toml").write_text(CELL.replace('"k*(1', '"K*(1'))
    for name, part in (("itself", "other"), ("other", "itself")):
        spec = f'[model]\nname = "{name}"\n[components.part]\nspec = "{part}.toml"\n'
        (folder / f"{name}.toml").write_text(spec)
    (folder / "out.toml").symlink_to(Path(__file__))
    (folder / "loop.toml").symlink_to(folder / "loop.toml")
    os.mkfifo(folder / "pipe.toml")
    with pytest.raises(PiezoError) as caught:
        whole(text)
    said = str(caught.value)
    assert said.startswith("whole.toml: ")
    assert REFUSED[text] in said
    assert said.count("\n") == 0


def test_a_text_without_a_file_has_shipped_components_only():
    assert parse(HEAD + '[components.a]\nspec = "piezo_stack"').components
    with pytest.raises(PiezoError, match=r"no shipped spec; shipped: .*piezo_stack"):
        parse(HEAD + '[components.a]\nspec = "cell.toml"')


def test_a_folder_of_parts_is_below_the_spec(whole):
    (whole.folder / "parts").mkdir()
    (whole.folder / "parts" / "cell.toml").write_text(CELL)
    (whole.folder / "parts" / "pair.toml").write_text(HEAD + TWO)
    (whole.folder / "parts" / "up.toml").write_text(HEAD + ONE.replace("cell", "../cell"))
    assert whole(ONE.replace("cell", "parts/pair").partition("nodes")[0]).flatten().elements
    with pytest.raises(PiezoError, match=r"up\.toml: components\.one\.spec: .* leads out"):
        whole(ONE.replace("cell", "parts/up"))


#: Specs that would be large, deep or long; each is refused, or loads, within seconds.
HOSTILE = {
    "ten thousand components": "".join(
        f'[components.c{n}]\nspec = "cell.toml"\n' for n in range(10_000)
    ),
    "a huge name": f'[components.{"a" * 400_000}]\nspec = "cell.toml"\n',
    "a huge path": f'[components.a]\nspec = "{"a" * 400_000}"\n',
    "a huge node": f'[components.a]\nspec = "cell.toml"\nnodes = {{ {"a" * 400_000} = "b" }}\n',
    "a deep chain": '[components.a]\nspec = "deep0.toml"\n',
    "a doubling": '[components.a]\nspec = "twice0.toml"\n',
}


@pytest.mark.some(2)
@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_specs_are_refused_soon(whole, name, monkeypatch):
    monkeypatch.setattr(flatten, "MOST_ELEMENTS", 500)
    head = '[model]\nname = "m"\n'
    for n in range(5000 if name == "a deep chain" else 0):
        part = f'{head}[components.a]\nspec = "deep{n + 1}.toml"\n'
        (whole.folder / f"deep{n}.toml").write_text(part)
    for n in range(18):
        part = f'[components.X]\nspec = "twice{n + 1}.toml"\n'
        text = head + part.replace("X", "a") + part.replace("X", "b")
        (whole.folder / f"twice{n}.toml").write_text(text)
    (whole.folder / "twice18.toml").write_text(CELL)
    with within(10), pytest.raises(PiezoError) as caught:
        whole(HOSTILE[name])
    assert len(str(caught.value)) < 1000


NAMES = st.sampled_from(["a", "b", "ab", "left", "x_1", "Q"])


@settings(max_examples=10, deadline=None)
@given(st.data(), NAMES, st.sampled_from(["k", "d", "m", "lam"]))
def test_a_component_is_its_model_with_other_names(data, name, parameter):
    """Written out alone, a component derives to its own system, renamed."""
    cell = parse(CELL.replace('"base"', '"wall"'))
    value = data.draw(st.integers(1, 9), label=parameter)
    own = Model(
        **{
            **dict(cell),
            "parameters": {
                n: p.model_copy(update={"value": float(value)}) if n == parameter else p
                for n, p in cell.parameters.items()
            },
        }
    )
    component = {"spec": cell, "parameters": {parameter: value}}
    made = derive(Model(model=cell.model, components={name: component}))
    alone = derive(own)
    assert [str(x) for x in made.x] == [f"{name}_{x}" for x in alone.x]
    words = [*cell.parameters, *cell.inputs, *(str(x) for x in alone.x)]
    front = {alone.symbols[w]: made.symbols[f"{name}_{w}"] for w in words}
    for matrix in ("J0", "rhs", "g"):
        one, other = getattr(alone.expand(), matrix), getattr(made.expand(), matrix)
        assert one.xreplace(front) == other
