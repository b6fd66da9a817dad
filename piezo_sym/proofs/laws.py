"""What has to be shown of each law: welldef, continuous, passive, odd.

Input: an `IPHS`.  Output: obligations, their questions asked branch by branch.  Laws stand in the
words of the domain: a state by its symbol, the temperature of the body that is heated by its own.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import final

from piezo_sym.iphs import IPHS
from piezo_sym.proofs.branches import (
    MOST,
    TooManyBranchesError,
    branches,
    choices,
    decided,
    parts,
    with_choices,
)
from piezo_sym.proofs.obligations import Obligation, Question, SignOf
from piezo_sym.proofs.reflection import reflected
from piezo_sym.spec.calculus import add, mul, neg
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
from piezo_sym.spec.expressions import ZERO, Call, Cmp, Div, Expr, Node, Num, Pow, Sym, rename, walk
from piezo_sym.spec.tables import condition_text, conditions
from piezo_sym.spec.text import spell


@final
@dataclass(frozen=True)
class Law:
    """A law of an element, in the words of the domain.

    Attributes
    ----------
    element : whose it is.
    name : what it gives, such as ``V_hysteron``.
    tree : the law.
    letter : of a dissipative law, the letter of its conjugate variable.
    jumps : whether the spec says that it is discontinuous on purpose.
    """

    element: str
    name: str
    tree: Expr
    letter: str = ""
    jumps: bool = False


@final
@dataclass(frozen=True)
class Ground:
    """What questions about a model may assume, and the order of names in a witness."""

    where: tuple[Cmp, ...]
    order: tuple[str, ...]
    texts: tuple[str, ...]

    def about(self, *laws: Law) -> Ground:
        """Return the ground for questions about laws, whose letters are names too."""
        letters = dict.fromkeys(law.letter for law in laws if law.letter)
        return replace(self, order=(*self.order, *letters))


def ground_of(iphs: IPHS) -> Ground:
    """Return the domain of a model, and that temperatures are positive (row ``temperature``)."""
    trees = tuple(condition.tree for condition in conditions(iphs.model))
    words = [port.temperature for _, port in iphs.circuit.of(Body)]
    warm = tuple(Cmp(">", Sym(word), ZERO) for word in words)
    states = [port.state for _, port in iphs.circuit.of(Storage, Body)]
    order = (*iphs.model.parameters, *words, *iphs.model.inputs, *states)
    return Ground((*trees, *warm), order, tuple(map(condition_text, trees)))


def laws_of(iphs: IPHS) -> tuple[Law, ...]:
    """Return every law of a model, in declaration order."""
    heat = {placed.element: port.temperature for placed, port in iphs.circuit.of(Body)}
    return tuple(law for placed in iphs.circuit.ports if (law := _law(iphs, placed, heat)))


def _law(iphs: IPHS, placed: Placed, heat: dict[str, str]) -> Law | None:
    element, port = placed.element, placed.port
    jumps = bool(getattr(iphs.model.elements[element], "discontinuous", False))
    match port:
        case Storage():
            return Law(element, port.costate, rename(port.law, {port.letter: port.state}))
        case Body():
            return Law(element, port.temperature, rename(port.law, {port.letter: port.state}))
        case Resistor():
            law = rename(port.law, {"T": heat[port.heats]})
            return Law(element, port.output, law, port.letter, jumps)
        case Coupling():
            words = {"T": heat[port.body]} if port.body else {}
            return Law(element, port.name, rename(port.ratio, words))
        case Exchange() | Conductor():
            return Law(element, "conductance", port.conductance)
        case Source():
            return None


def welldef(laws: tuple[Law, ...], ground: Ground) -> Obligation | None:
    """State that the laws of one element have values everywhere; None if they cannot lack one."""
    named = " and ".join(dict.fromkeys(law.name for law in laws))
    statement = f"{named}: a real value everywhere"
    element, latex = laws[0].element, r"W_k \in \mathbb{R}"
    made = Obligation("welldef", element, statement, latex, ground.texts)
    found: list[Question] = []
    ground = ground.about(*laws)
    try:
        for branch in (branch for law in laws for branch in branches(law.tree)):
            where: tuple[Cmp, ...] = ground.where
            for condition in branch.conditions:
                where = (*ask(found, condition, where, ground), condition)
            ask(found, branch.value, where, ground)
    except TooManyBranchesError:
        return replace(made, open_because=_too_many(laws[0]))
    questions = tuple(dict.fromkeys(found))
    needed = questions or any(law.letter for law in laws)
    return replace(made, questions=questions) if needed else None


def ask(
    found: list[Question], node: Node, where: tuple[Cmp, ...], ground: Ground
) -> tuple[Cmp, ...]:
    """Add the questions whether `node` has a value; return what is then known."""
    for claim in partial(node):
        label = f"{spell(claim.left)} {claim.op} 0"
        found.append(Question(label, ground.order, where, claim, claim))
        where = (*where, claim)
    return where


def partial(node: Node) -> Iterator[Cmp]:
    """Yield what must hold for a smooth tree to have a value, inner parts first."""
    for part in reversed(tuple(walk(node))):
        match part:
            case Div(_, right) if not isinstance(right, Num):
                yield Cmp("!=", right, ZERO)
            case Pow(base, exponent) if exponent.denominator != 1:
                yield Cmp(">=" if exponent > 0 else ">", base, ZERO)
            case Pow(base, exponent) if exponent < 0:
                yield Cmp("!=", base, ZERO)
            case Call("sqrt", (arg,)):
                yield Cmp(">=", arg, ZERO)
            case Call("log", (arg,)):
                yield Cmp(">", arg, ZERO)


def continuous(law: Law, ground: Ground) -> Obligation | None:
    """State that a law agrees with itself on both sides of each edge; None without an edge."""
    tree, ground = with_choices(law.tree), ground.about(law)
    if law.jumps or not choices(tree):
        return None
    statement = f"{law.name} has no jump where its branches meet"
    made = Obligation("continuous", law.element, statement, r"W_k(z^-) = W_k(z^+)", ground.texts)
    found: list[Question] = []
    try:
        for left, right, group in _edges(tree):
            at = {side: decided(tree, _decisions(group, side)) for side in (-1, 0, 1)}
            for side in (1, -1):
                found += _meeting(left, right, at[side], at[0], ground)
    except TooManyBranchesError:
        return replace(made, open_because=_too_many(law))
    return replace(made, questions=tuple(dict.fromkeys(found)))


def _edges(tree: Expr) -> Iterator[tuple[Expr, Expr, tuple[tuple[Cmp, int], ...]]]:
    """Yield each edge left = right, and the comparisons that change there with their sides."""
    groups: dict[Expr, list[tuple[Cmp, int]]] = {}
    for choice in choices(tree):
        difference = add(choice.left, neg(choice.right))
        turned = add(choice.right, neg(choice.left))
        key, sign = (turned, -1) if turned in groups else (difference, 1)
        groups.setdefault(key, []).append((choice, sign))
    for group in groups.values():
        first = group[0][0]
        yield first.left, first.right, tuple(group)


def _decisions(group: tuple[tuple[Cmp, int], ...], side: int) -> dict[Cmp, bool]:
    """Return how comparisons come out where left - right has the sign `side`."""
    outcome = {"<": -1, "<=": -1, ">": 1, ">=": 1}
    return {
        choice: (side * sign == outcome[choice.op]) or (side == 0 and "=" in choice.op)
        for choice, sign in group
    }


def _meeting(left: Expr, right: Expr, beside: Expr, at: Expr, ground: Ground) -> Iterator[Question]:
    """Yield the questions whether what holds beside an edge agrees on it with what holds there."""
    if beside == at:
        return
    for branch in branches(Call("together", (beside, at, left, right))):
        one, other, edge_left, edge_right = parts(branch)
        edge = Cmp("=", edge_left, edge_right)
        where = (*ground.where, *branch.conditions, edge)
        found: list[Question] = []
        ask(found, add(one, neg(other)), where, ground)
        yield from found
        claim = Cmp("=", one, other)
        label = f"{spell(one)} = {spell(other)} at {spell(edge_left)} = {spell(edge_right)}"
        yield Question(label, ground.order, where, claim, claim)


def passive(law: Law, ground: Ground) -> Obligation:
    """State that a dissipative law takes power in: its output times its letter is not negative."""
    power = f"{law.name}*{law.letter}"
    ground = ground.about(law)
    made = Obligation(
        "passive",
        law.element,
        f"{power} >= 0",
        r"W_k z_k \ge 0",
        ground.texts,
        sign=SignOf(law.tree, law.letter),
    )
    original = Cmp(">=", mul(law.tree, Sym(law.letter)), ZERO)
    try:
        questions = tuple(
            Question(
                f"{power} >= 0{_under(branch.conditions)}",
                ground.order,
                (*ground.where, *branch.conditions),
                Cmp(">=", mul(branch.value, Sym(law.letter)), ZERO),
                original,
                branch.conditions,
            )
            for branch in branches(law.tree)
            if branch.value != ZERO
        )
    except TooManyBranchesError:
        return replace(made, open_because=_too_many(law))
    return replace(made, questions=questions)


def conducts(law: Law, ground: Ground) -> Obligation:
    """State that heat flows from the warmer body to the colder one."""
    claim = Cmp(">=", law.tree, ZERO)
    question = Question(f"{spell(law.tree)} >= 0", ground.order, ground.where, claim, claim)
    statement = f"{spell(law.tree)} >= 0: heat flows from warm to cold"
    return Obligation(
        "passive", law.element, statement, r"\lambda \ge 0", ground.texts, questions=(question,)
    )


def odd(law: Law, ground: Ground) -> Obligation:
    """State that a law is odd, which allows the mean law of the discrete gradient."""
    ground = ground.about(law)
    total = add(law.tree, reflected(law.tree, law.letter))
    made = Obligation(
        "odd",
        law.element,
        f"{law.name}(-{law.letter}) = -{law.name}({law.letter})",
        "W_k(-z_k) = -W_k(z_k)",
        ground.texts,
        required=False,
    )
    if total == ZERO:
        return made
    claim = Cmp("=", law.tree, neg(reflected(law.tree, law.letter)))
    try:
        questions = tuple(
            Question(
                f"{made.statement}{_under(branch.conditions)}",
                ground.order,
                (*ground.where, *branch.conditions),
                Cmp("=", branch.value, ZERO),
                claim,
            )
            for branch in branches(total)
            if branch.value != ZERO
        )
    except TooManyBranchesError:
        return replace(made, open_because=_too_many(law))
    return replace(made, questions=questions)


def _under(where: tuple[Cmp, ...]) -> str:
    return f" where {' and '.join(map(condition_text, where))}" if where else ""


def _too_many(law: Law) -> str:
    return f"the law of {law.element} has more than {MOST} branches; use fewer kinks"
