"""`plot`: a dashboard of a run: states, inputs and outputs, temperatures, and the ledger.

Input: the `xarray.Dataset` of a run.  Output: a Matplotlib figure with one panel per unit and size
of the states, inputs, outputs, temperatures, energy and entropy; heat released and entropy
produced, stacked by process; heat conducted between bodies, energy put in, and the residual of its
balance; times of events as vertical lines; without panels of what is absent, or 0 all the time.
"""

from collections.abc import Callable, Iterator
from functools import partial
from itertools import cycle
from typing import Any, TypeAlias

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from piezo_sym.analysis.style import COLOURS, DASHES, LABEL, SMALL, dress
from piezo_sym.errors import UsageError, listing, one_line, quote
from piezo_sym.run.checks import FloatArray, checked_call
from piezo_sym.run.dataset import CONDUCTED
from piezo_sym.run.events import EVENT

Panel: TypeAlias = tuple[str, Callable[[Axes], None]]

ACROSS = 3  # panels in a row
WIDTH, HEIGHT = 3.2, 2.1  # of a panel, inches
LEGEND_WIDTH = 48  # characters of a legend
SHORT = 30  # characters of a legend that fits beside the power of ten of an axis
ABOVE = 2.0  # the distance of a longer one from the panel, over the size of its letters
HANDLE_WIDTH = 5  # characters that the line beside a name takes
HATCHES = ("", "///", "...", "xxx")  # for areas that share a colour
LABEL_WIDTH = 24  # characters beside an axis, in each of two lines
#: Quantities smaller than their unit's largest one by more than this get a panel of their own.
APART = 100.0
#: Less change than this, over the size, counts as round-off, as of a sine sampled at its whole
#: periods, even the 60,000th: numbers of an axis would need ten digits.
ROUND_OFF = 1e-9
STILL = 0.05  # the range of an axis beyond what does not change, over its size
FEW = 30  # samples, which are marked
MOST_LANES = 8  # drawn one by one; of more, the mean and the range are drawn
RESIDUALS = ("energy_residual", "entropy_residual")
SUMS = ("supplied_", "heat_", "produced_", "entropy_exchanged_")


