"""Model to circuit: every port of every element in declaration order, every quantity named once.

Input: a `Model`.  Output: a `Circuit`, the flat list the later stages work on, in which each
co-state, law output, ratio and temperature has the one name it keeps in mathematics, text and code.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, TypeVar, final, overload

from piezo_sym.errors import SpecError, quote
from piezo_sym.expressions.tree import Expr, rename
from piezo_sym.spec.elements.base import Element
from piezo_sym.spec.elements.domains import THERMAL
from piezo_sym.spec.elements.ports import (
    Body,
    Branch,
    Conductor,
    Coupling,
    DissipativePort,
    Exchange,
    HeatInput,
    Port,
    Source,
    Storage,
    body_node,
)
from piezo_sym.spec.model import Model
from piezo_sym.spec.names import fresh
from piezo_sym.spec.tables import (
    Condition,
    bank_of,
    banks,
    conditions,
    in_words,
    lane_parameters,
    temperatures,
)

#: The ending of the name of a lane's last node in a chain (no spec can write the colon).
LAST = ":last"
A = TypeVar("A", bound=Port)
B = TypeVar("B", bound=Port)


@final
@dataclass(frozen=True)
class Placed:
    """A port with its element, and with the bank of which it stands in one lane, if any."""

    element: str
    bank: str | None
    port: Port


@final
@dataclass(frozen=True)
class Circuit:
    """The ports of a model."""

    model: Model  # the spec they come from
    ports: tuple[Placed, ...]  # in declaration order
    #: Every name in use: parameters, inputs, states, bank sizes and the ports' quantities.
    names: frozenset[str]
    chains: Mapping[str, Branch]  # the two ends of the chain of each bank whose lanes are in series

    @overload
    def of(self, kind: type[A], /) -> Iterator[tuple[Placed, A]]: ...

    @overload
    def of(self, kind: type[A], other: type[B], /) -> Iterator[tuple[Placed, A | B]]: ...

    def of(self, *kinds: Any) -> Iterator[tuple[Placed, Any]]:
        """Yield the ports of some kinds, in declaration order."""
        for placed in self.ports:
            if isinstance(placed.port, kinds):
                yield placed, placed.port

    def replaced(self, placed: Placed, port: Port) -> "Circuit":
        """Return the circuit with one port replaced."""
        changed = tuple(replace(p, port=port) if p is placed else p for p in self.ports)
        return replace(self, ports=changed)

    @cached_property
    def by_element(self) -> Mapping[str, tuple[Port, ...]]:
        """The ports of each element that has any."""
        found: dict[str, list[Port]] = {}
        for placed in self.ports:
            found.setdefault(placed.element, []).append(placed.port)
        return {element: tuple(ports) for element, ports in found.items()}

    @cached_property
    def conditions(self) -> tuple[Condition, ...]:
        """The domain."""
        return conditions(self.model)

    @cached_property
    def lane_parameters(self) -> Mapping[str, str]:
        """The bank of each parameter that one bank alone uses."""
        return lane_parameters(self.model, self.conditions)

    @cached_property
    def pumped(self) -> dict[str, Branch]:
        """The branch of each body that a coupling carries entropy into or out of, by element."""
        pairs = (p.second for _, p in self.of(Coupling) if p.second_domain == THERMAL)
        nodes = {node for pair in pairs for node in pair}
        branches = {name: (body_node(name), THERMAL.reference) for name in self.bodies}
        return {name: branch for name, branch in branches.items() if branch[0] in nodes}

    @cached_property
    def bodies(self) -> dict[str, Body]:
        """The bodies by element."""
        return {placed.element: port for placed, port in self.of(Body)}


def circuit_of(model: Model) -> Circuit:
    """Return the circuit of a model; no quantity in it has a name that the spec uses."""
    heat = {body: word for word, body in temperatures(model).items()}
    laws = {
        name: {law.field: in_words(model, law, heat) for law in element.laws(name)}
        for name, element in model.elements.items()
    }
    taken = {*heat.values(), *model.parameters, *model.inputs, *model.elements}
    taken |= {f"{bank}_count" for bank in banks(model)}
    placed = [
        Placed(name, element.bank_of(name), _between_lane_ends(name, element, port))
        for name, element in model.elements.items()
        for port in element.ports(name)
    ]
    taken |= {p.port.state for p in placed if isinstance(p.port, Storage | Body)}
    named = [replace(p, port=_with_names(p, taken, heat, laws[p.element])) for p in placed]
    chains = {bank: model.elements[name].chain for name, bank in bank_of(model).items()}
    ends = {bank: pair for bank, pair in chains.items() if pair}
    return Circuit(model, tuple(named), frozenset(taken), ends)


def lane_ends(bank: str) -> Branch:
    """Return the two end nodes of a lane in a chain; the second is its reference node."""
    return f"{bank}:first", f"{bank}{LAST}"


def _between_lane_ends(name: str, element: Element, port: Port) -> Port:
    """Return a port, moved between the ends of its lane if the lanes are in series."""
    if element.chain is None or not isinstance(port, Storage | DissipativePort):
        return port
    ends = dict(zip(element.chain, lane_ends(element.bank_of(name) or ""), strict=True))
    if hasattr(element, "at"):
        what = f"a {element.kind} moves relative to {quote(port.branch[1])}, not to its cell"
        remedy = "leave it out, or write the cells one by one"
        raise SpecError(what, f"elements.{name}", "cells between their two ends", remedy)
    first, second = (ends.get(node, node) for node in port.branch)
    return replace(port, branch=(first, second))


def _with_names(
    entry: Placed, taken: set[str], heat: Mapping[str, str], laws: Mapping[str, Expr]
) -> Port:
    """Return the port with unused names for its quantities, and with the laws of `laws`.

    `heat` is the temperature symbol of each body; new names are added to `taken`.
    """

    def new(base: str) -> str:
        name = fresh(base, taken)
        taken.add(name)
        return name

    match entry.port:
        case Storage() as port:
            return replace(port, costate=new(port.costate))
        case DissipativePort() as port:
            letters = {word: fresh(word, taken) for word in (port.letter, port.rate_letter) if word}
            port = replace(port, law=rename(laws.get(port.field, port.law), letters))
            output, effort = new(port.output), new(port.effort)
            port = replace(port, letter=letters[port.letter], output=output, effort=effort)
            rate = port.rate and new(port.rate)
            return replace(port, rate_letter=letters.get(port.rate_letter, ""), rate=rate)
        case Conductor() as port:
            return replace(port, output=new(port.output), conductance=laws["conductance"])
        case Coupling() as port:
            return replace(port, name=new(port.name), ratio=laws[port.field])
        case Body() as port:
            return replace(port, temperature=heat[entry.element])
        case Exchange() as port:
            return replace(port, conductance=laws["conductance"])
        case Source() | HeatInput() as port:
            return port
