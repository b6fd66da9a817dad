"""The proved system in normal form: what each function of a module has to be.

Input: an `IPHS`.  Output: a `Proved`, the rows of every function and the entries of the Jacobian as
values, and what the laws themselves divide by.  The Jacobian is the derivative of the proved rates,
made here; that the co-states are the gradient of the energy is checked here.

A parameter of a bank is one number a lane, as it is in printed modules; the proofs close on named
co-states and laws of one lane, so they hold for lanes that differ.
"""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import final

import sympy as sp
from sympy.logic.boolalg import Boolean

from piezo_sym.algebra.lanes import LaneMatrix, Slot
from piezo_sym.algebra.sums import LaneSum
from piezo_sym.iphs import IPHS
from piezo_sym.spec.elements.ports import Body
from piezo_sym.spec.expressions import Num, walk
from piezo_sym.spec.parse import parse_law
from piezo_sym.spec.tables import conditions, lane_parameters, law_fields, states
from piezo_sym.translation.change import across, derivative
from piezo_sym.translation.field import Field, Need, NotShownError, Value
from piezo_sym.translation.functions import call, divisors, power, size_of
from piezo_sym.translation.known import ALL, LEAST, SAME, Key, Proved
from piezo_sym.translation.signs import assume, compare
from piezo_sym.translation.zero import is_zero

_RELATIONS = {sp.Gt: ">", sp.Ge: ">=", sp.Lt: "<", sp.Le: "<=", sp.Eq: "==", sp.Ne: "!="}


def proved(iphs: IPHS) -> Proved:
    """Return a system in normal form.

    Raises
    ------
    NotShownError
        If something in it has none, or if the co-states are not the gradient of the energy.
    """
    reader = _Reader(iphs)
    margins = reader.domain()
    values = dict(reader.values(margins))
    needs = [*reader.field.needs]
    for (function, *_), value in values.items():
        needs += reader.derived(value) if function == "jacobian" else ()
    reader.field.needs.clear()
    return Proved(
        reader.field,
        reader.names,
        reader.banks,
        reader.slots,
        values,
        tuple(needs),
        margins,
        dict(_rounded(iphs)),
        frozenset(iphs.model.parameters),
        tuple(map(Slot, iphs.model.inputs)),
    )


