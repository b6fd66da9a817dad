"""Values with names replaced, moved to another lane, and differentiated.

Input: values.  Output: values of the same field.  A derivative in a state of one lane of a bank has
two parts: `derivative` is that of the lane's own terms, `across` that of sums over the bank, equal
in all lanes.  The derivative of a sign is 0: derivatives hold inside the branches of a law.
"""

import ast
from collections.abc import Callable, Mapping
from fractions import Fraction

from piezo_sym.expressions.functions import RECORDS
from piezo_sym.translation.expressions import PLAIN, Expressions, Read
from piezo_sym.translation.field import Exponent, Generator, GeneratorField, NotShownError, Value
from piezo_sym.translation.functions import call, power
from piezo_sym.translation.signs import compare, on_path, sign_of

#: The functions that the derivatives in function records may call.
_CALLS = {name: name for name, record in RECORDS.items() if record.smooth}


def put(value: Value, new: Mapping[int, Value]) -> Value:
    """Return a value with generators replaced, except in sums over the lanes they belong to."""
    field = value.field
    if value.parts.isdisjoint(new):
        return value
    parts, powers = [], dict[tuple[int, Exponent], Value]()
    with on_path(field, None):
        for mono, c in value.terms.items():
            kept = tuple(p for p in mono if field.gens[p[0]].parts.isdisjoint(new))
            term = Value(field, {kept: c})
            for g, e in (p for p in mono if p not in kept):
                if (g, e) not in powers:
                    powers[g, e] = power(_put(field, g, new), Fraction(e))
                term = term * powers[g, e]
            parts.append(term)
        return field.total(parts)


def _put(field: GeneratorField, g: int, new: Mapping[int, Value]) -> Value:
    gen = field.gens[g]
    if g in new or gen.arg is None:
        return new[g]
    if gen.kind == "sum":
        bank = str(gen.mark)
        new = {n: v for n, v in new.items() if (bank, 0) not in field.gens[n].lanes}
        if any((bank, 0) in v.lanes for v in new.values()):
            raise NotShownError("a lane's name comes into a sum over lanes")
        return field.lane_sum(put(gen.arg, new), bank)
    arg = put(gen.arg, new)
    if gen.kind in {"power", "letter"}:
        return arg if gen.kind == "power" else field.letter(arg)
    if gen.kind == "sign":
        op = {1: ">", 0: "==", -1: "<"}[int(str(gen.mark))]
        return compare(op, arg, field.zero)
    return call(gen.kind, arg)


def spelled(value: Value) -> Value:
    """Return a value with letters written out, except in sums over the lanes they belong to."""
    gens = value.field.gens
    new = {g: arg for g in value.parts if gens[g].kind == "letter" and (arg := gens[g].arg)}
    written = put(value, new)
    return written if written == value else spelled(written)


def in_exponentials(value: Value) -> Value:
    """Return a value with hyperbolic functions written as exponentials."""
    field, new, value = value.field, dict[int, Value](), spelled(value)
    half, minus = field.number(Fraction(1, 2)), field.number(-1)
    for g in value.parts:
        gen = field.gens[g]
        if gen.kind in {"sinh", "cosh", "tanh"} and gen.arg is not None:
            up, down = (call("exp", in_exponentials(arg)) for arg in (gen.arg, gen.arg * minus))
            odd, even = (up - down) * half, (up + down) * half
            new[g] = {"sinh": odd, "cosh": even, "tanh": odd * power(even, -1)}[gen.kind]
    return put(value, new)


def moved(value: Value, bank: str, lane: int) -> Value:
    """Return a value with names of one lane of a bank (0: row, 1: column) moved to the other."""
    field, new = value.field, {}
    for g in value.parts:
        mark = field.gens[g].mark
        if isinstance(mark, tuple) and mark[1:] == (bank, 1 - lane):
            new[g] = field.name(mark[0], bank, lane, sign_of(field, g))
    return put(value, new)


Inner = Callable[[Generator], Value]


def derivative(value: Value, state: int) -> Value:
    """Return the derivative with respect to a name, except of sums over the name's own bank."""
    field = value.field
    bank = next(iter(field.gens[state].lanes), ("", 0))[0]

    def of_sum(gen: Generator) -> Value:
        if gen.mark == bank or gen.arg is None:
            return field.zero
        return field.lane_sum(derivative(gen.arg, state), str(gen.mark))

    return _chain(value, state, field.one, of_sum)


def across(value: Value, state: int, lane: int) -> Value:
    """Return the derivative of only the sums over a bank, with respect to a name of one lane."""
    field = value.field
    bank = next(iter(field.gens[state].lanes))[0]

    def of_sum(gen: Generator) -> Value:
        if gen.arg is None:
            return field.zero
        inside = across(gen.arg, state, lane)
        if gen.mark != bank:
            return field.lane_sum(inside, str(gen.mark))
        if inside.terms:
            raise NotShownError("terms of a sum over a bank depend on another sum over it")
        return moved(derivative(gen.arg, state), bank, lane)

    return _chain(value, state, field.zero, of_sum)


def _chain(value: Value, state: int, own: Value, of_sum: Inner) -> Value:
    """Return a derivative by the chain rule; `own` is that of the name itself, `of_sum` of sums."""
    field, parts = value.field, list[Value]()
    if state not in value.parts:
        return field.zero
    gens = {g: _slope(field, g, state, own, of_sum) for g in value.generators()}
    for mono, c in value.terms.items():
        for n, (g, e) in enumerate(mono):
            if gens[g].terms:
                left = ((g, e - 1),) if e != 1 else ()
                rest = (*mono[:n], *left, *mono[n + 1 :])
                parts.append(Value(field, {rest: c * e}) * gens[g])
    return field.total(parts)


def _slope(field: GeneratorField, g: int, state: int, own: Value, of_sum: Inner) -> Value:
    """Return the derivative of a generator with respect to a state."""
    gen, same = field.gens[g], field.raised(g, 1)
    if gen.arg is None:
        return own if g == state else field.zero
    if state not in gen.parts or gen.kind == "sign":
        return field.zero
    if gen.kind == "sum":
        return of_sum(gen)
    inner = _chain(gen.arg, state, own, of_sum)
    if gen.kind in {"power", "letter"} or not inner.terms:
        return inner
    return _of_rule(RECORDS[gen.kind].slopes[0], {"x": gen.arg, "y": same}) * inner


def _of_rule(rule: str, words: Mapping[str, Value]) -> Value:
    """Return the value of a derivative that a function record states as text."""

    def leaf(node: ast.expr) -> Read:
        return words[ast.unparse(node)], PLAIN

    read = Expressions(words["x"].field, {}, leaf, _CALLS, False)
    return read.numeric(ast.parse(rule, mode="eval").body)[0]
