"""Laws mirrored in their variable: W(-z), with signs brought to the front.

Input: a law and its letter.  Output: a tree in which odd and even functions have the same arguments
as in the law itself, so that W(z) + W(-z) of an odd law cancels term by term.
"""

from piezo_sym.expressions.calculus import add, neg, power, rebuilt
from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.tree import Add, Call, Expr, Neg, Pow, Sym, knots


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
            return _sum(tuple(map(turned, terms)))
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


def _sum(terms: tuple[Expr, ...]) -> Expr:
    """Return a sum, with one minus in front if each term has a minus."""
    if all(isinstance(term, Neg) for term in terms):
        return neg(add(*(neg(term) for term in terms)))
    return add(*terms)
