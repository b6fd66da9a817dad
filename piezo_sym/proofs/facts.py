"""Facts on functions for solvers: bounds that are true for all real numbers.

Input: a function, and symbols for its argument and its value.  Output: clauses.  Outside the domain
of a root or a logarithm a clause holds for every value.
"""

from collections.abc import Iterator
from fractions import Fraction

from piezo_sym.expressions.calculus import clause, mul, power
from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.tree import ONE, ZERO, Cmp, Expr

#: A disjunction: at least one of these comparisons holds.
Clause = tuple[Cmp, ...]


def facts_on(function: str, exponent: Fraction | Expr, x: Expr, y: Expr) -> Iterator[Clause]:
    """Yield bounds on y = f(x) that hold for every real x: outside its domain f is unrestricted.

    A ``root`` is the power `exponent` of x; the exponent of ``pow`` is a tree.
    """
    if isinstance(exponent, Fraction) and function == "root":  # y**q = x**p defines x**(p/q) >= 0
        undefined = Cmp("<" if exponent > 0 else "<=", x, ZERO)
        yield (undefined, Cmp(">=", y, ZERO))
        root = power(y, Fraction(exponent.denominator))
        inside = power(x, abs(Fraction(exponent.numerator)))
        sides = (root, inside) if exponent > 0 else (mul(root, inside), ONE)
        yield (undefined, Cmp("=", *sides))
    elif function in RECORDS:
        yield from (clause(text, x, y) for text in RECORDS[function].facts)


def facts_on_two(
    function: str, exponent: Fraction | Expr, one: tuple[Expr, Expr], other: tuple[Expr, Expr]
) -> Iterator[Clause]:
    """Yield clauses that relate two pairs (argument, value) of one function and exponent."""
    (x, y), (a, b) = one, other
    record = RECORDS.get(function)
    rising = record.monotone if record else isinstance(exponent, Fraction) and exponent > 0
    op = "<=" if record else "<"
    limited = record.domain if record else True
    undefined = (Cmp(op, x, ZERO), Cmp(op, a, ZERO)) if limited else ()
    if rising:
        yield (*undefined, Cmp(">", x, a), Cmp("<=", y, b))
        yield (*undefined, Cmp("<", x, a), Cmp(">=", y, b))
    elif function != "root":
        yield (Cmp("!=", x, a), Cmp("=", y, b))
