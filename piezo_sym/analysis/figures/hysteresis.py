"""Figures 3 and 6: hysteresis of displacement over voltage, by temperature and by frequency.

Input: the generated module of ``piezo_stack``.  Output: `FIGURE_3`: 100 V, 100 Hz, at four
temperatures of the environment; `FIGURE_6`: 100 V, 25 degrees Celsius, at four frequencies.  The
runs of Figure 6 have different lengths, so their data lie over periods of the drive, not over time.

The paper does not say when its loops are taken.  They cannot be periodic steady states: with Table
1 at 100 V and 100 Hz the only one is at 2722 K (Figure 4).  The first period is not closed.  These
are the tenth periods after a start at rest in thermal equilibrium: by then the initial transient
has decayed (the tip returns to within 0.3 % of its travel) and the body has warmed by a few kelvin.
"""

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from piezo_sym.analysis.figures.figure import (
    AMPLITUDE,
    CELSIUS,
    TEMPERATURES,
    ZERO_CELSIUS,
    PaperFigure,
)
from piezo_sym.analysis.style import column_figure, draw_lines, legend, name_axes
from piezo_sym.run import GeneratedModule, simulate, sine
from piezo_sym.run.collocation import METHOD

FREQUENCIES = (10.0, 50.0, 100.0, 200.0)  # Hz, of Figure 6
FREQUENCY = 100.0  # Hz, of Figure 3
PERIODS = 10
SAMPLES = 400  # per period
RTOL = 1e-7


def run(module: GeneratedModule, celsius: float, frequency: float = FREQUENCY) -> xarray.Dataset:
    """Return ten periods, at a temperature of the environment [deg C] and a frequency [Hz]."""
    dataset = simulate(
        module,
        inputs={"V_in": sine(AMPLITUDE, frequency), "T_e": celsius + ZERO_CELSIUS},
        duration=PERIODS / frequency,
        rtol=RTOL,
        times=PERIODS * SAMPLES + 1,
        method=METHOD,
    )
    return dataset[["V_in", "q", "T_body"]]


def over_turns(module: GeneratedModule, frequency: float) -> xarray.Dataset:
    """Return the run at one frequency [Hz], over periods of the drive."""
    dataset = run(module, TEMPERATURES[0], frequency)
    turns = np.arange(dataset.sizes["time"]) / SAMPLES
    attrs = {"units": "1", "long_name": "turns of the drive"}
    return dataset.rename(time="turn").assign_coords(turn=("turn", turns, attrs))


def last_periods(data: xarray.Dataset) -> xarray.Dataset:
    """Return the last period of each run."""
    return data.isel({"time" if "time" in data.dims else "turn": slice(-SAMPLES - 1, None)})


def _draw_loops(data: xarray.Dataset, over: str, unit: str) -> tuple[Figure, Axes]:
    figure, axes = column_figure()
    last = last_periods(data)
    draw_lines(axes, last.V_in, last.q * 1e3, over, unit)
    name_axes(axes, "voltage $V_{\\mathrm{in}}$ [V]", "displacement $q$ [mm]")
    return figure, axes


def draw_3(data: xarray.Dataset) -> Figure:
    """Return Figure 3."""
    figure, axes = _draw_loops(data, "T_e", CELSIUS)
    legend(axes, "$T_{\\mathrm{e}}$", loc="upper left")
    return figure


def draw_6(data: xarray.Dataset) -> Figure:
    """Return Figure 6."""
    figure, axes = _draw_loops(data, "frequency", "Hz")
    axes.set_ylim(-2.3, 3.1)
    legend(axes, "$f$", loc="upper center", ncols=4, handlelength=2, columnspacing=1)
    return figure


FIGURE_3 = PaperFigure("figure_3", "T_e", TEMPERATURES, "degC", run, draw_3)
FIGURE_6 = PaperFigure("figure_6", "frequency", FREQUENCIES, "Hz", over_turns, draw_6)
