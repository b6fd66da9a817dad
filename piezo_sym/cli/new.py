"""``piezo-sym new NAME``: a first spec, to run and then to edit."""

import os
from pathlib import Path
from typing import Annotated

import typer

from piezo_sym.errors import FileError
from piezo_sym.files import path_text, write_text


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
