"""What each element does: the effort, flow and power of its branches, its energy, its heat.

Input: an `IPHS`, and `Parts`: its co-states, rates, law outputs ... in the algebra of whoever asks,
which are trees where modules are printed, and normal forms where they are read back.  Output: rows
named ``<element>.<quantity>``.  A branch's power, effort times flow, flows into its element: that
of a store is the rate of its energy, that of a source the negative of what it supplies.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Generic, NamedTuple, TypeVar, final

from piezo_sym.expressions.calculus import add, derivative, inserted, mul
from piezo_sym.expressions.tree import Expr, Sym
from piezo_sym.iphs.iphs import IPHS
from piezo_sym.network import port_order
from piezo_sym.network.joints import Joint, Member
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


@final
@dataclass(frozen=True)
class Parts(Generic[V]):
    """The parts of a system in one algebra.

    Attributes
    ----------
    costates, rates : of each state.
    outputs, drives, heats : W, z and W z of each process, in which z holds no temperature.
    inputs, ports, supplies : the inputs of Definition 1, their outputs and power, of each port.
    couplings : given the rates of joined stores, the answers of couplings, see `Junction`.
    law : the value of a tree in names.
    total, product, negative : sums, products, negatives.
    """

    costates: Sequence[V]
    rates: Sequence[V]
    outputs: Sequence[V]
    drives: Sequence[V]
    heats: Sequence[V]
    inputs: Sequence[V]
    ports: Sequence[V]
    supplies: Sequence[V]
    couplings: Callable[[Sequence[V]], Sequence[V]]
    law: Callable[[Expr], V]
    total: Callable[..., V]
    product: Callable[[V, V], V]
    negative: Callable[[V], V]


class ElementRow(NamedTuple, Generic[V]):
    """A quantity of an element: its name, SI unit, text and bank, and its value."""

    name: str
    unit: str
    doc: str
    bank: str | None
    value: V


class _Part(NamedTuple, Generic[V]):
    quantity: str
    unit: str
    doc: str
    value: V


def element_rows(iphs: IPHS, parts: Parts[V]) -> tuple[ElementRow[V], ...]:
    """Return the quantities of all elements, in the order of their declaration."""
    reader, found = _Elements(iphs, parts), []
    for name, element in iphs.model.elements.items():
        bank = element.bank_of(name)
        for part in reader.quantities(name):
            doc = f"{part.doc} {element.kind} '{name}'"
            found.append(ElementRow(f"{name}.{part.quantity}", part.unit, doc, bank, part.value))
    return tuple(found)


@final
class _Elements(Generic[V]):
    """Finds the quantities of each element of one system."""

    def __init__(self, iphs: IPHS, parts: Parts[V]) -> None:
        self.iphs, self.parts, circuit = iphs, parts, iphs.circuit
        self.ports: dict[str, list[Placed]] = {name: [] for name in iphs.model.elements}
        for placed in circuit.ports:
            self.ports[placed.element].append(placed)
        self.places: dict[int, int] = {}  # of each port, among those of its kind
        for kinds in ((Storage, Body), (DissipativePort, Conductor), (Coupling,)):
            found = [placed for placed in circuit.ports if isinstance(placed.port, kinds)]
            self.places |= {id(placed): n for n, placed in enumerate(found)}
        self.places |= {id(placed): n for n, placed in enumerate(port_order(circuit))}
        self.joined = {m.element: (m, j) for j in iphs.junction.joints for m in j.members}
        followers = {m.element: m for j in iphs.junction.joints for m in j.followers}
        slots = iphs.junction.couplings["R"].cols
        rates = [self._rate(followers[slot.label]) for slot in slots]
        self.couplings = parts.couplings(rates)

    def quantities(self, name: str) -> Iterator[_Part[V]]:
        """Yield the quantities of one element."""
        ports = self.ports[name]
        if name in self.joined:
            member, joint = self.joined[name]
            costate, store = self._costate(member, joint), member.store
            yield from self._branch(store.domain, store.imposes, costate, self._rate(member))
            costates = {store.costate: joint.costate(member)}
            yield self._energy(inserted(member.energy, costates))
            return
        stores = [placed for placed in ports if isinstance(placed.port, Storage | Body)]
        if len(ports) == 1 and not stores:
            yield from self._alone(ports[0])
            return
        several = len(stores) > 1
        for placed in stores:
            yield from self._store(placed, ports, several)
        if several:
            powers = [self._power(placed) for placed in stores]
            yield _Part("power", "W", "power into", self.parts.total(*powers))
        rows = {self.places[id(placed)] for placed in stores}
        for energy in self.iphs.energies:
            if rows & {*energy.rows}:
                yield self._energy(energy.law)
        for placed in ports:
            if isinstance(placed.port, DissipativePort):
                yield self._heat(placed)

    def _branch(
        self,
        domain: PhysicalDomain,
        imposes: PowerVariable,
        given: V,
        other: V,
        end: str = "",
        of: str = "of",
        power: V | None = None,
    ) -> Iterator[_Part[V]]:
        """Yield effort and flow of a branch, of which one variable is `given`, and its power."""
        variables = (given, other) if imposes is domain.effort else (other, given)
        kinds = (domain.effort, domain.effort.other)
        for word, kind, value in zip(("effort", "flow"), kinds, variables, strict=True):
            variable = domain.variable(kind)
            yield _Part(word + end, variable.unit, f"{variable.name.replace('_', ' ')} {of}", value)
        if not end:
            power = self.parts.product(*variables) if power is None else power
            yield _Part("power", "W", "power into", power)

    def _store(self, placed: Placed, ports: list[Placed], several: bool) -> Iterator[_Part[V]]:
        n, port = self.places[id(placed)], placed.port
        end = f"_{port.state}" if several else ""  # type: ignore[union-attr]  # a store's
        costate, rate = self.parts.costates[n], self.parts.rates[n]
        for other in ports:
            if isinstance(other.port, DissipativePort):  # a hysteron's resistor, or a slip
                rate = self.parts.total(rate, self._beside(other, port.imposes.other))  # type: ignore[union-attr]
        yield from self._branch(port.domain, port.imposes, costate, rate, end)  # type: ignore[union-attr]

    def _power(self, placed: Placed) -> V:
        n = self.places[id(placed)]
        return self.parts.product(self.parts.costates[n], self.parts.rates[n])

    def _energy(self, law: Expr) -> _Part[V]:
        return _Part("energy", "J", "energy of", self.parts.law(law))

    def _heat(self, placed: Placed) -> _Part[V]:
        return _Part("heat", "W", "heat of", self.parts.heats[self.places[id(placed)]])

    def _beside(self, placed: Placed, kind: PowerVariable) -> V:
        """Return what a process adds to the variable of this kind of its element's branch."""
        k, gives = self.places[id(placed)], placed.port.imposes is kind  # type: ignore[union-attr]
        return self.parts.outputs[k] if gives else self.parts.drives[k]

    def _alone(self, placed: Placed) -> Iterator[_Part[V]]:
        """Yield the quantities of an element that stores nothing."""
        n, parts = self.places[id(placed)], self.parts
        match placed.port:
            case DissipativePort() as port:
                given, other = parts.outputs[n], parts.drives[n]
                heat = self._heat(placed)
                yield from self._branch(port.domain, port.imposes, given, other, power=heat.value)
                yield heat
            case Conductor() as port:
                hot, cold = (Sym(self.iphs.circuit.body(b).temperature) for b in _ends(port))
                difference = parts.total(parts.law(hot), parts.negative(parts.law(cold)))
                yield _Part("effort", "K", "temperature difference over", difference)
                yield _Part("power", "W", "heat from first to second body by", parts.heats[n])
            case Source() as port:
                given, other, power = parts.inputs[n], parts.ports[n], parts.supplies[n]
                if port.imposes is PowerVariable.THROUGH:
                    given = parts.negative(given)  # it pushes into its first node
                else:
                    other = parts.negative(other)
                power = parts.negative(power)
                yield from self._branch(port.domain, port.imposes, given, other, power=power)
            case Exchange() | HeatInput():
                flow, power = map(parts.negative, (parts.inputs[n], parts.supplies[n]))
                given = parts.ports[n]
                yield from self._branch(THERMAL, THERMAL.effort, given, flow, "", "at", power)
            case Coupling() as port:
                yield from self._coupling(port, *self.couplings[2 * n : 2 * n + 2])

    def _coupling(self, port: Coupling, first: V, across: V) -> Iterator[_Part[V]]:
        """Yield both branches, and the power that goes in at the first and out at the second."""
        parts, ratio = self.parts, self.parts.law(Sym(port.name))
        one, two = parts.product(ratio, across), parts.negative(parts.product(ratio, first))
        ends = ((first, one), (across, two)) if port.gyrates else ((one, first), (across, two))
        domains = (port.first_domain, port.second_domain)
        for n, (domain, (e, f)) in enumerate(zip(domains, ends, strict=True), 1):
            yield from self._branch(
                domain, PowerVariable.ACROSS, e, f, f"_{n}", f"in branch {n} of"
            )
        yield _Part("power", "W", "power from branch 1 to branch 2 of", parts.product(*ends[0]))

    # Joined stores

    def _costate(self, member: Member, joint: Joint) -> V:
        return self.parts.law(joint.costate(member))

    def _rate(self, member: Member) -> V:
        """Return the rate of a joined store's own state: its compliance times its co-state's."""
        joint, states = self.joined[member.element][1], self.iphs.system.states
        rows = {slot.label: n for n, slot in enumerate(states)}
        laws = {port.state: port.law for _, port in self.iphs.circuit.of(Storage)}
        terms = []
        for kept in joint.kept:
            slopes = (
                mul(share, derivative(laws[other.store.state], kept.store.state))
                for share, other in zip(member.shares, joint.kept, strict=True)
            )
            slope = self.parts.law(mul(member.compliance, add(*slopes)))
            terms.append(self.parts.product(slope, self.parts.rates[rows[kept.store.state]]))
        return self.parts.total(*terms)


def _ends(port: Conductor) -> tuple[str, str]:
    return port.first, port.second
