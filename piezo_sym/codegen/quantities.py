"""The named quantities of a system: co-states, ratios, driving forces, laws, heats, sums.

Input: an `IPHS`.  Output: `Quantities`, in an order in which each can be computed from earlier
ones, and the products of Definition 1 as expressions in them.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import final

from piezo_sym.algebra.lanes import LaneMatrix
from piezo_sym.algebra.symbols import coefficient
from piezo_sym.codegen.differences import with_excess
from piezo_sym.codegen.program import Described, Limit, Names, Quantity, banks_of
from piezo_sym.expressions.calculus import add, div, mul, neg
from piezo_sym.expressions.tree import Call, Expr, LaneSum, Mul, Sym, names
from piezo_sym.expressions.tree import replace as substituted
from piezo_sym.iphs import IPHS
from piezo_sym.iphs.definitions import costate_name
from piezo_sym.network import Driven, port_order
from piezo_sym.spec.circuit import Placed
from piezo_sym.spec.elements.ports import Body, Conductor, Coupling, DissipativePort, Storage
from piezo_sym.spec.tables import condition_text, greater

COSTATES, SUMS = "co-states dU/dx", "sums over lanes"
#: The quantity that is the difference of a temperature and a constant.
Excesses = Mapping[tuple[Sym, Sym], Quantity]


@final
@dataclass(frozen=True)
class Quantities:
    """The quantities of a system."""

    iphs: IPHS
    limits: tuple[Limit, ...]  # the conditions of the domain
    defined: tuple[Quantity, ...] = ()  # in an order in which they can be computed
    #: forces, drives, heats: of each process, its driving force, the conjugate variable z, and with
    #: the output W the heat W z.
    forces: tuple[Expr, ...] = ()
    drives: tuple[Expr, ...] = ()
    heats: tuple[Expr, ...] = ()
    taken: frozenset[str] = frozenset()  # every name in use
    #: The bank of each name with a value per lane that is given, not defined as a quantity.
    given: Mapping[str, str] = field(default_factory=dict)

    @cached_property
    def costates(self) -> tuple[Sym, ...]:
        """The co-state of each state; a body's is its temperature."""
        return tuple(Sym(costate_name(port)) for _, port in self.stores)

    @cached_property
    def inputs(self) -> tuple[Sym, ...]:
        """The input of each port."""
        return tuple(Sym(port.input) for _, port in self.ports)

    @cached_property
    def processes(self) -> tuple[tuple[Placed, DissipativePort | Conductor], ...]:
        """The ports of processes."""
        return tuple(self.iphs.circuit.of(DissipativePort, Conductor))

    @cached_property
    def outputs(self) -> tuple[Sym, ...]:
        """The output W of each process."""
        return tuple(Sym(port.output) for _, port in self.processes)

    @cached_property
    def stores(self) -> tuple[tuple[Placed, Storage | Body], ...]:
        """The ports that store energy, one per state."""
        return tuple(self.iphs.circuit.of(Storage, Body))

    @property
    def states(self) -> tuple[Described, ...]:
        """The states, as generated modules describe them."""
        return tuple(Described(s.state, s.units[0], s.doc, p.bank) for p, s in self.stores)

    @property
    def temperatures(self) -> dict[Expr, Sym]:
        """The name of each temperature by its law."""
        return {body.law: Sym(body.temperature) for body in self.bodies.values()}

    @cached_property
    def ports(self) -> tuple[tuple[Placed, Driven], ...]:
        """The ports of inputs, in the order of the outputs."""
        return port_order(self.iphs.circuit)

    @cached_property
    def bodies(self) -> Mapping[str, Body]:
        """The bodies by element."""
        return {placed.element: port for placed, port in self.iphs.circuit.of(Body)}

    @cached_property
    def lanes(self) -> dict[str, str]:
        """The bank of every name that has a value per lane."""
        lanes = {**self.iphs.circuit.lane_parameters, **self.given}
        lanes |= {port.state: placed.bank for placed, port in self.stores if placed.bank}
        return lanes | banks_of(self.defined)

    @cached_property
    def _names(self) -> Mapping[Expr, Sym]:
        return _by_value(self.defined)

    def total(self, term: Expr, bank: str | None) -> Sym:
        """Return the name of a term, or of its sum over the lanes of `bank`."""
        if isinstance(term, Sym) and not bank:
            return term
        return self._names[LaneSum(term, bank) if bank else term]

    def drive(self, k: int) -> Expr:
        """Return the rate that drives the slip of process k."""
        rate = self.slip_rate(k)
        return self._names.get(rate, rate)

    def slip_rate(self, k: int) -> Expr:
        """Return the rate of the state that slips in process k, without its own slip."""
        system, state = self.iphs.system, getattr(self.processes[k][1], "state", "")
        row = [slot.label for slot in system.states].index(state)
        full, own = (
            {place: b for place, b in part.items() if place[1] != k}
            for part in (system.B.full, system.B.own)
        )
        rest = replace(system.B, full=full, own=own)
        terms = self.terms(row, (system.J0, self.costates), (system.G, self.inputs))
        return add(*terms, *map(neg, self.terms(row, (rest, self.outputs))))

    def terms(self, row: int, *products: tuple[LaneMatrix, Sequence[Expr]]) -> Iterator[Expr]:
        """Yield the terms of a row of the sum of products ``block @ factors``, column by column."""
        for block, factors in products:
            for c, full, own in block.by_row.get(row, ()):
                bank, factor = block.cols[c].bank, factors[c]
                if full != 0:
                    name = self._names[LaneSum(factor, bank)] if bank else factor
                    yield mul(coefficient(full), name)
                if own != 0:
                    yield mul(coefficient(own), factor)


