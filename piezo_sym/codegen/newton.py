"""One step of the mean-value discrete gradient, and Newton's equations for it, solved.

Input: an `IPHS`, and the elements whose laws are proved odd.  Output: a `Step`.  The step solves

    x_new - x - h*f(x, x_new, u) = 0      f = J0 Ebar - sum b_k Wbar_k + g u, bodies apart

with mean co-states Ebar and laws at the mean temperature.  Newton's matrix is 1 - h*df/dx_new.
Each lane has a row of its own, ``pivot*d + B y = gap``, solved for ``d = free - reaction y`` and
put into the shared rows (a Schur complement).  Their unknowns y are the changes of the shared
states, and one border unknown for each sum over lanes through which lanes act on each other;
`eliminate` solves them as they stand, term by term.  A step costs O(r).

A dissipative step, for a start after a jump, takes the co-states of stores at its end: it is not
of second order, but it damps what is much faster than h.  `loss` says where the energy goes.
"""

from __future__ import annotations

from typing import final

from piezo_sym.algebra.lanes import Slot
from piezo_sym.codegen.differences import sharp_quantity
from piezo_sym.codegen.economy import economical
from piezo_sym.codegen.eliminate import Equations, eliminate
from piezo_sym.codegen.functions import exchanges_of, ports_of, rates_of
from piezo_sym.codegen.jacobian import jacobian_of
from piezo_sym.codegen.loss import is_lossy, with_loss
from piezo_sym.codegen.program import Entry, Field, Row
from piezo_sym.codegen.quantities import Quantities
from piezo_sym.codegen.step import Change, Step
from piezo_sym.expressions.calculus import add, div, mul, neg
from piezo_sym.expressions.tree import ONE, Expr, Sym
from piezo_sym.iphs import IPHS
from piezo_sym.spec.tables import lane_parameters


def step_of(iphs: IPHS, odd: frozenset[str]) -> Step:
    """Return the step of a system.

    Parameters
    ----------
    iphs : from `derive`.
    odd : elements whose dissipative laws are proved odd; across kinks they are averaged.
    """
    q = Quantities(iphs, odd)
    return _step(iphs, q, q.name("h"), rates_of(iphs, q), ())


def start_of(iphs: IPHS) -> Step | None:
    """Return the dissipative step of a system; None without a store, or a body to heat."""
    if not is_lossy(iphs):
        return None
    q = Quantities(iphs, frozenset(), late=True)
    h = q.name("h")
    rates, *numerical = with_loss(q, rates_of(iphs, q), Sym(h))
    return _step(iphs, q, h, rates, tuple(numerical))


def _step(
    iphs: IPHS, q: Quantities, h: str, rates: tuple[Row, ...], numerical: tuple[Row, ...]
) -> Step:
    """Return a step of size h with these rates."""
    states = tuple(Field(q.after[port.state], "", "", placed.bank) for placed, port in q.stores)
    slots = iphs.system.processes
    heats = tuple(Row(slot, heat) for slot, heat in zip(slots, q.heats, strict=True))
    produced = zip(slots, q.outputs, q.forces, iphs.system.heats, strict=True)
    productions = tuple(
        Row(slot, div(mul(output, force), q.costate(row))) for slot, output, force, row in produced
    )
    supplies = next(f for f in ports_of(q) if f.name == "supply").rows
    entropies = tuple(Row(Slot(body), rate) for body, rate in exchanges_of(q))
    lanes = {**lane_parameters(iphs.model), **_banks(q)}
    jacobian = jacobian_of(rates, states, lanes, q)
    equations = _Equations(q, h, states, rates, jacobian.entries)
    pivots, changes = equations.solved()
    return economical(
        Step(
            h=h,
            after=tuple(state.name for state in states),
            quantities=tuple(map(sharp_quantity, q.defined)),
            pivots=pivots,
            changes=changes,
            supplies=supplies,
            entropies=entropies,
            heats=heats,
            productions=productions,
            taken=frozenset(q.taken),
            numerical=numerical,
        ),
        lanes,
        (*iphs.model.parameters, *(port.state for _, port in q.stores)),
    )


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
    """Newton's equations of one step, as they are solved; adds quantities to `q`."""

    def __init__(
        self,
        q: Quantities,
        h: str,
        states: tuple[Field, ...],
        rates: tuple[Row, ...],
        entries: tuple[Entry, ...],
    ) -> None:
        self.q, self.h, self.states, self.rates, self.entries = q, h, states, rates, entries
        self.shared = tuple(n for n, state in enumerate(states) if not state.bank)
        self.borders: dict[tuple[int, Expr], int] = {}
        self.gaps = tuple(self._gap(n) for n in range(len(states)))
        self.columns = {state: n for n, state in enumerate(self.shared)}
        for entry in entries:
            for outer in entry.outer:
                key = (entry.col, outer.right)
                self.borders.setdefault(key, len(self.shared) + len(self.borders))

    def _gap(self, n: int) -> Expr:
        """Return the residual of state n."""
        before = self.q.stores[n][1].state
        moved = add(Sym(self.states[n].name), neg(Sym(before)))
        value = add(moved, neg(mul(Sym(self.h), self.rates[n].value)))
        return self.q.define(f"gap_{before}", value, self.states[n].bank, "residuals")

    def solved(self) -> tuple[tuple[Sym, ...], tuple[Change, ...]]:
        """Return the pivots, and the change of each state."""
        names = [f"change_{self.q.stores[n][1].state}" for n in self.shared]
        names += [f"border_{n + 1}" for n in range(len(self.borders))]
        equations = Equations([self.q.name(name) for name in names])
        for n in range(len(names)):
            equations.add((n, n), ONE)
        for n, state in enumerate(self.shared):
            equations.right[n] = self.gaps[state]
        for entry in self.entries:
            if entry.row in self.columns and entry.col in self.columns:
                place = self.columns[entry.row], self.columns[entry.col]
                equations.add(place, neg(mul(Sym(self.h), entry.value)))
        lanes = [n for n, state in enumerate(self.states) if state.bank]
        found = {lane: self._lane(lane, equations) for lane in lanes}
        pivots, unknowns = eliminate(equations, self.q)
        for n, state in enumerate(self.shared):
            found[state] = Change(unknowns[n])
        return pivots, tuple(found[n] for n in range(len(self.states)))

    def _lane(self, lane: int, equations: Equations) -> Change:
        """Return the change of a lane's state; its row is solved and put into the shared rows."""
        bank, state = str(self.states[lane].bank), self.q.stores[lane][1].state
        values = [e.value for e in self.entries if (e.row, e.col) == (lane, lane)]
        pivot = add(ONE, *(neg(mul(Sym(self.h), v)) for v in values))
        pivot = self.q.define(f"pivot_{state}", pivot, bank, "pivots of lanes")
        note = "lanes eliminated"
        free = self.q.define(f"free_{state}", div(self.gaps[lane], pivot), bank, note)
        reactions = {
            n: self.q.define(f"reaction_{state}_{n + 1}", div(value, pivot), bank, note)
            for n, value in self._row_of(lane).items()
        }
        for n, factor in self._column_of(lane).items():
            share = self.q.define(f"share_{state}_{n + 1}", factor, bank, note)
            total = self.q.total(mul(share, free), bank, f"sum_{share.name}")
            equations.right[n] = add(equations.right[n], neg(total))
            for column, value in reactions.items():
                total = self.q.total(mul(share, value), bank, f"sum_{share.name}_{column + 1}")
                equations.add((n, column), neg(total))
        unknowns = equations.unknowns
        return Change(free, tuple((value, Sym(unknowns[n])) for n, value in reactions.items()))

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
