"""Circuit to junction: the linear power-preserving structure of a network.

Input: a `Circuit`.  Output: a `Junction`,

    xdot = J0 E - B W + g u        z = B^T E + D^T u        y = g^T E + D W + N u

with the storage co-states E, the law outputs W and the inputs u as givens; transducer ratios are
opaque symbols.  `kirchhoff` solves the junction laws; here their answers become matrices, which are
checked to preserve power.  `loops` solves linear resistors that determine each other's flow.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import final

import sympy as sp

from piezo_sym.algebra.lanes import LaneMatrix, Slot
from piezo_sym.algebra.linear import Form
from piezo_sym.algebra.sums import Lanes
from piezo_sym.algebra.symbols import SymbolTable
from piezo_sym.errors import NetworkError
from piezo_sym.network.causality import causal_laws
from piezo_sym.network.joints import Joint, join_stores
from piezo_sym.network.kirchhoff import Laws, term_of
from piezo_sym.network.loops import Definition, Slope, loops_of
from piezo_sym.network.nodes import check_nodes
from piezo_sym.spec.circuit import Circuit
from piezo_sym.spec.elements.ports import Body, Conductor, Exchange, HeatInput


@final
@dataclass(frozen=True)
class Junction:
    """The linear structure of a network; the module's docstring has the equations."""

    circuit: Circuit  # the circuit, in the causality that the junction laws allow
    #: states, processes, ports: slots; ports are ordered by their input, then by declaration.
    states: tuple[Slot, ...]
    processes: tuple[Slot, ...]
    ports: tuple[Slot, ...]
    #: J0, B, D, g, N: matrices over them, their entries rational in the ratios, slopes and shares.
    J0: LaneMatrix
    B: LaneMatrix
    D: LaneMatrix
    g: LaneMatrix
    N: LaneMatrix
    #: slopes, shares: the symbols of resistive loops, see `Loops`.
    slopes: tuple[Slope, ...]
    shares: tuple[Definition, ...]
    joints: tuple[Joint, ...]  # the groups of stores that were joined into the states of some
    #: Across_1 (of a transformer: through_1) and across_2 of each coupling, over the co-states E,
    #: the law outputs W, the inputs u, and the rates "R" of followers.
    couplings: Mapping[str, LaneMatrix]
    #: The divisors of the solution; the structure exists where none is zero.
    divisors: tuple[sp.Expr, ...]


def junction_of(circuit: Circuit, symbols: SymbolTable) -> Junction:
    """Return the solved junction structure of a circuit.

    Raises `NetworkError` if the junction laws have no, or more than one, solution; names the
    elements at fault.
    """
    check_nodes(circuit)
    laws = causal_laws(circuit, symbols)
    blocks = _Blocks(laws, Lanes(symbols.banks, symbols.counts))
    return blocks.junction()


@final
class _Blocks:
    """The answers of the junction laws, sorted into matrices.

    A row is a branch's answer, a column a given.  Kinds of both: "E" (states), "W" (processes), "u"
    (ports), "R" (rates of followers, which disappear as they are joined).  Rows "C" are couplings.
    """

    def __init__(self, laws: Laws, lanes: Lanes) -> None:
        self.laws, self.lanes = laws, lanes
        self.slots = {
            "E": tuple(Slot(port.state, placed.bank) for placed, port in laws.states),
            "W": tuple(Slot(placed.element, placed.bank) for placed, _ in laws.processes),
            "u": tuple(Slot(placed.element) for placed, _ in laws.ports),
            "R": tuple(Slot(placed.element) for placed, _ in laws.followers),
            "C": tuple(Slot(port.name) for port in laws.ratio for _ in range(2)),
        }
        # y*u is put in: the current through a voltage source flows out at its first node
        self.signs = {edge.key: -edge.sign for edge in laws.edges if edge.key[0] == "u"}
        bodies = (n for n, (_, port) in enumerate(laws.states) if isinstance(port, Body))
        self.rows = {laws.states[n][0].element: n for n in bodies}  # each body's entropy
        # conduction takes entropy from its first body, and heat inputs bring it into theirs
        processes, ports = enumerate(laws.processes), enumerate(laws.ports)
        self.cooled = {n: p.first for n, (_, p) in processes if isinstance(p, Conductor)}
        self.warmed = {n: p.body for n, (_, p) in ports if isinstance(p, Exchange | HeatInput)}

    def junction(self) -> Junction:
        """Return the junction, having checked that it preserves power."""
        J0, N = self._block("E", "E"), self._block("u", "u")
        B, g, D = -self._block("E", "W"), self._block("E", "u"), self._block("u", "W")
        M = self._block("W", "W")
        zeros = (
            B - self._block("W", "E").T,
            g - self._block("u", "E").T,
            D - self._block("W", "u").T,
            M + M.T,
            self._block("E", "R") + self._block("R", "E").T,
            *(self._block("R", kind) for kind in "WuR"),
            *(self._block(kind, "R") for kind in "Wu"),
        )
        if not all(difference.is_zero for difference in zeros):
            what = "the junction laws do not preserve power"
            raise NetworkError(what, "network", remedy="report this spec: it shows a fault here")
        circuit, joints = join_stores(self.laws)
        loops = loops_of(self.laws, M)
        B, D = loops.columns(B), loops.columns(D)
        used = {
            symbol for block in (B, D) for e in block.full.values() for symbol in e.free_symbols
        }
        divisors = map(self.laws.expression, self.laws.divisors)
        return Junction(
            circuit=circuit,
            states=self.slots["E"],
            processes=self.slots["W"],
            ports=self.slots["u"],
            J0=J0 - loops.between(B, B),
            B=self._with_entropies(B, self.cooled),
            D=D,
            g=self._with_entropies(g - loops.between(B, D), self.warmed),
            N=N + loops.between(D, D),
            slopes=loops.slopes,
            shares=tuple(share for share in loops.shares if share[0] in used),
            joints=joints,
            couplings={kind: self._block("C", kind) for kind in "EWuR"},
            divisors=tuple(dict.fromkeys((*divisors, *loops.divisors))),
        )

    def _block(self, row: str, col: str) -> LaneMatrix:
        """Return the matrix of one kind of answers over one kind of givens.

        Rows "u" are outputs y, signed so that y*u is the power put in.
        """
        parts: tuple[dict[tuple[int, int], sp.Expr], dict[tuple[int, int], sp.Expr]] = ({}, {})
        for (kind, r), answer in self.laws.answers.items():
            if kind == row:
                sign = self.signs.get((kind, r), 1)
                for part, form in zip(parts, answer, strict=True):
                    part.update(self._entries(r, col, form, sign))
        return LaneMatrix(self.slots[row], self.slots[col], self.lanes, parts[0], parts[1])

    def _entries(self, row: int, col: str, form: Form, sign: int) -> dict[tuple[int, int], sp.Expr]:
        terms = [(*term_of(label), coefficient) for label, coefficient in form.items()]
        return {(row, n): sign * self.laws.expression(c) for kind, n, c in terms if kind == col}

    def _with_entropies(self, matrix: LaneMatrix, bodies: Mapping[int, str]) -> LaneMatrix:
        """Return B or g with a 1 in each column of `bodies`, in the row of its body's entropy."""
        ones = {(self.rows[body], n): sp.S.One for n, body in bodies.items()}
        return replace(matrix, full={**matrix.full, **ones})
