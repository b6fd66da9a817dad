"""Nodes of a network: each in one domain, none left hanging.

Input: a `Circuit`.  Output: nothing, or one `NetworkError` that names the node and its elements.
"""

from __future__ import annotations

from collections.abc import Iterator

from piezo_sym.errors import NetworkError, nearest
from piezo_sym.spec.circuit import Circuit
from piezo_sym.spec.elements.ports import Branch, Coupling, Domain, Resistor, Source, Storage

REFERENCES = {domain.reference: domain for domain in Domain}


def is_reference(node: str) -> bool:
    """Return whether a node is one at which the across variable is zero."""
    return node in REFERENCES


def branches(circuit: Circuit) -> Iterator[tuple[str, Branch, Domain]]:
    """Yield (element, branch, domain) of every branch of a circuit."""
    for placed, port in circuit.of(Storage, Resistor, Source, Coupling):
        if isinstance(port, Coupling):
            yield placed.element, port.first, port.first_domain
            yield placed.element, port.second, port.second_domain
        else:
            yield placed.element, port.branch, port.domain


def check_nodes(circuit: Circuit) -> None:
    """Check that every node is of one domain and that at least two branches meet there.

    Raises
    ------
    NetworkError
        Naming the node, and what meets there.
    """
    domains: dict[str, tuple[Domain, str]] = {}
    users: dict[str, list[str]] = {}
    for element, branch, domain in branches(circuit):
        where = f"elements.{element}"
        if branch[0] == branch[1]:
            what = f"both ends are at node '{branch[0]}'"
            raise NetworkError(what, where, "two different nodes")
        for node in branch:
            _check_domain(node, domain, where, domains)
            users.setdefault(node, []).append(element)
    for node, found in users.items():
        if len(found) < 2 and not is_reference(node):
            what = f"connects to '{node}', which no other element uses"
            others = [other for other in users if other != node and ":" not in other]
            remedy = f"{nearest(node, others)}; or add an element there"
            raise NetworkError(what, f"elements.{found[0]}", remedy=remedy)


def _check_domain(
    node: str, domain: Domain, where: str, domains: dict[str, tuple[Domain, str]]
) -> None:
    if is_reference(node):
        if REFERENCES[node] is not domain:
            what = f"'{node}' is the {REFERENCES[node].value} reference"
            raise NetworkError(what, where, f"'{domain.reference}' in this {domain.value} branch")
        return
    first, other = domains.setdefault(node, (domain, where))
    if first is not domain:
        what = f"node '{node}' is {domain.value} here and {first.value} in {other}"
        raise NetworkError(what, where, "a node of one domain", "rename one of the two nodes")
