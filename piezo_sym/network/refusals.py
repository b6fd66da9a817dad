"""The errors of junction laws without a single solution, in the terms of the spec.

Input: the laws, and the `SingularError` of their elimination.  Output: one `NetworkError` that
names the elements at fault, where they meet, and what to put there.
"""

from collections.abc import Iterable

from piezo_sym.algebra.linear import Form, SingularError
from piezo_sym.errors import NetworkError, with_article
from piezo_sym.network.inverse import turn
from piezo_sym.network.kirchhoff import Edge, Imposing, Laws, term_of
from piezo_sym.network.nodes import branches, is_inner, is_reference
from piezo_sym.spec.circuit import Placed
from piezo_sym.spec.elements import kind_of
from piezo_sym.spec.elements.domains import THERMAL, PhysicalDomain, PowerVariable
from piezo_sym.spec.elements.ports import Coupling, DissipativePort, Storage

ACROSS, THROUGH = PowerVariable.ACROSS, PowerVariable.THROUGH

MIXED = "variables"


def refusal(laws: Laws, singular: SingularError, why: str = "") -> NetworkError:
    """Return the error of the first contradiction between givens, or of what is undetermined."""
    for relation in singular.relations:
        edges = _edges(laws, relation)
        if chain := next((bank for kind, bank in relation if kind == "s"), None):
            return _chain(chain, edges)
        if edges:
            return _contradiction(laws, relation, edges, why)
    return _undetermined(laws, singular)


def _chain(bank: str, edges: list[Edge]) -> NetworkError:
    """Return the error of cells in series that fix the through variable they share."""
    port = edges[0].port
    word = port.domain.through.name.replace("_", " ")
    names = _quoted([e.placed.element for e in edges])
    what = f"the {word} that cells in series share is fixed by {names}"
    loose = kind_of("dissipation", port.domain)
    remedy = f"put a {loose} in parallel to them in each cell, or write the cells one by one"
    return NetworkError(what, f"banks.{bank}", f"a {port.domain.across.name} of each cell", remedy)


def _edges(laws: Laws, relation: Form) -> list[Edge]:
    """Return the branches whose givens a relation ties, in the order of their elements."""
    keys, order = [*map(term_of, relation)], list(laws.circuit.model.elements)
    tied = (edge for edge in laws.edges if edge.key in keys)
    return sorted(tied, key=lambda edge: order.index(edge.placed.element))


def _contradiction(laws: Laws, relation: Form, edges: list[Edge], why: str) -> NetworkError:
    names = list(dict.fromkeys(edge.placed.element for edge in edges))
    ports = [edge.port for edge in edges]
    words = list(dict.fromkeys(p.domain.variable(p.imposes).name for p in ports))
    word = words[0].replace("_", " ") if len(words) == 1 else MIXED
    couplings = [placed.element for placed, _ in couplings_in(laws, relation)]
    place = f" through {_quoted(couplings)}" if couplings else _place(laws, names)
    if len(names) == 1:
        return _alone(laws, edges, word, place, bool(couplings))
    fixed, why = _unturnable(laws, edges), why or _of_lanes(laws, edges)
    what = f"elements {_quoted(names)} fix each other's {word}{place}{why}"
    if slips := _slipping(laws, edges):
        return NetworkError(what, "network", *_behind_inductor(slips))
    node, mass = _massless(laws, edges)
    put = f"put {with_article(mass)} at '{node}'" if node else ""
    where = "which" if not why and place.endswith(f" '{node}'") else f"and node '{node}'"
    what += f", {where} has no {mass}" * bool(node)
    if fixed:
        expected, remedy = _inverse_law(*fixed[0])
        if node:
            return NetworkError(what, "network", f"one, or {expected}", f"{put}; or {remedy}")
        if len(fixed) == len(edges) and word != MIXED:  # turning one would close a loop
            expected, remedy = "independent laws", _store_between(ports[0], _loose_end(laws, edges))
        elif len(fixed) > 1:
            remedy = f"{remedy}; or {_separation(ports, word == MIXED)}"
        elif word != MIXED and not couplings:
            remedy = f"{remedy}; or {_store_between(ports[0])}"
        return NetworkError(what, "network", expected, remedy)
    if node and word == MIXED:
        return NetworkError(what, "network", f"{with_article(mass)} there", put)
    if THERMAL in [port.domain for port in ports]:
        pumps = [p for p, port in laws.circuit.of(Coupling) if port.second_domain == THERMAL]
        remedy = f"put a resistor in series with {_quoted([p.element for p in pumps])}"
        return NetworkError(what, "network", "a current that is free", remedy)
    remedy = _separation(ports, word == MIXED or bool(couplings))
    if laws.circuit.chains.keys() & {edge.placed.bank for edge in edges} and word != MIXED:
        remedy = _store_between(ports[0])  # a resistor would depend on the cells, and they on it
    return NetworkError(what, "network", "independent storage and sources", remedy)


