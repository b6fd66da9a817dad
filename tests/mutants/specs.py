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
    force: str, *assume: str, more: str = "", heat: str = "T_0*exp(S/c_0)", **values: str
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
            "[elements]",
            'mass = { kind = "mass", at = "tip", mass = "M", state = "p" }',
            f'damper = {{ kind = "damper", between = ["tip", "wall"], force = "{force}", heats = "body" }}',
            f'body = {{ kind = "thermal_mass", temperature = "{heat}", state = "S" }}',
            more,
        ]
    )


NAMED: dict[str, str] = {}
