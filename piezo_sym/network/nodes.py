"""Checks of nodes: each in one domain, shared by two branches, connected to its reference.

Input: a `Circuit`.  Output: nothing, or one `NetworkError` that names the node and its elements.
"""

import json
from collections.abc import Hashable, Iterable, Iterator, Mapping
from typing import TypeVar

from piezo_sym.errors import NetworkError, listing, nearest, quote, with_article
from piezo_sym.spec.circuit import LAST, Circuit, lane_ends
from piezo_sym.spec.elements import kind_of
from piezo_sym.spec.elements.domains import REFERENCES, PhysicalDomain, PowerVariable
from piezo_sym.spec.elements.ports import Body, Branch, Coupling, DissipativePort, Source, Storage
from piezo_sym.spec.tables import alone

K = TypeVar("K", bound=Hashable)


def is_reference(node: str) -> bool:
    """Return whether the across variable is zero at a node, by its domain or in a lane's chain."""
    return node in REFERENCES or node.endswith(LAST)


def branches(circuit: Circuit) -> Iterator[tuple[str, Branch, PhysicalDomain]]:
    """Yield (element, branch, domain) of every branch of a circuit."""
    for placed in circuit.ports:
        match placed.port:
            case Coupling() as port:
                yield placed.element, port.first, port.first_domain
                yield placed.element, port.second, port.second_domain
            case Storage() | DissipativePort() | Source() as port:
                yield placed.element, port.branch, port.domain
            case Body() as port if placed.element in circuit.pumped:
                yield placed.element, circuit.pumped[placed.element], port.domain


def _chained(circuit: Circuit) -> Iterator[tuple[str, Branch, PhysicalDomain]]:
    """Yield the links between the ends of each chain and its lanes, in the form of `branches`."""
    members = {
        placed.bank: (placed.element, placed.port) for placed in circuit.ports if placed.bank
    }
    for bank, (first, last) in circuit.chains.items():
        element, port = members[bank]
        start, end = lane_ends(bank)
        if isinstance(port, Storage | DissipativePort):
            yield element, (first, start), port.domain
            yield element, (end, last), port.domain


def beside_chain(circuit: Circuit, elements: Iterable[str]) -> str:
    """Return the advice to those of some elements that end at cells in series; '' if none does."""
    ends = {node for pair in circuit.chains.values() for node in pair if not is_reference(node)}
    known = [*branches(circuit)]
    at = [(e, n, domain) for e, pair, domain in known if e in elements for n in pair if n in ends]
    if not at:
        return ""
    names, node, domain = listing(dict.fromkeys(quote(e) for e, _, _ in at)), *at[0][1:]
    spring = kind_of("store", domain, PowerVariable.THROUGH)
    given = f"cells in series follow the {domain.through.name} of {with_article(spring)} or source"
    return f"connect {names} to another node than '{node}': {given.replace('_', ' ')}"


def is_inner(node: str) -> bool:
    """Return whether a node is internal to an element: its name has a colon, which specs cannot."""
    return ":" in node


def inner_nodes(circuit: Circuit) -> frozenset[str]:
    """Return the nodes that each lane of a bank has for itself: no branch outside is connected."""
    banks = {placed.element: placed.bank for placed in circuit.ports}
    users = [(node, banks[element]) for element, pair, _ in branches(circuit) for node in pair]
    users += [(node, None) for ends in circuit.chains.values() for node in ends]
    return frozenset(node for node in alone(users) if not is_reference(node))


def check_nodes(circuit: Circuit) -> None:
    """Check that every node is of one domain, shared by two branches, and tied to its reference.

    Raises `NetworkError`, which names the node and the elements there.
    """
    domains: dict[str, tuple[PhysicalDomain, str]] = {}
    users: dict[str, list[str]] = {}
    found = [*branches(circuit), *_chained(circuit)]
    for element, branch, domain in found:
        where = f"elements.{element}"
        if branch[0] == branch[1]:
            raise _short(circuit, element, branch[0])
        for node in branch:
            place = circuit.model.origins.node(where, node) or where
            _check_domain(node, domain, place, domains)
            users.setdefault(node, []).append(element)
    _check_chains(circuit, users)
    for node, own in users.items():
        if len(own) < 2 and not is_reference(node):
            raise _dangling(node, own[0], found)
    _check_ground(found)


