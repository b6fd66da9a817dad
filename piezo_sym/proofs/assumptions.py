"""The assumptions on a model: its domain, positive temperatures, ties between names.

Input: an `IPHS`.  Output: `Assumptions`, and `Law`, the type of the laws that questions are about.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import final

from piezo_sym.expressions.calculus import derivative
from piezo_sym.expressions.tree import ZERO, Call, Cmp, Div, Expr, Mul, Sym, names
from piezo_sym.iphs import IPHS
from piezo_sym.proofs.obligations import Obligation, Question
from piezo_sym.spec.elements.ports import (
    Body,
    Conductor,
    Coupling,
    DissipativePort,
    Exchange,
    Storage,
)
from piezo_sym.spec.tables import condition_text


@final
@dataclass(frozen=True)
class Law:
    """A law of an element, in names of the domain."""

    element: str  # its name
    name: str  # of the quantity that the law gives, such as ``V_hysteron``
    tree: Expr  # the law
    letter: str = ""  # of a dissipative law, the letter of its conjugate variable
    jumps: bool = False  # whether the spec declares it discontinuous
    #: Equation letter = drive (states, inputs), if the letter may be bounded; None: drive unknown.
    ties: tuple[Cmp | None, ...] = ()
    #: The laws as the spec has them, where the network inverts the law or joins stores.
    written: tuple[Expr, ...] = ()
    rate: str = ""  # of a slip, the letter of the rate that drives it
    derived: bool = False  # whether it is an integrated energy, which the spec does not give

    @property
    def of_element(self) -> str:
        """The law in words, such as ``the law of damper``."""
        return f"the law of {self.element}"


@final
@dataclass(frozen=True)
class Assumptions:
    """The assumptions of questions about a model, and the order of names in a witness."""

    where: tuple[Cmp, ...]  # the domain, T > 0, and ties of names to states
    order: tuple[str, ...]  # names, in the order in which a witness should be simple
    texts: tuple[str, ...]  # the domain, as text
    #: The name of each temperature, and (id, element) of the obligation that it is positive.
    warm: tuple[tuple[str, tuple[str, str]], ...] = ()
    fixed: frozenset[str] = frozenset()  # names that are constant in a run: the parameters

    def about(self, *laws: Law) -> Assumptions:
        """Return the assumptions for questions about laws, with their letters and ties."""
        letters = dict.fromkeys(x for law in laws for x in (law.letter, law.rate) if x)
        ties = [tie for law in laws for tie in law.ties if tie]
        return replace(self, order=(*self.order, *letters), where=(*self.where, *ties))

    def given(self, *conditions: Cmp) -> Assumptions:
        """Return the assumptions with additional conditions."""
        return replace(self, where=(*self.where, *conditions))

    def question(self, label: str, claim: Cmp, original: Cmp | None = None) -> Question:
        """Return the question whether a claim follows; see `Question` for `original`."""
        return Question(label, self.order, self.where, claim, original or claim)


def assumptions_of(iphs: IPHS) -> Assumptions:
    """Return the assumptions on a model; row ``temperature`` proves that of T > 0."""
    trees = tuple(condition.tree for condition in iphs.circuit.conditions)
    placed = tuple(iphs.circuit.of(Body))
    words = [port.temperature for _, port in placed]
    warm = tuple(Cmp(">", Sym(word), ZERO) for word in words)
    states = [port.state for _, port in iphs.circuit.of(Storage, Body)]
    order = (*iphs.model.parameters, *words, *iphs.model.inputs, *states)
    rows = tuple((port.temperature, ("temperature", body.element)) for body, port in placed)
    laws = [port.law for _, port in iphs.circuit.of(DissipativePort)]
    laws += [port.ratio for _, port in iphs.circuit.of(Coupling)]
    laws += [port.conductance for _, port in iphs.circuit.of(Exchange, Conductor)]
    used = {name for tree in (*trees, *laws) for name in names(tree)}
    ties = tuple(
        Cmp("=", Sym(port.temperature), port.law)
        for _, port in placed
        if port.state in used or not _takes_every_value(port.law, port.state)
    )
    texts, fixed = tuple(map(condition_text, trees)), frozenset(iphs.model.parameters)
    return Assumptions((*trees, *warm, *ties), order, texts, rows, fixed)


def _takes_every_value(law: Expr, state: str) -> bool:
    """Return whether a temperature takes every positive value, whatever the other states are.

    It does if it is positive, rises with S (row ``temperature``), and is c*exp(a*S + b) with a, b
    and c free of S.
    """
    match law:
        case Mul(left, right) if state not in names(left):
            return _takes_every_value(right, state)
        case Mul(left, right) | Div(left, right) if state not in names(right):
            return _takes_every_value(left, state)
        case Call("exp", (arg,)):
            return state not in names(derivative(arg, state))
    return False


def with_temperatures(obligation: Obligation, assumptions: Assumptions) -> Obligation:
    """Return an obligation that rests on the rows of the temperatures in its questions, too."""
    if obligation.id == "temperature":
        return obligation
    used = {name for question in obligation.questions for name in question.words}
    rows = tuple(row for word, row in assumptions.warm if word in used)
    return replace(obligation, rests_on=(*obligation.rests_on, *rows))