@partial(checked_call, name="plot")
def plot(run: xarray.Dataset) -> Figure:
    """Return a dashboard of a run.

    Parameters
    ----------
    run : what `simulate` returns, or one run of what `sweep` returns: ``runs.isel(L=0)``; with a
        single sample, points are drawn.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with ``.savefig("run.png")``; a notebook shows it after ``%matplotlib inline``.

    Raises
    ------
    UsageError : this is no run, more than one, or one without samples.
    """
    refuse_others(run)
    panels = list(_panels(run))
    rows = -(-len(panels) // ACROSS)
    figure = Figure(figsize=(ACROSS * WIDTH, rows * HEIGHT + 0.3), dpi=120, layout="constrained")
    grid = figure.subplots(rows, ACROSS, sharex=True, squeeze=False).ravel()
    for axes, (label, draw) in zip(grid, panels, strict=False):
        dress(axes)
        axes.ticklabel_format(useOffset=False)
        axes.locator_params(axis="x", nbins=4)
        axes.ticklabel_format(axis="y", scilimits=(-2, 4), useMathText=True)
        axes.yaxis.get_offset_text().set_fontsize(SMALL)
        draw(axes)
        _widen(axes)
        marks = _mark(axes, run)
        axes.set_ylabel(label, fontsize=LABEL)
        _small_legend(axes)
    for axes in grid[len(panels) :]:
        axes.remove()
    for axes in grid[max(0, len(panels) - ACROSS) : len(panels)]:  # the lowest panel of each column
        axes.tick_params(labelbottom=True)
    if marks:
        look: dict[str, Any] = {"fontsize": SMALL, "frameon": False, "ncols": len(marks)}
        figure.legend([*marks.values()], [*marks], loc="outside upper right", **look)
    figure.supxlabel("time [s]", fontsize=LABEL)
    figure.suptitle(str(run.attrs.get("model", "run")), fontsize=LABEL + 1)
    return figure


def refuse_others(run: xarray.Dataset) -> None:
    """Raise `UsageError` if this is not one run over time."""
    where, expected = "plot.run", "a Dataset that simulate() returned"
    if "energy_residual" not in getattr(run, "data_vars", ()):
        raise UsageError(f"{quote(type(run).__name__)} is no run", where, expected)
    more = [str(dim) for dim in run["energy_residual"].dims if dim != "time"]
    if more:
        what = f"this is a sweep over {listing(more)}"
        remedy = f"select one of its runs: plot(runs.isel({', '.join(f'{n}=0' for n in more)}))"
        raise UsageError(what, where, "one run", remedy)
    if "time" not in run["energy_residual"].dims:
        remedy = "a sweep keeps its runs over time if 'reduce' is left out"
        if "time" in run.coords:
            remedy = "keep the time of a sample: plot(run.isel(time=[-1]))"
        raise UsageError("this run has no time", where, expected, remedy)
    if not run["time"].size:
        raise UsageError("this run has no samples", where, "one sample at least")
    error = str(run["error"].values) if "error" in run else ""
    if error:
        what = f"this run failed: {one_line(error)}"
        raise UsageError(what, where, "a run that came through", "select another one")


def _panels(run: xarray.Dataset) -> Iterator[Panel]:
    for unit, named in _by_unit(run).items():
        for names in _by_size(run, named):
            yield _shown(names, unit), partial(_lines, run=run, names=names)
    sums = (
        ("heat released [J]", _stack, "heat_", False),
        (f"{CONDUCTED} [J]", _lines, "heat_", True),
        ("entropy produced [J/K]", _stack, "produced_", False),
        ("energy put in [J]", _lines, "supplied_", False),
    )
    for label, draw, prefix, conducted in sums:
        names = [str(name) for name in run.data_vars if str(name).startswith(prefix)]
        names = [name for name in names if _is_conducted(run[name]) is conducted]
        groups = list(_by_size(run, names))
        for group in groups if draw is _lines else [names] * bool(groups):
            yield label, partial(draw, run=run, names=group, prefix=prefix)
    draw = partial(_lines, names=["energy_residual"], prefix="energy_")
    yield "energy residual [J]", partial(draw, run=run)


def _is_conducted(variable: xarray.DataArray) -> bool:
    """Return whether this is the heat of a conduction, of either sign, which is no stack's part."""
    return str(variable.attrs.get("long_name", "")).startswith(CONDUCTED)


def _shown(names: list[str], unit: str) -> str:
    """Return the names of a panel, as many as fit beside it; its legend has all of them."""
    texts = [", ".join([*names[:n], *["..."] * (len(names) > n)]) for n in (3, 2, 1)]
    text = next((text for text in texts if len(text) <= LABEL_WIDTH), texts[-1])
    return f"{text}{' ' if len(f'{text} [{unit}]') <= LABEL_WIDTH else chr(10)}[{unit}]"


def _by_size(run: xarray.Dataset, names: list[str]) -> Iterator[list[str]]:
    """Yield quantities of one unit in groups of like size, without those that are always 0."""
    sizes = {name: float(np.nanmax(np.abs(_lanes(run[name])), initial=0.0)) for name in names}
    if run.time.size == 1:  # of one instant, 0 is a value like others
        sizes = {name: size or max(sizes.values()) or 1.0 for name, size in sizes.items()}
    left = names
    while left := [name for name in left if sizes[name] > 0]:
        least = max(sizes[name] for name in left) / APART
        yield [name for name in left if sizes[name] >= least]
        left = [name for name in left if sizes[name] < least]


def _widen(axes: Axes) -> None:
    """Draw what varies by round-off alone as constant."""
    low, high = axes.dataLim.intervaly
    if 0 < high - low <= ROUND_OFF * (size := max(abs(low), abs(high))):
        axes.set_ylim(low - STILL * size, high + STILL * size)


def _mark(axes: Axes, run: xarray.Dataset) -> dict[str, LineCollection]:
    """Draw the times of events as vertical lines; return those of each event by its name."""
    dashes, marks = cycle(DASHES[:0:-1]), dict[str, LineCollection]()
    for name, hits in run.coords.items():
        if hits.size and str(hits.attrs.get("long_name", "")).startswith(EVENT):
            look: dict[str, Any] = {"colors": "0.4", "linestyles": [next(dashes)], "linewidth": 0.7}
            across = axes.get_xaxis_transform()
            marks[str(name)] = axes.vlines(hits.values, 0.0, 1.0, transform=across, **look)
    return marks


def _by_unit(run: xarray.Dataset) -> dict[str, list[str]]:
    names: dict[str, list[str]] = {}
    for name in map(str, run.data_vars):
        unit = str(run[name].attrs.get("units", "1"))
        doubled = name.startswith("y_") and unit == "K"  # also T_<body>
        if name == "entropy":  # of a single body it is that one's state
            doubled = any(run[other].equals(run[name]) for other in names.get(unit, ()))
        if "time" not in run[name].dims or name in RESIDUALS or name.startswith(SUMS) or doubled:
            continue
        names.setdefault(unit, []).append(name)
    return names


def _lines(axes: Axes, run: xarray.Dataset, names: list[str], prefix: str = "") -> None:
    """Draw variables as lines; of a bank every lane, or mean and range if there are many."""
    time = run.time.values
    look: dict[str, Any] = {"linewidth": 0.9, "marker": "." if time.size <= FEW else ""}
    axes.set_prop_cycle(linestyle=[d for d in DASHES for _ in COLOURS], color=COLOURS * len(DASHES))
    for name in names:
        values, label = _lanes(run[name]), name.removeprefix(prefix)
        if run[name].ndim == 1:
            axes.plot(time, values, label=label, **look)
        elif values.shape[1] <= MOST_LANES:
            (bank,) = set(run[name].dims) - {"time"}
            lanes = [f"{label}_{lane}" for lane in run[name][bank].values]
            axes.plot(time, values, label=lanes, **look)
        else:
            (mean,) = axes.plot(time, values.mean(axis=1), label=f"{label}: mean and range", **look)
            limits = values.min(axis=1), values.max(axis=1)
            axes.fill_between(time, *limits, color=mean.get_color(), alpha=0.3, linewidth=0)


def _lanes(variable: xarray.DataArray) -> FloatArray:
    """Return a variable over time and lanes, (nt, lanes); one lane if it has no bank."""
    values = np.asarray(variable.transpose("time", ...).values, dtype=float)
    return values.reshape(values.shape[0], -1)


def _stack(axes: Axes, run: xarray.Dataset, names: list[str], prefix: str) -> None:
    """Draw the integrals of processes, stacked, of one instant as points; lanes are added up."""
    time = run.time.values
    base = np.zeros(time.size)
    for n, name in enumerate(names):
        own = _lanes(run[name]).sum(axis=1)
        top = base + own
        colour, label = COLOURS[n % len(COLOURS)], name.removeprefix(prefix)
        hatch = HATCHES[n // len(COLOURS) % len(HATCHES)]
        if time.size == 1:
            axes.plot(time, own, ".", color=colour, label=label)
        else:
            look: dict[str, Any] = {"facecolor": colour, "edgecolor": "0.3", "hatch": hatch}
            axes.fill_between(time, base, top, alpha=0.7, linewidth=0, label=label, **look)
        base = top


def _small_legend(axes: Axes) -> None:
    """Add a legend above a panel, unless its only curve is named by the panel's label."""
    names = axes.get_legend_handles_labels()[1]
    if len(names) > 1 or names[0] not in axes.get_ylabel():
        width = max(map(len, names)) + HANDLE_WIDTH
        columns = max(1, LEGEND_WIDTH // width)
        rows = -(-len(names) // columns)
        columns = -(-len(names) // rows)
        numbers = axes.yaxis.get_major_formatter()
        numbers.set_locs(axes.get_yticks().tolist())
        crowded = columns * width > SHORT and bool(numbers.get_offset())
        axes.legend(
            **{"fontsize": SMALL - 1, "loc": "lower right", "bbox_to_anchor": (1.0, 1.0)},
            **{"ncols": columns, "handlelength": 1.2, "columnspacing": 1.0, "frameon": False},
            **{"handletextpad": 0.4, "borderpad": 0.2, "borderaxespad": ABOVE if crowded else 0.1},
        )
