"""Whether a value is zero for all values of its names, on every branch and every lane.

Input: a `Value`.  Output: whether it is shown to be zero.  A value with signs is examined for each
combination of signs that is possible; where a difference is zero, a generator is eliminated by it.
Denominators are multiplied out.  A sum over lanes is zero if its terms are.
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import product

from piezo_sym.translation.change import put
from piezo_sym.translation.field import NotShownError, Value
from piezo_sym.translation.functions import by_cosh
from piezo_sym.translation.numerator import divisors, inverse, renamed, vanishes, vanishes_with
from piezo_sym.translation.possible import impossible
from piezo_sym.translation.signs import has_sign, sides_of, sign

MOST_CASES = 500
Case = tuple[Value, dict[Value, int]]
Edges = frozenset[Value]


def is_zero(value: Value, *, edges: Edges = frozenset()) -> bool:
    """Return whether a value is shown to be zero, except where a difference in `edges` is zero."""
    if (value, edges) in value.field.zeros:
        return True
    letters = [g for g in value.parts if value.field.gens[g].kind == "letter"]
    try:
        if _is_zero(value, edges=edges):
            value.field.zeros.add((value, edges))
            return True
    except NotShownError:
        if not letters:
            raise
    spelled = (_spelled(value, letter) for letter in sorted(letters, reverse=True))
    new = next((new for new in spelled if new != value), None)  # None: all lie in sums over lanes
    new = _by_cosh(value) if new is None else new
    return new != value and is_zero(new, edges=edges)


def _by_cosh(value: Value) -> Value:
    """Return a value with logarithms of 1 + exp(2*z) replaced by those of cosh(z)."""
    logs = ((g, value.field.gens[g]) for g in value.parts)
    found = ((g, by_cosh(gen.arg)) for g, gen in logs if gen.kind == "log" and gen.arg)
    return put(value, {g: new for g, new in found if new is not None})


def edges_of(value: Value) -> Edges:
    """Return the differences with states whose signs occur in a value: it may have kinks there."""
    field = value.field
    found = (field.gens[g].arg for g in value.parts if field.gens[g].kind == "sign")
    return frozenset(d for d in found if d is not None and d.parts & field.states)


def _spelled(value: Value, letter: int) -> Value:
    """Return a value without a letter: renamed if it can be, else written out."""
    new, arg = renamed(value, letter), value.field.gens[letter].arg
    assert arg is not None
    return put(value, {letter: arg}) if new is None else new


def _is_zero(value: Value, *, edges: Edges) -> bool:
    parts = _apart(value)  # parts need not be zero, though their sum is
    if len(parts) > 1 and all(is_zero(part, edges=edges) for part in parts):
        return True
    groups = _groups(value)
    if not groups:
        return vanishes(value)
    if _by_cases(value, groups, edges=edges):
        return True
    together = [tuple(d for group in groups for d in group)]
    return len(groups) > 1 and _by_cases(value, together, edges=edges)


def _apart(value: Value) -> list[Value]:
    """Return the terms of a value without sums over lanes, then the terms inside each such sum.

    Sums over one bank whose factors in its lane are equal are joined, and these factors left out.
    """
    field, gens, rest = value.field, value.field.gens, []
    sums: dict[tuple[str, Value], list[Value]] = {}
    for mono, c in value.terms.items():
        found = next((n for n, (g, e) in enumerate(mono) if gens[g].kind == "sum" and e == 1), None)
        if found is None:
            rest.append(Value(field, {mono: c}))
            continue
        gen = gens[mono[found][0]]
        other = mono[:found] + mono[found + 1 :]
        own = tuple(p for p in other if (gen.mark, 0) in gens[p[0]].lanes)
        free = Value(field, {tuple(p for p in other if p not in own): c})
        assert gen.arg is not None
        sums.setdefault((str(gen.mark), Value(field, {own: 1})), []).append(free * gen.arg)
    if not sums:
        return [value]
    return [field.total(rest), *map(field.total, sums.values())]


def _groups(value: Value) -> list[tuple[Value, ...]]:
    """Return the differences whose signs occur, grouped by products that share them."""
    field, groups = value.field, list[set[Value]]()
    for mono in value.terms:
        gens = (field.gens[g] for g, _ in mono)
        here = {gen.arg for gen in gens if gen.kind == "sign" and gen.arg}
        joined = [group for group in groups if group & here]
        groups = [group for group in groups if not group & here]
        if here:
            groups.append(here.union(*joined))
    return [tuple(sorted(group, key=lambda d: sorted(d.terms))) for group in groups]


def _by_cases(value: Value, groups: Sequence[tuple[Value, ...]], *, edges: Edges) -> bool:
    """Return whether a value is zero, deciding the signs of one group at a time."""
    left = value
    for group in groups:
        here = _chosen_by(value, group)
        base = _common(list(_cases(here, {}, [MOST_CASES], edges=edges)))
        if base is None:
            return False
        left = left - here + base
    return is_zero(left)


def _common(cases: list[Case]) -> Value | None:
    """Return the value that all possible cases share, or None if that is not shown."""
    while cases:
        (base, sides), *rest = cases
        wrong = [case for case in rest if _differs(base, case)]
        if wrong and 0 not in sides.values() and vanishes(base):  # 0/0 on an edge of its own only
            base = base.field.zero
            wrong = [case for case in rest if _differs(base, case)]
        if all(impossible(case[1]) for case in wrong):
            return base
        if not impossible(sides):
            return None
        cases = rest
    return None


def _cases(
    value: Value, sides: dict[Value, int], left: list[int], *, edges: Edges
) -> Iterator[Case]:
    """Yield a value and the signs in each case without two contradictory signs."""
    field = value.field
    found = Counter(
        gen.arg for mono in value.terms for g, _ in mono if (gen := field.gens[g]).kind == "sign"
    )
    if not found:
        left[0] -= 1
        if left[0] < 0:
            raise NotShownError("too many branches meet in one row")
        yield value, sides
        return
    d = max(found, key=lambda d: found[d])
    assert d is not None
    for side in (1, -1) if d in edges else (1, -1, 0):
        if side in sides_of(d) and not any(_never(d, side, e, s) for e, s in sides.items()):
            here = {**sides, d: side}
            yield from _cases(field.at(value, {d: side}), here, left, edges=edges)


def _never(first: Value, s: int, second: Value, t: int) -> bool:
    """Return whether two differences cannot have these signs; the result is kept."""
    field, key = first.field, (first, s, second, t)
    if key not in field.never:
        field.never[key] = _contradict(*key)
    return field.never[key]


def _chosen_by(value: Value, group: Sequence[Value]) -> Value:
    """Return the terms that have signs of a group of differences."""
    gens = value.field.gens
    terms = {
        mono: c
        for mono, c in value.terms.items()
        if any(gens[g].kind == "sign" and gens[g].arg in group for g, _ in mono)
    }
    return Value(value.field, terms)


def _contradict(first: Value, s: int, second: Value, t: int) -> bool:
    """Return whether two differences cannot have these signs, as their sum has another one."""
    number = first.field.number
    for scale, turns in product(_scales(first, second), product((1, -1), repeat=2)):
        signs = turns[0] * s, turns[1] * t
        if max(signs) <= 0:
            total = first * scale * number(turns[0]) + second * number(turns[1])
            if sign(total) > (0 if min(signs) < 0 else 1):
                return True
    return False


def _scales(first: Value, second: Value) -> Iterator[Value]:
    """Yield positive factors that make a term of one value like a term of the other."""
    field, found = first.field, set[Value]()
    for m, n in product(first.terms, second.terms):
        below = Value(field, {tuple((g, -e) for g, e in m): 1})
        scale = below * Value(field, {n: 1})
        if scale not in found and sign(scale) == 2:
            found.add(scale)
            yield scale


def _differs(base: Value, case: Case) -> bool:
    """Return whether a case is possible and not shown to have the value `base`."""
    value, edges = case[0] - base, {d: side for d, side in case[1].items() if side == 0}
    others = {d: side for d, side in case[1].items() if side}
    while edges:
        d, _ = edges.popitem()
        if vanishes_with(value, d):
            return False
        new = _solved(d)
        if any(vanishes(put(divisor, new)) for divisor in divisors(value)):
            return True  # 0/0 on the edge
        value = put(value, new)
        edges = {put(other, new): 0 for other in edges}
        others = {put(other, new): side for other, side in others.items()}
        if any(side not in sides_of(other) for other, side in (*edges.items(), *others.items())):
            return False
    return not is_zero(value)


def _solved(d: Value) -> dict[int, Value]:
    """Return what a generator is where d = 0, if d is linear in it by a factor that is not zero."""
    field = d.field
    for g in sorted(
        d.generators(), key=lambda g: (field.gens[g].kind != "name", not field.gens[g].lanes)
    ):
        gen = field.gens[g]
        own = {mono: c for mono, c in d.terms.items() if g in dict(mono)}
        powers = {dict(mono)[g] for mono in own}
        if len(powers) > 1 or gen.kind == "sum" or (d.lanes and not gen.lanes):
            continue
        rest = d - Value(field, own)
        factor = Value(field, {tuple(p for p in m if p[0] != g): c for m, c in own.items()})
        if g in factor.parts | rest.parts or (powers != {1} and (rest.terms or min(powers) < 0)):
            continue
        if has_sign(factor):
            return {g: -(rest * inverse(factor))}
    return {}
