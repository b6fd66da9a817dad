"""Domains mixed up: every reference in every other domain, shared nodes, pairs, units of ratios."""

from itertools import permutations

import pytest
from drawing import HEAD, line, refused

from piezo_sym import derive, verify
from piezo_sym.errors import SpecError
from piezo_sym.spec.load import parse

STORES = {
    "electrical": ("inductor", "inductance", "gnd"),
    "translation": ("spring", "stiffness", "wall"),
    "rotation": ("torsion_spring", "stiffness", "frame"),
    "hydraulic": ("inertance", "inertance", "tank"),
}
MIXED = list(permutations(STORES, 2))


def store(domain, name, *nodes):
    kind, field, _ = STORES[domain]
    return line(name, kind, between=[*nodes], **{field: "k"})


@pytest.mark.parametrize(("own", "other"), MIXED)
def test_a_reference_of_another_domain_is_refused(own, other):
    here, there = STORES[own][2], STORES[other][2]
    error = str(refused(store(own, "one", "a", there) + store(own, "two", "a", here)))
    what = f"elements.one: '{there}' is the {other} reference"
    assert f"{what}; expected '{here}' in this {own} branch; write '{here}' there" in error
    assert f"or use a{'n' * (other == 'electrical')} {other} element" in error


@pytest.mark.parametrize(("own", "other"), MIXED)
def test_a_node_of_two_domains_is_refused(own, other):
    parts = (store(domain, domain[:3], "a", STORES[domain][2]) for domain in (other, own))
    error = str(refused("".join(parts)))
    wanted = (
        f"elements.{own[:3]}: node 'a' is in domain {own} here, {other} in elements.{other[:3]}"
    )
    assert wanted in error
    assert "rename one of the two nodes" in error


def motor(**pairs):
    nodes = {field: ["x", "wall" if field == "translation" else "frame"] for field in pairs}
    return line("m", "motor", electrical=["a", "gnd"], constant="a", **nodes)


@pytest.mark.parametrize(
    ("pairs", "said"),
    [
        ({}, "exactly one of translation, rotation; neither given"),
        (
            {"translation": 1, "rotation": 1},
            "exactly one of translation, rotation; both translation and rotation given",
        ),
    ],
)
def test_a_motor_turns_or_pushes(pairs, said):
    with pytest.raises(SpecError, match=said) as caught:
        parse(HEAD + motor(**pairs))
    assert "elements.m" in str(caught.value)


RATIOS = {
    "a transducer": ("transducer", "ratio", "N/A", "a transducer ratio [C/m] is needed", "a motor"),
    "a voice coil": ("motor", "constant", "C/m", "a motor constant [N/A] is", "a transducer"),
}


@pytest.mark.parametrize(("kind", "field", "unit", "needed", "other"), RATIOS.values(), ids=RATIOS)
def test_a_ratio_in_another_unit_names_the_kind_that_takes_it(kind, field, unit, needed, other):
    pairs = {"electrical": ["a", "gnd"], "translation": ["x", "wall"]}
    elements = (
        line("C1", "capacitor", between=["a", "gnd"], capacitance="C")
        + line("L1", "inductor", between=["a", "b"], inductance="L")
        + line("t", kind, **{**pairs, "electrical": ["b", "gnd"]}, **{field: "a"})
        + line("m1", "mass", at="x", mass="m")
    )
    if kind == "transducer":
        elements = elements.replace("'b'", "'a'").replace("L1 =", "#")
    text = HEAD.replace('unit = "C/m"', f'unit = "{unit}"') + elements
    (row,) = (row for row in verify(derive(parse(text))).rows if row.id == "units")
    assert row.verdict.value == "REFUTED"
    assert needed in row.reason
    assert f"; {other} takes {unit}" in row.reason


def test_a_ratio_that_no_other_kind_takes_names_none():
    elements = (
        line("r1", "inertia", at="s", inertia="I_r")
        + line("p", "pump", rotation=["s", "frame"], hydraulic=["h", "tank"], displacement="a")
        + line("A1", "accumulator", between=["h", "tank"], capacitance="H")
    )
    more = (
        'I_r = { value = 1.0, unit = "kg*m**2" }\nH = { value = 1.0, unit = "m**3/Pa" }\n[inputs]'
    )
    (row,) = (
        row
        for row in verify(derive(parse(HEAD.replace("[inputs]", more) + elements))).rows
        if row.id == "units"
    )
    assert "a displacement [m**3/rad] is needed" in row.reason
    assert "takes" not in row.reason
