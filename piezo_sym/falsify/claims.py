"""What each row says, as a number that is negative where the row is false.

Input: an `IPHS`, a row's id and element.  Output: a `Claim`; its `look` gives at points the number,
its scale (the size of what cancels in it) and where the row says anything at all.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import final

import numpy as np

from piezo_sym.falsify.space import Array, Mask, Seen, Space
from piezo_sym.iphs import IPHS
from piezo_sym.spec.elements.ports import Body, Conductor, Exchange, Resistor, Source

#: Of the sum of absolute terms; a balance that is off by less is rounding.
TOLERANCE = 1e-9

Look = tuple[Array, Array]


@final
@dataclass(frozen=True, eq=False)
class Claim:
    """A row to attack.

    Attributes
    ----------
    id, element : of the row.
    look : the number, one row per lane or statement, and its scale; nan where it has no value.
    prepared : points on which the row says something, made of any points.
    climbs : whether number over scale is smooth, so that going downhill leads anywhere.
    part : whether it says something only where the number is finite.
    """

    id: str
    element: str
    look: Callable[[Seen], Look]
    prepared: Callable[[Space, Array], Array] | None = None
    climbs: bool = False
    part: bool = False


def claim_of(iphs: IPHS, id_: str, element: str) -> Claim | None:
    """Return the claim of a row, or None if numbers say nothing of it."""
    ports = [placed.port for placed in iphs.circuit.ports if placed.element == element]
    match id_, next(iter(ports[-1:]), None):  # of two, the dissipative one stands last
        case "passive", Resistor():
            return Claim(id_, element, lambda seen: _heat(seen, element), climbs=True)
        case "passive" | "conductance", Conductor() | Exchange():
            return Claim(id_, element, lambda seen: _law(seen, element), climbs=True)
        case "temperature", Body():
            return Claim(id_, element, lambda seen: _warm(seen, element), climbs=True)
        case "sigma", _:
            return Claim(id_, element, _sigma)
        case "environment", _:
            return Claim(id_, element, lambda seen: _environment(seen, iphs))
        case "exergy", _:
            return Claim(id_, element, lambda seen: _exergy(seen, iphs), _at_rest(iphs))
        case "invariant", Body():
            return Claim(id_, element, lambda seen: _invariant(seen, iphs, element), part=True)
        case "welldef", _:
            return Claim(id_, element, lambda seen: _defined(seen, element))
        case "continuous", _:
            return Claim(id_, element, lambda seen: (np.ones((1, seen.x.shape[1])),) * 2)
    return None


def laws_of(space: Space, element: str) -> list[slice]:
    """Return the rows of an element's laws."""
    found = (space.law_rows.get((element, what)) for what in ("law", "output"))
    return [row for row in found if row]


def _heat(seen: Seen, element: str) -> Look:
    row = seen.space.rows("PROCESSES", element)
    law, effort = (seen.space.law_rows[element, what] for what in ("output", "effort"))
    return seen.heat[row], seen.sizes[law] * np.abs(seen.laws[effort])


def _law(seen: Seen, element: str) -> Look:
    """Return the sign of the heat that a conduction or an ambient passes on."""
    law = seen.space.law_rows[element, "law"]
    if element not in seen.space.places["PROCESSES"]:
        return seen.laws[law], seen.sizes[law]
    produced = seen.entropy_production[seen.space.rows("PROCESSES", element)]
    value, scale = (seen.laws[law], produced), (seen.sizes[law], np.abs(produced))
    return np.concatenate(value), np.concatenate(scale)


def _warm(seen: Seen, element: str) -> Look:
    """Return temperature and slope; a zero is false of both."""
    law, slope = (seen.space.law_rows[element, what] for what in ("law", "slope"))
    value = np.concatenate([seen.temperatures[_body(seen.space, element)], seen.laws[slope]])
    scale = np.concatenate([seen.sizes[law], seen.sizes[slope]])
    return np.where(value == 0, -1e-300, value), scale


def _body(space: Space, element: str) -> slice:
    return space.rows("BODIES", element)


def _sigma(seen: Seen) -> Look:
    produced = seen.entropy_production
    return produced.sum(axis=0, keepdims=True), np.abs(produced).sum(axis=0, keepdims=True)


def _exchanges(seen: Seen, iphs: IPHS) -> Iterator[tuple[str, Array, Array, Array, Array]]:
    """Yield body, power put in, its size, temperature of body and of environment, per exchange."""
    for placed, port in iphs.circuit.of(Exchange):
        power = seen.supply[seen.space.rows("OUTPUTS", placed.element)]
        outside = seen.u[seen.space.rows("INPUTS", port.input)]
        hot = seen.temperatures[_body(seen.space, port.body)]
        law = seen.space.law_rows[placed.element, "law"]
        yield port.body, power, seen.sizes[law] * (hot + np.abs(outside)), hot, outside


