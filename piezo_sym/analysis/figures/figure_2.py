"""Figure 2: the voltage of a hysteron's resistance over its current, at several temperatures.

Input: the generated module of ``piezo_stack``.  Output: `FIGURE_2`.  Values are computed by the
module, as heat over current, not by a second copy of the formula.  The paper does not name the
temperatures; these are those of its other figures.

    w_T(i) = rho/(T - T_0) deadzone(i, i_0)
"""

import numpy as np
import xarray
from matplotlib.figure import Figure

from piezo_sym.analysis.figures.figure import CELSIUS, TEMPERATURES, ZERO_CELSIUS, PaperFigure
from piezo_sym.analysis.style import column_figure, draw_lines, legend, name_axes
from piezo_sym.run import GeneratedModule

MOST_CURRENT = 2.0  # A
POINTS = 400  # none at i = 0, where heat over current is 0/0


def curve(module: GeneratedModule, celsius: float) -> xarray.Dataset:
    """Return w_T over the current, at one temperature of the body [degrees Celsius]."""
    p = module.Parameters(hysteron_count=1)
    T = celsius + ZERO_CELSIUS
    current = MOST_CURRENT * (2 * np.arange(POINTS) + 1 - POINTS) / (POINTS - 1)
    rest = module.initial_state(np.array([0.0, 0.0, T]), p)  # there the body has T_e
    states = np.repeat(rest[:, None], POINTS, axis=1)
    states[3] = p.L * current
    voltage = module.heat(states, np.array([0.0, 0.0, T]), p)[0] / current
    attrs = {"units": "V", "long_name": "voltage of the resistance"}
    axis = xarray.DataArray(current, dims="i", attrs={"units": "A", "long_name": "current"})
    return xarray.Dataset({"w_T": ("i", voltage, attrs)}, {"i": axis})


def draw(data: xarray.Dataset) -> Figure:
    """Return Figure 2."""
    figure, axes = column_figure(2.5)
    draw_lines(axes, data.i, data.w_T, "T", CELSIUS, linewidth=1.2)
    name_axes(axes, "current $i$ [A]", "voltage $w_T(i)$ [V]")
    legend(axes, "$T$", loc="upper left")
    return figure


FIGURE_2 = PaperFigure("figure_2", "T", TEMPERATURES, "degC", curve, draw)
