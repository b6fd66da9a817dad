"""Dead zones as branches, with their factors and quotients inside the branch.

Input: an expression.  Output: the same with ``f*deadzone(z, w)`` as
``0 if abs(z) <= w else f*(z - copysign(w, z))``, for w >= 0.  Inside the zone nothing is divided,
and in a loop over lanes a compiler makes masks of such branches.  What is not a number stays so.
"""

from __future__ import annotations

from piezo_sym.expressions.calculus import add, div, mul, neg
from piezo_sym.expressions.tree import ZERO, Call, Cmp, Div, Expr, If, Mul, Neg, Num, Sym, rebuild


def with_branches(node: Expr) -> Expr:
    """Return an expression with dead zones of short arguments as branches."""
    inner = rebuild(node, with_branches)
    match inner:
        case Call("deadzone", (z, w)) if _short(z) and _short(w):
            beyond = add(z, neg(Call("copysign", (w, z))))
            return If(ZERO, Cmp("<=", Call("abs", (z,)), w), beyond)
        case Mul(left, If(then, condition, other)) if then == ZERO and _plain(left):
            return If(ZERO, condition, mul(left, other))
        case Mul(If(then, condition, other), right) if then == ZERO and _plain(right):
            return If(ZERO, condition, mul(other, right))
        case Div(If(then, condition, other), bottom) if then == ZERO and _plain(bottom):
            return If(ZERO, condition, div(other, bottom))
        case Neg(If(then, condition, other)) if then == ZERO:
            return If(ZERO, condition, neg(other))
    return inner


def _short(node: Expr) -> bool:
    return isinstance(node, Sym | Num) or (isinstance(node, Neg) and isinstance(node.arg, Sym))


def _plain(node: Expr) -> bool:
    """Return whether a factor holds no choice of its own."""
    return not isinstance(node, If)
