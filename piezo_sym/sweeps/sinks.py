"""Where results go: into memory, box by box.

Input: a `Frame`, a `Plan`, `Result` records.  Output: a Dataset over the swept dimensions.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any, final

import numpy as np

from piezo_sym.errors import UsageError
from piezo_sym.sweeps.frame import ERROR_ATTRS
from piezo_sym.sweeps.reduce import refuse_other_names

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    import xarray
    from numpy.typing import NDArray

    from piezo_sym.sweeps.frame import Frame, Variable
    from piezo_sym.sweeps.plan import Box, Plan
    from piezo_sym.sweeps.quantities import RunQuantity
    from piezo_sym.sweeps.run import Result


class Sink(ABC):
    """Takes results in any order."""

    @abstractmethod
    def missing(self) -> Iterable[Box]:
        """Return the boxes still to be run."""

    @abstractmethod
    def take(self, result: Result) -> None:
        """Keep a result."""

    @abstractmethod
    def dataset(self) -> xarray.Dataset:
        """Return all results."""


def refuse_other_sizes(name: str, known: tuple[int, ...], one: RunQuantity) -> None:
    """Raise `UsageError` if a function gives a quantity another shape than for runs before."""
    if one.values.shape[1:] != known:
        what = f"the function gives '{name}' other sizes for one run than for another"
        raise UsageError(what, "sweep.reduce", "the same for every run")


@final
class Memory(Sink):
    """Keeps results in arrays over the grid."""

    def __init__(self, plan: Plan, frame: Frame) -> None:
        self._plan, self._frame = plan, frame
        self._errors: NDArray[Any] = np.full(plan.shape, "", dtype=object)
        self._arrays: dict[str, NDArray[Any]] = {}
        self._about: dict[str, RunQuantity] = {}
        self._own: dict[str, RunQuantity] = {}

    def missing(self) -> Iterator[Box]:
        """Return all boxes."""
        return self._plan.boxes()

    def take(self, result: Result) -> None:
        """Keep a result."""
        region = self._plan.region(result.box)
        errors = np.array(result.errors, dtype=object)
        self._errors[region] = self._plan.arranged(result.box, errors)
        self._own = result.coords or self._own
        if self._arrays and result.quantities:
            refuse_other_names(self._arrays, result.quantities)
        for name, one in result.quantities.items():
            if name not in self._arrays:
                self._about[name] = one
                self._arrays[name] = self._room((*self._plan.shape, *one.values.shape[1:]))
            refuse_other_sizes(name, self._about[name].values.shape[1:], one)
            self._arrays[name][region] = self._plan.arranged(result.box, one.values)

    def _room(self, shape: tuple[int, ...]) -> NDArray[Any]:
        """Return an array to fill; nan where a function may leave gaps."""
        return np.full(shape, np.nan) if callable(self._plan.reduce) else np.empty(shape)

    def dataset(self) -> xarray.Dataset:
        """Return all results; those of a function that never ran have no names."""
        dims = self._frame.dims
        data: dict[str, Variable] = {
            name: ((*dims, *self._about[name].dims), array, dict(self._about[name].attrs))
            for name, array in self._arrays.items()
        }
        data = {**data, **self._frame.inputs, "error": (dims, self._errors, ERROR_ATTRS)}
        return self._frame.dataset(data, self._own)
