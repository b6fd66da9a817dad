"""Certificates of laws decided by intervals: checked again, with bounds of the checker's own.

Input: a law, and the cases of its certificate.  Output: the reason why it does not hold, or none.
A case holds where its guards do; there the law is a sum of terms, each prefactor*f(s) with letter =
scale*s; cvc5 answers that the cases cover the domain, and for the prefactor's sign.  That f(s)*s
has that sign is shown on windows lo < t <= hi of s = centre + side*t: cvc5 settles the choices
there, FLINT gives the Taylor series at lo and its remainder.  A window to infinity is left to cvc5,
far out, where coarse bounds of functions are enough.
"""

import operator
from collections.abc import Mapping
from fractions import Fraction
from math import prod
from typing import Any

from flint import arb, arb_series, ctx, fmpq

from . import laws
from .field import Field
from .laws import KINKS, InputError, Node, compare, made, need, negated, num, put, sym, symbols
from .prover import Claim, Prover, partial
from .spec import Element, Spec

BITS, ORDER, MOST_WINDOWS, MOST_CASES, FARTHEST = 192, 10, 3000, 64, 2**12
NARROWEST = Fraction(1, 2**20)
S, TANH = sym("s"), "1 - 2/(exp(2*x) + 1)"
SERIES: dict[str, Any] = {"*": operator.mul, "/": operator.truediv, "neg": operator.neg}
SERIES |= {"+": lambda *terms: sum(terms[1:], terms[0])}


def check_certificate(spec: Spec, element: Element, cases: Any, prover: Prover) -> None:
    """Refuse a certificate that does not show that a law takes power in."""
    before, ctx.prec, ctx.cap = (ctx.prec, ctx.cap), BITS, ORDER + 1
    try:
        _Certificate(spec, element, prover).check(cases)
    except (KeyError, TypeError, AttributeError, ValueError, ArithmeticError) as error:
        raise InputError(f"its certificate cannot be read: {error}") from None
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
        tree = laws.parse(text)
        need(all(name in self.words for name in symbols(tree)), "its certificate has other names")
        return put(tree, self.words)

    def check(self, cases: Any) -> None:
        need(len(cases) <= MOST_CASES, "its certificate has too many cases")
        guards = [tuple(self.read(text) for text in case["guards"]) for case in cases]
        free = all(g.op == "cmp" and self.letter not in symbols(g) for own in guards for g in own)
        need(free and self._cover(guards, ()), "its cases are not shown to cover the domain")
        for own, case in zip(guards, cases, strict=True):
            parts = [self.read(term["law"]) for term in case["terms"]]
            same = self._same(self.law, Node("+", (num(0), *parts)), own)
            need(same, "its terms are not shown to make up the law")
            for law, term in zip(parts, case["terms"], strict=True):
                self._term(law, term, own)

    def _cover(self, guards: list[tuple[Node, ...]], missed: tuple[Node, ...]) -> bool:
        """Return whether nowhere a guard of each case is missed."""
        if self.prover.proves(compare(num(1), "<"), missed):
            return True
        rest = guards[1:]
        return bool(guards) and all(self._cover(rest, (*missed, negated(g))) for g in guards[0])

    def _same(self, one: Node, other: Node, guards: tuple[Node, ...]) -> bool:
        """Return whether two laws are the same function where guards hold."""
        names = {s for tree in (one, other) for s in symbols(tree)} - {self.letter, "s"}
        positive = {s for s in names if self.prover.proves(compare(sym(s), ">"), guards)}
        settled = [self._settled(tree, self.prover, guards, names) for tree in (one, other)]
        return Field(positive).same(*settled)

    def _term(self, law: Node, term: Mapping[str, Any], guards: tuple[Node, ...]) -> None:
        """Refuse a summand of which law*letter >= 0 is not shown."""
        front, f, way = self.read(term["prefactor"]), laws.parse(term["f"]), term["sign"]
        scale, valued = num(1), [*partial(front)]
        need(not set(symbols(f)) - {"s"} and way in (1, -1), "f is not of s alone, or has no sign")
        for text, power in term["scale"].items():
            base = self.read(text)
            need(self.letter not in symbols(base), "a scale has the letter in it")
            valued += [*partial(base), Claim((), compare(base, ">"))]
            scale = Node("*", (scale, Node("**", (base,), Fraction(power))))
        letter = {self.letter: Node("*", (scale, S))}
        same = self._same(put(law, letter), put(Node("*", (front, f)), letter), guards)
        need(same, "a term is not shown to be prefactor*f(s)")
        valued.append(Claim((), compare(front, ">=" if way > 0 else "<=")))
        shown = all(self.prover.proves(claim, (*guards, *path)) for path, claim in valued)
        need(shown, "the sign of a prefactor or scale is not shown")
        self._rays(Node("*", (num(way), f)), term["rays"])

    def _settled(self, tree: Node, prover: Prover, where: tuple[Node, ...], free: set[Any]) -> Node:
        """Return a tree without the choices that are settled somewhere.

        Kinks stay if they are of symbols that are not free.
        """
        wide = tree.op in ("abs", "min", "max")  # both branches are equal at the edge
        if tree.op in KINKS and set(symbols(tree)) <= free:
            tree = laws.unkinked(tree)
        for branch in (1, 2) if tree.op == "if" else ():
            side = tree.args[0] if branch == 1 else negated(tree.args[0])
            value = side.value[0] + "=" if wide else side.value
            if prover.proves(Node("cmp", side.args, value), where):
                return self._settled(tree.args[branch], prover, where, free)
        args = tuple(self._settled(arg, prover, where, free) for arg in tree.args)
        return Node(tree.op, args, tree.value)

    # f(s)*s on the whole line

    def _rays(self, f: Node, rays: Any) -> None:
        """Refuse f if f(s)*s >= 0 is not shown for all real s: on windows that cover them."""
        covered: list[tuple[Any, Any]] = []
        for ray in rays:
            centre, side = Fraction(ray["centre"]), ray["side"]
            covered.append((centre, centre))
            good = side in (1, -1) and self._at(f, centre)
            need(good, f"f is not shown to have its sign at {centre}")
            for lo, hi, _ in ray["windows"]:
                ends = Fraction(lo), None if hi == "inf" else Fraction(hi)
                shown = self._window(f, centre, side, ends)
                need(shown, f"f is not shown to have its sign from {lo} to {hi} of {centre}")
                moved = [None if t is None else centre + side * t for t in ends]
                covered.append((moved[0], moved[1]) if side > 0 else (moved[1], moved[0]))
        need(bool(covered) and _is_line(covered), "the windows do not cover the line")

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
            if b is not None and self._at(f, centre + side * a):
                inside = compare(S, ">", a), compare(S, "<=", b)
                tree = self._settled(moved, self.tails, inside, {"s"})
                if _shown(tree, s, a, b):
                    continue
            if a >= FARTHEST or (b is not None and b - a < NARROWEST * max(b, 1)):
                return False
            middle = max(2 * a, Fraction(1)) if b is None else (a + b) / 2
            pieces += [(middle, b), (a, middle)]
        return True

    def _at(self, f: Node, s: Fraction) -> bool:
        """Return whether f(s)*s >= 0 at a number."""
        tree = self._settled(put(f, {"s": num(s)}), self.tails, (), {"s"})
        return s == 0 or bool(_exact(s) * _series(tree, arb_series([0]))[0] >= 0)


