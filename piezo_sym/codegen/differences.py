"""Exponentials less one without cancellation: ``I*(exp(z) - 1)`` as ``I*expm1(z)``.

Input: an expression.  Output: the same one, in which a sum that has a term with a factor exp(z),
and minus that term without it, has the term with expm1(z) = exp(z) - 1 in place of the two.  Near
z = 0 the plain difference would lose as many digits as exp(z) and 1 share.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from piezo_sym.codegen.program import Entry, Outer, Program, Quantity, Row
from piezo_sym.expressions.calculus import choices, div, mul, neg
from piezo_sym.expressions.tree import ONE, Add, Call, Div, Expr, Mul, Neg, knots, rebuild


def sharp_program(program: Program) -> Program:
    """Return a program in which no exponential cancels."""
    return replace(
        program,
        quantities=tuple(map(sharp_quantity, program.quantities)),
        functions=tuple(replace(f, rows=tuple(map(_row, f.rows))) for f in program.functions),
        jacobian=replace(program.jacobian, entries=tuple(map(_entry, program.jacobian.entries))),
        limits=tuple(replace(limit, margin=sharp(limit.margin)) for limit in program.limits),
    )


def sharp_quantity(quantity: Quantity) -> Quantity:
    """Return a quantity in which no exponential cancels."""
    return replace(quantity, value=sharp(quantity.value))


def _row(row: Row) -> Row:
    return replace(row, value=sharp(row.value), listed=tuple(map(sharp, row.listed)))


def _entry(entry: Entry) -> Entry:
    outer = tuple(Outer(sharp(o.left), sharp(o.right)) for o in entry.outer)
    return replace(entry, value=sharp(entry.value), outer=outer)


def sharp(node: Expr) -> Expr:
    """Return an expression in which no exponential cancels, tables written as their pieces."""
    inner = rebuild(choices(node) if knots(node) else node, sharp)
    if not isinstance(inner, Add):
        return inner
    kept = dict(enumerate(map(_plain, inner.terms)))
    shown = dict(enumerate(inner.terms))
    for n, term in enumerate(inner.terms):
        for rest, instead in _exponentials(term) if n in kept else ():
            less = neg(_plain(rest))
            lost = next((m for m, other in kept.items() if m != n and other == less), None)
            if lost is not None:
                kept[n] = shown[n] = instead
                del kept[lost], shown[lost]
                break
    return Add(tuple(shown.values())) if len(shown) > 1 else next(iter(shown.values()))


def _exponentials(term: Expr) -> Iterator[tuple[Expr, Expr]]:
    """Yield each factor exp(z) of a term as (the term without it, the term with expm1(z))."""
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


def _plain(term: Expr) -> Expr:
    """Return a term as `calculus` builds it."""
    match term:
        case Neg(arg):
            return neg(_plain(arg))
        case Mul(left, right):
            return mul(_plain(left), _plain(right))
        case Div(top, bottom):
            return div(_plain(top), _plain(bottom))
    return term
