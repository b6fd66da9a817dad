"""Checks the certificates of laws decided by intervals, with the checker's own bounds.

Input: a law, and the cases of its certificate.  Output: `InputError` if it does not hold.  Where
the guards of a case hold, the law is a sum of terms: prefactor*f(s) with letter = scale*s, or
prefactor/letter.  cvc5 shows that the cases cover the domain, and the sign of the prefactor;
`signs` shows that of f(s)*s on windows lo < t <= hi of s = centre + side*t, which cover the line.
"""

from collections.abc import Mapping
from fractions import Fraction
from math import inf
from typing import Any

from . import laws
from .field import Field
from .laws import InputError, Node, compare, need, num, subs, sym, symbols
from .prover import Claim, Prover, guarded, partial, true
from .signs import shown
from .spec import Element, Spec

MOST_WINDOWS, MOST_CASES, FARTHEST, NARROWEST = 3000, 64, 2**12, Fraction(1, 2**20)


def check_certificate(spec: Spec, element: Element, cases: Any, prover: Prover) -> None:
    """Raise `InputError` unless a certificate shows that a law takes power in."""
    try:
        _Certificate(spec, element, prover).check(cases)
    except (KeyError, TypeError, AttributeError, ValueError, ArithmeticError) as error:
        raise InputError(f"its certificate cannot be read: {error}") from None


class _Certificate:
    def __init__(self, spec: Spec, element: Element, prover: Prover) -> None:
        self.law, self.prover, self.left = element.law or num(0), prover, MOST_WINDOWS
        self.real, self.letter = Prover(()), ("z", element.name)
        # a certificate appends _ to the letter if the spec uses the same name for something else
        meanings = {element.letter: self.letter, **spec.words, f"{element.letter}_": self.letter}
        self.words = {word: sym(meaning) for word, meaning in meanings.items()}

    def read(self, text: str) -> Node:
        """Return the tree of a text of the certificate, in the symbols of the spec."""
        tree = laws.parse(text)
        need(symbols(tree).keys() <= self.words.keys(), "its certificate has other names")
        return subs(tree, self.words)

    def check(self, cases: Any) -> None:
        need(len(cases) <= MOST_CASES, "its certificate has too many cases")
        guards = [tuple(self.read(text) for text in case["guards"]) for case in cases]
        free = all(g.op == "cmp" and self.letter not in symbols(g) for own in guards for g in own)
        held = Node("+", (num(0), *(guarded(own, num(1)) for own in guards)))
        covered = free and self.prover.proves(compare(held, ">"))
        need(covered, "its cases are not shown to cover the domain")
        for own, case in zip(guards, cases, strict=True):
            if not self.prover.proves(compare(num(1), "<"), own):  # the case is not empty
                self._case(case["terms"], own)

    def _case(self, terms: Any, guards: tuple[Node, ...]) -> None:
        """Raise unless terms add up to the law and each is shown to take power in."""

        def known(condition: Node) -> bool:
            return self.letter not in symbols(condition) and self.prover.proves(condition, guards)

        field, claims = Field(known, scales=True), list[Claim]()
        parts = (num(0), *(self.read(term["law"]) for term in terms))
        need(field.same(self.law, Node("+", parts)), "its terms are not shown to make up the law")
        # the same for prefactor*f(s), which is shown to have a value
        products = (num(0), *(self._product(term, claims) for term in terms))
        need(field.same(self.law, Node("+", products)), "a term is not shown to be prefactor*f(s)")
        follow = all(self.prover.proves(claim, (*guards, *path)) for claim, path in claims)
        need(follow, "the sign of a prefactor or scale is not shown")
        for term in terms:
            if term["f"] is not None:
                self._rays(Node("*", (num(term["sign"]), laws.parse(term["f"]))), term["rays"])

    def _product(self, term: Mapping[str, Any], claims: list[Claim]) -> Node:
        """Return prefactor*f(letter/scale), or prefactor/letter; append the claims on it."""
        front, way, z = self.read(term["prefactor"]), term["sign"], sym(self.letter)
        need(way in (1, -1), "a term has no sign")
        claims += [*partial(front), true(front, ">=" if way > 0 else "<=")]
        if term["f"] is None:
            need(way > 0, "a term has no sign")
            return Node("/", (front, z))
        for text, power in term["scale"].items():
            base = self.read(text)
            need(self.letter not in symbols(base), "a scale has the letter in it")
            claims += [*partial(base), true(base, ">")]
            z = Node("/", (z, Node("**", (base,), _number(power))))
        f = laws.parse(term["f"])
        need(set(symbols(f)) <= {"s"}, "f is not of s alone")
        return Node("*", (front, subs(f, {"s": z})))

    def _rays(self, f: Node, rays: Any) -> None:
        """Raise unless f(s)*s >= 0 is shown on windows that cover all real s."""
        covered, reached = list[Any](), -inf
        for ray in rays:
            centre, side = _number(ray["centre"]), int(ray["side"])
            for low, high, _ in [("0", "0", 0), *ray["windows"]]:
                lo, hi = _number(low), inf if high == "inf" else _number(high)
                valid = side in (1, -1) and 0 <= lo <= hi
                signed = valid and self._window(f, centre, side, lo, hi)
                need(signed, f"f is not shown to have its sign from {lo} to {hi} of {centre}")
                covered.append(tuple(sorted((centre + side * lo, centre + side * hi))))
        for lo, hi in sorted(covered):
            reached = max(reached, hi) if lo <= reached else reached
        need(reached == inf, "the windows do not cover the line")

    def _window(self, f: Node, centre: Fraction, side: int, lo: Fraction, hi: Any) -> bool:
        """Return whether f(s)*s >= 0 is shown on a window and at its start, cutting if needed."""
        self.left -= 1
        if self.left < 0 or not shown(f, centre, side, (lo, lo), self.real):
            return False
        if lo == hi or shown(f, centre, side, (lo, hi), self.real):
            return True
        middle = (lo + hi) / 2 if hi != inf else max(2 * lo, Fraction(1))
        wide = lo < FARTHEST and hi - lo >= NARROWEST * max(hi, 1)
        halves = (lo, middle), (middle, hi)
        return wide and all(self._window(f, centre, side, *half) for half in halves)


def _number(text: Any) -> Fraction:
    top, _, bottom = str(text).partition("/")
    return laws.number(top) / laws.number(bottom or "1")
