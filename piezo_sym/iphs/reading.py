"""The display of a system: rates and laws term by term, in LaTeX or plain text.

Input: a `System`, its names that are written out (velocities as p/M), and those that are defined
below the equations (laws, ratios, temperatures).  Output: text, one equation per line.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import final

import sympy as sp

from piezo_sym.algebra.lanes import LaneMatrix
from piezo_sym.algebra.notation import joined, latex, matrix_latex, slot_text, symbol_latex, text
from piezo_sym.algebra.symbols import TABLE
from piezo_sym.iphs.system import System

BRANCHED = (sp.Piecewise, TABLE)
Pairs = tuple[tuple[sp.Symbol, sp.Expr], ...]
Print = Callable[[sp.Expr], str]


@final
@dataclass(frozen=True)
class Reading:
    """A system with what its display needs."""

    system: System  # in named co-states
    energies: tuple[sp.Expr, ...]  # the terms of the Hamiltonian, as functions of the state
    written: Pairs  # names replaced by their definitions, such as a velocity by p/M
    named: Pairs  # names kept, and defined after the equations
    #: The definition of a law output as the spec spells it, for plain text.
    spelled: Mapping[sp.Symbol, str]

    def write(self, expr: sp.Expr) -> sp.Expr:
        """Return `expr` with the written-out names replaced."""
        return expr.xreplace(dict(self.written))

    def rates(self, row: int) -> list[sp.Expr]:
        """Return the terms of one rate: from J0, then from processes, then from inputs."""
        system = self.system
        terms = [
            *_terms(system.J0, system.E, row),
            *_terms(-system.B, system.W, row),
            *(self._heating(k) for k, entropy in enumerate(system.heats) if entropy == row),
            *_terms(system.G, system.u, row),
        ]
        return [self.write(term) for term in terms]

    def outputs(self, port: int) -> list[sp.Expr]:
        """Return the terms of one output."""
        system = self.system
        terms = [
            *_terms(system.G.T, system.E, port),
            *_terms(system.D, system.W, port),
            *_terms(system.N, system.u, port),
        ]
        return [self.write(term) for term in terms]

    def productions(self) -> list[sp.Expr]:
        """Return the terms of the internal entropy production, one per process."""
        R, z = self.system.R, self.system.z
        return [self.write(self._total(k, r * z[k, 0])) for k, r in enumerate(R)]

    def gamma(self, k: int) -> sp.Expr:
        """Return gamma_k = W_k/(T z_k), with the law written out unless it has branches."""
        outputs = set(self.system.W)
        laws = {s: e for s, e in self.named if s in outputs and not e.has(*BRANCHED)}
        return self.write(self.system.R[k, 0].xreplace(laws) / self.system.z[k, 0])

    def _heating(self, k: int) -> sp.Expr:
        """Return a process's term in the entropy rate of the body that it heats."""
        return self._total(k, self.system.R[k, 0] * self.system.drive[k, 0])

    def _total(self, k: int, term: sp.Expr) -> sp.Expr:
        bank = self.system.processes[k].bank
        return self.system.E.lanes.sum(term, bank) if bank else term


def _terms(block: LaneMatrix, given: LaneMatrix, row: int) -> Iterator[sp.Expr]:
    """Yield the terms of ``(block @ given)[row]`` without expanding products."""
    for c, full, own in block.by_row.get(row, ()):
        value, bank = given[c, 0], block.cols[c].bank
        if full != 0:
            yield block.lanes.sum(full * value, bank) if bank else full * value
        if own != 0:
            yield own * value


def equations(
    reading: Reading, write: Print, name: Callable[[str], str], dot: str
) -> list[tuple[str, str]]:
    """Return (left side, right side) of every equation: U, rates, outputs, sigma, names."""
    system = reading.system

    def total(terms: list[sp.Expr]) -> str:
        return joined(write(term) for term in terms)

    found = [("U", total(list(reading.energies)))]
    for n, slot in enumerate(system.states):
        found.append((dot.format(name(slot_text(slot))), total(reading.rates(n))))
    for n, slot in enumerate(system.ports):
        found.append((name(f"y_{slot.label}"), total(reading.outputs(n))))
    found.append((name("sigma"), total(reading.productions())))
    return found


def equations_latex(reading: Reading) -> str:
    """Return the whole system as one aligned block of LaTeX."""
    pairs = equations(reading, latex, symbol_latex, r"\dot{{{}}}")
    pairs += [(latex(symbol), latex(reading.write(expr))) for symbol, expr in reading.named]
    lines = " \\\\\n".join(f"{left} &= {right}" for left, right in pairs)
    return f"\\begin{{aligned}}\n{lines}\n\\end{{aligned}}"


def equations_text(reading: Reading) -> list[tuple[str, str]]:
    """Return every equation as plain text, (left side, right side)."""
    pairs = equations(reading, text, str, "d{}/dt")
    for symbol, expr in reading.named:
        pairs.append((text(symbol), reading.spelled.get(symbol) or text(reading.write(expr))))
    return pairs


def document(reading: Reading) -> str:
    """Return LaTeX of everything in Definition 1, one displayed formula each."""
    system = reading.system

    def vector(matrix: LaneMatrix) -> str:
        shown = matrix.map(reading.write)
        return matrix_latex(shown.rows, shown.cols, shown.full, shown.own)

    rows = zip(system.states, system.dS, strict=True)
    entropies = [symbol_latex(slot.label) for slot, one in rows if one != 0]
    names = [symbol_latex(slot_text(slot)) for slot in system.states]
    total = [rf"S_{{\mathrm{{total}}}} = {joined(entropies)}"] if len(entropies) > 1 else []
    driven = [
        f"g = {vector(system.g)}",
        f"u = {vector(system.u)}",
        f"y = g^T \\frac{{\\partial U}}{{\\partial x}} = {vector(system.y)}",
        f"y_s = g^T \\frac{{\\partial S}}{{\\partial x}} = {vector(system.y_s)}",
    ]
    displays = [
        rf"x = \left({', '.join(names)}\right)^T",
        *total,
        rf"\frac{{\partial U}}{{\partial x}} = {vector(system.E)}",
        f"J_0 = {vector(system.J0)}",
        *(line for k in range(len(system.processes)) for line in _process(reading, k, vector)),
        rf"J_{{ir}} = J_0 + \sum_k R_k J_k = {vector(system.J_ir)}",
        *(driven if system.ports else ()),
        equations_latex(reading),
    ]
    return "\n\n".join(f"\\[\n{display}\n\\]" for display in displays)


def _process(reading: Reading, k: int, vector: Callable[[LaneMatrix], str]) -> Iterator[str]:
    system = reading.system
    slot = system.processes[k]
    index = symbol_latex(f"J_{slot_text(slot)}").removeprefix("J")
    bracket = reading.write(system.bracket[k, 0])
    yield f"J{index} = {vector(system.J(k))}"
    yield rf"\{{S, U\}}_{{J{index}}} = {latex(bracket)}"
    yield rf"R{index} = {latex(reading.write(system.R[k, 0]))}"
    yield rf"\gamma{index} = {latex(reading.gamma(k))}"
