"""The obligations on each law: welldef, passive, odd, rate-independent (continuous: `continuity`).

Input: an `IPHS`.  Output: obligations, their questions asked branch by branch.  Laws are in the
names of the domain: states and temperatures.
"""

from collections.abc import Iterator
from dataclasses import replace

from piezo_sym.expressions.calculus import add, increasing, mul, neg
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tidying import reflected
from piezo_sym.expressions.tree import ZERO, Call, Cmp, Expr, Mul, Node, Num, Sym, names
from piezo_sym.expressions.tree import replace as substituted
from piezo_sym.iphs import IPHS
from piezo_sym.iphs.definitions import costate_name
from piezo_sym.proofs.assumptions import Assumptions, Law, ties_of
from piezo_sym.proofs.branches import (
    TooManyBranchesError,
    branches,
    choice_conditions,
    value_conditions,
    with_choices,
)
from piezo_sym.proofs.obligations import Obligation, Question, SignOf
from piezo_sym.spec.circuit import Placed
from piezo_sym.spec.elements.ports import (
    Body,
    Conductor,
    Coupling,
    DissipativePort,
    Exchange,
    HeatInput,
    Source,
    Storage,
)
from piezo_sym.spec.names import fresh
from piezo_sym.spec.tables import condition_text


def laws_of(iphs: IPHS) -> tuple[Law, ...]:
    """Return every law of a model, in declaration order."""
    tied, stored = ties_of(iphs), dict(_energies(iphs))
    found: list[Law] = []
    for placed in iphs.circuit.ports:
        found += filter(None, (_law(iphs, placed), stored.get(placed)))
    return tuple(
        replace(law, ties=(tied[law.element],)) if law.letter and law.element in tied else law
        for law in found
    )


def _energies(iphs: IPHS) -> Iterator[tuple[Placed, Law]]:
    """Yield the energies with branches, or with value conditions that their slopes do not have."""
    stores = tuple(iphs.circuit.of(Storage, Body))
    for energy in iphs.energies:
        placed, _ = stores[energy.rows[0]]
        slopes = {claim for n in energy.rows for claim in _claims(stores[n][1].law)}
        if choice_conditions(with_choices(energy.law)) or not slopes.issuperset(
            _claims(energy.law)
        ):
            yield (
                placed,
                Law(placed.element, f"U_{placed.element}", energy.law, derived=energy.derived),
            )


def _claims(law: Expr) -> Iterator[Cmp]:
    """Yield the conditions under which a law has a value, without numeric factors."""
    for claim in value_conditions(law):
        left = claim.left.right if isinstance(claim.left, Mul) else claim.left
        plain = isinstance(claim.left, Mul) and isinstance(claim.left.left, Num)
        if not isinstance(claim.left, Num):
            yield Cmp(claim.op, left if plain else claim.left, claim.right)


def _law(iphs: IPHS, placed: Placed) -> Law | None:
    element, port = placed.element, placed.port
    match port:
        case Storage() | Body():
            return Law(element, costate_name(port), port.law, written=_apart(iphs, port.state))
        case DissipativePort():
            jumps = port.limit is not None
            jumps |= bool(getattr(iphs.model.elements[element], "discontinuous", False))
            written, rate = (port.written,) if port.written else (), port.rate_letter
            return Law(element, port.output, port.law, port.letter, jumps, (), written, rate)
        case Coupling():
            return Law(element, port.name, port.ratio)
        case Exchange() | Conductor():
            return Law(element, "conductance", port.conductance)
        case Source() | HeatInput():
            return None


def _apart(iphs: IPHS, state: str) -> tuple[Expr, ...]:
    """Return the laws and energies that stores joined into one state have by themselves."""
    joints = [j for j in iphs.junction.joints if j.kept[0].store.state == state]
    stores = [member.store for joint in joints for member in joint.members]
    return tuple(law for store in stores for law in (store.law, store.energy) if law is not None)


def welldef(laws: tuple[Law, ...], assumptions: Assumptions) -> Obligation | None:
    """State that the laws of one element have values everywhere; None if nothing is to be shown."""
    named = " and ".join(dict.fromkeys(law.name for law in laws))
    statement = f"{named}: a real value everywhere"
    element, latex = laws[0].element, r"W_k \in \mathbb{R}"
    about = assumptions.about(*laws)

    def questions() -> Iterator[Question]:
        for law in laws:
            yield from (replace(q, derived=law.derived) for q in value_questions(law.tree, about))
        for written in (written for law in laws for written in law.written):
            order = dict.fromkeys((*about.order, *names(written)))
            yield from value_questions(written, replace(about, order=tuple(order)))

    obligation = Obligation("welldef", element, statement, latex, assumptions.texts)
    obligation = obligation.asking(questions, laws[0].of_element)
    needed = obligation.questions or obligation.open_because or any(law.letter for law in laws)
    return obligation if needed else None


def value_questions(law: Expr | Cmp, assumptions: Assumptions) -> tuple[Question, ...]:
    """Return the questions whether a law, or both sides of a comparison, have a value everywhere.

    Each part must have one where it is evaluated: under the conditions around it.  The knots of a
    table must increase in all of the domain.  Raises `TooManyBranchesError` if the law has too many
    branches.
    """
    tree = Call("together", (law.left, law.right)) if isinstance(law, Cmp) else law
    pieces = branches(tree, assumptions.where)
    found: list[Question] = []
    for order in increasing(law):
        found += value_questions(order, assumptions)
        found.append(assumptions.question(f"{condition_text(order)} in a table", order))
    for branch in pieces:
        where = assumptions.where
        for part in (*branch.conditions, branch.value):
            found += part_questions(part, where, assumptions, law)
            where = (*where, *value_conditions(part), *((part,) if isinstance(part, Cmp) else ()))
    if found and len(pieces) > 1:
        found.append(replace(found[0], where=assumptions.where, branch=()).covered(pieces))
    return tuple(dict.fromkeys(found))


