"""Causality: which of its two variables each resistor and store gives, and which it is given.

Input: a `Circuit`.  Output: the same circuit in which laws that are linear in their variable are
turned round where the junction laws ask for it (an amplifier's output resistance before a bank of
hysterons is given the current, whether its law says ``voltage = "R*i"`` or ``current = "v/R"``).
A law that is not linear keeps its causality; if that cannot be, the network is refused by name.
Stores whose co-states the junction laws tie to earlier ones are given theirs.
"""

from typing import Any

from piezo_sym.algebra.linear import Form, SingularError, combine
from piezo_sym.algebra.symbols import SymbolTable
from piezo_sym.errors import NetworkError, quote
from piezo_sym.expressions.tree import names
from piezo_sym.network.inverse import constant_slope, turn, vanishes
from piezo_sym.network.kirchhoff import Laws
from piezo_sym.network.refusals import couplings_in, refusal
from piezo_sym.spec.circuit import Circuit, Placed
from piezo_sym.spec.elements.ports import Body, DissipativePort

#: Laws turned round, times branches of the network: about half a minute.
MOST_WORK = 1_000_000


def causal(circuit: Circuit, symbols: SymbolTable) -> Laws:
    """Return the junction laws of a circuit, in a causality in which they have a solution.

    Each turn of a linear law resolves one contradiction between variables that are given; a law is
    turned once at most, so this ends.

    Raises
    ------
    NetworkError
        If no turn of a linear law resolves a contradiction; names the elements in it.
    """
    turned, followers = set[str](), frozenset[str]()
    while True:
        laws = Laws(circuit, symbols, followers)
        contradiction = laws.contradiction()
        if contradiction is None:
            return laws
        found = _to_turn(laws, contradiction, turned)
        if found is None:
            followers |= dependent(laws, contradiction)
            continue
        placed, port = found
        turned.add(placed.element)
        if len(turned) * len(laws.edges) > MOST_WORK:
            field = port.domain.variable(port.imposes).name
            what = f"more than {len(turned) - 1} laws have to be turned round, one after the other"
            remedy = (
                f"give {field} = '...' of {port.letter} for '{placed.element}' and those like it"
            )
            raise NetworkError(what, "network", remedy=remedy)
        circuit = circuit.replaced(placed, port)


def _to_turn(
    laws: Laws, singular: SingularError, turned: set[str]
) -> tuple[Placed, DissipativePort] | None:
    """Return a resistor in a contradiction, turned round; one not yet turned, with a linear law."""
    for relation in singular.relations:
        for label in relation:
            kind, number = label[1] if label[0] == "sum" else label
            if kind == "W":
                placed, port = laws.processes[number]
                taken = laws.circuit.names
                other = turn(port, taken) if isinstance(port, DissipativePort) else None
                if placed.element not in turned and other is not None:
                    return placed, other
    return None


def dependent(laws: Laws, singular: SingularError) -> set[str]:
    """Return the states of stores whose co-states are decided by others, before them in the spec.

    These are given their co-state and give their rate. Kept are, in the order of the spec, those
    whose co-state is no combination of those kept before.

    Raises
    ------
    NetworkError
        If the laws do not fix the network otherwise, or a store cannot be joined.
    """
    if not singular.relations:
        raise refusal(laws, singular)
    found = set()
    for label, row in _reduced(singular.relations).items():
        why = _hindrance(laws, row)
        if label[0] != "E" or len(row) == 1 or why:
            said = [relation for relation in singular.relations if relation.keys() == row.keys()]
            raise refusal(laws, SingularError([*said, row, *singular.relations], []), why)
        found.add(laws.states[label[1]][1].state)
    return found


def _reduced(relations: list[Form]) -> dict[Any, Form]:
    """Return relations solved for the last store in each, or for what is no store's co-state."""
    labels = dict.fromkeys(label for relation in relations for label in relation)
    stores = sorted(label for label in labels if label[0] == "E")
    order = [*stores, *(label for label in labels if label[0] != "E")]
    rows: dict[Any, Form] = {}
    for relation in relations:
        form = dict(relation)
        for pivot, row in rows.items():
            combine(form, row, -form.get(pivot, 0))
        if form:
            last = max(form, key=order.index)
            form = {label: value / form[last] for label, value in form.items()}
            for row in rows.values():
                combine(row, form, -row.get(last, 0))
            rows[last] = form
    return rows


def _hindrance(laws: Laws, row: Form) -> str:
    """Return why stores whose co-states depend on each other cannot be joined, else nothing."""
    labels = [label[1] if label[0] == "sum" else label for label in row]
    stores = [laws.states[n] for kind, n in labels if kind == "E"]
    if len(stores) < len(row):
        return ""
    known = laws.circuit.model.parameters.keys()
    slips = {port.state for _, port in laws.circuit.of(DissipativePort) if port.rate}
    for placed, store in stores:
        name = quote(placed.element)
        if isinstance(store, Body):
            return f", and {name} is a body, whose temperature nothing else can impose"
        if placed.bank:
            return f", and {name} is a bank, which is not joined to others"
        if store.state in slips:
            return f", and {name} slips"
        slope = constant_slope(store.law, store.state)
        used = {*names(store.law), *names(store.energy or store.law)} - {store.state}
        if slope is None or vanishes(slope) or not known >= used:
            return f", and the energy of {name} is not quadratic"
    for placed, port in couplings_in(laws, row):
        if not known >= {*names(port.ratio)}:
            return f", and the ratio of {quote(placed.element)} is not of parameters alone"
    return ""
