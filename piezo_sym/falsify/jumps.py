"""Jumps of laws: values on both sides of a kink that stay apart however near the sides are.

Input: a row `continuous`, and brackets of kinks between neighbouring floats.  Output: the jump as
text, shown by exact arithmetic on two sides that approach each other.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from fractions import Fraction
from itertools import product
from typing import Any, final

import numpy as np
from flint import ctx, fmpq

from piezo_sym.expressions.exact_eval import exact
from piezo_sym.falsify.claims import Claim
from piezo_sym.falsify.exact import BITS, Point, text
from piezo_sym.falsify.points import Roots
from piezo_sym.falsify.space import EXTREME, LARGEST, LEAST, Array, Evaluation, Mask, Space

#: Relative change of a law between neighbouring floats that is no jump.
JUMP = 1e-6
#: Number of kinks, those with the largest changes, that are evaluated exactly.
MOST_CHECKED = 6
#: A difference that has shrunk to this fraction of its largest value is no jump.
FADED = fmpq(1, 10**6)
#: Relative distances of the two sides; fraction of a jump that must be left from NEAR to NEARER.
NEAR, NEARER, SAME = Fraction(1, 10**40), Fraction(1, 10**80), fmpq(9, 10)
#: Relative errors of a kink found in floating point: its sides are moved apart by these, in turn.
WIDER = (Fraction(0), Fraction(1, 10**15), Fraction(1, 10**12))
Values = list[Any]


def jump(claim: Claim, space: Space, found: Iterable[Sides]) -> tuple[str, Array] | None:
    """Return a jump of a law at one of the kinks found, and a point beside it, or None."""
    laws = [(what, claim.element) for what in space.probe.kinds(claim.element)]
    for sides, law in product(found, laws):
        leap, size = _leap(sides, law)
        big = np.where(sides.near, leap / size, 0)
        for n in np.argsort(-big, kind="stable")[:MOST_CHECKED]:
            if big[n] > JUMP:
                ends = sides.low.points[:, n], sides.high.points[:, n]
                change = float(leap[n]) if leap[n] < LARGEST else 0.0  # beside a pole: any change
                value = _confirmed(claim, space, *ends, change)
                if value:
                    return value, ends[1]
    return None


@final
@dataclass(frozen=True)
class Sides:
    """Points on both sides of kinks; `near` are kinks in states and inputs, inside the domain."""

    near: Mask
    low: Evaluation
    high: Evaluation


def sides_of(space: Space, roots: Roots) -> Sides:
    """Return points on both sides of kinks, which all rows share."""
    step = roots.high - roots.low
    # one float further than `high`: on an edge itself either branch may be taken
    low, high = (space.at(roots.at(value)) for value in (roots.low, roots.high + step))
    near = space.kinks[roots.edge] & (roots.column >= space.inputs_at)
    near &= np.abs(roots.high) < EXTREME
    base = space.at(roots.base)
    return Sides(near & low.inside & high.inside & ~base.extreme & ~base.steep, low, high)


def _leap(sides: Sides, law: tuple[str, str]) -> tuple[Array, Array]:
    """Return the change of a law in the lane where it is largest, and the law's size there."""
    low, high = sides.low.law(*law), sides.high.law(*law)
    with np.errstate(all="ignore"):
        leap = np.nan_to_num(np.abs(high.value - low.value), nan=0, posinf=LARGEST)
        size = np.minimum(low.size + high.size, LARGEST)
    most = leap.max(axis=0, initial=0)
    return most, np.where(leap == most, size, 0).max(axis=0, initial=LEAST)


def _confirmed(claim: Claim, space: Space, low: Array, high: Array, leap: float) -> str | None:
    """Return the jump of a law between two points, or None if it fades as they meet."""
    column = int(np.flatnonzero(low != high)[0])
    near, far = (Fraction(float(side[column])) for side in (low, high))
    point = [exact(value) for value in low.tolist()]

    def there(value: Fraction) -> Point:
        return Point(space, [*point[:column], value, *point[column + 1 :]])

    # of this element alone: the laws of other elements may jump on purpose at the same point
    laws = [space.probe.laws[what, claim.element] for what in space.probe.kinds(claim.element)]

    def values_at(value: Fraction) -> Values:
        return there(value).values(laws)

    for wider in WIDER:
        off = wider * max(abs(near), abs(far)) * (1 if far > near else -1)
        with ctx.workprec(BITS):
            if not _gap(values_at(near - off), values_at(far + off)) > exact(leap) / 10:
                continue
            found = _narrowed(values_at, near - off, far + off)
            if not found or not all(there(side).inside for side in found[1]):
                return None
            return f"its values differ by {text(found[0])} at a distance of {float(NEARER):g}"
    return None


def _narrowed(
    values_at: Callable[[Fraction], Values], low: Fraction, high: Fraction
) -> tuple[Any, tuple[Fraction, Fraction]] | None:
    """Return the difference on two sides that approach a kink, and the sides; None if it fades."""
    scale, gaps = max(abs(low), abs(high)), []
    one, other = values_at(low), values_at(high)
    gap = most = _gap(one, other)
    for limit in (NEAR, NEARER):
        while abs(high - low) > limit * scale:
            middle = (low + high) / 2
            value = values_at(middle)
            left, right = _gap(one, value), _gap(value, other)
            if gap <= FADED * most:
                return None
            calm = (
                1000 * min(left, right) <= max(left, right) or max(left, right) > SAME * 3 * gap / 2
            )
            if limit == NEARER and not calm:  # neither step nor pole, but an unresolved oscillation
                return None
            if left >= right:
                high, other, gap = middle, value, left
            else:
                low, one, gap = middle, value, right
        gaps.append(gap)
    return (gaps[1], (low, high)) if gaps[1] > SAME * gaps[0] else None


def _gap(one: Values, other: Values) -> Any:
    """Return a lower bound on the largest difference of two vectors; 0 if one is not known."""
    if not one or not other:
        return fmpq(0)
    return max(_least(a - b) for a, b in zip(one, other, strict=True))


def _least(gap: Any) -> Any:
    """Return the least absolute value in an enclosure, as a FLINT number.

    A rate beside the kink may be 2**(10**13), which has too many bits for a rational.
    """
    if isinstance(gap, fmpq):
        return abs(gap)
    return gap.abs_lower() if gap.is_finite() else fmpq(0)
