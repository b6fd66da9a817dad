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


def solve(
    equations: Iterable[Equation], unknowns: Iterable[Label], divisors: list[Any]
) -> dict[Any, Form]:
    """Return each unknown as a combination of givens.

    A pivot is a number as long as there is one; a symbol that had to be divided by is added to
    `divisors`, for somebody has to prove that it is not zero.

    Raises
    ------
    SingularError
        If the equations do not fix every unknown, or contradict each other.
    """
    open_rows = [Equation(dict(row.left), dict(row.right)) for row in equations]
    done: list[tuple[Any, Equation]] = []
    relations: list[Form] = []
    while open_rows:
        row = min(open_rows, key=_difficulty)
        open_rows = [other for other in open_rows if other is not row]
        if not row.left:
            relations += [row.right] if row.right else []
            continue
        pivot = next((k for k, v in row.left.items() if is_number(v)), next(iter(row.left)))
        if not is_number(row.left[pivot]):
            divisors.append(row.left[pivot])
        _normalise(row, pivot)
        for other in [*open_rows, *(equation for _, equation in done)]:
            _eliminate(other, row, pivot)
        done.append((pivot, row))
    solved = {pivot: row for pivot, row in done if not row.left}
    undetermined = [label for label in unknowns if label not in solved]
    if relations or undetermined:
        raise SingularError(relations, undetermined)
    return {pivot: row.right for pivot, row in solved.items()}


def is_number(coefficient: Any) -> bool:
    """Return whether a coefficient is a rational number, free of symbols."""
    top: Any = getattr(coefficient, "numer", None)
    return not hasattr(top, "is_ground") or bool(top.is_ground and coefficient.denom.is_ground)


def _difficulty(row: Equation) -> tuple[bool, int]:
    """Order rows: those with a number to divide by first, then short ones."""
    return bool(row.left) and not any(map(is_number, row.left.values())), len(row.left)


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
