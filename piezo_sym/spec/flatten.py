"""Models made of models and of banks, written out as one model of ordinary elements.

Input: the tables of a spec, and of the models of its components.  Output: the tables of a spec
without components, and the place of each row as the user wrote it.  Names of a component get its
name in front: ``left_q``, ``left_body``, ``T_left_body``, ``left.cap``.  The elements of a bank of
cells say which bank they are in: ``creep_spring`` of bank ``creep``, between ``tip`` and
``creep.inside``, one for each lane.  A node that no element outside of [banks] names is a cell's
own.
"""

import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import Any, final

from piezo_sym.errors import SpecError, quote
from piezo_sym.expressions.parse import parse_condition
from piezo_sym.expressions.tree import names
from piezo_sym.spec.checks.components import check_component
from piezo_sym.spec.elements.base import Element
from piezo_sym.spec.elements.domains import REFERENCES
from piezo_sym.spec.fields import Component, Tables
from piezo_sym.spec.names import check_name
from piezo_sym.spec.origins import Origin, Origins, Within
from piezo_sym.spec.rename import Renaming
from piezo_sym.spec.tables import heat_names, inputs_of, starts, states, temperatures

#: About as many elements as fit into the text of a spec.
MOST_ELEMENTS = 5_000
#: A name in a table, its value, and where the user wrote it.
Row = tuple[str, Any, Origin]


@final
@dataclass(frozen=True)
class Flat:
    """The tables of a model without components, and where the user wrote each row."""

    tables: dict[str, Any] = field(default_factory=dict)
    origins: Origins = field(default_factory=Origins)

    def add(self, table: str, rows: Iterable[Row], *, over: bool = False) -> None:
        """Add rows to a table; a name that is there already is overwritten (`over`) or refused."""
        present = self.tables.setdefault(table, {})
        for name, value, written in rows:
            place = f"{table}.{name}"
            if name in present and not over:
                what = f"would be called '{name}', like {self.origins.of(place).place}"
                raise SpecError(what, written.place, remedy="rename one of them, or the component")
            present[name], self.origins.rows[place] = value, written


def flattened(spec: Tables, models: Iterable[Tables]) -> Flat:
    """Return the tables of a spec, those of its components and banks added.

    Raises `SpecError` if a component names what its model or this spec does not have, or names
    clash.

    Parameters
    ----------
    models : the flat models of the components, in order.
    """
    pairs = zip(spec.components.items(), models, strict=True)
    parts = [Part(name, component, model) for (name, component), model in pairs]
    tables = [spec.elements, *(part.model.elements for part in parts)]
    count = sum(map(len, (*tables, *(bank.elements for bank in spec.banks.values()))))
    if count > MOST_ELEMENTS:
        expected = f"at most {MOST_ELEMENTS}"
        raise SpecError(f"would be {count} elements, written out", "components", expected)
    for part in parts:
        check_component(spec, f"components.{part.name}", part.component, part.model)
    flat = Flat({"model": spec.model})
    for table in ("parameters", "inputs", "initial", "elements"):
        own = [(name, row, Origin(f"{table}.{name}")) for name, row in getattr(spec, table).items()]
        theirs = [row for part in parts for row in part.rows(table)]
        first, last = (own, theirs) if table in ("parameters", "inputs") else (theirs, own)
        flat.add(table, first)
        flat.add(table, last, over=table == "initial")
    outside = {node for e in spec.elements.values() for _, node in e.named("node")}
    kept = ((part, e) for part in parts for e in part.kept.values())
    outside |= {part.node(node) for part, e in kept for _, node in e.named("node")}
    flat.add("elements", cells(spec, outside))
    assumed = [(text, Origin(f"domain.assume[{n}]")) for n, text in enumerate(spec.domain.assume)]
    assumed += [row for part in parts for row in part.assumed()]
    flat.tables["domain"] = {"assume": [text for text, _ in assumed]}
    flat.origins.rows.update({f"domain.assume[{n}]": row[1] for n, row in enumerate(assumed)})
    return flat


