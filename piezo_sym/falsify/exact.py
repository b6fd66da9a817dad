"""A suspicious point evaluated again, exactly, by the checker's reader.

Input: the spec as text, a `Claim` and a point (floats are rationals).  Output: the exact value that
breaks the row, as text, or None.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any, final

import numpy as np
from flint import arb, ctx, fmpq

from piezo_sym.checker import InputError, read_spec
from piezo_sym.checker.network import SingularError
from piezo_sym.falsify.claims import Claim
from piezo_sym.falsify.numbers import exact
from piezo_sym.falsify.point import Point, evaluate
from piezo_sym.falsify.space import Array, Space
from piezo_sym.iphs import IPHS

BITS = 1024
#: What has shrunk to this part of what it was is no jump.
FADED = Fraction(1, 10**6)
#: Two sides of a jump are brought together to these relative distances, and differ as before.
NEAR, NEARER, SAME = Fraction(1, 10**40), Fraction(1, 10**80), Fraction(9, 10)
#: A kink in floating point may lie beside the kink, by so much of its place.
WIDER = (Fraction(0), Fraction(1, 10**15), Fraction(1, 10**12))
TABLES = {
    "heat": "heats",
    "production": "productions",
    "temperature": "temperatures",
    "slope": "slopes",
    "conductance": "conductances",
}
Watched = tuple[Any, ...] | None


@final
class _View:
    """The checker's point as the rows look at it; what it cannot tell is an enclosure of all."""

    def __init__(self, at: Point, inputs: dict[str, Fraction]) -> None:
        self.at, self.inputs = at, inputs

    def get(self, what: str, name: str) -> list[tuple[Any, Any]]:
        if what == "input":
            found: Any = self.inputs[name]
        elif what == "rate":
            found = self.at.rates[name]
        elif name:
            found = getattr(self.at, TABLES[what])[name]
        else:
            found = tuple(p for own in self.at.productions.values() for p in own)
        return [(_known(v), 0) for v in (found if isinstance(found, tuple) else (found,))]


@final
class Exact:
    """Evaluates rows of one spec."""

    def __init__(self, iphs: IPHS) -> None:
        """Read the spec; the checker's `InputError` if it cannot."""
        self.spec = read_spec(iphs.model.to_toml())
        self.points: dict[tuple[Any, ...], Point] = {}

    def broken(self, claim: Claim, space: Space, point: Array) -> str | None:
        """Return what breaks a row at a point of the domain, or None."""
        values = [Fraction(v) for v in point.tolist()]
        try:
            at = self._at(space, values)
        except SingularError:
            return "the junction laws have no solution" if claim.id == "welldef" else None
        except InputError:  # a bank of too many lanes; its lanes are attacked two at a time, too
            return None
        if at.inside is not True:
            return None
        if claim.id == "welldef":
            lost = claim.element in at.undefined if claim.element else at.undefined
            return "a law has no value" if lost else None
        inputs = dict(
            zip((f.name for f in space.module.INPUTS), values[space.inputs_at :], strict=False)
        )
        view = _View(at, inputs)
        with ctx.workprec(BITS):
            if claim.says(view):
                for name, value, _, strict in claim.at(view):
                    if value < 0 or (strict and value == 0):
                        return f"{name} = {_text(value)}"
        return None

    def has_value(self, claim: Claim, space: Space, point: Array) -> bool:
        """Return whether a law that is nan in floating point has a value at a point inside."""
        at = self._at(space, [Fraction(v) for v in point.tolist()])
        return at.inside is True and claim.element not in at.undefined

    def jump(self, claim: Claim, space: Space, low: Array, high: Array, leap: float) -> str | None:
        """Return the jump of a law between two points, or None if it fades as they meet."""
        point = [Fraction(v) for v in low.tolist()]
        column = int(np.flatnonzero(low != high)[0])
        near, far = point[column], Fraction(float(high[column]))

        def seen(value: Fraction) -> Watched:
            at = self._at(space, [*point[:column], value, *point[column + 1 :]])
            return _watched(claim, at) if at.inside else None

        for wider in WIDER:
            off = wider * max(abs(near), abs(far)) * (1 if far > near else -1)
            if _gap(seen(near - off), seen(far + off)) > Fraction(leap) / 10:
                gap = _narrowed(seen, near - off, far + off)
                text = f"its values differ by {_text(gap or 0)} at a distance of {float(NEARER):g}"
                return text if gap else None
        return None

    def _at(self, space: Space, values: list[Fraction]) -> Point:
        """Return what is computed at a point, once for all claims."""
        key = (*space.counts.items(), *values)
        if key not in self.points:
            self.points[key] = self._computed(space, values)
        return self.points[key]

    def _computed(self, space: Space, values: list[Fraction]) -> Point:
        given: list[dict[str, Any]] = []
        for records in (space.module.PARAMETERS, space.module.INPUTS, space.module.STATES):
            given.append({})
            for record in records:
                count = space.lanes(record.bank)
                given[-1][record.name] = values[:count] if record.bank else values[0]
                values = values[count:]
        parameters, inputs, states = given
        return evaluate(self.spec, parameters, inputs, states, space.counts)


def _narrowed(
    seen: Callable[[Fraction], Watched], low: Fraction, high: Fraction
) -> Fraction | None:
    """Return by how much values differ on two sides that come together, if it does not fade."""
    scale, gaps = max(abs(low), abs(high)), []
    one, other = seen(low), seen(high)
    gap = most = _gap(one, other)
    for limit in (NEAR, NEARER):
        while abs(high - low) > limit * scale:
            middle = (low + high) / 2
            value = seen(middle)
            left, right = _gap(one, value), _gap(value, other)
            if value is None or gap <= FADED * most:
                return None
            calm = (
                1000 * min(left, right) <= max(left, right) or max(left, right) > SAME * 3 * gap / 2
            )
            if limit == NEARER and not calm:  # no step and no pole, but a swing not yet resolved
                return None
            if left >= right:
                high, other, gap = middle, value, left
            else:
                low, one, gap = middle, value, right
        gaps.append(gap)
    return gaps[1] if gaps[1] > SAME * gaps[0] else None


def _watched(claim: Claim, at: Point) -> tuple[Any, ...]:
    """Return what jumps if a law does: its values, or the rates where no law of its own is seen."""
    for table in (at.outputs, at.temperatures, at.conductances):
        found = table.get(claim.element)
        if found is not None:
            return found if isinstance(found, tuple) else (found,)
    return tuple(value for rates in at.rates.values() for value in rates)


def _gap(one: Watched, other: Watched) -> Fraction:
    """Return the largest difference of two vectors, as a lower bound; 0 where one is not there."""
    if one is None or other is None:
        return Fraction(0)
    with ctx.workprec(BITS):
        gaps = (_least(_known(a) - _known(b)) for a, b in zip(one, other, strict=True))
        return max(gaps, default=Fraction(0))


def _least(gap: Any) -> Fraction:
    """Return the least size that an enclosure allows."""
    if isinstance(gap, fmpq):
        return Fraction(int(abs(gap).p), int(gap.q))
    if not gap.is_finite():
        return Fraction(0)
    mantissa, exponent = gap.abs_lower().man_exp()
    return int(mantissa) * Fraction(2) ** int(exponent)


def _known(value: Any) -> Any:
    return arb("nan") if value is None else exact(value)


def _text(value: Any) -> str:
    """Return an exact value as text: a short fraction, or enough digits."""
    short = str(value)
    if isinstance(value, arb) or len(short) > 40:
        return str(arb(exact(value)).mid().str(17, radius=False))
    return short
