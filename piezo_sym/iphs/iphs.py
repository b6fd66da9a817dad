"""The irreversible port-Hamiltonian system of a model, as mathematics to read, prove and print.

Input: a `Circuit` and its junction.  Output: an `IPHS`: Definition 1 in named co-states (`system`),
the definition of each name (`definitions`), the energy U, and everything as functions of state,
inputs and parameters, which is what most users look at.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeAlias, final

import sympy as sp

from piezo_sym.algebra.lanes import LaneMatrix, vector
from piezo_sym.algebra.notation import slot_text, text
from piezo_sym.algebra.symbols import SymbolTable, symbol_table
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import Expr
from piezo_sym.iphs.definitions import (
    Energy,
    check_stops,
    costate_name,
    energies_of,
    laws_of,
    rates_of,
    ratios_of,
    starts_of,
    system_of,
)
from piezo_sym.iphs.reading import Pairs, Reading, document, equations_latex
from piezo_sym.iphs.system import System
from piezo_sym.network import Junction, junction_of
from piezo_sym.spec.circuit import Circuit, circuit_of
from piezo_sym.spec.elements.ports import Body, Conductor, DissipativePort, Storage
from piezo_sym.spec.model import Model
from piezo_sym.spec.tables import banks
from piezo_sym.spec.unroll import unroll

Matrix: TypeAlias = "sp.ImmutableMatrix | LaneMatrix"


@final
@dataclass(frozen=True)
class Process:
    """One irreversible process: a dissipative element and the body that it heats.

    Attributes
    ----------
    name, bank : the element, and its bank if it stands for one per lane.
    body : the thermal mass it heats.
    J : its skew structure matrix; for a bank that of lane j, ``J.explicit(counts, lane=j)``.
    bracket : {S, U}_J, which is its driving force z where no input drives it directly.
    R : its modulating function W/T, eq. (4).
    gamma : R/z = W/(T z), z being the bracket plus the terms of inputs; 0/0 at z = 0, where only R
        is used.
    """

    name: str
    bank: str | None
    body: str
    J: Matrix
    bracket: sp.Expr
    R: sp.Expr
    gamma: sp.Expr


def _matrix(name: str, doc: str) -> cached_property[Matrix]:
    """Return a property of an `IPHS`: a matrix of its `system` as a function of states."""

    def matrix(iphs: IPHS) -> Matrix:
        return iphs.written_out(getattr(iphs.system, name))

    matrix.__doc__ = doc
    return cached_property(matrix)


@final
@dataclass(frozen=True, repr=False)
class IPHS:
    """An irreversible port-Hamiltonian system, eqs. (1)-(5) of the paper.

    Attributes
    ----------
    model, circuit, symbols : its origin, and the symbols of its names.
    system : Definition 1 in named co-states.
    junction : the solved network, the origin of the matrices of `system`.
    energies : the terms of U, each of one store or of several that share one.
    starts : the initial value of each state, one per lane of a bank.
    laws, rates, shares, slopes, ratios, costates : definitions of the names in `system`, as
        (symbol, expression).

    Vectors and matrices are SymPy matrices, or `LaneMatrix` where a bank keeps its size a symbol;
    `expand` gives explicit ones.
    """

    model: Model
    circuit: Circuit
    symbols: SymbolTable
    junction: Junction
    system: System
    energies: tuple[Energy, ...]
    starts: tuple[tuple[Expr, ...], ...]
    laws: Pairs
    rates: Pairs
    shares: Pairs
    slopes: Pairs
    ratios: Pairs
    costates: Pairs

    @cached_property
    def x(self) -> Matrix:
        """State vector, n by 1."""
        names = {n: self.symbols[slot.label] for n, slot in enumerate(self.system.states)}
        return self.written_out(vector(self.system.states, self.system.E.lanes, names))

    u = _matrix(
        "u", "Inputs of Definition 1, one per port; a heat exchange enters as lam*(T_e/T - 1)."
    )

    @cached_property
    def U(self) -> sp.Expr:
        """Hamiltonian: the stored energy [J], eq. (6)."""
        return sp.Add(*self._stored)

    @cached_property
    def _stored(self) -> tuple[sp.Expr, ...]:
        """The terms of U, summed over the lanes of a bank."""
        sums, terms = self.system.E.lanes.sum, []
        for energy in self.energies:
            term = self.symbols.law(energy.law, {})
            terms.append(sums(term, energy.bank) if energy.bank else term)
        return tuple(terms)

    @cached_property
    def S(self) -> sp.Expr:
        """Total entropy [J/K]: the sum of the bodies' entropies."""
        rows = zip(self.system.states, self.system.dS, strict=True)
        return sp.Add(*(self.symbols[slot.label] for slot, one in rows if one != 0))

    E = _matrix("E", "Co-states dU/dx, n by 1.")
    J0 = _matrix("J0", "Structure matrix of the energy-preserving elements, n by n, eq. (15).")
    J_ir = _matrix("J_ir", "Structure matrix J0 + sum_k R_k J_k, n by n, eq. (3).")
    g = _matrix("g", "Input map, n by ports.")
    rhs = _matrix("rhs", "Rates dx/dt, n by 1, eq. (1).")
    y = _matrix("y", "Outputs conjugate to u, ports by 1, eq. (2).")
    y_s = _matrix("y_s", "Entropy-conjugate outputs g^T dS/dx, ports by 1, eq. (5).")

    @cached_property
    def sigma(self) -> sp.Expr:
        """Internal entropy production [W/K], eq. (7)."""
        return self.in_states(self.system.sigma)

    @cached_property
    def processes(self) -> tuple[Process, ...]:
        """The irreversible processes, in declaration order."""
        return tuple(self._process(k) for k in range(len(self.system.processes)))

    def _process(self, k: int) -> Process:
        system, slot = self.system, self.system.processes[k]
        body = next(
            placed.element
            for placed, port in self.circuit.of(Body)
            if port.state == system.states[system.heats[k]].label
        )
        R, z = system.R[k, 0], system.z[k, 0]
        bracket = self.in_states(system.bracket[k, 0])
        parts = (self.written_out(system.J(k)), bracket, self.in_states(R), self.in_states(R / z))
        return Process(slot.label, slot.bank, body, *parts)

    def in_states(self, expr: sp.Expr) -> sp.Expr:
        """Return an expression of `system` as a function of states, inputs and parameters."""
        for definitions in (*self.named, self.costates):
            expr = expr.xreplace(dict(definitions))
        return expr

    @property
    def named(self) -> tuple[Pairs, ...]:
        """The definitions without those of co-states, in the order of their insertion.

        Laws come twice, as the rate of a slip depends on the laws of other processes.
        """
        return (self.laws, self.rates, self.laws, self.shares, self.slopes, self.ratios)

    def written_out(self, matrix: LaneMatrix) -> Matrix:
        """Return a matrix of `system` as functions of states; explicit if there is no bank."""
        matrix = matrix.map(self.in_states)
        return matrix if banks(self.model) else matrix.explicit({})

    def expand(self, counts: Mapping[str, int] | None = None) -> IPHS:
        """Return the system derived anew with each lane as an element ``<bank>_<j>``.

        Sizes of banks are from `counts`, else the spec's own.  Its matrices are SymPy matrices.
        """
        circuit = circuit_of(unroll(self.model, {**banks(self.model), **(counts or {})}))
        symbols = symbol_table(circuit)
        return iphs_of(symbols, junction_of(circuit, symbols))

    def __repr__(self) -> str:
        """Return one line: the model, its states and its processes."""
        states = ", ".join(slot_text(slot) for slot in self.system.states)
        processes = ", ".join(slot_text(slot) for slot in self.system.processes)
        return f"<IPHS {self.model.name}: x = ({states}); processes {processes or 'none'}>"

    def _repr_latex_(self) -> str:
        return f"$\\displaystyle {equations_latex(self.reading)}$"

    @cached_property
    def reading(self) -> Reading:
        """The system for display: co-states written out, laws and temperatures by their names."""
        hot = {self.symbols[port.temperature] for _, port in self.circuit.of(Body)}
        written = tuple((s, e) for s, e in self.costates if s not in hot)
        temperatures = tuple((s, e) for s, e in self.costates if s in hot)
        symbols = replace(self.symbols, keep_tables=True)
        laws = laws_of(self.circuit, symbols, self.system)
        ratios = ratios_of(self.circuit, symbols)
        named = (*laws, *self.rates, *self.shares, *self.slopes, *ratios, *temperatures)
        return Reading(self.system, self._stored, written, named, self._spelled(dict(written)))

    def _spelled(self, written: Mapping[sp.Symbol, sp.Expr]) -> dict[sp.Symbol, str]:
        """Return each dissipative law as the spec spells it, with the definition of its letter."""
        spelled = {}
        processes = self.circuit.of(DissipativePort, Conductor)
        for (_, port), z in zip(processes, self.system.z, strict=True):
            if isinstance(port, Conductor):
                continue
            effort = f"{port.letter} = {text(z.xreplace(written))}"
            rate = f", {port.rate_letter} = {port.rate}" if port.rate else ""
            spelled[self.symbols[port.output]] = f"{spell(port.law)}, {effort}{rate}"
        return spelled

    def latex(self) -> str:
        """Return LaTeX of x, S, co-states, J0, each J_k, bracket, R_k, gamma_k, J_ir, g, u, y."""
        return document(self.reading)


def iphs_of(symbols: SymbolTable, junction: Junction) -> IPHS:
    """Return the IPHS of a solved network: its junction, and the laws of its elements.

    Raises `SpecError` if a storage law has no energy in closed form.  Raises `NetworkError` if a
    stop's rate depends on the effort of a stop.
    """
    circuit = junction.circuit
    system = system_of(circuit, symbols, junction)
    laws = tuple(laws_of(circuit, symbols, system))
    rates = tuple(rates_of(circuit, symbols, system))
    check_stops(circuit, symbols, rates, laws)
    return IPHS(
        model=circuit.model,
        circuit=circuit,
        symbols=symbols,
        junction=junction,
        system=system,
        energies=energies_of(circuit),
        starts=tuple(starts_of(junction)),
        laws=laws,
        rates=rates,
        shares=junction.shares,
        slopes=tuple((slope.symbol, symbols.law(slope.law, {})) for slope in junction.slopes),
        ratios=tuple(ratios_of(circuit, symbols)),
        costates=tuple(
            (symbols[costate_name(port)], symbols.law(port.law, {}))
            for _, port in circuit.of(Storage, Body)
        ),
    )
