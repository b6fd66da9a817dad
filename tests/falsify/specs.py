"""Small specs for the net: laws given as text, in a damper on a mass or between sources."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path
from types import ModuleType

from piezo_sym.codegen import lower, numpy_module
from piezo_sym.derivation import derive
from piezo_sym.falsify import module_from
from piezo_sym.iphs import IPHS
from piezo_sym.spec.load import load

#: Value and unit of every name that laws may use; those of the base are always there.
NAMES = {
    "M": (2.0, "kg"),
    "T_0": (300.0, "K"),
    "c_0": (5.0, "J/K"),
    "a": (2.0, "N*s/m"),
    "b": (3.0, "N*s/m"),
    "a_1": (1.0, "N*s/m"),
    "F_1": (1.0, "N"),
    "v_1": (1.0, "m/s"),
    "v_2": (1.5, "m/s"),
    "k": (100.0, "N/m"),
    "lam": (2.0, "W/K"),
    "R": (2.0, "ohm"),
    "i_1": (0.5, "A"),
    "L": (1e-3, "H"),
    "n": (1e-4, "1"),
}
BASE = ("M", "T_0", "c_0")
MASS = '[elements.mass]\nkind = "mass"\nat = "tip"\nmass = "M"\nstate = "p"\n'
SPRING = '[elements.spring]\nkind = "spring"\nbetween = ["tip", "wall"]\nstiffness = "{}"\n'
BODY = '[elements.body]\nkind = "thermal_mass"\ntemperature = "{}"\nstate = "S"\n'
AMBIENT = '[elements.ambient]\nkind = "ambient"\nbody = "body"\nconductance = "{}"\ninput = "T_e"\n'
INPUT = '[inputs]\nT_e = {{ unit = "K", default = {} }}\n'


def damper(law: str) -> str:
    """Return a mass with a damper of a law."""
    own = f'[elements.damper]\nkind = "damper"\nbetween = ["tip", "wall"]\nforce = "{law}"\n'
    return f'{MASS}{own}heats = "body"\n'


def built(
    folder: Path,
    elements: str,
    *assume: str,
    heat: str = "T_0*exp(S/c_0)",
    starts: Iterable[str] = (),
    **values: float,
) -> IPHS:
    """Return the system of some elements and a body, its parameters at the values given."""
    text = " ".join([elements, heat, *assume])
    lines = ["[model]", 'name = "made"', "[parameters]"]
    for name, (value, unit) in NAMES.items():
        if name in BASE or re.search(rf"\b{name}\b", text):
            lines.append(f'{name} = {{ value = {values.get(name, value)!r}, unit = "{unit}" }}')
    lines += ["[domain]", f"assume = {list(assume)!r}", "[initial]", *starts]
    lines += [elements, BODY.format(heat)]
    path = folder / "made.toml"
    path.write_text("\n".join(lines))
    return derive(load(path))


def module_of(iphs: IPHS) -> ModuleType:
    """Return a system's module."""
    return module_from(numpy_module(lower(iphs, "")))
