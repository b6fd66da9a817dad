"""Conditions on the sign of a law, as a person would write them.

Input: a comparison with zero, and a test of positivity.  Output: a shorter comparison that is
equivalent if the test is right: without positive factors, kap > 1 for kap**2*x - kap*x > 0.
"""

from collections.abc import Iterator
from fractions import Fraction
from functools import reduce

from piezo_sym.expressions.calculus import add, div, mul, neg, power
from piezo_sym.expressions.tidying import tidied
from piezo_sym.expressions.tree import ONE, ZERO, Add, Call, Cmp, Div, Expr, Mul, Neg, Num
from piezo_sym.proofs.signs.reduce import Positive, Setting, factored

#: Functions that are positive wherever they have a value.
ABOVE = frozenset({"exp", "cosh"})
#: The operator of a comparison after its sides are exchanged.
TURNED = {"<": ">", "<=": ">=", ">": "<", ">=": "<=", "!=": "!="}
#: A product: its number, and the exponent of each other factor.
Factors = tuple[Fraction, dict[Expr, Fraction]]


def without_factors(claim: Cmp, positive: Positive) -> Cmp:
    """Return a claim on the sign of a product as one on those factors that are not positive."""
    if claim.op not in {">", ">=", "!="} or claim.right != ZERO:
        return claim
    factors = (f for f in sign_factors(claim.left) if not _is_above(f))
    kept = [f for f in factors if not positive(f)] or [claim.left]
    return Cmp(claim.op, tidied(reduce(mul, kept)), ZERO)


def shortened(claim: Cmp, positive: Positive) -> Cmp:
    """Return a claim without factors that all terms of a sum share; of exp(x) > exp(y), x > y."""
    if claim.op not in {">", ">=", "!="} or claim.right != ZERO:
        return claim
    bare = tidied(reduce(mul, (_divided(f, positive) for f in sign_factors(claim.left))))
    inside = _logarithm(bare)
    if inside is None:
        return Cmp(claim.op, bare, ZERO)
    return shortened(without_factors(Cmp(claim.op, inside, ZERO), positive), positive)


def sided(condition: Cmp) -> Cmp:
    """Return a comparison of a sum with zero, such as n - 1 > 0, as n > 1: terms on both sides."""
    if condition.right != ZERO or not isinstance(condition.left, Add):
        return condition
    terms = condition.left.terms
    less = [neg(t) for t in terms if isinstance(t, Neg) or (isinstance(t, Num) and t.value < 0)]
    more = [t for t in terms if neg(t) not in less]
    if len(more) == 1 and isinstance(more[0], Num):
        return Cmp(TURNED[condition.op], add(*less), more[0])
    return Cmp(condition.op, add(*more), add(*less)) if more else condition


def sign_factors(law: Expr) -> Iterator[Expr]:
    """Yield factors whose product has the sign of a law."""
    match law:
        case Mul(left, right) | Div(left, right):
            yield from (*sign_factors(left), *sign_factors(right))
        case Neg(arg):
            yield from (Neg(ONE), *sign_factors(arg))
        case _:
            yield law


def factors_of(term: Expr, positive: Positive) -> Factors:
    """Return a term as a product of powers."""
    found = factored(term, Setting("", {}, positive))
    alone = {} if found.bound == ONE else {found.bound: Fraction(1)}  # without names, as log(2)
    return found.number, {**found.free, **alone}


def product_of(number: Fraction, powers: dict[Expr, Fraction]) -> Expr:
    """Return a product of powers as a tree, those with negative exponents as divisors."""
    tree: Expr = Num(number)
    for base, e in powers.items():
        tree = mul(tree, power(base, e)) if e >= 0 else div(tree, power(base, -e))
    return tree


def _divided(node: Expr, positive: Positive) -> Expr:
    """Return a sum without the positive factors that its terms share; other trees as they are."""
    if not isinstance(node, Add):
        return node
    terms, none = [factors_of(term, positive) for term in node.terms], Fraction(0)
    shared = dict[Expr, Fraction]()
    for base in terms[0][1]:
        exponents = [powers.get(base, none) for _, powers in terms]
        common = max(min(exponents), none) + min(max(exponents), none)  # 1/g of 1 + q/g stays
        shared |= {base: common} if common and (_is_above(base) or positive(base)) else {}
    left = (
        (number, {base: e - shared.get(base, none) for base, e in powers.items()})
        for number, powers in terms
    )
    return add(*(product_of(*term) for term in left)) if shared else node


def _logarithm(node: Expr) -> Expr | None:
    """Return x - y of exp(x) - exp(y), which has the same sign, or None; 1 is exp(0)."""
    one, other, *more = (*node.terms, ZERO) if isinstance(node, Add) else (ZERO, ZERO)
    for above, below in ((one, other), (other, one)):
        x, y = _exponent(above), _exponent(neg(below))
        if x and y and more == [ZERO]:
            return add(x, neg(y))
    return None


def _exponent(node: Expr) -> Expr | None:
    """Return x of exp(x), and 0 of 1."""
    match node:
        case Call("exp", (arg,)):
            return arg
    return ZERO if node == ONE else None


def _is_above(node: Expr) -> bool:
    return isinstance(node, Call) and node.function in ABOVE
