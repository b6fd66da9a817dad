"""The value of a law at a point, exactly: rationals where all is rational, else enclosures.

Input: a tree and numbers for its symbols (rationals of FLINT, enclosures, or what computes like
them).  Output: its value at the present precision; what that does not decide cannot be told.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from flint import arb, fmpq, fmpz

from piezo_sym.checker.laws import KINKS, Node, increasing, made, unkinked

MAX_BITS = 40_000
HUGE = {"sin": 2**4096, "cos": 2**4096}


class CannotTell(ArithmeticError):
    """The precision does not decide a comparison, or a number is beyond what is computed."""


class NoValue(ArithmeticError):
    """A law has no real value: a division by zero, a root or logarithm outside its domain."""


def exact(number: Any) -> Any:
    """Return a number as an exact rational of FLINT; what is none stays."""
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


def holds(condition: Node, words: Mapping[Any, Any]) -> bool:
    """Return whether a comparison holds."""
    told = sign(compute(made("x - z", x=condition.args[0], z=condition.args[1]), words))
    return {"<": told < 0, "<=": told <= 0, ">": told > 0, ">=": told >= 0}[condition.value]


def compute(node: Node, words: Mapping[Any, Any]) -> Any:
    """Return the value of a law; raises `NoValue` or `CannotTell`."""
    if node.op in ("num", "sym"):
        return exact(node.value) if node.op == "num" else words[node.value]
    if node.op == "if":
        return compute(node.args[1 if holds(node.args[0], words) else 2], words)
    if not all(holds(order, words) for order in increasing(node)):
        raise NoValue
    if node.op in KINKS and node.op not in ("min", "max"):
        return compute(
            unkinked(node) if node.op != "abs" else made("max(x, -x)", x=node.args[0]), words
        )
    args = [compute(arg, words) for arg in node.args]
    found = sum(args[1:], args[0]) if node.op == "+" else _operation(node, args[0], args[-1])
    if isinstance(found, fmpq):
        long = found.p.bit_length() + found.q.bit_length() > MAX_BITS
        return arb(found) if long else found
    if not found.is_finite():
        raise CannotTell
    return found


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
    if not abs(x) < HUGE.get(node.op, 2**34):
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
