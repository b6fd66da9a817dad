"""Laws as rational functions over atoms, in a normal form: equal if and only if the same.

Input: trees, and what each symbol stands for.  Output: `Ratio`, a reduced quotient of FLINT's
polynomials.  Symbols and functions (of normal arguments) are atoms; a choice ``a if c else b`` is
``[c]*a + (1 - [c])*b`` with an atom [c] of which [c]**2 = [c].  An identity between atoms holds
wherever both sides have values.  Functions give up positive factors, signs and constants.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from fractions import Fraction
from math import comb
from typing import Any

from flint import fmpq, fmpq_mpoly_ctx

from .laws import Node, compare, num

SIZE, MAX_TERMS = 160, 3000
ODD, EVEN = ("sin", "tanh", "sign", "deadzone", "saturate"), ("cos", "abs")
HOMOGENEOUS = ("abs", "min", "max", "deadzone", "saturate")
CTX = fmpq_mpoly_ctx.get([f"x{n}" for n in range(SIZE)], "lex")
ONE, ZERO = CTX.constant(1), CTX.constant(0)


class TooLargeError(Exception):
    """An expression is beyond what is written out."""


class Ratio:
    """A reduced quotient of two polynomials, the lower one with leading coefficient 1."""

    __slots__ = ("bottom", "top")

    def __init__(self, top: Any, bottom: Any = ONE) -> None:
        if bottom.is_zero():
            raise ZeroDivisionError("a divisor is zero by its form")
        if not bottom.is_one():
            shared = top.gcd(bottom)
            top, bottom = top / shared, bottom / shared
            lead = bottom.leading_coefficient()
            top, bottom = top / lead, bottom / lead
        self.top, self.bottom = top, bottom

    def __add__(self, other: Ratio) -> Ratio:
        if self.bottom == other.bottom:
            return Ratio(self.top + other.top, self.bottom)
        tops = _product(self.top, other.bottom) + _product(other.top, self.bottom)
        return Ratio(tops, _product(self.bottom, other.bottom))

    def __neg__(self) -> Ratio:
        return Ratio(-self.top, self.bottom)

    def __sub__(self, other: Ratio) -> Ratio:
        return self + -other

    def __mul__(self, other: Any) -> Ratio:
        if not isinstance(other, Ratio):
            return Ratio(self.top * other, self.bottom)
        return Ratio(_product(self.top, other.top), _product(self.bottom, other.bottom))

    __rmul__ = __mul__

    def __truediv__(self, other: Ratio) -> Ratio:
        return Ratio(_product(self.top, other.bottom), _product(self.bottom, other.top))

    def __pow__(self, power: int) -> Ratio:
        if power < 0:
            return Ratio(self.bottom, self.top) ** -power
        if any(comb(len(p) + power - 1, power) > MAX_TERMS for p in (self.top, self.bottom)):
            raise TooLargeError("a power is too large to be written out")
        return Ratio(self.top**power, self.bottom**power)

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Ratio):
            return bool(self.top == other.top and self.bottom == other.bottom)
        return bool(self.bottom.is_one() and self.top == other)

    def __hash__(self) -> int:
        return hash((str(self.top), str(self.bottom)))


def _product(left: Any, right: Any) -> Any:
    if len(left) * len(right) > MAX_TERMS * 20:
        raise TooLargeError("a product is too large to be written out")
    return left * right


def constant(value: Any) -> Ratio:
    """Return a number."""
    ratio = Fraction(value)
    return Ratio(CTX.constant(fmpq(ratio.numerator, ratio.denominator)))


class Field:
    """The atoms of one comparison; `positive` tells which symbols are positive."""

    def __init__(self, positive: Callable[[Any], bool] = lambda _: False) -> None:
        self.atoms: dict[Any, int] = {}
        self.trees: list[Node] = []
        self.positives: list[int] = []
        self.choices: list[int] = []
        self.positive = positive

    def atom(self, key: Any, tree: Node, positive: bool = False) -> Ratio:
        """Return an atom, the same for the same key."""
        if key not in self.atoms:
            place = len(self.trees)
            if place == SIZE:
                raise TooLargeError(f"more than {SIZE} different symbols and functions")
            self.atoms[key] = place
            self.trees.append(tree)
            self.positives += [place] if positive else []
            self.choices += [place] if key[0] == "choice" else []
        return Ratio(CTX.gen(self.atoms[key]))

    def symbol(self, key: Any) -> Ratio:
        """Return the atom of a symbol."""
        return self.atom(("symbol", key), Node("sym", (), key), self.positive(key))

    def of(self, node: Node, words: Callable[[Any], Ratio]) -> Ratio:
        """Return the normal form of a tree, `words` giving that of its symbols."""
        if node.op == "num":
            return constant(node.value)
        if node.op == "sym":
            return words(node.value)
        if node.op == "if":
            chosen = self.choice(node.args[0], words)
            then, other = (self.of(arg, words) for arg in node.args[1:])
            return then if then == other else other + chosen * (then - other)
        args = [self.of(arg, words) for arg in node.args]
        if node.op == "+":
            return sum(args[1:], args[0])
        if node.op == "neg":
            return -args[0]
        if node.op in "*/":
            return args[0] * args[1] if node.op == "*" else args[0] / args[1]
        if node.op == "**" and node.value.denominator == 1:
            return args[0] ** node.value.numerator
        if node.op in ("**", "sqrt"):
            power = node.value if node.op == "**" else Fraction(1, 2)
            return self.root(args[0], power, node.args[0])
        return self.function(node, args)

    def choice(self, condition: Node, words: Callable[[Any], Ratio]) -> Ratio:
        """Return the atom [difference > 0], or 1 less that of its opposite."""
        left, right = (self.of(arg, words) for arg in condition.args)
        less = condition.value in ("<", ">=")
        difference = self.scaled([right - left if less else left - right])[1][0]
        sides = condition.args[::-1] if less else condition.args
        tree = Node("if", (compare(sides[0], ">", sides[1]), num(1), num(0)))
        if difference.top.is_constant() and difference.bottom.is_one():
            found = constant(int(difference.top.leading_coefficient() > 0)) if difference != 0 else constant(0)
        else:
            found = self.atom(("choice", difference), tree)
        return found if condition.value in "<>" else constant(1) - found

    def root(self, base: Ratio, power: Fraction, tree: Node) -> Ratio:
        """Return a power of a root; positive factors have roots of their own."""
        factor, (rest,) = self.scaled([base], numbers=False)
        found = constant(1)
        for place, exponent in factor:
            found = found * self.single(constant(0) + Ratio(CTX.gen(place)), self.trees[place], power * exponent)
        return found if rest == 1 else found * self.single(rest, tree, power)

    def single(self, base: Ratio, tree: Node, power: Fraction) -> Ratio:
        if power.denominator == 1:
            return base**power.numerator
        root = Fraction(1, power.denominator)
        return self.atom(("root", root, base), Node("**", (tree,), root), True) ** power.numerator

    def function(self, node: Node, args: list[Ratio]) -> Ratio:
        """Return the atom of a function, times what the function gives up."""
        name, outside = node.op, constant(1)
        if name in (*HOMOGENEOUS, "sign"):
            factor, args = self.scaled(args)
            for place, exponent in factor if name != "sign" else ():
                outside = outside * (constant(exponent) if place < 0 else Ratio(CTX.gen(place)) ** int(exponent))
        if all(arg == 0 for arg in args):
            return constant(int(name in ("exp", "cos")))
        turned = args[0] != 0 and args[0].top.leading_coefficient() < 0
        if name in (*ODD, *EVEN, "exp") and turned:
            args = [-args[0], *args[1:]]
            node = Node(name, (Node("neg", (node.args[0],)), *node.args[1:]))
        found = self.atom((name, *args), node, name == "exp")
        if turned and name == "exp":
            return constant(1) / found
        return (-outside if turned and name in ODD else outside) * found

    def scaled(self, args: list[Ratio], numbers: bool = True) -> tuple[list[tuple[int, Any]], list[Ratio]]:
        """Return the positive factor that arguments share, as powers of atoms, and the rest.

        A number among the factors has place -1 and stands for itself.
        """
        some = [arg for arg in args if arg != 0]
        factor: list[tuple[int, Any]] = []
        for place in self.positives if some else ():
            power = min(_valuation(a.top, place) - _valuation(a.bottom, place) for a in some)
            if power:
                factor.append((place, power))
                args = [arg * Ratio(CTX.gen(place)) ** -power for arg in args]
        if some and numbers:
            size = abs(next(a for a in args if a != 0).top.leading_coefficient())
            factor.append((-1, Fraction(int(size.p), int(size.q))))
            args = [arg * (1 / size) for arg in args]
        return factor, args

    def is_zero(self, ratio: Ratio) -> bool:
        """Return whether an expression vanishes, a choice being 0 or 1."""
        if ratio.top.is_zero() or not self.choices:
            return bool(ratio.top.is_zero())
        total: dict[Any, Any] = {}
        for powers, factor in ratio.top.to_dict().items():
            key = tuple(min(p, 1) if n in self.choices else p for n, p in enumerate(powers))
            total[key] = total.get(key, 0) + factor
        return not any(total.values())

    def factors(self, polynomial: Any) -> Iterable[Node]:
        """Return the factors of a polynomial that are no numbers, as trees."""
        return [self.tree(part) for part, _ in polynomial.factor()[1]]

    def tree(self, polynomial: Any) -> Node:
        """Return a polynomial as a tree."""
        terms = []
        for powers, factor in polynomial.to_dict().items():
            tree = num(Fraction(int(factor.p), int(factor.q)))
            for place, power in enumerate(powers):
                for _ in range(int(power)):
                    tree = Node("*", (tree, self.trees[place]))
            terms.append(tree)
        return Node("+", tuple(terms))


def _valuation(polynomial: Any, place: int) -> int:
    """Return the power of an atom that divides a polynomial."""
    return min((int(powers[place]) for powers in polynomial.monoms()), default=0)
