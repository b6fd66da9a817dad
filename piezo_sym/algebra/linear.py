"""Exact elimination on sparse linear equations whose coefficients are rational in opaque symbols.

Input: equations ``sum c_k unknown_k = sum d_k given_k``.  Output: every unknown as a combination of
givens, or a `Singular` that carries what the equations say instead, so that the caller can name the
elements at fault.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, final

Label = Hashable
Form = dict[Any, Any]


@final
@dataclass
class Equation:
    """One equation: coefficients of unknowns on the left, of givens on the right."""

    left: Form = field(default_factory=dict)
    right: Form = field(default_factory=dict)


@final
@dataclass(eq=False)
class SingularError(Exception):
    """Equations that do not fix every unknown.

    Attributes
    ----------
    relations : combinations of givens that the equations force to be zero.
    undetermined : unknowns that nothing fixes.
    """

    relations: list[Form]
    undetermined: list[Any]


def accumulate(form: Form, label: Label, coefficient: Any) -> None:
    """Add a multiple of `label` to a combination, in place; zeros drop out."""
    total = form.get(label, 0) + coefficient
    if total:
        form[label] = total
    else:
        form.pop(label, None)


def combine(form: Form, other: Mapping[Any, Any], factor: Any) -> None:
    """Add `factor` times another combination, in place."""
    for label, coefficient in other.items():
        accumulate(form, label, factor * coefficient)


def solve(equations: Iterable[Equation], unknowns: Iterable[Label]) -> dict[Any, Form]:
    """Return each unknown as a combination of givens.

    Raises
    ------
    SingularError
        If the equations do not fix every unknown, or contradict each other.
    """
    open_rows = [Equation(dict(row.left), dict(row.right)) for row in equations]
    done: list[tuple[Any, Equation]] = []
    relations: list[Form] = []
    while open_rows:
        row = min(open_rows, key=lambda candidate: len(candidate.left))
        open_rows = [other for other in open_rows if other is not row]
        if not row.left:
            relations += [row.right] if row.right else []
            continue
        pivot = next(iter(row.left))
        _normalise(row, pivot)
        for other in [*open_rows, *(equation for _, equation in done)]:
            _eliminate(other, row, pivot)
        done.append((pivot, row))
    solved = {pivot: row for pivot, row in done if not row.left}
    undetermined = [label for label in unknowns if label not in solved]
    if relations or undetermined:
        raise SingularError(relations, undetermined)
    return {pivot: row.right for pivot, row in solved.items()}


def _normalise(row: Equation, pivot: Label) -> None:
    """Solve a row for its pivot: ``pivot + left = right``, the pivot itself left out."""
    scale = 1 / row.left.pop(pivot)
    row.left = {label: scale * value for label, value in row.left.items()}
    row.right = {label: scale * value for label, value in row.right.items()}


def _eliminate(other: Equation, row: Equation, pivot: Label) -> None:
    factor = other.left.pop(pivot, None)
    if factor is not None:
        combine(other.left, row.left, -factor)
        combine(other.right, row.right, -factor)
