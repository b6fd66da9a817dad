"""The second law as a whole, refuted where one law that takes no power in is driven alone.

Input: a system, and the rows so far.  Output: exact numbers at which ``sigma`` is negative, and its
value, or None.  A law may be active and the total not: another in parallel may outweigh it.  So the
whole of ``sigma`` is evaluated, with one lane per bank and every co-state but one zero.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction

import sympy as sp

from piezo_sym.algebra.sums import LaneSymbol
from piezo_sym.errors import PiezoError
from piezo_sym.expressions.exact_eval import all_hold
from piezo_sym.expressions.tree import Cmp, Num, Sym
from piezo_sym.iphs import IPHS
from piezo_sym.proofs.assumptions import assumptions_of
from piezo_sym.proofs.obligations import NEVER, Question
from piezo_sym.proofs.report import Row, Verdict
from piezo_sym.proofs.solvers import Asks
from piezo_sym.spec.elements.ports import (
    Body,
    Conductor,
    DissipativePort,
    Exchange,
    Source,
    Storage,
)
from piezo_sym.spec.tables import bank_of, banks, states

Values = Mapping[str, Fraction]
Found = tuple[dict[str, str], sp.Rational]


def negative_total(iphs: IPHS, rows: Iterable[Row], solver: Asks) -> Found | None:
    """Return numbers at which sigma < 0, found from the laws that are refuted."""
    sizes = dict.fromkeys(banks(iphs.model), 1)
    try:
        single = iphs.expand(sizes) if sizes else iphs
    except PiezoError:  # a lane's name is taken; a law that is refuted says enough
        return None
    for row in rows:
        if row.id == "passive" and row.verdict is Verdict.REFUTED and row.witness:
            lane = "_1" if row.element in bank_of(iphs.model) else ""
            given = {_in_lane(n, iphs): Fraction(v) for n, v in row.witness.items()}
            found = _driven(single, f"{row.element}{lane}", given, solver)
            if found:
                counts = {f"{bank}_count": "1" for bank in sizes}
                return {**counts, **found[0]}, found[1]
    return None


def _in_lane(name: str, iphs: IPHS) -> str:
    """Return what a name of a bank's law is called in its first lane."""
    return f"{name}_1" if isinstance(iphs.symbols.symbols.get(name), LaneSymbol) else name


def _driven(iphs: IPHS, element: str, given: Values, solver: Asks) -> Found | None:
    """Return numbers at which sigma < 0 while all that drives the system drives one element.

    One co-state or input gives the driving force its value, of a slip another one the rate.
    """
    processes = [
        (placed.element, port) for placed, port in iphs.circuit.of(DissipativePort, Conductor)
    ]
    k = [name for name, _ in processes].index(element)
    port = processes[k][1]
    known = _point(iphs, port, given, solver)
    if known is None:
        return None
    sigma = _named(iphs, iphs.system.sigma)
    rest = dict.fromkeys(_drives(iphs), sp.S.Zero)
    named = {iphs.symbols[n]: sp.Rational(v.numerator, v.denominator) for n, v in known.items()}
    fixed = {symbol: value for symbol, value in named.items() if symbol not in rest}
    aims = [(iphs.system.z[k, 0], given.get(getattr(port, "letter", "")))]
    if isinstance(port, DissipativePort) and port.rate:
        aims.append((iphs.symbols[port.rate], given.get(port.rate_letter)))
    wanted = [(_value(_named(iphs, z), fixed), v) for z, v in aims if v is not None]
    for drive in _drive(wanted, rest, rest):
        values = {**fixed, **rest, **drive}
        value = _value(sigma, values)
        if value.is_Rational and value < 0 and _allowed(iphs, sigma, values):
            return {s.name: str(v) for s, v in values.items() if s in sigma.free_symbols}, value
    return None


