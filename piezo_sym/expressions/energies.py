"""Energies of storage elements from their co-state laws, and co-states from energies.

Input: a tree and a name.  Output: a tree, or None where an integral has no simple form.  With F_1
and F_2 the antiderivatives of two branches that meet at the edge e, that of both is F_1 on one side
and F_2 + F_1(e) - F_2(e) on the other, which is continuous.
"""

from collections.abc import Callable, Collection
from contextlib import suppress
from functools import reduce
from itertools import islice
from math import prod

from piezo_sym.expressions.calculus import add, compared, derivative, div, inserted, mul, neg
from piezo_sym.expressions.exact_eval import OUTCOMES
from piezo_sym.expressions.integrals import MAX_PARTS, NoFormError, by_rules, divided, slope_of
from piezo_sym.expressions.reflection import reflected
from piezo_sym.expressions.tree import (
    ONE,
    ZERO,
    Add,
    Call,
    Cmp,
    Div,
    Expr,
    If,
    Mul,
    Neg,
    Node,
    Num,
    Pow,
    Sym,
    children,
    decided,
    first_choice,
    names,
    rebuild,
    walk,
)

#: Of higher powers no factors are taken apart.
MOST_FACTORS = 8
#: Of more pieces, or pieces of more than MAX_PARTS, no energy is written: it is asked for.
MOST_PIECES = 128
Otherwise = Callable[[Expr, str], Expr | None]


def antiderivative(
    node: Expr,
    name: str,
    otherwise: Otherwise = lambda *_: None,
    positive: Collection[str] = (),
) -> Expr | None:
    """Return an antiderivative of `node` by `name`, or None where there is none of a simple form.

    Known forms are those of `integrals`, and choices between such where comparisons are affine.

    Parameters
    ----------
    otherwise : is asked for those of smooth branches of other forms.
    positive : names that are; they decide how some edges are ordered.
    """
    with suppress(NoFormError):
        return by_rules(node, name)
    if isinstance(node, Add):
        parts = [antiderivative(term, name, positive=positive) for term in node.terms]
        known = [part for part in parts if part is not None]
        if len(known) == len(parts):
            return add(*known)
    plain = compared(node)
    condition = first_choice(plain)
    if condition is None:
        return otherwise(node, name)
    return _by_branches(plain, condition, name, otherwise, positive)


def of_odd(
    node: Expr, name: str, otherwise: Otherwise, positive: Collection[str] = ()
) -> Expr | None:
    """Return an antiderivative of what is odd in `name`, and of whose parts none jumps; or None.

    It is a function of the magnitude, if the law is smooth on each side of zero.

    Parameters
    ----------
    otherwise : is asked for that of other forms, where `name` is positive.
    """
    try:
        odd = reflected(node, name) == neg(inserted(node, {}))
    except ZeroDivisionError:
        return None
    above, plain = {*positive, name}, compared(node)
    side = _settled(plain, above)
    jumps = any(isinstance(part, Call) and part.function == "sign" for part in walk(node))
    if not odd or jumps or side == plain or first_choice(side) is not None:
        return None
    found = antiderivative(side, name, otherwise, above)
    return found and inserted(found, {name: Call("abs", (Sym(name),))})


def slope(energy: Expr, name: str) -> Expr:
    """Return the derivative of an energy by `name`; each term with kinks is a choice of slopes."""
    if name not in names(energy):
        return ZERO
    if isinstance(energy, Add):
        return add(*(slope(term, name) for term in energy.terms))
    plain = compared(energy)
    condition = first_choice(plain)
    if condition is None:
        return derivative(plain, name)
    then, other = (slope(decided(plain, {condition: h}), name) for h in (True, False))
    return then if then == other else If(then, condition, other)


def _by_branches(
    node: Expr, condition: Cmp, name: str, otherwise: Otherwise, positive: Collection[str]
) -> Expr | None:
    """Return the antiderivative of a choice from those of what it chooses between."""
    if sum(1 for _ in walk(node)) > MAX_PARTS or _pieces(node) > MOST_PIECES:
        return None
    parts = (decided(node, {condition: holds}) for holds in (True, False))
    then, other = (antiderivative(part, name, otherwise, positive) for part in parts)
    if then is None or other is None or _is_long(then) or _is_long(other):
        return None
    if name not in names(condition):
        return If(then, condition, other)
    difference = add(condition.left, neg(condition.right))
    slope = slope_of(difference, name)
    if slope is None:
        return None
    edge = {name: divided(neg(inserted(difference, {name: ZERO})), slope)}
    shift = add(*(_settled(inserted(part, edge), positive) for part in (then, neg(other))))
    return If(then, condition, add(other, shift))


def _pieces(node: Node) -> int:
    """Return how many branches the choices of a tree make together, at most."""
    if isinstance(node, If):
        return _pieces(node.condition) * (_pieces(node.then) + _pieces(node.other))
    return prod(map(_pieces, children(node)))


def _is_long(node: Node) -> bool:
    return next(islice(walk(node), MAX_PARTS, None), None) is not None


def _settled(node: Expr, positive: Collection[str]) -> Expr:
    """Return a tree without choices by comparisons that are decided whatever its names are."""
    inner = rebuild(node, lambda part: _settled(part, positive))
    match inner:
        case If(then, Cmp(op, left, right), other):
            sign = _sign(add(left, neg(right)), positive)
            if sign is not None:
                return then if OUTCOMES[op](sign) else other
        case Pow(Neg(arg), exponent) if exponent % 2 == 0:
            return Pow(arg, exponent)
    return inner


def _sign(node: Expr, positive: Collection[str]) -> int | None:
    """Return the sign of a tree, if it is the same for all values of its names."""
    match node:
        case Num(value):
            return (value > 0) - (value < 0)
        case Sym(name):
            return 1 if name in positive else None
        case Neg(arg):
            inner = _sign(arg, positive)
            return None if inner is None else -inner
        case Mul(left, right) | Div(left, right):
            one, two = _sign(left, positive), _sign(right, positive)
            return None if one is None or two is None else one * two
        case Add(terms):
            signs = {_sign(term, positive) for term in terms}
            return signs.pop() if len(signs) == 1 else None
    return None


def without_common_factors(node: Expr, name: str) -> Expr:
    """Return a product or quotient without factors of `name` above and below: sinh(x)/x*x.

    These are polynomials, which have a value everywhere: of log(x)/log(x) nothing is left out.
    """
    above, below = _factors(node)
    one: Expr = ONE
    both = [f for f in above if f in below and name in names(f) and _is_polynomial(f)]
    if not both:
        return node
    for factor in both:
        if factor in below:
            above.remove(factor)
            below.remove(factor)
    top, bottom = (reduce(mul, factors, one) for factors in (above, below))
    return div(top, bottom)


def _is_polynomial(node: Node) -> bool:
    if isinstance(node, Pow) and (node.exponent < 0 or node.exponent.denominator != 1):
        return False
    known = isinstance(node, Num | Sym | Neg | Add | Mul | Pow)
    return known and all(map(_is_polynomial, children(node)))


def _factors(node: Expr) -> tuple[list[Expr], list[Expr]]:
    """Return the factors above and below the line, whole powers a factor at a time."""
    match node:
        case Mul(left, right) | Div(left, right):
            (above, below), other = _factors(left), _factors(right)
            more, less = other if isinstance(node, Mul) else other[::-1]
            return [*above, *more], [*below, *less]
        case Pow(base, exponent) if exponent.denominator == 1 and 0 < exponent <= MOST_FACTORS:
            above, below = _factors(base)
            return above * exponent.numerator, below * exponent.numerator
    return [node], []