def _of_lanes(laws: Laws, edges: list[Edge]) -> str:
    """Return the note that a linear law is not turned round because it belongs to a bank, or ''."""
    for placed, port in ((edge.placed, edge.port) for edge in edges if edge.placed.bank):
        if isinstance(port, DissipativePort) and turn(port, laws.circuit.names):
            bank = f"'{placed.element}' is of a bank"
            return f", and {bank}, which has no law for all lanes together"
    return ""


def _alone(laws: Laws, edges: list[Edge], word: str, place: str, coupled: bool) -> NetworkError:
    """Return the error of one element, or the lanes of one bank, whose variable is forced to 0."""
    placed, expected, remedy = edges[0].placed, f"a free {word}", "connect it to other nodes"
    what = f"the {word} of '{placed.element}' is forced to be zero{place}"
    if placed.bank and not coupled and edges[0].port.imposes is ACROSS:
        what = f"the lanes of '{placed.element}' fix each other's {word}{place}"
        remedy = _separation([edges[0].port], mixed=False).partition(", or ")[2]
        if slips := _slipping(laws, edges):
            expected, remedy = _behind_inductor(slips)
        remedy += ", in each lane"
    return NetworkError(what, "network", expected, remedy)


def _slipping(laws: Laws, edges: list[Edge]) -> list[Edge]:
    """Return the capacitors among branches that slip, as stops do: no resistor sets them free."""
    slips = {port.state for _, port in laws.circuit.of(DissipativePort) if port.rate}
    stores = [(edge, edge.port) for edge in edges if isinstance(edge.port, Storage)]
    return [edge for edge, port in stores if port.state in slips and port.imposes is ACROSS]


def _behind_inductor(slips: list[Edge]) -> tuple[str, str]:
    """Return the expectation and the remedy for capacitors that slip."""
    domain = slips[0].port.domain
    inductor = with_article(kind_of("store", domain, THROUGH))
    names = _quoted([edge.placed.element for edge in slips])
    free = f"a {domain.through.name} of {names} that is a state's, or an input"
    return free, f"put {inductor} in series with {names}"


def _loose_end(laws: Laws, edges: list[Edge]) -> str:
    """Return the first node of branches that no given ties to a reference, or ''."""
    tied = {node for edge in laws.edges for node in edge.branch if is_reference(node)}
    across = [edge.branch for edge in laws.edges if edge.imposes is ACROSS]
    while more := {n for pair in across if tied & {*pair} for n in pair} - tied:
        tied |= more
    ends = (node for edge in edges for node in edge.branch)
    return next((node for node in ends if node not in tied and not is_inner(node)), "")


