"""Hysteresis of displacement over voltage, as in Figures 3 and 6: which loop is taken, and how.

Input: the generated module, a frequency, a temperature of the environment.  Output: a run of ten
periods; of these the last is drawn.

The paper does not say when its loops are taken.  A periodic steady state it cannot be: with Table 1
at 100 V and 100 Hz the only one has 2722 K (Figure 4).  The first period is no loop.  Shown is the
tenth after a start at rest in thermal equilibrium: by then the start has died out (the tip returns
to within 0.3 % of its travel) and the body has warmed by a few kelvin.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from piezo_sym.analysis import loops
from piezo_sym.analysis.figures.figure import AMPLITUDE
from piezo_sym.run import simulate, sine
from piezo_sym.run.runs import METHOD

if TYPE_CHECKING:
    import xarray

    from piezo_sym.run import GeneratedModule

PERIODS = 10
SAMPLES_A_PERIOD = 400
RTOL = 1e-7


def run(module: GeneratedModule, frequency: float, T_e: float) -> xarray.Dataset:
    """Return voltage, displacement and temperature over ten periods."""
    whole = simulate(
        module,
        inputs={"V_in": sine(AMPLITUDE, frequency), "T_e": T_e},
        duration=PERIODS / frequency,
        rtol=RTOL,
        times=PERIODS * SAMPLES_A_PERIOD + 1,
        method=METHOD,
    )
    return whole[["V_in", "q", "T_body"]]


def loop(data: xarray.Dataset) -> xarray.Dataset:
    """Return the last period of a run."""
    return data.isel(
        {"time" if "time" in data.dims else "turn": slice(-SAMPLES_A_PERIOD - 1, None)}
    )


def measured(data: xarray.Dataset) -> loops.Loop:
    """Return the measures of displacement [m] over voltage [V] in the last period of a run."""
    last = loop(data)
    return loops.measure(last.V_in.values, last.q.values)
