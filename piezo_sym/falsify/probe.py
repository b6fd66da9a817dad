"""Functions that an attack evaluates besides those of the module: single laws, and edges.

Input: an `IPHS`.  Output: a `Probe`, whose module is printed like any other.  Its functions are
`laws`, `sizes` (laws with the terms of every sum replaced by their absolute values, so that
value/size tells cancellation from a change of sign) and `edges`.  An edge is an expression near
whose zeros a law may be wrong: the difference of the sides of a comparison, a bound of the domain,
a divisor, the argument of a root, a sum, the difference of quantities of equal dimension.
"""

from __future__ import annotations

import importlib.abc
import importlib.util
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import reduce
from types import ModuleType
from typing import final

from piezo_sym.algebra.lanes import Slot
from piezo_sym.codegen import numpy_module
from piezo_sym.codegen.differences import sharp_program
from piezo_sym.codegen.lower import program_of
from piezo_sym.codegen.program import ModuleFunction, OutputRow, bank_of
from piezo_sym.codegen.quantities import Quantities, quantities_of
from piezo_sym.expressions.calculus import add, choices, derivative, increasing, kinks, mul, neg
from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.tree import (
    ONE,
    ZERO,
    Add,
    Call,
    Cmp,
    Div,
    Expr,
    If,
    LaneSum,
    Mul,
    Neg,
    Node,
    Num,
    Pow,
    Sym,
    children,
    knots,
    walk,
)
from piezo_sym.expressions.units import parse_unit
from piezo_sym.iphs import IPHS
from piezo_sym.iphs.definitions import costate_name
from piezo_sym.spec.elements.ports import (
    Body,
    Conductor,
    Coupling,
    DissipativePort,
    Source,
    Storage,
)

MOST_EDGES = 400


@final
@dataclass(frozen=True)
class ZeroSet:
    """An expression whose zeros are searched for; at those of a `kink` a law changes branches."""

    tree: Expr
    kink: bool = False


@final
@dataclass(frozen=True)
class Probe:
    """The printed functions of a system, and what their rows are.

    Attributes
    ----------
    iphs : the system.
    module : with functions `laws`, `sizes` and `edges`.
    laws : the bank of each row of `laws`, by element and quantity: law, effort, output, slope or
        hole (positive where the element's laws have no value).
    edges : for each row of `edges` whether a law changes branches there, and its bank.
    """

    iphs: IPHS
    module: ModuleType
    laws: Mapping[tuple[str, str], str | None]
    edges: tuple[tuple[bool, str | None], ...]


@final
class _Text(importlib.abc.InspectLoader):
    """Loads a module from the text that was generated for it."""

    def __init__(self, text: str) -> None:
        self.text = text

    def get_source(self, fullname: str) -> str:
        """Return the text."""
        del fullname
        return self.text


def module_from(text: str, name: str = "attacked") -> ModuleType:
    """Return a new module made of generated text, without a file or an entry in `sys.modules`."""
    spec = importlib.util.spec_from_loader(name, loader := _Text(text))
    if spec is None:
        raise ImportError(name)
    module = importlib.util.module_from_spec(spec)
    loader.exec_module(module)
    return module


def probe_of(iphs: IPHS) -> Probe:
    """Return the probe of a system."""
    q = quantities_of(iphs)
    known = {quantity.name: quantity.value for quantity in q.defined}
    laws = {(name, what): tree for name, what, tree in (*_laws(q), *_holes(iphs, q, known))}
    named = [item.value for item in q.defined if not isinstance(item.value, LaneSum)]
    trees = named + [limit.margin for limit in q.limits]
    trees += [tree for (_, what), tree in laws.items() if what != "hole"]
    found = [edge for tree in trees for edge in _edges(tree)]
    found += [ZeroSet(limit.margin) for limit in q.limits] + [
        ZeroSet(tree) for tree in _equal(iphs, q)
    ]
    edges = tuple(dict.fromkeys(e for e in found if not isinstance(e.tree, Num)))[:MOST_EDGES]
    values = [(tree, bank_of(tree, q.lanes)) for tree in laws.values()]
    turns = [(edge.tree, bank_of(edge.tree, q.lanes)) for edge in edges]
    sizes = [
        (ONE if what in {"effort", "hole"} else _size(_own(tree, known)), bank)
        for (_, what), (tree, bank) in zip(laws, values, strict=True)
    ]
    functions = (
        _function("laws", values),
        _function("sizes", sizes),
        _function("edges", turns),
    )
    module = module_from(numpy_module(sharp_program(program_of(q, functions))))
    banks = dict(zip(laws, (bank for _, bank in values), strict=True))
    kinks = tuple((edge.kink, bank) for edge, (_, bank) in zip(edges, turns, strict=True))
    return Probe(iphs, module, banks, kinks)


def _function(name: str, rows: list[tuple[Expr, str | None]]) -> ModuleFunction:
    made = tuple(OutputRow(Slot("", bank), tree) for tree, bank in rows)
    return ModuleFunction(name, name, ("x", "u", "p"), made)


def _own(tree: Expr, known: dict[str, Expr]) -> Expr:
    """Return the expression that a name stands for."""
    return known.get(tree.name, tree) if isinstance(tree, Sym) else tree


