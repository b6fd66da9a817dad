"""Whether a value is zero for all values of its names, on every branch and every lane.

Input: a `Value`.  Output: yes, or not shown.  Where signs choose, every choice that does not
contradict itself is looked at; where a difference is zero, that is put in.  What stands under a
fraction is multiplied out.  A sum over lanes is zero if its terms are.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import combinations, product
from math import ceil

from piezo_sym.translation.change import put
from piezo_sym.translation.field import Field, NotShownError, Value

MOST_CASES = 3**6
Sides = Mapping[Value, int]


def is_zero(value: Value, *, inside: bool = False) -> bool:
    """Return whether a value is shown to be zero; with `inside`, where no difference is zero."""
    if not value.terms:
        return True
    parts = _apart(value)
    if len(parts) > 1 or parts[0] is not value:
        return all(is_zero(part, inside=inside) for part in parts)
    groups = _groups(value)
    if not groups:
        return not cleared(value).terms
    if _by_cases(value, groups, inside=inside):
        return True
    together = [tuple(d for group in groups for d in group)]
    return len(groups) > 1 and _by_cases(value, together, inside=inside)


def cleared(value: Value) -> Value:
    """Return a value times the sums that it is divided by."""
    field = value.field
    while True:
        least: dict[int, Fraction] = {}
        for mono in value.terms:
            for g, e in mono:
                if e < 0 and field.gens[g].kind == "power":
                    least[g] = min(least.get(g, Fraction(0)), Fraction(e))
        if not least:
            return value
        g, e = next(iter(least.items()))
        value = value * Value(field, {((g, ceil(-e)),): 1})  # still a power where e is no number


def _apart(value: Value) -> list[Value]:
    """Return a value's sums over lanes, those with equal factors in the lane joined, and the rest.

    The value is the sum of the rest and, for each of the others, of its sum over lanes.
    """
    field, rest = value.field, []
    sums: dict[tuple[str, Value], list[Value]] = {}
    for mono, c in value.terms.items():
        found = next((n for n, (g, e) in enumerate(mono) if _is_sum(field, g) and e == 1), None)
        if found is None:
            rest.append(Value(field, {mono: c}))
            continue
        gen = field.gens[mono[found][0]]
        other = mono[:found] + mono[found + 1 :]
        own = tuple(p for p in other if (gen.mark, 0) in field.gens[p[0]].lanes)
        free = Value(field, {tuple(p for p in other if p not in own): c})
        assert gen.arg is not None
        sums.setdefault((str(gen.mark), Value(field, {own: 1})), []).append(free * gen.arg)
    if not sums:
        return [value]
    return [field.total(rest), *map(field.total, sums.values())]


def _is_sum(field: Field, g: int) -> bool:
    return field.gens[g].kind == "sum"


def _groups(value: Value) -> list[tuple[Value, ...]]:
    """Return the differences whose signs choose, those that stand in one product together."""
    field, groups = value.field, list[set[Value]]()
    for mono in value.terms:
        gens = (field.gens[g] for g, _ in mono)
        here = {gen.arg for gen in gens if gen.kind == "sign" and gen.arg}
        joined = [group for group in groups if group & here]
        groups = [group for group in groups if not group & here]
        if here:
            groups.append(here.union(*joined))
    return [tuple(sorted(group, key=lambda d: sorted(d.terms))) for group in groups]


def _by_cases(value: Value, groups: Sequence[tuple[Value, ...]], *, inside: bool) -> bool:
    """Return whether a value is zero, each group of choices looked at by itself."""
    left = value
    for group in groups:
        here = _chosen_by(value, group)
        first: Value | None = None
        if group not in value.field.cases:
            value.field.cases[group] = list(cases(group))
        for sides in value.field.cases[group]:
            if inside and 0 in sides.values():
                continue
            part = value.field.at(here, sides)
            if first is None:
                first, left = part, left - here + part
            elif not is_zero(_at_edges(part - first, sides)):
                return False
        if first is None:
            return False
    return is_zero(left)


def _chosen_by(value: Value, group: Sequence[Value]) -> Value:
    """Return the terms in which differences of a group choose."""
    gens = value.field.gens
    terms = {
        mono: c
        for mono, c in value.terms.items()
        if any(gens[g].kind == "sign" and gens[g].arg in group for g, _ in mono)
    }
    return Value(value.field, terms)


def cases(group: Sequence[Value]) -> Iterator[dict[Value, int]]:
    """Yield the signs that differences may have together, those inside branches first."""
    if 3 ** len(group) > MOST_CASES:
        raise NotShownError("too many branches meet in one row")
    never = {
        (m, s, n, t)
        for (m, first), (n, second) in combinations(enumerate(group), 2)
        for s, t in product((1, 0, -1), repeat=2)
        if _contradict(first, s, second, t)
    }
    for sides in product((1, -1, 0), repeat=len(group)):
        pairs = combinations(enumerate(sides), 2)
        known = all(_possible(d, side) for d, side in zip(group, sides, strict=True))
        if known and not any((m, s, n, t) in never for (m, s), (n, t) in pairs):
            yield dict(zip(group, sides, strict=True))


def _possible(d: Value, side: int) -> bool:
    """Return whether the domain leaves a sign to a difference."""
    above, below = d.field.sign(d), d.field.sign(-d)
    return above <= (2 if side > 0 else 1 if side == 0 else 0) and below <= (
        2 if side < 0 else 1 if side == 0 else 0
    )


def _contradict(first: Value, s: int, second: Value, t: int) -> bool:
    """Return whether two differences cannot have these signs: a sum of theirs has another one."""
    field, number = first.field, first.field.number
    for scale, turns in product(_scales(first, second), product((1, -1), repeat=2)):
        signs = turns[0] * s, turns[1] * t
        if max(signs) <= 0:
            total = first * scale * number(turns[0]) + second * number(turns[1])
            if field.sign(total) > (0 if min(signs) < 0 else 1):
                return True
    return False


def _scales(first: Value, second: Value) -> Iterator[Value]:
    """Yield positive factors that make a term of one value like a term of the other."""
    field, found = first.field, set[Value]()
    for m, n in product(first.terms, second.terms):
        below = Value(field, {tuple((g, -e) for g, e in m): 1})
        scale = below * Value(field, {n: 1})
        if scale not in found and field.sign(scale) == 2:
            found.add(scale)
            yield scale


def _at_edges(value: Value, sides: Sides) -> Value:
    """Return a value where the differences of sign 0 are zero, one of their names put in."""
    edges = [d for d, side in sides.items() if side == 0]
    while edges:
        d = edges.pop(0)
        new = _solved(d)
        value = put(value, new)
        edges = [put(other, new) for other in edges]
    return value


def _solved(d: Value) -> dict[int, Value]:
    """Return what a name is where d = 0, if d is linear in one by a factor that is not zero."""
    field = d.field
    for g in sorted(d.generators(), key=lambda g: not field.gens[g].lanes):
        gen = field.gens[g]
        if gen.kind != "name" or (d.lanes and not gen.lanes):
            continue
        own = {mono: c for mono, c in d.terms.items() if g in dict(mono)}
        (mono, c), *more = own.items()
        factor = Value(field, {tuple(p for p in mono if p[0] != g): c})
        rest = d - Value(field, own)
        linear = not more and dict(mono)[g] == 1 and g not in factor.names | rest.names
        if linear and max(field.sign(factor), field.sign(-factor)) == 2:
            path, field.path = field.path, None
            found = -(rest * field.power(factor, Fraction(-1)))
            field.path = path
            return {g: found}
    return {}
