"""A resistor's law turned round, into the other causality.

Input: a `DissipativePort`, whose law is a function of one letter.  Output: the same resistor with
``current = "v/R"`` for ``voltage = "R*i"``, if its law is linear in the letter.
"""

from collections.abc import Collection
from dataclasses import replace

import sympy as sp

from piezo_sym.algebra.symbols import to_sympy
from piezo_sym.expressions.calculus import derivative, div, mul
from piezo_sym.expressions.tree import ONE, ZERO, Call, Cmp, Div, Expr, Sym, names, walk
from piezo_sym.expressions.tree import replace as substitute
from piezo_sym.spec.elements.ports import DissipativePort
from piezo_sym.spec.names import fresh


def turn(port: DissipativePort, taken: Collection[str]) -> DissipativePort | None:
    """Return the resistor in its other causality if its law is linear in its letter, else None.

    `taken` are the names in use, which its new letter avoids.
    """
    slope = slope_of(port.law, port.letter)
    if port.rate or slope is None or vanishes(slope):
        return None
    letter = fresh(port.domain.variable(port.imposes).letter, taken)
    return replace(
        port,
        letter=letter,
        law=_over(Sym(letter), slope),
        output=port.effort,
        effort=port.output,
        imposes=port.imposes.other,
        written=port.written or port.law,
    )


def slope_of(law: Expr, letter: str) -> Expr | None:
    """Return the slope of a law that is linear in its letter, else None."""
    slope, at_zero = constant_slope(law, letter), substitute(law, {letter: ZERO})
    return slope if slope is not None and vanishes(at_zero) else None


def constant_slope(law: Expr, letter: str) -> Expr | None:
    """Return the slope of a law that is affine in a letter, else None."""
    if any(letter in names(node) for node in walk(law) if isinstance(node, Call | Cmp)):
        return None  # in a function or a condition: the slope would not show a jump
    slope = derivative(law, letter)
    return None if letter in names(slope) else slope


def _over(top: Expr, slope: Expr) -> Expr:
    match slope:
        case Div(left, right) if left == ONE:
            return mul(right, top)
    return div(top, slope)


def vanishes(law: Expr) -> bool:
    """Return whether a law is zero by its form, without expanding it."""
    table = {name: sp.Symbol(name, real=True) for name in names(law)}
    return bool(to_sympy(law, table) == 0)
