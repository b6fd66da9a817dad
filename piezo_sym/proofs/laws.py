"""What has to be shown of each law: welldef, passive, odd (and continuous, in `continuity`).

Input: an `IPHS`.  Output: obligations, their questions asked branch by branch.  Laws stand in the
words of the domain: a state by its symbol, the temperature of the body that is heated by its own.
"""

from __future__ import annotations

from dataclasses import replace

from piezo_sym.expressions.calculus import add, increasing, mul, neg
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import (
    ZERO,
    Call,
    Cmp,
    Expr,
    Node,
    Sym,
    names,
    rename,
)
from piezo_sym.expressions.tree import replace as substituted
from piezo_sym.iphs import IPHS
from piezo_sym.proofs.assumptions import Assumptions, Law
from piezo_sym.proofs.branches import MOST, TooManyBranchesError, branches, partial
from piezo_sym.proofs.obligations import Obligation, Question, SignOf
from piezo_sym.proofs.reflection import reflected
from piezo_sym.proofs.ties import ties
from piezo_sym.spec.circuit import Placed
from piezo_sym.spec.elements.ports import (
    Body,
    Conductor,
    Coupling,
    Exchange,
    Resistor,
    Source,
    Storage,
)
from piezo_sym.spec.tables import condition_text


def laws_of(iphs: IPHS) -> tuple[Law, ...]:
    """Return every law of a model, in declaration order."""
    heat = {placed.element: port.temperature for placed, port in iphs.circuit.of(Body)}
    tied = ties(iphs)
    found = [law for placed in iphs.circuit.ports if (law := _law(iphs, placed, heat))]
    return tuple(
        replace(law, ties=(tied[law.element],)) if law.letter and law.element in tied else law
        for law in found
    )


def _law(iphs: IPHS, placed: Placed, heat: dict[str, str]) -> Law | None:
    element, port = placed.element, placed.port
    jumps = bool(getattr(iphs.model.elements[element], "discontinuous", False))
    match port:
        case Storage():
            return Law(element, port.costate, rename(port.law, {port.letter: port.state}))
        case Body():
            return Law(element, port.temperature, rename(port.law, {port.letter: port.state}))
        case Resistor():
            words = {"T": heat[port.heats]}
            written = rename(port.written, words) if port.written else None
            law = rename(port.law, words)
            return Law(element, port.output, law, port.letter, jumps, written=written)
        case Coupling():
            words = {"T": heat[port.body]} if port.body else {}
            return Law(element, port.name, rename(port.ratio, words))
        case Exchange() | Conductor():
            return Law(element, "conductance", port.conductance)
        case Source():
            return None


def welldef(laws: tuple[Law, ...], assumptions: Assumptions) -> Obligation | None:
    """State that the laws of one element have values everywhere; None if they cannot lack one."""
    named = " and ".join(dict.fromkeys(law.name for law in laws))
    statement = f"{named}: a real value everywhere"
    element, latex = laws[0].element, r"W_k \in \mathbb{R}"
    made = Obligation("welldef", element, statement, latex, assumptions.texts)
    assumptions = assumptions.about(*laws)
    try:
        found = [question for law in laws for question in valued(law.tree, assumptions)]
        for written in (law.written for law in laws if law.written):
            order = dict.fromkeys((*assumptions.order, *names(written)))
            found += valued(written, replace(assumptions, order=tuple(order)))
    except TooManyBranchesError:
        return replace(made, open_because=too_many(laws[0]))
    needed = found or any(law.letter for law in laws)
    return replace(made, questions=tuple(dict.fromkeys(found))) if needed else None


def valued(law: Expr | Cmp, assumptions: Assumptions) -> tuple[Question, ...]:
    """Return the questions whether a law, or both sides of a comparison, have a value everywhere.

    Each part is asked about where it is evaluated: under the conditions around it alone; of a table
    that its knots increase is asked in all of the domain.

    Raises
    ------
    TooManyBranchesError
        If the law has too many branches.
    """
    tree = Call("together", (law.left, law.right)) if isinstance(law, Cmp) else law
    pieces = branches(tree, assumptions.where)
    found: list[Question] = []
    for order in increasing(law):
        found += valued(order, assumptions)
        label = f"{condition_text(order)} in a table"
        found.append(Question(label, assumptions.order, assumptions.where, order, order))
    for branch in pieces:
        where = assumptions.where
        for part in (*branch.conditions, branch.value):
            where = ask(found, part, where, assumptions, law)
            where = (*where, part) if isinstance(part, Cmp) else where
    if found and len(pieces) > 1:
        found.append(replace(found[0], where=assumptions.where, branch=()).covered(pieces))
    return tuple(dict.fromkeys(found))


