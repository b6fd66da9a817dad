"""Text of a law to a checked tree.

Input: text from a user.  Output: a tree, or a `SpecError`.  Proofs expand laws and write functions
with kinks branch by branch, so a short text can need unbounded time and memory there: the size of a
law in later stages is bounded before they run.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import TypeVar, final

from piezo_sym.errors import SpecError, quote
from piezo_sym.expressions.exact_eval import evaluate
from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.grammar import MAX_MAGNITUDE, RefusedError, read_condition, read_law
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import (
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
    children,
    knots,
    names,
    walk,
)

Tree = TypeVar("Tree", Expr, Cmp)

MAX_BRANCHES = 18
MAX_DEGREE = 32
MAX_DIGITS = 2000
MAX_NESTED = 8
MAX_NESTED_CONSTANT = 4
MAX_TERMS = 512


def parse_law(text: str, where: str) -> Expr:
    """Return the tree of a law; `where` is its place in the spec, for the message.

    Raises `SpecError` if the text is not of the law language, or a constant part has no value.
    """
    return _located(_law, text, where)


def parse_condition(text: str, where: str) -> Cmp:
    """Return the tree of one comparison, such as ``T > T_0``.

    Raises `SpecError` if the text is not one comparison of two laws.
    """
    return _located(_condition, text, where)


def _located(read: Callable[[str], Tree], text: str, where: str) -> Tree:
    try:
        return read(text)
    except RefusedError as refused:
        what = f"{quote(text)} {refused.what}"
        raise SpecError(what, where, refused.expected, refused.remedy) from None


@lru_cache(maxsize=16384)
def _law(text: str) -> Expr:
    tree = read_law(text)
    _check_size(tree)
    _check_constants(tree)
    return tree


@lru_cache(maxsize=16384)
def _condition(text: str) -> Cmp:
    tree = read_condition(text)
    for side in (tree.left, tree.right):
        _check_size(side)
        _check_constants(side)
    return tree


def _check_constants(node: Expr | Cmp) -> bool:
    """Return whether `node` is constant; refuse the smallest constant part without a value."""
    constant = all([_check_constants(part) for part in children(node)])
    if isinstance(node, Div) and not names(node.right) and evaluate(node.right, {}) == 0:
        what = f"divides by {quote(spell(node.right))}, which is zero"
        raise RefusedError(what, remedy="divide by something else")
    if isinstance(node, Cmp) or not constant or isinstance(node, Sym):
        return constant and not isinstance(node, Sym)
    try:
        evaluate(node, {})
    except (ArithmeticError, ValueError):
        what = f"has the constant part {quote(spell(node))} without a finite real value"
        raise RefusedError(what, remedy="give the number itself") from None
    return True


def _check_size(tree: Expr) -> None:
    """Refuse a law that would become too large in a later stage.

    Raises `RefusedError` with the limit that the law exceeds.
    """
    if _degree(tree) > MAX_DEGREE:
        raise RefusedError("has too high a degree", f"at most {MAX_DEGREE} in all")
    if _extent(tree).most > MAX_TERMS:
        what, remedy = "has too many terms when it is multiplied out", "nest fewer sums"
        raise RefusedError(what, f"at most {MAX_TERMS}", f"{remedy} in products and powers")
    if _most_branches(tree) > MAX_BRANCHES:
        what = "nests functions with kinks too deeply"
        raise RefusedError(what, f"at most {MAX_BRANCHES} branches", "split the law into elements")
    if _nested(tree) > MAX_NESTED:  # SymPy's time grows without bound
        raise RefusedError("nests functions too deeply", f"at most {MAX_NESTED} in each other")
    constant = (part for part in walk(tree) if not isinstance(part, Cmp) and not names(part))
    if any(_nested(part) > MAX_NESTED_CONSTANT for part in constant):
        what = "nests functions of numbers too deeply"
        raise RefusedError(what, f"at most {MAX_NESTED_CONSTANT}", "give the number itself")
    if _magnitude(tree) > MAX_MAGNITUDE or _digits(tree) > MAX_DIGITS:
        what = "has numbers that multiply to too large or too long ones"
        expected = f"up to 1e+-{MAX_MAGNITUDE} and {MAX_DIGITS} digits in all"
        raise RefusedError(what, expected, "use other units")


def _nested(node: Expr | Cmp) -> int:
    """Return how deeply functions and roots are nested."""
    nests = isinstance(node, Call) or (isinstance(node, Pow) and node.exponent.denominator > 1)
    return int(nests) + max((_nested(part) for part in children(node)), default=0)


def _magnitude(node: Expr | Cmp) -> float:
    """Return a bound on the power of ten, of either sign, of products of the numbers in a law."""
    parts = [_magnitude(part) for part in children(node)]
    match node:
        case Num(value):
            return abs(_log(value.numerator) - _log(value.denominator)) if value else 0.0
        case Mul() | Div():
            return sum(parts)
        case Pow(_, exponent):
            return parts[0] * float(max(abs(exponent), Fraction(1)))
    return max(parts, default=0.0)


def _digits(node: Expr | Cmp) -> float:
    """Return a bound on the digits of the numbers in a law, sums over a common denominator."""
    parts = [_digits(part) for part in children(node)]
    match node:
        case Num(value):
            return _log(max(abs(value.numerator), 1)) + _log(value.denominator)
        case Pow(_, exponent):
            return parts[0] * float(max(abs(exponent), Fraction(1)))
    return sum(parts)


def _log(value: int) -> float:
    return math.log10(abs(value))


def _most_branches(tree: Expr) -> int:
    """Return the most branches that a function with kinks, or a condition, has in a law.

    Both are written out branch by branch, with all choices inside them.
    """
    kinked = [part for part in walk(tree) if isinstance(part, Cmp) or _own_branches(part) > 1]
    return max((_branches(part) for part in kinked if not _plain_table(part)), default=1)


def _plain_table(node: Expr | Cmp) -> bool:
    """Return whether a tree is a table of smooth arguments, which may have many pieces."""
    return bool(knots(node)) and all(_branches(part) == 1 for part in children(node))


def _own_branches(node: Expr | Cmp) -> int:
    """Return the number of branches of a function, its arguments aside; 1 for other nodes."""
    return RECORDS[node.function].branches(len(node.args)) if isinstance(node, Call) else 1


def _branches(node: Expr | Cmp) -> int:
    """Return the number of branches of an expression that is written as one choice."""
    if isinstance(node, If):
        parts = _branches(node.then) + _branches(node.other)
    else:
        parts = math.prod(map(_branches, children(node)))
    conditions = _branches(node.condition) if isinstance(node, If) else _own_branches(node)
    return min(parts * conditions, MAX_BRANCHES + 1)


def _degree(node: Expr | Cmp) -> Fraction:
    match node:
        case Num():
            return Fraction(0)
        case Sym():
            return Fraction(1)
        case Mul(left, right) | Div(left, right):
            return _degree(left) + _degree(right)
        case Pow(base, exponent):
            return _degree(base) * max(abs(exponent), Fraction(1))
    return max(_degree(part) for part in children(node))


@final
@dataclass(frozen=True)
class _Extent:
    """The number of terms of an expanded law, the most of any part, and its divisors' terms."""

    terms: int
    most: int
    divisors: Mapping[Expr, int]


