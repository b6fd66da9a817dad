"""Figure 5: displacement after a step of the voltage from 50 V to 100 V, at four temperatures.

Input: the generated module of ``piezo_stack``.  Output: `FIGURE_5`.  The run starts in equilibrium
at 50 V and at the environment's temperature.  In thermal equilibrium the tip rests at

    q = V a T_e/(T_0 k)

The step leaves 0.3 J of heat in the body, which warms it by 0.05 K; so after the 10 ms shown, the
tip is beyond this q by 2e-4 of its travel, and returns with the time constant c_0/lam = 2.5 s.
"""

import xarray
from matplotlib.figure import Figure

from piezo_sym.analysis.figures.figure import CELSIUS, TEMPERATURES, ZERO_CELSIUS, PaperFigure
from piezo_sym.analysis.style import column_figure, draw_lines, legend, name_axes
from piezo_sym.run import GeneratedModule, simulate, step
from piezo_sym.run.collocation import METHOD

BEFORE, AFTER = 50.0, 100.0  # V
AT, DURATION = 1e-3, 11e-3  # s
SAMPLES = 1101
RTOL = 1e-7


def static(module: GeneratedModule, voltage: float, T_e: float) -> float:
    """Return the displacement [m] in equilibrium at a voltage [V] and a temperature [K]."""
    p = module.Parameters()
    return float(voltage * p.a * T_e / (p.T_0 * p.k))


def stepped(
    module: GeneratedModule, T_e: float, duration: float = DURATION, times: int = SAMPLES
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


def curve(module: GeneratedModule, celsius: float) -> xarray.Dataset:
    """Return the run at one temperature of the environment [degrees Celsius]."""
    return stepped(module, celsius + ZERO_CELSIUS)[["V_in", "q", "T_body"]]


def draw(data: xarray.Dataset) -> Figure:
    """Return Figure 5, over the time since the step."""
    figure, axes = column_figure()
    draw_lines(axes, (data.time - AT) * 1e3, data.q * 1e3, "T_e", CELSIUS)
    name_axes(axes, "time since the step [ms]", "displacement $q$ [mm]")
    axes.set_xlim(-AT * 1e3, (DURATION - AT) * 1e3)
    legend(axes, "$T_{\\mathrm{e}}$", loc="lower right")
    return figure


FIGURE_5 = PaperFigure("figure_5", "T_e", TEMPERATURES, "degC", curve, draw)
