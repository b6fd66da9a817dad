"""The laws and edges that an attack evaluates besides the functions of the module.

Input: an `IPHS`.  Output: a `Probe`: trees in the named quantities of its program.  An edge is an
expression near whose zeros a row may be false: the difference of the sides of a comparison, a bound
of the domain, a divisor, the argument of a root, a sum, the difference of quantities of equal
dimension.
"""

import importlib.abc
import importlib.util
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from types import ModuleType
from typing import final

from piezo_sym.codegen.functions import functions_of
from piezo_sym.codegen.program import bank_of
from piezo_sym.codegen.quantities import Quantities, quantities_of
from piezo_sym.expressions.calculus import add, derivative, kinks, neg
from piezo_sym.expressions.floats import Row
from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.tree import (
    ONE,
    Add,
    Call,
    Cmp,
    Div,
    Expr,
    LaneSum,
    Node,
    Num,
    Pow,
    Sym,
    names,
    rename,
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
    HeatInput,
    Source,
    Storage,
)

#: Most edges, fewer for large systems; the first ones of each form are preferred.
MOST_EDGES = 400


@final
@dataclass(frozen=True)
class Edge:
    """An expression whose zeros are searched for; at those of a `kink` a law changes its branch."""

    tree: Expr
    kink: bool = False
    bank: str | None = None


@final
@dataclass(frozen=True)
class Probe:
    """The trees of a system."""

    iphs: IPHS  # the system
    #: The tree of each name.  Names with a space are results of the module's functions: the heat
    #: and the production of a process, the rate of a state, the temperature of a body.
    defined: Mapping[str, Row]
    #: By (kind, element): output and effort of a process, conductance, temperature and slope of a
    #: body, costate, ratio; the divisors of the junction have the element "".
    laws: Mapping[tuple[str, str], Row]
    edges: tuple[Edge, ...]  # expressions near whose zeros rows may be false

    def law(self, what: str, element: str) -> Row:
        """Return a law; a law that is a mere name is replaced by its definition."""
        return self.written(self.laws[what, element])

    def behind(self, tree: Expr) -> set[str]:
        """Return the names in a tree and in their definitions; results of the module stay names."""
        found, left = set[str](), [*names(tree)]
        while left:
            if (name := left.pop()) not in found:
                found.add(name)
                tree, _ = self.defined.get(name, (ONE, None))
                left += names(tree) if " " not in name else ()
        return found

    @cached_property
    def produced(self) -> Expr:
        """The entropy production of all processes."""
        rows = ((n, bank) for n, (_, bank) in self.defined.items() if n.startswith("production "))
        return add(*(LaneSum(Sym(name), bank) if bank else Sym(name) for name, bank in rows))

    def kinds(self, element: str) -> list[str]:
        """Return the kinds of an element's laws that may jump: all but efforts and slopes."""
        own = (what for what, placed in self.laws if placed == element)
        return [what for what in own if what not in {"effort", "slope"}]

    @cached_property
    def of_element(self) -> Mapping[str, list[Row]]:
        """The laws of each element, without efforts; mere names are replaced by definitions."""
        found: dict[str, list[Row]] = {}
        for (what, element), row in self.laws.items():
            found.setdefault(element, []).extend([self.written(row)] if what != "effort" else [])
        return found

    @cached_property
    def powers(self) -> tuple[Call, ...]:
        """The powers in laws with an exponent that is no number."""
        parts = (part for row in self.laws.values() for part in walk(self.written(row)[0]))
        calls = (part for part in parts if isinstance(part, Call) and part.function == "pow")
        return tuple(dict.fromkeys(calls))

    def written(self, row: Row) -> Row:
        """Return a row as it is, or its definition if it is a mere name."""
        tree, _ = row
        return self.defined.get(tree.name, row) if isinstance(tree, Sym) else row


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
    """Return a new module of generated text, without a file or an entry in `sys.modules`."""
    spec = importlib.util.spec_from_loader(name, loader := _Text(text))
    if spec is None:
        raise ImportError(name)
    module = importlib.util.module_from_spec(spec)
    loader.exec_module(module)
    return module