def _extent(node: Expr | Cmp) -> _Extent:
    """Return the extent of a law; a sum of quotients counts over its common denominator."""
    parts = [_extent(part) for part in children(node)]
    divisors = {key: n for part in parts for key, n in part.divisors.items()}
    inner = [part.terms for part in parts]
    terms = 1
    match node:
        case Add():
            terms = sum(inner) * math.prod(divisors.values())
        case Mul() | Div():
            terms = math.prod(inner)
        case Pow(_, exponent):
            times = max(math.ceil(abs(exponent)), 1)
            terms = math.comb(inner[0] + times - 1, times)
        case Call("log", (arg,)):
            terms = _factors(arg)
        case Neg() | If():
            terms = max(inner)
    terms = min(terms, MAX_TERMS + 1)
    most = max([terms, *(part.most for part in parts)])
    if isinstance(node, Div):
        divisors = dict(parts[0].divisors) | {node.right: inner[1]}
    elif isinstance(node, Call | Cmp | If | Add):
        divisors = {}
    return _Extent(terms, most, divisors)


def _factors(node: Expr | Cmp) -> int:
    """Return the number of factors of a law, which are the terms of its logarithm."""
    match node:
        case Mul(left, right) | Div(left, right):
            return _factors(left) + _factors(right)
        case Pow(base, _):
            return _factors(base)
    return 1
