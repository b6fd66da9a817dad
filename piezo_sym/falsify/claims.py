"""What each row says, as numbers that are negative where it is false, in floats or exactly.

Input: a row and a `View` of one point or many.  Output: (name, value, scale, strict) tuples: the
row says value >= 0, or > 0 if strict.  The scale is the sum of the absolute values of the terms of
the value, so that value/scale tells rounding from a change of sign; it is 0 for exact numbers.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol, final

from piezo_sym.iphs import IPHS
from piezo_sym.spec.circuit import Circuit
from piezo_sym.spec.elements.ports import (
    Body,
    Conductor,
    DissipativePort,
    Exchange,
    HeatInput,
    Port,
    Source,
)

#: A balance below zero by less than this part of its scale is rounding.
TOLERANCE = 1e-9
BALANCES = {
    "exergy": "the exergy lost",
    "environment": "the production",
    "invariant": "the entropy gained, times T",
}
#: The value of a quantity and its size, the sum of the absolute values of its terms.
Pair = tuple[Any, Any]


class View(Protocol):
    """Quantities at one point, or at many."""

    def get(self, what: str, name: str) -> list[Pair]:
        """Return a quantity, one pair per lane.

        It is the heat, production, temperature, slope or conductance of an element, the rate of a
        state, or an input.
        """

    def total(self, what: str) -> Pair:
        """Return the sum of a quantity over all elements."""


@final
@dataclass(frozen=True)
class Claim:
    """A row that can be evaluated at a point.

    Attributes
    ----------
    id, element : of the row.
    port : the last port of the element.
    circuit : of the system.
    """

    id: str
    element: str
    port: Port | None
    circuit: Circuit

    @property
    def climbs(self) -> bool:
        """Whether value/scale varies smoothly, so that descending it makes sense."""
        return self.id in {"passive", "conductance", "temperature"}

    @property
    def numbers(self) -> bool:
        """Whether the row is an inequality; else it says that laws have values, or do not jump."""
        return self.id not in {"welldef", "continuous"}

    def at(self, view: View) -> Iterator[tuple[str, Any, Any, bool]]:
        """Yield (name, value, scale, strict) of what must not be negative."""
        match self.id:
            case "passive" | "conductance":
                what = "heat" if isinstance(self.port, DissipativePort) else "conductance"
                yield from ((what, *pair, False) for pair in view.get(what, self.element))
            case "temperature":
                for what in ("temperature", "slope"):
                    yield from ((what, *pair, True) for pair in view.get(what, self.element))
            case "sigma":
                yield "sigma", *view.total("production"), False
            case "exergy" | "environment" | "invariant":
                yield BALANCES[self.id], *self._balance(view), False
        if self.id == "invariant":
            for element, _ in self.exchanges:
                yield "conductance", *view.get("conductance", element)[0], False

    @cached_property
    def states(self) -> Mapping[str, str]:
        """The entropy of each body that a balance is about."""
        alone = self.id == "invariant"
        return {
            placed.element: body.state
            for placed, body in self.circuit.of(Body)
            if not alone or placed.element == self.element
        }

    @cached_property
    def exchanges(self) -> Sequence[tuple[str, Exchange]]:
        """What takes heat from these bodies to the outside, and its element."""
        own = self.circuit.of(Exchange)
        return [(placed.element, port) for placed, port in own if port.body in self.states]

    @cached_property
    def neighbours(self) -> Sequence[str]:
        """The bodies in contact with the row's own."""
        pairs = [(c.first, c.second) for _, c in self.circuit.of(Conductor)]
        ends = (two for pair in pairs for two in (pair, pair[::-1]))
        return [other for own, other in ends if own == self.element]

    def _balance(self, view: View) -> Pair:
        """Return the exergy lost, the production, or what the coldest body gains, and its scale."""
        states, exchanges = self.states, self.exchanges
        ((factor, _),) = view.get("temperature", next(iter(states)))[:1]
        if self.id == "exergy":
            ((factor, _),) = view.get("input", exchanges[0][1].input)
        factor = 1 if self.id == "environment" else factor
        rates = [pair for state in states.values() for pair in view.get("rate", state)]
        produced = view.total("production")[1]
        total = factor * _sum(rate for rate, _ in rates)
        scale = abs(factor) * (_sum(size for _, size in rates) + produced)
        for element, port in exchanges:
            ((outside, _),), ((hot, _),) = (
                view.get("input", port.input),
                view.get("temperature", port.body),
            )
            ((lam, size),) = view.get("conductance", element)
            share = 1 / outside if self.id == "environment" else 1
            total = total - share * (lam * (outside - hot))
            reach = size * (hot + abs(outside))
            scale = scale + abs(share) * reach + abs(factor) * (reach / hot)
        return total, scale

    def says(self, view: View) -> Any:
        """Return where the row applies: `invariant` only where its body is the coldest."""
        if self.id != "invariant":
            return True
        ((hot, _),) = view.get("temperature", self.element)
        cold: Any = True
        for _, port in self.exchanges:
            cold = cold & (hot < view.get("input", port.input)[0][0])
        for other in self.neighbours:
            cold = cold & (hot <= view.get("temperature", other)[0][0])
        return cold

    @cached_property
    def rest(self) -> tuple[tuple[str, ...], tuple[str, ...]] | None:
        """For a balance the inputs that it sets to zero, and those that it sets equal."""
        heat = tuple(port.input for _, port in self.circuit.of(HeatInput))
        if self.id != "exergy":
            return (heat, ()) if heat and self.id == "environment" else None
        outside = tuple(port.input for _, port in self.circuit.of(Exchange))
        sources = (port.input for _, port in self.circuit.of(Source))
        return tuple(name for name in (*sources, *heat) if name not in outside), outside


def claim_of(iphs: IPHS, id_: str, element: str) -> Claim | None:
    """Return the claim of a row, or None if it cannot be evaluated at a point."""
    ports = [placed.port for placed in iphs.circuit.ports if placed.element == element]
    claim = Claim(id_, element, ports[-1] if ports else None, iphs.circuit)
    match id_, claim.port:
        case (("passive" | "conductance"), (DissipativePort() | Conductor() | Exchange())):
            return claim
        case (("temperature" | "invariant"), Body()):
            return claim
        case (("sigma" | "exergy" | "environment" | "welldef" | "continuous"), _):
            return claim
    return None


def summed(pairs: Iterable[Pair]) -> Pair:
    """Return a sum of quantities."""
    found = list(pairs)
    return _sum(value for value, _ in found), _sum(size for _, size in found)


def _sum(parts: Iterator[Any]) -> Any:
    return sum(parts, start=0)
