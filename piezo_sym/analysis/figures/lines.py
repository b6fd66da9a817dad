"""Figures 2, 3, 5 and 6: a line per temperature or frequency, from the module or from its runs.

Input: the generated module of ``piezo_stack``.  Output: `FIGURE_2`, `FIGURE_3`, `FIGURE_5` and
`FIGURE_6`.

2. The voltage of a hysteron's resistance over its current.  Values are computed by the module, as
   heat over current, not by a second copy of the formula.  The paper does not name the
   temperatures; these are those of its other figures.

       w_T(i) = rho/(T - T_0) deadzone(i, i_0)

3. Displacement over voltage, 100 V at 100 Hz, at four temperatures of the environment.  The paper
   does not say when its loops are taken.  They cannot be periodic steady states: with Table 1 at
   100 V and 100 Hz the only one is at 2722 K (Figure 4).  The first period is not closed.  These
   are the tenth periods after a start at rest in thermal equilibrium: by then the initial
   transient has decayed (the tip returns to within 0.3 % of its travel) and the body has warmed by
   a few kelvin.
5. Displacement after a step of the voltage from 50 V to 100 V.  The run starts in equilibrium at
   50 V and at the environment's temperature.  In thermal equilibrium the tip rests at

       q = V a T_e/(T_0 k)

   The step leaves 0.3 J of heat in the body, which warms it by 0.05 K; so after the 10 ms shown,
   the tip is beyond this q by 2e-4 of its travel, and returns with the time constant
   c_0/lam = 2.5 s.
6. As Figure 3, at 25 degrees Celsius and four frequencies.  The runs have different lengths, so
   their data lie over periods of the drive, not over time.
"""

from typing import Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from piezo_sym.analysis.figures.figure import AMPLITUDE, TEMPERATURES, ZERO_CELSIUS, PaperFigure
from piezo_sym.analysis.style import COLOURS, DASHES, column_figure, legend, name_axes
from piezo_sym.run import GeneratedModule, simulate, sine, step
from piezo_sym.run.collocation import METHOD

CELSIUS = "\N{DEGREE SIGN}C"
MOST_CURRENT = 2.0  # A, of Figure 2
POINTS = 400  # none at i = 0, where heat over current is 0/0
FREQUENCY, FREQUENCIES = 100.0, (10.0, 50.0, 100.0, 200.0)  # Hz, of Figures 3 and 6
PERIODS = 10
SAMPLES = 400  # per period
BEFORE, AFTER = 50.0, 100.0  # V, of Figure 5
AT, DURATION = 1e-3, 11e-3  # s
STEP_SAMPLES = 1101
RTOL = 1e-7
T_E = "$T_{\\mathrm{e}}$"


def operator(module: GeneratedModule, celsius: float) -> xarray.Dataset:
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


def ten_periods(
    module: GeneratedModule, celsius: float, frequency: float = FREQUENCY
) -> xarray.Dataset:
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
    dataset = ten_periods(module, TEMPERATURES[0], frequency)
    turns = np.arange(dataset.sizes["time"]) / SAMPLES
    attrs = {"units": "1", "long_name": "turns of the drive"}
    return dataset.rename(time="turn").assign_coords(turn=("turn", turns, attrs))


def static(module: GeneratedModule, voltage: float, T_e: float) -> float:
    """Return the displacement [m] in equilibrium at a voltage [V] and a temperature [K]."""
    p = module.Parameters()
    return float(voltage * p.a * T_e / (p.T_0 * p.k))


def stepped(
    module: GeneratedModule, T_e: float, duration: float = DURATION, times: int = STEP_SAMPLES
) -> xarray.Dataset:
    """Return a run from equilibrium at 50 V through the step to 100 V, T_e in K."""
    charge = BEFORE * module.Parameters().C
    return simulate(
        module,
        inputs={"V_in": step(AT, BEFORE, AFTER), "T_e": T_e},
        initial={"q": static(module, BEFORE, T_e), "Q_C": charge},
        duration=duration,
        rtol=RTOL,
        times=times,
        method=METHOD,
    )


def step_response(module: GeneratedModule, celsius: float) -> xarray.Dataset:
    """Return the run at one temperature of the environment [degrees Celsius]."""
    return stepped(module, celsius + ZERO_CELSIUS)[["V_in", "q", "T_body"]]


def _lines(
    x: xarray.DataArray,
    y: xarray.DataArray,
    names: tuple[str, str],
    over: tuple[str, str, str],
    height: float = 2.7,
    linewidth: float = 1.1,
    **place: Any,
) -> tuple[Figure, Axes]:
    """Return y over x, one line per value of a dimension, with that value as its label.

    `names` are those of the axes; `over` is the dimension, its name in the legend, and its unit.
    """
    (dimension, title, unit), (figure, axes) = over, column_figure(height)
    for value, colour, dash in zip(y[dimension].values, COLOURS, DASHES, strict=False):
        along = x.sel({dimension: value}) if dimension in x.dims else x
        look: dict[str, Any] = {"linestyle": dash, "color": colour, "linewidth": linewidth}
        axes.plot(along, y.sel({dimension: value}), label=f"{value:.0f} {unit}", **look)
    name_axes(axes, *names)
    legend(axes, title, **place)
    return figure, axes


def draw_2(data: xarray.Dataset) -> Figure:
    """Return Figure 2."""
    names, over = ("current $i$ [A]", "voltage $w_T(i)$ [V]"), ("T", "$T$", CELSIUS)
    return _lines(data.i, data.w_T, names, over, height=2.5, linewidth=1.2, loc="upper left")[0]


def _loops(data: xarray.Dataset, over: tuple[str, str, str], **place: Any) -> tuple[Figure, Axes]:
    """Return the loops of the last period of each run."""
    last = data.isel({"time" if "time" in data.dims else "turn": slice(-SAMPLES - 1, None)})
    names = "voltage $V_{\\mathrm{in}}$ [V]", "displacement $q$ [mm]"
    return _lines(last.V_in, last.q * 1e3, names, over, **place)


def draw_3(data: xarray.Dataset) -> Figure:
    """Return Figure 3."""
    return _loops(data, ("T_e", T_E, CELSIUS), loc="upper left")[0]


def draw_5(data: xarray.Dataset) -> Figure:
    """Return Figure 5, over the time since the step."""
    names, over = ("time since the step [ms]", "displacement $q$ [mm]"), ("T_e", T_E, CELSIUS)
    since = (data.time - AT) * 1e3
    figure, axes = _lines(since, data.q * 1e3, names, over, loc="lower right")
    axes.set_xlim(-AT * 1e3, (DURATION - AT) * 1e3)
    return figure


def draw_6(data: xarray.Dataset) -> Figure:
    """Return Figure 6."""
    place = {"loc": "upper center", "ncols": 4, "handlelength": 2, "columnspacing": 1}
    figure, axes = _loops(data, ("frequency", "$f$", "Hz"), **place)
    axes.set_ylim(-2.3, 3.1)
    return figure


FIGURE_2 = PaperFigure("figure_2", "T", TEMPERATURES, "degC", operator, draw_2)
FIGURE_3 = PaperFigure("figure_3", "T_e", TEMPERATURES, "degC", ten_periods, draw_3)
FIGURE_5 = PaperFigure("figure_5", "T_e", TEMPERATURES, "degC", step_response, draw_5)
FIGURE_6 = PaperFigure("figure_6", "frequency", FREQUENCIES, "Hz", over_turns, draw_6)