def quantities_of(iphs: IPHS) -> Quantities:
    """Return the quantities of a system."""
    system, couplings = iphs.system, iphs.junction.couplings
    new = Names({*iphs.circuit.names, *(str(s.name) for s, _ in (*iphs.slopes, *iphs.shares))})
    excesses = _excesses(iphs, new)
    laws = _laws(iphs, excesses)
    q = Quantities(iphs, tuple(_limits(iphs, excesses)))
    used = {name for law in (*laws.values(), *(m.margin for m in q.limits)) for name in names(law)}
    excesses = {key: excess for key, excess in excesses.items() if excess.name in used}
    defined = [*_costates(iphs, excesses)]
    defined += sums_in((system.J0, system.B.T, system.G.T, couplings["E"]), q.costates, new)
    defined += _junction(iphs, laws)
    q = replace(q, defined=tuple(defined))
    processes = [*_processes(q, laws)]
    drives = tuple(z for *_, z in processes)
    heats = tuple(map(mul, q.outputs, drives))
    slips = [getattr(port, "rate", "") for _, port in q.processes]
    for last in (False, True):  # the rates of slips may use the outputs of the others
        named = zip(processes, slips, strict=True)
        defined += [item for (items, *_), rate in named if bool(rate) is last for item in items]
    defined += sums_in((system.B, system.D, couplings["W"]), q.outputs, new)
    defined += _totals(iphs, heats, _by_value(defined), new)
    forces, taken = tuple(force for _, force, _ in processes), frozenset(new.taken)
    return replace(
        q, defined=tuple(defined), forces=forces, drives=drives, heats=heats, taken=taken
    )


def _by_value(defined: Sequence[Quantity]) -> dict[Expr, Sym]:
    return {item.value: Sym(item.name) for item in reversed(defined)}


def _excesses(iphs: IPHS, new: Names) -> dict[tuple[Sym, Sym], Quantity]:
    """Return T - T_0 for each temperature of the form T = T_0*exp(z)."""
    excesses = {}
    for _, body in iphs.circuit.of(Body):
        match body.law:
            case Mul(Sym() as cold, Call("exp", args)):
                name, value = f"{body.temperature}_minus_{cold.name}", Call("expm1", args)
                excess = Quantity(new(name), mul(cold, value), None, COSTATES)
                excesses[Sym(body.temperature), cold] = excess
    return excesses


def _laws(iphs: IPHS, excesses: Excesses) -> dict[str, Expr]:
    """Return ratios, slopes of laws in a loop, and laws of processes by their names."""
    laws = {port.name: port.ratio for _, port in iphs.circuit.of(Coupling)}
    laws |= {str(slope.symbol.name): slope.law for slope in iphs.junction.slopes}
    laws |= {port.output: port.law for _, port in iphs.circuit.of(DissipativePort)}
    return {name: with_excess(law, excesses) for name, law in laws.items()}


