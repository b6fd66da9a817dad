"""Laws as rational functions over atoms, in a normal form: what has the same form is equal.

Input: trees, and what each symbol stands for.  Output: `Ratio`, a reduced quotient of FLINT's
polynomials.  Symbols and functions (of normal arguments) are atoms; a choice ``a if c else b`` is
``[c]*a + (1 - [c])*b`` with an atom [c] of which [c]**2 = [c]; positive factors leave comparisons
and roots.  An identity between atoms holds wherever both sides have values.
"""

from collections.abc import Callable
from fractions import Fraction
from math import comb
from typing import Any

from flint import fmpq, fmpq_mpoly_ctx

from . import laws
from .laws import ARITHMETIC, InputError, Node, compare, need, negated, num, symbols

SIZE, MAX_TERMS, MAX_PRODUCT = 160, 3000, 60_000
CTX = fmpq_mpoly_ctx.get([f"x{n}" for n in range(SIZE)], "lex")


class _Ratio:
    """A reduced quotient of two polynomials, the lower one with leading coefficient 1."""

    def __init__(self, top: Any, bottom: Any = None) -> None:
        if bottom is not None and not bottom.is_one():
            need(not bottom.is_zero(), "a divisor is zero by its form")
            shared = top.gcd(bottom) * bottom.leading_coefficient()
            top, bottom = top / shared, bottom / shared
            top, bottom = (part / bottom.leading_coefficient() for part in (top, bottom))
        self.top, self.bottom = top, CTX.constant(1) if bottom is None else bottom

    def __add__(self, other: "Ratio") -> "Ratio":
        if self.bottom == other.bottom:
            return Ratio(self.top + other.top, self.bottom)
        tops = _product(self.top, other.bottom) + _product(other.top, self.bottom)
        return Ratio(tops, _product(self.bottom, other.bottom))

    def __neg__(self) -> "Ratio":
        return Ratio(-self.top, self.bottom)

    def __sub__(self, other: "Ratio") -> "Ratio":
        return self + -other

    def __mul__(self, other: "Ratio") -> "Ratio":
        return Ratio(_product(self.top, other.top), _product(self.bottom, other.bottom))

    def __truediv__(self, other: "Ratio") -> "Ratio":
        return Ratio(_product(self.top, other.bottom), _product(self.bottom, other.top))

    def __pow__(self, power: int) -> "Ratio":
        if power < 0:
            return Ratio(self.bottom, self.top) ** -power
        terms = max(len(self.top), len(self.bottom))
        need(terms < 2 or comb(terms + power, power) <= MAX_TERMS, "a power is too large")
        return Ratio(self.top**power, self.bottom**power)

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Ratio):
            return bool(self.top == other.top and self.bottom == other.bottom)
        return bool(self.bottom.is_one() and self.top == other)

    def __hash__(self) -> int:
        return hash((str(self.top), str(self.bottom)))


Ratio = _Ratio


def _product(left: Any, right: Any) -> Any:
    need(len(left) * len(right) <= MAX_PRODUCT, "a product is too large to be written out")
    return left * right


def constant(value: int | Fraction) -> Ratio:
    """Return a number."""
    return Ratio(CTX.constant(fmpq(value.numerator, value.denominator)))


