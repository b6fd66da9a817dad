"""Specs on which mutants show: laws with guards, roots, quotients and kinks, true ones and false.

Input: laws and conditions as text.  Output: a spec's text.
"""

from __future__ import annotations

import re
from pathlib import Path

FOLDER = Path(__file__).parents[1] / "networks" / "specs"

#: Value and unit of every name that laws may use; those of the base are always there.
NAMES = {
    "M": (2.0, "kg"),
    "T_0": (300.0, "K"),
    "c_0": (5.0, "J/K"),
    "a": (-1.0, "N*s/m"),
    "b": (3.0, "N*s/m"),
    "d": (2.0, "N*s/m"),
    "a_1": (1.0, "N*s/m"),
    "F_1": (1.0, "N"),
    "F_2": (2.0, "N"),
    "v_1": (1.0, "m/s"),
    "v_2": (1.5, "m/s"),
    "k": (100.0, "N/m"),
    "T_1": (310.0, "K"),
    "lam": (2.0, "W/K"),
}
BASE = ("M", "T_0", "c_0")
ENDS = 'between = ["tip", "wall"]'


def spec_of(words: str) -> str:
    """Return a spec by its name, or of ``law | condition; ... | name=value; ...``."""
    if words in NAMED:
        return NAMED[words]
    if (FOLDER / f"{words}.toml").is_file():
        return (FOLDER / f"{words}.toml").read_text(encoding="utf-8")
    law, conditions, values = (*map(str.strip, words.split("|")), "", "")[:3]
    given = dict(value.split("=") for value in values.split("; ") if value)
    return damped(law, *conditions.split("; "), **given)


def damped(
    force: str,
    *assume: str,
    more: str = "",
    heat: str = "T_0*exp(S/c_0)",
    starts: str = "",
    **values: str,
) -> str:
    """Return a mass with a damper of a law, in a domain, and other elements."""
    text, assume = " ".join([force, heat, more, *assume]), tuple(filter(None, assume))
    used = [name for name in NAMES if name in BASE or re.search(rf"\b{name}\b", text)]
    lines = ["[model]", 'name = "damped"', "[parameters]"]
    lines += [
        f'{n} = {{ value = {values.get(n, NAMES[n][0])}, unit = "{NAMES[n][1]}" }}' for n in used
    ]
    quoted = ", ".join(f'"{condition}"' for condition in assume)
    return "\n".join(
        [
            *lines,
            "[domain]",
            f"assume = [{quoted}]",
            f"[initial]\n{starts}",
            "[elements]",
            'mass = { kind = "mass", at = "tip", mass = "M", state = "p" }',
            f'damper = {{ kind = "damper", {ENDS}, force = "{force}", heats = "body" }}',
            f'body = {{ kind = "thermal_mass", temperature = "{heat}", state = "S" }}',
            more,
        ]
    )


CONDUCTION = """
other = { kind = "thermal_mass", temperature = "T_0*exp(S/c_0)", state = "S_2" }
contact = { kind = "conduction", between = ["body", "other"], conductance = "lam" }
"""
AMBIENT = """
ambient = { kind = "ambient", body = "body", conductance = "%s", input = "T_e" }
[inputs]
T_e = { unit = "K", default = 305.0 }
"""
SECOND_MASS = """
mass_2 = { kind = "mass", at = "end", mass = "M", state = "p_2" }
damper_2 = { kind = "damper", between = ["end", "wall"], force = "%s", heats = "%s" }
other = { kind = "thermal_mass", temperature = "T_0*exp(S/c_0)", state = "S_2" }
"""
NAMED = {
    "conduction": damped("d*v", "d > 0", more=CONDUCTION, lam="-2.0"),
    "exchange": damped(
        "d*v",
        "d > 0",
        "lam > 0",
        "T_e > 0",
        more=AMBIENT % "lam if T_1 > T_0 else -lam",
        T_1="290.0",
    ),
    "cold": damped("d*v", "d > 0", "T_e > 0", more=AMBIENT % "lam", lam="-2.0"),
    "turned": damped("F_1", "F_1 > 0", "p > 0", starts="p = 5.0").replace(
        '"tip", "wall"', '"wall", "tip"', 1
    ),
    "two masses": damped(
        "F_1", "F_1 > 0", "p > 0", more=SECOND_MASS % ("F_1", "body"), starts="p = 5.0"
    ),
    "two bodies": damped(
        "d*v",
        "d > 0",
        "T_body > T_0",
        more=SECOND_MASS % ("d*v*(T - T_0)/T_0", "other"),
        starts="S = 1.0",
    ),
}

SIZES = {"R": "ohm", "C": "F", "L": "H", "c": "J/K", "T_0": "K", "a": "C/m", "m": "kg", "U": "V"}
SIZES |= {"R_2": "ohm", "lam": "W/K", "k": "N/m", "G": "1/ohm", "n": "1"}


def network(elements: str, *assume: str, inputs: str = "") -> str:
    """Return a spec of elements, a line each; parameters are what they are called."""
    used = [name for name in SIZES if re.search(rf"\b{name}\b", elements + " ".join(assume))]
    lines = ["[model]", 'name = "network"', "[parameters]"]
    lines += [f'{n} = {{ value = {2.0 + len(n) / 8}, unit = "{SIZES[n]}" }}' for n in used]
    quoted = ", ".join(f'"{condition}"' for condition in assume)
    rows = [line.partition(" ")[::2] for line in elements.strip().splitlines()]
    made = [f"{name} = {{ kind = {rest} }}" for name, rest in rows]
    return "\n".join(
        [*lines, f"[inputs]\n{inputs}\n[domain]\nassume = [{quoted}]\n[elements]", *made]
    )


