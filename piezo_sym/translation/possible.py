"""Whether differences can have some signs together: a query to a solver.

Input: the signs.  Output: whether a solver shows that they contradict each other or the domain.  To
the solver, generators are real numbers with the signs that are known.
"""

from collections.abc import Iterator, Mapping
from fractions import Fraction

from piezo_sym.expressions.calculus import add, mul, power
from piezo_sym.expressions.functions import RECORDS, LawFunction
from piezo_sym.expressions.tree import ONE, ZERO, Cmp, Expr, Num, Sym
from piezo_sym.proofs.query import query
from piezo_sym.proofs.rational import Clause
from piezo_sym.proofs.solvers import solver
from piezo_sym.translation.field import Exponent, GeneratorField, Value
from piezo_sym.translation.signs import sign, sign_of

MOST_ASKED = 60
MOST_UNKNOWN = 3
#: Seconds to wait for an answer.
PATIENCE = 3.0
MOST_TERMS = 60
_OPS = {1: ">", 0: "=", -1: "<"}


def impossible(sides: Mapping[Value, int]) -> bool:
    """Return whether differences are shown to have these signs nowhere in the domain."""
    key = frozenset(sides.items())
    field = next(iter(sides)).field
    if key not in field.asked and len(field.asked) < MOST_ASKED and field.unknown < MOST_UNKNOWN:
        field.asked[key] = _impossible(sides)
    return field.asked.get(key, False)


def _impossible(sides: Mapping[Value, int]) -> bool:
    field = next(iter(sides)).field
    known = {value: sign for value, sign in field.assumed.items() if value.constant is None}
    values = [*sides, *(v for v in known if len(v.terms) <= MOST_TERMS)]
    if any(len(value.terms) > MOST_TERMS for value in sides):
        return False
    given = [Cmp(_OPS[side], _tree(value), ZERO) for value, side in sides.items()]
    given += [Cmp(">" if known[v] == 2 else ">=", _tree(v), ZERO) for v in values[len(sides) :]]
    signed = {p for value in values for mono in value.terms for p in mono}
    inner = (field.gens[g].arg for g, _ in tuple(signed))
    signed |= {p for arg in inner if arg for mono in arg.terms for p in mono}
    clauses: list[Clause] = [(part,) for part in given]
    clauses += [c for p in sorted(signed) for c in _of_generator(field, p)]
    asked = query("", (), clauses, Cmp("<", ZERO, ZERO))
    result = solver("z3", PATIENCE).ask(asked).result
    field.unknown += result == "unknown"
    return result == "unsat"


def _of_generator(field: GeneratorField, part: tuple[int, Exponent]) -> Iterator[Clause]:
    """Yield facts on a power of a generator: its sign, a root's square, bounds of functions.

    The root of a factor may stand where that of the product is meant, which is 0 where another
    factor is: only the magnitude of such a factor is known to be the square of its root.
    """
    known, gen, symbol = sign_of(field, part[0]), field.gens[part[0]], _symbol(part)
    if known:
        yield (Cmp(">" if known == 2 else ">=", symbol, ZERO),)
    if gen.arg is None or len(gen.arg.terms) > MOST_TERMS:
        return
    arg = _tree(gen.arg)
    if gen.kind == "power" and part[1] == Fraction(1, 2):
        yield (Cmp(">=", symbol, ZERO),)
        sides = (arg,) if sign(gen.arg) else (arg, _tree(-gen.arg))
        yield tuple(Cmp("=", power(symbol, Fraction(2)), side) for side in sides)
    if gen.kind in RECORDS and part[1] == 1:
        yield from ((fact,) for fact in _of_function(RECORDS[gen.kind], arg, symbol))


def _of_function(record: LawFunction, arg: Expr, value: Expr) -> Iterator[Cmp]:
    """Yield the bounds of a function; if it is monotone, on which side of a known value it is."""
    low, high = record.bounds
    if isinstance(low, Fraction) and isinstance(high, Fraction):
        yield from (Cmp("<=", value, Num(high)), Cmp(">=", value, Num(low)))
    if record.monotone and record.known:
        at, there = (Num(Fraction(-number)) for number in record.known)
        yield Cmp(">=", mul(add(value, there), add(arg, at)), ZERO)


def _symbol(part: tuple[int, Exponent]) -> Expr:
    """Return a positive integer power of a generator; any other power is a symbol of its own."""
    g, e = part
    if Fraction(e).denominator == 1 and e > 0:
        return power(Sym(f"g{g}"), Fraction(e))
    return Sym(f"g{g}_{Fraction(e).numerator}_{Fraction(e).denominator}".replace("-", "m"))


def _tree(value: Value) -> Expr:
    terms = []
    for mono, c in value.terms.items():
        term: Expr = ONE
        for part in mono:
            term = mul(term, _symbol(part))
        terms.append(mul(Num(Fraction(c)), term))
    return add(*terms)
