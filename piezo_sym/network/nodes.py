"""Checks of nodes: each in one domain, shared by two branches, connected to its reference.

Input: a `Circuit`.  Output: nothing, or one `NetworkError` that names the node and its elements.
"""

from __future__ import annotations

from collections.abc import Iterator

from piezo_sym.errors import NetworkError, listing, nearest, with_article
from piezo_sym.spec.circuit import Circuit
from piezo_sym.spec.elements.domains import REFERENCES, PhysicalDomain
from piezo_sym.spec.elements.ports import (
    Body,
    Branch,
    Coupling,
    DissipativePort,
    Source,
    Storage,
)


def is_reference(node: str) -> bool:
    """Return whether a node is one at which the across variable is zero."""
    return node in REFERENCES


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


def is_inner(node: str) -> bool:
    """Return whether a node is an element's own (no spec can write the colon)."""
    return ":" in node


def inner_nodes(circuit: Circuit) -> frozenset[str]:
    """Return the nodes that each lane of a bank has for itself: branches of one bank alone meet."""
    owners = {placed.element: placed.bank for placed in circuit.ports}
    users: dict[str, set[str | None]] = {}
    for element, branch, _ in branches(circuit):
        for node in branch:
            users.setdefault(node, set()).add(owners[element])
    found = (node for node, banks in users.items() if len(banks) == 1 and None not in banks)
    return frozenset(found) - REFERENCES.keys()


def check_nodes(circuit: Circuit) -> None:
    """Check that every node is of one domain, shared by two branches, and tied to its reference.

    Raises
    ------
    NetworkError
        Naming the node, and what meets there.
    """
    domains: dict[str, tuple[PhysicalDomain, str]] = {}
    users: dict[str, list[str]] = {}
    for element, branch, domain in branches(circuit):
        where = f"elements.{element}"
        if branch[0] == branch[1]:
            raise _short(circuit, element, branch[0])
        for node in branch:
            _check_domain(node, domain, where, domains)
            users.setdefault(node, []).append(element)
    for node, found in users.items():
        if len(found) < 2 and not is_reference(node):
            raise _dangling(node, found[0], list(branches(circuit)))
    _check_ground(circuit)


def _check_domain(
    node: str, domain: PhysicalDomain, where: str, domains: dict[str, tuple[PhysicalDomain, str]]
) -> None:
    if is_reference(node):
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
    """Return why both ends of a branch cannot be one node."""
    where = f"elements.{element}"
    if hasattr(circuit.model.elements[element], "at"):
        what = f"stands at '{node}', which does not move"
        return NetworkError(what, where, "a node that moves", "name another node")
    what = f"both ends are at node '{node}'"
    return NetworkError(what, where, "two different nodes", "rename one of them")


def _dangling(
    node: str, element: str, found: list[tuple[str, Branch, PhysicalDomain]]
) -> NetworkError:
    """Return an element that ends where nothing else does, with the nodes it may have meant."""
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


def _check_ground(circuit: Circuit) -> None:
    """Check that branches connect every node to the reference of its domain."""
    beside: dict[str, list[str]] = {}
    for _, (one, other), _ in branches(circuit):
        beside.setdefault(one, []).append(other)
        beside.setdefault(other, []).append(one)
    tied = _reached(list(REFERENCES), beside)
    for element, (node, _), domain in branches(circuit):
        if node not in tied:
            near = sorted(n for n in _reached([node], beside) if not is_inner(n))
            what = f"nothing connects node '{node}' to '{domain.reference}'"
            expected = f"a path to '{domain.reference}', the {domain.name} reference"
            remedy = f"call one of these nodes '{domain.reference}': {listing(near)}"
            raise NetworkError(what, f"elements.{element}", expected, remedy)


def _reached(start: list[str], beside: dict[str, list[str]]) -> set[str]:
    """Return the nodes that branches connect to those of `start`, and these."""
    found, todo = set(start), list(start)
    while todo:
        new = [node for node in beside.get(todo.pop(), ()) if node not in found]
        found.update(new)
        todo.extend(new)
    return found
