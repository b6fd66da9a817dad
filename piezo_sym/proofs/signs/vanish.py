"""Whether a law is exactly zero at a rational number, where intervals only say nearly.

Input: a tree in one name, a number.  Output: True if its value cancels, as SymPy adds it up:
``log(1 + exp(0)) - log(2)``.  Each part has to have a value, and none to jump.
"""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache

import sympy as sp

from piezo_sym.algebra.symbols import to_sympy
from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.tree import Call, Expr, If, Sym, children, rebuild

#: A function of larger numbers, or of others than rational ones, is only equal to itself.
LARGEST = 1000


def vanishes(tree: Expr, at: Fraction) -> bool:
    """Return whether a tree is sure to be zero at a number, and continuous there if defined."""
    return _value(tree, at) == 0


def rational_at(tree: Expr, at: Fraction) -> Fraction | None:
    """Return the value of a tree at a number if it is sure to be this rational."""
    value = _value(tree, at)
    return Fraction(int(value.p), int(value.q)) if isinstance(value, sp.Rational) else None


@lru_cache(maxsize=4096)
def _value(node: Expr, at: Fraction) -> sp.Expr | None:
    """Return an exact value; None where there may be a jump, or no finite value."""
    match node:
        case Sym():
            return sp.Rational(at.numerator, at.denominator)
        case If():
            return None
        case Call(function) if RECORDS[function].jumps:
            return None
    parts = {f"part_{n}": _value(part, at) for n, part in enumerate(children(node))}
    if None in parts.values():
        return None
    plain = all(isinstance(part, sp.Rational) and abs(part) < LARGEST for part in parts.values())
    if isinstance(node, Call) and not plain:
        return sp.Function(node.function)(*parts.values())
    words = iter(parts)
    value = sp.expand(to_sympy(rebuild(node, lambda _: Sym(next(words))), parts))
    return None if value.has(sp.zoo, sp.nan, sp.oo) else value
