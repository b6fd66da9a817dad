"""Continuity: a law with branches does not jump where two of them meet.

Input: a law.  Output: an obligation with a question on each pair of branches (`continuous`); those
that have to be asked (`neighbour_questions`); whether a law jumps at a point (`jumps`).  With each
< read as <=, the conditions of a branch describe a closed part of the domain, and the parts cover
it.  A law that is continuous on finitely many closed parts, and has equal values where they meet,
is continuous: the pasting lemma.
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from itertools import combinations, pairwise, product

from piezo_sym.expressions.calculus import add, neg
from piezo_sym.expressions.exact_eval import TooCloseError, Value, all_hold, differ, value_of
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import Call, Cmp, Expr, If, knots, names, walk
from piezo_sym.proofs.assumptions import Assumptions, Law
from piezo_sym.proofs.branches import (
    KINKED,
    Branch,
    TooManyBranchesError,
    branches,
    choice_conditions,
    opposite,
    settled,
    value_conditions,
    with_choices,
)
from piezo_sym.proofs.laws import part_questions, value_questions
from piezo_sym.proofs.obligations import NEVER, Meeting, Obligation, Question
from piezo_sym.proofs.solvers import SolverLike

#: A law with more branches is left open, as each pair is compared.
MOST = 60
RELAXED = {"<": "<=", ">": ">="}
#: Distances from a point at which a branch is searched for.
STEPS = tuple(Fraction(1, 10**n) for n in (6, 12, 18))
#: The growth of a value from one step to the next that indicates a pole.
GROWTH = 10

Numbers = Mapping[str, Fraction]


def continuous(laws: tuple[Law, ...], assumptions: Assumptions) -> Obligation | None:
    """State that the laws of one element have no jump; None if none has an edge.

    At an edge states, inputs or temperatures select another branch; parameters alone select the
    same branch throughout a run.  Laws that the spec declares discontinuous are left out.
    """
    own = [law for law in laws if not law.jumps and _edges(law, assumptions)]
    if not own:
        return None
    element, latex = own[0].element, r"W_k(z^-) = W_k(z^+)"
    statement = _statement(*own)
    obligation = Obligation("continuous", element, statement, latex, assumptions.texts)
    tables = [law for law in own if not _has_choices(law.tree)]
    alone = [law for law in tables if not law.letter]  # dissipative laws have a row welldef anyway
    valid = obligation.asking(
        lambda: (q for law in alone for q in value_questions(law.tree, assumptions)),
        own[0].of_element,
    )
    if valid.open_because:
        return valid
    given = valid.questions or len(alone) < len(tables)
    asked = obligation.asking(
        lambda: (q for law in own for q in jump_questions(law, assumptions.about(law))),
        own[0].of_element,
    )
    return replace(asked, rests_on=(("welldef", element),) if given else ())


def _statement(*laws: Law) -> str:
    named = " and ".join(dict.fromkeys(law.name for law in laws))
    if len(laws) > 1:
        return f"{named} have no jump where branches meet"
    return f"{named} has no jump where its branches meet"


def jump_questions(law: Law, assumptions: Assumptions) -> Iterator[Question]:
    """Yield a question on each pair of branches that may meet, and whether they cover all points.

    Raises `TooManyBranchesError` if the law has too many branches.
    """
    if not (_edges(law, assumptions) and _has_choices(law.tree)):
        return
    found = branches(law.tree, assumptions.where)
    if len(found) > MOST:
        raise TooManyBranchesError(MOST)
    tree = settled(law.tree, assumptions.where)
    for one, other in combinations(found, 2):
        if one.value != other.value and not _never_meet(one, other, assumptions):
            sides, may_jump = (one, other), bool(law.letter)  # only laws of dissipation may
            meeting = Meeting(tree, sides, assumptions.where, assumptions.fixed, may_jump)
            yield from (
                replace(q, derived=law.derived) for q in _meeting_questions(meeting, assumptions)
            )
    if len(found) > 1:
        asked = assumptions.question(_statement(law), Cmp("=", law.tree, law.tree))
        yield replace(asked.covered(found), derived=law.derived)


def _edges(law: Law, assumptions: Assumptions) -> list[Cmp]:
    """Return the conditions of a law's choices that parameters alone do not decide."""
    conditions = choice_conditions(with_choices(law.tree))
    return [c for c in conditions if not {*names(c)} <= assumptions.fixed]


def _has_choices(law: Expr) -> bool:
    """Return whether a law has choices or kinks outside of tables.

    Tables are continuous in all arguments where their knots increase, and have a value only there.
    """
    kinks = (n for n in walk(law) if isinstance(n, If) or (isinstance(n, Call) and not knots(n)))
    return any(isinstance(n, If) or n.function in KINKED for n in kinks)


def _never_meet(one: Branch, other: Branch, assumptions: Assumptions) -> bool:
    """Return whether parameters alone choose between two branches: then they never meet."""
    return any(
        opposite(condition) in other.conditions and {*names(condition)} <= assumptions.fixed
        for condition in one.conditions
    )


