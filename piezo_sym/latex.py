"""Mathematics as LaTeX, in the paper's notation: sums over j kept, terms in the order of the states.

Input: a `Reading` of a system: which names are written out and which are explained below.  Output:
LaTeX text, the same for every version of SymPy as far as SymPy's own printer allows.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import final

import sympy as sp

from piezo_sym.lanes import LaneMatrix, Slot
from piezo_sym.system import System

#: Letters that users spell in ASCII because the Greek one is a keyword.
SPELLINGS = {"lam": r"\lambda"}
Pairs = tuple[tuple[sp.Symbol, sp.Expr], ...]


@final
@dataclass(frozen=True)
class Reading:
    """How a system is read.

    Attributes
    ----------
    system : in named co-states.
    U : the Hamiltonian, as a function of the state.
    written : names replaced by what they stand for, such as p/M for the velocity.
    named : names kept, and explained after the equations: laws, ratios, temperatures.
    """

    system: System
    U: sp.Expr
    written: Pairs
    named: Pairs

    def write(self, expr: sp.Expr) -> sp.Expr:
        """Return `expr` with the written-out names replaced."""
        return expr.xreplace(dict(self.written))


def latex(expr: sp.Expr) -> str:
    """Return one expression as LaTeX."""
    names = {s: _symbol(s.name) for s in expr.free_symbols}
    return str(sp.latex(expr, symbol_names=names, fold_short_frac=False))


def _symbol(name: str) -> str:
    """Return a name as LaTeX: ``phi_j`` with its index, ``V_hysteron_j`` with two."""
    head, *rest = name.split("_")
    letter = SPELLINGS.get(head, sp.latex(sp.Symbol(head)) if len(head) > 1 else head)
    if not rest:
        return letter
    labels = [part if len(part) == 1 or part.isdigit() else rf"\mathrm{{{part}}}" for part in rest]
    return f"{letter}_{{{','.join(labels)}}}"


def joined(terms: Iterable[sp.Expr]) -> str:
    """Return terms joined by their signs, in the order given."""
    text = ""
    for term in terms:
        piece = latex(term)
        negative = piece.startswith("-")
        sign = "- " if negative else "+ " if text else ""
        text += f" {sign}{piece[1:].strip() if negative else piece}"
    return text.strip() or "0"


def rows_latex(reading: Reading) -> list[str]:
    """Return the rows of eq. (1), ``\\dot{x} = ...``, one a state."""
    system = reading.system
    return [
        rf"\dot{{{_label(slot)}}} = {joined(_row_terms(reading, n))}"
        for n, slot in enumerate(system.states)
    ]


def _row_terms(reading: Reading, row: int) -> list[sp.Expr]:
    """Return the terms of one rate: structure in state order, then processes, then inputs."""
    system = reading.system
    blocks = ((system.J0, system.E), (-system.B, system.W), (system.G, system.u))
    terms = [term for block, given in blocks for term in _products(block, given, row)]
    terms += [
        term
        for k, entropy in enumerate(system.heats)
        if entropy == row
        for term in _heat(system, k)
    ]
    order = [reading.write(term) for term in terms]
    heat = len(order) - len([k for k in system.heats if k == row])
    return order[heat:] + order[:heat]


def _heat(system: System, k: int) -> list[sp.Expr]:
    production = system.R[k, 0] * system.z[k, 0]
    bank = system.processes[k].bank
    return [system.E.lanes.sum(production, bank) if bank else production]


def _products(block: LaneMatrix, given: LaneMatrix, row: int) -> list[sp.Expr]:
    part = LaneMatrix(
        block.rows,
        block.cols,
        block.lanes,
        {place: entry for place, entry in block.full.items() if place[0] == row},
        {place: entry for place, entry in block.own.items() if place[0] == row},
    )
    found = []
    for col in range(len(block.cols)):
        one = LaneMatrix(given.rows, given.cols, given.lanes, _only(given, col))
        entry = (part @ one)[row, 0]
        if entry != 0:
            found.append(entry)
    return found


def _only(given: LaneMatrix, row: int) -> dict[tuple[int, int], sp.Expr]:
    return {place: entry for place, entry in given.full.items() if place[0] == row}


def _label(slot: Slot) -> str:
    return _symbol(f"{slot.label}_j" if slot.bank else slot.label)


def matrix_latex(matrix: LaneMatrix, write: Mapping[sp.Symbol, sp.Expr] | None = None) -> str:
    """Return a matrix as LaTeX; a bank's rows and columns stand for j = 1..r, with dots."""
    rows = []
    for r, row in enumerate(matrix.rows):
        cells = [_cell(matrix, r, c, write or {}) for c in range(len(matrix.cols))]
        line = [piece for c, cell in enumerate(cells) for piece in _dotted(matrix.cols[c], cell)]
        rows.append(" & ".join(line))
        if row.bank:
            dots = [d for c in matrix.cols for d in ((r"\vdots", r"\ddots", r"\vdots") if c.bank else (r"\vdots",))]
            rows += [" & ".join(dots), " & ".join(line)]
    return "\\begin{bmatrix} " + " \\\\ ".join(rows) + " \\end{bmatrix}"


def _dotted(col: Slot, cell: str) -> tuple[str, ...]:
    return (cell, r"\cdots", cell) if col.bank else (cell,)


def _cell(matrix: LaneMatrix, r: int, c: int, write: Mapping[sp.Symbol, sp.Expr]) -> str:
    full = matrix.full.get((r, c), sp.S.Zero).xreplace(dict(write))
    own = matrix.own.get((r, c), sp.S.Zero).xreplace(dict(write))
    if own == 0:
        return latex(full)
    delta = r"\delta_{jk}" if own == 1 else rf"{latex(own)}\,\delta_{{jk}}"
    return delta if full == 0 else f"{latex(full)} + {delta}"


def equations_latex(reading: Reading) -> str:
    """Return the whole system: U, the rates, and what their names stand for."""
    lines = [f"U &= {joined(_terms(reading.U))}"]
    lines += [row.replace(" = ", " &= ", 1) for row in rows_latex(reading)]
    lines += [f"{latex(s)} &= {latex(reading.write(e))}" for s, e in reading.named]
    return "\\begin{aligned} " + " \\\\ ".join(lines) + " \\end{aligned}"


def _terms(expr: sp.Expr) -> list[sp.Expr]:
    return list(sp.Add.make_args(expr))
