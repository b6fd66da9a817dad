"""The numerical loss of a dissipative step: what its stores lose beside all processes, as heat.

Input: the `Quantities` of a step whose co-states of stores are those at its end.  Output: the heat
as a quantity, and the rates with it.  With E+ the co-state after a step and Ebar its mean,

    N = sum over stores (E+ - Ebar)*(x_new - x) = sum of lead*(x_new - x)^2      `mean.lead`

is what h y^T u - sum h W z exceeds the stores' gain of energy by; N >= 0 if energies are convex.
The first body declared takes it, since nobody else says which one: the body's row gets N/(h Tbar).
Then U_new - U = h y^T u stays exact, and N/Tbar is one more term of the entropy produced.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from piezo_sym.algebra.lanes import Slot
from piezo_sym.codegen.mean import lead
from piezo_sym.codegen.program import Row
from piezo_sym.codegen.quantities import Quantities
from piezo_sym.expressions.calculus import add, div, mul, neg, power
from piezo_sym.expressions.tree import Sym
from piezo_sym.iphs import IPHS
from piezo_sym.spec.elements.ports import Body, Storage

NAME = "numerical"
NOTE = "numerical losses"


def is_lossy(iphs: IPHS) -> bool:
    """Return whether a system has what a dissipative step needs: a store, and a body to heat."""
    circuit = iphs.circuit
    return bool(tuple(circuit.of(Storage))) and bool(tuple(circuit.of(Body)))


def with_loss(q: Quantities, rates: tuple[Row, ...], h: Sym) -> tuple[tuple[Row, ...], Row, Row]:
    """Return the rates with the loss in the first body's row; its heat and entropy production."""
    heat = numerical_heat(q, h)
    body = next(n for n, (_, port) in enumerate(q.stores) if isinstance(port, Body))
    produced = div(heat, q.costate(body))
    row = replace(rates[body], value=add(rates[body].value, produced))
    slot = Slot(NAME)
    return (*rates[:body], row, *rates[body + 1 :]), Row(slot, heat), Row(slot, produced)


def numerical_heat(q: Quantities, h: Sym) -> Sym:
    """Define the loss of every store, and return their sum over h: a heat [W]."""
    terms = []
    for placed, port in q.stores:
        if not isinstance(port, Storage):
            continue
        old, new = Sym(port.state), Sym(q.after[port.state])
        square = power(add(new, neg(old)), Fraction(2))
        value = mul(lead(port.law, port.letter, old, new), square)
        loss = q.define(f"loss_{port.state}", value, placed.bank, NOTE)
        terms.append(q.total(loss, placed.bank, f"sum_{loss.name}") if placed.bank else loss)
    return q.define(f"heat_{NAME}", div(add(*terms), h), None, NOTE)
