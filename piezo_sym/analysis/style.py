"""The look of figures: one journal column wide, legible in print, lines distinct without colour.

Input: sizes, labels, data.  Output: Matplotlib figures without any global state, and their files: a
PNG to look at, an SVG to print, a CSV of the data; the same bytes in every run.
"""

import io
from pathlib import Path
from typing import Any

import xarray
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from piezo_sym.files import write_bytes
from piezo_sym.run.text_tables import header_of

#: Okabe and Ito's colours, which colour-blind readers can distinguish; dashes, for print in grey.
COLOURS = ("#0072B2", "#009E73", "#E69F00", "#D55E00", "#CC79A7", "#56B4E9", "#000000", "#F0E442")
DASHES: tuple[str | tuple[int, tuple[int, ...]], ...] = ("-", (0, (6, 2)), (0, (6, 2, 1, 2)), ":")
COLUMN = 3.5  # inches
LABEL, SMALL = 8, 7  # points


def column_figure(height: float = 2.7) -> tuple[Figure, Axes]:
    """Return a figure one column wide, and its axes; `height` in inches."""
    figure = Figure(figsize=(COLUMN, height), dpi=300, layout="constrained")
    axes = figure.add_subplot()
    dress(axes)
    return figure, axes


def dress(axes: Axes) -> None:
    """Give axes a light grid and legible numbers."""
    axes.grid(linewidth=0.3, alpha=0.6)
    axes.set_axisbelow(True)
    axes.tick_params(labelsize=SMALL)


def name_axes(axes: Axes, x: str, y: str) -> None:
    """Label the axes, with units."""
    axes.set_xlabel(x, fontsize=LABEL)
    axes.set_ylabel(y, fontsize=LABEL)


def legend(axes: Axes, title: str, **place: Any) -> None:
    """Add a small legend; `place` as for Matplotlib."""
    place = {"fontsize": SMALL, "title_fontsize": SMALL, "handlelength": 2.6, **place}
    axes.legend(title=title, **place)


def save(figure: Figure, data: xarray.Dataset, folder: Path, name: str) -> tuple[Path, ...]:
    """Write a figure as PNG and SVG and its data as CSV, each file atomically; return the paths."""
    paths = tuple(folder / f"{name}{ending}" for ending in (".png", ".svg", ".csv"))
    for path in paths:
        write_bytes(path, _content(figure, data, path.suffix))
    return paths


def _content(figure: Figure, data: xarray.Dataset, ending: str) -> bytes:
    if ending == ".csv":
        frame = data.to_dataframe().reset_index().dropna(how="all", subset=list(data.data_vars))
        units = {name: data[name].attrs.get("units", "1") for name in frame.columns}
        frame.columns = [header_of(name, unit) for name, unit in units.items()]
        return bytes(frame.to_csv(index=False, float_format="%.10g").encode())
    stream = io.BytesIO()
    metadata = {"Date": None, "Creator": None} if ending == ".svg" else {"Software": None}
    with rc_context({"svg.hashsalt": "piezo_sym"}):
        figure.savefig(stream, format=ending[1:], metadata=metadata)
    return stream.getvalue()
