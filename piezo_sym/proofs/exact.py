"""The properties that algebra decides: skew, casimir, energy, entropy, temperature.

Input: an `IPHS`.  Output: a row each.  The system stands in named co-states, so that each property
is the vanishing of a normal form, a polynomial in independent symbols and in sums over lanes: zero
proves it for every state, input, parameter and every r; a value other than zero at exact numbers
refutes it. A `None` of SymPy's is open, never proved.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from math import prod
from typing import final

import sympy as sp

from piezo_sym.algebra.lanes import LaneMatrix
from piezo_sym.iphs import IPHS
from piezo_sym.proofs.report import Row, Verdict
from piezo_sym.spec.elements.ports import Body, Storage

#: Lanes a refutation is written out for; one lane hides what couples two.
LANES = 2
TRIES = (1, 2, 3)
#: Terms of a common denominator up to which a quotient is brought to lowest terms.
MAX_DENOMINATOR = 64


@final
@dataclass(frozen=True)
class Residual:
    """An expression that a property says is zero, and the name of its place."""

    place: str
    expr: sp.Expr


def skew(iphs: IPHS) -> Row:
    """J0 and every J_k are skew, for every pair of lanes of every bank."""
    system = iphs.system
    matrices = [("J0", system.J0)]
    matrices += [(f"J_{slot.label}", system.J(k)) for k, slot in enumerate(system.processes)]
    found = [
        residual
        for name, matrix in matrices
        for residual in _entries(f"({name} + {name}^T)", matrix + matrix.T)
    ]
    return _row(iphs, "skew", "J0 + J0^T = 0 and J_k + J_k^T = 0", found)


def casimir(iphs: IPHS) -> Row:
    """Entropy is a Casimir function of J0."""
    system = iphs.system
    return _row(iphs, "casimir", "J0 dS/dx = 0", _entries("J0 dS/dx", system.J0 @ system.dS))


def energy(iphs: IPHS) -> Row:
    """First law: dU/dx is the co-states, and dU/dt is the power put in."""
    system = iphs.system
    balance = (system.E.T @ system.rhs - system.y.T @ system.u)[0, 0]
    found = [*_gradient(iphs), Residual("dU/dt - y^T u", balance)]
    return _row(iphs, "energy", "dU/dt = y^T u", found)


def entropy(iphs: IPHS) -> Row:
    """Entropy balance: what the processes produce and what the inputs bring, eq. (5)."""
    system = iphs.system
    produced = system.R.T @ system.bracket + system.y_s.T @ system.u
    balance = (system.dS.T @ system.rhs - produced)[0, 0]
    statement = "dS/dt = sum_k gamma_k {S,U}_k^2 + y_s^T u"
    if not system.D.is_zero:  # a source drives a process: R_k is not gamma_k {S,U}_k there
        statement = "dS/dt = sum_k R_k {S,U}_k + y_s^T u"
    return _row(iphs, "entropy", statement, [Residual("dS/dt - sigma - y_s^T u", balance)])


def welldef(iphs: IPHS) -> Iterator[Row]:
    """Yield a row for each ratio that the junction laws divide by: it is not zero."""
    for divisor in iphs.junction.divisors:
        value = iphs.in_states(divisor)
        statement = f"{divisor} != 0: the junction laws divide by it"
        sign = _cancelled(value).is_zero
        if sign is False:
            yield Row("welldef", "", statement, Verdict.PROVED)
            continue
        verdict = Verdict.REFUTED if sign else Verdict.OPEN
        reason = f"{divisor} = {value} is {'zero' if sign else 'not shown to be other than zero'}"
        reason += "; add a mass or capacitor there, or the sign of its parameters to the domain"
        yield Row("welldef", "", statement, verdict, {} if sign else None, reason)


def _cancelled(value: sp.Expr) -> sp.Expr:
    """Return a quotient in lowest terms, or as it is where its common denominator explodes."""
    bottoms = {sp.fraction(term)[1] for term in sp.Add.make_args(value)}
    size = prod(len(sp.Add.make_args(factor)) for b in bottoms for factor in sp.Mul.make_args(b))
    return sp.cancel(value) if size <= MAX_DENOMINATOR else value


def temperature(iphs: IPHS) -> Iterator[Row]:
    """Yield a row a body: its temperature is positive and rises with its entropy."""
    for placed, port in iphs.circuit.of(Body):
        state = iphs.symbols[port.state]
        law = iphs.symbols.law(port.law, {port.letter: state})
        slope = sp.diff(law, state)
        signs = {"T > 0": law.is_positive, "dT/dS > 0": slope.is_positive}
        open_ones = [text for text, sign in signs.items() if sign is not True]
        wrong = [text for text, sign in signs.items() if sign is False]
        if wrong:
            reason = f"{' and '.join(wrong)} is false for every S"
            statement = "T > 0 and dT/dS > 0"
            yield Row("temperature", placed.element, statement, Verdict.REFUTED, {}, reason)
            continue
        verdict = Verdict.OPEN if open_ones else Verdict.PROVED
        reason = f"the sign of {' and '.join(open_ones)} is not decided" if open_ones else ""
        yield Row("temperature", placed.element, "T > 0 and dT/dS > 0", verdict, reason=reason)


def _gradient(iphs: IPHS) -> Iterator[Residual]:
    """Yield dU/dx minus the co-state, for each store."""
    stores = iphs.circuit.of(Storage, Body)
    for energy_law, (_, port), (_, costate) in zip(
        iphs.energies, stores, iphs.costates, strict=True
    ):
        state = iphs.symbols[port.state]
        difference = sp.diff(iphs.symbols.law(energy_law, {}), state) - costate
        yield Residual(f"dU/d{port.state}", sp.expand(difference))


def _entries(name: str, matrix: LaneMatrix) -> Iterator[Residual]:
    for (r, c), full, own in matrix.entries():
        place = f"{name}[{matrix.rows[r].label}, {matrix.cols[c].label or 1}]"
        yield from (Residual(place, expr) for expr in (full, own) if expr != 0)


def _row(iphs: IPHS, name: str, statement: str, residuals: Iterable[Residual]) -> Row:
    """Return the verdict on residuals that should all be zero."""
    for residual in residuals:
        value = sp.expand(residual.expr)
        if value == 0:
            continue
        witness = _witness(iphs, value)
        if witness is None:
            reason = f"{residual.place} = {value} was not shown to be zero"
            return Row(name, "", statement, Verdict.OPEN, reason=reason)
        numbers, at = witness
        reason = f"{residual.place} = {value}, which is {at}"
        return Row(name, "", statement, Verdict.REFUTED, numbers, reason)
    return Row(name, "", statement, Verdict.PROVED)


def _witness(iphs: IPHS, expr: sp.Expr) -> tuple[dict[str, str], sp.Expr] | None:
    """Return exact numbers at which `expr` is not zero, and its value there."""
    lanes = iphs.system.E.lanes
    counts = dict.fromkeys(lanes.counts, LANES)
    written = lanes.expand(expr, counts)
    symbols = sorted(written.free_symbols, key=lambda symbol: str(symbol.name))
    sizes = {symbol.name: str(counts[bank]) for bank, symbol in lanes.counts.items()}
    for start in TRIES:
        values = {s: sp.Integer(start + n % len(TRIES)) for n, s in enumerate(symbols)}
        value = written.xreplace(values)
        if value.is_number and value.is_zero is False:
            return {**sizes, **{s.name: str(v) for s, v in values.items()}}, value
    return None
