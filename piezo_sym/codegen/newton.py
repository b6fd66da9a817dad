"""One step of the mean-value discrete gradient, and Newton's equations for it, lanes eliminated.

Input: an `IPHS`, and the elements whose laws are proved odd.  Output: a `Step`.  The step solves

    x_new - x - h*f(x, x_new, u) = 0        f = J0 Ebar - sum b_k Wbar_k + g u, and the bodies' rows

with mean co-states Ebar and laws at the mean temperature.  Newton's matrix is 1 - h*df/dx_new.
Each lane has a row of its own, ``pivot*d + B y = gap``: it is solved for d and put into the shared
rows (a Schur complement), whose unknowns y are the changes of the shared states, and one border
unknown for each sum over lanes through which lanes act on each other.  A step costs O(r).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from piezo_sym.algebra.lanes import Slot
from piezo_sym.codegen.functions import exchanges_of, ports_of, rates_of
from piezo_sym.codegen.jacobian import jacobian_of
from piezo_sym.codegen.program import Entry, Field, Quantity, Row
from piezo_sym.codegen.quantities import Quantities
from piezo_sym.iphs import IPHS
from piezo_sym.spec.calculus import add, div, mul, neg
from piezo_sym.spec.elements.ports import Body
from piezo_sym.spec.expressions import ONE, ZERO, Expr, Sym
from piezo_sym.spec.names import fresh
from piezo_sym.spec.tables import lane_parameters


@final
@dataclass(frozen=True)
class Step:
    """What a step computes, before any language.

    Attributes
    ----------
    h, after : the names of the step size and of each state after the step, in state order.
    quantities : in an order in which they can be computed.
    unknowns : names of y: the change of each shared state, then the border unknowns.
    matrix : entries of the shared rows, those that are not zero, as ((row, column), value).
    right : right-hand sides of the shared rows.
    shared : the state of each of the first unknowns.
    lanes : for each state that is one a lane, its row: the change given y.
    rates : f, a row a state.
    supplies, entropies : power and entropy rate that ports put in, a row a port and an exchange.
    heats, productions : of the processes, for the ledger and for the acceptance of a root.
    temperatures : mean temperatures, for the acceptance of a root.
    taken : every name in use.
    """

    h: str
    after: tuple[str, ...]
    quantities: tuple[Quantity, ...]
    unknowns: tuple[str, ...]
    matrix: tuple[tuple[tuple[int, int], Expr], ...]
    right: tuple[Expr, ...]
    shared: tuple[int, ...]
    lanes: tuple[tuple[int, Expr], ...]
    rates: tuple[Row, ...]
    supplies: tuple[Row, ...]
    entropies: tuple[Row, ...]
    heats: tuple[Row, ...]
    productions: tuple[Row, ...]
    temperatures: tuple[Row, ...]
    taken: frozenset[str]


def step_of(iphs: IPHS, odd: frozenset[str]) -> Step:
    """Return the step of a system.

    Parameters
    ----------
    iphs : from `derive`.
    odd : elements whose dissipative laws are proved odd; across kinks they are averaged.
    """
    q = Quantities(iphs, odd)
    states = tuple(Field(q.after[port.state], "", "", placed.bank) for placed, port in q.stores)
    rates = rates_of(iphs, q)
    slots = iphs.system.processes
    heats = tuple(Row(slot, heat) for slot, heat in zip(slots, q.heats, strict=True))
    produced = zip(slots, q.outputs, q.forces, iphs.system.heats, strict=True)
    productions = tuple(
        Row(slot, div(mul(output, force), q.costate(row))) for slot, output, force, row in produced
    )
    lanes = {**lane_parameters(iphs.model), **_banks(q)}
    jacobian = jacobian_of(rates, states, lanes, q)
    equations = _Equations(q, states, rates, jacobian.entries)
    return equations.step(heats, productions)


def _banks(q: Quantities) -> dict[str, str]:
    """Return the bank of each state that is one a lane, before and after the step."""
    return {
        name: placed.bank
        for placed, port in q.stores
        for name in (port.state, q.after[port.state])
        if placed.bank
    }


@final
class _Equations:
    """Newton's equations of one step on their way to a `Step`; adds quantities to `q`."""

    def __init__(
        self,
        q: Quantities,
        states: tuple[Field, ...],
        rates: tuple[Row, ...],
        entries: tuple[Entry, ...],
    ) -> None:
        self.q, self.states, self.rates, self.entries = q, states, rates, entries
        self._supplies = next(f for f in ports_of(q) if f.name == "supply").rows
        self._entropies = tuple(Row(Slot(body), rate) for body, rate in exchanges_of(q))
        self.h = self._name("h")
        self.shared = tuple(n for n, state in enumerate(states) if not state.bank)
        self.borders: dict[tuple[int, Expr], int] = {}
        self.gaps = tuple(self._gap(n) for n in range(len(states)))
        self.columns = {state: n for n, state in enumerate(self.shared)}
        for entry in entries:
            for outer in entry.outer:
                key = (entry.col, outer.right)
                self.borders.setdefault(key, len(self.shared) + len(self.borders))

    def _name(self, base: str) -> str:
        name = fresh(base, self.q.taken)
        self.q.taken.add(name)
        return name

    def _gap(self, n: int) -> Expr:
        """Return the residual of state n."""
        before = self.q.stores[n][1].state
        moved = add(Sym(self.states[n].name), neg(Sym(before)))
        value = add(moved, neg(mul(Sym(self.h), self.rates[n].value)))
        return self.q.define(f"gap_{before}", value, self.states[n].bank, "residuals")

    def step(self, heats: tuple[Row, ...], productions: tuple[Row, ...]) -> Step:
        """Return the step."""
        pivots = {n: self._pivot(n) for n, state in enumerate(self.states) if state.bank}
        matrix: dict[tuple[int, int], list[Expr]] = {}
        for n in range(len(self.shared) + len(self.borders)):
            matrix[n, n] = [ONE]
        for entry in self.entries:
            if entry.row in self.columns and entry.col in self.columns:
                place = self.columns[entry.row], self.columns[entry.col]
                matrix.setdefault(place, []).append(neg(mul(Sym(self.h), entry.value)))
        right = [self.gaps[n] for n in self.shared] + [ZERO] * len(self.borders)
        for lane, pivot in pivots.items():
            self._eliminate(lane, pivot, matrix, right)
        unknowns = [self._name(f"change_{self.q.stores[n][1].state}") for n in self.shared]
        unknowns += [self._name(f"border_{n + 1}") for n in range(len(self.borders))]
        lanes = tuple((lane, self._change(lane, pivot, unknowns)) for lane, pivot in pivots.items())
        temperatures = tuple(
            Row(Slot(placed.element), Sym(port.temperature))
            for placed, port in self.q.stores
            if isinstance(port, Body)
        )
        return Step(
            h=self.h,
            after=tuple(state.name for state in self.states),
            quantities=tuple(self.q.defined),
            unknowns=tuple(unknowns),
            matrix=tuple((place, add(*matrix[place])) for place in sorted(matrix)),
            right=tuple(right),
            shared=self.shared,
            lanes=lanes,
            rates=self.rates,
            supplies=self._supplies,
            entropies=self._entropies,
            heats=heats,
            productions=productions,
            temperatures=temperatures,
            taken=frozenset(self.q.taken),
        )

    def _pivot(self, lane: int) -> Expr:
        values = [e.value for e in self.entries if (e.row, e.col) == (lane, lane)]
        value = add(ONE, *(neg(mul(Sym(self.h), v)) for v in values))
        state = self.q.stores[lane][1].state
        return self.q.define(f"pivot_{state}", value, self.states[lane].bank, "pivots of lanes")

    def _row_of(self, lane: int) -> dict[int, Expr]:
        """Return B: what a lane's row has in the columns of the shared unknowns."""
        found: dict[int, list[Expr]] = {}
        for entry in self.entries:
            if entry.row != lane:
                continue
            if entry.col in self.columns:
                term = neg(mul(Sym(self.h), entry.value))
                found.setdefault(self.columns[entry.col], []).append(term)
            for outer in entry.outer:
                border = self.borders[entry.col, outer.right]
                found.setdefault(border, []).append(neg(mul(Sym(self.h), outer.left)))
        return {column: add(*terms) for column, terms in found.items()}

    def _column_of(self, lane: int) -> dict[int, Expr]:
        """Return C: what the shared rows have in a lane's column."""
        found = {
            self.columns[entry.row]: neg(mul(Sym(self.h), entry.value))
            for entry in self.entries
            if entry.col == lane and entry.row in self.columns
        }
        borders = {n: neg(right) for (col, right), n in self.borders.items() if col == lane}
        return {**found, **borders}

    def _eliminate(
        self,
        lane: int,
        pivot: Expr,
        matrix: dict[tuple[int, int], list[Expr]],
        right: list[Expr],
    ) -> None:
        """Put the solution of a lane's row into the shared rows."""
        bank, state = str(self.states[lane].bank), self.q.stores[lane][1].state
        row = self._row_of(lane)
        for n, factor in self._column_of(lane).items():
            base, note = f"share_{state}_{n + 1}", "lanes eliminated"
            share = self.q.define(base, div(factor, pivot), bank, note)
            total = self.q.total(mul(share, self.gaps[lane]), bank, f"sum_{share.name}")
            right[n] = add(right[n], neg(total))
            for column, value in row.items():
                total = self.q.total(mul(share, value), bank, f"sum_{share.name}_{column + 1}")
                matrix.setdefault((n, column), []).append(neg(total))

    def _change(self, lane: int, pivot: Expr, unknowns: list[str]) -> Expr:
        """Return the change of a lane's state, given those of the shared unknowns."""
        taken = [mul(value, Sym(unknowns[n])) for n, value in self._row_of(lane).items()]
        return div(add(self.gaps[lane], *(neg(term) for term in taken)), pivot)
