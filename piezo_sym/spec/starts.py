"""Starts of states that move at one rate, such as the displacements of springs in parallel.

Input: a spec, and the states that a user gave a start.  Output: a warning where others of the same
rate are left out.  The spec is read only where that may be.
"""

import warnings
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from piezo_sym.errors import InputWarning, listing

if TYPE_CHECKING:
    from piezo_sym.spec.model import Model


def warn_parted(model: "str | Path | Model", module: Any, initial: object) -> None:
    """Warn of states that are given a start while others, which move at their rate, are not."""
    given = {*initial} if isinstance(initial, Mapping) else set()
    units = {record.unit for record in module.STATES if record.name in given}
    if all(r.name in given or r.unit not in units for r in module.STATES):
        return
    for group in _groups(model, module.SPEC_SHA256):
        first = [state for state in group if state in given]
        others = [state for state in group if state not in given]
        if first and others:
            kept = listing(f"{first[0]} - {state}" for state in others)
            text = (
                f"{listing(group)} move at one rate; given only {listing(first)}, they keep "
                f"{kept} as at the start: give {listing(others)}, too, if all are one quantity"
            )
            warnings.warn(text, InputWarning, stacklevel=4)


@lru_cache(maxsize=64)
def _groups(model: "str | Path | Model", _sha256: str) -> tuple[list[str], ...]:
    """Return the states of each rate in a spec of this hash; runs in a loop read it once."""
    from piezo_sym.spec.checks.energies import motions
    from piezo_sym.spec.load import load

    spec = (load(model) if isinstance(model, str | Path) else model).flatten()
    alike: dict[object, list[str]] = {}
    for element in spec.elements:
        for state, branch in motions(spec, element).items():
            alike.setdefault(branch, []).append(state)
    return tuple(alike.values())
