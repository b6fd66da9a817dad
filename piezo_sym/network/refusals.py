"""What junction laws without a solution mean, in the terms of the spec.

Input: the laws, and what elimination found wrong with them.  Output: one `NetworkError` that names
the elements at fault, where they meet, and what to put there.
"""

from __future__ import annotations

from piezo_sym.algebra.linear import Form, SingularError
from piezo_sym.errors import NetworkError
from piezo_sym.network.inverse import inverse_field, turn
from piezo_sym.network.kirchhoff import Edge, Laws
from piezo_sym.network.nodes import branches, is_inner, is_reference
from piezo_sym.spec.elements.ports import (
    Coupling,
    DissipativePort,
    Source,
    Storage,
)

MIXED = "variables"
REMEDIES = {
    "voltage": "merge those in parallel into one, or put a resistor in series with one of them",
    "current": "merge those in series into one, or put a capacitor between their node and 'gnd'",
    "velocity": "merge them into one, or put a spring or damper between them",
    "force": "merge those in series into one, or put a mass at the node between them",
    MIXED: "put a resistor, spring or damper between two of them, or a capacitor or mass at a node",
}


def refusal(laws: Laws, singular: SingularError) -> NetworkError:
    """Return the first contradiction between givens, or else what nothing determines."""
    for relation in singular.relations:
        edges = _edges(laws, relation)
        if edges:
            return _contradiction(laws, relation, edges)
    return _undetermined(singular)


def _edges(laws: Laws, relation: Form) -> list[Edge]:
    """Return the branches whose givens a relation ties, in the order of their elements."""
    keys = [label[1] if label[0] == "sum" else label for label in relation]
    order = list(laws.circuit.model.elements)
    found = [edge for edge in laws.edges if edge.key in keys]
    return sorted(found, key=lambda edge: order.index(edge.placed.element))


def _contradiction(laws: Laws, relation: Form, edges: list[Edge]) -> NetworkError:
    names = list(dict.fromkeys(edge.placed.element for edge in edges))
    words = list(dict.fromkeys(map(_word, edges)))
    word = words[0] if len(words) == 1 else MIXED
    couplings = _couplings(laws, relation)
    place = f" through {_listed(couplings)}" if couplings else _place(laws, names)
    if len(names) == 1:
        what = f"the {word} of {_listed(names)} is forced to be zero{place}"
        return NetworkError(what, "network", f"a free {word}", "connect it to other nodes")
    what = f"elements {_listed(names)} fix each other's {word}{place}"
    fixed = _fixed(laws, edges)
    if fixed:
        expected, remedy = _inverse(*fixed[0])
        remedy = f"{remedy}; or {REMEDIES[word]}" if len(fixed) > 1 else remedy
        return NetworkError(what, "network", expected, remedy)
    remedy = REMEDIES[MIXED if couplings else word]
    return NetworkError(what, "network", "independent storage and sources", remedy)


def _listed(names: list[str]) -> str:
    return ", ".join(f"'{name}'" for name in names)


def _word(edge: Edge) -> str:
    match edge.placed.port:
        case Storage() | DissipativePort() | Source() as port:
            return port.domain.variable(port.imposes).name
    return MIXED


def _fixed(laws: Laws, edges: list[Edge]) -> list[tuple[str, DissipativePort]]:
    """Return the resistors among branches whose laws cannot be turned round."""
    found = [(edge.placed.element, edge.placed.port) for edge in edges]
    resistors = [(name, port) for name, port in found if isinstance(port, DissipativePort)]
    taken = laws.circuit.names
    return [(name, port) for name, port in resistors if turn(port, taken) is None]


def _inverse(element: str, port: DissipativePort) -> tuple[str, str]:
    """Return what is expected of a law that gives what is given already, and the law to write."""
    field, letter = inverse_field(port)
    expected = f"the law of '{element}' as a function of {letter}, which is given"
    remedy = f"give the inverse law, {field} = '...' of {letter}"
    return expected, f"{remedy} (only laws c*{port.letter} are turned round)"


def _couplings(laws: Laws, relation: Form) -> list[str]:
    """Return the couplings whose ratios stand in a relation, in the order of the spec."""
    found = {
        symbol for value in relation.values() for symbol in laws.expression(value).free_symbols
    }
    return [p.element for p, port in laws.circuit.of(Coupling) if laws.symbols[port.name] in found]


def _place(laws: Laws, names: list[str]) -> str:
    """Return where the elements meet, if they all do at one node."""
    nodes = [
        {
            node
            for element, branch, _ in branches(laws.circuit)
            if element == name
            for node in branch
        }
        for name in names
    ]
    common = sorted(node for node in set.intersection(*nodes) if not is_reference(node))
    return f" at node '{common[0]}'" if len(common) == 1 and not is_inner(common[0]) else ""


def _undetermined(singular: SingularError) -> NetworkError:
    loose = [label[1] for label in singular.undetermined if label[0] == "e"]
    at = f"node '{loose[0]}'" if loose else "the network"
    remedy = "connect a capacitor, mass, source or voltage-law resistor there"
    return NetworkError(f"nothing determines {at}", "network", remedy=remedy)