@final
class _Reader:
    """Reads the SymPy expressions of a system."""

    def __init__(self, iphs: IPHS) -> None:
        self.iphs, self.field = iphs, Field()
        model, system = iphs.model, iphs.system
        owners = {n: e for n, e in states(model).items() if e in iphs.symbols.counts}
        self.banks = {**lane_parameters(model), **owners}
        names = [*model.parameters, *model.inputs, *states(model)]
        symbols = {name: iphs.symbols[name] for name in names}
        if len({*iphs.symbols.symbols.values()}) < len(iphs.symbols.symbols):
            raise NotShownError("two names of the system have one symbol")
        self.names = {name: self._name(name, symbol) for name, symbol in symbols.items()}
        own = (self.names[slot.label].parts for slot in system.states)
        self.field.states = frozenset().union(*own)
        self.known = {symbols[name]: value for name, value in self.names.items()}
        self.known |= {s: self.field.count(bank) for bank, s in iphs.symbols.counts.items()}
        groups = (iphs.laws, iphs.shares, iphs.slopes, iphs.ratios, iphs.costates)
        self.definitions = {symbol: expr for group in groups for symbol, expr in group}
        bodies = tuple(Slot(placed.element) for placed, _ in iphs.circuit.of(Body))
        limits = tuple(Slot(str(n)) for n, _ in enumerate(conditions(model)))
        rates, ports, heats = system.states, system.ports, system.processes
        self.slots = {"initial_state": rates, "rhs": rates, "jacobian": rates, "outputs": ports}
        self.slots |= {"supply": ports, "heat": heats, "entropy_production": heats}
        self.slots |= {"temperatures": bodies, "margins": limits}
        self.slots |= dict.fromkeys(("energy", "entropy"), (Slot(""),))

    def _name(self, name: str, symbol: sp.Symbol) -> Value:
        sign = 2 if symbol.is_positive else int(bool(symbol.is_nonnegative))
        return self.field.name(name, self.banks.get(name), 0, sign)

    def domain(self) -> tuple[tuple[Value, bool], ...]:
        """Return the margins of the domain, and take them, and temperatures, as positive."""
        found = []
        for condition in conditions(self.iphs.model):
            tree = condition.tree
            turn = self.field.number(1 if tree.op.startswith(">") else -1)
            left, right = (self(self.iphs.symbols.law(t, {})) for t in (tree.left, tree.right))
            found.append(((left - right) * turn, "=" not in tree.op))
        for margin, strict in found:
            assume(margin, 2 if strict else 1)
        for _, port in self.iphs.circuit.of(Body):
            assume(self(self.iphs.symbols[port.temperature]), 2)
        self.known = {s: v for s, v in self.known.items() if s not in self.definitions}
        return tuple(found)

    def values(self, margins: Sequence[tuple[Value, bool]]) -> Iterator[tuple[Key, Value]]:
        """Yield the rows of every function."""
        system, field = self.iphs.system, self.field
        rates = [*self._rows(system.rhs)]
        outputs, inputs = [*self._rows(system.y)], [*self._rows(system.u)]
        works, drives = [*self._rows(system.W)], [*self._rows(system.drive)]
        made = zip(self._rows(system.R), self._rows(system.z), strict=True)
        produced = (r * z for r, z in zip(system.R, system.z, strict=True))
        self._tie("sigma", zip(produced, system.processes, strict=True), system.sigma)
        listed = {
            "rhs": rates,
            "outputs": outputs,
            "supply": [y * u for y, u in zip(outputs, inputs, strict=True)],
            "heat": [w * z for w, z in zip(works, drives, strict=True)],
            "entropy_production": [r * z for r, z in made],
            "energy": [self._energy()],
            "entropy": [self(self.iphs.S)],
            "temperatures": [
                self(self.iphs.symbols[port.temperature]) for _, port in self.iphs.circuit.of(Body)
            ],
        }
        for function, rows in listed.items():
            yield from (((function, n), value) for n, value in enumerate(rows))
        for n, (margin, _) in enumerate(margins):
            yield ("margins", n, *([LEAST] if margin.lanes else [])), margin
        for n, slot in enumerate(system.states):
            start = self.iphs.model.initial.get(slot.label, 0.0)
            parts = start if isinstance(start, tuple) else (start,)
            for lane, part in enumerate(parts):
                yield ("initial_state", n, *([lane] if len(parts) > 1 else [])), self._start(part)
        field.path = None
        yield from self._jacobian(rates)
        field.path = field.one

    def _rows(self, matrix: LaneMatrix) -> Iterator[Value]:
        return (self(entry) for entry in matrix)

    def _start(self, part: str | float) -> Value:
        if isinstance(part, str):
            return self(self.iphs.symbols.law(parse_law(part, "initial"), {}))
        return self.field.number(Fraction(repr(part)))

    def _energy(self) -> Value:
        """Return the energy; its gradient is the co-states."""
        parts = []
        system = self.iphs.system
        stored = (self.iphs.symbols.law(law, {}) for law in self.iphs.energies)
        self._tie("U", zip(stored, system.states, strict=True), self.iphs.U)
        for slot, law, costate in zip(system.states, self.iphs.energies, system.E, strict=True):
            term = self(self.iphs.symbols.law(law, {}))
            (state,) = self.names[slot.label].parts
            if not is_zero(derivative(term, state) - self(costate)):
                raise NotShownError(f"dU/d{slot.label} is not shown to be the co-state")
            parts.append(self.field.lane_sum(term, slot.bank) if slot.bank else term)
        return self.field.total(parts)

    def _tie(self, name: str, terms: Iterator[tuple[sp.Expr, Slot]], shown: sp.Expr) -> None:
        """Refuse a total that is shown and is not that of its terms, a bank's summed over lanes."""
        total = self.iphs.system.E.lanes.sum
        parts = (total(term, slot.bank) if slot.bank else term for term, slot in terms)
        if sp.expand(sp.Add(*parts) - shown) != 0:
            raise NotShownError(f"{name} of the system is not that of its parts")

    def _jacobian(self, rates: Sequence[Value]) -> Iterator[tuple[Key, Value]]:
        slots = self.slots["rhs"]
        columns = {g: c for c, slot in enumerate(slots) for g in self.names[slot.label].parts}
        for r, rate in enumerate(rates):
            for c, state in sorted((columns[g], g) for g in rate.parts if g in columns):
                slot = slots[c]
                row, own = slots[r].bank, derivative(rate, state)
                kind = SAME if row and row == slot.bank else ALL
                yield ("jacobian", r, c, kind), own
                if slot.bank:
                    other = across(rate, state, 1 if row else 0)
                    if kind is ALL and own.terms and other.terms:
                        raise NotShownError("a rate depends on another bank's lane")
                    if kind is SAME or not own.terms:
                        yield ("jacobian", r, c, ALL), other

    def derived(self, value: Value) -> Iterator[Need]:
        """Yield what a derivative is divided by, in the branch where it is."""
        gens, one = self.field.gens, self.field.one
        for mono in value.terms:
            below = [g for g, e in mono if e < 0]
            path = one
            for g, _ in mono:
                path = path * self.field.raised(g, 1) if gens[g].kind == "sign" else path
            for g in below:
                yield from (Need("nonzero", d, path, True) for d in divisors(self.field, g))

    # Expressions

    def __call__(self, expr: sp.Expr) -> Value:
        """Return an expression in normal form."""
        field = self.field
        if isinstance(expr, sp.Symbol):
            if expr not in self.known:
                path, field.path = field.path, field.one
                self.known[expr] = field.letter(self(self.definitions[expr]))
                field.path = path
            return self.known[expr]
        if isinstance(expr, sp.Rational):
            return field.number(Fraction(int(expr.p), int(expr.q)))
        if isinstance(expr, sp.Piecewise):
            return self._chosen(expr)
        if isinstance(expr, LaneSum):
            return field.lane_sum(self(expr.args[0]), expr.args[1].name)
        if expr is sp.E:
            return call("exp", field.one)
        args = [self(arg) for arg in expr.args]
        if isinstance(expr, sp.Add):
            return field.total(args)
        args = [field.letter(arg) for arg in args]
        if isinstance(expr, sp.Mul):
            product = field.one
            for arg in args:
                product = product * arg
            return product
        return self._function(expr, args)

    def _function(self, expr: sp.Expr, args: Sequence[Value]) -> Value:
        if isinstance(expr, sp.Pow):
            exponent = args[1].constant
            if exponent is not None:
                return power(args[0], exponent)
            return call("exp", args[1] * call("log", args[0]))
        if isinstance(expr, sp.Abs):
            return size_of(args[0])
        function = type(expr).__name__
        if function not in {"exp", "log", "sin", "cos", "tanh"}:
            raise NotShownError(f"{function} in the proved system")
        return call(function, args[0])

    def _chosen(self, expr: sp.Piecewise) -> Value:
        field, path, left, parts = self.field, self.field.path, self.field.one, []
        for value, condition in expr.args:
            here = left * self._test(condition)
            field.path = path and path * here
            parts.append(here * self(value))
            left = left - here
        field.path = path
        if left.terms:
            raise NotShownError("a choice of the proved system leaves a case out")
        return field.total(parts)

    def _test(self, condition: Boolean) -> Value:
        field = self.field
        if condition in (sp.true, sp.false):
            return field.number(int(bool(condition)))
        if type(condition) in _RELATIONS:
            left, right = map(self, condition.args)
            return compare(_RELATIONS[type(condition)], left, right)
        parts = [self._test(part) for part in condition.args]
        if not isinstance(condition, sp.And | sp.Or | sp.Not):
            raise NotShownError(f"{type(condition).__name__} in a condition of the proved system")
        product = field.one
        for part in parts:
            product = product * (part if isinstance(condition, sp.And) else field.one - part)
        return product if not isinstance(condition, sp.Or) else field.one - product


def _rounded(iphs: IPHS) -> Iterator[tuple[float, Fraction]]:
    """Yield the numbers of a spec that no short decimal is, with the nearest machine number."""
    model = iphs.model
    trees = [law.tree for name, e in model.elements.items() for law in law_fields(name, e)]
    trees += iphs.energies
    trees += [side for c in conditions(model) for side in (c.tree.left, c.tree.right)]
    starts = (s if isinstance(s, tuple) else (s,) for s in model.initial.values())
    trees += [parse_law(part, "initial") for s in starts for part in s if isinstance(part, str)]
    for tree in trees:
        for node in walk(tree):
            if isinstance(node, Num) and Fraction(repr(float(node.value))) != node.value:
                yield float(node.value), node.value