def _limits(iphs: IPHS, excesses: Excesses) -> Iterator[Limit]:
    """Yield the conditions of the domain with their margins, greater minus smaller side."""
    for condition in iphs.circuit.conditions:
        test = greater(condition.tree)
        margin = with_excess(add(test.left, neg(test.right)), excesses)
        yield Limit(condition_text(condition.tree), "=" not in test.op, margin)


def _costates(iphs: IPHS, excesses: Excesses) -> Iterator[Quantity]:
    known = {hot.name: (cold, excess) for (hot, cold), excess in excesses.items()}
    for placed, port in iphs.circuit.of(Storage, Body):
        name, law = costate_name(port), port.law
        if name in known:
            cold, excess = known[name]
            yield excess
            law = add(cold, Sym(excess.name))
        yield Quantity(name, law, placed.bank, COSTATES)


def _junction(iphs: IPHS, laws: Mapping[str, Expr]) -> Iterator[Quantity]:
    """Yield ratios, and the slopes and shares of resistors in a loop."""
    for _, port in iphs.circuit.of(Coupling):
        yield Quantity(port.name, laws[port.name], None, "transducer ratios")
    for slope in iphs.junction.slopes:
        name = str(slope.symbol.name)
        yield Quantity(name, laws[name], None, "slopes of laws in a loop")
    for symbol, value in iphs.shares:
        note = "shares of resistors in a loop"
        yield Quantity(str(symbol.name), coefficient(value), None, note)


def _processes(
    q: Quantities, laws: Mapping[str, Expr]
) -> Iterator[tuple[tuple[Quantity, ...], Expr, Expr]]:
    """Yield the quantities of each process, its driving force and the conjugate variable z."""
    states, driven = q.iphs.system.B.T, q.iphs.system.D.T
    lanes = {c.name for c, (placed, _) in zip(q.costates, q.stores, strict=True) if placed.bank}
    lanes |= {port.output for placed, port in q.processes if placed.bank}
    for k, (placed, port) in enumerate(q.processes):
        z = add(*q.terms(k, (states, q.costates), (driven, q.inputs)))
        defined = list[Quantity]()
        if isinstance(port, Conductor):
            force: Expr = add(z, neg(Sym(q.bodies[port.second].temperature)))
            law = div(mul(port.conductance, force), z)
        else:
            if not isinstance(z, Sym):
                defined.append(Quantity(port.effort, z, placed.bank, "driving forces"))
                z = Sym(port.effort)
            letters: dict[str, Expr] = {port.letter: z}
            if port.rate:
                rate = q.slip_rate(k)
                letters[port.rate_letter] = rate if isinstance(rate, Sym) else Sym(port.rate)
                if not isinstance(rate, Sym):
                    bank = None if lanes.isdisjoint(names(rate)) else placed.bank
                    defined.append(Quantity(port.rate, rate, bank, "rates of slips"))
            force, law = z, substituted(laws[port.output], letters)
        defined.append(Quantity(port.output, law, placed.bank, "dissipative laws"))
        yield tuple(defined), force, z


def _totals(
    iphs: IPHS, heats: Sequence[Expr], known: Mapping[Expr, Sym], new: Names
) -> Iterator[Quantity]:
    """Yield heats, and the energies of banks, summed over lanes."""
    for slot, heat in zip(iphs.system.processes, heats, strict=True):
        if slot.bank:
            yield Quantity(new(f"heat_{slot.label}"), LaneSum(heat, slot.bank), None, SUMS)
        elif heat not in known:
            yield Quantity(new(f"heat_{slot.label}"), heat, None, "heats")
    for energy in iphs.energies:
        if energy.bank:
            word = f"energy_{iphs.system.states[energy.rows[0]].label}"
            yield Quantity(new(word), LaneSum(energy.law, energy.bank), None, SUMS)


def sums_in(blocks: Sequence[LaneMatrix], factors: Sequence[Sym], new: Names) -> Iterator[Quantity]:
    """Yield the sums over lanes in products of blocks and some factors."""
    entries = ((b.cols[c], c, full) for b in blocks for (_, c), full, _ in b.entries())
    columns = {c: slot.bank for slot, c, full in entries if full != 0}
    for c, bank in sorted(columns.items()):
        if bank:
            yield Quantity(new(f"sum_{factors[c].name}"), LaneSum(factors[c], bank), None, SUMS)
