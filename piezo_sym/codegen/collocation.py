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

from dataclasses import dataclass, replace
from typing import final

from piezo_sym.codegen.differences import sharp_quantity
from piezo_sym.codegen.functions import exchanges_of, heats_of, productions_of, rates_of, supply_of
from piezo_sym.codegen.jacobian import jacobian_of
from piezo_sym.codegen.paths import Path, given_to, in_motion, paths_of
from piezo_sym.codegen.program import Entry, Limit, Names, OutputRow, Quantity, needed
from piezo_sym.codegen.quantities import COSTATES, Quantities, quantities_of
from piezo_sym.codegen.switches import Switch, switched
from piezo_sym.expressions.calculus import compared, is_affine
from piezo_sym.iphs import IPHS
from piezo_sym.spec.elements.ports import Body, Storage


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
    rates: tuple[OutputRow, ...]
    booked: tuple[OutputRow, ...]
    switches: tuple[Switch, ...]
    limits: tuple[Limit, ...]
    taken: frozenset[str]
    bends: tuple[OutputRow, ...] = ()


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
    q = quantities_of(iphs)
    new = Names(q.taken)
    paths = paths_of(q, new)
    q = replace(q, taken=frozenset(new.taken))
    states = {state.name for state in q.states}
    means = tuple(
        item for item in q.defined if item.note == COSTATES and not is_affine(item.value, states)
    )
    elements = iphs.model.elements.values()
    return Collocation(
        means=tuple(sharp_quantity(replace(m, value=compared(m.value))) for m in means),
        stage=_stage(given_to(q, paths), means),
        slopes=_slopes(in_motion(q, paths), means),
        heated=_heated(q),
        jumps=any(getattr(element, "discontinuous", False) for element in elements),
        paths=paths,
    )


def _heated(q: Quantities) -> int:
    ports = [port for _, port in q.stores]
    lossy = any(isinstance(port, Storage) for port in ports)
    bodies = (n for n, port in enumerate(ports) if isinstance(port, Body))
    return next(bodies, -1) if lossy else -1


def _stage(q: Quantities, means: tuple[Quantity, ...]) -> Stage:
    rates, new = rates_of(q), Names(q.taken)
    booked = (*supply_of(q), *heats_of(q), *productions_of(q), *exchanges_of(q))
    defined = tuple(item for item in q.defined if item not in means)
    found = switched(defined, (*rates, *booked), q.lanes, new, means=means)
    states = {state.name for state in q.states}  # the other conditions hold for a whole run
    limits = (m for m in q.limits if states & {*needed(q.defined, [m.margin])[1]})
    return Stage(
        quantities=tuple(map(sharp_quantity, found.quantities)),
        rates=found.rows[: len(rates)],
        booked=found.rows[len(rates) :],
        switches=found.switches,
        limits=tuple(replace(limit, margin=compared(limit.margin)) for limit in limits),
        taken=frozenset(new.taken),
        bends=found.bends,
    )


def _slopes(q: Quantities, means: tuple[Quantity, ...]) -> Slopes:
    new, given = Names(q.taken), {mean.name for mean in means}
    found = switched(q.defined, rates_of(q), q.lanes, new, compared_names=given)
    entries, derivatives = jacobian_of(
        *(found.rows, q.states, found.quantities, found.lanes, new, q.temperatures)
    )
    quantities = tuple(map(sharp_quantity, (*found.quantities, *derivatives)))
    return Slopes(quantities, entries, found.switches, frozenset(new.taken))
