"""The results of boxes, collected in memory; `store` collects them on disk.

Input: a `Plan`, its frame, `Result` records.  Output: a Dataset over the swept dimensions.  Both
have the same three methods: the boxes that are `missing`, `take` and `dataset`.
"""

from collections.abc import Iterable
from typing import Any, final

import numpy as np
import xarray

from piezo_sym.sweeps.frame import ERROR_ATTRS
from piezo_sym.sweeps.plan import Plan, Region
from piezo_sym.sweeps.reduce import refuse_other_names, refuse_other_sizes
from piezo_sym.sweeps.run import Result


def write(array: Any, region: Region, name: str, one: xarray.Variable) -> None:
    """Write a quantity of a box into an array over the grid."""
    refuse_other_sizes(name, array.shape[len(region) :], one.shape[len(region) :])
    array[region] = one.values


@final
class Memory:
    """Keeps results in arrays over the grid."""

    def __init__(self, plan: Plan, frame: xarray.Dataset) -> None:
        self._plan, self._frame = plan, frame
        self._errors = np.full(plan.shape, "", dtype=object)
        self._found: dict[str, xarray.Variable] = {}
        self._coords: dict[str, xarray.Variable] = {}

    def missing(self) -> Iterable[Region]:
        """Return all boxes."""
        return self._plan.regions()

    def take(self, region: Region, result: Result) -> None:
        """Keep the result of a box."""
        self._errors[region] = result.errors
        self._coords = result.coords or self._coords
        if self._found and result.quantities:
            refuse_other_names(self._found, result.quantities)
        for name, one in result.quantities.items():
            if name not in self._found:
                shape = (*self._plan.shape, *one.shape[len(region) :])
                # a function that fails for a whole box leaves nan
                room = np.full(shape, np.nan) if callable(self._plan.reduce) else np.empty(shape)
                self._found[name] = xarray.Variable(one.dims, room, one.attrs)
            write(self._found[name].values, region, name, one)

    def dataset(self) -> xarray.Dataset:
        """Return all results; only errors, if the reduction never ran."""
        errors = xarray.Variable(self._plan.dims, self._errors, ERROR_ATTRS)
        found = self._frame.assign_coords(self._coords).assign({**self._found, "error": errors})
        return found[[*self._found, *self._frame.data_vars, "error"]]
