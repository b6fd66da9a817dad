"""A figure of the paper: the data of its curves, from runs or searches, and the drawing.

Input: a generated module.  Output: `PaperFigure`, and its data as an `xarray.Dataset`.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, final

import xarray
from matplotlib.figure import Figure

from piezo_sym.run import GeneratedModule

ZERO_CELSIUS = 273.15
#: Environment temperatures of the paper [degrees Celsius].
TEMPERATURES = (25.0, 30.0, 35.0, 40.0)
AMPLITUDE = 100.0  # of the voltage [V]


@final
@dataclass(frozen=True)
class PaperFigure:
    """A figure: functions for the data of one of its curves, and to draw all of them."""

    name: str
    over: str  # dimension along which the curves differ
    values: tuple[float, ...]
    units: str
    curve: Callable[[GeneratedModule, float], xarray.Dataset]
    draw: Callable[[xarray.Dataset], Figure]

    def joined(self, curves: list[xarray.Dataset]) -> xarray.Dataset:
        """Return the data of all curves, in the order of `values`."""
        attrs: dict[str, Any] = {"units": self.units}
        axis = xarray.DataArray(list(self.values), dims=self.over, name=self.over, attrs=attrs)
        return xarray.concat(curves, axis, join="outer", combine_attrs="drop_conflicts")


def data_of(figure: PaperFigure, module: GeneratedModule) -> xarray.Dataset:
    """Return the data of a figure."""
    return figure.joined([figure.curve(module, value) for value in figure.values])
