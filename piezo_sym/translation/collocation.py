"""A stage of a collocation step as the proved system has it: what the printed step has to be.

Input: an `IPHS`.  Output: a `Proved`, the rows of `integrands` and `stage`.  A stage computes

    K = J0 Ebar - sum_k b_k W_k(zbar_k) + g u,    in a body's row heats/Tbar + exchanges

at the state x = X(c) and the means Ebar of co-states over the step.  That is the proved system's
right side with co-states as names.  A co-state that is affine in its state has its value at x as
its mean, so it is a function of x.  The others are names independent of x: what holds for all their
values holds for their means.  A stage is given g = Ebar + c, the means of co-states plus terms c
that do not depend on the state; and of each stop the means of effort, slip and heat, which stands
where effort times slip does in the system, and a share that serves Newton's method alone.
"""

from collections.abc import Iterator
from typing import TypeAlias

import sympy as sp

from piezo_sym.algebra.lanes import Slot
from piezo_sym.expressions.calculus import derivative, div, is_affine
from piezo_sym.expressions.tree import names
from piezo_sym.iphs import IPHS
from piezo_sym.iphs.definitions import costate_name
from piezo_sym.network import port_order
from piezo_sym.spec.circuit import Placed
from piezo_sym.spec.elements.ports import Body, DissipativePort, Exchange, HeatInput, Storage
from piezo_sym.translation.change import spelled
from piezo_sym.translation.field import NotShownError, Value
from piezo_sym.translation.known import Key, Proved
from piezo_sym.translation.reference import margins_of, of_system
from piezo_sym.translation.system_reader import SystemReader

Stop: TypeAlias = tuple[Placed, Storage, DissipativePort]


def proved_step(iphs: IPHS) -> Proved:
    """Return a stage of a system in normal form."""
    read, given = SystemReader(iphs), [condition.tree for condition in iphs.circuit.conditions]
    means = dict(_means(read))
    slots = {"integrands": tuple(slot for slot, _ in means.values())}
    values: dict[Key, Value] = {
        ("integrands", n): value for n, (_, value) in enumerate(means.values())
    }
    for costate, (slot, _) in means.items():
        read.names[slot.label] = read.free(costate, slot.label, slot.bank)
        read.banks |= {slot.label: slot.bank} if slot.bank else {}
    stops = tuple(_stops(iphs))
    given_paths = tuple(slot for stop in stops for slot in _given(read, *stop))
    domain = read.assume(given)
    read.assume_temperatures()
    moving = {slot.label for slot in iphs.system.states}
    moving |= {port.temperature for _, port in iphs.circuit.of(Body)}
    limits = [condition for condition in given if not moving.isdisjoint(names(condition))]
    values |= dict(margins_of(read.margins(limits)))
    for n, limit in enumerate(limits):
        values["strict", n] = read.field.number("=" not in limit.op)
    slots |= dict.fromkeys(("margins", "strict"), tuple(Slot(str(n)) for n in range(len(limits))))
    listed = of_system(read, dict(_heats(read, stops)))
    ledger = dict(_ledger(read, listed))
    slots |= {"rhs": iphs.system.states, "ledger": tuple(ledger)}
    slots["processes"] = iphs.system.processes
    slots["g"] = (*slots["integrands"], *given_paths)
    paths = tuple(_paths(read, stops, slots, values))
    stage = {"rhs": listed["rhs"], "ledger": ledger.values()}
    if all(any(iphs.circuit.of(kind)) for kind in (Storage, Body)):
        slots["costates"] = iphs.system.states
        stage["costates"] = [read(costate) for costate in iphs.system.E]
    for function, rows in stage.items():
        values |= {(function, n): value for n, value in enumerate(rows)}
    functions = {slot.label: value for slot, value in means.values()}
    needs = tuple(read.field.needs)
    found = (iphs, read.field, read.names, read.banks, slots, values, needs, domain, functions)
    return Proved(*found, paths)


def _stops(iphs: IPHS) -> Iterator[Stop]:
    """Yield the element, the store and the slip of each stop."""
    stores = {port.state: port for _, port in iphs.circuit.of(Storage)}
    for placed, port in iphs.circuit.of(DissipativePort):
        if port.limit is not None:
            yield placed, stores[port.state], port


