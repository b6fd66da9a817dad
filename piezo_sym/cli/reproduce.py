"""``piezo-sym reproduce``: the paper's figures, from the spec to files."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from piezo_sym.cli.output import warnings_as_lines


def reproduce(
    out: Annotated[Path, typer.Option(help="Folder for the figures.")] = Path("figures"),
) -> None:
    """Draw Figure 3 of the paper: hysteresis of displacement over voltage at 25, 30, 35, 40 degC.

    The module is the committed one of piezo_stack; it is compared with its spec first.
    """
    from piezo_sym.analysis.figures import draw_figure_3, figure_3, save, slopes
    from piezo_sym.modules import module_of

    with warnings_as_lines():
        data = figure_3(module_of("piezo_stack"))
    for path in save(draw_figure_3(data), data, out, "figure_3"):
        typer.echo(f"{path}")
    rows = zip(data.T_e.values, slopes(data), strict=True)
    found = ", ".join(f"{slope * 1e6:.3f} at {celsius:.0f} degC" for celsius, slope in rows)
    typer.echo(f"slope of the loops [um/V]: {found}")
