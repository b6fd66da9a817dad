"""Linear resistors that determine each other's flow, solved together.

Input: a junction whose driving forces depend on law outputs, z = K^T c + M W with c = (E, u),
K = (B, D) and M skew.  Output: the same junction without M.  With W = G z, G the slopes of the
laws, and H = (I - M G)^-1,

    z = H K^T c = K'^T c        K' = K H^T        G H = H^T G H + H^T (G M G) H,

so each process keeps its own z and W = G z, and the skew part K' (G M G) K'^T goes to J0, g and
N.  The entries of H have names (`shares`): both balances close whatever their values are.
Where every slope is >= 0, det(I - M G) >= 1, for it is a sum of squares of Pfaffians of M times
products of slopes, that of the empty set being 1.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import final

import sympy as sp
from sympy.polys.matrices import DomainMatrix
from sympy.utilities.iterables import connected_components

from piezo_sym.algebra.lanes import LaneMatrix
from piezo_sym.errors import NetworkError, listing, quote, with_article
from piezo_sym.expressions.tree import Expr
from piezo_sym.network.inverse import slope_of
from piezo_sym.network.kirchhoff import Laws
from piezo_sym.network.nodes import beside_chain, is_reference
from piezo_sym.spec.elements import kind_of
from piezo_sym.spec.elements.domains import PowerVariable
from piezo_sym.spec.elements.ports import DissipativePort
from piezo_sym.spec.names import fresh

#: The most resistors in one loop; the solution of more would have thousands of terms.
MOST = 8

Definition = tuple[sp.Symbol, sp.Expr]


@final
@dataclass(frozen=True)
class Slope:
    """The slope of a law in a loop: its symbol, its process, and its law in temperatures."""

    symbol: sp.Symbol
    process: int
    law: Expr


@final
@dataclass(frozen=True)
class Loops:
    """All resistive loops of a network, solved."""

    #: Shares of the driving forces, processes by processes; the identity without loops.
    H: LaneMatrix
    skew: LaneMatrix  # the matrix G M G, processes by processes
    slopes: tuple[Slope, ...]  # of each process in a loop
    #: The symbol of each entry of H that is no number, and its value in slopes and ratios.
    shares: tuple[Definition, ...]
    divisors: tuple[sp.Expr, ...]  # the determinants that H divides by

    def columns(self, K: LaneMatrix) -> LaneMatrix:
        """Return K', for the columns K (B or D) of the processes."""
        return K @ self.H.T

    def between(self, left: LaneMatrix, right: LaneMatrix) -> LaneMatrix:
        """Return the skew part K' (G M G) K'^T between two blocks of K' (B or D)."""
        return left @ self.skew @ right.T


def loops_of(laws: Laws, M: LaneMatrix) -> Loops:
    """Return the solved loops of a network in which z = K^T c + M W.

    Raises `NetworkError` if a law in a loop is not linear, or a loop has too many resistors; names
    them.
    """
    groups = _groups(M)
    taken = set(laws.circuit.names)
    found = [slope for group in groups for slope in _slopes(laws, group, taken)]
    slopes = {slope.process: slope.symbol for slope in found}
    shares: list[Definition] = []
    divisors: list[sp.Expr] = []
    H = {(k, k): sp.S.One for k, slot in enumerate(M.rows) if slot.bank is None}
    for group in groups:
        inverse, divisor = _loop_inverse(M, group, slopes)
        divisors.append(divisor)
        for (row, col), value in inverse.items():
            base = f"share_{M.rows[row].label}_{M.rows[col].label}"
            H[row, col] = value if value.is_number else _symbol(base, taken)
            shares += [] if value.is_number else [(H[row, col], value)]
    own = {(k, k): sp.S.One for k, slot in enumerate(M.rows) if slot.bank}
    skew = {(r, c): slopes[r] * entry * slopes[c] for (r, c), entry, _ in M.entries()}
    return Loops(
        H=LaneMatrix(M.rows, M.rows, M.lanes, H, own),
        skew=LaneMatrix(M.rows, M.rows, M.lanes, skew),
        slopes=tuple(found),
        shares=tuple(shares),
        divisors=tuple(divisors),
    )


def _symbol(base: str, taken: set[str]) -> sp.Symbol:
    name = fresh(base, taken)
    taken.add(name)
    return sp.Symbol(name, real=True)


def _groups(M: LaneMatrix) -> list[tuple[int, ...]]:
    """Return the processes that depend on each other, group by group, in declaration order."""
    pairs = [pair for pair, _, _ in M.entries()]
    groups = connected_components(({k for pair in pairs for k in pair}, pairs))
    return sorted(tuple(sorted(group)) for group in groups)


def _slopes(laws: Laws, group: tuple[int, ...], taken: set[str]) -> Iterator[Slope]:
    """Yield the slopes of a loop; refuse nonlinear laws, and too many laws."""
    members = [laws.processes[k] for k in group]
    names = listing(quote(placed.element) for placed, _ in members)
    what = f"{names} determine each other's flow"
    resistors = {placed.element: p for placed, p in members if isinstance(p, DissipativePort)}
    between = _between(resistors, next(iter(resistors)))
    if len(group) > MOST:
        remedy = f"join those in series or in parallel, or {between}"
        raise NetworkError(what, "network", f"at most {MOST} that do", remedy)
    for k, (placed, port) in zip(group, members, strict=True):
        law = None
        if isinstance(port, DissipativePort) and not placed.bank:
            law = slope_of(port.law, port.letter)
        if law is None:
            between = _between(resistors, placed.element)
            chain = beside_chain(laws.circuit, resistors)
            remedy = chain or between if placed.bank else f"{between}, or make the law linear"
            expected = "linear laws, and none of a bank" if placed.bank else "linear laws"
            raise NetworkError(what, f"elements.{placed.element}", expected, remedy)
        yield Slope(_symbol(f"slope_{placed.element}", taken), k, law)


def _between(resistors: Mapping[str, DissipativePort], one: str) -> str:
    """Return the advice to put a store where `one` of some resistors meets the others."""
    own, nodes = resistors.get(one, next(iter(resistors.values()))), set[str]()
    for element, port in resistors.items():
        if element != one and port.domain == own.domain:
            nodes |= {node for node in port.branch if node in own.branch and not is_reference(node)}
    store = kind_of("store", own.domain, PowerVariable.ACROSS)
    at = f"at node '{nodes.pop()}'" if len(nodes) == 1 else "at the node between them"
    return f"put {with_article(store)} {at}"


def _loop_inverse(
    M: LaneMatrix, group: tuple[int, ...], slopes: dict[int, sp.Symbol]
) -> tuple[dict[tuple[int, int], sp.Expr], sp.Expr]:
    """Return the entries of (I - M G)^-1 of one group, and its determinant."""
    size = range(len(group))
    place = {k: n for n, k in enumerate(group)}
    entries = {(place[r], place[c]): -e * slopes[c] for (r, c), e, _ in M.entries() if r in place}
    matrix = sp.Matrix(len(group), len(group), lambda r, c: int(r == c) + entries.get((r, c), 0))
    solved = DomainMatrix.from_Matrix(matrix).to_field()
    inverse = solved.inv().to_Matrix()
    found = {(group[r], group[c]): inverse[r, c] for r in size for c in size}
    divisor = solved.domain.to_sympy(solved.det())
    return {place: value for place, value in found.items() if value != 0}, sp.expand(divisor)