def _check_domain(
    node: str, domain: PhysicalDomain, where: str, domains: dict[str, tuple[PhysicalDomain, str]]
) -> None:
    if node in REFERENCES:
        other = REFERENCES[node]
        if other != domain:
            what = f"'{node}' is the {other.name} reference"
            expected = f"'{domain.reference}' in this {domain.name} branch"
            remedy = f"write '{domain.reference}' there, or use {with_article(other.name)} element"
            raise NetworkError(what, where, expected, remedy)
        return
    first, there = domains.setdefault(node, (domain, where))
    if first != domain:
        what = f"node '{node}' is in domain {domain.name} here, {first.name} in {there}"
        raise NetworkError(what, where, "a node of one domain", "rename one of the two nodes")


def _short(circuit: Circuit, element: str, node: str) -> NetworkError:
    """Return the error of a branch with both ends at one node."""
    where = f"elements.{element}"
    if hasattr(circuit.model.elements[element], "at"):
        what = f"stands at '{node}', which does not move"
        return NetworkError(what, where, "a node that moves", "name another node")
    what = f"both ends are at node '{node}'"
    return NetworkError(what, where, "two different nodes", "rename one of them")


def _dangling(
    node: str, element: str, found: list[tuple[str, Branch, PhysicalDomain]]
) -> NetworkError:
    """Return the error of an element alone at a node, with the nodes it may have meant."""
    domain = next(own for _, branch, own in found if node in branch)
    mine = {other for name, branch, _ in found if name == element for other in branch}
    known = dict.fromkeys(
        other
        for _, branch, own in found
        for other in branch
        if own == domain and other not in mine and not is_inner(other)
    )
    what = f"connects to '{node}', which no other element uses"
    remedy = f"{nearest(node, known)}; or add {with_article(domain.name)} element there"
    return NetworkError(what, f"elements.{element}", "two elements at a node", remedy)


def _check_chains(circuit: Circuit, users: Mapping[str, list[str]]) -> None:
    """Check that the elements of a chain meet only each other and the ends, and reach both ends."""
    inner = inner_nodes(circuit)
    for bank, pair in circuit.chains.items():
        for node, end in zip(lane_ends(bank), pair, strict=True):
            if len(users[node]) < 2:
                what = f"no cell connects to {quote(end)}, an end of all in series"
                remedy = f"write between = {json.dumps(pair)} in an element that spans its cell, or"
                remedy += " one of both in two that meet at a node of the cell"
                raise NetworkError(what, f"banks.{bank}", "cells between both ends", remedy)
    for placed in circuit.ports:
        if (ends := circuit.chains.get(placed.bank or "")) is None:
            continue
        for node in getattr(placed.port, "branch", ()):
            if node not in inner and not node.endswith(LAST):
                what = f"connects to {quote(node)}, and is one of cells in series"
                expected = f"nodes of its cell, or the ends {listing(map(quote, ends))}"
                remedy = "name other nodes, or write the cells one by one"
                raise NetworkError(what, f"elements.{placed.element}", expected, remedy)


def _check_ground(found: list[tuple[str, Branch, PhysicalDomain]]) -> None:
    """Check that branches connect every node to the reference of its domain."""
    neighbours: dict[str, list[str]] = {}
    for _, (one, other), _ in found:
        neighbours.setdefault(one, []).append(other)
        neighbours.setdefault(other, []).append(one)
    tied = reachable(list(REFERENCES), neighbours)
    for element, (node, _), domain in found:
        if node not in tied:
            near = sorted(n for n in reachable([node], neighbours) if not is_inner(n))
            what = f"nothing connects node '{node}' to '{domain.reference}'"
            expected = f"a path to '{domain.reference}', the {domain.name} reference"
            remedy = f"call one of these nodes '{domain.reference}': {listing(near)}"
            raise NetworkError(what, f"elements.{element}", expected, remedy)


def reachable(start: Iterable[K], neighbours: Mapping[K, Iterable[K]]) -> set[K]:
    """Return `start` and all that connections lead to from there."""
    found, todo = set(start), list(start)
    while todo:
        new = [node for node in neighbours.get(todo.pop(), ()) if node not in found]
        found.update(new)
        todo.extend(new)
    return found
