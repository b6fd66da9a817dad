"""``piezo-sym generate [SPEC...]``: write generated modules, or check that they are up to date."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from piezo_sym.spec.model import Model


def generate(
    specs: Annotated[
        list[str] | None, typer.Argument(metavar="[SPEC...]", help="Default: all shipped specs.")
    ] = None,
    out: Annotated[Path, typer.Option(help="Folder of generated modules.")] = Path("generated"),
    check: Annotated[bool, typer.Option("--check", help="Write nothing; fail on drift.")] = False,
    allow_unproved: Annotated[
        bool, typer.Option("--allow-unproved", help="Write what is not proved; the files say so.")
    ] = False,
) -> None:
    """Generate the modules of specs into OUT/<model>/.

    With --check nothing is written: exit code 1 if a file is missing, differs from its spec, or
    belongs to no spec, with the difference and the command that mends it.
    """
    from piezo_sym.build import shipped_models
    from piezo_sym.spec.load import load

    models = [load(spec) for spec in specs] if specs else list(shipped_models())
    if check:
        _check(models, specs or [], out, allow_unproved)
        return
    from piezo_sym.build import generate as write

    for model in models:
        for path in write(model, out, allow_unproved=allow_unproved):
            typer.echo(f"{path}")


def _check(models: list[Model], specs: list[str], out: Path, allow_unproved: bool) -> None:
    from piezo_sym.build import drift, raise_if_drifted

    found = drift(models, out, complete=not specs, allow_unproved=allow_unproved)
    for fault in found:
        typer.echo(f"{fault.path} {fault.fault}")
        if fault.diff:
            typer.echo(fault.diff)
    options = ["--out", str(out)] if out != Path("generated") else []
    options += ["--allow-unproved"] if allow_unproved else []
    raise_if_drifted(found, " ".join(["piezo-sym generate", *specs, *options]))
    typer.echo(f"{len(models)} {'model' if len(models) == 1 else 'models'} up to date in {out}")
