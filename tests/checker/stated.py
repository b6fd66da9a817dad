"""Specs, what the package states of them, and the checker's lines about that."""

import copy
import json
import subprocess
import sys
from functools import cache
from pathlib import Path

from piezo_sym import derive
from piezo_sym.checker import read_spec
from piezo_sym.checker.rows import audit
from piezo_sym.proofs import decide, proofs_json
from piezo_sym.spec.load import parse

ROOT = Path(__file__).parents[2]
CHECKER = ROOT / "piezo_sym" / "checker"
PIEZO_STACK = (ROOT / "piezo_sym" / "models" / "piezo_stack.toml").read_text(encoding="utf-8")
SPECS = sorted((ROOT / "tests" / "networks" / "specs").glob("*.toml"))
PROGRAM = {"id": "program", "element": None, "verdict": "PROVED", "required": True}


@cache
def _stated(text):
    iphs = derive(parse(text))
    found = json.loads(proofs_json(decide(iphs), iphs.model, "made by a test"))
    return {**found, "obligations": [*found["obligations"], PROGRAM]}


def stated(text):
    """Return what the package states of a spec; a copy, to be changed."""
    return copy.deepcopy(_stated(text))


def forged(text):
    """Return the same, every required row being called PROVED, without information."""
    proofs = stated(text)
    proofs["obligations"] = [row for row in proofs["obligations"] if row["required"]]
    for row in proofs["obligations"]:
        row.update(verdict="PROVED", certificate=None)
    return proofs


def refused(text, proofs):
    """Return the rows that the checker does not confirm, with its reasons."""
    return {(name, element): why for name, element, why in audit(read_spec(text), proofs) if why}


def run(folder, text, proofs):
    """Return how the checker's own program ends, and what it prints."""
    paths = folder / "spec.toml", folder / "proofs.json"
    paths[0].write_text(text, encoding="utf-8")
    paths[1].write_text(proofs if isinstance(proofs, str) else json.dumps(proofs), encoding="utf-8")
    command = [sys.executable, "-I", str(CHECKER), *map(str, paths)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    return done.returncode, done.stdout, done.stderr


MASS = """[model]
name = "mass_and_damper"
[parameters]
a   = { value = -1.0, unit = "%(unit)s" }
a_1 = { value = 1.0, unit = "N*s/m" }
F_1 = { value = 1.0, unit = "N" }
v_1 = { value = 1.0, unit = "m/s" }
k   = { value = 1.0, unit = "N/m" }
m   = { value = 1.0, unit = "kg" }
T_0 = { value = 300.0, unit = "K" }
c   = { value = 2.0, unit = "J/K" }
[domain]
assume = [%(domain)s]
[elements]
mass   = { kind = "mass", at = "tip", mass = "m" }
spring = { kind = "spring", between = ["tip", "wall"], stiffness = "%(stiffness)s" }
damper = { kind = "damper", between = ["tip", "wall"], force = "%(force)s", heats = "body" }
body   = { kind = "thermal_mass", temperature = "T_0*exp(S/c)" }
"""


def mass(force, domain="", stiffness="k", unit="N*s/m"):
    """Return a mass on a spring and a damper; a law has a, a_1 [N*s/m], F_1, v_1 and k."""
    quoted = ", ".join(
        f'"{text}"' for text in ["a_1 > 0", "F_1 > 0", "v_1 > 0", *domain.split(";")] if text
    )
    return MASS % {"force": force, "domain": quoted, "stiffness": stiffness, "unit": unit}
