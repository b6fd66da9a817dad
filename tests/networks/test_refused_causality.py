"""Elements that fix each other: each refusal names them and says what to put where."""

import re

import pytest
from drawing import (
    BODY,
    LC,
    OTHER,
    bank,
    capacitor,
    coupling,
    current,
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
    velocity,
    voltage,
)

from piezo_sym import derive
from piezo_sym.errors import NetworkError
from piezo_sym.spec.load import parse

MERGE = "merge those in parallel into one, or put a resistor in series with one of them"
SERIES = "merge those in series into one, or put a capacitor between their node and 'gnd'"
CUBIC = {"current": "v**3/R"}

CONFLICTS = {
    "two capacitors in parallel across a voltage source": (
        voltage("s", "a", "gnd") + capacitor("C1", "a", "gnd") + capacitor("C2", "a", "gnd"),
        "elements 's', 'C1' fix each other's voltage at node 'a'",
        MERGE,
    ),
    "a force between two springs in series": (
        spring("s1", "wall", "a") + spring("s2", "a", "b") + force("s", "a") + mass("m1", "b"),
        "elements 's1', 's2', 's' fix each other's force at node 'a'",
        "put a mass at the node between them",
    ),
    "two capacitors in parallel, one of which saturates": (
        LC + line("C2", "capacitor", between=["a", "gnd"], capacitance="C/(1 + Q**2)"),
        "elements 'C1', 'C2' fix each other's voltage at node 'a', and the energy of 'C2' is not "
        "quadratic",
        MERGE,
    ),
    "two springs in series, one with a kink": (
        spring("s1", "wall", "a")
        + line("s2", "spring", between=["a", "b"], stiffness="k if q < 0 else 2*k")
        + mass("m1", "b"),
        "elements 's1', 's2' fix each other's force at node 'a', and the energy of 's2' is not "
        "quadratic",
        "put a mass at the node between them",
    ),
    "an inductor and a mass on a transducer that is warm": (
        inductor("L1", "a", "gnd")
        + mass("m1", "x")
        + transducer("t", ("a", "gnd"), ("x", "wall"), "a*T/T_0", temperature="body")
        + BODY,
        "elements 'L1', 'm1' fix each other's variables through 't', and the ratio of 't' is not "
        "of parameters alone",
        "or a capacitor or mass at a node",
    ),
    "four free inertias in one bar": (
        "".join(mass(f"m{n}", f"n{n}") for n in range(6))
        + coupling("l1", "lever", ("n0", "n1"), ("n2", "wall"))
        + coupling("l2", "lever", ("n4", "n2"), ("n3", "n5")),
        "'m0', 'm1', 'm3', 'm4', 'm2', 'm5' are joined into 4 states that depend on each other",
        "at most 3",
    ),
    "a voltage source across a capacitor": (
        voltage("s", "a", "gnd") + capacitor("C1", "a", "gnd"),
        "elements 's', 'C1' fix each other's voltage at node 'a'",
        MERGE,
    ),
    "two voltage sources in parallel": (
        voltage("s", "a", "gnd") + voltage("s2", "a", "gnd") + inductor("L1", "a", "gnd"),
        "elements 's', 's2' fix each other's voltage at node 'a'",
        MERGE,
    ),
    "a current source into an inductor": (
        current("s", "gnd", "a") + inductor("L1", "a", "gnd"),
        "elements 's', 'L1' fix each other's current at node 'a'",
        SERIES,
    ),
    "two banks in series through a bare node": (
        voltage("s", "in", "gnd") + bank("h1", "in", "n") + bank("h2", "n", "gnd", count=3) + BODY,
        "elements 'h1', 'h2' fix each other's current at node 'n'",
        SERIES,
    ),
    "a bank in series with an inductor": (
        voltage("s", "in", "gnd") + bank("h1", "in", "n") + inductor("L1", "n", "gnd") + BODY,
        "elements 'h1', 'L1' fix each other's current at node 'n', and 'h1' is a bank, which is",
        SERIES,
    ),
    "a velocity source on a mass": (
        velocity("s", "a") + mass("m1", "a"),
        "elements 's', 'm1' fix each other's velocity at node 'a'",
        "put a spring or damper between them",
    ),
    "a force on a spring without a mass": (
        force("s", "a") + spring("s1", "a", "wall"),
        "elements 's', 's1' fix each other's force at node 'a'",
        "put a mass at the node between them",
    ),
    "two transformers side by side": (
        capacitor("C1", "x", "gnd")
        + inductor("L1", "y", "gnd")
        + coupling("t1", "transformer", ("x", "gnd"), ("y", "gnd"))
        + coupling("t2", "transformer", ("x", "gnd"), ("y", "gnd")),
        "the voltage of 'C1' is forced to be zero through 't1', 't2'",
        "connect it to other nodes",
    ),
}

