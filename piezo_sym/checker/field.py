"""Laws as rational functions over atoms, in a normal form: equal forms are equal functions.

Input: trees, and the values of their symbols.  Output: `Ratio`, a reduced quotient of polynomials.
Symbols and functions (of normal arguments) are atoms; a choice ``a if c else b`` is ``[c]*a +
(1 - [c])*b`` with an atom [c] = [c]**2; positive factors are removed from comparisons and taken out
of roots.  An identity holds wherever both sides have values; divisors in branches that are not
taken do not matter.
"""

from collections.abc import Callable
from fractions import Fraction
from functools import reduce
from math import comb, prod
from typing import Any, TypeAlias, cast

from flint import fmpq, fmpq_mpoly_ctx

from .functions import KINKS
from .laws import ARITHMETIC, InputError, Node, compare, need, negated, num, unkinked, walk

SIZE, MAX_TERMS, MAX_PRODUCT, MAX_SIDES, MAX_POWER = 160, 3000, 60_000, 256, 16
CTX = fmpq_mpoly_ctx.get([f"x{n}" for n in range(SIZE)], "lex")
UNIT = CTX.constant(1)


class Ratio:
    """A reduced quotient of two polynomials, the lower one with leading coefficient 1."""

    def __init__(self, top: Any, bottom: Any = UNIT) -> None:
        if not bottom.is_one():
            need(not bottom.is_zero(), "a divisor is zero by its form")
            shared = top.gcd(bottom)
            top, bottom = top / shared, bottom / shared
            top, bottom = (part / bottom.leading_coefficient() for part in (top, bottom))
        self.top, self.bottom = top, bottom

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
        return self * Ratio(other.bottom, other.top)

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


def _product(left: Any, right: Any) -> Any:
    need(len(left) * len(right) <= MAX_PRODUCT, "a product is too large to be written out")
    return left * right


def constant(value: int | Fraction) -> Ratio:
    """Return a number."""
    return Ratio(CTX.constant(fmpq(value.numerator, value.denominator)))


ZERO, ONE = constant(0), constant(1)
Told: TypeAlias = Callable[[Node], Any]


