"""Exact elimination on sparse linear equations whose coefficients are rational in opaque symbols.

Input: equations ``sum c_k unknown_k = sum d_k given_k``.  Output: every unknown as a combination of
givens, or a `SingularError` with the contradictions, from which the caller names the elements at
fault.
"""

from collections.abc import Hashable, Iterable, Mapping
from dataclasses import dataclass, field
from heapq import heapify, heappop, heappush
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
    """Equations that do not fix every unknown."""

    relations: list[Form]  # combinations of givens that the equations force to be zero
    undetermined: list[Any]  # unknowns that nothing fixes


@final
class LongError(Exception):
    """Equations whose elimination needs more operations than the limit."""


def accumulate(form: Form, label: Label, coefficient: Any) -> None:
    """Add a multiple of `label` to a combination, in place; zeros drop out."""
    total = form[label] + coefficient if label in form else coefficient
    if total:
        form[label] = total
    else:
        form.pop(label, None)


def combine(form: Form, other: Mapping[Any, Any], factor: Any) -> None:
    """Add `factor` times another combination, in place."""
    if factor in (1, -1):  # as most are: there is no fraction to cancel
        terms = ((label, c if factor == 1 else -c) for label, c in other.items())
    else:
        terms = ((label, factor * c) for label, c in other.items())
    for label, term in terms:
        accumulate(form, label, term)


def solve(
    equations: Iterable[Equation], unknowns: Iterable[Label], divisors: list[Any], most: int
) -> dict[Any, Form]:
    """Return each unknown as a combination of givens.

    Numbers are preferred as pivots.  A pivot with symbols is added to `divisors`: a proof must show
    that it is not zero.  Raises `SingularError` if the equations do not fix every unknown, or
    contradict each other; `LongError` if more than `most` coefficients would be combined.
    """
    rows = [Equation(dict(row.left), dict(row.right)) for row in equations]
    users = _users(rows)
    most -= sum(len(row.left) + len(row.right) for row in rows)
    waiting = {n: _difficulty(row) for n, row in enumerate(rows)}
    queue = [(difficulty, n) for n, difficulty in waiting.items()]
    heapify(queue)
    done: list[tuple[Any, Equation]] = []
    relations: list[Form] = []
    while waiting:
        difficulty, n = heappop(queue)
        if waiting.get(n) != difficulty:  # outdated: the row is done, or was queued again
            continue
        del waiting[n]
        row = rows[n]
        if not row.left:
            relations += [row.right] if row.right else []
            continue
        pivot = _pivot(row, divisors)
        _normalise(row, pivot)
        for other in users.pop(pivot) - {n}:
            factor = rows[other].left.pop(pivot)
            combine(rows[other].left, row.left, -factor)
            combine(rows[other].right, row.right, -factor)
            most -= len(row.left) + len(row.right)
            for label in row.left:
                (users[label].add if label in rows[other].left else users[label].discard)(other)
            if other in waiting:
                waiting[other] = _difficulty(rows[other])
                heappush(queue, (waiting[other], other))
        if most < 0:
            raise LongError
        done.append((pivot, row))
    solved = {pivot: row for pivot, row in done if not row.left}
    undetermined = [label for label in unknowns if label not in solved]
    if relations or undetermined:
        raise SingularError(relations, undetermined)
    return {pivot: row.right for pivot, row in solved.items()}


def _users(rows: list[Equation]) -> dict[Any, set[int]]:
    """Return the rows that contain each unknown."""
    users: dict[Any, set[int]] = {}
    for n, row in enumerate(rows):
        for label in row.left:
            users.setdefault(label, set()).add(n)
    return users


def is_number(coefficient: Any) -> bool:
    """Return whether a coefficient is a rational number, free of symbols."""
    top: Any = getattr(coefficient, "numer", None)
    return not hasattr(top, "is_ground") or bool(top.is_ground and coefficient.denom.is_ground)


def _difficulty(row: Equation) -> tuple[bool, int]:
    """Return a sort key: rows with a numeric pivot first, then by length."""
    return bool(row.left) and not any(map(is_number, row.left.values())), len(row.left)


def _pivot(row: Equation, divisors: list[Any]) -> Any:
    """Return the unknown to solve a row for: one with a numeric coefficient if there is one."""
    pivot = next((k for k, v in row.left.items() if is_number(v)), next(iter(row.left)))
    if not is_number(row.left[pivot]):
        divisors.append(row.left[pivot])
    return pivot


def _normalise(row: Equation, pivot: Label) -> None:
    """Solve a row for its pivot: ``pivot + left = right``, the pivot itself left out."""
    scale = 1 / row.left.pop(pivot)
    row.left = {label: scale * value for label, value in row.left.items()}
    row.right = {label: scale * value for label, value in row.right.items()}
