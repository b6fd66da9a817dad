"""The command ``piezo-sym``: a file per command, one for those about specs; one line per error.

Input: the words of a command line.  Output: text, files, and an exit code: 0 success, 1 a required
property is not proved or a generated file is out of date, 2 the spec or the command is wrong.
"""

import os
import sys
from typing import Annotated, Any

import typer

from piezo_sym.cli.bench import bench
from piezo_sym.cli.generate import generate
from piezo_sym.cli.reference import functions, kinds, new, schema, units
from piezo_sym.cli.reproduce import reproduce
from piezo_sym.cli.show import show
from piezo_sym.cli.simulate import simulate
from piezo_sym.cli.verify import verify
from piezo_sym.errors import PiezoError, legible
from piezo_sym.interrupts import STOPPED

#: The exception typer raises for a wrong command line; its module differs between versions.
CommandError: Any = typer.BadParameter.__mro__[2]

#: Exit code after the reader has closed the pipe, as in typer and rich.
CLOSED = 1

app = typer.Typer(
    name="piezo-sym",
    help="Physical elements to a proved irreversible port-Hamiltonian system and fast modules.",
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)
for command in (
    *(new, verify, generate, show, simulate, reproduce, bench),
    *(kinds, functions, units, schema),
):
    app.command()(command)


def _print_version(wanted: bool) -> None:
    if wanted:
        from piezo_sym import __version__

        typer.echo(__version__)
        raise typer.Exit


@app.callback()
def _options(
    _version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_print_version, is_eager=True, help="Print the version and stop."
        ),
    ] = False,
) -> None:
    """Do nothing: the callback of the option runs before any command is looked up."""


def run(words: list[str]) -> int:
    """Run a command line, and return its exit code; an error is one line on stderr."""
    try:
        code = app(args=words, prog_name="piezo-sym", standalone_mode=False)
        sys.stdout.flush()
    except PiezoError as error:
        return _failed("\npiezo-sym: ".join(error.lines()), error.exit_code)
    except CommandError as error:
        message = legible(error.format_message()).rstrip(".")
        message = message.replace(", unable to parse string as a number", ", such as 0.1")
        command = f" {error.ctx.info_name}" if error.ctx and error.ctx.parent else ""
        python = "; sweeps are made in Python: help(piezo_sym.sweep)" * ("'sweep'" in message)
        return _failed(f"{message}{python}; see `piezo-sym{command} --help`", 2)
    except BrokenPipeError:  # the reader has closed the pipe; files are written by now
        sys.stdout = open(os.devnull, "w")  # noqa: SIM115 - so that the flush at exit is silent
        return CLOSED
    except OSError as error:
        if error.filename is not None:
            return _failed(f"{legible(str(error.filename))}: {error.strerror}", 2)
        return _failed(f"cannot print: {error.strerror}; free some space, or print elsewhere", 2)
    except MemoryError:
        return _failed("out of memory; use smaller banks or fewer --times", 2)
    except (KeyboardInterrupt, typer.Abort):
        code = STOPPED  # newer versions of typer return this code themselves
    if code == STOPPED:
        return _failed("stopped", STOPPED)
    return code if isinstance(code, int) else 0


def _failed(message: str, code: int) -> int:
    typer.echo(f"piezo-sym: {message}", err=True)
    return code