def _rates(seen: Seen, iphs: IPHS) -> Array:
    """Return the rate of each body's entropy."""
    rows = [seen.space.rows("STATES", port.state) for _, port in iphs.circuit.of(Body)]
    return np.concatenate([seen.rhs[row] for row in rows])


def _beyond(value: Array, scale: Array) -> Array:
    """Return a balance as a number that is negative only if it is off by more than rounding."""
    return value + TOLERANCE * scale


def _environment(seen: Seen, iphs: IPHS) -> Look:
    """Return production with the environment's, as a sum of squares and from the rates."""
    sigma, terms = _sigma(seen)
    crossed, rates = np.zeros_like(sigma), _rates(seen, iphs)
    total, terms = rates.sum(axis=0, keepdims=True), terms + np.abs(rates).sum(axis=0)
    for _, power, size, hot, outside in _exchanges(seen, iphs):
        crossed = crossed + power / outside * ((outside - hot) / hot)
        total = total - power / outside
        terms = terms + size / np.minimum(np.abs(outside), hot)
    return np.concatenate([sigma + crossed, _beyond(total, terms)]), np.concatenate([terms, terms])


def _exergy(seen: Seen, iphs: IPHS) -> Look:
    """Return exergy lost, as a sum of squares and from the rates."""
    sigma, scale = _sigma(seen)
    lost, outside, rates = np.zeros_like(sigma), np.ones_like(sigma), _rates(seen, iphs)
    terms = np.abs(seen.supply).sum(axis=0, keepdims=True)
    for _, power, size, hot, outside in _exchanges(seen, iphs):
        lost = lost + power * ((outside - hot) / hot)
        terms = terms + size * np.maximum(1, np.abs(outside) / hot)
    total = outside * rates.sum(axis=0, keepdims=True) - seen.supply.sum(axis=0, keepdims=True)
    terms = terms + np.abs(outside) * (scale + np.abs(rates).sum(axis=0))
    return np.concatenate([outside * sigma + lost, _beyond(total, terms)]), np.concatenate([terms, terms])


def _at_rest(iphs: IPHS) -> Callable[[Space, Array], Array]:
    """Return how points get one common environment, and inputs of sources that are zero."""

    def prepared(space: Space, points: Array) -> Array:
        rows = {f.name: space.inputs_at + n for n, f in enumerate(space.module.INPUTS)}
        outside = [rows[port.input] for _, port in iphs.circuit.of(Exchange)]
        sources = [rows[port.input] for _, port in iphs.circuit.of(Source)]
        changed = points.copy()
        changed[[row for row in sources if row not in outside]] = 0
        changed[outside] = points[outside[0]]
        return changed

    return prepared


def _invariant(seen: Seen, iphs: IPHS, element: str) -> Look:
    """Return what a body that is coldest gains beyond the heat of its environments."""
    hot = seen.temperatures[_body(seen.space, element)]
    (state,) = (p.state for b, p in iphs.circuit.of(Body) if b.element == element)
    rate = seen.rhs[seen.space.rows("STATES", state)] * hot
    least, cold = np.zeros_like(hot), np.ones_like(hot, dtype=bool)
    terms = np.abs(rate) + np.abs(seen.entropy_production).sum(axis=0) * hot
    for body, power, size, _, outside in _exchanges(seen, iphs):
        if body == element:
            least, terms, cold = least + power, terms + size, cold & (hot < outside)
    for _, port in iphs.circuit.of(Conductor):
        for own, other in ((port.first, port.second), (port.second, port.first)):
            if own == element:
                cold = cold & (hot <= seen.temperatures[_body(seen.space, other)])
    value = np.concatenate([_beyond(rate - least, terms), least])
    return np.where(cold, value, np.inf), np.concatenate([terms, terms])


def _defined(seen: Seen, element: str) -> Look:
    """Return -1 where a law has no value, and a divisor or an argument is such that it has none."""
    rows = laws_of(seen.space, element)
    values = np.concatenate([seen.laws[row] for row in rows]) if rows else seen.rhs
    lost = ~np.isfinite(values).all(axis=0)
    if lost.any():
        lost[lost] = seen.space.at(seen.points[:, lost]).suspect
    return np.where(lost, -1.0, 1.0)[None], np.ones((1, len(lost)))
