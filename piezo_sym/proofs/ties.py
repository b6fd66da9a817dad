"""What the letter of a dissipative law is: its drive, as a function of states and inputs.

Input: an `IPHS`.  Output: by element, a comparison letter = drive, where not every value of the
letter is taken in the domain; None where the drive is no such function, though the domain may bound
it: a refutation then says nothing.
"""

from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import reduce

import sympy as sp

from piezo_sym.expressions.calculus import add, derivative, mul, neg, power
from piezo_sym.expressions.tree import Cmp, Expr, Num, Sym, names, rename
from piezo_sym.iphs import IPHS
from piezo_sym.iphs.definitions import costate_name
from piezo_sym.spec.elements.ports import Body, Conductor, Coupling, Resistor, Source, Storage
from piezo_sym.spec.tables import conditions


def ties(iphs: IPHS) -> Mapping[str, Cmp | None]:
    """Return what ties the letter of each dissipative law that the domain may bound."""
    bounded = frozenset(_bounded(iphs))
    if not bounded:
        return {}
    trees = dict(_trees(iphs))
    processes = iphs.circuit.of(Resistor, Conductor)
    return {
        placed.element: None if tree is None else Cmp("=", Sym(port.letter), tree)
        for (placed, port), drive in zip(processes, iphs.system.drive, strict=True)
        if isinstance(port, Resistor) and not bounded.isdisjoint(_symbols(iphs, drive))
        for tree in (_tree(drive, trees),)
    }


def _bounded(iphs: IPHS) -> Iterator[sp.Symbol]:
    """Yield the co-states and inputs that the domain speaks of, and co-states that are no ratio.

    A current phi/L takes every value, unless the domain speaks of phi; one of a softening inductor
    may not.
    """
    used = {name for c in conditions(iphs.model) for name in names(c.tree)}
    for _, store in iphs.circuit.of(Storage):
        if store.state in used or store.letter in names(derivative(store.law, store.letter)):
            yield iphs.symbols[costate_name(store)]
    for _, source in iphs.circuit.of(Source):
        if source.input in used:
            yield iphs.symbols[source.input]


def _symbols(iphs: IPHS, drive: sp.Expr) -> set[sp.Symbol]:
    """Return the symbols that a drive depends on, those of its shares and slopes among them."""
    meant = dict((*iphs.shares, *iphs.slopes))
    found: set[sp.Symbol] = set()
    left = set(drive.free_symbols)
    while left:
        symbol = left.pop()
        found.add(symbol)
        left |= set(getattr(meant.get(symbol), "free_symbols", ())) - found
    return found


def _trees(iphs: IPHS) -> Iterator[tuple[sp.Symbol, Expr]]:
    """Yield what co-states, inputs and ratios are in the words of the domain."""
    heat = {placed.element: port.temperature for placed, port in iphs.circuit.of(Body)}
    for _, store in iphs.circuit.of(Storage):
        yield iphs.symbols[costate_name(store)], rename(store.law, {store.letter: store.state})
    for _, source in iphs.circuit.of(Source):
        yield iphs.symbols[source.input], Sym(source.input)
    for _, coupling in iphs.circuit.of(Coupling):
        words = {"T": heat[coupling.body]} if coupling.body else {}
        yield iphs.symbols[coupling.name], rename(coupling.ratio, words)


def _tree(expr: sp.Expr, trees: Mapping[sp.Symbol, Expr]) -> Expr | None:
    """Return an expression of sums, products and whole powers as a tree, or None."""
    if expr in trees:
        return trees[expr]
    if expr.is_Rational:
        return Num(Fraction(int(expr.p), int(expr.q)))
    parts = [_tree(part, trees) for part in expr.args]
    known = [part for part in parts if part is not None]
    if not parts or len(known) != len(parts):
        return None
    if expr.is_Add:
        return add(*known)
    if expr.is_Mul:
        product = reduce(mul, known[1:])
        return neg(product) if expr.args[0] == -1 else mul(known[0], product)
    if expr.is_Pow and expr.exp.is_Integer:
        return power(known[0], Fraction(int(expr.exp)))
    return None
