"""Ties of the letter of a dissipative law to its drive, a function of states and inputs.

Input: an `IPHS`.  Output: by element, the comparison letter = drive where the domain, or a state
that the law reads, may restrict the values of the letter; None where the drive is no such function,
so that numbers refute nothing.
"""

from collections.abc import Iterator, Mapping

import sympy as sp

from piezo_sym.algebra.symbols import coefficient
from piezo_sym.expressions.calculus import derivative
from piezo_sym.expressions.tree import ONE, ZERO, Cmp, Div, Expr, Sym, names, replace
from piezo_sym.iphs import IPHS
from piezo_sym.network.nodes import reachable
from piezo_sym.spec.circuit import Placed
from piezo_sym.spec.elements.ports import (
    Body,
    Conductor,
    Coupling,
    DissipativePort,
    Source,
    Storage,
)


def ties(iphs: IPHS) -> Mapping[str, Cmp | None]:
    """Return the tie of each dissipative law whose letter the domain or the law may restrict."""
    bounded, words = frozenset(_bounded(iphs)), dict(_words(iphs))
    states = {slot.label for slot in iphs.system.states}
    return {
        placed.element: None if tree is None else Cmp("=", Sym(port.letter), tree)
        for placed, port, drive in _drives(iphs)
        for read in (states & {*names(port.law)},)
        if any(
            symbol in bounded or not read.isdisjoint(names(words.get(symbol, ZERO)))
            for symbol in _symbols(iphs, drive)
        )
        for tree in (_tree(drive, words),)
    }


def drive_of(iphs: IPHS, element: str) -> tuple[Cmp, ...]:
    """Return what drives an element of dissipation, as letter = drive, where that is known."""
    words = dict(_words(iphs))
    own = ((port, drive) for placed, port, drive in _drives(iphs) if placed.element == element)
    trees = ((port.letter, _tree(drive, words)) for port, drive in own)
    return tuple(Cmp("=", Sym(letter), tree) for letter, tree in trees if tree is not None)


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


def _tree(drive: sp.Expr, words: Mapping[sp.Symbol, Expr]) -> Expr | None:
    """Return a drive in names of the domain, or None if it depends on anything else."""
    if not drive.is_rational_function(*words) or not drive.free_symbols <= words.keys():
        return None
    return replace(coefficient(drive), {str(s.name): tree for s, tree in words.items()})
