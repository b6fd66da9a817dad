"""Nodes and references drawn wrongly: each refusal names the culprit and says what to do."""

import re

import pytest
from drawing import (
    BODY,
    LC,
    OTHER,
    bank,
    capacitor,
    coupling,
    damper,
    force,
    inductor,
    line,
    mass,
    refused,
    resistor,
    spec,
    spring,
    transducer,
    voltage,
)

from piezo_sym import cli
from piezo_sym.errors import NetworkError, SpecError
from piezo_sym.spec.load import parse

NODES = {
    "a node that one element uses": (
        capacitor("C1", "a", "gnd") + inductor("L1", "a", "b"),
        "elements.L1: connects to 'b', which no other element uses",
        "or add an electrical element there",
    ),
    "a node with a typing error": (
        mass("m1", "tip") + spring("s", "tpi", "wall") + damper("d1", "tip", "wall") + BODY,
        "elements.s: connects to 'tpi', which no other element uses",
        "did you mean 'tip'?",
    ),
    "a bank at a node with a typing error": (
        voltage("s", "in", "gnd") + bank("h", "in", "capp") + LC.replace("'a'", "'cap'") + BODY,
        "elements.h: connects to 'capp', which no other element uses",
        "did you mean 'cap'?",
    ),
    "a mass on nothing": (
        mass("m1", "a"),
        "elements.m1: connects to 'a', which no other element uses",
        "or add a translation element there",
    ),
    "a transducer that moves nothing": (
        LC + transducer("t", ("a", "gnd"), ("x", "wall")),
        "elements.t: connects to 'x', which no other element uses",
        "or add a translation element there",
    ),
    "a node in two domains": (
        capacitor("C1", "a", "gnd") + mass("m1", "a"),
        "elements.m1: node 'a' is in domain translation here, electrical in elements.C1",
        "rename one of the two nodes",
    ),
    "one node on both sides of a transducer": (
        capacitor("C1", "a", "gnd") + transducer("t", ("a", "gnd"), ("a", "wall")),
        "elements.t: node 'a' is in domain translation here, electrical in elements.C1",
        "rename one of the two nodes",
    ),
    "a transducer the wrong way round": (
        capacitor("C1", "a", "gnd")
        + mass("m1", "x")
        + transducer("t", ("x", "wall"), ("a", "gnd")),
        "elements.t: node 'x' is in domain electrical here, translation in elements.m1",
        "rename one of the two nodes",
    ),
    "a lever in a circuit": (
        LC + coupling("lev", "lever", ("a", "gnd"), ("b", "gnd")),
        "elements.lev: node 'a' is in domain translation here, electrical in elements.C1",
        "rename one of the two nodes",
    ),
    "the wall in an electrical branch": (
        capacitor("C1", "a", "wall") + inductor("L1", "a", "gnd"),
        "elements.C1: 'wall' is the translation reference; expected 'gnd' in this electrical",
        "write 'gnd' there",
    ),
    "the ground in a translation branch": (
        mass("m1", "a") + spring("s1", "a", "gnd"),
        "elements.s1: 'gnd' is the electrical reference; expected 'wall' in this translation",
        "write 'wall' there",
    ),
    "a mass at the wall": (
        mass("m1", "wall"),
        "elements.m1: stands at 'wall', which does not move",
        "name another node",
    ),
    "a force on the wall": (
        mass("m1", "a") + spring("s1", "a", "wall") + force("f1", "wall"),
        "elements.f1: stands at 'wall', which does not move",
        "name another node",
    ),
    "both ends at one node": (
        capacitor("C1", "a", "a") + inductor("L1", "a", "gnd"),
        "elements.C1: both ends are at node 'a'; expected two different nodes",
        "rename one of them",
    ),
    "a short source": (
        voltage("s", "gnd", "gnd"),
        "elements.s: both ends are at node 'gnd'",
        "rename one of them",
    ),
    "a circuit without ground": (
        capacitor("C1", "a", "b") + inductor("L1", "a", "b"),
        "elements.C1: nothing connects node 'a' to 'gnd'",
        "call one of these nodes 'gnd': a, b",
    ),
    "a ground of another name": (
        capacitor("C1", "a", "GND") + inductor("L1", "a", "GND"),
        "elements.C1: nothing connects node 'a' to 'gnd'",
        "call one of these nodes 'gnd': GND, a",
    ),
    "a mechanism without a wall": (
        mass("m1", "x")
        + spring("s0", "x", "wall")
        + spring("s1", "a", "b")
        + spring("s2", "a", "b"),
        "elements.s1: nothing connects node 'a' to 'wall'",
        "call one of these nodes 'wall': a, b",
    ),
    "a second winding without ground": (
        LC + coupling("tr", "transformer", ("a", "gnd"), ("p", "q")) + capacitor("C2", "p", "q"),
        "elements.tr: nothing connects node 'p' to 'gnd'",
        "call one of these nodes 'gnd': p, q",
    ),
}

