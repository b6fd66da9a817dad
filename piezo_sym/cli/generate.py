"""``piezo-sym generate [SPEC...]``: write generated modules, or check that they are up to date."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from piezo_sym.cli.output import about, printed_at_the_end
from piezo_sym.errors import UsageError, quote
from piezo_sym.files import path_text

if TYPE_CHECKING:
    from piezo_sym.spec.model import Model


#: The most lines of a file's difference that are printed.
MOST_LINES = 10


def generate(
    specs: Annotated[
        list[str] | None, typer.Argument(metavar="[SPEC...]", help="Default: all shipped specs.")
    ] = None,
    out: Annotated[Path, typer.Option(help="Folder of generated modules.")] = Path("generated"),
    check: Annotated[bool, typer.Option("--check", help="Write nothing; fail on drift.")] = False,
    allow_unproved: Annotated[
        bool, typer.Option("--allow-unproved", help="Write what is not proved; the files say so.")
    ] = False,
    every: Annotated[
        bool,
        typer.Option("--all", help="With --check: these specs are all; fail on other files."),
    ] = False,
) -> None:
    """Generate the modules of specs into OUT/<model>/.

    With --check nothing is written: exit code 1 if OUT/<model>/ is not what the spec gives, file
    for file and byte for byte, with the first differing lines and what to do; with --all (or
    without SPEC) also if anything else is in OUT.
    """
    from piezo_sym.build import refuse_case, shipped_models
    from piezo_sym.spec.load import load

    if every and not check:
        raise UsageError("goes with --check alone", "--all", remedy="add --check, or leave it out")
    names = specs or []
    models = [load(spec) for spec in names] or list(shipped_models())
    called = [model.name for model in models]
    if twice := next((name for name in called if called.count(name) > 1), None):
        what = f"two specs are called {quote(twice)}"  # their files would be the same
        raise UsageError(what, "generate", remedy="give each model a name of its own")
    refuse_case(called, out)
    if check:
        _check(models, names, out, allow_unproved, every or not names)
        return
    from piezo_sym.build import generate as write

    with printed_at_the_end() as lines:
        for spec, model in zip(names or [model.name for model in models], models, strict=True):
            with about(spec):
                lines += map(str, write(model, out, allow_unproved=allow_unproved))


def _check(
    models: list[Model], specs: list[str], out: Path, allow_unproved: bool, complete: bool
) -> None:
    from piezo_sym.build import drift, raise_if_drifted

    options = ["--out", str(out)] if out != Path("generated") else []
    options += ["--allow-unproved"] if allow_unproved else []
    command = " ".join(["piezo-sym generate", *specs, *options])
    faults = drift(models, out, complete=complete, allow_unproved=allow_unproved)
    for fault in faults:
        typer.echo(f"{path_text(fault.path)} {fault.fault}; {fault.remedy(command)}")
        lines = fault.diff.splitlines()
        for line in lines[:MOST_LINES]:
            typer.echo(line)
        if more := len(lines[MOST_LINES:]):
            typer.echo(f"... and {more} more lines of the difference")
    raise_if_drifted(faults, command)
    typer.echo(f"{len(models)} {'model' if len(models) == 1 else 'models'} up to date in {out}")
