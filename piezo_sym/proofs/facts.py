"""What solvers are told of functions: bounds that are true for all real numbers.

Input: a function, its argument and its value by name.  Output: clauses.  Each says of a root or a
logarithm nothing where it is not defined.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from piezo_sym.spec.calculus import add, mul, neg, power
from piezo_sym.spec.expressions import ONE, ZERO, Cmp, Expr, Num

#: One of these comparisons holds.
Clause = tuple[Cmp, ...]


#: A little below e: exp(x) >= e*x.
BELOW_E = Num(Fraction(271828, 100000))


def _number(value: int | Fraction) -> Num:
    return Num(Fraction(value))


def facts_on(function: str, exponent: Fraction, x: Expr, y: Expr) -> Iterator[Clause]:
    """Yield bounds on y = f(x) that hold for every real x, each with the function's own domain.

    Parameters
    ----------
    function : ``exp`` ..., or ``root`` for the power `exponent` of x.
    """
    above, below = Cmp(">", x, ZERO), Cmp("<", x, ZERO)
    plus, minus = Cmp(">=", y, ZERO), Cmp("<=", y, ZERO)
    yield from _where_defined(function, exponent, x, y)
    match function:
        case "exp":  # convex: above its tangents at 0 and 1; 1/exp(x) = exp(-x) >= 1 - x
            yield (Cmp(">", y, ZERO),)
            yield (Cmp(">=", y, add(ONE, x)),)
            yield (Cmp(">=", y, mul(BELOW_E, x)),)
            half = mul(_number(Fraction(1, 2)), power(x, Fraction(2)))
            yield (below, Cmp(">=", y, add(ONE, x, half)))
            yield (Cmp(">=", x, ONE), Cmp("<=", mul(y, add(ONE, neg(x))), ONE))
        case "tanh":  # x/(1 + |x|) lies between 0 and tanh(x), and that below x
            yield (Cmp("<", y, ONE),)
            yield (Cmp(">", y, neg(ONE)),)
            yield (below, Cmp("<=", y, x))
            yield (below, Cmp(">=", mul(y, add(ONE, x)), x))
            yield (above, Cmp(">=", y, x))
            yield (above, Cmp("<=", mul(y, add(ONE, neg(x))), x))
        case "sin":  # |sin x| <= |x|, its sign up to 3 < pi, x - x**3/6 <= sin x for x >= 0
            cubic = add(x, neg(mul(_number(Fraction(1, 6)), power(x, Fraction(3)))))
            yield from _within_one(y)
            yield (below, Cmp("<=", y, x))
            yield (above, Cmp(">=", y, x))
            yield (below, Cmp(">=", y, cubic))
            yield (above, Cmp("<=", y, cubic))
            yield (below, Cmp(">", x, _number(3)), plus)
            yield (above, Cmp("<", x, _number(-3)), minus)
        case "cos":  # 1 - x**2/2 <= cos x
            half = mul(_number(Fraction(1, 2)), power(x, Fraction(2)))
            yield from _within_one(y)
            yield (Cmp(">=", y, add(ONE, neg(half))),)


def facts_on_two(
    function: str, exponent: Fraction, one: tuple[Expr, Expr], other: tuple[Expr, Expr]
) -> Iterator[Clause]:
    """Yield what relates the values of one function at two arguments.

    Parameters
    ----------
    one, other : each an argument and its value.
    """
    (x, y), (a, b) = one, other
    rising = function in {"exp", "tanh", "log"} or (function == "root" and exponent > 0)
    op = "<=" if function == "log" else "<"
    limited = function in {"log", "root"}
    undefined = (Cmp(op, x, ZERO), Cmp(op, a, ZERO)) if limited else ()
    if rising:
        yield (*undefined, Cmp(">", x, a), Cmp("<=", y, b))
        yield (*undefined, Cmp("<", x, a), Cmp(">=", y, b))
    elif function != "root":
        yield (Cmp("!=", x, a), Cmp("=", y, b))


def _within_one(y: Expr) -> Iterator[Clause]:
    yield (Cmp("<=", y, ONE),)
    yield (Cmp(">=", y, neg(ONE)),)


def _where_defined(function: str, exponent: Fraction, x: Expr, y: Expr) -> Iterator[Clause]:
    """Yield what is known of functions that not every number has a value of."""
    match function:
        case "root":  # y >= 0, y**q = x**p: all there is to say
            undefined = Cmp("<" if exponent > 0 else "<=", x, ZERO)
            yield (undefined, Cmp(">=", y, ZERO))
            root = power(y, Fraction(exponent.denominator))
            inside = power(x, abs(Fraction(exponent.numerator)))
            sides = (root, inside) if exponent > 0 else (mul(root, inside), ONE)
            yield (undefined, Cmp("=", *sides))
        case "log":  # below its tangent at 1, and log(x) = -log(1/x)
            undefined = Cmp("<=", x, ZERO)
            yield (undefined, Cmp("<=", y, add(x, neg(ONE))))
            yield (undefined, Cmp(">=", mul(y, x), add(x, neg(ONE))))
