"""SymPy expressions at numbers, with 40 digits, and the size that rounding is measured against.

Input: an expression and a value for each of its names.  Output: its value and its size: what the
result would be wrong by, per unit of relative error of every number and of every operation.  The
size of a sum is the sum of the sizes of its terms, so that cancellation is not blamed on the code.
"""

import operator

import mpmath as mp
import sympy as sp

from piezo_sym.algebra.symbols import Raised

DIGITS = 40
RELATIONS = {sp.Lt: operator.lt, sp.Le: operator.le, sp.Gt: operator.gt, sp.Ge: operator.ge}


def measured(expr, values):
    """Return (value, size) of an expression at exactly the floating-point numbers given."""
    return all_measured([expr], values)[0]


def all_measured(expressions, values):
    """Return (value, size) of each expression; what they have in common is computed once."""
    known = {}
    with mp.workdps(DIGITS):
        exact = {name: mp.mpf(v) for name, v in values.items()}
        return [_measured(expr, exact, known) for expr in expressions]


def _measured(expr, values, known):
    if expr not in known:
        known[expr] = _found(expr, values, known)
    return known[expr]


def _found(expr, values, known):
    if isinstance(expr, sp.Symbol):
        return values[expr.name], abs(values[expr.name])
    if expr.is_Rational:
        value = mp.mpf(expr.p) / expr.q
        return value, abs(value)
    if isinstance(expr, sp.Piecewise):
        return _measured(_branch(expr, values, known), values, known)
    parts = [_measured(arg, values, known) for arg in expr.args]
    if expr.is_Add:
        return mp.fsum(v for v, _ in parts), mp.fsum(s for _, s in parts)
    if expr.is_Mul:
        return _product(parts)
    if expr.is_Pow or isinstance(expr, Raised):
        (base, size), (exponent, _) = parts
        value = base**exponent
        return value, abs(value) * (1 + (abs(exponent / base) * size if base else 0))
    function = getattr(mp, expr.func.__name__)
    ((arg, size),) = parts
    return function(arg), abs(function(arg)) + abs(mp.diff(function, arg)) * size


def _product(parts):
    value, size = mp.mpf(1), mp.mpf(0)
    for v, s in parts:
        value, size = value * v, size * abs(v) + abs(value) * s
    return value, size


def _branch(expr, values, known):
    for part, condition in expr.args:
        if condition == sp.true or _holds(condition, values, known):
            return part
    raise AssertionError(f"no branch of {expr} holds")


def _holds(condition, values, known):
    if isinstance(condition, sp.And | sp.Or):
        every = all if isinstance(condition, sp.And) else any
        return every(_holds(part, values, known) for part in condition.args)
    if isinstance(condition, sp.ITE):
        test, then, other = condition.args
        return _holds(then if _holds(test, values, known) else other, values, known)
    if condition in (sp.true, sp.false):
        return bool(condition)
    left, right = (_measured(side, values, known)[0] for side in condition.args)
    return RELATIONS[condition.func](left, right)