def ask(
    found: list[Question],
    node: Node,
    where: tuple[Cmp, ...],
    assumptions: Assumptions,
    law: Expr | Cmp | None = None,
) -> tuple[Cmp, ...]:
    """Add the questions whether `node` has a value; return what is then known."""
    for claim in partial(node):
        label = f"{spell(claim.left)} {claim.op} 0"
        branch = where[len(assumptions.where) :]
        found.append(Question(label, assumptions.order, where, claim, claim, branch, law=law))
        where = (*where, claim)
    return where


def passive(law: Law, assumptions: Assumptions) -> Obligation:
    """State that a dissipative law takes power in: its output times its letter is not negative."""
    power = f"{law.name}*{law.letter}"
    assumptions = assumptions.about(law)
    made = Obligation(
        "passive",
        law.element,
        f"{power} >= 0",
        r"W_k z_k \ge 0",
        assumptions.texts,
        rests_on=(("welldef", law.element),),
        sign=SignOf(law.tree, law.letter, assumptions.where),
    )
    claim = Cmp(">=", mul(law.tree, Sym(law.letter)), ZERO)
    question = Question(f"{power} >= 0", assumptions.order, assumptions.where, claim, claim)
    return replace(made, questions=on_branches(law.tree, question, law.letter))


def on_branches(law: Expr, question: Question, letter: str = "") -> tuple[Question, ...]:
    """Return a question on each branch of a law, and whether they cover all points.

    The claim compares the law, or its product with `letter`, with zero; where there are too many
    branches it stays as it is.
    """
    plain = question.claim.op in {">=", "="}  # a branch that is zero has nothing to show
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
                question.claim.op,
                mul(branch.value, Sym(letter)) if letter else branch.value,
                ZERO,
            ),
            branch=branch.path,
        )
        for branch in pieces
        if not (plain and branch.value == ZERO)
    ]
    return (*found, question.covered(pieces)) if len(pieces) > 1 else tuple(found)


def conducts(law: Law, assumptions: Assumptions) -> Obligation:
    """State that heat flows from the warmer body to the colder one."""
    claim = Cmp(">=", law.tree, ZERO)
    question = Question(
        f"{spell(law.tree)} >= 0", assumptions.order, assumptions.where, claim, claim
    )
    statement = f"{spell(law.tree)} >= 0: heat flows from warm to cold"
    made = Obligation("passive", law.element, statement, r"\lambda \ge 0", assumptions.texts)
    try:
        found = valued(law.tree, assumptions)
    except TooManyBranchesError:
        return replace(made, open_because=too_many(law))
    return replace(made, questions=(*found, *on_branches(law.tree, question)))


def odd(law: Law, assumptions: Assumptions) -> Obligation:
    """State that a law is odd, which allows the mean law of the discrete gradient."""
    assumptions = assumptions.about(law)
    made = Obligation(
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
        twice = reflected(turned, law.letter)  # signs then stand alike in both
        total = ZERO if twice == neg(turned) else add(twice, turned)
    except ZeroDivisionError:
        return replace(made, open_because=f"the law of {law.element} divides by zero")
    claim = Cmp("=", total, ZERO)
    original = Cmp("=", law.tree, neg(turned))
    question = Question(made.statement, assumptions.order, assumptions.where, claim, original)
    mirror = substituted(law.tree, {law.letter: neg(Sym(law.letter))})
    try:  # the mirrored law has values, too: `welldef` is about those that the letter takes
        found = valued(mirror, assumptions) if law.ties else ()
        branches(total, assumptions.where)  # or there are too many
    except TooManyBranchesError:
        return replace(made, open_because=too_many(law))
    mirrored = on_branches(total, question) if total != ZERO else ()
    return replace(made, questions=(*found, *mirrored))


def _under(where: tuple[Cmp, ...]) -> str:
    return f" where {' and '.join(map(condition_text, where))}" if where else ""


def too_many(law: Law) -> str:
    """Return why a law with too many branches is left open."""
    return f"the law of {law.element} has more than {MOST} branches; use fewer kinks"
