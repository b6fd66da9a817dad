"""Laws as rational functions over atoms, in a normal form: equal if and only if the same.

Input: trees, and what each symbol stands for.  Output: `Ratio`, a reduced quotient of FLINT's
polynomials.  Symbols and functions (of normal arguments) are atoms; a choice ``a if c else b`` is
``[c]*a + (1 - [c])*b`` with an atom [c] of which [c]**2 = [c].  An identity between atoms holds
wherever both sides have values.  Functions give up positive factors, signs and constants.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from fractions import Fraction
from math import comb
from typing import Any

from flint import fmpq, fmpq_mpoly_ctx

from .laws import Node, compare, need, num, sym

SIZE, MAX_TERMS, MAX_PRODUCT = 160, 3000, 60_000
HOMOGENEOUS = ("abs", "min", "max", "deadzone", "saturate", "sign")
CTX = fmpq_mpoly_ctx.get([f"x{n}" for n in range(SIZE)], "lex")


class _Ratio:
    """A reduced quotient of two polynomials, the lower one with leading coefficient 1."""

    __slots__ = ("bottom", "top")

    def __init__(self, top: Any, bottom: Any = None) -> None:
        if bottom is not None and not bottom.is_one():
            need(not bottom.is_zero(), "a divisor is zero by its form")
            shared = top.gcd(bottom)
            top, bottom = top / shared, bottom / shared
            lead = bottom.leading_coefficient()
            top, bottom = top / lead, bottom / lead
        self.top, self.bottom = top, CTX.constant(1) if bottom is None else bottom

    def __add__(self, other: _Ratio) -> _Ratio:
        if self.bottom == other.bottom:
            return _Ratio(self.top + other.top, self.bottom)
        tops = _product(self.top, other.bottom) + _product(other.top, self.bottom)
        return _Ratio(tops, _product(self.bottom, other.bottom))

    def __neg__(self) -> _Ratio:
        return self * constant(-1)

    def __sub__(self, other: _Ratio) -> _Ratio:
        return self + -other

    def __mul__(self, other: _Ratio) -> _Ratio:
        return _Ratio(_product(self.top, other.top), _product(self.bottom, other.bottom))

    def __truediv__(self, other: _Ratio) -> _Ratio:
        return _Ratio(_product(self.top, other.bottom), _product(self.bottom, other.top))

    def __pow__(self, power: int) -> _Ratio:
        if power < 0:
            return _Ratio(self.bottom, self.top) ** -power
        terms = max(len(self.top), len(self.bottom))
        need(terms < 2 or comb(terms + power, power) <= MAX_TERMS, "a power is too large")
        return _Ratio(self.top**power, self.bottom**power)

    def __eq__(self, other: object) -> bool:
        if isinstance(other, _Ratio):
            return bool(self.top == other.top and self.bottom == other.bottom)
        return bool(self.bottom.is_one() and self.top == other)

    def __hash__(self) -> int:
        return hash((str(self.top), str(self.bottom)))

    @property
    def number(self) -> Fraction | None:
        """Its value if it is a number."""
        if not (self.top.is_constant() and self.bottom.is_one()):
            return None
        return _fraction(self.top.leading_coefficient()) if self.top != 0 else Fraction(0)


def _product(left: Any, right: Any) -> Any:
    need(len(left) * len(right) <= MAX_PRODUCT, "a product is too large to be written out")
    return left * right


def _fraction(number: Any) -> Fraction:
    return Fraction(int(number.p), int(number.q))


Ratio = _Ratio


def constant(value: int | Fraction) -> _Ratio:
    """Return a number."""
    return _Ratio(CTX.constant(fmpq(value.numerator, value.denominator)))


class Field:
    """The atoms of one comparison; `positive` are the symbols known to be so."""

    def __init__(self, positive: Collection[Any] = ()) -> None:
        self.atoms, self.trees = dict[Any, int](), list[Node]()
        self.positives, self.choices, self.positive = list[int](), list[int](), positive

    def atom(self, key: Any, tree: Node, positive: bool = False) -> _Ratio:
        """Return an atom, the same for the same key."""
        if key not in self.atoms:
            place = self.atoms[key] = len(self.trees)
            need(place < SIZE, f"more than {SIZE} different symbols and functions")
            self.trees.append(tree)
            self.positives += [place] * positive
            self.choices += [place] * (key[0] == "choice")
        return _Ratio(CTX.gen(self.atoms[key]))

    def symbol(self, key: Any) -> _Ratio:
        """Return the atom of a symbol."""
        return self.atom(("symbol", key), sym(key), key in self.positive)

    def of(self, node: Node, words: Callable[[Any], Ratio] | None = None) -> _Ratio:
        """Return the normal form of a tree, `words` giving that of its symbols."""
        if node.op in ("num", "sym"):
            return constant(node.value) if node.op == "num" else (words or self.symbol)(node.value)
        if node.op == "if":
            chosen = self._choice(node.args[0], words)
            then, other = (self.of(arg, words) for arg in node.args[1:])
            return then if then == other else other + chosen * (then - other)
        args = [self.of(arg, words) for arg in node.args]
        match node.op:
            case "+":
                return sum(args[1:], args[0])
            case "neg":
                return -args[0]
            case "*":
                return args[0] * args[1]
            case "/":
                return args[0] / args[1]
            case "**" | "sqrt":
                power = node.value if node.op == "**" else Fraction(1, 2)
                if power.denominator > 1:
                    root = Node("**", node.args, Fraction(1, power.denominator))
                    args = [self.atom((root.value, *args), root)]
                return args[0] ** power.numerator
        return self._function(node, args)

    def _choice(self, condition: Node, words: Callable[[Any], Ratio] | None) -> _Ratio:
        """Return the atom [difference > 0], or 1 less that of its opposite."""
        less = condition.value in ("<", ">=")
        left, right = condition.args[::-1] if less else condition.args
        found = self.scaled([self.of(left, words) - self.of(right, words)])[1][0]
        if found.number is None:
            tree = Node("if", (compare(left, ">", right), num(1), num(0)))
            found = self.atom(("choice", found), tree)
        else:
            found = constant(int(found.number > 0))
        return found if condition.value in "<>" else constant(1) - found

    def _function(self, node: Node, args: list[_Ratio]) -> _Ratio:
        """Return the atom of a function, times the positive factor that the function gives up."""
        if all(arg == 0 for arg in args):
            return constant(int(node.op in ("exp", "cos")))
        outside = constant(1)
        if node.op in HOMOGENEOUS:
            outside, args = self.scaled(args)
        found = self.atom((node.op, *args), node, node.op == "exp")
        return found if node.op == "sign" else outside * found

    def scaled(self, args: list[_Ratio]) -> tuple[Ratio, list[_Ratio]]:
        """Return the positive atoms that arguments share as a factor, and the arguments over it."""
        some, factor = [arg for arg in args if arg != 0], constant(1)
        for place in self.positives if some else ():
            powers = (_valuation(a.top, place) - _valuation(a.bottom, place) for a in some)
            factor = factor * _Ratio(CTX.gen(place)) ** min(powers)
        return factor, [arg / factor for arg in args]

    def is_zero(self, ratio: _Ratio) -> bool:
        """Return whether an expression vanishes, a choice being 0 or 1."""
        if not self.choices:
            return bool(ratio.top.is_zero())
        total: dict[Any, Any] = {}
        for powers, factor in ratio.top.to_dict().items():
            key = tuple(min(p, 1) if n in self.choices else p for n, p in enumerate(powers))
            total[key] = total.get(key, 0) + factor
        return not any(total.values())

    def same(self, one: Node, other: Node) -> bool:
        """Return whether two trees are the same function."""
        return self.is_zero(self.of(one) - self.of(other))

    def factors(self, ratio: _Ratio) -> list[Node]:
        """Return the factors above the line that are no numbers, as trees."""
        return [self._tree(part) for part, _ in ratio.top.factor()[1]]

    def _tree(self, polynomial: Any) -> Node:
        terms = []
        for powers, factor in polynomial.to_dict().items():
            tree = num(_fraction(factor))
            for place, power in enumerate(powers):
                if power:
                    tree = Node("*", (tree, Node("**", (self.trees[place],), Fraction(int(power)))))
            terms.append(tree)
        return Node("+", tuple(terms))


def _valuation(polynomial: Any, place: int) -> int:
    """Return the power of an atom that divides a polynomial."""
    return min((int(powers[place]) for powers in polynomial.monoms()), default=0)
