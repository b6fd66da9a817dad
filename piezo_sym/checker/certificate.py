"""Certificates of laws decided by intervals: checked again, with bounds of the checker's own.

Input: a law, and the cases of its certificate.  Output: the reason why it does not hold, or none.
A case holds where its guards do; there the law is a sum of terms, each prefactor*f(s) with letter =
scale*s; cvc5 answers that the cases cover the domain and for the prefactor's sign.  That f(s)*s has
that sign is shown on windows: Taylor series by FLINT at the left end, their remainder on the whole
of it; a window to infinity is left to cvc5, far out, where coarse bounds of functions are enough.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from typing import Any

from flint import arb, arb_series, ctx

from .field import Field
from .laws import KINKED, InputError, Node, compare, negated, num, parse, parse_law, put
from .laws import sym, symbols, unkinked
from .point import CannotTell, NoValue, compute, exact
from .prover import Prover
from .spec import Element, Spec

BITS, ORDER, MOST_WINDOWS, MOST_CASES, FARTHEST = 192, 10, 4000, 64, 2**12
NARROWEST = Fraction(1, 2**20)
S = sym("s")


def check_certificate(spec: Spec, element: Element, cases: Any, prover: Prover) -> str:
    """Return why a certificate does not show that a law takes power in, or nothing."""
    try:
        return _Certificate(spec, element, prover).check(cases)
    except (KeyError, TypeError, AttributeError, ValueError, NoValue, CannotTell) as error:
        return f"its certificate cannot be read: {type(error).__name__} {error}"


class _Certificate:
    def __init__(self, spec: Spec, element: Element, prover: Prover) -> None:
        self.law, self.prover, self.left = element.law or num(0), prover, MOST_WINDOWS
        self.tails = Prover(())
        self.letter = sym(("z", element.name))
        field = next(reversed(element.laws))
        letters = (element.kind.laws.get(field) or element.kind.laws[f"{field}?"])[1]
        self.words = {word: sym(s) for word, s in spec.words.items() if s[0] in "pT"}
        self.words[letters.split()[0]] = self.letter

    def read(self, text: str) -> Node:
        """Return a text of the certificate in the symbols of the spec."""
        tree = parse(text)
        for name in symbols(tree):
            if name not in self.words:
                raise InputError(f"its certificate has the unknown name {str(name)[:40]!r}")
        return put(tree, self.words)

    def check(self, cases: Any) -> str:
        """Return why the cases do not show it."""
        if not isinstance(cases, list) or len(cases) > MOST_CASES:
            return "its certificate has no cases, or too many"
        guards = [tuple(self.read(text) for text in case["guards"]) for case in cases]
        if any(self.letter.value in symbols(g) or g.op != "cmp" for own in guards for g in own):
            return "a guard is no comparison free of the letter"
        if not self._cover(guards, ()):
            return "the cases are not shown to cover the domain"
        reasons = (self._case(own, case["terms"]) for own, case in zip(guards, cases, strict=True))
        return next(filter(None, reasons), "")

    def _cover(self, guards: list[tuple[Node, ...]], missed: tuple[Node, ...]) -> bool:
        """Return whether one case holds everywhere: no choice of a missed guard of each is left."""
        if not guards:
            return self.prover.proves(compare(num(1), "<", 0), missed)
        return all(self._cover(guards[1:], (*missed, negated(guard))) for guard in guards[0])

    def _case(self, guards: tuple[Node, ...], terms: Any) -> str:
        laws = [self.read(term["law"]) for term in terms]
        field = Field(self._positive(guards))
        law = self._decided(self.law, guards)
        total = self._decided(Node("+", (num(0), *laws)), guards)
        if not field.is_zero(field.of(law) - field.of(total)):
            return "its terms are not shown to make up the law"
        reasons = (self._term(law, term, guards) for law, term in zip(laws, terms, strict=True))
        return next(filter(None, reasons), "")

    def _positive(self, guards: tuple[Node, ...]) -> set[Any]:
        """Return the symbols that are positive where guards hold."""
        given = [s for s in symbols(Node("+", (self.law, *guards))) if s != self.letter.value]
        return {s for s in given if self.prover.proves(compare(sym(s), ">", 0), guards)}

    def _decided(self, tree: Node, guards: tuple[Node, ...]) -> Node:
        """Return a tree without the choices that guards decide."""
        if tree.op in KINKED and self.letter.value not in symbols(tree):
            return self._decided(unkinked(tree), guards)
        args = tuple(self._decided(arg, guards) for arg in tree.args)
        if tree.op == "if" and self.letter.value not in symbols(tree.args[0]):
            for side, branch in ((tree.args[0], args[1]), (negated(tree.args[0]), args[2])):
                if self.prover.proves(side, guards):
                    return branch
        return Node(tree.op, args, tree.value)

    def _term(self, law: Node, term: Mapping[str, Any], guards: tuple[Node, ...]) -> str:
        """Return why law*letter >= 0 is not shown of one summand."""
        front, f, way = self.read(term["prefactor"]), parse_law(term["f"]), term["sign"]
        if set(symbols(f)) - {"s"} or way not in (1, -1):
            return "f is not of s alone, or it has no sign"
        scale = num(1)
        for text, power in term["scale"].items():
            base = self.read(text)
            if self.letter.value in symbols(base) or not self.prover.proves(compare(base, ">", 0), guards):
                return f"the scale {text[:40]!r} is not shown to be positive"
            scale = Node("*", (scale, Node("**", (base,), Fraction(power))))
        field = Field(self._positive(guards))
        letter = {self.letter.value: Node("*", (scale, S))}
        made = Node("*", (put(front, letter), f))
        if not field.is_zero(field.of(self._decided(put(law, letter), guards)) - field.of(self._decided(made, guards))):
            return "a term is not shown to be prefactor*f(s)"
        if not self.prover.proves(compare(front, ">=" if way > 0 else "<=", 0), guards):
            return "the sign of a prefactor is not shown"
        return self._rays(Node("*", (num(way), f)), term["rays"])

    # f(s)*s on the whole line

    def _rays(self, f: Node, rays: Any) -> str:
        """Return why f(s)*s >= 0 is not shown for all real s: on windows that cover them."""
        before, ctx.prec, ctx.cap = (ctx.prec, ctx.cap), BITS, ORDER + 1
        try:
            covered: list[tuple[Any, Any]] = []
            for ray in rays:
                centre, side = Fraction(ray["centre"]), ray["side"]
                if side not in (1, -1) or not _at(f, centre):
                    return f"f is not shown to have its sign at {centre}"
                for lo, hi, _ in ray["windows"]:
                    window = Fraction(lo), None if hi == "inf" else Fraction(hi)
                    if not self._window(f, centre, side, *window):
                        return f"f is not shown to have its sign from {lo} to {hi} of {centre}"
                    ends = [None if t is None else centre + side * t for t in window]
                    covered.append((ends[0], ends[1]) if side > 0 else (ends[1], ends[0]))
            return "" if _is_line(covered) else "the windows do not cover the line"
        finally:
            ctx.prec, ctx.cap = before

    def _window(
        self, f: Node, centre: Fraction, side: int, lo: Fraction, hi: Fraction | None
    ) -> bool:
        """Return whether f(s)*s >= 0 for s = centre + side*t, lo <= t <= hi."""
        s = Node("+", (num(centre), Node("*", (num(side), S)))) if centre or side < 0 else S
        moved = put(f, {"s": s})
        g, pieces = Node("*", (moved, s)), [(lo, hi)]
        while pieces:
            self.left -= 1
            a, b = pieces.pop()
            if self.left < 0 or a < 0:
                return False
            if b is None:
                far = compare(S, ">=", num(a)), compare(Node("*", (num(side), moved)), ">=", 0)
                if a > abs(centre) and self.tails.proves(far[1], far[:1]):
                    continue
                if a >= FARTHEST:
                    return False
                pieces += [(max(2 * a, Fraction(1)), None), (a, max(2 * a, Fraction(1)))]
            elif not (_at(f, centre + side * a) and _shown(g, a, b)):
                if b - a < NARROWEST * max(b, 1):
                    return False
                pieces += [((a + b) / 2, b), (a, (a + b) / 2)]
        return True


class _Jet:
    """A function of t on lo < t <= hi: Taylor series at lo and, of each of its orders, on all of it."""

    def __init__(self, left: Any, whole: Any, width: Any) -> None:
        self.left, self.whole, self.width = left, whole, width

    def _with(self, left: Any, whole: Any) -> _Jet:
        if not all(c.is_finite() for c in [*left.coeffs(), *whole.coeffs()]):
            raise CannotTell
        return _Jet(left, whole, self.width)

    def _both(self, made: Any, other: Any = None) -> _Jet:
        pairs = (other.left, other.whole) if isinstance(other, _Jet) else (other, other)
        try:
            return self._with(made(self.left, pairs[0]), made(self.whole, pairs[1]))
        except (ValueError, ZeroDivisionError):
            raise CannotTell from None

    def __add__(self, other: Any) -> _Jet:
        return self._both(lambda a, b: a + b, other)

    def __sub__(self, other: Any) -> _Jet:
        return self._both(lambda a, b: a - b, other)

    def __neg__(self) -> _Jet:
        return self._both(lambda a, _: -a)

    def __mul__(self, other: Any) -> _Jet:
        return self._both(lambda a, b: a * b, other)

    def __truediv__(self, other: Any) -> _Jet:
        return self._both(lambda a, b: a / b, other)

    def __rtruediv__(self, other: Any) -> _Jet:
        return self._both(lambda a, b: b / a, other)

    def __pow__(self, power: int) -> _Jet:
        made = self * 0 + 1
        for _ in range(power):
            made = made * self
        return made

    __radd__, __rmul__ = __add__, __mul__

    def __rsub__(self, other: Any) -> _Jet:
        return -self + other

    def __abs__(self) -> Any:
        return abs(_coefficient(self.whole, 0))

    def is_finite(self) -> bool:
        """Return whether it has values on the window; else it is not made."""
        return True

    def root(self, order: int) -> _Jet:
        """Return a root, of what is positive."""
        return self._both(lambda a, _: a.sqrt() if order == 2 else (a.log() / order).exp())

    def __getattr__(self, name: str) -> Any:
        if name == "tanh":
            return lambda: 1 - 2 / ((2 * self).exp() + 1)
        if name not in ("exp", "log", "sin", "cos"):
            raise AttributeError(name)
        return lambda: self._both(lambda a, _: getattr(a, name)())

    def _hull(self, other: Any, which: str) -> _Jet:
        ends = _coefficient(self.whole, 0), _coefficient(getattr(other, "whole", other), 0)
        value = arb_series([getattr(ends[0], which)(ends[1])], prec=1)
        return self._with(value, value)

    def min(self, other: Any) -> _Jet:
        """Return the smaller value; no more is known of it than where it lies."""
        return self._hull(other, "min")

    def max(self, other: Any) -> _Jet:
        """Return the larger value."""
        return self._hull(other, "max")

    def __gt__(self, other: Any) -> bool:
        return (self - other).lies(lambda x: x > 0)

    def __lt__(self, other: Any) -> bool:
        return (other - self).lies(lambda x: x > 0)

    def __eq__(self, other: object) -> bool:
        return all(c == 0 for c in (self - other).whole.coeffs())

    __hash__ = None  # type: ignore[assignment]

    def lies(self, above: Any) -> bool:
        """Return whether the values on the window are above zero in a sense."""
        if above(_coefficient(self.whole, 0)):
            return True
        size = min(self.whole.prec, self.left.prec)
        zeros = next((k for k in range(size) if not _coefficient(self.left, k) == 0), size)
        step = arb(self.width / 2, self.width / 2)
        for order in range(zeros, size):
            total = _coefficient(self.whole, order)
            for k in reversed(range(zeros, order)):
                total = _coefficient(self.left, k) + step * total
            if above(total):
                return True
        return False


def _coefficient(series: Any, k: int) -> Any:
    if not isinstance(series, arb_series):
        return arb(series) if k == 0 else arb(0)
    return series[k]


def _at(f: Node, s: Fraction) -> bool:
    """Return whether f(s)*s >= 0 at a number."""
    try:
        return bool(compute(Node("*", (f, S)), {"s": exact(s)}) >= 0)
    except (CannotTell, NoValue):
        return False


def _shown(g: Node, lo: Fraction, hi: Fraction) -> bool:
    """Return whether g(t) >= 0 for lo < t <= hi."""
    width = arb(exact(hi - lo))
    ends = arb(exact(lo)), arb(exact(lo)) + arb(width / 2, width / 2)
    left, whole = (arb_series([end, 1], prec=ORDER + 1) for end in ends)
    try:
        found = compute(g, {"s": _Jet(left, whole, width)})
    except (CannotTell, NoValue):
        return False
    return found.lies(lambda x: x >= 0) if isinstance(found, _Jet) else bool(found >= 0)


def _is_line(covered: list[tuple[Any, Any]]) -> bool:
    """Return whether closed intervals (None: infinity) cover the real line."""
    covered = sorted(covered, key=lambda c: (c[0] is not None, c[0] or 0))
    if not covered or covered[0][0] is not None:
        return False
    reached = covered[0][1]
    for lo, hi in covered[1:]:
        if reached is None or lo is None or lo > reached:
            break
        reached = None if hi is None else max(reached, hi)
    return reached is None
