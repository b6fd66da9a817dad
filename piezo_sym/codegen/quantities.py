"""The named quantities of a program: co-states, ratios, driving forces, laws, heats, sums.

Input: an `IPHS`.  Output: `Quantities`, the definitions in an order in which each can be computed,
and the terms of Definition 1's products as expressions in them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace as replace_fields
from functools import cached_property
from typing import final

import sympy as sp

from piezo_sym.algebra.coefficients import coefficient
from piezo_sym.algebra.lanes import LaneMatrix, Slot
from piezo_sym.codegen.expm1_difference import with_excess
from piezo_sym.codegen.program import Quantity
from piezo_sym.expressions.calculus import add, div, is_affine, mul, neg
from piezo_sym.expressions.tree import (
    Expr,
    LaneSum,
    Sym,
    rebuild,
    rename,
    replace,
)
from piezo_sym.iphs import IPHS
from piezo_sym.iphs.definitions import costate_name, heated
from piezo_sym.network import port_order
from piezo_sym.spec.elements.ports import Body, Conductor, Coupling, Resistor, Source, Storage
from piezo_sym.spec.names import fresh


@final
class Quantities:
    """A growing list of definitions; every name is new, every value refers to earlier names.

    Attributes
    ----------
    defined : the definitions, in order.
    forces, outputs, heats : driving force, output W and heat of each process.
    means : at a stage of a step, the co-states that are given to it.

    Parameters
    ----------
    iphs : the system.
    given : for a stage of a step: co-states that are not affine in the state are `means`.
    """

    def __init__(self, iphs: IPHS, *, given: bool = False) -> None:
        self.system = iphs.system
        self.circuit = iphs.circuit
        self.stores = tuple(self.circuit.of(Storage, Body))
        self.ports = port_order(self.circuit)
        self.bodies: Mapping[str, Body] = {p.element: port for p, port in self.circuit.of(Body)}
        self.taken = set(self.circuit.names)
        self.taken |= {str(symbol.name) for symbol, _ in (*iphs.slopes, *iphs.shares)}
        self.defined: list[Quantity] = []
        self.given = given
        self.means: list[Quantity] = []
        self._sums: dict[LaneSum, Sym] = {}
        self._costates()
        self._ratios()
        self._loops(iphs)
        self.forces, self.outputs, self.heats = self._processes()

    def name(self, base: str) -> str:
        """Return a fresh name, and take it."""
        name = fresh(base, self.taken)
        self.taken.add(name)
        return name

    def define(self, base: str, value: Expr, bank: str | None, note: str) -> Sym:
        """Add a definition under a fresh name, and return the name."""
        return self.defined_as(self.name(base), value, bank, note)

    def defined_as(self, name: str, value: Expr, bank: str | None, note: str) -> Sym:
        """Add a definition under a name that is taken for it, and return the name."""
        self.defined.append(Quantity(name, value, bank, note))
        return Sym(name)

    def total(self, arg: Expr, bank: str, base: str) -> Sym:
        """Return the quantity that is the sum of `arg` over the lanes of `bank`."""
        key = LaneSum(arg, bank)
        if key not in self._sums:
            self._sums[key] = self.define(base, key, None, "sums over lanes")
        return self._sums[key]

    def costate(self, n: int) -> Sym:
        """Return the co-state of state n."""
        return Sym(costate_name(self.stores[n][1]))

    def input(self, n: int) -> Expr:
        """Return the input of port n that junction laws know: a source's."""
        port = self.ports[n].port
        if not isinstance(port, Source):
            msg = f"port {n} is no source"
            raise TypeError(msg)
        return Sym(port.input)

    def sharp(self, law: Expr) -> Expr:
        """Return a law with differences to a temperature written so that they do not cancel."""
        return with_excess(law, self._temperature_laws, self._excess)

    @cached_property
    def _temperature_laws(self) -> dict[str, Expr]:
        return {
            port.temperature: rename(port.law, {port.letter: port.state})
            for port in self.bodies.values()
        }

    def _excess(self, hot: str, cold: Sym, value: Expr) -> Sym:
        """Return ``hot - cold`` as a quantity, and from now on hot as cold plus this quantity."""
        base = f"{hot}_minus_{cold.name}"
        if self.given:
            return self._given_excess(hot, cold, value, base)
        known = next((q for q in self.defined if q.value == value), None)
        if known:
            return Sym(known.name)
        excess = self.define(base, value, None, "co-states dU/dx")
        place = next(n for n, quantity in enumerate(self.defined) if quantity.name == hot)
        self.defined.insert(place, self.defined.pop())
        self.defined[place + 1] = replace_fields(self.defined[place + 1], value=add(cold, excess))
        return excess

    def _given_excess(self, hot: str, cold: Sym, value: Expr, base: str) -> Sym:
        """Return ``hot - cold`` as what is given, and from now on hot as cold plus this."""
        known = next((mean for mean in self.means if mean.value == value), None)
        if known:
            return Sym(known.name)
        place = next((n for n, mean in enumerate(self.means) if mean.name == hot), -1)
        if place < 0:  # given as a difference to another constant already
            return self.define(base, add(Sym(hot), neg(cold)), None, "co-states dU/dx")
        self.means[place] = Quantity(self.name(base), value, None, self.means[place].note)
        excess = Sym(self.means[place].name)
        self.defined.insert(0, Quantity(hot, add(cold, excess), None, "co-states dU/dx"))
        return excess

    def known(self, expr: Expr) -> Expr:
        """Return an expression with each part that is a temperature written by its name."""
        found = self._temperatures.get(expr)
        return found if found else rebuild(expr, self.known)

    @cached_property
    def _temperatures(self) -> dict[Expr, Sym]:
        return {law: Sym(name) for name, law in self._temperature_laws.items()}

    def row(self, block: LaneMatrix, row: int, given: Callable[[int], Expr]) -> Iterator[Expr]:
        """Yield the terms of ``(block @ given)[row]``, column by column."""
        for c, full, own in block.by_row.get(row, ()):
            yield from self._term(full, own, block.cols[c], given(c))

    def _term(self, full: sp.Expr, own: sp.Expr, col: Slot, value: Expr) -> Iterator[Expr]:
        if full != 0 and col.bank:
            name = value.name if isinstance(value, Sym) else col.label
            yield mul(coefficient(full), self.total(value, col.bank, f"sum_{name}"))
        elif full != 0:
            yield mul(coefficient(full), value)
        if own != 0:
            yield mul(coefficient(own), value)

    def _costates(self) -> None:
        note = "co-states dU/dx"
        for placed, port in self.stores:
            law = rename(port.law, {port.letter: port.state})
            if self.given and not is_affine(law, {port.state}):
                self.means.append(Quantity(costate_name(port), law, placed.bank, note))
                continue
            self.defined_as(costate_name(port), law, placed.bank, note)

    def _ratios(self) -> None:
        for _, port in self.circuit.of(Coupling):
            law = self._at(port.ratio, port.body)
            self.defined_as(port.name, law, None, "transducer ratios")

    def _loops(self, iphs: IPHS) -> None:
        """Define how resistors in a loop share what drives them."""
        processes = tuple(self.circuit.of(Resistor, Conductor))
        for slope in iphs.junction.slopes:
            law = self._at(slope.law, heated(processes[slope.process][1]))
            self.defined_as(str(slope.symbol.name), law, None, "slopes of laws in a loop")
        for symbol, value in iphs.shares:
            name = str(symbol.name)
            self.defined_as(name, coefficient(value), None, "shares of resistors in a loop")

    def _at(self, law: Expr, body: str | None) -> Expr:
        """Return a law in which ``T`` is the temperature of `body`."""
        return self.sharp(rename(law, {"T": self.bodies[body].temperature})) if body else law

    def _processes(self) -> tuple[list[Expr], list[Sym], list[Expr]]:
        forces, outputs, heats = [], [], []
        states, inputs = self.system.B.T, self.system.D.T
        for k, (placed, port) in enumerate(self.circuit.of(Resistor, Conductor)):
            terms = [*self.row(states, k, self.costate)]
            terms += self.row(inputs, k, self.input)
            effort = add(*terms)
            if not isinstance(effort, Sym) and isinstance(port, Resistor):
                effort = self.defined_as(port.effort, effort, placed.bank, "driving forces")
            if isinstance(port, Resistor):
                force: Expr = effort
                law = replace(self._at(port.law, port.heats), {port.letter: effort})
            else:
                force = add(effort, neg(Sym(self.bodies[port.second].temperature)))
                law = div(mul(port.conductance, force), effort)
            output = self.defined_as(port.output, law, placed.bank, "dissipative laws")
            forces.append(force)
            outputs.append(output)
            heats.append(mul(output, effort))
        return forces, outputs, heats

    def heat(self, k: int) -> Sym:
        """Return the quantity that is the heat of process k, summed over the lanes of a bank."""
        slot = self.system.processes[k]
        base = f"heat_{slot.label}"
        if slot.bank:
            return self.total(self.heats[k], slot.bank, base)
        known = next((q for q in self.defined if q.value == self.heats[k]), None)
        return Sym(known.name) if known else self.define(base, self.heats[k], None, "heats")