def _massless(laws: Laws, edges: list[Edge]) -> tuple[str, str]:
    """Return the first node at which all forces or torques are given, and the kind of inertia."""
    moved = {n for e in laws.edges if e.port.imposes is ACROSS for n in e.branch}
    for edge in edges:
        port = edge.port
        bare = [n for n in edge.branch if n not in moved and not is_reference(n)]
        if port.domain.mechanical and port.imposes is THROUGH and bare:
            return bare[0], kind_of("store", port.domain, ACROSS)
    return "", ""


def _quoted(names: list[str]) -> str:
    return ", ".join(f"'{name}'" for name in names)


def _separation(ports: list[Imposing], mixed: bool) -> str:
    """Return the advice to separate givens of one variable, or of `mixed` variables."""
    domains = list(dict.fromkeys(port.domain for port in ports if port.domain != THERMAL))
    if mixed:
        loose, stores = _kinds("dissipation", domains), _kinds("store", domains, ACROSS)
        return f"put {loose} between two of them, or {stores} at a node"
    (domain,) = domains
    loose, spring = kind_of("dissipation", domain), kind_of("store", domain, THROUGH)
    if ports[0].imposes is ACROSS:
        if domain.mechanical:
            return f"merge them into one, or put a {spring} or {loose} between them"
        loose = with_article(loose)
        return f"merge those in parallel into one, or put {loose} in series with one of them"
    return f"merge those in series into one, or {_store_between(ports[0])}"


def _store_between(port: Imposing, node: str = "") -> str:
    """Return the advice to put a store between two elements that impose the same variable."""
    domain = port.domain
    store = with_article(kind_of("store", domain, port.imposes.other))
    if port.imposes is ACROSS:
        where = "between them" if domain.mechanical else "in series with one of them"
    else:
        end = f"'{node}'" if node else "their node"
        where = f"at {end}" if node else "at the node between them"
        where = where if domain.mechanical else f"between {end} and '{domain.reference}'"
    return f"put {store} {where}"


def _kinds(role: str, domains: Iterable[PhysicalDomain], *imposes: PowerVariable) -> str:
    """Return the kinds of a role in some domains, as "a mass or capacitor"."""
    return with_article(" or ".join(kind_of(role, domain, *imposes) for domain in domains))


def _unturnable(laws: Laws, edges: list[Edge]) -> list[tuple[str, DissipativePort]]:
    """Return the resistors among branches whose laws cannot be turned round."""
    resistors = [(e.placed.element, e.port) for e in edges if isinstance(e.port, DissipativePort)]
    taken = laws.circuit.names
    return [(name, port) for name, port in resistors if turn(port, taken) is None]


def _inverse_law(element: str, port: DissipativePort) -> tuple[str, str]:
    """Return the expectation and the remedy for a law that imposes what is imposed already."""
    given, asked = map(port.domain.variable, (port.imposes, port.imposes.other))
    expected = f"the law of '{element}' as a function of {given.letter}, which is given"
    remedy = f"give the inverse law, {asked.name} = '...' of {given.letter}"
    return expected, f"{remedy} (only laws c*{port.letter} are turned round)"


def couplings_in(laws: Laws, relation: Form) -> list[tuple[Placed, Coupling]]:
    """Return the couplings whose ratios stand in a relation, in the order of the spec."""
    found = {
        symbol for value in relation.values() for symbol in laws.expression(value).free_symbols
    }
    return [(p, port) for p, port in laws.circuit.of(Coupling) if laws.symbols[port.name] in found]


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


def _undetermined(laws: Laws, singular: SingularError) -> NetworkError:
    loose = [label[1] for label in singular.undetermined if label[0] == "e"]
    at = f"node '{loose[0]}'" if loose else "the network"
    known = list(branches(laws.circuit))
    own = [domain for _, branch, domain in known if not loose or loose[0] in branch]
    domain = own[0]
    store, resistor = _kinds("store", (domain,), ACROSS), kind_of("dissipation", domain)
    law = domain.across.name
    remedy = f"connect {store}, a source, or a {resistor} with a law for its {law} there"
    return NetworkError(f"nothing determines {at}", "network", remedy=remedy)