def part_questions(
    node: Node, where: tuple[Cmp, ...], assumptions: Assumptions, law: Expr | Cmp | None = None
) -> Iterator[Question]:
    """Yield the questions whether the parts of a smooth tree have values, inner parts first.

    The conditions of `where` beyond the assumptions are those of a branch.
    """
    for claim in value_conditions(node):
        label = f"{spell(claim.left)} {claim.op} 0"
        branch = where[len(assumptions.where) :]
        yield Question(label, assumptions.order, where, claim, claim, branch, law=law)
        where = (*where, claim)


def passive(law: Law, assumptions: Assumptions) -> Obligation:
    """State that a dissipative law takes power in: output times letter >= 0."""
    power = f"{law.name}*{law.letter}"
    assumptions = assumptions.about(law)
    obligation = Obligation(
        "passive",
        law.element,
        f"{power} >= 0",
        r"W_k z_k \ge 0",
        assumptions.texts,
        rests_on=(("welldef", law.element),),
        sign=SignOf(law.tree, law.letter, assumptions.where),
    )
    claim = Cmp(">=", mul(law.tree, Sym(law.letter)), ZERO)
    question = assumptions.question(f"{power} >= 0", claim)
    return replace(obligation, questions=branch_questions(law.tree, question, law.letter))


def branch_questions(law: Expr, question: Question, letter: str = "") -> tuple[Question, ...]:
    """Return a question on each branch of a law, and whether the branches cover all points.

    The claim compares the law, or its product with `letter`, with zero; with too many branches it
    stays as it is.
    """
    plain = question.claim.op in {">=", "="}  # holds on a branch that is zero
    try:
        pieces = branches(law, question.where)
    except TooManyBranchesError:
        return (question,)
    found = [
        replace(
            question,
            label=f"{question.label}{_under(branch.conditions)}",
            where=(*question.where, *branch.path),
            claim=Cmp(
                question.claim.op, mul(branch.value, Sym(letter)) if letter else branch.value, ZERO
            ),
            branch=branch.path,
        )
        for branch in pieces
        if not (plain and branch.value == ZERO)
    ]
    return (*found, question.covered(pieces)) if len(pieces) > 1 else tuple(found)


def conducts(law: Law, assumptions: Assumptions) -> Obligation:
    """State that heat flows from the warmer body to the colder one."""
    claim = f"{spell(law.tree)} >= 0"
    question = assumptions.question(claim, Cmp(">=", law.tree, ZERO))
    statement = f"{claim}: heat flows from warm to cold"
    sign = SignOf(law.tree, "", assumptions.where)
    obligation = Obligation(
        "passive", law.element, statement, r"\lambda \ge 0", assumptions.texts, sign=sign
    )
    return obligation.asking(
        lambda: (*value_questions(law.tree, assumptions), *branch_questions(law.tree, question)),
        law.of_element,
    )


def odd(law: Law, assumptions: Assumptions) -> Obligation:
    """State that a law is odd, which allows the mean law of the discrete gradient."""
    assumptions = assumptions.about(law)
    obligation = Obligation(
        "odd",
        law.element,
        f"{law.name}(-{law.letter}) = -{law.name}({law.letter})",
        "W_k(-z_k) = -W_k(z_k)",
        assumptions.texts,
        rests_on=(("welldef", law.element),),
        letter=law.letter,
        required=False,
    )
    try:
        turned = reflected(law.tree, law.letter)
        twice = reflected(turned, law.letter)  # the law, its signs placed as in `turned`
        total = ZERO if twice == neg(turned) else add(twice, turned)
    except ZeroDivisionError:
        return replace(obligation, open_because=f"{law.of_element} divides by zero")
    original = Cmp("=", law.tree, neg(turned))
    question = assumptions.question(obligation.statement, Cmp("=", total, ZERO), original)
    mirror = substituted(law.tree, {law.letter: neg(Sym(law.letter))})

    def questions() -> Iterator[Question]:
        if law.ties:  # then `welldef` is about some values of the letter, not about their mirrors
            yield from value_questions(mirror, assumptions)
        branches(total, assumptions.where)  # raises if there are too many
        yield from branch_questions(total, question) if total != ZERO else ()

    return obligation.asking(questions, law.of_element)


def rate_independent(law: Law, assumptions: Assumptions) -> Obligation:
    """State that a slip is homogeneous of degree 1 in the rate that drives it."""
    assumptions, c = assumptions.about(law), Sym(fresh("c", assumptions.order))
    faster = substituted(law.tree, {law.rate: mul(c, Sym(law.rate))})
    slip, other = f"{law.name}({law.letter}", mul(c, law.tree)
    obligation = Obligation(
        "rate-independent",
        law.element,
        f"{slip}, {c.name}*{law.rate}) = {c.name}*{slip}, {law.rate}) for {c.name} > 0",
        r"\mathrm{slip}(f, c v) = c\,\mathrm{slip}(f, v)",
        assumptions.texts,
        rests_on=(("welldef", law.element),),
        letter=law.rate,
        required=False,
    )
    about = replace(assumptions, order=(*assumptions.order, c.name)).given(Cmp(">", c, ZERO))
    difference = add(faster, neg(other))
    question = about.question(
        obligation.statement, Cmp("=", difference, ZERO), Cmp("=", faster, other)
    )
    return obligation.asking(lambda: branch_questions(difference, question), law.of_element)


def _under(where: tuple[Cmp, ...]) -> str:
    return f" where {' and '.join(map(condition_text, where))}" if where else ""