REFERENCES = {
    "heat of a body that is not there": (
        LC + resistor("R1", "a", "gnd", heats="bdy") + BODY,
        "elements.R1.heats: 'bdy' is no thermal_mass of this spec",
        "did you mean 'body'?",
    ),
    "heat of an element that is no body": (
        LC + resistor("R1", "a", "gnd", heats="L1") + BODY,
        "elements.R1.heats: 'L1' is no thermal_mass of this spec",
        "known: body",
    ),
    "heat and no body at all": (
        LC + resistor("R1", "a", "gnd", heats="hull"),
        "elements.R1.heats: 'hull' is no thermal_mass of this spec; expected a body for the heat",
        'add one to [elements]: hull = { kind = "thermal_mass", temperature = "T_0*exp(S/c_0)" }',
    ),
    "a transducer at a body that is not there": (
        LC
        + mass("m1", "x")
        + transducer("t", ("a", "gnd"), ("x", "wall"), "a*T", temperature="T")
        + BODY,
        "elements.t.temperature: 'T' is no thermal_mass of this spec",
        "known: body",
    ),
    "a transducer of one of two bodies": (
        LC + mass("m1", "x") + transducer("t", ("a", "gnd"), ("x", "wall"), "a*T") + BODY + OTHER,
        "elements.t.ratio: 'T' is the temperature of no body",
        "add to the element: temperature = ",
    ),
    "conduction from a body to itself": (
        BODY + line("wire", "conduction", between=["body", "body"], conductance="lam"),
        "elements.wire.between: both ends are at body 'body'; expected two different bodies",
        "name another thermal_mass",
    ),
    "conduction to nobody": (
        BODY + line("wire", "conduction", between=["body", "bodi"], conductance="lam"),
        "elements.wire.between: 'bodi' is no thermal_mass of this spec",
        "did you mean 'body'?",
    ),
    "an ambient of no body": (
        LC + line("air", "ambient", body="body", conductance="lam", input="T_e"),
        "elements.air.body: 'body' is no thermal_mass of this spec",
        "add one to [elements]: body = ",
    ),
    "an input that is not declared": (
        LC + voltage("s", "b", "gnd", of="V_in") + resistor("R1", "b", "a") + BODY,
        "elements.s.input: 'V_in' is no input of this spec",
        "known: V, F, w, I, T_e",
    ),
    "no elements": ("", "elements: has no elements; expected at least one", "kinds: spring, mass"),
    "three nodes": (
        mass("m1", "a") + spring("s1", "a", "wall", "b"),
        "elements.s1.between: ",
        "expected a list of two names, such as ['a', 'b']",
    ),
    "a mass between nodes": (
        line("m1", "mass", between=["a", "wall"], mass="m") + spring("s1", "a", "wall"),
        "elements.m1.between: unknown key 'between'",
        "did you mean 'at'? it stands at one node, and its other one is the reference",
    ),
}


@pytest.mark.parametrize(("text", "fault", "remedy"), NODES.values(), ids=NODES)
def test_a_node_names_the_culprit_and_the_remedy(text, fault, remedy):
    error = refused(text)
    assert isinstance(error, NetworkError)
    assert str(error).startswith(fault)
    assert remedy in str(error)


@pytest.mark.parametrize(("text", "fault", "remedy"), REFERENCES.values(), ids=REFERENCES)
def test_a_reference_names_the_culprit_and_the_remedy(text, fault, remedy):
    error = refused(text)
    assert isinstance(error, SpecError)
    assert str(error).startswith(f"spec: {fault}")
    assert remedy in str(error)


@pytest.mark.parametrize("name", ["a ground of another name", "a node in two domains"])
@pytest.mark.parametrize("command", ["verify", "show", "generate", "simulate"])
def test_on_the_command_line_a_refusal_is_one_line(name, command, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.toml").write_text(spec(NODES[name][0]))
    words = [command, "mine.toml", *(["--duration", "1"] if command == "simulate" else [])]
    assert cli.run(words) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.count("\n") == 1
    assert NODES[name][1] in err
    assert [path.name for path in tmp_path.iterdir()] == ["mine.toml"]


BODILESS = """
[model]
name = "bodiless"
[parameters]
R = { value = 1.0, unit = "ohm" }
C = { value = 1.0, unit = "F" }
[elements]
store = { kind = "capacitor", between = ["a", "gnd"], capacitance = "C" }
loss = { kind = "resistor", between = ["a", "gnd"], voltage = "R*i", heats = "core" }
"""


@pytest.mark.parametrize("known", ["", 'T_0 = { value = 293.15, unit = "K" }\n'])
def test_the_body_that_a_remedy_adds_is_one(known):
    text = BODILESS.replace("R =", f"{known}R =")
    with pytest.raises(SpecError) as error:
        parse(text)
    remedy = str(error.value)
    body, more = re.search(r"to \[elements\]: (.*); and to \[parameters\]: (.*)$", remedy).groups()
    assert ("T_0" in more) == (not known)
    text = text.replace("R =", "\n".join([*more.split(" and "), "R ="]), 1)
    assert parse(text + body).elements["core"].kind == "thermal_mass"
