"""Causality: which of its two variables each resistor gives and which it is given.

Input: a `Circuit`.  Output: the same circuit in which laws that are linear in their variable are
turned round where the junction laws ask for it (an amplifier's output resistance before a bank of
hysterons is given the current, whether its law says ``voltage = "R*i"`` or ``current = "v/R"``).
A law that is not linear keeps its causality; if that cannot be, the network is refused by name.
Stores that depend on others are given their co-state, see `rigid`.
"""

from __future__ import annotations

from piezo_sym.algebra.linear import SingularError
from piezo_sym.algebra.symbols import SymbolTable
from piezo_sym.errors import NetworkError
from piezo_sym.network.inverse import turn
from piezo_sym.network.kirchhoff import Laws
from piezo_sym.network.rigid import dependent
from piezo_sym.spec.circuit import Circuit, Placed
from piezo_sym.spec.elements.ports import DissipativePort

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