def _laws(q: Quantities) -> Iterator[tuple[str, str, Expr]]:
    """Yield (element, quantity, expression) of every law, effort of a resistor, slope of a body."""
    forces = iter(zip(q.forces, q.outputs, strict=True))
    for placed in q.iphs.circuit.ports:
        element, port = placed.element, placed.port
        match port:
            case Storage() | Body():
                yield element, "law", Sym(costate_name(port))
                if isinstance(port, Body):
                    yield element, "slope", derivative(port.law, port.state)
            case Coupling():
                yield element, "law", Sym(port.name)
            case Source():
                continue
            case DissipativePort():
                force, output = next(forces)
                yield from ((element, "output", output), (element, "effort", force))
            case _:
                if not hasattr(port, "input"):
                    next(forces)
                yield element, "law", port.conductance


def _size(node: Expr) -> Expr:
    """Return an expression with the terms of each sum replaced by their absolute values."""
    match node:
        case Add(terms):
            return add(*map(_size, terms))
        case Neg(arg):
            return _size(arg)
        case Mul(left, right):
            return mul(_size(left), _size(right))
        case Div(left, right):
            return Div(_size(left), _absolute(right))
        case Pow(base, exponent) if exponent > 0 and exponent.denominator == 1:
            return Pow(_size(base), exponent)
        case If(then, condition, other):
            return If(_size(then), condition, _size(other))
        case Call() if knots(node):
            return _size(choices(node))
    return _absolute(node)


def _absolute(node: Expr) -> Expr:
    return Num(abs(node.value)) if isinstance(node, Num) else Call("abs", (node,))


def _holes(iphs: IPHS, q: Quantities, known: dict[str, Expr]) -> Iterator[tuple[str, str, Expr]]:
    """Yield expressions, positive where an element's laws or the junction have no value."""
    found: dict[str, list[Expr]] = {}
    for element, what, tree in _laws(q):
        if what != "effort":
            found.setdefault(element, []).append(_hole(_own(tree, known)))
    junction = [known[str(symbol.name)] for symbol, _ in (*iphs.slopes, *iphs.shares)]
    for element, parts in {**found, "": [_hole(tree) for tree in junction]}.items():
        yield element, "hole", _any(parts)


def _hole(node: Node) -> Expr:
    """Return an expression that is positive where a law has no value on the branch taken."""
    match node:
        case If(then, condition, other):
            inside = If(_hole(then), condition, _hole(other))
            return _any(
                [_hole(condition), inside if {inside.then, inside.other} != {ZERO} else ZERO]
            )
        case Call() if knots(node):
            out = [If(ZERO, order, ONE) for order in increasing(node)]
            return _any([*out, _hole(choices(node))])
        case Div(_, bottom) if not isinstance(bottom, Num):
            own: Cmp | None = Cmp("<=", _absolute(bottom), ZERO)
        case Pow(base, exponent) if exponent.denominator != 1:
            own = Cmp("<" if exponent > 0 else "<=", base, ZERO)
        case Pow(base, exponent) if exponent < 0:
            own = Cmp("<=", _absolute(base), ZERO)
        case Call(function, (arg,)) if RECORDS[function].domain:
            own = Cmp("<" if "=" in RECORDS[function].domain else "<=", arg, ZERO)
        case _:
            own = None
    return _any([If(ONE, own, ZERO) if own else ZERO, *map(_hole, children(node))])


def _any(parts: list[Expr]) -> Expr:
    """Return the largest of some nonnegative expressions."""
    kept = [part for part in dict.fromkeys(parts) if part != ZERO]
    return reduce(lambda one, other: Call("max", (one, other)), kept) if kept else ZERO


def _edges(tree: Node) -> Iterator[ZeroSet]:
    """Yield the edges of a law, outermost first."""
    for node in walk(tree):
        match node:
            case LaneSum() | Num() | Sym():
                continue
            case Cmp(_, left, right):
                yield ZeroSet(add(left, neg(right)), kink=True)
            case Call(function) if not RECORDS[function].smooth:
                yield from (ZeroSet(add(c.left, neg(c.right)), kink=True) for c in kinks(node))
            case Call(function, (z,)) if RECORDS[function].units == "pure":
                yield from (ZeroSet(z), ZeroSet(add(z, neg(ONE))), ZeroSet(add(z, ONE)))
            case Call(_, (z,)) | Pow(z, _) | Div(_, z):
                yield ZeroSet(z)
            case Add():
                yield ZeroSet(node)


def _equal(iphs: IPHS, q: Quantities) -> Iterator[Expr]:
    """Yield differences and sums of a quantity and a parameter or input of equal dimension."""
    units = [(name, p.dimension.dimension) for name, p in iphs.model.parameters.items()]
    units += [(name, u.dimension.dimension) for name, u in iphs.model.inputs.items()]
    quantities: list[tuple[Expr, str]] = []
    for _, store in q.stores:
        unit = "K" if isinstance(store, Body) else store.units[1]
        quantities.append((Sym(costate_name(store)), unit))
    for force, (_, process) in zip(
        q.forces, iphs.circuit.of(DissipativePort, Conductor), strict=True
    ):
        if isinstance(process, DissipativePort):
            quantities.append((force, process.domain.variable(process.imposes.other).unit))
    for tree, unit in dict.fromkeys(quantities):
        for name, dimension in units:
            if parse_unit(unit).dimension == dimension:
                yield from (add(tree, neg(Sym(name))), add(tree, Sym(name)))
