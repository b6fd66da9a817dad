"""Whether a law is exactly zero at a rational number, where intervals only say nearly.

Input: a tree in one name, a number.  Output: True if its value cancels term by term:
``log(1 + exp(0)) - log(2)`` does, since exp(0) is 1 and both terms are then the same.  A value is
kept as a sum of rational multiples of parts that are not rational, such as ``log(2)``.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from functools import lru_cache
from typing import TypeAlias

from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.tree import ONE, Add, Call, Div, Expr, Mul, Neg, Num, Pow, Sym
from piezo_sym.proofs.exact_eval import value_of

#: part -> how often; the rational part stands at ONE, and no number of times is zero.
Sum: TypeAlias = Mapping[Expr, Fraction]


@lru_cache(maxsize=4096)
def vanishes(tree: Expr, at: Fraction) -> bool:
    """Return whether a tree is sure to be zero at a number, and continuous there if defined."""
    value = _value(tree, at)
    return value is not None and not value


def rational_at(tree: Expr, at: Fraction) -> Fraction | None:
    """Return the value of a tree at a number if it is sure to be this rational."""
    value = _value(tree, at)
    return None if value is None else _rational(value)


def _value(node: Expr, at: Fraction) -> Sum | None:
    """Return the value as a sum; None where there may be a jump or a division by zero."""
    match node:
        case Num(number):
            return _times({ONE: Fraction(1)}, number)
        case Sym():
            return _times({ONE: Fraction(1)}, at)
        case Neg(arg):
            inner = _value(arg, at)
            return None if inner is None else _times(inner, Fraction(-1))
        case Add(terms):
            return _total([_value(term, at) for term in terms])
        case Mul(left, right) | Div(left, right):
            return _product(node, _value(left, at), _value(right, at))
        case Pow(base, exponent):
            return _power(_value(base, at), exponent)
        case Call(function, args) if not RECORDS[function].jumps:
            return _call(function, [_value(arg, at) for arg in args])
    return None


def _times(a: Sum, factor: Fraction) -> Sum:
    return {part: n * factor for part, n in a.items()} if factor else {}


def _total(terms: list[Sum | None]) -> Sum | None:
    total: dict[Expr, Fraction] = {}
    for term in terms:
        if term is None:
            return None
        for part, n in term.items():
            total[part] = total.get(part, Fraction(0)) + n
    return {part: n for part, n in total.items() if n}


def _rational(a: Sum) -> Fraction | None:
    """Return a sum that is one rational number."""
    return a.get(ONE, Fraction(0)) if a.keys() <= {ONE} else None


def _product(node: Mul | Div, a: Sum | None, b: Sum | None) -> Sum | None:
    if a is None or b is None:
        return None
    first, second = _rational(a), _rational(b)
    if isinstance(node, Div):
        if second is not None:
            return _times(a, 1 / second) if second else None
        return {Div(_tree(a), _tree(b)): Fraction(1)} if a else {}
    if second is not None:
        return _times(a, second)
    return _times(b, first) if first is not None else {Mul(_tree(a), _tree(b)): Fraction(1)}


def _power(base: Sum | None, exponent: Fraction) -> Sum | None:
    if base is None:
        return None
    number = _rational(base)
    if number is not None and exponent.denominator == 1 and (number or exponent > 0):
        return _times({ONE: Fraction(1)}, number**exponent.numerator)
    if not base:
        return {} if exponent > 0 else None
    return {Pow(_tree(base), exponent): Fraction(1)}


def _call(function: str, args: list[Sum | None]) -> Sum | None:
    known = [arg for arg in args if arg is not None]
    if len(known) < len(args):
        return None
    numbers = [number for arg in known if (number := _rational(arg)) is not None]
    record = RECORDS[function]
    if record.known and numbers and numbers[0] == record.known[0]:
        return _times({ONE: Fraction(1)}, Fraction(record.known[1]))
    if not record.smooth and len(numbers) == len(args):
        value = value_of(Call(function, tuple(map(Num, numbers))), {})
        return _times({ONE: Fraction(1)}, value)
    return {Call(function, tuple(map(_tree, known))): Fraction(1)}


def _tree(a: Sum) -> Expr:
    """Return a sum as a tree, its parts in one order."""
    return Add(tuple(Mul(Num(n), part) for part, n in sorted(a.items(), key=repr)))
