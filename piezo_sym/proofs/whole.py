"""The sign of a law as a whole, where its branches in polynomials were not enough.

Input: a `SignOf` with the domain it is stated in, the order of names, and a solver.  Output: an
`Outcome`: a verdict with its witness or its certificate, or None where the law has too many cases.

A law is split by the choices that its parameters make; each case assumes the domain and its own
guards.  A law that reduces to ``prefactors * f(s)``, its letter being a positive scale times s, has
the sign of both: the solver looks at the prefactors, interval arithmetic at ``f(s)*s``.  A sum is
passive if each term is.  Where nothing is proved, simple numbers are tried in the law itself.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from fractions import Fraction
from functools import reduce as fold
from typing import final

from piezo_sym.proofs.asked import Asked, Numbers, moved, tried
from piezo_sym.proofs.obligations import SignOf
from piezo_sym.proofs.report import Verdict
from piezo_sym.proofs.signs import (
    Case,
    Reduction,
    Term,
    cases,
    decide_sign,
    grouped,
    reductions,
    summands,
)
from piezo_sym.proofs.solvers import Asks
from piezo_sym.spec.calculus import mul
from piezo_sym.spec.expressions import (
    ONE,
    ZERO,
    Add,
    Call,
    Cmp,
    Div,
    Expr,
    Mul,
    Neg,
    Num,
    Pow,
    Sym,
    names,
)

#: Functions of one variable that may fail before the search stops.
MOST_FAILED = 6


@final
@dataclass(frozen=True, slots=True)
class Outcome:
    """A verdict: for REFUTED with the numbers, for OPEN why, for PROVED with its certificate."""

    verdict: Verdict
    numbers: Numbers | None = None
    reason: str = ""
    certificate: tuple[Case, ...] = ()


def whole_sign(sign: SignOf, order: tuple[str, ...], solver: Asks) -> Outcome | None:
    """Return the verdict on ``law*letter >= 0`` in a domain.

    Parameters
    ----------
    sign : the law, its letter, and the domain.
    order : names, in the order in which a witness should be simple.
    solver : for the signs of what stands in front of a function of the letter alone.
    """
    claim = Cmp(">=", mul(sign.law, Sym(sign.letter)), ZERO)
    asked = Asked(sign.where, order, solver)
    if numbers := tried(claim, sign.letter, asked):
        return Outcome(Verdict.REFUTED, numbers)
    split = cases(sign.law, sign.letter, asked.positive)
    if split is None:
        return None
    shown: list[Case] = []
    reasons: list[str] = []
    for guards, law in split:
        search = Search(sign.letter, Asked((*sign.where, *guards), order, solver))
        terms = search.terms(law)
        if terms is not None:
            shown.append(Case(guards, terms))
        elif not search.asked.empty():
            if numbers := search.witness(claim):
                return Outcome(Verdict.REFUTED, numbers)
            reasons += search.reasons[:1] or ["bounds on the functions in it do not decide it"]
    if not reasons:
        return Outcome(Verdict.PROVED, certificate=tuple(shown))
    if numbers := moved(claim, sign.letter, asked):
        return Outcome(Verdict.REFUTED, numbers)
    return Outcome(Verdict.OPEN, reason=reasons[0])


@final
@dataclass(frozen=True)
class Search:
    """The search for what shows that a law has the sign of its letter.

    Attributes
    ----------
    letter : the letter.
    asked : the solver, in the domain and the guards of a case.
    reasons : what is still open, filled as the search goes on.
    negative : where a reduced law has the wrong sign: the reduction, its sign, and s.
    """

    letter: str
    asked: Asked
    reasons: list[str] = field(default_factory=list)
    negative: list[tuple[Reduction, int, Fraction]] = field(default_factory=list)

    def terms(self, law: Expr) -> tuple[Term, ...] | None:
        """Return summands that are shown to be passive and make up the law, or None."""
        if law == ZERO:
            return ()
        if (term := self._term(law)) is not None:
            return (term,)
        if isinstance(law, Add):
            parts = [self.terms(term) for term in law.terms]
            if all(part is not None for part in parts):
                return tuple(term for part in parts for term in part or ())
        groups = grouped(summands(law), self.letter, self.asked.positive)
        if not groups or len(groups) == 1:
            return None
        found = [self._term(group) for group in groups]
        return tuple(filter(None, found)) if all(found) else None

    def _term(self, law: Expr) -> Term | None:
        """Return a law that comes down to one variable and is shown to be passive, or None."""
        for reduction in reductions(law, self.letter, self.asked.positive):
            sign = self._sign(reduction.prefactors)
            if sign is None or len(self.reasons) + len(self.negative) >= MOST_FAILED:
                continue
            power = Mul(reduction.f, Sym(self.letter))
            decision = decide_sign(power if sign > 0 else Neg(power), self.letter)
            if decision.verdict is Verdict.PROVED:
                front = fold(Mul, reduction.prefactors) if reduction.prefactors else ONE
                return Term(
                    law, self.letter, front, sign, reduction.units, reduction.f, decision.rays
                )
            if decision.witness is not None:
                self.negative.append((reduction, sign, decision.witness))
            else:
                self.reasons.append(decision.reason)
        return None

    def _sign(self, factors: Iterable[Expr]) -> int | None:
        """Return the sign that a product keeps in the domain, zero aside, or None."""
        left = [factor for factor in factors if not self._plain(factor)]
        if not left or self.asked.follows(Cmp(">=", fold(mul, left), ZERO)):
            return 1
        if self.asked.follows(Cmp("<=", fold(mul, left), ZERO)):
            return -1
        if len(left) == 1:
            return None
        signs = [self._sign([factor]) for factor in left]
        return None if None in signs else fold(int.__mul__, map(int, filter(None, signs)))

    def _plain(self, factor: Expr) -> bool:
        """Return whether a tree is seen to be nowhere negative, wherever it has a value."""
        match factor:
            case Sym() | Num():
                return self.asked.positive(factor)
            case Call("exp" | "abs" | "sqrt", _):
                return True
            case Pow(base, e):
                return e.denominator != 1 or e % 2 == 0 or self._plain(base)
            case Add(terms):
                return all(map(self._plain, terms))
            case Mul(left, right) | Div(left, right):
                return self._plain(left) and self._plain(right)
        return False

    def witness(self, claim: Cmp) -> Numbers | None:
        """Return numbers at which a reduced law that has the wrong sign breaks the claim."""
        for reduction, sign, value in self.negative:
            start: Expr = Num(Fraction(sign))
            front = fold(mul, reduction.prefactors, start)
            wanted = {*names(claim), *names(reduction.scale)}
            point = self.asked.point(Cmp("<=", front, ZERO), wanted)
            letter = None if point is None else reduction.back(value, point)
            if point is None or letter is None:
                continue
            numbers = {**point, self.letter: letter}
            if self.asked.breaks(claim, numbers):
                return numbers
        return None