@final
@dataclass(frozen=True)
class Part:
    """A component: the rows that its model adds to the flat spec, under their new names."""

    name: str
    component: Component
    model: Tables

    def rows(self, table: str) -> Iterator[Row]:
        """Yield the rows that the component adds to a table of the flat spec."""
        for name, row in getattr(self.model, table).items():
            if (new := self._row(table, name, row)) is not None:
                names = self.renaming.words if table != "elements" else {}
                new_name = names.get(name, f"{self.name}_{name}")
                yield new_name, new, self.origin(f"{table}.{name}")

    def _row(self, table: str, name: str, row: Any) -> Any:
        """Return a row of the component's model under new names, or None if it is left out."""
        match table:
            case "elements":
                return self.renaming.fields(row, name) if name in self.kept else None
            case "parameters":
                given = self.component.parameters.get(name, row.value)
                new = row.model_copy(update={"value": given})
                return None if isinstance(given, str) else new
            case "inputs":
                return None if name in {*self.component.inputs, *self.gone} else row
        return None if name in self.gone else self.renaming.start(row)

    def assumed(self) -> Iterator[tuple[str, Origin]]:
        """Yield the conditions of the component's domain on what is kept, and their origins."""
        for n, text in enumerate(self.model.domain.assume):
            used = names(parse_condition(text, "domain.assume"))
            if self.gone.isdisjoint(used):
                yield self.renaming.text(text), self.origin(f"domain.assume[{n}]")

    def origin(self, row: str) -> Origin:
        """Return where a row of the component's model was written."""
        there = self.model.origins.of(row)
        return Origin(f"{self._within.place}: {there.place}", (self._within, *there.within))

    @cached_property
    def _within(self) -> Within:
        """The component's place, and its names for ours: the first if it has several for one."""
        words, nodes = self.renaming.words, dict[str, str]()
        old = {words[word]: word for word in reversed([*words])}
        for theirs, ours in self.component.nodes.items():
            nodes[ours] = f"{nodes[ours]} and {theirs}" if ours in nodes else theirs
        text = self.component.spec.text
        return Within(f"components.{self.name}", f"{self.name}.", old, nodes, text)

    @cached_property
    def kept(self) -> Mapping[str, Element]:
        """The elements of the component's model that are not left out."""
        left_out, elements = {*self.component.without}, self.model.elements
        return {name: element for name, element in elements.items() if name not in left_out}

    @cached_property
    def gone(self) -> frozenset[str]:
        """The states, temperatures and inputs that go with the elements left out."""
        symbols, hot = states(self.model), temperatures(self.model)
        gone = {word for word, name in (*symbols.items(), *hot.items()) if name not in self.kept}
        kept = (law for s in self.model.initial if s not in gone for law in starts(self.model, s))
        used = {word for law in kept for word in names(law)}
        used |= inputs_of(self.kept.values())
        return frozenset(gone | (inputs_of(self.model.elements.values()) - used))

    @cached_property
    def renaming(self) -> Renaming:
        """The new names of the component's symbols, elements and nodes."""
        front, given = f"{self.name}_", self.component.parameters
        symbols = {word: front + word for word in (*self.model.inputs, *states(self.model))}
        values = {word: given.get(word) for word in self.model.parameters}
        replaced = {w: v if isinstance(v, str) else front + w for w, v in values.items()}
        temperature = {word: f"T_{front}{body}" for word, body in heat_names(self.model).items()}
        words = {**temperature, **symbols, **self.component.inputs, **replaced}
        return Renaming(words, lambda name: front + name, self.node)

    def node(self, node: str) -> str:
        """Return the name in the flat spec of a node of the component."""
        same = node if node in REFERENCES else f"{self.name}.{node}"
        return self.component.nodes.get(node, same)


def cells(spec: Tables, outside: set[str]) -> Iterator[Row]:
    """Yield the name, the fields and the origin of each element of a cell.

    Raises `SpecError` if a bank has no elements, or one that cannot be in a cell, or a node has two
    meanings.

    Parameters
    ----------
    outside : the nodes of the elements that are in no cell.
    """
    for bank, table in spec.banks.items():
        where = f"banks.{bank}"
        check_name(bank, where)
        if not table.elements:
            raise SpecError("has no elements", where, "at least one, in its table elements")
        for name, element in table.elements.items():
            place = f"{where}.elements.{name}"
            check_name(name, place)
            _check_cell_element(element, place, where)
            node = partial(_cell_node, bank, outside | {*(table.series or ())}, place)
            more = {"bank": bank, "count": table.count, "series": table.series}
            shared = {node for _, node in element.named("node")} <= {*REFERENCES, *outside}
            if shared and element.form.joins(element):
                more = {"count": table.count}  # those of all cells have one across variable
            fields = Renaming({}, node=node).fields(element, name)
            yield f"{bank}_{name}", fields | more, Origin(place)


def _check_cell_element(element: Element, place: str, where: str) -> None:
    if not element.form.has_lanes:
        what = f"a {element.kind} is in no cell of a bank"
        remedy = f"write it in [elements], with nodes that cells of {where} name, too"
        raise SpecError(what, place, "a store, a dissipative element, a stop or hysteron", remedy)
    for key in ("count", "bank", "series"):
        if (given := getattr(element, key)) is not None:
            expected, remedy = f"count and series in [{where}]", "leave it out"
            if key == "series":
                ends = json.dumps(given)
                remedy = f"write series = {ends} there, and between = {ends} in a cell's elements"
            raise SpecError(f"{key} is given in a cell", f"{place}.{key}", expected, remedy)


def _cell_node(bank: str, outside: set[str], place: str, node: str) -> str:
    """Return the new name of a cell's node; a node that also stands outside of cells keeps its."""
    if node in REFERENCES or node in outside:
        return node
    name = f"{bank}.{node}"
    if name in outside:
        what = f"{quote(name)} is what node {quote(node)} of a cell of {quote(bank)} is called"
        raise SpecError(what, place, "one meaning of a node", f"rename {quote(node)} here")
    return name
