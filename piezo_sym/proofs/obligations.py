"""The types of what has to be shown of a model.

`balances`, `bodies`, `laws`, `continuity` and `domain` state `Obligation` records, `prove` decides
them.  An obligation holds if its residuals are zero, the claims of its questions follow, and the
obligations it rests on hold.
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
    branches,
    cover,
    has_kinks,
    parts,
    settled,
)
from piezo_sym.proofs.query import Query, query
from piezo_sym.proofs.rational import cleared, implied, parts_of
from piezo_sym.report import Stated

#: A claim that holds nowhere, and so follows only from conditions that no point satisfies.
NEVER = Cmp("<", ONE, ZERO)


@final
@dataclass(frozen=True)
class Meeting:
    """Two branches that must agree where they meet; `fixed` names are constant in a run."""

    law: Expr
    sides: tuple[Branch, Branch]
    domain: tuple[Cmp, ...]
    fixed: frozenset[str] = frozenset()
    may_jump: bool = False  # whether a spec can declare that the law jumps


@final
@dataclass(frozen=True)
class Question:
    """A claim for all real numbers where some comparisons hold."""

    label: str  # the claim in words
    order: tuple[str, ...]  # names, in the order in which a witness should be simple
    where: tuple[Cmp, ...]  # the assumptions; they may have kinks and functions
    claim: Cmp  # what should follow, usually about one branch of a law
    original: Cmp  # the claim on the law as the spec has it, on which a witness is checked
    branch: tuple[Cmp, ...] = ()  # those of the assumptions that select the branch
    #: On the border of two branches: these branches; a witness must show a jump.
    meeting: Meeting | None = None
    #: For the question whether a law has a value: the law; at a witness it must have none.
    law: Expr | Cmp | None = None
    #: Whether all assumptions go into the query, as a counterexample needs; a proof needs those
    #: that bind the names of the claim.
    keep_all: bool = False
    split: bool = True  # whether the claim is asked on each of its branches
    witness: bool = False  # whether numbers that break the claim are wanted
    derived: bool = False  # whether it is about an integrated energy; breaking that refutes no spec
    rising: str = ""  # what has to rise with S, energy or temperature, if the claim says that

    def __hash__(self) -> int:
        """Return a hash without the assumptions, which questions of a model share."""
        return hash((self.label, self.claim, self.original, self.branch))

    @cached_property
    def kept(self) -> tuple[Cmp, ...]:
        """The assumptions that go into the query."""
        return self.where if self.keep_all else binding(self.where, frozenset(self._about()))

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
            witness=self.witness or self.keep_all,
        )

    def smooth(self) -> tuple[Question, ...]:
        """Return the question on each smooth branch of its claim.

        With several branches, one more question asks whether they cover all points; with too many,
        the claim stays as it is.
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
        plain = replace(self, meeting=None, law=None, split=False, rising="")
        return replace(plain, label=label, claim=claim, original=claim)

    def _about(self) -> Iterator[str]:
        """Yield the names that the claim, or a witness, is about."""
        for condition in (self.claim, self.original, *self.branch):
            yield from names(condition)
        if self.meeting:
            yield from names(self.meeting.law)
        if self.law and self.keep_all:
            yield from names(self.law)


@final
@dataclass(frozen=True)
class Residual:
    """An expression that must be zero, and its name."""

    place: str
    expr: sp.Expr
    #: Questions whether certain branches are empty; on all others `expr` was found to be zero.
    empty: tuple[Question, ...] = ()
    derived: bool = False  # whether it is about an integrated energy


def _settled(condition: Cmp, known: tuple[Cmp, ...]) -> Cmp:
    """Return a comparison with its kinks as choices, some decided by the other `known` ones."""
    if not has_kinks(condition):
        return condition
    others = tuple(other for other in known if other != condition)
    left, right = (settled(side, others) for side in (condition.left, condition.right))
    return Cmp(condition.op, left, right)


def _signed(condition: Cmp) -> str:
    """Return the name that a comparison keeps from zero, or ''."""
    match condition:
        case Cmp("<" | ">", Sym(name), Num(value)) if value == 0:
            return name
    return ""


@final
@dataclass(frozen=True)
class SignOf:
    """The claim law*letter >= 0, for methods that treat the law as a whole."""

    law: Expr
    letter: str  # empty for a conductance: the claim is then law >= 0
    #: The assumptions at every point: the domain and ties of names, but no branch.
    where: tuple[Cmp, ...] = ()


@final
@dataclass(frozen=True)
class Obligation:
    """One property of one model."""

    id: str  # such as ``passive``
    element: str  # the element it is about, or empty for the whole model
    #: statement, latex: the property, in words and as mathematics.
    statement: str
    latex: str
    #: The comparisons of the domain that it is stated under, as text.
    assumptions: tuple[str, ...] = ()
    residuals: tuple[Residual, ...] = ()  # must be zero
    questions: tuple[Question, ...] = ()  # their claims must follow
    #: Other obligations, as (id, element), that must hold.
    rests_on: tuple[tuple[str, str], ...] = ()
    sign: SignOf | None = None  # the law whose sign the questions are about, if they are
    letter: str = ""  # the letter whose simple values are tried if questions stay open
    required: bool = True  # whether `generate` insists on it; else it is information
    #: A letter that the domain may bound in an unknown way, as its drive is no expression in states
    #: and inputs: numbers for it refute nothing.
    loose: str = ""
    open_because: str = ""  # why no questions could be asked

    def published(self) -> Stated:
        """Return the parts of the obligation that a report publishes beside its row."""
        queries = ((question.query.label, question.query.text()) for question in self.questions)
        return Stated(self.latex, self.assumptions, self.rests_on, tuple(queries))

    def smooth(self) -> Obligation:
        """Return the obligation with its claims split into smooth ones."""
        parts = dict.fromkeys(part for q in self.questions for part in q.smooth())
        return replace(self, questions=tuple(parts))

    def asking(self, questions: Callable[[], Iterable[Question]], law: str) -> Obligation:
        """Return the obligation with questions, or left open if `law` has too many branches."""
        try:
            return replace(self, questions=tuple(dict.fromkeys(questions())))
        except TooManyBranchesError as error:
            reason = f"{law} has more than {error.most} branches; use fewer kinks"
            return replace(self, open_because=reason)