class Field:
    """The atoms of one comparison; `known` tells of comparisons whether they always hold.

    Without it no comparison is scaled: factors that depend on the size of a bank stay.
    """

    def __init__(self, known: Callable[[Node], bool] | None = None) -> None:
        self.atoms, self.trees, self.scales = dict[Any, int](), list[Node](), known is not None
        self.known = known or (lambda _: False)
        #: Atoms a of which a**power = b: choices are their own square, roots of an atom.
        self.powers: dict[int, tuple[int, int]] = {}

    def atom(self, key: Any, tree: Node) -> Ratio:
        """Return an atom, the same for the same key."""
        if key not in self.atoms:
            self.atoms[key] = len(self.trees)
            need(len(self.trees) < SIZE, f"more than {SIZE} different symbols and functions")
            self.trees.append(tree)
        return Ratio(CTX.gen(self.atoms[key]))

    def of(self, node: Node, words: Callable[[Any], Ratio] | None = None) -> Ratio:
        """Return the normal form of a tree, `words` giving that of its symbols."""
        if node.op == "num":
            return constant(node.value)
        if node.op == "sym":
            return words(node.value) if words else self.atom(("symbol", node.value), node)
        if node.op in laws.KINKS:
            return self.of(laws.unkinked(node), words)
        if node.op == "if":
            sides = (node.args[0], negated(node.args[0]))
            for side, branch in zip(sides, node.args[1:], strict=True):
                if self.known(side):
                    return self.of(branch, words)
            then, other = (self.of(arg, words) for arg in node.args[1:])
            chosen = constant(0) if then == other else self._choice(node.args[0], words)
            return other + chosen * (then - other)
        args = [self.of(arg, words) for arg in node.args]
        if node.op == "**":
            power = Fraction(node.value)
            root = args[0] if power.denominator == 1 else self._root(args[0], power.denominator)
            return root**power.numerator
        if node.op in ARITHMETIC:
            found: Ratio = ARITHMETIC[node.op](*args)
            return found
        if args[0] == 0 and node.op != "log":
            return constant(int(node.op in ("exp", "cos")))
        return self.atom((node.op, *args), node)

    def _choice(self, condition: Node, words: Callable[[Any], Ratio] | None) -> Ratio:
        """Return the atom [difference > 0], or 1 less that of its opposite."""
        less = condition.value in ("<", ">=")
        left, right = condition.args[::-1] if less else condition.args
        found = self.scaled(self.of(left, words) - self.of(right, words))
        if not symbols(condition) and found.top.is_constant() and found.bottom.is_one():
            found = constant(int(found != 0 and found.top.leading_coefficient() > 0))
        else:
            key = ("choice", found)
            found = self.atom(key, Node("if", (compare(left, ">", right), num(1), num(0))))
            self.powers.setdefault(self.atoms[key], (2, self.atoms[key]))
        return found if condition.value in "<>" else constant(1) - found

    def _root(self, base: Ratio, power: int) -> Ratio:
        """Return a root, positive factors being taken out of it."""
        outside = constant(1)
        for factor, times in self._positive(base):
            root = self._simple(factor, power) if times % power else factor
            outside = outside * root ** (times if times % power else times // power)
            base = base / factor**times
        return outside if base == 1 else outside * self._simple(base, power)

    def _simple(self, base: Ratio, power: int) -> Ratio:
        """Return a root as an atom, of which a power is known if it is one of an atom."""
        key = power, base
        found = self.atom(key, Node("**", (self.tree(base),), Fraction(1, power)))
        single = len(base.top) == base.top.total_degree() == base.top.leading_coefficient() == 1
        if base.bottom.is_one() and single:
            self.powers[self.atoms[key]] = power, [*map(int, base.top.monoms()[0])].index(1)
        return found

    def _positive(self, ratio: Ratio) -> list[tuple[Ratio, int]]:
        """Return the factors known to be positive, if need be with a minus, and their powers."""
        parts = [(ratio.top, 1), (ratio.bottom, -1)] if self.scales and ratio != 0 else []
        factors = [(f, sign * times) for part, sign in parts for f, times in part.factor()[1]]
        both = [(own, times) for f, times in factors for own in (f, -f)]
        return [(Ratio(f), n) for f, n in both if self.known(compare(self._tree(f), ">"))]

    def scaled(self, ratio: Ratio) -> Ratio:
        """Return an expression without its positive factors, of the same sign."""
        factor = constant(1)
        if self.scales and ratio != 0:
            factor *= Ratio(CTX.constant(abs(ratio.top.leading_coefficient())))
        for part, times in self._positive(ratio):
            factor = factor * part**times
        return ratio / factor

    def is_zero(self, ratio: Ratio) -> bool:
        """Return whether an expression vanishes, powers of choices and roots being reduced."""
        total: dict[Any, Any] = {}
        for monomial, factor in ratio.top.to_dict().items():
            powers = [int(power) for power in monomial]
            for place, (power, base) in reversed(self.powers.items()):
                while powers[place] >= power:
                    powers[place] -= power
                    powers[base] += 1
            total[tuple(powers)] = total.get(tuple(powers), 0) + factor
        return not any(total.values())

    def same(self, one: Node, other: Node) -> bool:
        """Return whether two trees are the same function, and not too large to be told."""
        try:
            return self.is_zero(self.of(one) - self.of(other))
        except InputError:
            return False

    def tree(self, ratio: Ratio) -> Node:
        """Return an expression as a tree of its atoms."""
        return Node("/", (self._tree(ratio.top), self._tree(ratio.bottom)))

    def _tree(self, polynomial: Any) -> Node:
        terms = []
        for powers, factor in polynomial.to_dict().items():
            tree = num(Fraction(int(factor.p), int(factor.q)))
            for place, power in enumerate(powers):
                if power:
                    tree = Node("*", (tree, Node("**", (self.trees[place],), Fraction(int(power)))))
            terms.append(tree)
        return Node("+", tuple(terms))
