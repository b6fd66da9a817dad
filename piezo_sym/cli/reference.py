"""``piezo-sym kinds``, ``functions``, ``units``, ``schema``: what a spec may say; ``new``: one."""

import json
import os
import re
from pathlib import Path
from textwrap import wrap
from typing import Annotated, Any

import typer

from piezo_sym.cli.output import print_table
from piezo_sym.errors import FileError, UsageError, quote
from piezo_sym.files import path_text, write_text

WIDTH = 100
#: The source of the numbers of equations and assumptions.
PAPER = "Numbered equations and assumptions: Caballeria, Ramirez, Le Gorrec (2021)."
NUMBERED = re.compile(r"\beqs?\. \(|Assumption")
CELLS = """[banks.creep]
count = 3                   # cells; a parameter that is a list has a value for each
[banks.creep.elements]      # of one cell; nodes that stand in no other table are its own
slow = { kind = "spring", between = ["tip", "middle"], stiffness = "k" }
loss = { kind = "damper", between = ["middle", "wall"], force = "d*v", heats = "body" }"""
CHAIN = """[banks.creep]               # Kelvin-Voigt's, in a chain from base to wall; d > 0
count = 3
series = ["base", "wall"]
[banks.creep.elements]      # each between the ends of its cell, which go by these names
slow = { kind = "spring", between = ["base", "wall"], stiffness = "k" }
loss = { kind = "damper", between = ["base", "wall"], force = "d*v", heats = "body" }"""
OPERATORS = (
    ("+ - * /", "as usual", "R*(1 + al*(T - T_0))"),
    ("**", "a power, by a whole number or a small fraction", "d*v**3"),
    ("", "or by a parameter, which is > 0 where the base may be 0", "abs(f/f_0)**n"),
    ("if", "one comparison (< <= > >=) chooses", "k_1*q if q < g else k_2*q"),
)


def kinds(
    kind: Annotated[str | None, typer.Argument(metavar="[KIND]", help="One kind, whole.")] = None,
) -> None:
    """List the kinds of elements, or show one: its fields, units, signs, an example."""
    from piezo_sym.spec.elements import KINDS
    from piezo_sym.spec.problems import meant_kind
    from piezo_sym.spec.schema import schema

    if kind is not None and kind not in KINDS:
        raise UsageError(f"{quote(kind)} is no kind", "KIND", remedy=meant_kind(kind))
    known = schema()["$defs"]
    if kind is not None:
        _show(kind, known[KINDS[kind].__name__])
        return
    title = f"Kinds of elements; more on one: piezo-sym kinds KIND. {PAPER}"
    docs = {name: known[element.__name__]["description"] for name, element in KINDS.items()}
    rows = ((name, doc.partition("\n")[0]) for name, doc in docs.items())
    print_table(title, ("kind", "what it is"), rows)
    typer.echo(f"Several alike, in parallel: count = 3 in an element. Cells of several:\n\n{CELLS}")
    typer.echo(f"\nCells in series, a chain:\n\n{CHAIN}")


def _show(kind: str, known: dict[str, Any]) -> None:
    *about, example = known["description"].split("\n\n")
    for part in about:
        typer.echo("\n".join(wrap(part, WIDTH)) + "\n")
    groups = known.get("allOf", ())
    either = {f for group in groups for choice in group["oneOf"] for f in choice["required"]}
    rows = []
    for name, field in known["properties"].items():
        needed = "yes" if name in known["required"] else "one of" if name in either else ""
        default = f"default: {field['default']!r}" if field.get("default") is not None else ""
        rows.append((name, needed or default, field.get("description", "")))
    print_table(f"Fields of {kind}", ("field", "needed", "what it is"), rows)
    if NUMBERED.search(about[0]):
        typer.echo(f"{PAPER}\n")
    typer.echo(f"[elements]\n{example.removeprefix('Example: ')}")


def functions() -> None:
    """List what laws are made of: operators and functions, with an example each."""
    from piezo_sym.expressions.functions import FUNCTIONS

    units = {"pure": "none", "none": "any; value none", "equal": "all equal", "power": "its power"}
    rows = [(sign, about, "", "", example) for sign, about, example in OPERATORS]
    rows += [(n, f.about, units[f.units], f.domain, f.example) for n, f in FUNCTIONS.items()]
    print_table("Laws", ("", "what it is", "units", "domain", "example"), rows)


def units() -> None:
    """List the units of values and inputs; each takes SI prefixes: uF, mm, kV."""
    from piezo_sym.expressions.units import known_units

    title = "Units, each with SI prefixes: uF, mm, kV"
    print_table(title, ("unit", "name", "in SI"), known_units())
    typer.echo("Joined by * and /, with powers: N*s/m, m**2, kg/m**3, N/(m/s)**(1/2), 1 (none).")
    typer.echo("No offsets: a temperature is given in K; headers of .csv files may say degC.")


def schema() -> None:
    """Print the JSON Schema (draft 2020-12) of specs.

    Editors complete and check specs with it (Even Better TOML, Taplo). Once in a folder:

    piezo-sym schema > piezo-sym.schema.json

    and as the first line of each spec, where `piezo-sym new` writes it:

    #:schema ./piezo-sym.schema.json
    """
    from piezo_sym.spec.schema import schema as spec_schema

    typer.echo(json.dumps(spec_schema(), indent=2))


def new(
    name: Annotated[
        str, typer.Argument(metavar="NAME", help="The model's name: letters, digits and _.")
    ],
) -> None:
    """Write NAME.toml into this folder: a commented spec of an actuator, to run and to edit.

    It has a spring, a mass, a damper, a capacitor, a bank of two hysterons, a transducer, a body
    that they heat, and sources; verify, generate and simulate work on it as it stands. A file that
    is there already is kept: exit code 2.
    """
    from piezo_sym.spec.load import starter

    path = Path(f"{name}.toml")
    text = starter(name, "NAME")
    if os.path.lexists(path):  # also true of a broken link, which must not be written through
        remedy = "give another name, or move the file away"
        raise FileError("is there already", path_text(path), remedy=remedy)
    write_text(path, text)
    typer.echo(f"{path}")
    typer.echo(f"  piezo-sym verify {path}")
    typer.echo(f'  piezo-sym simulate {path} --duration 0.1 --input "V_in=sine(100, 50)"')
