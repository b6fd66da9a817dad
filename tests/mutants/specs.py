"""Specs on which mutants show: laws with guards, roots, quotients and kinks, true ones and false.

Input: laws and conditions as text.  Output: a spec's text.
"""

from __future__ import annotations

import re

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


def spec_of(words: str) -> str:
    """Return a spec by its name, or of ``law | condition; ... | name=value; ...``."""
    if words in NAMED:
        return NAMED[words]
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
    lines += [f'{n} = {{ value = {values.get(n, NAMES[n][0])}, unit = "{NAMES[n][1]}" }}' for n in used]
    quoted = ", ".join(f'"{condition}"' for condition in assume)
    return "\n".join(
        [
            *lines,
            "[domain]",
            f"assume = [{quoted}]",
            f"[initial]\n{starts}",
            "[elements]",
            'mass = { kind = "mass", at = "tip", mass = "M", state = "p" }',
            f'damper = {{ kind = "damper", between = ["tip", "wall"], force = "{force}", heats = "body" }}',
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
HYSTERON = """
source = { kind = "current_source", between = ["in", "gnd"], input = "I" }
cap = { kind = "capacitor", between = ["in", "gnd"], capacitance = "1.0" }
h = { kind = "hysteron", between = ["in", "gnd"], inductance = "2.0", voltage = "%s", heats = "body" }
[inputs]
I = { unit = "A", default = 0.0 }
"""
NAMED = {
    "conduction": damped("d*v", "d > 0", more=CONDUCTION, lam="-2.0"),
    "exchange": damped(
        "d*v", "d > 0", "lam > 0", "T_e > 0", more=AMBIENT % "lam if T_1 > T_0 else -lam", T_1="290.0"
    ),
    "cold": damped("d*v", "d > 0", "T_e > 0", more=AMBIENT % "lam", lam="-2.0"),
    "turned": damped("F_1", "F_1 > 0", "p > 0", starts="p = 5.0").replace('"tip", "wall"', '"wall", "tip"', 1),
    "two masses": damped("F_1", "F_1 > 0", "p > 0", more=SECOND_MASS % ("F_1", "body"), starts="p = 5.0"),
    "two bodies": damped(
        "d*v", "d > 0", "T_body > T_0", more=SECOND_MASS % ("d*v*(T - T_0)/T_0", "other"), starts="S = 1.0"
    ),
}
