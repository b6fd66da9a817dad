"""A suspicious point again, exactly, by the checker's reader: is the row false there, or the float?

Input: the spec as text, a `Claim` and a point (floats are rationals).  Output: the exact value that
breaks the row, as text, or None.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Any, final

from flint import arb, ctx, fmpq

from piezo_sym.checker import InputError, read_spec
from piezo_sym.checker.network import SingularError
from piezo_sym.checker.numbers import exact
from piezo_sym.falsify.claims import Claim
from piezo_sym.falsify.point import Point, evaluate
from piezo_sym.falsify.space import Array, Space
from piezo_sym.iphs import IPHS
from piezo_sym.spec.elements.ports import Body, Conductor, Exchange

BITS = 1024
#: Two sides of a jump are brought together to these relative distances, and differ as before.
NEAR, NEARER = Fraction(1, 10**40), Fraction(1, 10**80)
SAME = Fraction(9, 10)


@final
class Exact:
    """Evaluates rows of one spec."""

    def __init__(self, iphs: IPHS) -> None:
        """Read the spec.

        Raises
        ------
        InputError
            If the checker cannot.
        """
        self.circuit, self.spec = iphs.circuit, read_spec(iphs.model.to_toml())

    def broken(self, claim: Claim, space: Space, point: Array) -> str | None:
        """Return what breaks a row at a point of the domain, or None."""
        values = [Fraction(v) for v in point.tolist()]
        at = self._at(space, values)
        if at is None:
            alone = claim.id == "welldef" and not claim.element
            return "the junction laws have no solution" if alone else None
        if at.inside is not True:
            return None
        if claim.id == "welldef":
            lost = at.undefined if not claim.element else set(at.undefined) & {claim.element}
            return "a law has no value" if lost else None
        with ctx.workprec(BITS):
            for name, value, strict in self._numbers(claim, space, at, values):
                if value is not None and (value < 0 or (strict and value == 0)):
                    return f"{name} = {_text(value)}"
        return None

    def has_value(self, claim: Claim, space: Space, point: Array) -> bool:
        """Return whether a law that is nan in floating point has a value at a point inside."""
        at = self._at(space, [Fraction(v) for v in point.tolist()])
        return at is not None and at.inside is True and claim.element not in at.undefined

    def jump(self, claim: Claim, space: Space, low: Array, high: Array) -> str | None:
        """Return the jump of a law between two points, or None if it fades as they meet."""
        sides = [[Fraction(v) for v in point.tolist()] for point in (low, high)]
        column = next(n for n, (a, b) in enumerate(zip(*sides, strict=True)) if a != b)
        ends = [side[column] for side in sides]
        scale = max(map(abs, ends))

        def seen(value: Fraction) -> tuple[Any, ...] | None:
            point = [*sides[0][:column], value, *sides[0][column + 1 :]]
            at = self._at(space, point)
            return _watched(claim, at) if at is not None and at.inside else None

        found = [seen(end) for end in ends]
        gaps = []
        for limit in (NEAR, NEARER):
            while abs(ends[1] - ends[0]) > limit * scale:
                middle = sum(ends, Fraction(0)) / 2
                value = seen(middle)
                if value is None or None in found:
                    return None
                left = _gap(found[0], value) >= _gap(value, found[1])
                ends, found = (
                    ([ends[0], middle], [found[0], value])
                    if left
                    else ([middle, ends[1]], [value, found[1]])
                )
            gaps.append(_gap(*found))
        if gaps[1] > 0 and gaps[1] > SAME * gaps[0]:
            return f"its values differ by {_text(gaps[1])} at distances {float(NEARER):g} apart"
        return None

    def _at(self, space: Space, values: list[Fraction]) -> Point | None:
        """Return the spec at a point, or None if its network has no solution there."""
        given: list[dict[str, Any]] = []
        for records in (space.module.PARAMETERS, space.module.INPUTS, space.module.STATES):
            own: dict[str, Any] = {}
            for record in records:
                count = space.counts[record.bank] if record.bank else 1
                own[record.name] = values[:count] if record.bank else values[0]
                values = values[count:]
            given.append(own)
        try:
            return evaluate(self.spec, *given, dict(space.counts))
        except SingularError:
            return None

    def _numbers(
        self, claim: Claim, space: Space, at: Point, values: list[Fraction]
    ) -> Iterator[tuple[str, Any, bool]]:
        """Yield what has to be >= 0 (strict: > 0), by name."""
        inputs = {f.name: values[space.inputs_at + n] for n, f in enumerate(space.module.INPUTS)}
        match claim.id:
            case "passive" | "conductance":
                yield "conductance", at.conductances.get(claim.element), False
                for name, found in (("heat", at.heats), ("production", at.productions)):
                    yield from ((name, value, False) for value in found.get(claim.element, ()))
            case "temperature":
                yield "T", at.temperatures[claim.element], True
                yield "dT/dS", at.slopes[claim.element], True
            case "sigma":
                yield "sigma", at.sigma, False
            case "exergy" | "environment" | "invariant":
                yield from self._balances(claim, at, inputs)

    def _balances(
        self, claim: Claim, at: Point, inputs: dict[str, Fraction]
    ) -> Iterator[tuple[str, Any, bool]]:
        """Yield exergy lost, production with the environment, or what a coldest body gains."""
        bodies = {b.element: p.state for b, p in self.circuit.of(Body)}
        bodies = {n: s for n, s in bodies.items() if claim.element in ("", n)}
        hot = {n: _known(at.temperatures[n]) for n in at.temperatures}
        rate = sum((_known(at.rates[s][0]) for s in bodies.values()), exact(0))
        taken, power, outside = exact(0), exact(0), exact(1)
        for placed, port in self.circuit.of(Exchange):
            if port.body in bodies:
                outside = exact(inputs[port.input])
                heat = _known(at.conductances[placed.element]) * (outside - hot[port.body])
                power, taken = power + heat, taken + heat / outside
                if claim.element and not outside > hot[port.body]:
                    return
        if claim.id == "environment":
            yield "the production", rate - taken, False
        elif claim.id == "exergy":
            yield "the exergy lost", outside * rate - power, False
        else:
            pairs = [{p.first, p.second} for _, p in self.circuit.of(Conductor)]
            others = [n for pair in pairs if claim.element in pair for n in pair - {claim.element}]
            if all(hot[claim.element] <= hot[other] for other in others):
                yield "the gain", rate * hot[claim.element] - power, False
                yield "the heat brought", power, False


def _known(value: Any) -> Any:
    """Return a value to compute with; what cannot be told is an enclosure of everything."""
    return arb("nan") if value is None else exact(value)


def _watched(claim: Claim, at: Point) -> tuple[Any, ...]:
    """Return what jumps if a law does."""
    element = claim.element
    for table in (at.outputs, at.temperatures, at.conductances):
        if element in table:
            found = table[element]
            return found if isinstance(found, tuple) else (found,)
    return tuple(value for rates in at.rates.values() for value in rates)


def _gap(one: Any, other: Any) -> Any:
    """Return the largest difference of two vectors, as a lower bound."""
    with ctx.workprec(BITS):
        gaps = [abs(_known(a) - _known(b)) for a, b in zip(one, other, strict=True)]
        return max((Fraction(0), *(_least(gap) for gap in gaps)))


def _least(gap: Any) -> Fraction:
    """Return the least value that an enclosure allows."""
    if isinstance(gap, fmpq):
        return Fraction(int(gap.p), int(gap.q))
    if not gap.is_finite():
        return Fraction(0)
    mantissa, exponent = gap.abs_lower().man_exp()
    return int(mantissa) * Fraction(2) ** int(exponent)


def _text(value: Any) -> str:
    """Return an exact value as text: a short fraction, or enough digits."""
    short = str(value)
    if isinstance(value, Fraction):
        return short if len(short) <= 40 else f"{float(value):.17g}"
    return str(arb(value).mid().str(17, radius=False))


def exact_of(iphs: IPHS) -> Exact | None:
    """Return the evaluator of a system, or None if the checker cannot read its spec."""
    try:
        return Exact(iphs)
    except InputError:
        return None