CAUSALITY = {
    "a current law in series with an inductor": (
        inductor("L1", "a", "b")
        + resistor("R1", "b", "gnd", **CUBIC)
        + capacitor("C1", "a", "gnd"),
        "elements 'L1', 'R1' fix each other's current at node 'b'; expected the law of 'R1' as a "
        "function of i, which is given",
        "give the inverse law, voltage = '...' of i (only laws c*v are turned round); or put a "
        "capacitor between their node and 'gnd'",
    ),
    "a voltage law across a capacitor": (
        capacitor("C1", "a", "gnd") + resistor("R1", "a", "gnd", voltage="R*i**3"),
        "elements 'C1', 'R1' fix each other's voltage at node 'a'; expected the law of 'R1' as a "
        "function of v",
        "give the inverse law, current = '...' of v",
    ),
    "a dead zone across a source": (
        voltage("s", "a", "gnd") + resistor("R1", "a", "gnd", voltage="R*deadzone(i, 0.5)"),
        "elements 's', 'R1' fix each other's voltage at node 'a'",
        "give the inverse law, current = '...' of v",
    ),
    "a law with an offset across a source": (
        voltage("s", "a", "gnd") + resistor("R1", "a", "gnd", voltage="R*i + 1"),
        "elements 's', 'R1' fix each other's voltage",
        "(only laws c*i are turned round)",
    ),
    "a law that is zero across a source": (
        voltage("s", "a", "gnd") + resistor("R1", "a", "gnd", voltage="0*i"),
        "elements 's', 'R1' fix each other's voltage",
        "give the inverse law, current = '...' of v",
    ),
    "a law whose slope cancels across a source": (
        voltage("s", "a", "gnd") + resistor("R1", "a", "gnd", voltage="R*i - R*i"),
        "elements 's', 'R1' fix each other's voltage",
        "give the inverse law, current = '...' of v",
    ),
    "a velocity law at a mass": (
        mass("m1", "a") + damper("d1", "a", "wall", velocity="f**3/d"),
        "elements 'm1', 'd1' fix each other's velocity at node 'a'",
        "give the inverse law, force = '...' of v (only laws c*f are turned round); or put a "
        "spring between them",
    ),
    "a force law in series with a spring": (
        spring("s1", "wall", "a") + damper("d1", "a", "wall", force="d*v**3"),
        "elements 's1', 'd1' fix each other's force at node 'a', which has no mass; expected one, "
        "or the law of 'd1' as a function of f",
        "put a mass at 'a'; or give the inverse law, velocity = '...' of f",
    ),
    "a spring and a force on a transducer without a mass": (
        spring("s1", "x", "wall")
        + force("s", "x")
        + capacitor("C1", "a", "gnd")
        + transducer("t", ("a", "gnd"), ("x", "wall"), "a"),
        "elements 's1', 's', 'C1' fix each other's variables through 't', and node 'x' has no mass",
        "expected a mass there; put a mass at 'x'",
    ),
    "a current law in series with a bank": (
        voltage("s", "in", "gnd") + bank("h", "in", "n") + resistor("R1", "n", "gnd", **CUBIC),
        "elements 'h', 'R1' fix each other's current at node 'n'",
        "give the inverse law, voltage = '...' of i",
    ),
    "two nonlinear resistors in series across a capacitor": (
        resistor("R1", "a", "n", **CUBIC) + resistor("R2", "n", "gnd", **CUBIC) + LC,
        "elements 'R1', 'R2' fix each other's current at node 'n'; expected independent laws",
        "put a capacitor between 'n' and 'gnd'",
    ),
}


def stop(name, *nodes, **more):
    law = {"capacitance": "C", "limit": "a", "heats": "body", **more}
    return line(name, "stop", between=[*nodes], **law)


