"""Certificates of laws decided by intervals: checked again, with bounds of the checker's own.

Input: a law, and the cases of its certificate.  Output: the reason why it does not hold, or none.
A case holds where its guards do; there the law is a sum of terms, each prefactor*f(s) with letter =
scale*s; cvc5 answers that the cases cover the domain, and for the prefactor's sign.  That f(s)*s
has that sign is shown on windows lo < t <= hi of s = centre + side*t: cvc5 settles the choices
there, FLINT gives the Taylor series at lo and its remainder.  A window to infinity is left to cvc5,
far out, where coarse bounds of functions are enough.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from flint import arb, arb_series, ctx

from .field import Field
from .laws import KINKS, Node, compare, made, need, negated, num, parse, put, sym, symbols, unkinked
from .numbers import CannotTell, NoValue, compute, exact
from .prover import Prover
from .spec import Element, Spec

BITS, ORDER, MOST_WINDOWS, MOST_CASES, FARTHEST = 192, 10, 3000, 64, 2**12
NARROWEST = Fraction(1, 2**20)
S, TANH = sym("s"), "1 - 2/(exp(2*x) + 1)"


def check_certificate(spec: Spec, element: Element, cases: Any, prover: Prover) -> str:
    """Return why a certificate does not show that a law takes power in, or nothing."""
    before, ctx.prec, ctx.cap = (ctx.prec, ctx.cap), BITS, ORDER + 1
    try:
        return _Certificate(spec, element, prover).check(cases)
    except (KeyError, TypeError, AttributeError, ValueError, ArithmeticError) as error:
        return f"its certificate cannot be read: {type(error).__name__} {error}"
    finally:
        ctx.prec, ctx.cap = before


class _Certificate:
    def __init__(self, spec: Spec, element: Element, prover: Prover) -> None:
        self.law, self.prover, self.left = element.law or num(0), prover, MOST_WINDOWS
        self.tails, self.letter = Prover(()), ("z", element.name)
        self.words = {word: sym(meaning) for word, meaning in spec.words.items()}
        self.words[element.letter] = sym(self.letter)

    def read(self, text: str) -> Node:
        """Return a text of the certificate in the symbols of the spec."""
        tree = parse(text)
        unknown = [name for name in symbols(tree) if name not in self.words]
        need(not unknown, f"its certificate has the unknown name {str(unknown)[:40]}")
        return put(tree, self.words)

    def check(self, cases: Any) -> str:
        few = isinstance(cases, list) and len(cases) <= MOST_CASES
        guards = [tuple(self.read(text) for text in case["guards"]) for case in cases if few]
        free = all(g.op == "cmp" and self.letter not in symbols(g) for own in guards for g in own)
        if not (few and free and self._cover(guards, ())):
            return "its cases are not shown to cover the domain"
        reasons = (self._case(own, case["terms"]) for own, case in zip(guards, cases, strict=True))
        return next(filter(None, reasons), "")

    def _cover(self, guards: list[tuple[Node, ...]], missed: tuple[Node, ...]) -> bool:
        """Return whether nowhere a guard of each case is missed."""
        if self.prover.proves(compare(num(1), "<"), missed):
            return True
        rest = guards[1:]
        return bool(guards) and all(self._cover(rest, (*missed, negated(g))) for g in guards[0])

    def _case(self, guards: tuple[Node, ...], terms: Any) -> str:
        laws = [self.read(term["law"]) for term in terms]
        total = Node("+", (num(0), *laws))
        if not self._same(self.law, total, guards):
            return "its terms are not shown to make up the law"
        reasons = (self._term(law, term, guards) for law, term in zip(laws, terms, strict=True))
        return next(filter(None, reasons), "")

    def _same(self, one: Node, other: Node, guards: tuple[Node, ...]) -> bool:
        """Return whether two laws are the same function where guards hold."""
        names = {s for tree in (one, other) for s in symbols(tree)} - {self.letter, "s"}
        positive = {s for s in names if self.prover.proves(compare(sym(s), ">"), guards)}
        return Field(positive).same(self._decided(one, guards), self._decided(other, guards))

    def _decided(self, tree: Node, guards: tuple[Node, ...]) -> Node:
        """Return a tree without the choices of parameters that guards decide."""
        free = not {self.letter, "s"} & set(symbols(tree.args[0] if tree.op == "if" else tree))
        if tree.op in KINKS and free:
            return self._decided(unkinked(tree), guards)
        args = tuple(self._decided(arg, guards) for arg in tree.args)
        for side, branch in ((tree.args[0], 1), (tree.args[0], 2)) if tree.op == "if" and free else ():
            if self.prover.proves(side if branch == 1 else negated(side), guards):
                return args[branch]
        return Node(tree.op, args, tree.value)

    def _term(self, law: Node, term: Mapping[str, Any], guards: tuple[Node, ...]) -> str:
        """Return why law*letter >= 0 is not shown of one summand."""
        front, f, way, scale = self.read(term["prefactor"]), parse(term["f"]), term["sign"], num(1)
        need(not set(symbols(f)) - {"s"} and way in (1, -1), "f is not of s alone, or has no sign")
        for text, power in term["scale"].items():
            base = self.read(text)
            free = self.letter not in symbols(base)
            if not (free and self.prover.proves(compare(base, ">"), guards)):
                return f"the scale {text[:40]!r} is not shown to be positive"
            scale = Node("*", (scale, Node("**", (base,), Fraction(power))))
        letter = {self.letter: Node("*", (scale, S))}
        if not self._same(put(law, letter), put(Node("*", (front, f)), letter), guards):
            return "a term is not shown to be prefactor*f(s)"
        if not self.prover.proves(compare(front, ">=" if way > 0 else "<="), guards):
            return "the sign of a prefactor is not shown"
        return self._rays(Node("*", (num(way), f)), term["rays"])

    # f(s)*s on the whole line

    def _rays(self, f: Node, rays: Any) -> str:
        """Return why f(s)*s >= 0 is not shown for all real s: on windows that cover them."""
        covered: list[tuple[Any, Any]] = []
        for ray in rays:
            centre, side = Fraction(ray["centre"]), ray["side"]
            covered.append((centre, centre))
            if side not in (1, -1) or not _holds_at(f, centre):
                return f"f is not shown to have its sign at {centre}"
            for lo, hi, _ in ray["windows"]:
                ends = Fraction(lo), None if hi == "inf" else Fraction(hi)
                if not self._window(f, centre, side, ends):
                    return f"f is not shown to have its sign from {lo} to {hi} of {centre}"
                moved = [None if t is None else centre + side * t for t in ends]
                covered.append((moved[0], moved[1]) if side > 0 else (moved[1], moved[0]))
        return "" if _is_line(covered) else "the windows do not cover the line"

    def _window(self, f: Node, centre: Fraction, side: int, ends: tuple[Fraction, Any]) -> bool:
        """Return whether f(s)*s >= 0 for s = centre + side*t, t in a window, its ends included."""
        s = made("c + k*s", c=num(centre), k=num(side))
        moved, pieces = put(f, {"s": s}), [ends]
        while pieces:
            self.left -= 1
            a, b = pieces.pop()
            if self.left < 0 or a < 0:
                return False
            far, signed = compare(S, ">=", a), compare(Node("*", (num(side), moved)), ">=")
            if b is None and a > abs(centre) and self.tails.proves(signed, (far,)):
                continue
            if b is not None and _holds_at(f, centre + side * a):
                tree = self._smooth(Node("*", (moved, s)), (compare(S, ">", a), compare(S, "<=", b)))
                if _shown(tree, a, b):
                    continue
            if a >= FARTHEST or (b is not None and b - a < NARROWEST * max(b, 1)):
                return False
            middle = max(2 * a, Fraction(1)) if b is None else (a + b) / 2
            pieces += [(middle, b), (a, middle)]
        return True

    def _smooth(self, tree: Node, window: tuple[Node, Node]) -> Node:
        """Return a tree without the choices that a window settles."""
        if tree.op in KINKS:
            return self._smooth(unkinked(tree), window)
        for branch in (1, 2) if tree.op == "if" else ():
            side = tree.args[0] if branch == 1 else negated(tree.args[0])
            if self.tails.proves(side, window):
                return self._smooth(tree.args[branch], window)
        return Node(tree.op, tuple(self._smooth(arg, window) for arg in tree.args), tree.value)


def _is_line(covered: list[tuple[Any, Any]]) -> bool:
    """Return whether closed intervals (None: infinity) cover the real line."""
    covered = sorted(covered, key=lambda c: (c[0] is not None, c[0] or 0))
    reached = covered[0][1] if covered and covered[0][0] is None else Fraction(-1, 0 + 1)
    if not covered or covered[0][0] is not None:
        return False
    for lo, hi in covered:
        if reached is not None and lo is not None and lo > reached:
            return False
        reached = None if reached is None or hi is None else max(reached, hi)
    return reached is None


def _holds_at(f: Node, s: Fraction) -> bool:
    """Return whether f(s)*s >= 0 at a number."""
    try:
        return bool(compute(Node("*", (f, S)), {"s": exact(s)}) >= 0)
    except (CannotTell, NoValue):
        return False


def _shown(g: Node, lo: Fraction, hi: Fraction) -> bool:
    """Return whether g(t) >= 0 for lo < t <= hi, by a Taylor series of some order.

    What is exactly zero at lo is divided out, t - lo being positive.
    """
    step = arb(exact((hi - lo) / 2), exact((hi - lo) / 2))
    try:
        left, whole = (_series(g, arb_series([arb(exact(lo)) + more, 1])) for more in (0, step))
    except (CannotTell, ValueError, ZeroDivisionError):
        return False
    first = next((k for k in range(ORDER + 1) if not left[k] == 0), ORDER)
    for order in range(ORDER + 1):
        total, skipped = whole[order], min(first, order)
        for k in reversed(range(skipped, order)):
            total = left[k] + step * total
        if total >= 0:
            return True
    return False


def _series(node: Node, t: Any) -> Any:
    """Return the series of a tree without choices; raises `CannotTell` where there is none."""
    if node.op in ("num", "sym"):
        return t if node.op == "sym" else arb_series([exact(node.value)])
    if node.op == "if":
        raise CannotTell
    if node.op == "tanh":
        return _series(made(TANH, x=node.args[0]), t)
    args = [_series(arg, t) for arg in node.args]
    x, power = args[0], Fraction(node.value or 0)
    match node.op:
        case "+":
            found = sum(args[1:], x)
        case "neg":
            found = -x
        case "*":
            found = x * args[1]
        case "/":
            found = x / args[1]
        case "**" if power.denominator == 1:
            found = arb_series([1])
            for _ in range(abs(power.numerator)):
                found = found * x
            found = found if power >= 0 else 1 / found
        case "**":
            found = (x.log() * arb(exact(power))).exp()
        case _:
            found = getattr(x, node.op)()
    if not all(c.is_finite() for c in found):
        raise CannotTell
    return found
