"""The sign of a law as a whole, where queries on its branches did not decide it.

Input: a `SignOf`, the order of names, and a solver.  Output: an `Outcome`: a verdict with its
witness or certificate, or None where the law has too many cases.

A law is split by the choices on parameters; each case assumes the domain and its guards.  A law
that reduces to ``prefactors * f(s)``, its letter being a positive scale times s, has the sign of
both: the solver decides the prefactors, interval arithmetic ``f(s)*s``.  A sum is passive if each
term is.  Where nothing is proved, simple numbers are tried in the law itself.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import reduce as fold
from typing import final

from piezo_sym.expressions.calculus import mul
from piezo_sym.expressions.tree import ONE, ZERO, Add, Cmp, Expr, If, Mul, Neg, Num, Sym, names
from piezo_sym.proofs.asked import (
    DomainOracle,
    Numbers,
    moved_counterexample,
    simple_counterexample,
)
from piezo_sym.proofs.branches import opposite
from piezo_sym.proofs.obligations import SignOf
from piezo_sym.proofs.signs.cases import balanced, cases, choice_outside, grouped, summands
from piezo_sym.proofs.signs.certificate import Case, Term
from piezo_sym.proofs.signs.decide import decide_sign
from piezo_sym.proofs.signs.reduce import Reduction, reductions
from piezo_sym.proofs.solvers import SolverLike
from piezo_sym.report import Verdict

#: Functions of one variable without a proved sign, after which the search stops.
MOST_FAILED = 12


@final
@dataclass(frozen=True, slots=True)
class Outcome:
    """A verdict, with the numbers that refute, the reason why it is open, or the certificate."""

    verdict: Verdict
    numbers: Numbers | None = None
    reason: str = ""
    certificate: tuple[Case, ...] = ()


def whole_sign(
    sign: SignOf, order: tuple[str, ...], solver: SolverLike, own: Iterable[Numbers] = ()
) -> Outcome | None:
    """Return the verdict on ``law*letter >= 0`` in a domain, or None if the law has too many cases.

    A witness is simple in the first names of `order`; the solver decides the signs of prefactors.
    One is also looked for near the spec's `own` values, of which none need be zero.
    """
    claim = Cmp(">=", mul(sign.law, Sym(sign.letter)), ZERO)
    domain = DomainOracle(sign.where, order, solver)
    if numbers := simple_counterexample(claim, sign.letter, domain):
        return Outcome(Verdict.REFUTED, numbers)
    split = cases(sign.law, sign.letter, domain.positive)
    if split is None:
        return None
    shown: list[Case] = []
    reasons: list[str] = []
    for guards, law in split:
        search = Search(law, sign.letter, domain.within(*guards))
        terms = search.terms(law)
        if terms is not None:
            shown.append(Case(guards, terms))
        elif not search.domain.empty():
            if numbers := search.witness(claim):
                return Outcome(Verdict.REFUTED, numbers)
            reasons += search.reasons[:1] or ["bounds on the functions in it do not decide it"]
    if not reasons:
        return Outcome(Verdict.PROVED, certificate=tuple(shown))
    for start in (None, *own):
        if numbers := moved_counterexample(claim, sign.letter, domain, start):
            return Outcome(Verdict.REFUTED, numbers)
    return Outcome(Verdict.OPEN, reason=reasons[0])


@final
@dataclass(frozen=True)
class Search:
    """The search for a proof that a law has the sign of its letter."""

    #: law, letter: the law of one case, and its letter.
    law: Expr
    letter: str
    domain: DomainOracle  # the domain with the guards of the case
    #: Why functions f are left open, filled by the search.
    reasons: list[str] = field(default_factory=list)
    #: Reduced laws of the wrong sign: the reduction, its sign, and a value of s.
    negative: list[tuple[Reduction, int, Fraction]] = field(default_factory=list)

    def terms(self, law: Expr) -> tuple[Term, ...] | None:
        """Return terms, each shown to be passive, whose sum is the law; None if one is not."""
        if law == ZERO:
            return ()
        law = choice_outside(law)
        if (term := self._term(law)) is not None:
            return term
        match law:
            case Add(parts) if (found := _joined(map(self.terms, parts))) is not None:
                return found
            case If(then, condition, other):
                sides = ((then, condition), (other, opposite(condition)))
                return _joined(self._where(side, where) for side, where in sides)
        groups = grouped(summands(law), self.letter, self.domain.positive)
        if not groups or len(groups) == 1:
            return self._polynomial(law)
        if (found := _joined(map(self._term, groups))) is not None:
            return found
        groups = balanced(groups, self.letter, self.domain.positive)
        return None if groups is None else _joined(map(self._term, groups))

    def _where(self, law: Expr, condition: Cmp) -> tuple[Term, ...] | None:
        """Return the terms of the law ``law if condition else 0``, or None."""
        found = () if law == ZERO else self._term(If(law, condition, ZERO))
        if found is None and (inner := self.terms(law)) is not None:
            return tuple(term.where(condition) for term in inner)
        return found

    def _term(self, law: Expr) -> tuple[Term] | None:
        """Return a law as one term if it reduces to one variable and is shown to be passive."""
        for reduction in reductions(law, self.letter, self.domain.positive):
            for sign in (1, -1):
                if len(self.reasons) + len(self.negative) >= MOST_FAILED:
                    return None
                power = Mul(reduction.f, Sym(self.letter))
                decision = decide_sign(power if sign > 0 else Neg(power), self.letter)
                if decision.witness is not None:
                    self.negative.append((reduction, sign, decision.witness))
                elif decision.verdict is not Verdict.PROVED:
                    self.reasons.append(decision.reason)
                elif self._keeps(reduction.prefactors, sign):
                    front = fold(Mul, reduction.prefactors) if reduction.prefactors else ONE
                    units, f = reduction.units, reduction.f
                    return (Term(law, self.letter, front, sign, units, f, decision.rays),)
        return None

    def _polynomial(self, law: Expr) -> tuple[Term] | None:
        """Return a part of the law as a term if the solver shows that it is passive."""
        power = mul(law, Sym(self.letter))
        if law == self.law or not self.domain.follows(Cmp(">=", power, ZERO)):
            return None
        return (Term(law, self.letter, power),)

    def _keeps(self, factors: Sequence[Expr], sign: int) -> bool:
        """Return whether ``sign*product >= 0`` is shown in the domain."""
        left = [factor for factor in factors if not self.domain.nonnegative(factor)]
        if not left:
            return sign > 0
        start: Expr = Num(Fraction(sign))
        if self.domain.follows(Cmp(">=", fold(mul, left, start), ZERO)):
            return True
        return len(left) > 1 and self._signs(left) == sign

    def _signs(self, factors: Sequence[Expr]) -> int:
        """Return the sign of a product from those of its factors; 0 if one is not known."""
        total = 1
        for factor in factors:
            if not self._keeps([factor], 1):
                total = -total if self._keeps([factor], -1) else 0
        return total

    def witness(self, claim: Cmp) -> Numbers | None:
        """Return numbers at which a reduced law of the wrong sign breaks the claim, or None."""
        for n, (reduction, sign, value) in enumerate(self.negative):
            start: Expr = Num(Fraction(sign))
            front = Cmp("<=", fold(mul, reduction.prefactors, start), ZERO)
            wanted = self.domain.related((*names(claim), *names(reduction.scale)))
            found = None if n else self.domain.point(front, wanted)
            for point in (*self.domain.samples, *((found,) if found else ())):
                letter = reduction.back(value, point)
                numbers = {**point, self.letter: letter or Fraction(0)}
                if letter is not None and self.domain.breaks(claim, numbers):
                    return {name: value for name, value in numbers.items() if name in wanted}
        return None


def _joined(parts: Iterable[tuple[Term, ...] | None]) -> tuple[Term, ...] | None:
    """Return the terms of all parts, or None if a part is None."""
    found: list[Term] = []
    for part in parts:
        if part is None:
            return None
        found += part
    return tuple(found)
