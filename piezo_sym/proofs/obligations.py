"""What has to be shown of a model, as data.

Input: nothing; these are the types.  Output: `Obligation` records that `balances`, `bodies`,
`laws`, `continuity` and `domain` state and `prove` decides.  An obligation holds if its residuals
are zero, its questions are answered with yes, and the obligations it rests on hold.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import final

import sympy as sp

from piezo_sym.expressions.tree import ONE, ZERO, Call, Cmp, Expr, Num, Sym, names
from piezo_sym.proofs.binding import binding
from piezo_sym.proofs.branches import (
    Branch,
    TooManyBranchesError,
    bends,
    branches,
    cover,
    parts,
    settled,
)
from piezo_sym.proofs.query import Query, query
from piezo_sym.proofs.rational import cleared, implied, parts_of

#: A claim that holds nowhere: it follows only where nothing is.
NEVER = Cmp("<", ONE, ZERO)


@final
@dataclass(frozen=True)
class Meeting:
    """Two branches that must agree where they meet; `fixed` names do not change in a run."""

    law: Expr
    sides: tuple[Branch, Branch]
    domain: tuple[Cmp, ...]
    fixed: frozenset[str] = frozenset()


@final
@dataclass(frozen=True)
class Question:
    """A claim for all real numbers where some comparisons hold.

    Attributes
    ----------
    label : the claim in words.
    order : names, in the order in which a witness should be simple.
    where : what is assumed; comparisons may have kinks and functions.
    claim : what should follow, as a rule on one branch of a law.
    original : the same on the law as the spec has it; a witness is checked on this.
    branch : the part of `where` that says which branch it is.
    meeting : for a question on the border of two branches, these; a witness must show a jump.
    law : for a question whether a law has a value, that law; at a witness it must have none.
    whole : whether all that is assumed goes into the query, as a counterexample needs; a proof
        needs what binds the names of the claim.
    split : whether the claim is asked on each of its branches.
    witness : whether numbers that break the claim are wanted, as those of a counterexample are.
    found : whether it is about an energy that no spec gives: what breaks that refutes no spec.
    """

    label: str
    order: tuple[str, ...]
    where: tuple[Cmp, ...]
    claim: Cmp
    original: Cmp
    branch: tuple[Cmp, ...] = ()
    meeting: Meeting | None = None
    law: Expr | Cmp | None = None
    whole: bool = False
    split: bool = True
    witness: bool = False
    found: bool = False

    def __hash__(self) -> int:
        """Return a hash without the assumptions, which questions of a model have in common."""
        return hash((self.label, self.claim, self.original, self.branch))

    @cached_property
    def kept(self) -> tuple[Cmp, ...]:
        """What of `where` goes into the query."""
        return self.where if self.whole else binding(self.where, frozenset(self._about()))

    @cached_property
    def words(self) -> frozenset[str]:
        """The model's own names in the query."""
        found = (name for condition in self.kept for name in names(condition))
        return frozenset((*self._about(), *found))

    @cached_property
    def query(self) -> Query:
        """The question in polynomials and choices, for a solver."""
        kept = self.kept
        given = tuple(_settled(condition, kept) for condition in kept)
        claim = _settled(self.claim, kept)
        sides = [side for c in (*given, claim) for side in (c.left, c.right)]
        known = parts_of(sides, self.words.union(self.order))

        def plain(condition: Cmp) -> Cmp:
            left, right = map(known.without_functions, (condition.left, condition.right))
            return Cmp(condition.op, left, right)

        signed = frozenset(map(_signed, given))
        clauses = [implied(plain(condition), signed) for condition in given]
        return query(
            self.label,
            self.order,
            (*clauses, *known.facts(signed)),
            cleared(plain(claim)),
            about=self.words,
            witness=self.witness or self.whole,
        )

    def smooth(self) -> tuple[Question, ...]:
        """Return the question, or if its claim has kinks, the same on each branch of it.

        Where there are several branches, one more question says that they cover all points; where
        there are too many, the claim stays as it is.
        """
        if not self.split:
            return (self,)
        try:
            found = branches(Call("together", (self.claim.left, self.claim.right)), self.where)
        except TooManyBranchesError:
            return (self,)
        if len(found) == 1:
            return (replace(self, claim=Cmp(self.claim.op, *parts(found[0]))),)
        return (
            *(
                replace(
                    self,
                    where=(*self.where, *branch.conditions),
                    claim=Cmp(self.claim.op, *parts(branch)),
                    branch=(*self.branch, *branch.conditions),
                )
                for branch in found
            ),
            self.covered(found),
        )

    def covered(self, found: tuple[Branch, ...]) -> Question:
        """Return the question whether branches cover all points."""
        label, claim = f"{self.label}: the branches cover all points", cover(found)
        plain = replace(self, meeting=None, law=None, split=False)
        return replace(plain, label=label, claim=claim, original=claim)

    def _about(self) -> Iterator[str]:
        """Yield the names that a claim or a witness needs: of the law, and of where it is."""
        for condition in (self.claim, self.original, *self.branch):
            yield from names(condition)
        if self.meeting:
            yield from names(self.meeting.law)
        if self.law and self.whole:
            yield from names(self.law)


@final
@dataclass(frozen=True)
class Residual:
    """An expression that a property says is zero, and the name of its place.

    Attributes
    ----------
    empty : questions whether branches are taken nowhere; on all others it is zero.
    found : whether it is about an energy that no spec gives.
    """

    place: str
    expr: sp.Expr
    empty: tuple[Question, ...] = ()
    found: bool = False


def _settled(condition: Cmp, known: tuple[Cmp, ...]) -> Cmp:
    """Return a comparison with choices for its kinks; other comparisons decide some of them."""
    if not bends(condition):
        return condition
    others = tuple(other for other in known if other != condition)
    left, right = (settled(side, others) for side in (condition.left, condition.right))
    return Cmp(condition.op, left, right)


def _signed(condition: Cmp) -> str:
    """Return the name that a comparison says is not zero, or nothing."""
    match condition:
        case Cmp("<" | ">", Sym(name), Num(value)) if value == 0:
            return name
    return ""


@final
@dataclass(frozen=True)
class SignOf:
    """The sign of a law times its letter, for methods that look at the law as a whole.

    Attributes
    ----------
    letter : empty for a conductance, which must not be negative itself.
    where : what is assumed at every point: the domain, and what ties names; no branch's conditions.
    """

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
    loose : a letter that the domain may bound by a drive that is not written out; what its value
        refutes is then OPEN.
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
    loose: str = ""
    open_because: str = ""

    @property
    def queries(self) -> tuple[Query, ...]:
        """The queries of its questions, for solvers."""
        return tuple(question.query for question in self.questions)

    def smooth(self) -> Obligation:
        """Return the obligation with its claims split into smooth ones."""
        return replace(
            self, questions=_each_once(part for q in self.questions for part in q.smooth())
        )

    def asking(self, questions: Callable[[], Iterable[Question]], law: str) -> Obligation:
        """Return the obligation with questions, or left open where `law` has too many branches."""
        try:
            return replace(self, questions=_each_once(questions()))
        except TooManyBranchesError as error:
            reason = f"{law} has more than {error.most} branches; use fewer kinks"
            return replace(self, open_because=reason)


def _each_once(questions: Iterable[Question]) -> tuple[Question, ...]:
    return tuple(dict.fromkeys(questions))
