"""The figures of the paper's section 4, from the committed module.

Input: nothing but the shipped spec ``piezo_stack``.  Output: data as `xarray.Dataset`, and files:
a PNG to look at, an SVG to print, a CSV with the curves.
"""

from __future__ import annotations

import io
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from piezo_sym.files import write_bytes

if TYPE_CHECKING:
    from types import ModuleType

    import xarray

#: Environment temperatures of Figure 3 [degrees Celsius], and the run: 0.1 s at 100 V, 100 Hz.
TEMPERATURES = (25.0, 30.0, 35.0, 40.0)
ZERO_CELSIUS = 273.15
AMPLITUDE, FREQUENCY, DURATION = 100.0, 100.0, 0.1
SAMPLES_A_PERIOD = 400
RTOL = 1e-8
#: Okabe and Ito's colours, told apart by colour-blind readers; dashes, for print in grey.
COLOURS = ("#0072B2", "#009E73", "#E69F00", "#D55E00")
DASHES = ("-", "--", "-.", ":")


def figure_3(module: ModuleType) -> xarray.Dataset:
    """Return voltage and displacement of Figure 3's runs, over `T_e` and time.

    Each run starts at rest in thermal equilibrium and lasts ten periods of the voltage.

    Parameters
    ----------
    module : the generated module of ``piezo_stack``.
    """
    import xarray as xr

    from piezo_sym.run import simulate, sine

    runs = []
    for celsius in TEMPERATURES:
        run = simulate(
            module,
            inputs={"V_in": sine(AMPLITUDE, FREQUENCY), "T_e": celsius + ZERO_CELSIUS},
            duration=DURATION,
            rtol=RTOL,
            times=int(DURATION * FREQUENCY) * SAMPLES_A_PERIOD + 1,
        )
        runs.append(run[["V_in", "q", "T_body"]])
    axis = xr.DataArray(list(TEMPERATURES), dims="T_e", attrs={"units": "degC"})
    return xr.concat(runs, dim=axis.rename("T_e"), join="exact", combine_attrs="drop_conflicts")


def last_period(data: xarray.Dataset) -> xarray.Dataset:
    """Return the last period of the voltage, a loop that is closed but for the warming."""
    return data.isel(time=slice(-SAMPLES_A_PERIOD - 1, None))


def draw_figure_3(data: xarray.Dataset) -> Any:
    """Return Figure 3 as a Matplotlib figure: displacement against voltage for each T_e.

    The paper does not say which part of the run it draws.  Drawn is the tenth period, by when the
    start has died out; the loops still drift a little, because the actuator heats itself.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(3.5, 2.9), dpi=300, layout="constrained")
    axes = figure.add_subplot()
    lines = zip(TEMPERATURES, COLOURS, DASHES, strict=True)
    for celsius, colour, dash in lines:
        loop = last_period(data.sel(T_e=celsius))
        label = f"{celsius:.0f} \N{DEGREE SIGN}C"
        axes.plot(loop.V_in, loop.q * 1e3, dash, color=colour, linewidth=1.2, label=label)
    axes.set_xlabel("voltage $V_{\\mathrm{in}}$ [V]", fontsize=8)
    axes.set_ylabel("displacement $q$ [mm]", fontsize=8)
    axes.grid(linewidth=0.3, alpha=0.6)
    axes.legend(title="$T_{\\mathrm{e}}$", fontsize=7, title_fontsize=7, loc="upper left")
    axes.tick_params(labelsize=7)
    return figure


def save(figure: Any, data: xarray.Dataset, folder: Path, name: str) -> tuple[Path, ...]:
    """Write a figure as PNG and SVG and its data as CSV, each in one step; return the paths.

    Raises
    ------
    FileError
        If the folder cannot be written.
    """
    paths = tuple(folder / f"{name}{ending}" for ending in (".png", ".svg", ".csv"))
    for path in paths:
        write_bytes(path, _content(figure, data, path.suffix))
    return paths


def _content(figure: Any, data: xarray.Dataset, ending: str) -> bytes:
    if ending == ".csv":
        frame = data.to_dataframe().reset_index()
        return bytes(frame.to_csv(index=False, float_format="%.10g").encode())
    stream = io.BytesIO()
    metadata: Mapping[str, None] = {"Date": None} if ending == ".svg" else {"Software": None}
    figure.savefig(stream, format=ending[1:], metadata=metadata)
    return stream.getvalue()


def slopes(data: xarray.Dataset) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Return the slope of each loop's chord, from least to greatest voltage [m/V], over T_e."""
    loop = last_period(data)
    first, last = (int(pick(loop.V_in.values[0])) for pick in (np.argmin, np.argmax))
    rise = loop.q.isel(time=last) - loop.q.isel(time=first)
    return np.asarray(rise / (loop.V_in.isel(time=last) - loop.V_in.isel(time=first)))
