"""Roots of products, which SymPy takes apart: what their factors need says nothing of a law.

Input: a `Proved`.  Output: whether a law has a root of a product of which a factor may be zero.
sqrt(r*(p - a)) is 0 where r is, whatever p - a is.  For r >= 0 SymPy makes it sqrt(r)*sqrt(p - a),
which has no value for p < a: that a law needs p - a >= 0 then excuses no printed text.  (Outside
the domain it knows no signs, and takes no root apart.)
"""

from collections.abc import Iterator

from piezo_sym.expressions.tree import Call, Cmp, Div, Expr, Mul, Neg, Num, Pow, Sym, walk
from piezo_sym.spec.elements.ports import Body
from piezo_sym.spec.tables import conditions, laws
from piezo_sym.translation.known import Proved
from piezo_sym.translation.signs import sign


def has_split_roots(known: Proved) -> bool:
    """Return whether a radicand has two factors that are not known to be positive."""
    model = known.iphs.model.flatten()
    trees = [law.tree for law in laws(model)] + [c.tree for c in conditions(model)]
    positive = {name for name, value in known.names.items() if sign(value) == 2}
    positive |= {"T", *(body.temperature for _, body in known.iphs.circuit.of(Body))}
    return any(
        sum(not _is_positive(factor, positive) for factor in _factors(radicand)) > 1
        for tree in trees
        for radicand in _radicands(tree)
    )


def _radicands(tree: Expr | Cmp) -> Iterator[Expr]:
    for part in walk(tree):
        match part:
            case Call("sqrt", (arg,)):
                yield arg
            case Pow(base, e) if e.denominator != 1:
                yield base


def _factors(tree: Expr) -> Iterator[Expr]:
    match tree:
        case Mul(left, right) | Div(left, right):
            yield from _factors(left)
            yield from _factors(right)
        case Neg(arg) | Pow(arg, _):
            yield from _factors(arg)
        case _:
            yield tree


def _is_positive(factor: Expr, names: set[str]) -> bool:
    match factor:
        case Num(value):
            return value > 0
        case Sym(name):
            return name in names
        case Call(function):
            return function in {"exp", "cosh"}
    return False
