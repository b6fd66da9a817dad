"""Structure coefficients as trees: exact rationals, and rational functions of transducer ratios.

Input: a SymPy expression from the junction laws.  Output: a tree with its terms in a fixed order,
so that printed text does not depend on SymPy's.
"""

from fractions import Fraction

import sympy as sp

from piezo_sym.expressions.calculus import add, div, mul, power
from piezo_sym.expressions.tree import ONE, Expr, Num, Sym


def coefficient(expr: sp.Expr) -> Expr:
    """Return a rational function of symbols as a tree, symbols and powers in a fixed order."""
    top, bottom = sp.fraction(sp.together(expr))
    symbols = sorted(expr.free_symbols, key=lambda symbol: str(symbol.name))
    return div(_polynomial(top, symbols), _polynomial(bottom, symbols))


def _polynomial(expr: sp.Expr, symbols: list[sp.Symbol]) -> Expr:
    if not symbols:
        return _number(expr)
    terms = sp.Poly(expr, *symbols).terms()
    return add(*(_monomial(powers, value, symbols) for powers, value in terms))


def _monomial(powers: tuple[int, ...], value: sp.Rational, symbols: list[sp.Symbol]) -> Expr:
    term: Expr = ONE
    for exponent, symbol in zip(powers, symbols, strict=True):
        if exponent:
            term = mul(term, power(Sym(symbol.name), Fraction(exponent)))
    return mul(_number(value), term)


def _number(value: sp.Expr) -> Num:
    return Num(Fraction(int(value.p), int(value.q)))
