"""The value of a law at a point, exactly: a rational where all numbers are, else an enclosure.

Input: a tree of the checker, and what gives the values of its symbols, rationals or balls of FLINT.
Output: its value at the present precision, or an error that says what prevents it.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any

from flint import arb, fmpq, fmpz

from piezo_sym.checker.functions import KINKS
from piezo_sym.checker.laws import Node, increasing, made, unkinked

MAX_BITS = 40_000
#: Arguments beyond these are not computed: a function's value would need too many digits.
LARGEST, LARGEST_ANGLE = 2**34, 2**4096
ValueOf = Callable[[Any], Any]


class CannotTell(ArithmeticError):
    """The precision does not decide a comparison, or a number is too large to be computed."""


class NoValue(ArithmeticError):
    """A law has no real value: a division by zero, a root or logarithm outside its domain."""


def exact(number: Any) -> Any:
    """Return a Python number as an exact rational of FLINT; FLINT's numbers stay."""
    if not isinstance(number, int | float | Fraction):
        return number
    ratio = Fraction(number)
    return fmpq(ratio.numerator, ratio.denominator)


def sign(number: Any) -> int:
    """Return the sign of a number; raises `CannotTell` if its enclosure does not tell."""
    told = 1 if number > 0 else -1 if number < 0 else 0 if number == 0 else None
    if told is None:
        raise CannotTell
    return told


def holds(condition: Node, value_of: ValueOf) -> bool:
    """Return whether a comparison holds."""
    told = sign(compute(made("x - z", x=condition.args[0], z=condition.args[1]), value_of))
    return {"<": told < 0, "<=": told <= 0, ">": told > 0, ">=": told >= 0}[condition.value]


def compute(node: Node, value_of: ValueOf) -> Any:
    """Return the value of a law; raises `NoValue` or `CannotTell`."""
    if node.op in ("num", "sym"):
        return exact(node.value) if node.op == "num" else value_of(node.value)
    if node.op == "if":
        return compute(node.args[1 if holds(node.args[0], value_of) else 2], value_of)
    if not all(holds(order, value_of) for order in increasing(node)):
        raise NoValue
    if node.op in KINKS and node.op not in ("min", "max"):
        plain = unkinked(node) if node.op != "abs" else made("max(x, -x)", x=node.args[0])
        return compute(plain, value_of)
    args = [compute(arg, value_of) for arg in node.args]
    found = sum(args[1:], args[0]) if node.op == "+" else _operation(node, args[0], args[-1])
    if isinstance(found, fmpq):
        long = found.p.bit_length() + found.q.bit_length() > MAX_BITS
        return arb(found) if long else found
    if not found.is_finite():
        raise CannotTell
    return found


def text(number: Any) -> str:
    """Return an exact value as text: a short fraction, or 17 digits."""
    short = str(number)
    if isinstance(number, arb) or len(short) > 40:
        return str(arb(exact(number)).mid().str(17, radius=False))
    return short


def _operation(node: Node, x: Any, z: Any) -> Any:
    match node.op:
        case "neg":
            return -x
        case "*":
            return x * z
        case "/":
            return x / _nonzero(z)
        case "**":
            return _power(x, node.value)
        case "min" | "max":
            try:
                return x if (sign(x - z) >= 0) == (node.op == "max") else z
            except CannotTell:
                return getattr(_real(x), node.op)(z)
        case "log":
            if sign(x) <= 0:
                raise NoValue("logarithm of no positive number")
            return exact(0) if x == 1 else _real(x).log()
    if x == 0:
        return exact(1 if node.op in ("exp", "cos", "cosh") else 0)
    if not abs(x) < (LARGEST_ANGLE if node.op in ("sin", "cos") else LARGEST):
        raise CannotTell
    return getattr(_real(x), node.op)()


def _real(number: Any) -> Any:
    return arb(number) if isinstance(number, fmpq) else number


def _nonzero(x: Any) -> Any:
    if sign(x) == 0:
        raise NoValue("division by zero")
    return x


def _power(x: Any, exponent: Fraction) -> Any:
    top, order = exponent.numerator, exponent.denominator
    x = _nonzero(x) if top < 0 else x
    if order > 1:
        if sign(x) < 0:
            raise NoValue("root of a negative number")
        roots = [fmpz(n).root(order) for n in (x.p, x.q)] if isinstance(x, fmpq) else [0, 1]
        rational = isinstance(x, fmpq) and fmpq(*roots) ** order == x
        x = fmpq(*roots) if rational else _real(x).root(order)
    return 1 / x ** abs(top) if top < 0 else x**top