DIODE = {"current": "c*(exp(v/R) - 1)"}
#: What one step of advice has to mend.
AT_ONCE = {
    "a bridge of diodes": (
        current("s", "p", "n")
        + capacitor("C1", "p", "n")
        + resistor("d1", "p", "out", **DIODE)
        + resistor("d2", "n", "out", **DIODE)
        + resistor("d3", "gnd", "p", **DIODE)
        + resistor("d4", "gnd", "n", **DIODE)
        + capacitor("C2", "out", "gnd"),
        "elements 'd1', 'd2', 'd3', 'd4' fix each other's current; expected independent laws; put "
        "a capacitor between 'p' and 'gnd'",
    ),
    "two nonlinear resistors": (
        resistor("R1", "a", "n", **CUBIC) + resistor("R2", "n", "gnd", **CUBIC) + LC,
        "put a capacitor between 'n' and 'gnd'",
    ),
    "a stop beside a capacitor": (
        stop("z", "a", "gnd") + LC,
        "'z', 'C1' fix each other's voltage at node 'a', and 'z' slips; expected a current of 'z' "
        "that is a state's, or an input; put an inductor in series with 'z'",
    ),
    "a stop across a source": (
        stop("z", "a", "gnd") + voltage("s", "a", "gnd"),
        "put an inductor in series with 'z'",
    ),
    "two stops": (
        stop("z", "a", "gnd") + stop("y", "a", "gnd") + inductor("L1", "a", "gnd"),
        "put an inductor in series with 'z', 'y'",
    ),
}


@pytest.mark.parametrize(("text", "said"), AT_ONCE.values(), ids=AT_ONCE)
def test_one_remedy_is_enough(text, said):
    message = str(refused(text))
    assert message.endswith(said)
    if found := re.search("put a capacitor between '(.)' and 'gnd'", message):
        text += capacitor("C_x", found[1], "gnd")
    for name in re.findall("'(.)'", message.partition("in series with ")[2]):
        text = text.replace(
            f"{name} = {{ kind = \"stop\", between = ['a'",
            f"{name} = {{ kind = \"stop\", between = ['{name}_in'",
        )
        text += inductor(f"L_{name}", "a", f"{name}_in")
    assert derive(parse(spec(text))).x


def test_stops_in_lanes_that_share_a_voltage_are_told_so():
    cell = "[banks.many]\ncount = 3\n[banks.many.elements]\n"
    first = LC + BODY + cell
    said = str(refused(first + stop("z", "a", "gnd")))
    assert "network: the lanes of 'many_z' fix each other's voltage at node 'a'; expected" in said
    assert said.endswith("put an inductor in series with 'many_z', in each lane")
    assert derive(parse(spec(first + stop("z", "b", "gnd") + inductor("L_z", "a", "b")))).x


TIED = CONFLICTS | CAUSALITY


@pytest.mark.parametrize(("text", "fault", "remedy"), TIED.values(), ids=TIED)
def test_elements_that_fix_each_other_are_named_with_a_remedy(text, fault, remedy):
    error = refused(text)
    assert isinstance(error, NetworkError)
    assert str(error).startswith(f"network: {fault}")
    assert remedy in str(error)


REMEDIED = {
    "a resistor between two capacitors": capacitor("C1", "a", "gnd")
    + resistor("R1", "a", "b")
    + capacitor("C2", "b", "gnd"),
    "a capacitor between two inductors": LC + inductor("L2", "a", "gnd"),
    "a spring between two masses": mass("m1", "a") + spring("s1", "a", "b") + mass("m2", "b"),
    "a mass between two springs": spring("s1", "wall", "a") + mass("m1", "a") + force("f1", "a"),
    "a voltage law in series with an inductor": inductor("L1", "a", "b")
    + resistor("R1", "b", "gnd", voltage="R*i**3")
    + capacitor("C1", "a", "gnd"),
    "a capacitor between a current law and an inductor": inductor("L1", "a", "b")
    + resistor("R1", "b", "gnd", **CUBIC)
    + capacitor("C1", "a", "gnd")
    + capacitor("C2", "b", "gnd"),
    "a spring between a velocity law and a mass": mass("m1", "a")
    + spring("s1", "a", "b")
    + damper("d1", "b", "wall", velocity="f**3/d"),
    "a force law at a mass": mass("m1", "a") + damper("d1", "a", "wall", force="d*v**3"),
    "a body for the heat": LC + resistor("R1", "a", "gnd") + BODY,
    "inputs and a body that nothing uses": LC + BODY + OTHER,
}


@pytest.mark.parametrize("text", REMEDIED.values(), ids=REMEDIED)
def test_what_the_remedies_say_is_accepted(text):
    assert derive(parse(spec(text))).x
