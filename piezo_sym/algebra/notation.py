"""Expressions and matrices as LaTeX and as plain text, in the paper's notation.

Input: SymPy expressions, slots and entries.  Output: text.  Terms of a sum stand in the order in
which they are given, not in SymPy's; a bank's row or column stands for j = 1..r.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, final

import sympy as sp
from sympy.printing.str import StrPrinter

#: Letters that are spelled in ASCII because the Greek word is a keyword.
SPELLINGS = {"lam": r"\lambda"}
ORDERED = (sp.StrictGreaterThan, sp.GreaterThan, sp.StrictLessThan, sp.LessThan)
Entries = Mapping[tuple[int, int], sp.Expr]


@final
@dataclass(frozen=True)
class Slot:
    """A row or column: its label and, if it stands for one per lane, its bank."""

    label: str
    bank: str | None = None


def latex(expr: sp.Expr) -> str:
    """Return one expression as LaTeX."""
    names = {s: symbol_latex(s.name) for s in expr.free_symbols}
    return str(sp.latex(_with_magnitudes(_with_powers(expr), sp.Abs), symbol_names=names))


def text(expr: sp.Expr) -> str:
    """Return one expression as plain text."""
    plain = _with_magnitudes(_with_powers(expr), sp.Function("abs"))
    return str(_Text().doprint(plain.replace(lambda e: isinstance(e, sp.Piecewise), _extreme)))


@final
class _Text(StrPrinter):  # type: ignore[misc]
    """Writes choices, whose last case is for all else, as laws do: ``a if x > 0 else b``."""

    def _print_Piecewise(self, choice: sp.Piecewise) -> str:
        *cases, (last, _) = choice.args
        branches = (f"{self._print(value)} if {self._print(c)} else " for value, c in cases)
        return f"({''.join(branches)}{self._print(last)})"

    def _print_Relational(self, condition: Any) -> str:
        return f"{self._print(condition.lhs)} {condition.rel_op} {self._print(condition.rhs)}"

    def _print_And(self, condition: sp.And) -> str:
        return " and ".join(map(self._print, condition.args))


def _with_powers(expr: sp.Expr) -> sp.Expr:
    """Return an expression with powers for exponentials of a logarithm times something."""
    return expr.replace(sp.exp, _power)


def _power(exponent: sp.Expr) -> sp.Expr:
    logs = [factor for factor in sp.Mul.make_args(exponent) if isinstance(factor, sp.log)]
    if len(logs) != 1:
        return sp.exp(exponent)
    return sp.Pow(logs[0].args[0], exponent / logs[0])


def _with_magnitudes(expr: sp.Expr, magnitude: Any) -> sp.Expr:
    """Return an expression with choices that equal ``abs`` or ``sign`` written as these."""
    known = {choice: _named(choice, magnitude) for choice in expr.atoms(sp.Piecewise)}
    return expr.xreplace({choice: named for choice, named in known.items() if named is not None})


def _named(choice: sp.Piecewise, magnitude: Any) -> sp.Expr | None:
    """Return a choice as a magnitude or a sign, or None if it is neither."""
    (first, condition), (second, other), *last = choice.args
    if not isinstance(condition, sp.StrictGreaterThan | sp.GreaterThan):
        return None
    x = condition.lhs - condition.rhs
    if not last and other == sp.true and sp.expand(first - x) == sp.expand(second + x) == 0:
        return magnitude(x, evaluate=False)
    signs = isinstance(condition, sp.StrictGreaterThan) and [*map(tuple, last)] == [(0, True)]
    turned = isinstance(other, sp.StrictLessThan) and sp.expand(other.lhs - other.rhs - x) == 0
    if signs and turned and (first, second) == (1, -1):
        return sp.sign(x, evaluate=False)
    return None


def _extreme(choice: sp.Piecewise) -> sp.Expr:
    """Return a choice as the larger or smaller of two, or a power of that and 0; else as it is."""
    if len(choice.args) != 2:
        return choice
    (first, condition), (second, other) = choice.args
    if other != sp.true or not isinstance(condition, ORDERED):
        return choice
    base, power = next((side for side in (first, second) if side != 0), first).as_base_exp()
    if 0 in (first, second) and power.is_Integer and power > 0:
        first, second = (sp.S.Zero if side == 0 else base for side in (first, second))
    else:
        power = sp.S.One
    gap, size = sp.expand(first - second), sp.expand(condition.gts - condition.lts)
    name = {size: "max", -size: "min"}.get(gap)
    return sp.Function(name)(first, second) ** power if name else choice


def symbol_latex(name: str) -> str:
    """Return a name as LaTeX: ``phi_j`` with its index, ``V_hysteron_j`` with two."""
    head, *rest = name.rstrip("_").split("_")
    letter = SPELLINGS.get(head) or (head if len(head) == 1 else sp.latex(sp.Symbol(head)))
    if letter == head and len(head) > 1:
        letter = rf"\mathrm{{{head}}}"
    if not rest:
        return letter
    labels = [part if len(part) == 1 or part.isdigit() else rf"\mathrm{{{part}}}" for part in rest]
    return f"{letter}_{{{','.join(labels)}}}"


def joined(pieces: Iterable[str]) -> str:
    """Return printed terms joined by their signs, in the order given."""
    total = ""
    for piece in pieces:
        negative = piece.startswith("-")
        sign = "- " if negative and total else "-" if negative else "+ " if total else ""
        total += f"{' ' if total else ''}{sign}{piece[1:].strip() if negative else piece}"
    return total or "0"


def slot_text(slot: Slot) -> str:
    """Return a slot's label, ``phi_j`` for a bank's."""
    return f"{slot.label}_j" if slot.bank else slot.label


def matrix_latex(rows: Sequence[Slot], cols: Sequence[Slot], full: Entries, own: Entries) -> str:
    """Return a matrix as LaTeX; a bank's rows and columns stand for lane j, with dots around."""
    lines = []
    for r, row in enumerate(rows):
        cells = [
            _latex_cell(full.get((r, c), sp.S.Zero), own.get((r, c))) for c in range(len(cols))
        ]
        line = " & ".join(_dotted(cols, cells, r"\cdots"))
        dots = " & ".join(_dotted(cols, [r"\vdots"] * len(cols), ""))
        lines += [dots, line, dots] if row.bank else [line]
    return "\\begin{bmatrix} " + " \\\\ ".join(lines) + " \\end{bmatrix}"


