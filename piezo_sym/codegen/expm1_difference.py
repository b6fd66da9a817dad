"""Temperature differences without cancellation: T - T_0 as T_0*expm1(S/c_0).

Input: a law that subtracts a constant from a temperature.  Output: the law with that difference as
a quantity of its own, where the temperature is this constant times an exponential.  Near T_0 the
plain difference would lose as many digits as T and T_0 share.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from piezo_sym.expressions.calculus import add, mul
from piezo_sym.expressions.tree import Add, Call, Expr, Mul, Neg, Sym, rebuild

Define = Callable[[str, Sym, Expr], Sym]


def with_excess(law: Expr, bodies: Mapping[str, Expr], define: Define) -> Expr:
    """Return `law` with differences such as ``T - T_0`` replaced by quantities.

    Parameters
    ----------
    law : any expression.
    bodies : each temperature's name, and its law in its state.
    define : makes the difference of a temperature and a constant a quantity.
    """
    inner = rebuild(law, lambda part: with_excess(part, bodies, define))
    if not isinstance(inner, Add):
        return inner
    for name, temperature in bodies.items():
        match temperature:
            case Mul(Sym() as factor, Call("exp", args)):
                found = _difference(inner, Sym(name), factor)
                if found is not None:
                    sign, rest = found
                    value = mul(factor, Call("expm1", args))
                    excess: Expr = define(name, factor, value)
                    return add(excess if sign > 0 else Neg(excess), *rest)
    return inner


def _difference(total: Add, hot: Sym, cold: Sym) -> tuple[int, list[Expr]] | None:
    """Return the sign of ``hot - cold`` in a sum and its other terms, if it is there."""
    for sign, first, second in ((1, hot, Neg(cold)), (-1, Neg(hot), cold)):
        if first in total.terms and second in total.terms:
            rest = list(total.terms)
            rest.remove(first)
            rest.remove(second)
            return sign, rest
    return None
