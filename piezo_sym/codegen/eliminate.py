"""Linear equations solved term by term: elimination written out, with pivots on the diagonal.

Input: sparse equations ``1 + h*(...)`` in names and trees.  Output: definitions of every number on
the way, and of the unknowns.  There is no exchange of rows: with a convex energy and passive laws
the matrix has a positive definite symmetric part (in the scale of the energy), and so has all that
is left of it after each pivot; where heat couples back, a shorter step brings the matrix near to 1.
Pivots therefore have to be positive, and a step that has others is too long.  The unknown with the
fewest entries is eliminated first, so that a chain of elements costs what it has.
"""

from __future__ import annotations

from typing import final

from piezo_sym.codegen.quantities import Quantities
from piezo_sym.expressions.calculus import add, div, mul, neg
from piezo_sym.expressions.tree import ZERO, Expr, Num, Sym

NOTE = "Newton's equations, solved"


@final
class Equations:
    """Equations on the way to be solved.

    Attributes
    ----------
    unknowns : names.
    rows : of each equation, its entries by unknown.
    right : right-hand sides.
    """

    def __init__(self, unknowns: list[str]) -> None:
        self.unknowns = unknowns
        self.rows: list[dict[int, Expr]] = [{} for _ in unknowns]
        self.right: list[Expr] = [ZERO for _ in unknowns]

    def add(self, place: tuple[int, int], value: Expr) -> None:
        """Add a value to the entry at (row, column)."""
        row, column = place
        total = add(self.rows[row].get(column, ZERO), value)
        self.rows[row][column] = total
        if total == ZERO:
            del self.rows[row][column]


def eliminate(equations: Equations, q: Quantities) -> tuple[tuple[Sym, ...], tuple[Expr, ...]]:
    """Return the pivots, and the value of each unknown; their definitions are added to `q`."""
    left = set(range(len(equations.unknowns)))
    order: list[int] = []
    pivots: list[Sym] = []
    while left:
        n = min(left, key=lambda n: (_cost(equations, n, left), n))
        left.remove(n)
        order.append(n)
        pivots += _pivot(equations, n, left, q)
    found: dict[int, Expr] = {}
    for n in reversed(order):
        row = equations.rows[n]
        terms = [neg(mul(value, found[col])) for col, value in row.items() if col != n]
        value = div(add(equations.right[n], *terms), row[n])
        found[n] = q.defined_as(equations.unknowns[n], value, None, NOTE)
    return tuple(pivots), tuple(found[n] for n in range(len(found)))


def _cost(equations: Equations, n: int, left: set[int]) -> int:
    """Return Markowitz's count: how many entries the elimination of unknown n may touch."""
    rows = sum(n in equations.rows[m] for m in left) - 1
    return rows * (sum(m in left for m in equations.rows[n]) - 1)


def _pivot(equations: Equations, n: int, left: set[int], q: Quantities) -> list[Sym]:
    """Take unknown n out of the equations that are left; return its pivot, if it is not 1."""
    row, name = equations.rows[n], equations.unknowns[n]
    for col in sorted(row):
        base = f"pivot_{name}" if col == n else f"entry_{name}_{col + 1}"
        row[col] = _named(base, row[col], q)
    equations.right[n] = _named(f"right_{name}", equations.right[n], q)
    for m in sorted(m for m in left if n in equations.rows[m]):
        share = _named(f"share_{name}_{m + 1}", div(equations.rows[m].pop(n), row[n]), q)
        equations.right[m] = add(equations.right[m], neg(mul(share, equations.right[n])))
        for col, value in row.items():
            if col != n:
                equations.add((m, col), neg(mul(share, value)))
    pivot = row[n]
    return [pivot] if isinstance(pivot, Sym) else []


def _named(base: str, value: Expr, q: Quantities) -> Expr:
    """Return a value by its name; a number or a name stands for itself."""
    if isinstance(value, Num | Sym):
        return value
    return q.define(base, value, None, NOTE)
