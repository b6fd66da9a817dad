"""Claims on the parameters of a domain: whether they follow, and simple numbers that break them.

Input: a domain, the order of names in a witness, and a solver.  Output: whether a claim follows,
points of the domain, and points at which a claim is false.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from itertools import product
from typing import final

from piezo_sym.expressions.exact_eval import all_hold
from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.tree import (
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
from piezo_sym.proofs.binding import connected
from piezo_sym.proofs.branches import TooManyBranchesError
from piezo_sym.proofs.obligations import NEVER, Question
from piezo_sym.proofs.solvers import Answer, SolverLike
from piezo_sym.spec.tables import greater

#: Values of a letter that are tried in a law, in this order.
TRIED = tuple(
    sign * size
    for size in map(Fraction, ("1", "2", "3", "1/2", "5", "4", "10", "1/10", "20", "100"))
    for sign in (1, -1)
)
#: How many of them are tried together with a changed parameter; its changes as (factor, summand).
FEW = 8
MOVES = tuple((Fraction(a), Fraction(b)) for a, b in ((10, 0), (-1, 0), (1, 1), (1, -1)))
MOVES += ((Fraction(1, 10), Fraction(0)),)

#: Most questions asked about one law, and how many of them may stay unanswered.
MOST_ASKED, MOST_UNKNOWN = 60, 4

Numbers = Mapping[str, Fraction]


@final
@dataclass(frozen=True)
class DomainOracle:
    """A domain, and a solver that decides claims on it."""

    where: tuple[Cmp, ...]  # the conditions of the domain
    order: tuple[str, ...]  # names, in the order in which a witness should be simple
    solver: SolverLike  # for what is not decided by the form of a claim
    #: For trees asked about so far, whether they were shown to be positive.
    known: dict[Expr, bool] = field(default_factory=dict)
    #: The solver's answers so far, in all cases of one law.
    results: list[str] = field(default_factory=list)

    def within(self, *guards: Cmp) -> DomainOracle:
        """Return the part of the domain where guards hold."""
        return replace(self, where=(*self.where, *guards), known={})

    def positive(self, part: Expr) -> bool:
        """Return whether a tree is shown to be positive."""
        if part not in self.known:
            self.known[part] = self._positive(part)
        return self.known[part]

    def _positive(self, part: Expr) -> bool:
        match part:
            case Num(value):
                return value > 0
            case Call(function, _) if RECORDS[function].sign == ">":
                return True
            case Neg(arg) if self.positive(arg):
                return False
            case Sym() if Cmp(">", part, ZERO) in map(greater, self.where):
                return True
            case Mul(a, b) | Div(a, b) if self.positive(a) and self.positive(b):
                return True
            case Pow(base, _) if self.positive(base):
                return True
            case Call(function, (base, *_)) if RECORDS[function].sign and self.positive(base):
                return True
            case Add(terms) if all(map(self.nonnegative, terms)) and any(map(self.positive, terms)):
                return True
        return self.follows(Cmp(">", part, ZERO))

    def nonnegative(self, part: Expr) -> bool:
        """Return whether the form of a tree shows that it is >= 0 wherever it has a value."""
        match part:
            case Sym() | Num():
                return self.positive(part)
            case Call(function, _) if RECORDS[function].sign:
                return True
            case Pow(base, e):
                return e.denominator != 1 or e % 2 == 0 or self.nonnegative(base)
            case Add(parts):
                return all(map(self.nonnegative, parts))
            case Mul(left, right) | Div(left, right):
                return self.nonnegative(left) and self.nonnegative(right)
        return False

    def follows(self, claim: Cmp) -> bool:
        """Return whether a claim holds in all of the domain."""
        if any(all_hold((claim,), sample) is False for sample in self.samples):
            return False
        return all(answer.result == "unsat" for answer in self._answers(claim, claim))

    @cached_property
    def samples(self) -> tuple[Numbers, ...]:
        """A few points of the domain, at which most false claims are seen to be false."""
        first = self.point(NEVER, self.order)
        if first is None:
            return ()
        others = (
            {**first, name: first[name] * factor + step}
            for name, (factor, step) in product(first, MOVES)
        )
        return (first, *(point for point in others if all_hold(self.where, point)))

    def empty(self) -> bool:
        """Return whether no point is in the domain."""
        question = Question("", self.order, self.where, NEVER, NEVER, keep_all=True)
        return self._answer(question).result == "unsat"

    def point(self, claim: Cmp, wanted: Iterable[str]) -> Numbers | None:
        """Return simple numbers in the domain at which a claim is false, or None."""
        about = self.related((*wanted, *names(claim)))
        named = tuple(Sym(name) for name in self.order if name in about)
        for answer in self._answers(claim, Cmp(">=", Add((ZERO, *named)), ZERO), witness=True):
            if answer.result == "sat":
                return {n: value for n, value in answer.model.items() if n in self.order}
        return None

    def related(self, words: Iterable[str]) -> set[str]:
        """Return `words` and all names that conditions connect with them, even indirectly."""
        known = {*words}
        return known.union(*(names(condition) for condition in connected(self.where, known)))

    def _answers(self, claim: Cmp, original: Cmp, *, witness: bool = False) -> Iterator[Answer]:
        question = Question("", self.order, self.where, claim, original, witness=witness)
        try:
            parts = question.smooth()
        except TooManyBranchesError:
            return iter((Answer("unknown"),))
        return map(self._answer, parts)

    def _answer(self, question: Question) -> Answer:
        """Return the answer to a question; ``unknown`` beyond the limits on questions."""
        results = self.results
        if len(results) >= MOST_ASKED or results.count("unknown") >= MOST_UNKNOWN:
            return Answer("unknown")
        try:
            answer = self.solver.ask(question.query)
        except TooManyBranchesError:
            answer = Answer("unknown")
        results.append(answer.result)
        return answer

    def breaks(self, claim: Cmp, numbers: Numbers) -> bool:
        """Return whether numbers lie in the domain and break a claim, evaluated exactly.

        Only conditions that connect to names of the claim are checked.
        """
        near = connected(self.where, names(claim))
        return bool(all_hold(near, numbers)) and all_hold((claim,), numbers) is False


def simple_counterexample(claim: Cmp, letter: str, domain: DomainOracle) -> Numbers | None:
    """Return the first simple numbers in the domain at which a claim is broken, or None."""
    placed = _candidates(claim, letter, domain, domain.point(NEVER, names(claim)))
    return next((numbers for numbers in placed if domain.breaks(claim, numbers)), None)


def _candidates(
    claim: Cmp, letter: str, domain: DomainOracle, point: Numbers | None
) -> Iterator[Numbers]:
    """Yield points with simple values of the letter; if states tie it, as the solver finds them."""
    if point is None:
        return
    if not _tied(letter, domain):
        yield from ({**point, letter: value} for value in TRIED)
        return
    for value in TRIED[:FEW]:
        found = domain.within(Cmp("=", Sym(letter), Num(value))).point(NEVER, names(claim))
        yield from () if found is None else (found,)


def _tied(letter: str, domain: DomainOracle) -> bool:
    return any(c.op == "=" for c in connected(domain.where, {letter}))


def moved_counterexample(
    claim: Cmp, letter: str, domain: DomainOracle, own: Numbers | None = None
) -> Numbers | None:
    """Return numbers that break a claim: a simple point, or `own`, with one parameter changed.

    With `own`, the letter is tried at the sizes of parameters, too: tanh(v/v_0) bends near v_0.
    """
    near = domain.related(names(claim))
    point = {n: own[n] for n in near & own.keys()} if own else domain.point(NEVER, names(claim))
    if not point or not point.keys() >= {*names(claim)} - {letter} or _tied(letter, domain):
        return None
    others = [name for name in names(claim) if name != letter]
    sizes = dict.fromkeys((Fraction(1), *(abs(point[name]) for name in others if own)))
    for name, (factor, step), size in product(others, MOVES, filter(None, sizes)):
        for value in TRIED[:FEW]:
            numbers = {**point, name: point[name] * factor + step, letter: value * size}
            if domain.breaks(claim, numbers):
                return numbers
    return None
