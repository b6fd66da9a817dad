"""Simplification of trees: like terms added up, choices taken that signs of names decide.

Input: a tree.  Output: a tree of the same value; or, by `reflected`, of a law mirrored in its
variable, W(-z), with signs brought to the front: odd and even functions have the same arguments as
in the law itself, so that W(z) + W(-z) of an odd law cancels term by term.
"""

from collections.abc import Collection
from fractions import Fraction

from piezo_sym.expressions.calculus import add, inserted, mul, neg, power, rebuilt
from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.tree import (
    COMPARED,
    ONE,
    Add,
    Call,
    Cmp,
    Div,
    Expr,
    If,
    Mul,
    Neg,
    Num,
    Pow,
    Sym,
    knots,
    rebuild,
)


def collected(*terms: Expr) -> Expr:
    """Return the sum of `terms`, with like ones added up."""
    total: dict[Expr, Fraction] = {}
    todo = [(Fraction(1), term) for term in reversed(terms)]
    while todo:
        match todo.pop():
            case (factor, Add(inner)):
                todo += [(factor, term) for term in reversed(inner)]
            case (factor, Neg(arg)):
                todo.append((-factor, arg))
            case (factor, Mul(Num(value), arg) | Mul(arg, Num(value))):
                todo.append((factor * value, arg))
            case (factor, Div(arg, Num(value))) if value:
                todo.append((factor / value, arg))
            case (factor, Num(value)):
                total[ONE] = total.get(ONE, Fraction(0)) + factor * value
            case (factor, term):
                total[term] = total.get(term, Fraction(0)) + factor
    return add(*(mul(Num(factor), term) for term, factor in total.items()))


def tidied(node: Expr) -> Expr:
    """Return a tree with like terms of its sums added up."""
    inner = rebuild(node, tidied)
    return collected(inner) if isinstance(inner, Add) else inserted(inner, {})


def settled(node: Expr, positive: Collection[str]) -> Expr:
    """Return a tree with each choice taken that holds for all values of its names, or for none.

    `positive` are the names whose values are positive.
    """
    inner = rebuild(node, lambda part: settled(part, positive))
    match inner:
        case If(then, Cmp(op, left, right), other):
            sign = sign_of(add(left, neg(right)), positive)
            if sign is not None:
                return then if COMPARED[op](sign, 0) else other
        case Pow(Neg(arg), exponent) if exponent % 2 == 0:
            return Pow(arg, exponent)
    return inner


def sign_of(node: Expr, positive: Collection[str]) -> int | None:
    """Return the sign of a tree, if it is the same for all values of its names."""
    match node:
        case Num(value):
            return (value > 0) - (value < 0)
        case Sym(name):
            return 1 if name in positive else None
        case Neg(arg):
            inner = sign_of(arg, positive)
            return None if inner is None else -inner
        case Mul(left, right) | Div(left, right):
            one, two = sign_of(left, positive), sign_of(right, positive)
            return None if one is None or two is None else one * two
        case Add(terms):
            signs = {sign_of(term, positive) for term in terms}
            return signs.pop() if len(signs) == 1 else None
        case Pow(base, _) if sign_of(base, positive) == 1:
            return 1
    return None


def reflected(law: Expr, letter: str) -> Expr:
    """Return a law with the sign of its letter changed.

    Raises `ZeroDivisionError` if a divisor simplifies to zero.
    """

    def turned(node: Expr) -> Expr:
        return reflected(node, letter)

    match law:
        case Sym(name):
            return Neg(law) if name == letter else law
        case Add(terms):
            parts = tuple(map(turned, terms))
            if all(isinstance(part, Neg) for part in parts):  # one minus in front
                return neg(add(*map(neg, parts)))
            return add(*parts)
        case Pow(base, exponent):
            inner = turned(base)
            if isinstance(inner, Neg) and exponent.denominator == 1:
                size = power(inner.arg, exponent)
                return neg(size) if exponent.numerator % 2 else size
            return power(inner, exponent)
        case Call(function, (first, *others)):
            inner, rest = turned(first), tuple(map(turned, others))
            if isinstance(inner, Neg) and knots(law):  # y(-x) is minus the table of -x_k, -y_k
                mirrored = (neg(turned(part)) for pair in reversed(knots(law)) for part in pair)
                return neg(Call(function, (inner.arg, *mirrored)))
            parity = RECORDS[function].parity
            if not isinstance(inner, Neg) or not parity:
                return Call(function, (inner, *rest))
            call = Call(function, (inner.arg, *rest))
            return neg(call) if parity == "odd" else call
    return rebuilt(law, turned)