def _is_line(covered: list[tuple[Any, Any]]) -> bool:
    """Return whether closed intervals (None: infinity) cover the real line."""
    ends = sorted(((lo is not None, lo or 0), (hi is None, hi or 0)) for lo, hi in covered)
    good, reached = not ends[0][0][0], ends[0][1]
    for (_, lo), hi in ends[1:]:
        good &= reached[0] or lo <= reached[1]
        reached = max(reached, hi)
    return good and reached[0]


def _shown(f: Node, s: Node, lo: Fraction, hi: Fraction) -> bool:
    """Return whether f*s >= 0 for lo < t <= hi, both functions of t, by Taylor series.

    What is exactly zero at lo is divided out, t - lo being positive; f may be so by its form.
    """
    radius = arb(_exact((hi - lo) / 2))
    step, field = arb(radius, radius), Field()
    try:
        both = [arb_series([arb(_exact(lo)) + more, 1]) for more in (0, step)]
        left, whole = (_series(f, t) for t in both)
        if field.is_zero(field.of(put(f, {"s": num(lo)}))):
            left = arb_series([0, *list(left)[1:]])
        left, whole = (g * _series(s, t) for g, t in zip((left, whole), both, strict=True))
    except (ValueError, ZeroDivisionError, InputError):
        return False
    first = next((k for k in range(ORDER + 1) if (left[k] == 0) is not True), ORDER)
    for order in range(ORDER + 1):
        total, skipped = whole[order], min(first, order)
        for k in reversed(range(skipped, order)):
            total = left[k] + step * total
        if total >= 0:
            return True
    return False


def _exact(number: Fraction) -> Any:
    return fmpq(number.numerator, number.denominator)


def _series(node: Node, t: Any) -> Any:
    """Return the series of a tree without choices; raises an error where there is none."""
    if node.op in ("num", "sym"):
        return t if node.op == "sym" else arb_series([_exact(node.value)])
    if node.op == "tanh":
        return _series(made(TANH, x=node.args[0]), t)
    need(node.op != "if", "a choice is not settled")
    args = [_series(arg, t) for arg in node.args]
    power = Fraction(node.value or 0)
    if node.op == "**" and power.denominator == 1:
        found = prod([args[0]] * abs(power.numerator), start=arb_series([1]))
        found = found if power >= 0 else 1 / found
    elif node.op == "**":
        found = (args[0].log() * arb(_exact(power))).exp()
    else:
        found = SERIES[node.op](*args) if node.op in SERIES else getattr(args[0], node.op)()
    need(all(c.is_finite() for c in found), "it has no value")
    return found