def _meeting_questions(meeting: Meeting, assumptions: Assumptions) -> Iterator[Question]:
    """Yield the questions whether two branches have values where they meet, and equal ones.

    Conditions of the domain, and those asked before, are not asked again.
    """
    one, other = meeting.sides
    where, border = assumptions.where, tuple(_border(one, other, assumptions.fixed))
    found: list[Question] = []
    for part in (*border, add(one.value, neg(other.value))):
        found += (q for q in part_questions(part, where, assumptions) if q.claim not in where)
        where = (*where, *value_conditions(part), *((part,) if isinstance(part, Cmp) else ()))
    edge = next(c for c in border if c.op == "=")
    at = f"{spell(edge.left)} = {spell(edge.right)}"
    label = f"{spell(one.value)} = {spell(other.value)} at {at}"
    claim = Cmp("=", one.value, other.value)
    found.append(replace(assumptions, where=where).question(label, claim))
    for question in found:
        yield replace(question, branch=border, meeting=meeting)


def _border(one: Branch, other: Branch, fixed: frozenset[str]) -> Iterator[Cmp]:
    """Yield the conditions where the closed parts of two branches meet; equations are edges.

    Conditions on parameters alone stay as they are: parameters are constant across an edge.
    """
    for condition in dict.fromkeys((*one.conditions, *other.conditions)):
        both = condition in one.conditions and opposite(condition) in other.conditions
        if both:
            yield Cmp("=", condition.left, condition.right)
        elif not (condition in other.conditions and opposite(condition) in one.conditions):
            same = {*names(condition)} <= fixed
            op = condition.op if same else RELAXED.get(condition.op, condition.op)
            yield Cmp(op, condition.left, condition.right)


def neighbour_questions(questions: tuple[Question, ...], solver: SolverLike) -> Iterator[Question]:
    """Yield the questions, except those on two branches that are not neighbours.

    Two branches are neighbours if no third branch has all its conditions among theirs.  If one has,
    it lies wherever the two meet, so they agree if it agrees with each.  That is asked, or follows
    in the same way: the third contradicts each in fewer conditions than they contradict each other.
    """
    yield from (q for q in questions if q.meeting is None)
    meetings = [(q.meeting.law, q) for q in questions if q.meeting]
    for law in dict.fromkeys(law for law, _ in meetings):
        own = [q for of, q in meetings if of == law]
        about = {side: q for q in own if q.meeting for side in q.meeting.sides}
        taken = tuple(side for side, q in about.items() if not _is_empty(side, q, solver))
        near = frozenset(_neighbours(taken))
        yield from (q for q in own if q.meeting and q.meeting.sides in near)


def _neighbours(taken: tuple[Branch, ...]) -> Iterator[tuple[Branch, Branch]]:
    paths = {branch: frozenset(branch.conditions) for branch in taken}
    for one, other in combinations(taken, 2):
        both = paths[one] | paths[other]
        if not any(paths[third] <= both for third in taken if third not in (one, other)):
            yield from ((one, other), (other, one))


def _is_empty(branch: Branch, question: Question, solver: SolverLike) -> bool:
    """Return whether a branch is shown to be empty in the domain."""
    assert question.meeting is not None
    if any(opposite(condition) in branch.conditions for condition in branch.conditions):
        return True
    where = (*question.meeting.domain, *branch.conditions)
    asked = replace(question, where=where, claim=NEVER, branch=branch.conditions)
    return solver.ask(asked.query).result == "unsat"


def jumps(meeting: Meeting, values: Numbers) -> bool:
    """Return whether a law certainly jumps where two branches meet, or has no value there."""
    try:
        at = value_of(meeting.law, values)
    except TooCloseError:
        return False
    except (ArithmeticError, ValueError):
        return True
    return any(_other_limit(side, meeting, at, values) for side in meeting.sides)


def _other_limit(side: Branch, meeting: Meeting, at: Value, values: Numbers) -> bool:
    """Return whether a branch reaches a point with a limit other than the law's value there."""
    try:
        apart = differ(value_of(side.value, values), at)
    except TooCloseError:
        return False
    except (ArithmeticError, ValueError):
        ways = _approaches(side, meeting, values)
        sizes = ([_size(meeting.law, point) for point in way] for way in ways)
        return any(s[0] > 0 and all(b > GROWTH * a for a, b in pairwise(s)) for s in sizes)
    return apart and any(True for _ in _approaches(side, meeting, values))


def _size(law: Expr, values: Numbers) -> float:
    try:
        return abs(float(value_of(law, values)))
    except (ArithmeticError, ValueError):
        return 0.0


def _approaches(side: Branch, meeting: Meeting, values: Numbers) -> Iterator[list[Numbers]]:
    """Yield, for each direction in which a branch reaches a point, points of it nearer and nearer.

    Parameters are kept: no run crosses a jump along them.
    """
    for way in _directions(tuple(name for name in values if name not in meeting.fixed)):
        points: list[Numbers] = [
            {n: v + step * way.get(n, 0) for n, v in values.items()} for step in STEPS
        ]
        conditions = [
            c for c in (*meeting.domain, *side.conditions) if values.keys() >= {*names(c)}
        ]
        if all(all_hold(conditions, point) for point in points):
            yield points


def _directions(order: tuple[str, ...]) -> Iterator[Mapping[str, int]]:
    for name, sign in product(order, (1, -1)):
        yield {name: sign}
    for (one, other), sign, factor in product(combinations(order, 2), (1, -1), (1, -1, 2, -2)):
        yield {one: sign, other: factor}
