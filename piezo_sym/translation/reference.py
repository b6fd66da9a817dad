"""The proved system in normal form: what each function of a module has to be.

Input: an `IPHS`.  Output: a `Proved`: the rows of every function and the entries of the Jacobian as
values, and what the laws divide by.  The Jacobian is derived here from the proved rates, and the
co-states are checked here to be the gradient of the energy.

A parameter of a bank is one number per lane, as it is in printed modules; the proofs close on named
co-states and laws of one lane, so they hold for lanes that differ.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from types import MappingProxyType

import sympy as sp

from piezo_sym.algebra.lanes import Slot
from piezo_sym.iphs import IPHS
from piezo_sym.iphs.elements import element_rows, follower_rates, in_words
from piezo_sym.spec.elements.ports import Body
from piezo_sym.translation.change import across, derivative, in_exponentials
from piezo_sym.translation.field import NotShownError, Value
from piezo_sym.translation.known import ALL, LEAST, SAME, Key, Proved
from piezo_sym.translation.signs import on_path
from piezo_sym.translation.system_reader import SystemReader
from piezo_sym.translation.zero import is_zero


def proved(iphs: IPHS) -> Proved:
    """Return a system in normal form."""
    read = SystemReader(iphs)
    domain = read.assume(condition.tree for condition in iphs.circuit.conditions)
    read.assume_temperatures()
    slots = _slots(iphs)
    elements = tuple(elements_of(read))
    slots["elements"] = tuple(slot for slot, _ in elements)
    values = dict(_values(read, slots))
    values |= {("elements", n): value for n, (_, value) in enumerate(elements)}
    needs = tuple(read.field.needs)
    return Proved(iphs, read.field, read.names, read.banks, slots, values, needs, domain, {})


def _slots(iphs: IPHS) -> dict[str, tuple[Slot, ...]]:
    rates, ports, heats = iphs.system.states, iphs.system.ports, iphs.system.processes
    found = dict.fromkeys(("initial_state", "rhs", "jacobian"), rates)
    found |= {"outputs": ports, "supply": ports, "heat": heats, "entropy_production": heats}
    found["temperatures"] = tuple(Slot(placed.element) for placed, _ in iphs.circuit.of(Body))
    found["margins"] = tuple(Slot(str(n)) for n, _ in enumerate(iphs.circuit.conditions))
    return found | dict.fromkeys(("energy", "entropy"), (Slot(""),))


def of_system(
    read: SystemReader, instead: Mapping[sp.Expr, sp.Expr] = MappingProxyType({})
) -> dict[str, list[Value]]:
    """Return the rows of rates, outputs, supply, heats, production; `instead` replaces products."""
    system = read.iphs.system
    found: dict[str, Iterable[sp.Expr]] = {
        "rhs": system.rhs,
        "outputs": system.y,
        "supply": map(sp.Mul, system.y, system.u),
        "heat": map(sp.Mul, system.W, system.drive),
        "entropy_production": map(sp.Mul, system.R, system.z),
    }
    return {name: [read(term.subs(instead)) for term in terms] for name, terms in found.items()}


def elements_of(read: SystemReader) -> Iterator[tuple[Slot, Value]]:
    """Yield the quantities of all elements."""
    iphs, system = read.iphs, read.iphs.system
    law, blocks = iphs.symbols.law, iphs.junction.couplings
    words = in_words(
        {
            "rate": [*system.rhs],
            "drive": [*system.drive],
            "heat": [*map(sp.Mul, system.W, system.drive)],
            "input": [*system.u],
            "output": [*system.y],
            "supply": [*map(sp.Mul, system.y, system.u)],
        }
    )
    answers = [*(blocks["E"] @ system.E + blocks["W"] @ system.W + blocks["u"] @ system.u)]
    followers = [law(rate, words) for rate in follower_rates(iphs)]
    for (n, m), share, _ in blocks["R"].entries():
        answers[n] += share * followers[m]
    words |= in_words({"answer": answers})
    for row in element_rows(iphs):
        yield Slot(row.name, row.bank), read(law(row.value, words))


def margins_of(values: Sequence[Value]) -> Iterator[tuple[Key, Value]]:
    """Yield rows of margins; that of a bank is the least over its lanes."""
    for n, margin in enumerate(values):
        yield ("margins", n, *([LEAST] if margin.lanes else [])), margin


def _values(
    read: SystemReader, slots: Mapping[str, tuple[Slot, ...]]
) -> Iterator[tuple[Key, Value]]:
    """Yield the rows of every function."""
    iphs, field = read.iphs, read.field
    yield from margins_of(read.margins(condition.tree for condition in iphs.circuit.conditions))
    listed, system = of_system(read), iphs.system
    produced = (r * z for r, z in zip(system.R, system.z, strict=True))
    _tie(iphs, "sigma", zip(produced, system.processes, strict=True), system.sigma)
    bodies = [read(iphs.symbols[port.temperature]) for _, port in iphs.circuit.of(Body)]
    listed |= {"energy": [_energy(read)], "entropy": [read(iphs.S)], "temperatures": bodies}
    for function, rows in listed.items():
        yield from (((function, n), value) for n, value in enumerate(rows))
    for n, parts in enumerate(iphs.starts):
        for lane, part in enumerate(parts):
            place = [lane] if len(parts) > 1 else []
            yield ("initial_state", n, *place), read(iphs.symbols.law(part, {}))
    with on_path(field, None):
        yield from _jacobian(read, slots["rhs"], listed["rhs"])


def _energy(read: SystemReader) -> Value:
    """Return the energy, its gradient checked to be the co-states."""
    iphs, system, parts = read.iphs, read.iphs.system, list[Value]()
    stored = [iphs.symbols.law(energy.law, {}) for energy in iphs.energies]
    slots = [Slot("", energy.bank) for energy in iphs.energies]
    _tie(iphs, "U", zip(stored, slots, strict=True), iphs.U)
    if sorted(n for energy in iphs.energies for n in energy.rows) != [*range(len(system.states))]:
        raise NotShownError("a state has no energy, or more than one")
    for law, energy in zip(stored, iphs.energies, strict=True):
        term = read(law)
        for n in energy.rows:
            label = system.states[n].label
            (state,) = read.names[label].parts
            if not is_zero(in_exponentials(derivative(term, state) - read(system.E[n, 0]))):
                raise NotShownError(f"dU/d{label} is not shown to be the co-state")
        parts.append(read.field.lane_sum(term, energy.bank) if energy.bank else term)
    return read.field.total(parts)


def _tie(iphs: IPHS, name: str, terms: Iterator[tuple[sp.Expr, Slot]], shown: sp.Expr) -> None:
    """Raise `NotShownError` if a published total is not the sum of its terms over all lanes."""
    total = iphs.system.E.lanes.sum
    parts = (total(term, slot.bank) if slot.bank else term for term, slot in terms)
    if sp.expand(sp.Add(*parts) - shown) != 0:
        raise NotShownError(f"{name} of the system is not that of its parts")


def _jacobian(
    read: SystemReader, slots: tuple[Slot, ...], rates: Sequence[Value]
) -> Iterator[tuple[Key, Value]]:
    columns = {g: c for c, slot in enumerate(slots) for g in read.names[slot.label].parts}
    for r, rate in enumerate(rates):
        for c, state in sorted((columns[g], g) for g in rate.parts if g in columns):
            slot = slots[c]
            row, own = slots[r].bank, derivative(rate, state)
            kind = SAME if row and row == slot.bank else ALL
            yield ("jacobian", r, c, kind), own
            if slot.bank:
                other = across(rate, state, 1 if row else 0)
                if kind is ALL and own.terms and other.terms:
                    raise NotShownError("a rate depends on another bank's lane")
                if kind is SAME or not own.terms:
                    yield ("jacobian", r, c, ALL), other
