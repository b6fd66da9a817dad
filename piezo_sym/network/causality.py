"""Causality: which of its two variables each resistor and store imposes.

Input: a `Circuit`.  Output: the same circuit with linear laws turned round where the junction laws
need it (an amplifier's output resistance before a bank of hysterons takes the current, whether its
law says ``voltage = "R*i"`` or ``current = "v/R"``).  A law that is not linear keeps its causality;
if that cannot be, the network is refused, naming the elements.  Stores whose co-states the junction
laws tie to those of earlier stores follow them: they impose their rate.
"""

from typing import Any

from piezo_sym.algebra.linear import Form, SingularError, combine
from piezo_sym.algebra.symbols import SymbolTable
from piezo_sym.errors import NetworkError, quote
from piezo_sym.expressions.tree import names
from piezo_sym.network.inverse import constant_slope, turn, vanishes
from piezo_sym.network.kirchhoff import Laws, term_of
from piezo_sym.network.refusals import couplings_in, refusal
from piezo_sym.spec.circuit import Circuit, Placed
from piezo_sym.spec.elements.ports import Body, DissipativePort

#: Laws turned round, times branches of the network: about half a minute.
MOST_WORK = 1_000_000


def causal_laws(circuit: Circuit, symbols: SymbolTable) -> Laws:
    """Return the junction laws of a circuit, in a causality in which they have a solution.

    Each turn of a linear law resolves one contradiction between imposed variables.  A law is turned
    once at most, so the loop ends.  Raises `NetworkError` if no turn of a linear law resolves a
    contradiction; names the elements in it.
    """
    turned, followers = set[str](), frozenset[str]()
    while True:
        laws = Laws(circuit, symbols, followers)
        try:
            laws.answers  # noqa: B018 - solved here, kept for later
        except SingularError as contradiction:
            found = _turned_resistor(laws, contradiction, turned)
            if found is None:
                followers |= dependent_states(laws, contradiction)
                continue
        else:
            return laws
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


def _turned_resistor(
    laws: Laws, singular: SingularError, turned: set[str]
) -> tuple[Placed, DissipativePort] | None:
    """Return the first resistor in a contradiction that can be turned, in its other causality."""
    for relation in singular.relations:
        for kind, number in map(term_of, relation):
            if kind == "W":
                placed, port = laws.processes[number]
                taken = laws.circuit.names
                other = turn(port, taken) if isinstance(port, DissipativePort) else None
                if placed.element not in turned and other is not None:
                    return placed, other
    return None


def dependent_states(laws: Laws, singular: SingularError) -> set[str]:
    """Return the states of the stores whose co-states depend on those of other stores.

    In the order of the spec, a store follows if its co-state is a combination of earlier ones; it
    then imposes its rate.  Raises `NetworkError` if the laws do not fix the network otherwise, or a
    store cannot be joined.
    """
    if not singular.relations:
        raise refusal(laws, singular)
    followers = set()
    for label, row in _row_reduced(singular.relations).items():
        why = _hindrance(laws, row)
        if label[0] != "E" or len(row) == 1 or why:
            first = [relation for relation in singular.relations if relation.keys() == row.keys()]
            raise refusal(laws, SingularError([*first, row, *singular.relations], []), why)
        followers.add(laws.states[label[1]][1].state)
    return followers


def _row_reduced(relations: list[Form]) -> dict[Any, Form]:
    """Return relations solved for the last store in each, or for a given that is no co-state."""
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
    """Return why stores whose co-states depend on each other cannot be joined, or ''."""
    stores = [laws.states[n] for kind, n in map(term_of, row) if kind == "E"]
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
