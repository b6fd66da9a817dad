"""What has to be shown of a law with branches: that it does not jump where two of them meet.

Input: a law.  Output: an obligation, its questions asked of each pair of branches.  With each <
read as <=, the conditions of a branch describe a closed part of the domain; the parts cover it.  A
law that is continuous on each of finitely many closed parts, and agrees with itself where they
meet, is continuous: the pasting lemma.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations

from piezo_sym.expressions.calculus import add, neg
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import Call, Cmp, Expr, If, knots, names, walk
from piezo_sym.proofs.assumptions import Assumptions, Law
from piezo_sym.proofs.branches import (
    KINKED,
    Branch,
    TooManyBranchesError,
    branches,
    choices,
    opposite,
    settled,
    with_choices,
)
from piezo_sym.proofs.laws import ask, too_many, valued
from piezo_sym.proofs.obligations import Meeting, Obligation, Question

#: More branches than these are not compared, each with each.
MOST = 60
RELAXED = {"<": "<=", ">": ">="}


def continuous(law: Law, assumptions: Assumptions) -> Obligation | None:
    """State that a law has no jump; None if it has no edge to jump at, or jumps on purpose.

    An edge is where states, inputs or temperatures choose another branch: a branch chosen by
    parameters alone is the same throughout a run.
    """
    statement = f"{law.name} has no jump where its branches meet"
    latex = r"W_k(z^-) = W_k(z^+)"
    made = Obligation("continuous", law.element, statement, latex, assumptions.texts)
    assumptions = assumptions.about(law)
    edges = [c for c in choices(with_choices(law.tree)) if not {*names(c)} <= assumptions.fixed]
    if law.jumps or not edges:
        return None
    try:
        if not _chooses(law.tree):
            asked = law.letter or valued(
                law.tree, assumptions
            )  # else knots are numbers that increase
            return replace(made, rests_on=(("welldef", law.element),) if asked else ())
        found = branches(law.tree, assumptions.where)
    except TooManyBranchesError:
        return replace(made, open_because=too_many(law))
    if len(found) > MOST:
        reason = f"the law of {law.element} has {len(found)} branches, too many to compare in pairs"
        return replace(made, open_because=f"{reason}; use fewer kinks")
    tree = settled(law.tree, assumptions.where)
    questions = [
        question
        for one, other in combinations(found, 2)
        if one.value != other.value and not _apart(one, other, assumptions)
        for question in _meeting(
            Meeting(tree, (one, other), assumptions.where, assumptions.fixed), assumptions
        )
    ]
    whole = Cmp("=", law.tree, law.tree)
    covered = Question(statement, assumptions.order, assumptions.where, whole, whole).covered(found)
    return replace(made, questions=(*dict.fromkeys(questions), *([covered] * (len(found) > 1))))


def _chooses(law: Expr) -> bool:
    """Return whether a law chooses other than by tables, which are continuous in all arguments.

    That holds where their knots increase, and a law has a value only there.
    """
    kinks = (n for n in walk(law) if isinstance(n, If) or (isinstance(n, Call) and not knots(n)))
    return any(isinstance(n, If) or n.function in KINKED for n in kinks)


def _apart(one: Branch, other: Branch, assumptions: Assumptions) -> bool:
    """Return whether two branches are chosen by parameters alone, so that they never meet."""
    return any(
        opposite(condition) in other.conditions and {*names(condition)} <= assumptions.fixed
        for condition in one.conditions
    )


def _meeting(meeting: Meeting, assumptions: Assumptions) -> Iterator[Question]:
    """Yield the questions whether two branches have values, and the same, where they meet."""
    one, other = meeting.sides
    found: list[Question] = []
    where, border = assumptions.where, tuple(_border(one, other, assumptions.fixed))
    for condition in border:
        where = (*ask(found, condition, where, assumptions), condition)
    where = ask(found, add(one.value, neg(other.value)), where, assumptions)
    claim = Cmp("=", one.value, other.value)
    edge = next(c for c in border if c.op == "=")
    at = f"{spell(edge.left)} = {spell(edge.right)}"
    label = f"{spell(one.value)} = {spell(other.value)} at {at}"
    found.append(Question(label, assumptions.order, where, claim, claim))
    for question in found:
        yield replace(question, branch=border, meeting=meeting)


def _border(one: Branch, other: Branch, fixed: frozenset[str]) -> Iterator[Cmp]:
    """Yield what holds where the closed parts of two branches meet; one comparison is an edge.

    What parameters alone decide stays as it is: they are the same on both sides of an edge.
    """
    for condition in dict.fromkeys((*one.conditions, *other.conditions)):
        both = condition in one.conditions and opposite(condition) in other.conditions
        if both:
            yield Cmp("=", condition.left, condition.right)
        elif not (condition in other.conditions and opposite(condition) in one.conditions):
            same = {*names(condition)} <= fixed
            op = condition.op if same else RELAXED.get(condition.op, condition.op)
            yield Cmp(op, condition.left, condition.right)
