"""Analysis: measures of loops, states of rest and periodic ones, a dashboard, the paper's figures.

Input: runs (`xarray.Dataset`), or generated modules to run.  Output: numbers, frozen records,
Matplotlib figures.  Nothing here imports a spec or SymPy.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from piezo_sym.analysis import loops as loops

__all__ = ["loops"]


def __getattr__(name: str) -> Any:
    """Load the measures of loops when they are first used: they need NumPy and xarray."""
    if name not in __all__:
        message = f"module 'piezo_sym.analysis' has no attribute '{name}'"
        raise AttributeError(message)
    import piezo_sym.analysis.loops as measures

    return measures
