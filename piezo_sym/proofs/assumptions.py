"""The assumptions on a model: its domain, positive temperatures, ties between names.

Input: an `IPHS`.  Output: `Assumptions`; `Law`, the type of the laws that questions are about; and
what ties the letter of a dissipative law to its drive, a function of states and inputs.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import final

import sympy as sp

from piezo_sym.algebra.symbols import coefficient
from piezo_sym.expressions.calculus import derivative
from piezo_sym.expressions.tree import ONE, ZERO, Call, Cmp, Div, Expr, Mul, Sym, names
from piezo_sym.expressions.tree import replace as put
from piezo_sym.iphs import IPHS
from piezo_sym.network.nodes import reachable
from piezo_sym.proofs.obligations import Obligation, Question
from piezo_sym.spec.circuit import Placed
from piezo_sym.spec.elements.ports import (
    Body,
    Conductor,
    Coupling,
    DissipativePort,
    Exchange,
    Source,
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


def ties_of(iphs: IPHS) -> Mapping[str, Cmp | None]:
    """Return the tie of each dissipative law whose letter the domain or the law may restrict.

    It is the comparison letter = drive, or None where the drive is no function of states and
    inputs, so that numbers refute nothing.
    """
    bounded, words = frozenset(_bounded(iphs)), dict(_words(iphs))
    states = {slot.label for slot in iphs.system.states}
    return {
        placed.element: _tie(port.letter, drive, words)
        for placed, port, drive in _drives(iphs)
        for read in (states & {*names(port.law)},)
        if any(
            symbol in bounded or not read.isdisjoint(names(words.get(symbol, ZERO)))
            for symbol in _symbols(iphs, drive)
        )
    }


def drive_of(iphs: IPHS, element: str) -> tuple[Cmp, ...]:
    """Return what drives an element of dissipation, as letter = drive, where that is known."""
    words = dict(_words(iphs))
    own = ((port, drive) for placed, port, drive in _drives(iphs) if placed.element == element)
    return tuple(filter(None, (_tie(port.letter, drive, words) for port, drive in own)))


def _drives(iphs: IPHS) -> Iterator[tuple[Placed, DissipativePort, sp.Expr]]:
    """Yield the elements of dissipation with what drives them."""
    processes = iphs.circuit.of(DissipativePort, Conductor)
    for (placed, port), drive in zip(processes, iphs.system.drive, strict=True):
        if isinstance(port, DissipativePort):
            yield placed, port, drive


def _bounded(iphs: IPHS) -> Iterator[sp.Symbol]:
    """Yield the inputs in the domain's conditions, and co-states that may not take every value.

    A current phi/L takes every value if L > 0 and no condition has phi.  The current of a softening
    or a moving inductor may not, nor may temperatures.
    """
    trees = [condition.tree for condition in iphs.circuit.conditions]
    used = {name for tree in trees for name in names(tree)}
    states = {slot.label for slot in iphs.system.states}
    for _, store in iphs.circuit.of(Storage):
        slope = derivative(store.law, store.state)
        size = slope.right if isinstance(slope, Div) and slope.left == ONE else slope
        free = Cmp(">", size, ZERO) in trees and states.isdisjoint(names(size))
        if store.state in used or not free:
            yield iphs.symbols[store.costate]
    for _, source in iphs.circuit.of(Source):
        if source.input in used:
            yield iphs.symbols[source.input]
    for element in iphs.circuit.pumped:
        yield iphs.symbols[iphs.circuit.bodies[element].temperature]


def _symbols(iphs: IPHS, drive: sp.Expr) -> set[sp.Symbol]:
    """Return the symbols that a drive depends on, also through its shares and slopes."""
    definitions = (*iphs.shares, *iphs.slopes)
    return reachable(drive.free_symbols, {s: value.free_symbols for s, value in definitions})


def _words(iphs: IPHS) -> Iterator[tuple[sp.Symbol, Expr]]:
    """Yield co-states, inputs, temperatures and ratios with their laws in names of the domain."""
    for _, store in iphs.circuit.of(Storage):
        yield iphs.symbols[store.costate], store.law
    for _, source in iphs.circuit.of(Source):
        yield iphs.symbols[source.input], Sym(source.input)
    for _, body in iphs.circuit.of(Body):
        yield iphs.symbols[body.temperature], Sym(body.temperature)
    for _, coupling in iphs.circuit.of(Coupling):
        yield iphs.symbols[coupling.name], coupling.ratio


def _tie(letter: str, drive: sp.Expr, words: Mapping[sp.Symbol, Expr]) -> Cmp | None:
    """Return letter = drive in names of the domain, or None if it depends on anything else."""
    if not drive.is_rational_function(*words) or not drive.free_symbols <= words.keys():
        return None
    tree = put(coefficient(drive), {str(s.name): tree for s, tree in words.items()})
    return Cmp("=", Sym(letter), tree)
