"""A system as text that a second program can check: rates, U, y, and the law of each name.

Input: an `IPHS`.  Output: the "system" part of ``proofs.json``, in the law grammar of specs with
``sum(bank, law)``, and ``pow(x, w)`` for x**w of an x that may be zero.  Names of a bank have no
index: they are of the row's own lane, or of the lane that the enclosing sum runs over.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace as changed
from fractions import Fraction

import sympy as sp

from piezo_sym.algebra.sums import SymbolicLaneSum
from piezo_sym.algebra.symbols import Raised
from piezo_sym.expressions.calculus import add, div, mul, power
from piezo_sym.expressions.functions import FUNCTIONS as WRITTEN
from piezo_sym.expressions.text import ATOM, SPEC, write
from piezo_sym.expressions.tree import ONE, Call, Cmp, Expr, If, LaneSum, Mul, Num, Sym, replace
from piezo_sym.iphs import IPHS
from piezo_sym.iphs.definitions import costate_name
from piezo_sym.spec.elements.ports import Body, Conductor, Coupling, DissipativePort, Storage

#: The law language with sums over the lanes of a bank, and powers of a base that may be zero.
STYLE = changed(
    SPEC,
    lane_sum=lambda arg, bank: (f"sum({bank}, {arg[0]})", ATOM),
    call=lambda name, args: (f"{name}({', '.join(text for text, _ in args)})", ATOM),
)
COMPARISONS = {sp.Lt: "<", sp.Le: "<=", sp.Gt: ">", sp.Ge: ">="}
FUNCTIONS = tuple(getattr(sp, name) for name, r in WRITTEN.items() if r.transcendental)
HALF = sp.Rational(1, 2)
#: SymPy turns atan(1) into pi/4; the law language has no pi.
PI = Mul(Num(Fraction(4)), Call("atan", (ONE,)))


def published(iphs: IPHS) -> dict[str, object]:
    """Return the states, names, rates, energy and outputs of a system as text, in order."""
    system = iphs.system
    slots = list(zip(system.states, iphs.circuit.of(Storage, Body), strict=True))
    tree = _Trees(iphs)
    stored = [LaneSum(e.law, e.bank) if e.bank else e.law for e in iphs.energies]
    return {
        "states": [
            {"name": slot.label, "element": placed.element, "bank": slot.bank}
            for slot, (placed, _) in slots
        ],
        "names": dict(_names(iphs, tree)),
        "rates": {
            slot.label: write(tree(rate), STYLE)
            for slot, rate in zip(system.states, system.rhs, strict=True)
        },
        "energy": write(add(*stored), STYLE),
        "outputs": {
            slot.label: write(tree(y), STYLE)
            for slot, y in zip(system.ports, system.y, strict=True)
        },
    }


def _names(iphs: IPHS, tree: _Trees) -> Iterator[tuple[str, dict[str, str | None]]]:
    """Yield each name of a system with its element, role, bank and law."""

    def entry(name: str, element: str, role: str, law: Expr) -> tuple[str, dict[str, str | None]]:
        bank = iphs.symbols.banks.get(iphs.symbols[name]) if name in iphs.symbols.symbols else None
        return name, {"element": element, "role": role, "bank": bank, "law": write(law, STYLE)}

    circuit = iphs.circuit
    for placed, store in circuit.of(Storage, Body):
        role = "temperature" if isinstance(store, Body) else "costate"
        yield entry(costate_name(store), placed.element, role, store.law)
    for placed, port in circuit.of(Coupling):
        yield entry(port.name, placed.element, "ratio", port.ratio)
    processes = tuple(circuit.of(DissipativePort, Conductor))
    rates = dict(iphs.rates)
    for placed, slip in circuit.of(DissipativePort):
        if slip.rate:
            rate = tree(rates[iphs.symbols[slip.rate]])
            yield entry(slip.rate, placed.element, "rate", rate)
    for slope in iphs.junction.slopes:
        element = processes[slope.process][0].element
        yield entry(slope.symbol.name, element, "slope", slope.law)
    for share, value in iphs.junction.shares:
        yield entry(share.name, "", "share", tree(value))
    for (placed, process), z in zip(processes, iphs.system.z, strict=True):
        if isinstance(process, Conductor):
            first = Sym(circuit.bodies[process.first].temperature)
            law = div(mul(process.conductance, tree(z)), first)
        else:
            letters = {process.letter: tree(z), process.rate_letter: Sym(process.rate)}
            law = replace(process.law, letters)
        yield entry(process.output, placed.element, "output", law)


class _Trees:
    """SymPy expressions to trees, terms and factors sorted by their text."""

    def __init__(self, iphs: IPHS) -> None:
        self.names: Mapping[sp.Symbol, str] = {s: n for n, s in iphs.symbols.symbols.items()}
        self.sizes = {symbol: bank for bank, symbol in iphs.symbols.counts.items()}

    def __call__(self, expr: sp.Expr) -> Expr:
        """Return the tree of an expression."""
        match expr:
            case sp.pi:
                return PI
            case sp.E:
                return Call("exp", (ONE,))
            case sp.Rational():
                return Num(Fraction(int(expr.p), int(expr.q)))
            case sp.Symbol():
                bank = self.sizes.get(expr)
                return LaneSum(ONE, bank) if bank else Sym(self.names.get(expr, str(expr.name)))
            case SymbolicLaneSum():
                return LaneSum(self(expr.args[0]), str(expr.args[1]))
            case sp.Add():
                return add(*self._ordered(expr.args))
            case sp.Mul():
                return self._product(expr)
            case sp.Pow():
                return self._power(expr.base, expr.exp)
            case sp.Piecewise():
                return self._choice(expr.args)
        if isinstance(expr, Raised):
            return Call("pow", tuple(map(self, expr.args)))
        if isinstance(expr, FUNCTIONS):
            return Call(type(expr).__name__, (self(expr.args[0]),))
        raise TypeError(f"{type(expr).__name__} is nothing that a system has")

    def _ordered(self, args: tuple[sp.Expr, ...]) -> list[Expr]:
        return sorted(map(self, args), key=lambda tree: write(tree, STYLE))

    def _product(self, expr: sp.Mul) -> Expr:
        top, bottom = sp.fraction(expr)
        if bottom != 1:
            return div(self(top), self(bottom))
        total: Expr = ONE
        for factor in self._ordered(expr.args):
            total = mul(total, factor)
        return total

    def _power(self, base: sp.Expr, exponent: sp.Expr) -> Expr:
        if exponent == HALF:
            return Call("sqrt", (self(base),))
        if exponent == -1:
            return div(ONE, self(base))
        return power(self(base), Fraction(int(exponent.p), int(exponent.q)))

    def _choice(self, cases: tuple[tuple[sp.Expr, sp.Basic], ...]) -> Expr:
        (value, condition), *rest = cases
        if not rest:
            return self(value)
        left, right = self(condition.args[0]), self(condition.args[1])
        return If(
            self(value), Cmp(COMPARISONS[type(condition)], left, right), self._choice(tuple(rest))
        )