def probe_of(iphs: IPHS) -> Probe:
    """Return the probe of a system."""
    q = quantities_of(iphs)
    defined = {item.name: (item.value, item.bank) for item in q.defined}
    laws = {key: (tree, bank_of(tree, q.lanes)) for key, tree in _laws(q)}
    shares = [str(symbol.name) for symbol, _ in (*iphs.slopes, *iphs.shares)]
    trees: list[Expr] = [i.value for i in q.defined if not isinstance(i.value, LaneSum)]
    trees += [limit.margin for limit in q.limits]
    trees += [tree for tree, _ in laws.values()]
    laws |= {(name, ""): defined[name] for name in shares}
    found = [edge for tree in trees for edge in _edges(tree)]
    found += [Edge(limit.margin) for limit in q.limits] + [Edge(tree) for tree in _equal(iphs, q)]
    most = max(100, MOST_EDGES * 100 // max(100, len(defined)))
    edges = _varied(dict.fromkeys(e for e in found if not isinstance(e.tree, Num)), most)
    edges = tuple(Edge(e.tree, e.kink, bank_of(e.tree, q.lanes)) for e in edges)
    return Probe(iphs, {**defined, **dict(_rows(q))}, laws, edges)


def _varied(found: Iterable[Edge], most: int) -> tuple[Edge, ...]:
    """Return at most `most` edges, preferring the first ones of each form."""
    seen, ranked = Counter[Expr](), list[tuple[int, Edge]]()
    for edge in found:
        form = rename(edge.tree, {name: str(n) for n, name in enumerate(names(edge.tree))})
        seen[form] += 1
        ranked.append((seen[form], edge))
    last = sorted(rank for rank, _ in ranked)[:most][-1:]
    kept = [edge for rank, edge in ranked if [rank] <= last]
    return tuple(kept[:most])


#: The module's function behind each kind of name with a space, and the table of its rows.
RESULTS = {
    "heat": ("heat", "PROCESSES"),
    "production": ("entropy_production", "PROCESSES"),
    "rate": ("rhs", "STATES"),
    "temperature": ("temperatures", "BODIES"),
}


def _rows(q: Quantities) -> Iterator[tuple[str, Row]]:
    """Yield the rows of the module's functions."""
    rows = {function.name: function.rows for function in functions_of(q)}
    for what, (function, _) in RESULTS.items():
        yield from ((f"{what} {r.slot.label}", (r.value, r.slot.bank)) for r in rows[function])


def _laws(q: Quantities) -> Iterator[tuple[tuple[str, str], Expr]]:
    """Yield every law, the effort of each resistor, and the slope of each temperature."""
    forces = iter(zip(q.forces, q.outputs, strict=True))
    for placed in q.iphs.circuit.ports:
        element, port = placed.element, placed.port
        match port:
            case Body():
                yield ("temperature", element), Sym(port.temperature)
                yield ("slope", element), derivative(port.law, port.state)
            case Storage():
                yield (f"costate {port.state}", element), Sym(costate_name(port))
            case Coupling():
                yield ("ratio", element), Sym(port.name)
            case DissipativePort():
                force, output = next(forces)
                yield from ((("output", element), output), (("effort", element), force))
            case Source() | HeatInput():
                continue
            case _:
                if isinstance(port, Conductor):
                    next(forces)
                yield ("conductance", element), port.conductance


def _edges(tree: Node) -> Iterator[Edge]:
    """Yield the edges of a law, outermost first."""
    for node in walk(tree):
        match node:
            case LaneSum() | Num() | Sym():
                continue
            case Cmp(_, left, right):
                yield Edge(add(left, neg(right)), kink=True)
            case Call(function) if not RECORDS[function].smooth:
                yield from (Edge(add(c.left, neg(c.right)), kink=True) for c in kinks(node))
            case Call(function, (z,)) if RECORDS[function].units == "pure":
                yield from (Edge(z), Edge(add(z, neg(ONE))), Edge(add(z, ONE)))
            case Call(_, (z, *_)) | Pow(z, _) | Div(_, z):
                yield Edge(z)
            case Add():
                yield Edge(node)


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