def _dotted(cols: Sequence[Slot], cells: Sequence[str], dots: str) -> list[str]:
    """Return the cells of a row, with dots on both sides of a bank's column."""
    parts = [
        (dots, cell, dots) if col.bank else (cell,) for col, cell in zip(cols, cells, strict=True)
    ]
    return [piece for part in parts for piece in part]


def _latex_cell(full: sp.Expr, own: sp.Expr | None) -> str:
    if own is None or own == 0:
        return "0" if full == 0 else latex(full)
    factor = {1: "", -1: "-"}.get(own, rf"{latex(own)}\,")
    same = rf"{factor}\delta_{{jk}}"
    return same if full == 0 else joined((latex(full), same))


def matrix_text(rows: Sequence[Slot], cols: Sequence[Slot], full: Entries, own: Entries) -> str:
    """Return a matrix as an aligned grid; ``[j=k]`` marks an entry for equal lanes only."""
    grid = [["", *(slot_text(col) or "." for col in cols)]]
    for r, row in enumerate(rows):
        cells = [_text_cell(full.get((r, c), sp.S.Zero), own.get((r, c))) for c in range(len(cols))]
        grid.append([slot_text(row), *cells])
    widths = [max(len(line[n]) for line in grid) for n in range(len(grid[0]))]
    return "\n".join(
        "  ".join(cell.rjust(width) for cell, width in zip(line, widths, strict=True)).rstrip()
        for line in grid
    )


def _text_cell(full: sp.Expr, own: sp.Expr | None) -> str:
    if own is None or own == 0:
        return text(full)
    return f"{text(own)}[j=k]" if full == 0 else f"{text(full)} + {text(own)}[j=k]"