class Field:
    """The atoms of one comparison; `known` decides whether a comparison always holds.

    Positive factors are removed from comparisons only if `scales`: some depend on a bank's size.
    """

    def __init__(self, known: Told = lambda _: False, *, scales: bool = False) -> None:
        self.atoms, self.known, self.scales = dict[Any, tuple[int, Node]](), known, scales
        # polynomials that are zero, by their atom: c**2 - c of a choice, r**n - base of a root.
        # `sums` has those of roots of sums: as they share symbols, the remainder after several
        # divisions depends on their order, so each is tried alone, after all others
        self.relations, self.sums = dict[Ratio, Any](), dict[Ratio, Any]()
        self.nonzero = set[Ratio]()  # factors that are zero nowhere, whatever branch is taken

    def atom(self, key: Any, tree: Node) -> Ratio:
        """Return an atom, the same for the same key."""
        place, _ = self.atoms.setdefault(key, (len(self.atoms), tree))
        need(place < SIZE, f"more than {SIZE} different symbols and functions")
        return Ratio(CTX.gen(place))

    def of(self, node: Node, words: Told | None = None) -> Ratio:
        """Return the normal form of a tree; `words` returns those of its symbols and sums."""
        if node.op == "num":
            return constant(node.value)
        if node.op in ("sym", "sum"):
            return words(node) if words else self.atom(("symbol", node.value), node)
        if node.op in KINKS and node.op != "table":  # the sum of its pieces would be long
            return self.of(unkinked(node), words)
        if node.op == "if":
            for n, side in ((1, node.args[0]), (2, negated(node.args[0]))):
                if self.known(side):
                    return self.of(node.args[n], words)
            then, other = (self.of(branch, words) for branch in node.args[1:])
            chosen = ZERO if then == other else self._choice(node.args[0], words)
            return other + chosen * (then - other)
        args = [self.of(arg, words) for arg in node.args]
        if node.op == "**":
            power = Fraction(node.value)
            whole = power.denominator == 1 or args[0] == ZERO
            root = args[0] if whole else self._root(args[0], power.denominator)
            return (root if power >= 0 else self._inverse(root)) ** abs(power.numerator)
        if node.op == "/":
            return args[0] * self._inverse(args[1])
        if node.op in ARITHMETIC:
            return cast("Ratio", ARITHMETIC[node.op](*args))
        if args[0] == ZERO and node.op not in ("log", "table"):
            return ONE if node.op in ("exp", "cos", "cosh") else ZERO
        return self._exp(args[0]) if node.op == "exp" else self.atom((node.op, *args), node)

    def _exp(self, ratio: Ratio) -> Ratio:
        """Return exp(a + 3*b) as exp(a)*exp(b)**3, each factor an atom (a large power is one)."""
        found = ONE
        for powers, factor in ratio.top.to_dict().items():
            n, term = int(factor.p), Ratio(CTX.from_dict({powers: fmpq(1, factor.q)}), ratio.bottom)
            n, term = (n, term) if abs(n) <= MAX_POWER else (1, term * constant(n))
            found *= self.atom(("exp", term), Node("exp", (self.tree(term),))) ** n
        return found

    def _choice(self, condition: Node, words: Told | None) -> Ratio:
        """Return the atom [difference > 0], or 1 minus the atom of the opposite."""
        less = condition.value in ("<", ">=")
        left, right = condition.args[::-1] if less else condition.args
        found = self.scaled(self.of(left, words) - self.of(right, words))
        fixed = all(part.op not in ("sym", "sum") for part in walk(condition))
        if fixed and found.top.is_constant() and found.bottom.is_one():
            found = ONE if found != ZERO and found.top.leading_coefficient() > 0 else ZERO
        else:
            tree = Node("if", (compare(self.tree(found), ">"), num(1), num(0)))
            found = self.atom(("choice", found), tree)
            self.relations[found] = found.top**2 - found.top
        return found if condition.value in "<>" else ONE - found

    def _inverse(self, ratio: Ratio) -> Ratio:
        """Return 1/ratio; the inverse of a factor that choices or roots could make zero is an atom.

        Such a factor must not cancel.
        """
        plain = self._reduced(ratio.top) if self._places(ratio.top) else ratio.top
        if ratio == ZERO or not self._places(plain):  # of zero, all degrees are -1
            return ONE / Ratio(plain, ratio.bottom)
        size, factors = ratio.top.factor()
        found = Ratio(ratio.bottom / size)
        for own, times in ((Ratio(factor), times) for factor, times in factors):
            tree = Node("/", (num(1), self._tree(own.top)))
            hidden = own not in self.nonzero and self._vanishes(own.top)
            part = self.atom(("/", own), tree) if hidden else ONE / own
            found = found * part**times
        return found

    def _places(self, polynomial: Any) -> list[int]:
        """Return the indices of the atoms in a polynomial that have a relation."""
        places = [n for n, power in enumerate(polynomial.degrees()) if power]
        return [n for n in places if Ratio(CTX.gen(n)) in self.relations]

    def _vanishes(self, factor: Any) -> bool:
        """Return whether the values of choices, or roots in a sum, could make a factor zero."""
        keys, sides = list(self.atoms), [factor]
        for place in self._places(factor):
            if keys[place][0] != "choice":
                return len(factor) > 1
            need(len(sides) < MAX_SIDES, "a divisor has too many choices")
            sides = [part.subs({f"x{place}": side}) for part in sides for side in (0, 1)]
        return any(part.is_zero() for part in sides)

    def _root(self, base: Ratio, power: int) -> Ratio:
        """Return a root with positive factors taken out of it."""
        outside = ONE
        for factor, times in self._positive(base):
            root = self._simple(factor, power) if times % power else factor
            outside = outside * root ** (times if times % power else times // power)
            base = base / factor**times
        return outside if base == ONE else outside * self._simple(base, power)

    def _simple(self, base: Ratio, power: int) -> Ratio:
        """Return a root as an atom, with its relation; other bases than one term are `sums`."""
        found = self.atom((power, base), Node("**", (self.tree(base),), Fraction(1, power)))
        keys, parts = list(self.atoms), (base.top, base.bottom)
        chosen = any(keys[n][0] == "choice" for part in parts for n in self._places(part))
        plain = len(base.top) == len(base.bottom) == 1 and not chosen
        (self.relations if plain else self.sums)[found] = found.top**power * base.bottom - base.top
        return found

    def _positive(self, ratio: Ratio) -> list[tuple[Ratio, int]]:
        """Return the factors f or -f known to be positive, and their powers."""
        parts = [(ratio.top, 1), (ratio.bottom, -1)] if ratio != ZERO else []
        factors = [(f, sign * times) for part, sign in parts for f, times in part.factor()[1]]
        both = [(own, times) for f, times in factors for own in (f, -f)]
        return [(Ratio(f), n) for f, n in both if self.known(compare(self._tree(f), ">"))]

    def scaled(self, ratio: Ratio) -> Ratio:
        """Return an expression of the same sign without positive factors, if `scales`."""
        if not self.scales or ratio == ZERO:
            return ratio
        size = Ratio(CTX.constant(abs(ratio.top.leading_coefficient())))
        return ratio / prod((part**n for part, n in self._positive(ratio)), start=size)

    def same(self, one: Node, other: Node) -> bool:
        """Return whether two trees are shown to be the same function."""
        try:
            return self.is_zero(self.of(one) - self.of(other))
        except InputError:
            return False

    def is_zero(self, ratio: Ratio) -> bool:
        """Return whether an expression vanishes by the relations of choices and roots."""
        rest, sums = self._reduced(ratio.top), map(self._reduced, self.sums.values())
        return bool(rest == 0) or any(divmod(rest, zero)[1] == 0 for zero in sums if zero != 0)

    def _reduced(self, polynomial: Any) -> Any:
        """Return a polynomial less multiples of what is zero by the relations."""
        return reduce(lambda top, zero: divmod(top, zero)[1], self.relations.values(), polynomial)

    def tree(self, ratio: Ratio) -> Node:
        """Return an expression as a tree of its atoms."""
        return Node("/", (self._tree(ratio.top), self._tree(ratio.bottom)))

    def _tree(self, polynomial: Any) -> Node:
        terms, atoms = [], [tree for _, tree in self.atoms.values()]
        for powers, factor in polynomial.to_dict().items():
            raised = (Node("**", (atoms[n],), Fraction(int(p))) for n, p in enumerate(powers) if p)
            size = num(Fraction(int(factor.p), int(factor.q)))
            terms.append(reduce(lambda tree, part: Node("*", (tree, part)), raised, size))
        return Node("+", tuple(terms) or (num(0),))
