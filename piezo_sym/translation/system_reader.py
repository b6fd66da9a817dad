"""SymPy expressions of a system as values in normal form.

Input: an `IPHS`.  Output: a `SystemReader`: the value of each name, of margins of the domain, of
any expression.  A co-state can be made a name of its own, free of the state that it belongs to: at
a stage of a collocation step it is a mean over the step.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from fractions import Fraction
from typing import final

import sympy as sp
from sympy.logic.boolalg import Boolean

from piezo_sym.algebra.sums import SymbolicLaneSum
from piezo_sym.algebra.symbols import Raised
from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.parse import parse_law
from piezo_sym.expressions.tree import Call, Cmp, Expr, If, Num, Sym, names, walk
from piezo_sym.iphs import IPHS
from piezo_sym.proofs.branches import KINKED, value_conditions
from piezo_sym.spec.elements.ports import Body
from piezo_sym.spec.tables import bank_states, laws, states
from piezo_sym.translation.field import GeneratorField, NotShownError, Value
from piezo_sym.translation.functions import call, power, raised, size_of
from piezo_sym.translation.signs import assume, compare, on_path, reading

#: Functions of which some parts have a value on one branch alone, as choices; abs(a) needs a.
BRANCHED = KINKED - {"abs"}


def _branches(tree: Expr | Cmp) -> bool:
    return any(
        isinstance(n, If) or (isinstance(n, Call) and n.function in BRANCHED) for n in walk(tree)
    )


@final
class SystemReader:
    """Reads the SymPy expressions of a system.

    Attributes
    ----------
    field : of the values.
    names : parameters, inputs and states, in lane 0 where they have one per lane.
    banks : the bank of each of these that has one value per lane.
    costates : the co-states that are names, by their names in the spec.
    known : the value of each symbol that is a name, or whose definition was read.
    """

    def __init__(self, iphs: IPHS) -> None:
        self.iphs, self.field = iphs, GeneratorField()
        model, system = iphs.model, iphs.system
        self.banks = {**iphs.circuit.lane_parameters, **bank_states(model)}
        names = [*model.parameters, *model.inputs, *states(model)]
        symbols = {name: iphs.symbols[name] for name in names}
        if len({*iphs.symbols.symbols.values()}) < len(iphs.symbols.symbols):
            raise NotShownError("two names of the system have one symbol")
        self.costates = dict[str, Value]()
        self.names = {name: self._name(name, symbol) for name, symbol in symbols.items()}
        own = (self.names[slot.label].parts for slot in system.states)
        self.field.states = frozenset().union(*own)
        self._read = list[sp.Symbol]()  # symbols in `known` with definitions
        self.known = {symbols[name]: value for name, value in self.names.items()}
        self.known |= {s: self.field.count(bank) for bank, s in iphs.symbols.counts.items()}
        groups = (*iphs.named, iphs.costates)
        self._definitions = {symbol: expr for group in groups for symbol, expr in group}

    def _name(self, name: str, symbol: sp.Symbol, bank: str | None = None) -> Value:
        sign = 2 if symbol.is_positive else int(bool(symbol.is_nonnegative))
        return self.field.name(name, bank or self.banks.get(name), 0, sign)

    def free(self, costate: str, name: str, bank: str | None) -> Value:
        """Make a co-state a name that does not depend on a state, and return it."""
        self._forget()
        symbol = self.iphs.symbols[costate]
        del self._definitions[symbol]
        self.known[symbol] = self.costates[costate] = self._name(name, symbol, bank)
        return self.costates[costate]

    def assume(self, given: Iterable[Cmp]) -> tuple[tuple[Value, bool], ...]:
        """Assume some conditions; return their margins, and whether each is strict."""
        found = [(self._margin(condition, {}), "=" not in condition.op) for condition in given]
        for margin, strict in found:
            assume(margin, 2 if strict else 1)
        self._forget()
        return tuple(found)

    def assume_temperatures(self) -> None:
        """Assume that all temperatures are positive."""
        for _, port in self.iphs.circuit.of(Body):
            assume(self(self.iphs.symbols[port.temperature]), 2)
        self._forget()

    def margins(self, given: Iterable[Cmp]) -> list[Value]:
        """Return the margins of some conditions, without assuming any of them."""
        given = list(given)
        with self._outside("margins", *given) as letters:
            for condition in given:
                self._divide(condition, letters)
            return [self._margin(condition, letters) for condition in given]

    def law(self, law: Expr) -> Value:
        """Return the value of a law, without the assumptions of the domain."""
        with self._outside("integrands", law) as letters:
            self._divide(law, letters)
            return self(self.iphs.symbols.law(law, letters))

    def _divide(self, tree: Expr | Cmp, letters: Mapping[str, sp.Symbol]) -> None:
        """Note the divisors of a tree, and of a temperature in it, as they are written.

        Rows welldef show that they are not zero; SymPy turns phi/(L/(1 + phi**2)) into a product.
        Trees with branches are left out: there the rows show it on each branch only.
        """
        bodies = {Sym(port.temperature): port.law for _, port in self.iphs.circuit.of(Body)}
        found = [tree, *(law for word, law in bodies.items() if word in walk(tree))]
        for condition in (
            c for part in found if not _branches(part) for c in value_conditions(part)
        ):
            if condition.op == "!=":
                power(self(self.iphs.symbols.law(condition.left, letters)), -1)

    @contextmanager
    def _outside(self, function: str, *trees: Expr | Cmp) -> Iterator[Mapping[str, sp.Symbol]]:
        """Yield a symbol without sign for each name in trees, while known signs are forgotten."""
        used = dict.fromkeys(name for tree in trees for name in names(tree))
        found = {name: self.costates.get(name, self.names.get(name)) for name in used}
        unsigned = {name: sp.Dummy(name, real=True) for name, value in found.items() if value}
        self.known |= {letter: found[name] for name, letter in unsigned.items()}
        self._forget()
        with reading(self.field, function):
            yield unsigned
        self._forget()

    def _margin(self, condition: Cmp, letters: Mapping[str, sp.Symbol]) -> Value:
        turn = self.field.number(1 if condition.op.startswith(">") else -1)
        sides = condition.left, condition.right
        left, right = (self(self.iphs.symbols.law(side, letters)) for side in sides)
        return (left - right) * turn

    def _forget(self) -> None:
        """Forget definitions that were read under other assumptions on signs."""
        for symbol in self._read:
            del self.known[symbol]
        self._read.clear()

    def __call__(self, expr: sp.Expr) -> Value:
        """Return an expression in normal form."""
        field = self.field
        if isinstance(expr, sp.Symbol):
            if expr not in self.known:
                with on_path(field, field.one):
                    self.known[expr] = field.letter(self(self._definitions[expr]))
                self._read.append(expr)
            return self.known[expr]
        if isinstance(expr, sp.Rational):
            return field.number(Fraction(int(expr.p), int(expr.q)))
        if isinstance(expr, sp.Piecewise):
            return self._chosen(expr)
        if isinstance(expr, SymbolicLaneSum):
            return field.lane_sum(self(expr.args[0]), expr.args[1].name)
        if expr is sp.E:
            return call("exp", field.one)
        if expr is sp.pi:
            return call("atan", field.one) * field.number(4)
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
        if isinstance(expr, Raised):
            return raised(*args)
        function = type(expr).__name__
        if function not in RECORDS or not RECORDS[function].transcendental:
            raise NotShownError(f"{function} in the proved system")
        return call(function, args[0])

    def _chosen(self, expr: sp.Piecewise) -> Value:
        field, left, parts = self.field, self.field.one, []
        for value, condition in expr.args:
            here = left * self._test(condition)
            with on_path(field, field.path and field.path * here):
                parts.append(here * self(value))
            left = left - here
        if left.terms:
            raise NotShownError("a choice of the proved system leaves a case out")
        return field.total(parts)

    def _test(self, condition: Boolean) -> Value:
        field = self.field
        if condition in (sp.true, sp.false):
            return field.number(int(bool(condition)))
        if isinstance(condition, sp.Rel):
            left, right = map(self, condition.args)
            return compare(condition.rel_op, left, right)
        parts = [self._test(part) for part in condition.args]
        if not isinstance(condition, sp.And | sp.Or | sp.Not):
            raise NotShownError(f"{type(condition).__name__} in a condition of the proved system")
        product = field.one
        for part in parts:
            product = product * (part if isinstance(condition, sp.And) else field.one - part)
        return product if not isinstance(condition, sp.Or) else field.one - product


def rounded(iphs: IPHS) -> Iterator[tuple[float, Fraction]]:
    """Yield (nearest double, exact value) of each number in a spec that is rounded in print."""
    model = iphs.model
    trees = [law.tree for law in laws(model)]
    trees += [energy.law for energy in iphs.energies]
    trees += [side for c in iphs.circuit.conditions for side in (c.tree.left, c.tree.right)]
    starts = (s if isinstance(s, tuple) else (s,) for s in model.initial.values())
    trees += [parse_law(part, "initial") for s in starts for part in s if isinstance(part, str)]
    for tree in trees:
        for node in walk(tree):
            if isinstance(node, Num) and Fraction(repr(float(node.value))) != node.value:
                yield float(node.value), node.value