def _given(
    read: SystemReader, placed: Placed, store: Storage, slip: DissipativePort
) -> Iterator[Slot]:
    """Yield the slots of the values of a stop that are given to a stage; add them to the names."""
    given = ("effort", "slip", "heat", "share")
    slots = tuple(Slot(f"{what} of {placed.element}", placed.bank) for what in given)
    effort, moved, heat, share = slots
    read.names[effort.label] = read.free(store.costate, effort.label, placed.bank)
    read.names[moved.label] = read.free(slip.output, moved.label, placed.bank)
    for slot in (heat, share):
        read.names[slot.label] = read.field.name(slot.label, placed.bank, 0, 0)
    for slot in slots:
        read.banks |= {slot.label: slot.bank} if slot.bank else {}
        yield slot


def _heats(read: SystemReader, stops: tuple[Stop, ...]) -> Iterator[tuple[sp.Expr, sp.Symbol]]:
    """Yield each stop's product effort*slip, and the symbol of the mean heat that replaces it."""
    for placed, store, slip in stops:
        heat = sp.Dummy("heat", real=True)
        read.known[heat] = read.names[f"heat of {placed.element}"]
        yield read.iphs.symbols[store.costate] * read.iphs.symbols[slip.output], heat


def _paths(
    read: SystemReader,
    stops: tuple[Stop, ...],
    slots: dict[str, tuple[Slot, ...]],
    values: dict[Key, Value],
) -> Iterator[tuple[str, str | None, bool, bool]]:
    """Yield each stop's row of the table; add the rows of its parameters and its drive."""
    drives = [read(read.iphs.symbols[slip.rate]) for *_, slip in stops]
    seen = {part for drive in drives for part in drive.parts}
    for n, ((placed, store, slip), drive) in enumerate(zip(stops, drives, strict=True)):
        slope = derivative(store.law, store.state)
        assert slip.limit is not None
        parts = read.law(slope), read.law(div(slip.limit, slope))
        values |= {("path_parameters", 2 * n + k): value for k, value in enumerate(parts)}
        values["drives", n] = drive
        own = Slot(placed.element, placed.bank if drive.lanes else None)
        slots["drives"] = (*slots.get("drives", ()), own)
        both = (Slot(placed.element, placed.bank),) * 2
        slots["path_parameters"] = (*slots.get("path_parameters", ()), *both)
        inner = read.names[store.state].parts
        yield store.state, placed.bank, bool(drive.lanes), not seen.isdisjoint(inner)


def _means(read: SystemReader) -> Iterator[tuple[str, tuple[Slot, Value]]]:
    """Yield co-states that are not affine in the states, slots of their means, their values."""
    iphs, known = read.iphs, dict(read.iphs.costates)
    states = [slot.label for slot in iphs.system.states]
    for slot, (_, port) in zip(iphs.system.states, iphs.circuit.of(Storage, Body), strict=True):
        costate = costate_name(port)
        if iphs.symbols.law(port.law, {}) != known[iphs.symbols[costate]]:
            raise NotShownError(f"{costate} of the system is not its law")
        value = spelled(read.law(port.law))
        if not is_affine(port.law, states):
            yield costate, (Slot(f"mean of {costate}", slot.bank), value)
        elif not _shown_affine(value, read.field.states):
            raise NotShownError(f"{costate} is not shown to be affine in the states")


def _shown_affine(value: Value, states: frozenset[int]) -> bool:
    """Return whether each term has one state as a simple factor, or does not depend on states."""
    gens = value.field.gens
    return all(
        found in ([], [1])
        for mono in value.terms
        for found in ([e if g in states else 0 for g, e in mono if gens[g].parts & states],)
    )


def _ledger(read: SystemReader, listed: dict[str, list[Value]]) -> Iterator[tuple[Slot, Value]]:
    """Yield the rows of the ledger: powers, heats, entropy produced, entropy from exchanges."""
    system = read.iphs.system
    parts = {"power of": "supply", "heat of": "heat", "entropy produced by": "entropy_production"}
    for words, function in parts.items():
        for slot, value in zip(
            system.ports if function == "supply" else system.processes,
            listed[function],
            strict=True,
        ):
            yield Slot(f"{words} {slot.label}", slot.bank), value
    shares, inputs = system.G.T @ system.dS, system.u
    for n, (placed, port) in enumerate(port_order(read.iphs.circuit)):
        if isinstance(port, Exchange | HeatInput):
            brought = read(shares[n, 0]) * read(inputs[n, 0])
            yield Slot(f"entropy brought by {placed.element}"), brought
