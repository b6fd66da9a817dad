"""The output of commands: one console, and plain tables that also read well in a log."""

import re
import warnings
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import typer
from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from piezo_sym.errors import InputWarning, PiezoError, UsageError, legible

#: Match an argument of a function, and one that a remedy names.  Options with names of their own.
ARGUMENT = re.compile(r"^simulate\.(\w+)\.?")
ELSEWHERE = re.compile(r"(?<=give it )in '(\w+)'")
OPTIONS = {"inputs": "--input", "parameters": "--set", "events": "--event", "store": "--out"}
STYLES = {"PROVED": "green", "REFUTED": "bold red", "OPEN": "yellow"}


@contextmanager
def about(spec: str, *kinds: type[PiezoError]) -> Iterator[None]:
    """Prefix each error raised inside with the name of the spec's file, unless it has it.

    Parameters
    ----------
    kinds : the types of errors to prefix; all if none is given.
    """
    try:
        yield
    except PiezoError as error:
        name = legible(Path(spec).name)
        if isinstance(error, kinds or PiezoError) and name not in str(error):
            error.put_in(name)
        raise


@contextmanager
def named_as_options(start: str) -> Iterator[None]:
    """Name options in errors about arguments of the function: simulate.parameters.d is --set d.

    Parameters
    ----------
    start : the option that gave the initial state.
    """

    def option(argument: str) -> str:
        return (OPTIONS | {"initial": start}).get(argument, "--" + argument.replace("_", "-"))

    try:
        yield
    except UsageError as error:
        error.where = ARGUMENT.sub(lambda found: f"{option(found[1])} ", error.where).strip()
        error.remedy = ELSEWHERE.sub(lambda found: f"with {option(found[1])}", error.remedy)
        raise


@contextmanager
def warnings_as_lines() -> Iterator[None]:
    """Print warnings of runs as one line each on stderr.

    A call that is refused prints its error only, no warnings about modules.
    """
    from piezo_sym.modules import ModuleWarning
    from piezo_sym.run.engine import EngineWarning

    kinds, of_modules = (EngineWarning, InputWarning, ModuleWarning), list[str]()

    def shown(message: Warning | str, *others: Any, **named: Any) -> None:
        if isinstance(message, ModuleWarning):
            of_modules.append(f"piezo-sym: {legible(str(message))}")
        elif isinstance(message, kinds):
            typer.echo(f"piezo-sym: {legible(str(message))}", err=True)
        else:
            before(message, *others, **named)

    with warnings.catch_warnings():
        before = warnings.showwarning
        warnings.showwarning = shown
        for kind in kinds:
            warnings.simplefilter("always", kind)
        try:
            yield
        except UsageError:
            of_modules.clear()
            raise
        finally:
            for line in of_modules:
                typer.echo(line, err=True)


@contextmanager
def printed_at_the_end() -> Iterator[list[str]]:
    """Print lines at the end, also after an error, so that a closed pipe interrupts no work."""
    lines: list[str] = []
    try:
        yield lines
    except BaseException:  # it matters more than lines that cannot be printed
        with suppress(OSError):
            typer.echo("".join(f"{line}\n" for line in lines), nl=False)
        raise
    typer.echo("".join(f"{line}\n" for line in lines), nl=False)


#: Width of a console that wraps nothing.
ENDLESS = 1_000_000


def console() -> Console:
    """Return the console for results; in a log or a pipe each row is one line."""
    terminal = Console()
    return terminal if terminal.is_terminal else Console(width=ENDLESS)


def print_table(title: str, columns: Sequence[str], rows: Iterable[Sequence[str | Text]]) -> None:
    """Print a table, unless it has no rows; markup in its cells has no effect."""
    heading = Text(title, style="bold", no_wrap=True, overflow="ignore")
    table = Table(*columns, title=heading, title_justify="left", box=box.SIMPLE_HEAD)
    for row in rows:
        table.add_row(*(cell if isinstance(cell, Text) else Text(cell) for cell in row))
    if table.rows:
        console().print(table)
