"""``piezo-sym bench [SPEC]``: speed and error beside what one would otherwise use."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.text import Text

from piezo_sym.cli.output import about, console, row, table
from piezo_sym.cli.words import pairs, signal
from piezo_sym.files import write_text

if TYPE_CHECKING:
    from piezo_sym.bench import Report


Spec = Annotated[str, typer.Argument(metavar="[SPEC]", help="Path or shipped name.")]
Groups = Annotated[
    list[str] | None,
    typer.Option(metavar="GROUP", help="rhs, batch, run, long, making or sweep; repeat."),
]
Quick = Annotated[
    bool,
    typer.Option(
        "--quick", help="Few repetitions, smaller sweeps, no peers that take over 1 s a run."
    ),
]
Repeat = Annotated[int | None, typer.Option(min=1, help="Repetitions of each call.")]
Duration = Annotated[
    float, typer.Option(help="Length of the short run [s]; the long one takes 100 times it.")
]
Inputs = Annotated[
    list[str] | None,
    typer.Option("--input", "-i", help="NAME=NUMBER, NAME=sine(100,100) or NAME=@FILE.csv; SI."),
]
AsJson = Annotated[Path | None, typer.Option(metavar="FILE", help="Report as JSON.")]
AsMarkdown = Annotated[Path | None, typer.Option(metavar="FILE", help="Report as Markdown.")]


def bench(
    spec: Spec = "piezo_stack",
    only: Groups = None,
    quick: Quick = False,
    repeat: Repeat = None,
    duration: Duration = 0.1,
    inputs: Inputs = None,
    json: AsJson = None,
    markdown: AsMarkdown = None,
) -> None:
    """Measure a spec against lambdified SymPy with solve_ivp, and peers that are installed.

    Ratios of medians, measured in turns in one process, with the error of both sides. A batch is
    100,000 states in one call, 10,000 with --quick; small ones gain less. Peers come
    with `pip install 'piezo_sym[bench]'`. piezo_stack is driven with 100 V at 100 Hz; any other
    spec has its own defaults.
    """
    from piezo_sym.bench import QUICK, THOROUGH, as_json
    from piezo_sym.bench import bench as measure
    from piezo_sym.bench import markdown as as_markdown
    from piezo_sym.run.checks import positive
    from piezo_sym.spec.load import load

    settings = QUICK if quick else THOROUGH
    with about(spec):
        report = measure(
            load(spec),
            inputs=dict(pairs(inputs or (), "--input", signal)),
            duration=positive(duration, "--duration"),
            only=only or (),
            settings=replace(settings, rounds=repeat) if repeat else settings,
            say=lambda group: typer.echo(f"measuring {group} ...", err=True),
        )
    _print(report)
    for path, text in ((json, as_json), (markdown, as_markdown)):
        if path is not None:
            write_text(path, text(report))
            typer.echo(f"{path}")


def _print(report: Report) -> None:
    from piezo_sym.bench.output import COLUMNS, cells, notes
    from piezo_sym.bench.output import about as where

    columns = table(f"benchmark of {report.model}", *COLUMNS)
    for one in report.rows:
        row(columns, *cells(one))
    screen = console()
    screen.print(columns)
    for line in (*notes(report), where(report.machine)):
        screen.print(Text(line))
