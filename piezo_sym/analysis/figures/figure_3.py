"""Figure 3: hysteresis of displacement over voltage at four temperatures of the environment.

Input: the generated module of ``piezo_stack``.  Output: `FIGURE_3`: 100 V, 100 Hz, the tenth period
after a start in thermal equilibrium (see `hysteresis` for why).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from piezo_sym.analysis.figures.figure import TEMPERATURES, ZERO_CELSIUS, PaperFigure
from piezo_sym.analysis.figures.hysteresis import loop, measured, run
from piezo_sym.analysis.style import COLOURS, DASHES, column_figure, legend, name_axes

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

    from piezo_sym.run import GeneratedModule

FREQUENCY = 100.0  # Hz


def curve(module: GeneratedModule, celsius: float) -> xarray.Dataset:
    """Return the run at one temperature of the environment [degrees Celsius]."""
    return run(module, FREQUENCY, celsius + ZERO_CELSIUS)


def draw(data: xarray.Dataset) -> Figure:
    """Return Figure 3."""
    figure, axes = column_figure()
    for celsius, colour, dash in zip(data.T_e.values, COLOURS, DASHES, strict=False):
        one = loop(data.sel(T_e=celsius))
        label = f"{celsius:.0f} \N{DEGREE SIGN}C"
        axes.plot(one.V_in, one.q * 1e3, linestyle=dash, color=colour, linewidth=1.1, label=label)
    name_axes(axes, "voltage $V_{\\mathrm{in}}$ [V]", "displacement $q$ [mm]")
    legend(axes, "$T_{\\mathrm{e}}$", loc="upper left")
    return figure


def summary(data: xarray.Dataset) -> str:
    """Return the slopes of the loops, for a log."""
    slopes = [measured(data.sel(T_e=celsius)).slope * 1e6 for celsius in data.T_e.values]
    return "slope of the loops, tenth period [um/V]: " + ", ".join(f"{s:.3f}" for s in slopes)


FIGURE_3 = PaperFigure(
    "figure_3", "hysteresis over T_e", "T_e", TEMPERATURES, "degC", curve, draw, summary
)
