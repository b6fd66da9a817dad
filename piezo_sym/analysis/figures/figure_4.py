"""Figure 4: static temperature change of the body over the frequency, for four inductances.

Input: the generated module of ``piezo_stack``.  Output: `FIGURE_4`: 100 V, 25 degrees Celsius.
It shows the mean temperature of the periodic steady states: stable ones as solid lines, unstable
ones thin and dotted, and arrows where the temperature jumps; an inset enlarges the folds.

With Table 1's numbers the damper's heat grows with alpha^2, so with T^2, but the cooling only with
T.  Up to a fold at 58 to 71 Hz, depending on the inductance, there is a cool steady state, whose
temperature rises with the frequency, as the paper reports.  Past the fold there is none, and the
temperature rises until the inductance limits the current, at thousands of kelvin.  The temperature
of this hot state falls with the frequency, as it follows the resonance of inductance and reflected
capacitance.

Temperatures above 400 K are shaded: there the laws are not valid.  alpha = a T/T_0 and
rho/(T - T_0) are fits near room temperature; commercial stacks are rated to 350 to 420 K, and at
the Curie temperature of soft PZT (420 to 620 K) the piezoelectric effect vanishes.
"""

from typing import Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from piezo_sym.analysis.branches import steady_branches
from piezo_sym.analysis.figures.figure import AMPLITUDE, TEMPERATURES, ZERO_CELSIUS, PaperFigure
from piezo_sym.analysis.style import COLOURS, SMALL, column_figure, dress, legend, name_axes
from piezo_sym.run import GeneratedModule, sine

T_E = TEMPERATURES[0] + ZERO_CELSIUS  # K
INDUCTANCES = (0.1, 0.5, 1.0, 5.0)  # mH
FREQUENCIES = (10.0, 1000.0)  # Hz
HOTTEST = 1e4  # K: curves end there
VALID = 400.0  # K: above, the laws are not valid
LEAST, MOST = 1.0, 1e4  # ends of the axis [K]
MARKS = ("o", "s", "^", "D")  # not dashes, which tell stable from unstable
#: The inset of the folds: its place in the axes, its ranges of frequency [Hz] and rise [K].
INSET = (0.57, 0.08, 0.41, 0.29)
FOLDS, RISES = (55.0, 75.0), (50.0, 500.0)
APART = 0.3  # distance of marks on a line, as a fraction of the diagonal


def curve(module: GeneratedModule, millihenry: float) -> xarray.Dataset:
    """Return the steady states at one inductance [mH], in order along their curves."""
    branches = steady_branches(
        module,
        inputs=lambda f: {"V_in": sine(AMPLITUDE, f), "T_e": T_E},
        frequencies=FREQUENCIES,
        temperatures=(T_E, HOTTEST),
        parameters={"L": millihenry * 1e-3},
    )
    units = {"frequency": "Hz", "temperature": "K", "coldest": "K", "hottest": "K", "jumps_to": "K"}
    columns = {
        name: ("point", values, {"units": units.get(name, "1")})
        for name, values in branches.table().items()
    }
    return xarray.Dataset(columns, {"point": np.arange(columns["curve"][1].size)})


def draw(data: xarray.Dataset) -> Figure:
    """Return Figure 4, the rise over the environment, both axes logarithmic."""
    figure, axes = column_figure(3.5)
    axes.set(xscale="log", yscale="log", xlim=FREQUENCIES, ylim=(LEAST, MOST))
    _draw_all(axes, data)
    text = f"over {VALID:.0f} K: outside\nthe laws' range"
    axes.text(11, 130, text, fontsize=SMALL - 1, color="0.25", va="bottom")
    name_axes(axes, "frequency $f$ [Hz]", "temperature rise $T - T_{\\mathrm{e}}$ [K]")
    above = {"loc": "lower center", "bbox_to_anchor": (0.5, 1.0), "ncols": len(MARKS)}
    legend(axes, "$L$", **above, handlelength=1.5, columnspacing=1.2)
    folds = axes.inset_axes(INSET, xlim=FOLDS, ylim=RISES)
    dress(folds)
    folds.tick_params(labelsize=SMALL - 1)
    _draw_all(folds, data)
    axes.indicate_inset_zoom(folds, edgecolor="0.3", linewidth=0.5)
    return figure


def _draw_all(axes: Axes, data: xarray.Dataset) -> None:
    axes.axhspan(VALID - T_E, MOST, color="0.9", linewidth=0, zorder=0)
    for n, (millihenry, colour) in enumerate(zip(data.L.values, COLOURS, strict=False)):
        one = data.sel(L=millihenry).dropna("point", subset=["frequency"])
        look = {"color": colour, "marker": MARKS[n], "markersize": 3}
        apart = (APART * (n + 0.5) / len(MARKS), APART)  # first mark, and distance of the next
        label = f"{millihenry:g} mH"
        for number in np.unique(one["curve"].values):
            part = one.isel(point=one["curve"].values == number)
            _draw_curve(axes, part, label, {**look, "markevery": apart})
            label = "_again"
        _draw_jumps(axes, one, look)


def _draw_curve(axes: Axes, curve: xarray.Dataset, label: str, look: dict[str, Any]) -> None:
    """Draw one curve, solid where stable, else dotted; a fold belongs to both parts."""
    frequency, rise = curve.frequency.values, curve.temperature.values - T_E
    fold = np.isfinite(curve.jumps_to.values) | np.isinf(curve.jumps_to.values)
    stable = curve.stable.values > 0
    solid, dotted = (np.where(kind | fold, rise, np.nan) for kind in (stable, ~stable))
    axes.plot(frequency, solid, linewidth=1.2, label=label, **look)
    axes.plot(frequency, dotted, ":", color=look["color"], linewidth=0.8)


def _draw_jumps(axes: Axes, one: xarray.Dataset, look: dict[str, Any]) -> None:
    for n in np.flatnonzero(~np.isnan(one.jumps_to.values)):
        f, start = float(one.frequency[n]), float(one.temperature[n]) - T_E
        end = min(float(one.jumps_to[n]) - T_E, axes.get_ylim()[1])
        style = {"arrowstyle": "->", "color": look["color"], "linewidth": 0.8, "linestyle": "--"}
        axes.annotate("", (f, end), (f, start), arrowprops={**style, "shrinkA": 0, "shrinkB": 0})
        axes.plot(f, start, linestyle="", **look)


FIGURE_4 = PaperFigure("figure_4", "L", INDUCTANCES, "mH", curve, draw)
