"""Causality: which of its two variables each resistor gives and which it is given.

Input: a `Circuit`.  Output: the same circuit in which laws that are linear in their variable are
turned round where the junction laws ask for it (an amplifier's output resistance before a bank of
hysterons is given the current, whether its law says ``voltage = "R*i"`` or ``current = "v/R"``).
A law that is not linear keeps its causality; if that cannot be, the network is refused by name.
"""

from __future__ import annotations

from dataclasses import replace

import sympy as sp

from piezo_sym.algebra.linear import SingularError
from piezo_sym.algebra.symbols import SymbolTable, to_sympy
from piezo_sym.network.kirchhoff import Laws
from piezo_sym.spec.calculus import derivative, div, mul
from piezo_sym.spec.circuit import Circuit, Placed
from piezo_sym.spec.elements.ports import Domain, Resistor
from piezo_sym.spec.expressions import ONE, ZERO, Div, Expr, Sym, names

#: The letter that a law has in the other causality.
CONJUGATE = {
    (Domain.ELECTRICAL, "i"): "v",
    (Domain.ELECTRICAL, "v"): "i",
    (Domain.MECHANICAL, "v"): "f",
    (Domain.MECHANICAL, "f"): "v",
}


def causal(circuit: Circuit, symbols: SymbolTable) -> Laws:
    """Return the junction laws of a circuit, in a causality in which they have a solution.

    Each turn of a linear law resolves one contradiction between variables that are given; a law is
    turned once at most, so this ends.

    Raises
    ------
    NetworkError
        If no turn of a linear law resolves a contradiction; names the elements in it.
    """
    turned: set[str] = set()
    while True:
        laws = Laws(circuit, symbols)
        contradiction = laws.contradiction()
        if contradiction is None:
            return laws
        found = _to_turn(laws, contradiction, turned)
        if found is None:
            raise laws.refusal(contradiction)
        placed, port = found
        turned.add(placed.element)
        circuit = circuit.replaced(placed, port)


def _to_turn(
    laws: Laws, singular: SingularError, turned: set[str]
) -> tuple[Placed, Resistor] | None:
    """Return a resistor in a contradiction, turned round; one not yet turned, with a linear law."""
    for relation in singular.relations:
        for label in relation:
            kind, number = label[1] if label[0] == "sum" else label
            if kind == "W":
                placed, port = laws.processes[number]
                other = turn(port) if isinstance(port, Resistor) else None
                if placed.element not in turned and other is not None:
                    return placed, other
    return None


def turn(port: Resistor) -> Resistor | None:
    """Return a resistor in its other causality if its law has a slope that is not 0, else None."""
    slope = slope_of(port)
    if slope is None or _is(slope, ZERO):  # what is zero whatever it is given has no other form
        return None
    letter = CONJUGATE[port.domain, port.letter]
    return replace(
        port,
        letter=letter,
        law=_over(Sym(letter), slope),
        output=port.effort,
        effort=port.output,
        imposes=port.imposes.other,
    )


def slope_of(port: Resistor) -> Expr | None:
    """Return the slope of a law that is linear in its letter, else None."""
    slope = derivative(port.law, port.letter)
    if port.letter in names(slope) or not _is(port.law, mul(slope, Sym(port.letter))):
        return None
    return slope


def _over(top: Expr, slope: Expr) -> Expr:
    match slope:
        case Div(left, right) if left == ONE:
            return mul(right, top)
    return div(top, slope)


def _is(law: Expr, other: Expr) -> bool:
    """Return whether two laws are the same function."""
    table = {name: sp.Symbol(name, real=True) for name in (*names(law), *names(other))}
    return bool(sp.expand(to_sympy(law, table) - to_sympy(other, table)) == 0)
