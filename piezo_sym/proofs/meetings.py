"""Which branches of a law have to be compared: those that are taken, with none in between.

Input: questions on pairs of branches that meet, and a solver.  Output: the questions left, from
which the others follow.
"""

from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations

from piezo_sym.expressions.tree import ONE, ZERO, Cmp
from piezo_sym.proofs.branches import Branch, opposite
from piezo_sym.proofs.obligations import Question
from piezo_sym.proofs.solvers import Asks


def needed(questions: tuple[Question, ...], solver: Asks) -> Iterator[Question]:
    """Yield the questions that are left: of those on two branches, the ones on neighbours.

    Two branches are neighbours if there is no third whose conditions are all among theirs.  Where
    two others meet, such a third meets both; that each of them agrees with it is asked, or follows
    in the same way: the third contradicts each of them in fewer conditions than they do each other.
    """
    about = {side: q for q in questions if q.meeting for side in q.meeting.sides}
    taken = tuple(side for side, question in about.items() if not _empty(side, question, solver))
    near = frozenset(_neighbours(taken))
    yield from (q for q in questions if q.meeting is None or q.meeting.sides in near)


def _neighbours(taken: tuple[Branch, ...]) -> Iterator[tuple[Branch, Branch]]:
    paths = {branch: frozenset(branch.conditions) for branch in taken}
    for one, other in combinations(taken, 2):
        both = paths[one] | paths[other]
        if not any(paths[third] <= both for third in taken if third not in (one, other)):
            yield from ((one, other), (other, one))


def _empty(branch: Branch, question: Question, solver: Asks) -> bool:
    """Return whether a branch is shown to be taken nowhere in the domain."""
    assert question.meeting is not None
    if any(opposite(condition) in branch.conditions for condition in branch.conditions):
        return True
    never = Cmp("<", ONE, ZERO)
    where = (*question.meeting.domain, *branch.conditions)
    asked = replace(question, where=where, claim=never, branch=branch.conditions)
    return solver.ask(asked.query()).result == "unsat"
