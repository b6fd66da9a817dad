"""Names to SymPy symbols, law trees to SymPy expressions and structure coefficients back to trees.

Input: a `Circuit`.  Output: a `SymbolTable`.  All symbols are real; a parameter that the domain
says is positive (or not negative) is so in SymPy too; temperatures are positive.  A symbol of a
bank's lane is spelled with the paper's index, ``phi_j``.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from typing import Any, final

import sympy as sp

from piezo_sym.algebra.sums import LaneSymbol, SymbolicLaneSum
from piezo_sym.errors import SpecError, UnknownNameError, nearest, quote
from piezo_sym.expressions.calculus import add, choices, div, mul, power
from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.grammar import parse_rule
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import (
    COMPARED,
    ONE,
    Add,
    Call,
    Cmp,
    Div,
    Expr,
    If,
    Mul,
    Neg,
    Num,
    Pow,
    Sym,
    knots,
    names,
)
from piezo_sym.spec.circuit import Circuit
from piezo_sym.spec.elements.ports import Body, Conductor, Coupling, DissipativePort, Port, Storage
from piezo_sym.spec.tables import bank_states, banks, greater, states

TABLE = sp.Function("table")


class Raised(sp.Function):  # type: ignore[misc]
    """x**w for x >= 0, w > 0, kept as written: SymPy may take a `Pow` apart."""

    _imp_ = staticmethod(pow)
    is_extended_real = True
    is_extended_nonnegative = True

    @classmethod
    def eval(cls, x: sp.Expr, w: sp.Expr) -> sp.Expr | None:
        """Return the power of numbers, nan where it has no value, and 0 for x = 0; else None."""
        if x.is_zero and w.is_positive:
            return sp.S.Zero
        if not (x.is_number and w.is_number):
            return None
        return sp.Pow(x, w) if x.is_nonnegative and w.is_positive else sp.nan

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Return the derivative by an argument, where x > 0."""
        x, w = self.args
        return self * (w / x if argindex == 1 else sp.log(x))

    def _latex(self, printer: Any) -> str:
        base, exponent = map(printer.doprint, self.args)
        return rf"\left({base}\right)^{{{exponent}}}"

    def _sympystr(self, printer: Any) -> str:
        return str(printer.doprint(sp.Pow(*self.args, evaluate=False)))


@final
@dataclass(frozen=True)
class SymbolTable(Mapping[str, sp.Symbol]):
    """The symbols of a circuit, by name."""

    #: The symbol of every name; that of a bank's quantity is a `LaneSymbol`.
    symbols: Mapping[str, sp.Symbol]
    banks: Mapping[LaneSymbol, str]  # the bank of each lane symbol
    counts: Mapping[str, sp.Symbol]  # the size symbol of each bank
    #: Whether a `table` stays one function instead of its pieces, for display.
    keep_tables: bool = False

    def __getitem__(self, name: str) -> sp.Symbol:
        """Return the symbol of a name."""
        try:
            return self.symbols[name]
        except KeyError:
            what, remedy = f"unknown name {quote(name)}", nearest(str(name), self.symbols)
            raise UnknownNameError(what, remedy=remedy) from None

    def __contains__(self, name: object) -> bool:
        """Return whether a symbol has this name."""
        return name in self.symbols

    def __iter__(self) -> Iterator[str]:
        """Yield the names."""
        return iter(self.symbols)

    def __len__(self) -> int:
        """Return the number of names."""
        return len(self.symbols)

    def law(self, tree: Expr, letters: Mapping[str, sp.Expr]) -> sp.Expr:
        """Return a law as a SymPy expression, its letters replaced by the given expressions.

        Raises `SpecError` if a side of a comparison is not real, such as ``log(sign(v)) < 1`` for v
        < 0.
        """
        table = {n: (letters if n in letters else self)[n] for n in names(tree)}
        try:
            return to_sympy(tree, table | {"table": TABLE} if self.keep_tables else table)
        except TypeError as error:
            what = f"the law {quote(spell(tree))} compares what has no real value somewhere"
            remedy = "keep its logarithms, roots and quotients defined"
            raise SpecError(what, "elements", "real numbers to compare", remedy) from error


def symbol_table(circuit: Circuit) -> SymbolTable:
    """Return the symbols of a circuit's parameters, inputs, states and named quantities."""
    model = circuit.model
    signs = _signs(circuit)
    sizes = banks(model)
    per_lane = bank_states(model)
    owners = circuit.lane_parameters
    per_lane |= {n: owners[n] for n, p in model.parameters.items() if isinstance(p.value, tuple)}
    names = [*model.parameters, *model.inputs, *states(model)]
    for placed in circuit.ports:
        for name in _quantities(placed.port):
            names.append(name)
            if placed.bank:
                per_lane[name] = placed.bank
        if isinstance(placed.port, Body):
            signs[placed.port.temperature] = {"positive": True}
    table = {name: _symbol(name, per_lane.get(name), signs.get(name)) for name in names}
    counts = {bank: sp.Symbol(f"{bank}_count", integer=True, positive=True) for bank in sizes}
    return SymbolTable(table, {table[name]: bank for name, bank in per_lane.items()}, counts)


def _quantities(port: Port) -> tuple[str, ...]:
    """Return the names of the quantities that a port defines."""
    match port:
        case Conductor():
            return (port.output,)
        case Storage():
            return (port.costate,)
        case DissipativePort():
            return (port.output, port.effort, *filter(None, (port.rate,)))
        case Coupling():
            return (port.name,)
        case Body():
            return (port.temperature,)
    return ()