BODY = 'body "thermal_mass", temperature = "T_0*exp(S/c)", state = "S"\n'
OTHER = 'other "thermal_mass", temperature = "T_0*exp(S/c)", state = "S_2"\n'
SUPPLY = 'supply "voltage_source", between = ["in", "gnd"], input = "V"\n'
PUSH = 'push "current_source", between = ["n", "gnd"], input = "I"\n'
COIL = 'coil "inductor", between = ["o", "gnd"], inductance = "L"\n'
CAP = 'cap "capacitor", between = ["n", "gnd"], capacitance = "C"\n'
FEED = 'feed "resistor", between = ["in", "n"], current = "v/R", heats = "body"\n'
LOSS = 'loss "resistor", between = ["{}", "{}"], {} = "{}", heats = "{}"\n'
TWO_LOSSES = LOSS.format("n", "o", "current", "v/R", "body")
TWO_LOSSES += LOSS.replace("loss", "loss_2").format("o", "gnd", "voltage", "R_2*T/T_0*i", "other")
VOLT = 'V = { unit = "V", default = 1.0 }'
AMPERE = 'I = { unit = "A", default = 1.0 }'
NAMED |= {
    "current": network(
        PUSH + CAP + LOSS.format("n", "gnd", "current", "v/R", "body") + BODY,
        "R > 0",
        inputs=AMPERE,
    ),
    "transformer": network(
        SUPPLY
        + FEED
        + CAP
        + 'ideal "transformer", first = ["n", "gnd"], second = ["o", "gnd"], ratio = "n"\n'
        + 'coil "inductor", between = ["o", "gnd"], inductance = "L"\n'
        + BODY,
        "R > 0",
        "n > 0",
        inputs=VOLT,
    ),
    "affine": network(
        SUPPLY + FEED.replace("current", "voltage").replace("v/R", "R*i + U") + CAP + BODY,
        inputs=VOLT,
    ),
    "affine linear": network(
        SUPPLY + FEED.replace("current", "voltage").replace("v/R", "R*i") + CAP + BODY,
        "R > 0",
        inputs=VOLT,
    ),
    "ports": network(
        SUPPLY + PUSH.replace('"n", "gnd"', '"in", "gnd"') + FEED + CAP + BODY,
        "R > 0",
        inputs=VOLT + "\n" + AMPERE,
    ),
    "piezo": (FOLDER.parents[2] / "piezo_sym" / "models" / "piezo_stack.toml").read_text(),
    "friction": network(
        SUPPLY + FEED.replace("current", "voltage").replace("v/R", "R*i + U*sign(i)") + CAP + BODY,
        "R > 0",
        "U >= 0",
        inputs=VOLT,
    ),
    "across": network(
        SUPPLY
        + LOSS.format("in", "gnd", "current", "v/R*T/T_0", "other")
        + FEED
        + CAP
        + BODY
        + OTHER,
        "R > 0",
        inputs=VOLT,
    ),
    "two domains": network(
        SUPPLY + FEED + 'cap "mass", at = "n", mass = "m"\n' + BODY, "R > 0", inputs=VOLT
    ),
    "shorted": network(
        SUPPLY + FEED + CAP + LOSS.format("n", "n", "current", "v/R", "body") + BODY,
        "R > 0",
        inputs=VOLT,
    ),
    "loop": network(
        PUSH + CAP + TWO_LOSSES + BODY + OTHER,
        "R > 0",
        "R_2 > 0",
        inputs=AMPERE,
    ),
    "coil loop": network(
        PUSH + CAP + TWO_LOSSES + COIL + BODY + OTHER,
        "R > 0",
        "R_2 > 0",
        inputs=AMPERE,
    ),
    "driven coil loop": network(
        SUPPLY
        + PUSH.replace('"n"', '"o"')
        + LOSS.format("in", "o", "current", "v/R", "body")
        + LOSS.replace("loss", "loss_2").format("o", "gnd", "voltage", "R_2*i", "other")
        + COIL
        + BODY
        + OTHER,
        "R > 0",
        "R_2 > 0",
        inputs=VOLT + "\n" + AMPERE,
    ),
    "loop of any sign": network(
        PUSH
        + CAP
        + LOSS.format("n", "o", "current", "v/R", "body")
        + LOSS.replace("loss", "loss_2").format("o", "gnd", "voltage", "R_2*i", "body")
        + BODY,
        "R > 0",
        inputs=AMPERE,
    ),
    "driven loop": network(
        SUPPLY
        + LOSS.format("in", "o", "current", "v/R", "body")
        + LOSS.replace("loss", "loss_2").format("o", "n", "voltage", "R_2*i", "other")
        + CAP
        + BODY
        + OTHER,
        "R > 0",
        "R_2 > 0",
        inputs=VOLT,
    ),
    "two airs": network(
        PUSH
        + CAP
        + LOSS.format("n", "gnd", "current", "v*T/(R*T_0)", "body")
        + LOSS.replace("loss", "loss_2").format("n", "gnd", "current", "v*T/(R_2*T_0)", "other")
        + 'air "ambient", body = "other", conductance = "lam", input = "T_e"\n'
        + 'contact "conduction", between = ["body", "other"], conductance = "lam"\n'
        + BODY
        + OTHER,
        "R > 0",
        "R_2 > 0",
        "lam >= 0",
        "T_e > 0",
        inputs=AMPERE + '\nT_e = { unit = "K", default = 310.0 }',
    ),
}
