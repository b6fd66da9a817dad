"""How thoroughly to measure.

Input: none.  Output: `Settings`; `THOROUGH`, and `QUICK` for a first look.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import final


@final
@dataclass(frozen=True)
class Settings:
    """Effort of a benchmark.

    Attributes
    ----------
    rounds : how often every call is timed.
    columns : states of a batch.
    run_target, long_target : the errors that runs are tuned to.
    most : seconds that a run of a peer may take; one that takes longer is left out.
    patience : seconds spent on finding a peer's tolerance.
    members, sweep_target : runs of a sweep, and the error that all of them are tuned to.
    """

    rounds: int = 9
    columns: int = 100_000
    run_target: float = 1e-6
    long_target: float = 5e-6
    most: float = 20.0
    patience: float = 90.0
    members: int = 1000
    sweep_target: float = 1e-5


THOROUGH = Settings()
QUICK = Settings(rounds=3, columns=10_000, most=1.0, patience=5.0, members=100)
