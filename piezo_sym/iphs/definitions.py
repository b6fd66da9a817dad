"""What the names of a system stand for: co-states, law outputs, ratios, energies.

Input: a `Circuit`, its symbols and its junction.  Output: the `System` in named co-states, and for
each name the expression behind it, stated once.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from fractions import Fraction
from typing import final

import sympy as sp

from piezo_sym.algebra.integrals import integral
from piezo_sym.algebra.lanes import vector
from piezo_sym.algebra.symbols import SymbolTable
from piezo_sym.errors import NetworkError, SpecError, quote, with_article
from piezo_sym.expressions.calculus import neg
from piezo_sym.expressions.energies import antiderivative
from piezo_sym.expressions.exact_eval import Value, all_hold, value_of
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tidying import collected
from piezo_sym.expressions.tree import ZERO, Call, Cmp, Expr, If, Sym, names, rebuild, walk
from piezo_sym.iphs.system import System
from piezo_sym.network import Driven, Junction, port_order
from piezo_sym.network.nodes import beside_chain
from piezo_sym.spec.circuit import Circuit
from piezo_sym.spec.elements import kind_of
from piezo_sym.spec.elements.domains import PowerVariable
from piezo_sym.spec.elements.ports import (
    Body,
    Conductor,
    Coupling,
    DissipativePort,
    HeatInput,
    Source,
    Storage,
)
from piezo_sym.spec.model import Model
from piezo_sym.spec.tables import greater, starts

Point = Mapping[str, Value]
#: Factors that give trial values of a state, from its initial value and the energy's parameters.
TIMES = (Fraction(1), Fraction(-1), Fraction(1, 2), Fraction(-1, 2), Fraction(2), Fraction(-2))
NEAR = Fraction(1, 10**12)


def costate_name(port: Storage | Body) -> str:
    """Return the name of a store's co-state: a body's is its temperature."""
    return port.temperature if isinstance(port, Body) else port.costate


def heated(port: DissipativePort | Conductor) -> str:
    """Return the name of the body that a process heats; of conduction, the second one."""
    return port.heats if isinstance(port, DissipativePort) else port.second


def system_of(circuit: Circuit, symbols: SymbolTable, junction: Junction) -> System:
    """Return Definition 1 of a solved junction, E, W and u being symbols."""
    lanes = junction.J0.lanes
    stores = tuple(circuit.of(Storage, Body))
    rows = {placed.element: n for n, (placed, port) in enumerate(stores) if isinstance(port, Body)}
    processes = [port for _, port in circuit.of(DissipativePort, Conductor)]
    costates = {n: symbols[costate_name(port)] for n, (_, port) in enumerate(stores)}
    driven = enumerate(port_order(circuit))
    inputs = {n: _input(port, circuit, symbols) for n, (_, port) in driven}
    outputs = {n: symbols[port.output] for n, port in enumerate(processes)}
    return System(
        states=junction.states,
        processes=junction.processes,
        ports=junction.ports,
        E=vector(junction.states, lanes, costates),
        dS=vector(junction.states, lanes, dict.fromkeys(rows.values(), sp.S.One)),
        u=vector(junction.ports, lanes, inputs),
        W=vector(junction.processes, lanes, outputs),
        heats=tuple(rows[heated(port)] for port in processes),
        J0=junction.J0,
        B=junction.B,
        D=junction.D,
        G=junction.g,
        N=junction.N,
    )


def _input(port: Driven, circuit: Circuit, symbols: SymbolTable) -> sp.Expr:
    """Return a port's entry of the input vector u: its input, P/T or lam*(T_e/T - 1)."""
    if isinstance(port, Source):
        return symbols[port.input]
    temperature = symbols[circuit.bodies[port.body].temperature]
    ratio = symbols[port.input] / temperature
    if isinstance(port, HeatInput):
        return ratio
    return symbols.law(port.conductance, {}) * (ratio - 1)


