"""What has to be shown of a model, as data.

Input: nothing; these are the types.  Output: `Obligation` records that `algebra`, `laws` and
`balances` state and `prove` decides.  An obligation holds if its residuals are zero, its questions
are answered, and the obligations it rests on hold.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import final

import sympy as sp

from piezo_sym.proofs.branches import (
    MOST,
    Branch,
    TooManyBranchesError,
    branches,
    parts,
    smooth_clauses,
)
from piezo_sym.proofs.query import Query, connected, query
from piezo_sym.proofs.rational import cleared, parts_of
from piezo_sym.spec.expressions import Call, Cmp, Expr, names


@final
@dataclass(frozen=True)
class Residual:
    """An expression that a property says is zero, and the name of its place."""

    place: str
    expr: sp.Expr


@final
@dataclass(frozen=True)
class Meeting:
    """Two branches of a law that must agree where they meet."""

    law: Expr
    sides: tuple[Branch, Branch]
    domain: tuple[Cmp, ...]


@final
@dataclass(frozen=True)
class Question:
    """A claim on smooth laws, for every real number where some comparisons hold.

    Attributes
    ----------
    label : the claim in words.
    order : names, in the order in which a witness should be simple.
    where : what is assumed.
    claim : what should follow, on one branch of a law.
    original : the same on the law as the spec has it; a witness is checked on this.
    branch : the part of `where` that says which branch it is.
    meeting : for a question on the border of two branches, these; a witness must show a jump.
    whole : whether all that is assumed goes into the query, as a counterexample needs; a proof
        needs what is connected to the claim by names.
    """

    label: str
    order: tuple[str, ...]
    where: tuple[Cmp, ...]
    claim: Cmp
    original: Cmp
    branch: tuple[Cmp, ...] = ()
    meeting: Meeting | None = None
    whole: bool = False

    def query(self) -> Query:
        """Return the question in polynomials, for a solver.

        Raises
        ------
        TooManyBranchesError
            If a condition of the domain has too many branches.
        """
        return self._query

    @cached_property
    def _query(self) -> Query:
        about = {*names(self.claim), *self._about()}
        kept = self.where if self.whole else connected(self.where, about)
        assumed = [clause for condition in kept for clause in smooth_clauses(condition)]
        conditions = [*(part for clause in assumed for part in clause), self.claim]
        sides = [side for c in conditions for side in (c.left, c.right)]
        taken = frozenset(name for side in sides for name in names(side))
        known = parts_of(sides, taken)

        def plain(condition: Cmp) -> Cmp:
            left, right = map(known.without_functions, (condition.left, condition.right))
            return cleared(Cmp(condition.op, left, right))

        given = [tuple(map(plain, clause)) for clause in assumed]
        words = (*about, *(name for condition in kept for name in names(condition)))
        return query(
            self.label, self.order, [*given, *known.facts()], plain(self.claim), about=words
        )

    def smooth(self) -> tuple[Question, ...]:
        """Return the question, or if its claim has kinks, the same on each branch of it.

        Raises
        ------
        TooManyBranchesError
            If there are too many.
        """
        found = branches(Call("together", (self.claim.left, self.claim.right)))
        if len(found) == 1:
            return (self,)
        claims = [Cmp(self.claim.op, *parts(branch)) for branch in found]
        return tuple(
            replace(self, where=(*self.where, *b.conditions), claim=claim, branch=b.conditions)
            for b, claim in zip(found, claims, strict=True)
        )

    def _about(self) -> Iterator[str]:
        """Yield the names that a witness needs: of the law, and of what says where it is."""
        for condition in (self.original, *self.branch):
            yield from names(condition)
        if self.meeting:
            yield from names(self.meeting.law)


@final
@dataclass(frozen=True)
class SignOf:
    """The sign of a law times its letter in a domain, for methods that look at the whole law."""

    law: Expr
    letter: str
    where: tuple[Cmp, ...] = ()


@final
@dataclass(frozen=True)
class Obligation:
    """One property of one model.

    Attributes
    ----------
    id : such as ``passive``.
    element : the element it is about, or empty for the whole model.
    statement, latex : the property, in words and as mathematics.
    assumptions : the comparisons of the domain that it is stated under, as text.
    residuals : must be zero.
    questions : must be answered with yes.
    rests_on : other obligations, as (id, element), that must hold.
    sign : the law behind the questions, where it is one law's sign.
    letter : a letter whose simple values are tried where questions are left open.
    required : whether `generate` insists on it; else it is information.
    open_because : why nothing could be asked, where a law is beyond what is looked at.
    """

    id: str
    element: str
    statement: str
    latex: str
    assumptions: tuple[str, ...] = ()
    residuals: tuple[Residual, ...] = ()
    questions: tuple[Question, ...] = ()
    rests_on: tuple[tuple[str, str], ...] = ()
    sign: SignOf | None = None
    letter: str = ""
    required: bool = True
    open_because: str = ""

    def smooth(self) -> Obligation:
        """Return the obligation with questions on smooth claims only."""
        try:
            questions = tuple(part for q in self.questions for part in q.smooth())
        except TooManyBranchesError:
            reason = f"its claims have more than {MOST} branches; use fewer kinks"
            return replace(self, questions=(), open_because=reason)
        return replace(self, questions=questions)
