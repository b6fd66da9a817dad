"""``piezo-sym bench [SPEC]``: speed and error, compared with SciPy on lambdified SymPy."""

from dataclasses import asdict
from json import dumps
from pathlib import Path
from typing import Annotated

import typer
from rich.text import Text

from piezo_sym.cli.output import about, console, print_table
from piezo_sym.cli.simulate import DURATION, time
from piezo_sym.cli.words import Units, pairs
from piezo_sym.files import write_text

Words = list[str] | None


def bench(
    spec: Annotated[
        str, typer.Argument(metavar="[SPEC]", help="Path or shipped name.")
    ] = "piezo_stack",
    only: Annotated[Words, typer.Option(metavar="GROUP", help="rhs, batch or run; repeat.")] = None,
    repeat: Annotated[int, typer.Option(min=1, help="Repetitions of each call.")] = 5,
    duration: Annotated[float, time(DURATION, "--duration")] = 0.1,
    inputs: Annotated[
        Words, typer.Option("--input", "-i", help="NAME=NUMBER or NAME=sine(100V,50Hz).")
    ] = None,
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Report as JSON.")] = None,
) -> None:
    """Measure a spec against lambdified SymPy with solve_ivp.

    Ratios of medians with their quartiles, measured in turns in one process, with the error of
    both sides: above 1, ours is faster. A batch is 10,000 states in one call; small ones gain
    less. piezo_stack is driven with 100 V at 100 Hz; any other spec has its own defaults.
    """
    from piezo_sym.bench import bench as measure
    from piezo_sym.bench.contest import COLUMNS
    from piezo_sym.run.checks import positive
    from piezo_sym.spec.load import load

    with about(spec):
        report = measure(
            load(spec),
            inputs=dict(pairs(inputs or (), "--input", Units(spec).signal)),
            duration=positive(duration, "--duration"),
            only=only or (),
            rounds=repeat,
            say=lambda group: typer.echo(f"measuring {group} ...", err=True),
        )
    if json is not None:
        write_text(json, dumps(asdict(report), indent=1) + "\n")
    print_table(f"benchmark of {report.model}", COLUMNS, (row.cells for row in report.rows))
    for line in report.notes:
        console().print(Text(line))
    if json is not None:
        typer.echo(f"{json}")
