"""Certificates: proofs by intervals as data that a second program can check.

These are the types; `as_data` gives plain JSON.  Texts are in the law language, with ``s`` for the
letter of `f`.

A certificate claims that law*letter >= 0 in the domain.  Its cases cover the domain: at each point
all guards of some case hold, and the law is the sum of the laws of that case's terms wherever it is
defined.  A law of zero has no terms.  Guards are free of the letter.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import final

from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import ZERO, Cmp, Expr, If, rename
from piezo_sym.proofs.signs.intervals import INF

#: The letter of f in a certificate.
LETTER = "s"


@final
@dataclass(frozen=True, slots=True)
class Windows:
    """Windows of t on which a function of x = centre + side*t is shown to be >= 0."""

    #: centre, side: a rational number, and 1 or -1.
    centre: Fraction
    side: int
    #: (lo, hi, order) for lo < t <= hi, hi possibly infinite, with the number of derivatives used.
    #: The centre t = 0 is in no window; the function is evaluated there separately.
    windows: tuple[tuple[float, float, int], ...]

    def as_data(self) -> dict[str, object]:
        """Return plain data; numbers are exact, as text."""
        windows = [[_number(lo), _number(hi), order] for lo, hi, order in self.windows]
        return {"centre": str(self.centre), "side": self.side, "windows": windows}


def _number(end: float) -> str:
    return "inf" if end == INF else str(Fraction(end))


@final
@dataclass(frozen=True, slots=True)
class Term:
    """One summand: ``law = prefactor*f(s)`` wherever the law is defined, ``letter = scale*s``."""

    law: Expr  # in the letter
    letter: str  # its name
    #: May contain the letter; ``sign*prefactor >= 0`` follows from domain and guards for every
    #: value of the letter, wherever the prefactor is defined.
    prefactor: Expr
    sign: int = 1  # 1 or -1
    #: (base, power); each base is free of the letter and > 0 by domain and guards.
    scale: tuple[tuple[Expr, Fraction], ...] = ()
    #: A tree in the letter, which stands for s: f is defined and ``sign*f(s)*s >= 0`` for all real
    #: s.  None: the prefactor is law*letter itself.
    f: Expr | None = None
    #: The windows of that proof; every real s is a centre or lies in a window.
    rays: tuple[Windows, ...] = ()

    def where(self, condition: Cmp) -> Term:
        """Return the term of ``law if condition else 0``."""
        law, prefactor = (If(part, condition, ZERO) for part in (self.law, self.prefactor))
        return replace(self, law=law, prefactor=prefactor)

    def as_data(self) -> dict[str, object]:
        """Return plain data; a fractional power is text such as 1/2."""
        scale = {spell(b): int(e) if e.denominator == 1 else str(e) for b, e in self.scale}
        f = None if self.f is None else spell(rename(self.f, {self.letter: LETTER}))
        return {
            "law": spell(self.law),
            "prefactor": spell(self.prefactor),
            "sign": self.sign,
            "scale": scale,
            "f": f,
            "rays": [ray.as_data() for ray in self.rays],
        }


@final
@dataclass(frozen=True, slots=True)
class Case:
    """The law where all `guards` hold: the sum of the terms' laws."""

    guards: tuple[Cmp, ...]
    terms: tuple[Term, ...]

    def as_data(self) -> dict[str, object]:
        """Return plain data."""
        guards = [f"{spell(c.left)} {c.op} {spell(c.right)}" for c in self.guards]
        return {"guards": guards, "terms": [term.as_data() for term in self.terms]}
