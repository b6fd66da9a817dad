"""A suspicious point evaluated again, exactly, by the checker's reader.

Input: the spec as text, a `Claim` and a point (floats are rationals).  Output: the exact value that
breaks the row, as text, or None.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any, final

from flint import ctx

from piezo_sym.checker import InputError, read_spec
from piezo_sym.checker.network import SingularError
from piezo_sym.falsify.claims import Claim
from piezo_sym.falsify.numbers import text
from piezo_sym.falsify.point import Point, evaluate
from piezo_sym.falsify.space import Array, Space
from piezo_sym.iphs import IPHS

BITS = 1024


@final
class Exact:
    """Evaluates rows of one spec."""

    def __init__(self, iphs: IPHS) -> None:
        """Read the spec; raises the checker's `InputError` if it cannot be read."""
        self.spec = read_spec(iphs.model.to_toml())
        self.points: dict[tuple[Any, ...], Point] = {}

    def at(self, space: Space, values: Sequence[float | Fraction]) -> Point:
        """Return what the spec says at a point, computed once for all claims."""
        key = (*space.counts.items(), *values)
        if key not in self.points:
            numbers = {name: values[columns] for name, columns in space.columns_of.items()}
            try:
                self.points[key] = evaluate(self.spec, numbers, space.counts)
            except InputError:  # too many lanes; two at a time are attacked as well
                self.points[key] = Point({}, inside=None, undefined=())
        return self.points[key]

    def broken(self, claim: Claim, space: Space, point: Array) -> str | None:
        """Return what breaks a row at a point of the domain, or None."""
        try:
            at = self.at(space, point.tolist())
        except SingularError:
            return "the junction laws have no solution" if claim.id == "welldef" else None
        if not at.inside:
            return None
        if claim.id == "welldef":
            lost = claim.element in at.undefined if claim.element else at.undefined
            return "a law has no value" if lost else None
        with ctx.workprec(BITS):
            if claim.says(at):
                for name, value, _, strict in claim.at(at):
                    if value < 0 or (strict and value == 0):
                        return f"{name} = {text(value)}"
        return None

    def has_value(self, claim: Claim, space: Space, point: Array) -> bool:
        """Return whether a law that is nan in floating point has a value at a point inside."""
        at = self.at(space, point.tolist())
        return bool(at.inside) and claim.element not in at.undefined
