"""One stage of a collocation step, and the slopes that Newton's method needs, before any language.

Input: an `IPHS`.  Output: a `Collocation`.  At a stage the state is X(c_i), and co-states are
weighted means over the step (STEPPING: energy-preserving Gauss collocation):

    Ebar_i = int_0^1 (l_i(tau)/b_i) dU/dx(X(tau)) dtau
    K_i    = J0 Ebar_i - sum_k b_k W_k(zbar_ki) + g u_i,   a body's row: heats/Tbar_i + exchanges

The mean of a co-state that is affine in the state is its value at X(c_i).  The means of the others,
and of differences such as T - T_0 that would cancel, are given to the stage; `means` are their
integrands.  Branches of laws are given, too, so that Newton's method meets smooth functions; the
signs of the switching functions tell which branches are right.
"""

from dataclasses import dataclass, replace
from typing import final

from piezo_sym.codegen.differences import sharp_quantity
from piezo_sym.codegen.functions import exchanges_of, heats_of, productions_of, rates_of, supply_of
from piezo_sym.codegen.jacobian import jacobian_of
from piezo_sym.codegen.paths import Path, paths_of, slope_quantities, stage_quantities
from piezo_sym.codegen.program import Entry, Limit, Names, OutputRow, Quantity
from piezo_sym.codegen.quantities import COSTATES, Quantities, quantities_of
from piezo_sym.codegen.switches import Switch, switched_values
from piezo_sym.expressions.calculus import compared, is_affine
from piezo_sym.expressions.tree import names
from piezo_sym.iphs import IPHS
from piezo_sym.spec.elements.ports import Body, Storage


@final
@dataclass(frozen=True)
class Stage:
    """What a stage computes."""

    quantities: tuple[Quantity, ...]  # in an order in which they can be computed
    rates: tuple[OutputRow, ...]  # of each state
    #: The rows of the ledger: power of each port, heat and entropy production of processes, entropy
    #: rate of heat exchanges.
    booked: tuple[OutputRow, ...]
    switches: tuple[Switch, ...]  # of the laws, in order
    limits: tuple[Limit, ...]  # the conditions of the domain that depend on the state
    taken: frozenset[str]  # every name in use
    #: Functions whose sign changes where an integrand of `means` has a kink.
    bends: tuple[OutputRow, ...] = ()
    costates: tuple[OutputRow, ...] = ()  # dU/dx of each state; some are given means


@final
@dataclass(frozen=True)
class Slopes:
    """The Jacobian of the rates at a point, on given branches."""

    quantities: tuple[Quantity, ...]
    entries: tuple[Entry, ...]
    taken: frozenset[str]


@final
@dataclass(frozen=True)
class Collocation:
    """A collocation step of a system."""

    means: tuple[Quantity, ...]  # the functions of the state whose weighted means a stage is given
    stage: Stage
    slopes: Slopes
    #: The row of the entropy that takes the loss of a dissipative step, that of the first body; -1
    #: if there is no body, or no store that could lose energy.
    heated: int
    jumps: bool  # whether a law is declared discontinuous
    #: The path functionals, whose values a stage is given after the means.
    paths: tuple[Path, ...] = ()
    bodies: tuple[int, ...] = ()  # which states are entropies, a bank's counted once

    @property
    def takes_residuals(self) -> bool:
        """Whether the body `heated` takes what Newton's method leaves of the equations as heat."""
        return self.heated >= 0 and bool(self.stage.costates)


def collocation_of(iphs: IPHS, known: Quantities | None = None) -> Collocation:
    """Return the collocation step of a system, whose quantities may have been found."""
    q = known or quantities_of(iphs)
    new = Names(q.taken)
    paths = paths_of(q, new)
    q = replace(q, taken=frozenset(new.taken))
    states = {state.name for state in q.states}
    means = tuple(
        item for item in q.defined if item.note == COSTATES and not is_affine(item.value, states)
    )
    elements, own = iphs.model.elements.values(), stage_quantities(q, paths)
    rates = rates_of(own)  # also for slopes, if no path makes them differ
    smooth = slope_quantities(q, paths)
    bodies = tuple(n for n, (_, port) in enumerate(q.stores) if isinstance(port, Body))
    lossy = any(isinstance(port, Storage) for _, port in q.stores)
    return Collocation(
        means=tuple(sharp_quantity(replace(m, value=compared(m.value))) for m in means),
        stage=_stage(own, rates, means),
        slopes=_slopes(smooth, rates if smooth is own else rates_of(smooth), means),
        heated=bodies[0] if bodies and lossy else -1,
        bodies=bodies,
        jumps=any(getattr(element, "discontinuous", False) for element in elements),
        paths=paths,
    )


def _stage(q: Quantities, rates: tuple[OutputRow, ...], means: tuple[Quantity, ...]) -> Stage:
    new = Names(q.taken)
    booked = (*supply_of(q), *heats_of(q), *productions_of(q), *exchanges_of(q))
    defined = tuple(item for item in q.defined if item not in means)
    costates = map(OutputRow, q.iphs.system.states, q.costates)
    values = switched_values(defined, (*rates, *booked, *costates), q.lanes, new, means=means)
    moving = {state.name for state in q.states}
    for item in q.defined:
        moving.update([item.name] if not moving.isdisjoint(names(item.value)) else [])
    # other conditions are checked once per run
    limits = (m for m in q.limits if not moving.isdisjoint(names(m.margin)))
    return Stage(
        quantities=tuple(map(sharp_quantity, values.quantities)),
        rates=values.rows[: len(rates)],
        booked=values.rows[len(rates) : len(rates) + len(booked)],
        switches=values.switches,
        limits=tuple(replace(limit, margin=compared(limit.margin)) for limit in limits),
        costates=values.rows[len(rates) + len(booked) :],
        taken=frozenset(new.taken),
        bends=values.bends,
    )


def _slopes(q: Quantities, rates: tuple[OutputRow, ...], means: tuple[Quantity, ...]) -> Slopes:
    new, given = Names(q.taken), {mean.name for mean in means}
    values = switched_values(q.defined, rates, q.lanes, new, compared_names=given)
    entries, derivatives = jacobian_of(
        *(values.rows, q.states, values.quantities, values.lanes, new, q.temperatures)
    )
    quantities = tuple(map(sharp_quantity, (*values.quantities, *derivatives)))
    return Slopes(quantities, entries, frozenset(new.taken))
