"""What each element does: the effort, flow and power of its branches, its energy, its heat.

Input: an `IPHS`.  Output: rows named ``<element>.<quantity>``, as trees in co-states, law outputs,
states, parameters and the symbols of `in_words` for rates, heats and so on, which printers and
readers of printed text resolve each in their own way.  A branch's power, effort times flow, flows
into its element: for a store it is the rate of its energy, for a source minus its supply.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple, TypeVar, final

from piezo_sym.expressions.calculus import add, derivative, inserted, mul, neg
from piezo_sym.expressions.tree import Expr, Sym
from piezo_sym.iphs.definitions import costate_name
from piezo_sym.iphs.iphs import IPHS
from piezo_sym.network import port_order
from piezo_sym.network.joints import Member
from piezo_sym.spec.circuit import Placed
from piezo_sym.spec.elements.domains import THERMAL, PhysicalDomain, PowerVariable
from piezo_sym.spec.elements.ports import (
    Body,
    Conductor,
    Coupling,
    DissipativePort,
    Exchange,
    HeatInput,
    Source,
    Storage,
)

V = TypeVar("V")


class ElementRow(NamedTuple):
    """A quantity of an element: its name, SI unit, text, value and bank."""

    name: str
    unit: str
    doc: str
    value: Expr
    bank: str | None = None


def in_words(given: Mapping[str, Sequence[V]]) -> dict[str, V]:
    """Return values by the names of the symbols that element rows have for them.

    Parameters
    ----------
    given : by kind: "rate" of each state; "drive" (z without temperatures) and "heat" of each
        process; "input" of Definition 1, "output" and "supply" of each port; "answer", two per
        coupling, see `Junction`.
    """
    return {
        _symbol(kind, n).name: v for kind, values in given.items() for n, v in enumerate(values)
    }


def _symbol(kind: str, n: int) -> Sym:
    return Sym(f"{kind} {n}")  # no name of a spec has a space


def element_rows(iphs: IPHS) -> tuple[ElementRow, ...]:
    """Return the quantities of all elements, in the order of their declaration."""
    elements, rows = _Elements(iphs), []
    for name, element in iphs.model.elements.items():
        bank = element.bank_of(name)
        for entry in elements.quantities(name):
            words = f"{name}.{entry.name}", entry.unit, f"{entry.doc} {element.kind} '{name}'"
            rows.append(ElementRow(*words, entry.value, bank))
    return tuple(rows)


@final
class _Elements:
    """The quantities of each element of one system."""

    def __init__(self, iphs: IPHS) -> None:
        self.iphs, circuit = iphs, iphs.circuit
        self.ports: dict[str, list[Placed]] = {name: [] for name in iphs.model.elements}
        for placed in circuit.ports:
            self.ports[placed.element].append(placed)
        self.places: dict[int, int] = {}  # the index of each port among those of its kind
        for kinds in ((Storage, Body), (DissipativePort, Conductor), (Coupling,)):
            alike = (placed for placed in circuit.ports if isinstance(placed.port, kinds))
            self.places |= {id(placed): n for n, placed in enumerate(alike)}
        self.places |= {id(placed): n for n, (placed, _) in enumerate(port_order(circuit))}
        self.joined = {m.element: (m, j) for j in iphs.junction.joints for m in j.members}

    def quantities(self, name: str) -> Iterator[ElementRow]:
        """Yield the quantities of one element."""
        iphs, ports = self.iphs, self.ports[name]
        if name in self.joined:
            member, joint = self.joined[name]
            costate, store, rate = joint.costate(member), member.store, _joined_rate(iphs, member)
            yield from self._branch(store.domain, store.imposes, costate, rate)
            stored = inserted(member.energy, {store.costate: costate})
            yield ElementRow("energy", "J", "energy of", stored)
            return
        stores = [placed for placed in ports if isinstance(placed.port, Storage | Body)]
        if len(ports) == 1 and not stores:
            yield from self._storeless(ports[0])
            return
        several = len(stores) > 1
        for placed in stores:
            yield from self._store(placed, ports, several)
        if several:
            powers = (mul(Sym(costate_name(port)), rate) for port, rate in map(self._rate, stores))
            yield ElementRow("power", "W", "power into", add(*powers))
        rows = {self.places[id(placed)] for placed in stores}
        for energy in iphs.energies:
            if rows & {*energy.rows}:
                yield ElementRow("energy", "J", "energy of", energy.law)
        for placed in ports:
            if isinstance(placed.port, DissipativePort):
                yield self._heat(placed)
                if placed.port.limit is not None:
                    effort = placed.port.domain.variable(placed.port.imposes.other)
                    yield ElementRow("limit", effort.unit, "largest effort of", placed.port.limit)

    def _branch(
        self,
        domain: PhysicalDomain,
        imposes: PowerVariable,
        given: Expr,
        other: Expr,
        end: str = "",
        of: str = "of",
        power: Expr | None = None,
    ) -> Iterator[ElementRow]:
        """Yield effort and flow of a branch, and its power; `given` is the imposed variable."""
        variables = (given, other) if imposes is domain.effort else (other, given)
        kinds = (domain.effort, domain.effort.other)
        for word, kind, value in zip(("effort", "flow"), kinds, variables, strict=True):
            variable = domain.variable(kind)
            yield ElementRow(
                word + end, variable.unit, f"{variable.name.replace('_', ' ')} {of}", value
            )
        if not end:
            power = mul(*variables) if power is None else power
            yield ElementRow("power", "W", "power into", power)

    def _store(self, placed: Placed, ports: list[Placed], several: bool) -> Iterator[ElementRow]:
        port, rate = self._rate(placed)
        for other in ports:
            if isinstance(other.port, DissipativePort):  # a hysteron's resistor, or a slip
                gives = other.port.imposes is port.imposes.other
                output = Sym(other.port.output)
                rate = add(rate, output if gives else _symbol("drive", self.places[id(other)]))
        costate, end = Sym(costate_name(port)), f"_{port.state}" if several else ""
        yield from self._branch(port.domain, port.imposes, costate, rate, end)

    def _rate(self, placed: Placed) -> tuple[Storage | Body, Expr]:
        """Return a store and the rate of its state."""
        assert isinstance(placed.port, Storage | Body)
        return placed.port, _symbol("rate", self.places[id(placed)])

    def _heat(self, placed: Placed) -> ElementRow:
        return ElementRow("heat", "W", "heat of", _symbol("heat", self.places[id(placed)]))

    def _storeless(self, placed: Placed) -> Iterator[ElementRow]:
        """Yield the quantities of an element that stores nothing."""
        n = self.places[id(placed)]
        match placed.port:
            case DissipativePort() as port:
                heat, given, other = self._heat(placed), Sym(port.output), _symbol("drive", n)
                yield from self._branch(port.domain, port.imposes, given, other, power=heat.value)
                yield heat
            case Conductor() as port:
                bodies = self.iphs.circuit.bodies
                hot, cold = (Sym(bodies[end].temperature) for end in (port.first, port.second))
                yield ElementRow("effort", "K", "temperature difference over", add(hot, neg(cold)))
                doc = "heat from first to second body by"
                yield ElementRow("power", "W", doc, _symbol("heat", n))
            case Source() as port:
                pushes = port.imposes is PowerVariable.THROUGH  # into its first node
                given, output, power = (_symbol(word, n) for word in ("input", "output", "supply"))
                ends: tuple[Expr, Expr] = (neg(given), output) if pushes else (given, neg(output))
                yield from self._branch(port.domain, port.imposes, *ends, power=neg(power))
            case Exchange() | HeatInput():
                given, flow, power = _symbol("output", n), _symbol("input", n), _symbol("supply", n)
                pair = (given, neg(flow))
                yield from self._branch(THERMAL, THERMAL.effort, *pair, "", "at", neg(power))
            case Coupling() as port:
                yield from self._coupling(
                    port, _symbol("answer", 2 * n), _symbol("answer", 2 * n + 1)
                )

    def _coupling(self, port: Coupling, first: Expr, across: Expr) -> Iterator[ElementRow]:
        """Yield the quantities of both branches, and the power from the first to the second."""
        one, two = mul(Sym(port.name), across), neg(mul(Sym(port.name), first))
        ends = ((first, one), (across, two)) if port.gyrates else ((one, first), (across, two))
        domains = (port.first_domain, port.second_domain)
        for n, (domain, (e, f)) in enumerate(zip(domains, ends, strict=True), 1):
            yield from self._branch(
                domain, PowerVariable.ACROSS, e, f, f"_{n}", f"in branch {n} of"
            )
        yield ElementRow("power", "W", "power from branch 1 to branch 2 of", mul(*ends[0]))


def follower_rates(iphs: IPHS) -> tuple[Expr, ...]:
    """Return the rates of the own states of stores that follow other stores."""
    followers = {m.element: m for j in iphs.junction.joints for m in j.followers}
    slots = iphs.junction.couplings["R"].cols
    return tuple(_joined_rate(iphs, followers[slot.label]) for slot in slots)


def _joined_rate(iphs: IPHS, member: Member) -> Expr:
    """Return the rate of a joined store's own state: its compliance times its co-state's rate."""
    joint = next(joint for joint in iphs.junction.joints if member in joint.members)
    rows = {slot.label: n for n, slot in enumerate(iphs.system.states)}
    laws = {port.state: port.law for _, port in iphs.circuit.of(Storage)}
    terms = []
    for kept in joint.kept:
        slopes = (
            mul(share, derivative(laws[other.store.state], kept.store.state))
            for share, other in zip(member.shares, joint.kept, strict=True)
        )
        slope = mul(member.compliance, add(*slopes))
        terms.append(mul(slope, _symbol("rate", rows[kept.store.state])))
    return add(*terms)
