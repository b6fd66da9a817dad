"""One stage of a collocation step, and the slopes that Newton's method needs, before any language.

Input: an `IPHS`.  Output: a `Collocation`.  At a stage the state is X(c_i), and co-states are
weighted means over the step (STEPPING: energy-preserving Gauss collocation):

    Ebar_i = int_0^1 (l_i(tau)/b_i) dU/dx(X(tau)) dtau
    K_i    = J0 Ebar_i - sum_k b_k W_k(zbar_ki) + g u_i,   a body's row: heats/Tbar_i + exchanges

A co-state that is affine in its state is its value at X(c_i); the others, and differences such as
T - T_0 that would cancel, are given: `means` says what they are means of.  Laws take the branches
that they are given, so that what Newton's method sees is smooth; the switching functions tell
which branches these should be.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import final

from piezo_sym.algebra.lanes import Slot
from piezo_sym.codegen.differences import sharp_quantity
from piezo_sym.codegen.functions import exchanges_of, limits_of, ports_of, rates_of
from piezo_sym.codegen.jacobian import jacobian_of
from piezo_sym.codegen.paths import Path
from piezo_sym.codegen.program import Entry, Field, Limit, Quantity, Row, needed
from piezo_sym.codegen.quantities import Quantities
from piezo_sym.codegen.switches import Switch, Switches, compared, lanes_of
from piezo_sym.expressions.calculus import div, is_affine, mul
from piezo_sym.expressions.tree import names, rename
from piezo_sym.iphs import IPHS
from piezo_sym.iphs.definitions import costate_name
from piezo_sym.spec.elements.ports import Body, Storage
from piezo_sym.spec.tables import lane_parameters


@final
@dataclass(frozen=True)
class Stage:
    """What a stage computes.

    Attributes
    ----------
    quantities : in an order in which they can be computed.
    rates : of each state.
    booked : what the ledger takes: power of each port, heat and entropy production of each process,
        entropy rate of each heat exchange.
    switches : of the laws, in order.
    limits : conditions of the domain that a state can leave.
    taken : every name in use.
    bends : what changes its sign where a function has a kink whose mean the stage is given.
    """

    quantities: tuple[Quantity, ...]
    rates: tuple[Row, ...]
    booked: tuple[Row, ...]
    switches: tuple[Switch, ...]
    limits: tuple[Limit, ...]
    taken: frozenset[str]
    bends: tuple[Row, ...] = ()


@final
@dataclass(frozen=True)
class Slopes:
    """The derivative of the rates by the state at a point, on given branches."""

    quantities: tuple[Quantity, ...]
    entries: tuple[Entry, ...]
    switches: tuple[Switch, ...]
    taken: frozenset[str]


@final
@dataclass(frozen=True)
class Collocation:
    """A collocation step of a system.

    Attributes
    ----------
    means : the functions of the state whose weighted means a stage is given.
    heated : the state whose row takes what a dissipative step loses, the first body's; -1 if there
        is no body, or no store that could lose anything.
    jumps : whether a law says that it is discontinuous.
    paths : what a stage is given behind the means.
    """

    means: tuple[Quantity, ...]
    stage: Stage
    slopes: Slopes
    heated: int
    jumps: bool
    paths: tuple[Path, ...] = ()


def collocation_of(iphs: IPHS) -> Collocation:
    """Return the collocation step of a system."""
    q = Quantities(iphs, given=True)
    stage = _stage(iphs, q)  # its conditions may be what asks for a difference of temperatures
    means = tuple(replace(mean, value=compared(mean.value)) for mean in q.means)
    sharp = tuple(map(sharp_quantity, means))
    jumps = any(
        getattr(element, "discontinuous", False) for element in iphs.model.elements.values()
    )
    return Collocation(sharp, stage, _slopes(iphs), _heated(iphs), jumps)


def _heated(iphs: IPHS) -> int:
    ports = [port for _, port in iphs.circuit.of(Storage, Body)]
    lossy = any(isinstance(port, Storage) for port in ports)
    bodies = (n for n, port in enumerate(ports) if isinstance(port, Body))
    return next(bodies, -1) if lossy else -1


def _stage(iphs: IPHS, q: Quantities) -> Stage:
    rates, slots = rates_of(iphs, q), iphs.system.processes
    heats = tuple(Row(slot, heat) for slot, heat in zip(slots, q.heats, strict=True))
    produced = zip(slots, q.outputs, q.forces, iphs.system.heats, strict=True)
    productions = tuple(
        Row(slot, div(mul(output, force), q.costate(row))) for slot, output, force, row in produced
    )
    supplies = next(f for f in ports_of(q) if f.name == "supply").rows
    entropies = tuple(Row(Slot(body), rate) for body, rate in exchanges_of(q))
    moving = (limit for limit in limits_of(iphs.model, q) if _moves(iphs, q, limit))
    limits = tuple(replace(limit, margin=compared(limit.margin)) for limit in moving)
    switches = _switches(iphs, q)
    quantities = [*switches.quantities(q.defined)]
    rows = switches.rows(rates)
    booked = switches.rows((*supplies, *heats, *productions, *entropies))
    bends = switches.bends(q.means)
    quantities += switches.new()
    found = tuple(switches.found.values())
    sharp = tuple(map(sharp_quantity, quantities))
    return Stage(sharp, rows, booked, found, limits, frozenset(q.taken), bends)


def _moves(iphs: IPHS, q: Quantities, limit: Limit) -> bool:
    """Return whether a condition depends on the state: the others hold for a whole run."""
    fixed = {*iphs.model.parameters, *iphs.model.inputs}
    _, used = needed(q.defined, [limit.margin])
    own = {*(mean.name for mean in q.means), *(port.state for _, port in q.stores)}
    return not own.isdisjoint({*used, *names(limit.margin)} - fixed)


def _slopes(iphs: IPHS) -> Slopes:
    q = Quantities(iphs)
    rates = rates_of(iphs, q)
    switches = _switches(iphs, q)
    laws = {costate_name(p): rename(p.law, {p.letter: p.state}) for _, p in q.stores}
    states = {costate_name(port): port.state for _, port in q.stores}
    means = {name for name, law in laws.items() if not is_affine(law, {states[name]})}
    q.defined[:] = switches.quantities(q.defined, means)  # a stage is given these
    rows = switches.rows(rates)
    q.defined += switches.new()
    fields = tuple(Field(port.state, "", "", placed.bank) for placed, port in q.stores)
    entries = jacobian_of(rows, fields, switches.lanes, q).entries
    quantities = tuple(map(sharp_quantity, q.defined))
    return Slopes(quantities, entries, tuple(switches.found.values()), frozenset(q.taken))


def _switches(iphs: IPHS, q: Quantities) -> Switches:
    known = {**lane_parameters(iphs.model)}
    known |= {port.state: placed.bank for placed, port in q.stores if placed.bank}
    known |= {mean.name: mean.bank for mean in q.means if mean.bank}
    return Switches(lanes_of(known, q.defined), q.name)
