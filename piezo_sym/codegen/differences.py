"""Differences written with ``expm1(z) = exp(z) - 1``, so that no digits cancel near z = 0.

Two forms would lose digits: T - T_0 where T = T_0*exp(S/c_0) (`with_excess`), and sums of
``I*exp(z)`` and ``-I``, as in the law of a diode (`sharp`).
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from fractions import Fraction

from piezo_sym.codegen.program import Entry, Outer, OutputRow, Program, Quantity
from piezo_sym.expressions.calculus import add, choices, div, mul, neg, rebuilt
from piezo_sym.expressions.tree import ONE, Add, Call, Div, Expr, Mul, Neg, Num, Sym, knots, rebuild


def with_excess(law: Expr, excesses: Mapping[tuple[Sym, Sym], Quantity]) -> Expr:
    """Return a law with differences such as ``T - T_0`` replaced by their names.

    `excesses` has the quantity that is the difference of a temperature and a constant.
    """
    inner = rebuild(law, lambda part: with_excess(part, excesses))
    if not isinstance(inner, Add):
        return inner
    bare = {term.arg if isinstance(term, Neg) else term for term in inner.terms}
    near = [pair for pair in excesses if bare.issuperset(pair)] if len(bare) > 1 else []
    for hot, cold in near:
        excess = Sym(excesses[hot, cold].name)
        for first, second, value in ((hot, neg(cold), excess), (neg(hot), cold, neg(excess))):
            if first in inner.terms and second in inner.terms:
                rest = list(inner.terms)
                rest.remove(first)
                rest.remove(second)
                return add(value, *rest)
    return inner


def sharp_program(program: Program) -> Program:
    """Return a program in which no exponential cancels."""
    return replace(
        program,
        quantities=tuple(map(sharp_quantity, program.quantities)),
        functions=tuple(replace(f, rows=tuple(map(_row, f.rows))) for f in program.functions),
        jacobian=tuple(map(_entry, program.jacobian)),
        limits=tuple(replace(limit, margin=sharp(limit.margin)) for limit in program.limits),
    )


def sharp_quantity(quantity: Quantity) -> Quantity:
    """Return a quantity in which no exponential cancels."""
    return replace(quantity, value=sharp(quantity.value))


def _row(row: OutputRow) -> OutputRow:
    value, *listed = (sharp(_finite(tree)) for tree in (row.value, *row.listed))
    return replace(row, value=value, listed=tuple(listed))


def _entry(entry: Entry) -> Entry:
    outer = tuple(Outer(sharp(o.left), sharp(o.right)) for o in entry.outer)
    return replace(entry, value=sharp(entry.value), outer=outer)


def sharp(node: Expr) -> Expr:
    """Return an expression in which no exponential cancels, with tables written as choices."""
    inner = rebuild(choices(node) if knots(node) else node, sharp)
    if not isinstance(inner, Add):
        return inner
    kept = dict(enumerate(map(_normal, inner.terms)))
    shown = dict(enumerate(inner.terms))
    for n, term in enumerate(inner.terms):
        for factor, instead in _exponentials(term) if n in kept else ():
            opposite = neg(_normal(factor))
            lost = next((m for m, other in kept.items() if m != n and other == opposite), None)
            if lost is not None:
                kept[n] = shown[n] = instead
                del kept[lost], shown[lost]
                break
    return Add(tuple(shown.values())) if len(shown) > 1 else next(iter(shown.values()))


def _finite(node: Expr) -> Expr:
    """Return an expression with log(cosh(z)), the energy of a tanh, as a + log((1 + exp(-2*a))/2).

    With a = abs(z) nothing overflows: cosh(z) does for abs(z) > 710.  Near 0 both forms are exact
    to the round-off of 1; a is max(z, -z), of which each branch equals log(cosh(z)) everywhere.
    """
    inner = rebuild(node, _finite)
    match inner:
        case Call("log", (Call("cosh", (z,)),)):
            size, half = Call("max", (z, neg(z))), Num(Fraction(1, 2))
            far = Call("exp", (mul(Num(Fraction(-2)), size),))
            return add(size, Call("log", (add(half, mul(half, far)),)))
    return inner


def _exponentials(term: Expr) -> Iterator[tuple[Expr, Expr]]:
    """Yield, for each factor exp(z) of a term, the term without it and the term with expm1(z)."""
    match term:
        case Call("exp", args):
            yield ONE, Call("expm1", args)
        case Neg(arg):
            yield from ((neg(rest), Neg(new)) for rest, new in _exponentials(arg))
        case Mul(left, right):
            yield from ((mul(rest, right), Mul(new, right)) for rest, new in _exponentials(left))
            yield from ((mul(left, rest), Mul(left, new)) for rest, new in _exponentials(right))
        case Div(top, bottom):
            yield from ((div(rest, bottom), Div(new, bottom)) for rest, new in _exponentials(top))


def _normal(term: Expr) -> Expr:
    """Return a term in the form of `calculus`, so that equal terms are equal trees."""
    return rebuilt(term, _normal) if isinstance(term, Neg | Mul | Div) else term