@final
@dataclass(frozen=True)
class Energy:
    """The energy [J] of one store, or of stores that share one."""

    law: Expr  # a function of states and parameters
    rows: tuple[int, ...]  # the indices of the states that it depends on
    bank: str | None  # the bank, if each of its lanes has such an energy
    derived: bool  # whether it was integrated from a co-state law; else the spec gives it


def energies_of(circuit: Circuit) -> tuple[Energy, ...]:
    """Return the energies, ordered by the first state of each.

    Raises `SpecError` if a co-state law has no integral in closed form.
    """
    above = (greater(condition.tree) for condition in circuit.conditions)
    positive = frozenset(
        c.left.name for c in above if c.op == ">" and c.right == ZERO and isinstance(c.left, Sym)
    )
    rows: dict[tuple[Expr, str | None, bool], tuple[int, ...]] = {}
    for n, (placed, port) in enumerate(circuit.of(Storage, Body)):
        law = port.energy or _with_values(
            _integral(placed.element, port, positive), port.state, circuit
        )
        key = law, placed.bank, port.energy is None
        rows[key] = (*rows.get(key, ()), n)
    return tuple(Energy(law, own, bank, derived) for (law, bank, derived), own in rows.items())


def _integral(element: str, port: Storage | Body, positive: frozenset[str]) -> Expr:
    """Return the integral of a co-state law over its state; `positive` names are > 0."""
    energy = None
    with suppress(RecursionError):  # a sum may be split at edges that lead to each other
        energy = antiderivative(port.law, port.state, integral, positive)
    if energy is None:
        what = f"no integral of the law {quote(spell(port.law))} by {port.state} is found"
        expected = "one of the functions of laws, found by SymPy in 5 s"
        remedy = f"give the energy itself instead: energy = '...', a law of {port.state}"
        raise SpecError(what, f"elements.{element}", expected, remedy)
    return energy


def _with_values(energy: Expr, state: str, circuit: Circuit) -> Expr:
    """Return an energy with log(-a) in place of log(a) where a < 0 in the domain.

    1/(q - a) integrates to log(q - a) as well as to log(a - q), which have the same slope, but only
    one of them has a value.  The sign is taken from trial points that satisfy the conditions on
    parameters, inputs and this state, on each branch from the points on it; if signs differ, the
    first point decides.  No proof rests on the choice: rows welldef and energy check the result.
    """
    if not any(isinstance(n, Call) and n.function == "log" for n in walk(energy)):
        return energy
    used = {state, *circuit.model.parameters, *circuit.model.inputs}
    domain = [c.tree for c in circuit.conditions if used.issuperset(names(c.tree))]
    points = [*_points(energy, state, circuit.model)]
    return _turned(energy, [point for point in points if all_hold(domain, point)])


def _points(energy: Expr, state: str, model: Model) -> Iterator[Point]:
    """Yield the spec's own values, of the first lane and the last, with some values of a state."""
    own: dict[str, Value] = {name: Fraction(entry.si) for name, entry in model.inputs.items()}
    for lane in (0, -1):
        own |= {name: Fraction(p.lanes[lane]) for name, p in model.parameters.items()}
        with suppress(ArithmeticError, ValueError):
            start = value_of(starts(model, state)[lane], own)
            sizes = [own[name] for name in names(energy) if name in model.parameters]
            yield from ({**own, state: start + size * NEAR} for size in (0, *sizes))
            yield from ({**own, state: start - size * NEAR} for size in sizes)
            yield from ({**own, state: size * times} for size in (start, *sizes) for times in TIMES)


