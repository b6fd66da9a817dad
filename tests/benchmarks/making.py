"""Derivation, proofs and generated files: how long they take, and that banks cost nothing.

Input: a `Problem`.  Output: rows that compare the spec with the same spec whose banks have ten
thousand lanes; without banks there is nothing to compare with.  Nothing is remembered from one
call to the next.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from sympy.core.cache import clear_cache

from piezo_sym import Model, derive, verify
from piezo_sym.bench.contest import Contestant, Pair, compared
from piezo_sym.build import files_of, report_and_texts
from piezo_sym.spec.tables import banks
from tests.benchmarks.report import Part

if TYPE_CHECKING:
    from piezo_sym.bench.problem import Problem
    from tests.benchmarks.settings import Settings

LARGE = 10_000
STAGES: tuple[tuple[str, Callable[[Model], object]], ...] = (
    ("derivation", derive),
    ("derivation and proofs", lambda model: verify(derive(model))),
    ("all files of a module", lambda model: files_of(model, *report_and_texts(model))),
)


def making_rows(problem: Problem, settings: Settings) -> Part:
    """Return the rows of the group `making`."""
    large = enlarged(problem.model)
    pairs = []
    for name, stage in STAGES:
        ours = Contestant(name, cold(stage, problem.model))
        other = Contestant(f"{name}, r = {LARGE}", cold(stage, large)) if large else None
        pairs.append(Pair(other, ours))
    return Part(compared("making", pairs, settings.rounds))


def enlarged(model: Model) -> Model | None:
    """Return the model with large banks, or nothing if it has none, or values lane by lane."""
    if not banks(model) or any(isinstance(p.value, tuple) for p in model.parameters.values()):
        return None
    data = model.model_dump()
    for bank in banks(model):
        data["elements"][bank]["count"] = LARGE
    return Model(**data)


def cold(stage: Callable[[Model], object], model: Model) -> Callable[[], object]:
    """Return a call of a stage with nothing remembered by SymPy."""

    def call() -> object:
        clear_cache()
        return stage(model)

    return call
