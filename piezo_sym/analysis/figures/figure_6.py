"""Figure 6: hysteresis of displacement over voltage at four frequencies.

Input: the generated module of ``piezo_stack``.  Output: `FIGURE_6`: 100 V, 25 degrees Celsius, the
tenth period after a start in thermal equilibrium (see `hysteresis` for why).  The runs have
different lengths, so their data lie over turns of the drive, not over time.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from piezo_sym.analysis.figures.figure import TEMPERATURES, ZERO_CELSIUS, PaperFigure
from piezo_sym.analysis.figures.hysteresis import SAMPLES_A_PERIOD, loop, measured, run
from piezo_sym.analysis.style import COLOURS, DASHES, column_figure, legend, name_axes

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

    from piezo_sym.run import GeneratedModule

FREQUENCIES = (10.0, 50.0, 100.0, 200.0)  # Hz


def curve(module: GeneratedModule, frequency: float) -> xarray.Dataset:
    """Return the run at one frequency [Hz], over turns of the drive."""
    import numpy as np

    found = run(module, frequency, TEMPERATURES[0] + ZERO_CELSIUS)
    turns = np.arange(found.sizes["time"]) / SAMPLES_A_PERIOD
    moved = found.rename(time="turn").assign_coords(turn=("turn", turns))
    moved.turn.attrs.update({"units": "1", "long_name": "turns of the drive"})
    return moved


def draw(data: xarray.Dataset) -> Figure:
    """Return Figure 6."""
    figure, axes = column_figure()
    for frequency, colour, dash in zip(data.frequency.values, COLOURS, DASHES, strict=False):
        one = loop(data.sel(frequency=frequency))
        label = f"{frequency:.0f} Hz"
        axes.plot(one.V_in, one.q * 1e3, linestyle=dash, color=colour, linewidth=1.1, label=label)
    name_axes(axes, "voltage $V_{\\mathrm{in}}$ [V]", "displacement $q$ [mm]")
    axes.set_ylim(-2.3, 3.1)
    legend(axes, "$f$", loc="upper center", ncols=4, handlelength=2, columnspacing=1)
    return figure


def summary(data: xarray.Dataset) -> str:
    """Return widths and slopes of the loops, for a log."""
    found = [measured(data.sel(frequency=f)) for f in data.frequency.values]
    widths = ", ".join(f"{one.width * 1e3:.3f}" for one in found)
    slopes = ", ".join(f"{one.slope * 1e6:.2f}" for one in found)
    return f"width of the loops at 0 V, tenth period [mm]: {widths}; slope [um/V]: {slopes}"


FIGURE_6 = PaperFigure(
    "figure_6", "hysteresis over frequency", "frequency", FREQUENCIES, "Hz", curve, draw, summary
)