def _turned(node: Expr, points: Sequence[Point]) -> Expr:
    match node:
        case If(then, condition, other):
            on = [point for point in points if all_hold((condition,), point)]
            off = [point for point in points if all_hold((condition,), point) is False]
            return If(_turned(then, on), condition, _turned(other, off))
        case Call("log", (arg,)):
            inner = _turned(arg, points)
            below = [all_hold((Cmp("<", inner, ZERO),), point) for point in points]
            above = [all_hold((Cmp(">", inner, ZERO),), point) for point in points]
            turned = any(below) and (below[0] or not any(above))
            return Call("log", (collected(neg(inner)) if turned else inner,))
    return rebuild(node, lambda part: _turned(part, points))


Definitions = Iterator[tuple[sp.Symbol, sp.Expr]]


def laws_of(circuit: Circuit, symbols: SymbolTable, system: System) -> Definitions:
    """Yield each law output W with its law in z, temperatures and states."""
    for (_, port), z in zip(circuit.of(DissipativePort, Conductor), system.z, strict=True):
        if isinstance(port, DissipativePort):
            letters = {port.letter: z, port.rate_letter: symbols.symbols.get(port.rate, z)}
            yield symbols[port.output], symbols.law(port.law, letters)
        else:
            first = symbols[circuit.bodies[port.first].temperature]
            yield symbols[port.output], symbols.law(port.conductance, {}) * z / first


def rates_of(circuit: Circuit, symbols: SymbolTable, system: System) -> Definitions:
    """Yield the rate that drives each slip: that of its store's state without the slip itself.

    The driving force of a slip is its store's co-state, so the slip stands in no other row: rates
    depend on co-states, inputs and outputs of other processes, but on no slip.
    """
    slips = {port.state: port for _, port in circuit.of(DissipativePort) if port.rate}
    if slips:
        rates = system.J0 @ system.E + system.G @ system.u - system.B @ system.W
        for row, slot in enumerate(system.states):
            if port := slips.get(slot.label):
                yield symbols[port.rate], rates[row, 0] + symbols[port.output]


def check_stops(
    circuit: Circuit,
    symbols: SymbolTable,
    rates: Iterable[tuple[sp.Symbol, sp.Expr]],
    laws: Iterable[tuple[sp.Symbol, sp.Expr]],
) -> None:
    """Refuse a stop whose rate depends on the effort of a stop: that would be an implicit equation.

    Laws depend on co-states, inputs and states alone, so inserting them once is enough.  Raises
    `NetworkError`, which says what to put beside it.
    """
    stores = {port.state: port for _, port in circuit.of(Storage)}
    stops = [(e, p) for e, p in circuit.of(DissipativePort) if p.limit is not None]
    efforts = {symbols[stores[port.state].costate]: placed.element for placed, port in stops}
    known, named = dict(laws), dict(rates)
    for placed, port in stops:
        rate = named[symbols[port.rate]].xreplace(known)
        for other in sorted(efforts.keys() & rate.free_symbols, key=str):
            given = port.domain.variable(port.imposes)
            name = kind_of("store", port.domain, port.imposes)
            where = "in series" if port.imposes is PowerVariable.THROUGH else "at its node"
            raise NetworkError(
                f"the {given.name} of stop {quote(placed.element)} depends on the "
                f"{port.domain.variable(port.imposes.other).name} of {quote(efforts[other])}",
                f"elements.{placed.element}",
                f"a {given.name} that is a state's, or an input",
                beside_chain(circuit, [placed.element]) or f"put {with_article(name)} {where}",
            )


def ratios_of(circuit: Circuit, symbols: SymbolTable) -> Definitions:
    """Yield each coupling's ratio with its law in temperatures and states."""
    for _, port in circuit.of(Coupling):
        yield symbols[port.name], symbols.law(port.ratio, {})


def starts_of(junction: Junction) -> Iterator[tuple[Expr, ...]]:
    """Yield the initial value of each state, one per lane of a bank; Z^T x for joined stores."""
    model = junction.circuit.model
    joints = {m.store.state: joint for joint in junction.joints for m in joint.kept}
    for state in (slot.label for slot in junction.states):
        joint = joints.get(state)
        yield (joint.start(model, state),) if joint else starts(model, state)
