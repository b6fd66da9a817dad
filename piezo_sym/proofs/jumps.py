"""Whether a law jumps at a point: what a witness against continuity has to show.

Input: two branches that meet, and exact numbers.  Output: yes only if the law has no value there,
or one of the branches comes near the point and has another value there than the law, or none.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from itertools import combinations, pairwise, product

from piezo_sym.expressions.tree import Cmp, Expr, names
from piezo_sym.proofs.branches import Branch
from piezo_sym.proofs.exact_eval import TooCloseError, Value, holds, minus, sign_of, value_of
from piezo_sym.proofs.obligations import Meeting

#: How far from the point a branch is looked for.
STEPS = tuple(Fraction(1, 10**n) for n in (6, 12, 18))
#: By how much a value must grow from one step to the next to be called a pole.
GROWTH = 10

Numbers = Mapping[str, Fraction]


def jumps(meeting: Meeting, values: Numbers) -> bool:
    """Return whether the law of two branches certainly jumps at a point, or has no value there."""
    try:
        at = value_of(meeting.law, values)
    except TooCloseError:
        return False
    except (ArithmeticError, ValueError):
        return True
    return any(_other(side, meeting, at, values) for side in meeting.sides)


def _other(side: Branch, meeting: Meeting, at: Value, values: Numbers) -> bool:
    """Return whether a branch comes near a point with another value than the law has there."""
    try:
        apart = sign_of(minus(value_of(side.value, values), at))
    except TooCloseError:
        return False
    except (ArithmeticError, ValueError):
        ways = _ways(side, meeting, values)
        return any(_grows([_size(meeting.law, point) for point in way]) for way in ways)
    return bool(apart) and any(True for _ in _ways(side, meeting, values))


def _size(law: Expr, values: Numbers) -> float:
    try:
        value = value_of(law, values)
    except (ArithmeticError, ValueError):
        return 0.0
    return abs(float(value if isinstance(value, Fraction) else value.mid))


def _grows(sizes: list[float]) -> bool:
    return sizes[0] > 0 and all(later > GROWTH * before for before, later in pairwise(sizes))


def _ways(side: Branch, meeting: Meeting, values: Numbers) -> Iterator[list[Numbers]]:
    """Yield points of a branch nearer and nearer to a point, one direction after the other.

    Parameters stay where they are: a jump along them is none that a run could see.
    """
    for way in _directions(tuple(name for name in values if name not in meeting.fixed)):
        points: list[Numbers] = [
            {n: v + step * way.get(n, 0) for n, v in values.items()} for step in STEPS
        ]
        if all(_within((*meeting.domain, *side.conditions), point) for point in points):
            yield points


def _directions(order: tuple[str, ...]) -> Iterator[Mapping[str, int]]:
    for name, sign in product(order, (1, -1)):
        yield {name: sign}
    for (one, other), sign, factor in product(combinations(order, 2), (1, -1), (1, -1, 2, -2)):
        yield {one: sign, other: factor}


def _within(conditions: tuple[Cmp, ...], values: Numbers) -> bool:
    """Return whether comparisons hold, as far as they are about the names given."""
    known = (c for c in conditions if {*names(c)} <= values.keys())
    try:
        return all(holds(condition, values) for condition in known)
    except (ArithmeticError, ValueError):
        return False
