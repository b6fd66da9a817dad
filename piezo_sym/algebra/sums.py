"""Sums over the lanes of a bank whose size stays a symbol.

Input: expressions in lane symbols such as ``phi_j``.  Output: `SymbolicLaneSum`, a sum kept as a
sum, in a normal form in which equal sums are equal expressions.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, final

import sympy as sp
from sympy.core.symbol import Str
from sympy.printing.precedence import PRECEDENCE


class LaneSymbol(sp.Symbol):  # type: ignore[misc]
    """A quantity of a bank's lane j, spelled ``<quantity>_j``.

    Quantity and bank are part of its identity, so it never equals a plain symbol of that spelling.
    """

    __slots__ = ("bank", "quantity")

    def __new__(cls, quantity: str, bank: str, **assumptions: bool) -> LaneSymbol:
        """Return the symbol of a quantity in lane j of a bank."""
        symbol: LaneSymbol = sp.Symbol.__xnew__(cls, f"{quantity}_j", **assumptions)
        symbol.quantity, symbol.bank = quantity, bank
        return symbol

    def __getnewargs_ex__(self) -> tuple[tuple[str, str], dict[str, bool]]:
        """Return the arguments that make the symbol again when it is unpickled."""
        return (self.quantity, self.bank), dict(self._assumptions_orig)

    def _hashable_content(self) -> tuple[Any, ...]:
        return (self.quantity, self.bank, *super()._hashable_content())


class SymbolicLaneSum(sp.Expr):  # type: ignore[misc]
    """The sum of its first argument over the lanes j = 1..r of the bank named by its second."""

    is_commutative = True
    is_real = True
    is_Function = True  # so that SymPy's LaTeX hands the power of a sum to `_latex`

    def __new__(cls, arg: sp.Expr, bank: str | Str) -> SymbolicLaneSum:
        """Return the sum of `arg` over the lanes of `bank`, as it stands."""
        bank = bank if isinstance(bank, Str) else Str(bank)
        total: SymbolicLaneSum = sp.Expr.__new__(cls, arg, bank)
        return total

    def has(self, *patterns: Any) -> bool:
        """Return whether the sum has a pattern; denies choices, which SymPy would move outside."""
        return bool(super().has(*(p for p in patterns if p is not sp.Piecewise)))

    def _latex(self, printer: Any, exp: Any = None) -> str:
        term = printer.parenthesize(self.args[0], PRECEDENCE["Mul"])
        text = rf"\sum_{{j=1}}^{{r}} {term}"
        return text if exp is None else rf"\left({text}\right)^{{{exp}}}"

    def _sympystr(self, printer: Any) -> str:
        return f"Sum_j({printer.doprint(self.args[0])})"


def outside_sums(expr: sp.Basic) -> frozenset[sp.Symbol]:
    """Return the symbols of `expr` outside of sums over lanes."""
    if isinstance(expr, SymbolicLaneSum):
        return frozenset()
    if isinstance(expr, sp.Symbol):
        return frozenset({expr})
    return frozenset().union(*(outside_sums(arg) for arg in expr.args))


@final
@dataclass(frozen=True)
class Lanes:
    """The bank of each lane symbol and the size of each bank, for sums over lanes."""

    banks: Mapping[LaneSymbol, str]
    counts: Mapping[str, sp.Symbol]

    def sum(self, expr: sp.Expr, bank: str) -> sp.Expr:
        """Return the sum of `expr` over the lanes of `bank`, in normal form.

        Lane-free factors stand outside, lane-free terms give the bank's size, and every distinct
        sum of a product of lane symbols is an atom of its own.
        """
        total = sp.S.Zero
        for term in sp.Add.make_args(sp.expand(expr)):
            free, lane = self._split(term, bank)
            total += free * (self.counts[bank] if lane == 1 else SymbolicLaneSum(lane, bank))
        return total

    def _split(self, term: sp.Expr, bank: str) -> tuple[sp.Expr, sp.Expr]:
        """Return a product as (factors without lane symbols of the bank, the others)."""
        parts: tuple[list[sp.Expr], list[sp.Expr]] = ([], [])
        for factor in sp.Mul.make_args(term):
            lane = any(self.banks.get(symbol) == bank for symbol in outside_sums(factor))
            parts[lane].append(factor)
        return sp.Mul(*parts[0]), sp.Mul(*parts[1])

    def symbols(self, bank: str) -> tuple[LaneSymbol, ...]:
        """Return the lane symbols of `bank`."""
        return tuple(symbol for symbol, own in self.banks.items() if own == bank)

    def at(self, expr: sp.Expr, bank: str, lane: int) -> sp.Expr:
        """Return `expr` in lane number `lane` of `bank`: ``phi_j`` becomes ``phi_<lane>``."""
        symbols = self.symbols(bank)
        names = {s: sp.Symbol(f"{s.quantity}_{lane}", **s.assumptions0) for s in symbols}
        return expr.xreplace(names)

    def expand(self, expr: sp.Expr, counts: Mapping[str, int]) -> sp.Expr:
        """Return `expr` with every sum over lanes written out, for banks of the given sizes."""

        def written(arg: sp.Expr, bank: Str) -> sp.Expr:
            lanes = range(1, counts[bank.name] + 1)
            return sp.Add(*(self.at(arg, bank.name, lane) for lane in lanes))

        sizes = {symbol: sp.Integer(counts[bank]) for bank, symbol in self.counts.items()}
        return expr.replace(SymbolicLaneSum, written).xreplace(sizes)