def _symbol(name: str, bank: str | None, sign: Mapping[str, bool] | None) -> sp.Symbol:
    known = sign or {"real": True}
    return sp.Symbol(name, **known) if bank is None else LaneSymbol(name, bank, **known)


def _signs(circuit: Circuit) -> dict[str, dict[str, bool]]:
    """Return the SymPy assumption on each parameter or input that the domain keeps >= a number."""
    found: dict[str, dict[str, bool]] = {}
    for condition in circuit.conditions:
        match greater(condition.tree):
            case Cmp(">" | ">=" as op, Sym(name), Num(least)) if least >= 0:
                if found.get(name) != {"positive": True}:
                    strict = op == ">" or least > 0
                    found[name] = {"positive": True} if strict else {"nonnegative": True}
    known = {*circuit.model.parameters, *circuit.model.inputs}
    return {name: sign for name, sign in found.items() if name in known}


def to_sympy(node: Expr, table: Mapping[str, sp.Expr]) -> sp.Expr:
    """Return a law's tree as a SymPy expression over the symbols in `table`.

    A ``table`` function that is in `table` stays one function instead of its pieces.
    """
    match node:
        case Num(value):
            return sp.Rational(value.numerator, value.denominator)
        case Sym(name):
            return table[name]
        case Neg(arg):
            return -to_sympy(arg, table)
        case Add(terms):
            return sp.Add(*(to_sympy(term, table) for term in terms))
        case Mul(left, right):
            return to_sympy(left, table) * to_sympy(right, table)
        case Div(left, right):
            return to_sympy(left, table) / to_sympy(right, table)
        case Pow(base, exponent):
            return to_sympy(base, table) ** sp.Rational(exponent.numerator, exponent.denominator)
        case Call(function) if knots(node) and function not in table:
            return to_sympy(choices(node), table)
        case Call(function, args):
            parts = tuple(to_sympy(arg, table) for arg in args)
            if knots(node):
                return table[function](*parts)
            if RECORDS[function].smooth:
                return getattr(sp, function, Raised)(*parts)
            return _by_branches(partial(_kinked, function), parts)
        case If(then, Cmp(op, left, right), other):
            choose = partial(_choice, op, to_sympy(then, table), to_sympy(other, table))
            return _by_branches(choose, (to_sympy(left, table), to_sympy(right, table)))
    raise TypeError(f"{type(node).__name__} is no law")


def _choice(op: str, then: sp.Expr, other: sp.Expr, left: sp.Expr, right: sp.Expr) -> sp.Expr:
    return sp.Piecewise((then, _relation(op, left, right)), (other, True))


def _relation(op: str, left: sp.Expr, right: sp.Expr) -> Any:
    """Return a comparison; where a side is a sum, of the difference with zero.

    SymPy takes very long to order two sums that share terms.
    """
    plain = right.is_number or not (left.is_Add or right.is_Add)
    return COMPARED[op](left, right) if plain else COMPARED[op](left - right, 0)


def _by_branches(build: Callable[..., sp.Expr], args: tuple[sp.Expr, ...]) -> sp.Expr:
    """Return ``build(*args)`` with the choices inside `args` moved outside.

    Conditions then contain no choices: SymPy would try to solve the inequality.
    """
    choice = next((found for arg in args for found in _choices(arg)), None)
    if choice is None:
        return build(*args)
    cases = ((tuple(a.xreplace({choice: e}) for a in args), c) for e, c in choice.args)
    return sp.Piecewise(*((_by_branches(build, here), c) for here, c in cases))


def _choices(expr: sp.Basic) -> Iterator[sp.Piecewise]:
    """Yield the choices in an expression outside of sums over lanes, outermost first."""
    if isinstance(expr, sp.Piecewise):
        yield expr
    elif not isinstance(expr, SymbolicLaneSum):
        for arg in expr.args:
            yield from _choices(arg)


def _kinked(function: str, *args: sp.Expr) -> sp.Expr:
    """Return a function with kinks as a `Piecewise`."""
    law, table, cases = parse_rule(RECORDS[function].choices), {"x": args[0], "w": args[-1]}, []
    while isinstance(law, If):
        left, right = (to_sympy(side, table) for side in (law.condition.left, law.condition.right))
        cases.append((to_sympy(law.then, table), _relation(law.condition.op, left, right)))
        law = law.other
    return sp.Piecewise(*cases, (to_sympy(law, table), True))


def coefficient(expr: sp.Expr) -> Expr:
    """Return a rational function of symbols as a tree, symbols and powers in a fixed order."""
    top, bottom = sp.fraction(sp.together(expr))
    symbols = sorted(expr.free_symbols, key=lambda symbol: str(symbol.name))
    return div(_polynomial(top, symbols), _polynomial(bottom, symbols))


def _polynomial(expr: sp.Expr, symbols: list[sp.Symbol]) -> Expr:
    if not symbols:
        return _number(expr)
    terms = list[Expr]()
    for exponents, value in sp.Poly(expr, *symbols).terms():
        term: Expr = ONE
        for exponent, symbol in zip(exponents, symbols, strict=True):
            term = mul(term, power(Sym(symbol.name), Fraction(exponent)))
        terms.append(mul(_number(value), term))
    return add(*terms)


def _number(value: sp.Expr) -> Num:
    return Num(Fraction(int(value.p), int(value.q)))
