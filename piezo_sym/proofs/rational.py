"""Laws as polynomials and choices, which solvers of real arithmetic understand.

Input: trees without kinked functions; choices stay.  Output: the same trees with a symbol for every
function and root (`Part`), facts on these symbols, and quotients without division: cleared
(`Ratio`), or with a symbol each where the tree has choices.

A fact is a clause that is true for all real numbers: its premise is the function's own domain, not
the branch in which the function stands.  Outside its domain a function's symbol is free.  A claim
that follows from facts is a theorem; a counterexample has to be confirmed on the law itself.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from itertools import combinations
from typing import final

from piezo_sym.expressions.calculus import add, clause, mul, neg, power
from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.tree import (
    ONE,
    ZERO,
    Add,
    Call,
    Cmp,
    Div,
    Expr,
    If,
    Mul,
    Neg,
    Node,
    Num,
    Pow,
    Sym,
    replaced,
    walk,
)
from piezo_sym.spec.names import fresh

#: A disjunction: at least one of these comparisons holds.
Clause = tuple[Cmp, ...]
#: With more functions than these, no facts relate pairs of them.
MOST_ALIKE = 8


@final
@dataclass(frozen=True)
class Ratio:
    """A quotient of two polynomials."""

    top: Expr
    bottom: Expr = ONE


@final
@dataclass(frozen=True)
class Part:
    """A function, root or quotient in a law, with a symbol of its own."""

    name: str  # of its symbol
    #: ``exp``, ..., ``root`` for the power `exponent` of the argument, or ``quotient``, which
    #: equals its argument.
    function: str
    argument: Expr  # the argument's symbol, which equals `value`
    value: Ratio  # the argument, free of functions
    exponent: Fraction | Expr = Fraction(1)  # of a root, or of ``pow``


@final
@dataclass(frozen=True)
class Parts:
    """The functions of some laws, each after those in its argument."""

    parts: tuple[Part, ...]
    words: tuple[tuple[Node, Sym], ...]

    def without_functions(self, law: Expr) -> Expr:
        """Return a law with each function replaced by its symbol."""
        return replaced(law, dict(self.words))

    def facts(self, nonzero: frozenset[str] = frozenset()) -> Iterator[Clause]:
        """Yield facts on the parts; products of `nonzero` names as divisors need no premise."""
        for part in self.parts:
            bottom = part.value.bottom
            if part.argument != part.value.top or bottom != ONE:
                undefined = () if _product_of(bottom, nonzero) else (Cmp("=", bottom, ZERO),)
                yield (*undefined, Cmp("=", mul(part.argument, bottom), part.value.top))
            yield from facts_on(part.function, part.exponent, part.argument, Sym(part.name))
        alike = [p for p in self.parts if p.function != "quotient"]
        for one, other in combinations(alike if len(alike) <= MOST_ALIKE else (), 2):
            if (one.function, one.exponent) == (other.function, other.exponent):
                pairs = ((p.argument, Sym(p.name)) for p in (one, other))
                yield from facts_on_two(one.function, one.exponent, *pairs)


def parts_of(laws: Iterable[Expr], taken: frozenset[str]) -> Parts:
    """Return the functions in laws, and the quotients in laws with choices; names avoid `taken`."""
    words: dict[Node, Sym] = {}
    found: list[Part] = []
    used = set(taken)

    def name(base: str) -> str:
        new = fresh(base, used)
        used.add(new)
        return new

    for law in laws:
        nodes = tuple(walk(law))
        chooses = any(isinstance(node, If) for node in nodes)
        for node in reversed(nodes):  # inner ones first
            known = _function(node) or (_quotient(node) if chooses else None)
            if known is None or node in words:
                continue
            function, given, exponent = known
            value = ratio(replaced(given, words))
            symbol = Sym(name(f"{function}_{len(found) + 1}"))
            simple = isinstance(value.top, Sym | Num) and value.bottom == ONE
            argument = value.top if simple else Sym(name(f"{function}_argument_{len(found) + 1}"))
            if function == "quotient":
                argument = symbol
            found.append(Part(symbol.name, function, argument, value, exponent))
            words[node] = symbol
    return Parts(tuple(found), tuple(words.items()))


def _quotient(node: Node) -> tuple[str, Expr, Fraction | Expr] | None:
    """Return a quotient as ("quotient", itself, 1), or None; division by a number is none."""
    match node:
        case Div(_, Num(value)) if value != 0:
            return None
        case Div():
            return "quotient", node, Fraction(1)
        case Pow(_, exponent) if exponent.denominator == 1 and exponent < 0:
            return "quotient", node, Fraction(1)
    return None


def _function(node: Node) -> tuple[str, Expr, Fraction | Expr] | None:
    """Return a function or root as (name, argument, exponent), or None."""
    match node:
        case Call(function, (arg,)) if (exponent := RECORDS[function].power) is not None:
            return "root", arg, exponent
        case Call(function, (arg, *more)) if RECORDS[function].transcendental:
            return function, arg, more[0] if more else Fraction(1)
        case Pow(base, exponent) if exponent.denominator != 1:
            return "root", base, exponent
    return None


def ratio(law: Expr) -> Ratio:
    """Return a rational law as a quotient of two polynomials, with no division by numbers left."""
    match law:
        case Num() | Sym():
            return Ratio(law)
        case Neg(arg):
            inner = ratio(arg)
            return Ratio(neg(inner.top), inner.bottom)
        case Add(terms):
            return _total([ratio(term) for term in terms])
        case Mul(left, right):
            a, b = ratio(left), ratio(right)
            return Ratio(mul(a.top, b.top), mul(a.bottom, b.bottom))
        case Div(left, Num(value)) if value != 0:
            a = ratio(left)
            return Ratio(mul(Num(1 / value), a.top), a.bottom)
        case Div(left, right):
            a, b = ratio(left), ratio(right)
            return Ratio(mul(a.top, b.bottom), mul(a.bottom, b.top))
        case Pow(base, exponent) if exponent.denominator == 1:
            a, size = ratio(base), abs(exponent)
            top, bottom = power(a.top, size), power(a.bottom, size) if a.bottom != ONE else ONE
            return Ratio(top, bottom) if exponent > 0 else Ratio(bottom, top)
        case If(then, Cmp(op, left, right), other):  # its quotients have symbols of their own
            return Ratio(If(_top(then), Cmp(op, _top(left), _top(right)), _top(other)))
    raise TypeError(f"{type(law).__name__} is not rational")


def _top(law: Expr) -> Expr:
    """Return a law that divides by numbers only as a polynomial."""
    value = ratio(law)
    if value.bottom != ONE:
        raise TypeError("a choice divides, and the quotient has no symbol")
    return value.top


def _total(parts: list[Ratio]) -> Ratio:
    """Return a sum; with one common denominator its terms are added at once, in linear time."""
    if len({part.bottom for part in parts}) == 1:
        return Ratio(add(*(part.top for part in parts)), parts[0].bottom)
    return reduce(_sum, parts, Ratio(ZERO))


def _sum(a: Ratio, b: Ratio) -> Ratio:
    if a.top == ZERO:
        return b
    if a.bottom == b.bottom:
        return Ratio(add(a.top, b.top), a.bottom)
    return Ratio(add(mul(a.top, b.bottom), mul(b.top, a.bottom)), mul(a.bottom, b.bottom))


def implied(condition: Cmp, nonzero: frozenset[str]) -> Clause:
    """Return a comparison of rational sides as a clause: it holds, or a divisor is zero.

    Divisors that are products of `nonzero` names cannot be.
    """
    bottoms = (ratio(side).bottom for side in (condition.left, condition.right))
    undefined = (Cmp("=", b, ZERO) for b in bottoms if not _product_of(b, nonzero))
    return (*dict.fromkeys(undefined), cleared(condition))


def _product_of(tree: Expr, known: frozenset[str]) -> bool:
    """Return whether a tree is a product of powers of known names and of nonzero numbers."""
    match tree:
        case Num(value):
            return value != 0
        case Sym(name):
            return name in known
        case Mul(left, right):
            return _product_of(left, known) and _product_of(right, known)
        case Pow(base, _) | Neg(base):
            return _product_of(base, known)
    return False


def cleared(condition: Cmp) -> Cmp:
    """Return a comparison of rational sides as one of polynomials.

    Where a denominator is zero the result may hold although the comparison is undefined.
    """
    left, right = ratio(condition.left), ratio(condition.right)
    if left.bottom == ONE == right.bottom:
        return Cmp(condition.op, left.top, right.top)
    difference = ratio(add(condition.left, neg(condition.right)))
    equation = condition.op in {"=", "!="}
    return Cmp(condition.op, difference.top if equation else signed(difference), ZERO)


def signed(value: Ratio) -> Expr:
    """Return a polynomial with the sign of a quotient: top times bottom."""
    return value.top if value.bottom == ONE else mul(value.top, value.bottom)


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