def _value(expr: sp.Expr, values: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr:
    """Return an expression at a point; nan where it has no real value to compare."""
    try:
        return expr.xreplace(dict(values))
    except TypeError:
        return sp.nan


def _named(iphs: IPHS, expr: sp.Expr) -> sp.Expr:
    """Return an expression in co-states and inputs: all that is defined by them is written out."""
    for definitions in iphs.named:
        expr = expr.xreplace(dict(definitions))
    return expr


def _point(
    iphs: IPHS, port: DissipativePort | Conductor, given: Values, solver: Asks
) -> Values | None:
    """Return simple numbers of the domain, with those given, for parameters and temperatures."""
    assumptions = assumptions_of(iphs)
    letters = {getattr(port, "letter", ""), getattr(port, "rate_letter", "")}
    where = [*assumptions.where]
    where += [Cmp("=", Sym(n), Num(v)) for n, v in given.items() if n not in letters]
    if isinstance(port, Conductor):
        hot, cold = (iphs.circuit.body(b).temperature for b in (port.first, port.second))
        where.append(Cmp("!=", Sym(hot), Sym(cold)))
    wanted = tuple(n for n in assumptions.order if n in given or n not in states(iphs.model))
    about = tuple(Cmp("=", Sym(n), Sym(n)) for n in wanted)
    made = Question("", assumptions.order, tuple(where), NEVER, NEVER, about, witness=True)
    answer = solver.ask(made.query)
    return {n: answer.model[n] for n in wanted} if answer.result == "sat" else None


def _drives(iphs: IPHS) -> Iterator[sp.Symbol]:
    """Yield what drives the processes: co-states that are no temperature, inputs of sources."""
    yield from (iphs.symbols[port.costate] for _, port in iphs.circuit.of(Storage))
    exchanged = {port.input for _, port in iphs.circuit.of(Exchange)}
    for _, port in iphs.circuit.of(Source):
        if port.input not in exchanged:
            yield iphs.symbols[port.input]


def _drive(
    wanted: Sequence[tuple[sp.Expr, Fraction]],
    rest: Mapping[sp.Symbol, sp.Expr],
    free: Iterable[sp.Symbol],
) -> Iterator[dict[sp.Symbol, sp.Expr]]:
    """Yield co-states or inputs, one for each of what is wanted, that alone give it its value."""
    if not wanted:
        yield {}
        return
    z, value = wanted[0]
    for symbol in (symbol for symbol in free if symbol in z.free_symbols):
        share = _value(z, {**rest, symbol: sp.S.One}) - _value(z, rest)
        if share.is_Rational and share != 0:
            own = {symbol: sp.Rational(value.numerator, value.denominator) / share}
            for others in _drive(wanted[1:], rest, [s for s in free if s != symbol]):
                yield own | others


def _allowed(iphs: IPHS, sigma: sp.Expr, values: Mapping[sp.Symbol, sp.Expr]) -> bool:
    """Return whether numbers lie in the domain, and every co-state in sigma can have its value.

    That of a state which a law in sigma reads is the co-state at this state.
    """
    moving = {iphs.symbols[name] for name in states(iphs.model)}
    exact = {s.name: Fraction(int(v.p), int(v.q)) for s, v in values.items()}
    return bool(all_hold(assumptions_of(iphs).where, exact)) and all(
        _takes_every_value(iphs, symbol, law)
        if sigma.free_symbols.isdisjoint(law.free_symbols & moving)
        else _value(law, values) == values[symbol]
        for symbol, law in iphs.costates
        if symbol in sigma.free_symbols
    )


def _takes_every_value(iphs: IPHS, costate: sp.Symbol, law: sp.Expr) -> bool:
    """Return whether a co-state is linear in its state, or a temperature exponential in it."""
    stores = iphs.circuit.of(Storage, Body)
    owner = {p.temperature if isinstance(p, Body) else p.costate: p for _, p in stores}
    state = iphs.symbols[owner[costate.name].state]
    slope = sp.diff(law, state)
    linear = slope != 0 and state not in slope.free_symbols
    return linear or (costate.is_positive and state not in (slope / law).free_symbols)
