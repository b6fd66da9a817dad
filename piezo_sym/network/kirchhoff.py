"""Kirchhoff's and Newton's laws as exact equations, solved for banks of any size.

Input: a `Circuit`.  Output: for each branch, the variable it does not impose, as a combination of
co-states E, law outputs W and inputs u.  All that is used of an element is which variable, across
or through, each of its branches imposes.  A bank is one representative lane, whose own unknowns are
eliminated first.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any, final

import sympy as sp
from sympy.polys.domains import QQ

from piezo_sym.algebra.linear import Equation, Form, LongError, accumulate, combine, solve
from piezo_sym.algebra.symbols import SymbolTable
from piezo_sym.errors import NetworkError
from piezo_sym.network.nodes import inner_nodes, is_reference
from piezo_sym.spec.circuit import Circuit, Placed, lane_ends
from piezo_sym.spec.elements.domains import PowerVariable
from piezo_sym.spec.elements.ports import (
    Body,
    Branch,
    Conductor,
    Coupling,
    DissipativePort,
    Exchange,
    HeatInput,
    Source,
    Storage,
)

#: Coefficients combined in a solution, times the number of ratios: about half a minute.
MOST_WORK = 20_000_000

#: The answer of a branch: the part equal in all lanes, and the part in its own lane's givens.
Answer = tuple[Form, Form]
#: A port of an input.
Driven = Source | Exchange | HeatInput
#: A port that imposes a variable on a branch.
Imposing = Storage | DissipativePort | Source | Body


@final
@dataclass(frozen=True)
class Edge:
    """A branch in the junction laws.

    `key` is the given that it imposes, such as ``("E", 2)`` ("R": the rate of a follower); the
    through variable, where it is unknown, has the label ``("t", key)``.
    """

    placed: Placed
    port: Imposing
    branch: Branch
    imposes: PowerVariable
    key: tuple[str, int]
    sign: int


def term_of(label: Any) -> tuple[str, Any]:
    """Return the (kind, index) of a given, or of the given that a sum over lanes has."""
    kind, index = label[1] if label[0] == "sum" else label
    return kind, index


def port_order(circuit: Circuit) -> tuple[tuple[Placed, Driven], ...]:
    """Return the ports driven by inputs, in the order of the inputs, then of declaration."""
    inputs = list(circuit.model.inputs)
    driven = [(p, p.port) for p in circuit.ports if isinstance(p.port, Driven)]
    return tuple(sorted(driven, key=lambda pair: inputs.index(pair[1].input)))


@final
class Laws:
    """The junction laws of one circuit, and their solution.

    `followers` are the states of the stores that impose their rate, not their co-state.
    """

    def __init__(
        self, circuit: Circuit, symbols: SymbolTable, followers: frozenset[str] = frozenset()
    ) -> None:
        self.circuit, self.symbols = circuit, symbols
        self.banks = tuple(symbols.counts)
        couplings = [port for _, port in circuit.of(Coupling)]
        letters = {port: sp.Symbol(f"ratio_{n}") for n, port in enumerate(couplings)}
        self.field = QQ.frac_field(*letters.values()) if letters else QQ
        self.ratio = {port: self.field.from_sympy(letter) for port, letter in letters.items()}
        self._names = {letter: symbols[port.name] for port, letter in letters.items()}
        self.states = tuple(s for s in circuit.of(Storage, Body) if s[1].state not in followers)
        self.followers = tuple(s for s in circuit.of(Storage) if s[1].state in followers)
        self.processes = tuple(circuit.of(DissipativePort, Conductor))
        self.ports = port_order(circuit)
        self.edges = tuple(self._edges())
        self.inner = inner_nodes(circuit)
        self.divisors: list[Any] = []

    def _edges(self) -> Iterator[Edge]:
        given = {"E": self.states, "R": self.followers, "W": self.processes, "u": self.ports}
        for kind, ports in given.items():
            for n, (placed, port) in enumerate(ports):
                branch = getattr(port, "branch", self.circuit.pumped.get(placed.element))
                if branch and isinstance(port, Imposing):
                    imposes = port.imposes.other if kind == "R" else port.imposes
                    pushes = kind == "u" and imposes is PowerVariable.THROUGH  # into its first node
                    yield Edge(placed, port, branch, imposes, (kind, n), -1 if pushes else 1)

    @cached_property
    def answers(self) -> dict[tuple[str, int], Answer]:
        """The variable that each branch does not impose, by the given that it imposes.

        Coupling n has two: ("C", 2*n) is across_1 (of a transformer: through_1), ("C", 2*n + 1) is
        across_2. Raises `SingularError` if the laws have no, or more than one, solution; `refusals`
        names the elements.  Raises `NetworkError` if a bank fixes a node that it shares.
        """
        lanes = {bank: self._solve_lane(bank) for bank in self.banks}
        shared = self._solve_shared(lanes)
        found, one = dict[tuple[str, int], Answer](), self.field.one
        for edge in self.edges:
            across = edge.imposes is PowerVariable.THROUGH
            asked = _across(edge.branch, one) if across else {("t", edge.key): one}
            found[edge.key] = self._solution(asked, lanes.get(edge.placed.bank or "", {}), shared)
        for n, port in enumerate(self.ratio):
            first = _across(port.first, one) if port.gyrates else {("t", port.name): one}
            found["C", 2 * n] = self._solution(first, {}, shared)
            found["C", 2 * n + 1] = self._solution(_across(port.second, one), {}, shared)
        return found

    def expression(self, coefficient: Any) -> sp.Expr:
        """Return a coefficient as an expression in the ratios' own symbols."""
        return self.field.to_sympy(coefficient).xreplace(self._names)

    def _balances(self, bank: str | None) -> dict[str, Equation]:
        """Return the sum of through variables at each node, of a bank's or the other branches."""
        rows: dict[str, Equation] = {}
        for edge in self.edges:
            if edge.placed.bank == bank:
                through = Equation({("t", edge.key): self.field.one})
                if edge.imposes is PowerVariable.THROUGH:
                    through = Equation({}, {edge.key: edge.sign * self.field.one})
                _book(rows, edge.branch, through, self.field.one)
        if bank is None:
            for port, ratio in self.ratio.items():
                first, second = self._coupled(port, ratio)
                _book(rows, port.first, Equation(first, {}), self.field.one)
                _book(rows, port.second, Equation(second, {}), self.field.one)
        return rows

    def _coupled(self, port: Coupling, ratio: Any) -> tuple[Form, Form]:
        """Return the through variables of a coupling's two branches."""
        if port.gyrates:
            return _across(port.second, ratio), _across(port.first, -ratio)
        return {("t", port.name): self.field.one}, {("t", port.name): -ratio}

    def _constraints(self, bank: str | None) -> Iterator[Equation]:
        for edge in self.edges:
            if edge.placed.bank == bank and edge.imposes is PowerVariable.ACROSS:
                given = {edge.key: edge.sign * self.field.one}
                yield Equation(_across(edge.branch, self.field.one), given)
        for port, ratio in self.ratio.items():
            if bank is None and not port.gyrates:
                across = _across(port.first, self.field.one)
                combine(across, _across(port.second, ratio), -self.field.one)
                yield Equation(across, {})

    def _flows(self, bank: str | None) -> list[tuple[str, Any]]:
        """Return the unknown through variables of a bank's branches; None: of those in no bank."""
        own = (e for e in self.edges if e.placed.bank == bank)
        return [("t", e.key) for e in own if e.imposes is PowerVariable.ACROSS]

    def _solve_lane(self, bank: str) -> dict[Any, Form]:
        """Return one lane's own unknowns in terms of its givens and the shared nodes."""
        balances = self._balances(bank)
        if bank in self.circuit.chains:
            accumulate(balances[lane_ends(bank)[0]].right, ("s", bank), -self.field.one)
        inner = {node: row for node, row in balances.items() if node in self.inner}
        equations = [Equation(row.left, _negated(row.right)) for row in inner.values()]
        equations += list(self._constraints(bank))
        unknowns = [("e", node) for node in inner] + self._flows(bank)
        for equation in equations:  # in a lane's equations, shared nodes are givens
            for label in [label for label in equation.left if label not in unknowns]:
                accumulate(equation.right, label, -equation.left.pop(label))
        return self._solve(equations, unknowns)

    def _solve_shared(self, lanes: dict[str, dict[Any, Form]]) -> dict[Any, Form]:
        """Return the shared unknowns in terms of shared givens and of sums over lanes."""
        balances = self._balances(None)
        for bank, solution in lanes.items():
            for node, row in self._balances(bank).items():
                if node not in self.inner:
                    total = balances.setdefault(node, Equation())
                    combine(total.right, self._summed(bank, row, solution), self.field.one)
        chained = []
        for bank, ends in self.circuit.chains.items():
            _book(balances, ends, Equation({("s", bank): self.field.one}), self.field.one)
            one = Equation({("e", lane_ends(bank)[0]): self.field.one})
            fall = self._summed(bank, one, lanes[bank])
            chained.append(Equation(_across(ends, self.field.one), fall))
        equations = [Equation(row.left, _negated(row.right)) for row in balances.values()]
        equations += [*self._constraints(None), *chained]
        unknowns = [("e", node) for node in balances] + self._flows(None)
        unknowns += [("s", bank) for bank in self.circuit.chains]
        unknowns += [("t", port.name) for port in self.ratio if not port.gyrates]
        return self._solve(equations, unknowns)

    def _solve(self, equations: list[Equation], unknowns: list[Any]) -> dict[Any, Form]:
        """Return the solution of some of the laws; refuse those that take too long."""
        try:
            return solve(equations, unknowns, self.divisors, MOST_WORK // (len(self.ratio) + 3))
        except LongError as error:
            what = f"the laws of {len(self.edges)} branches and {len(self.ratio)} couplings"
            remedy = "leave elements out, or put masses and capacitors between levers and the like"
            what = f"{what} take too long to solve"
            raise NetworkError(what, "network", remedy=remedy) from error

    def _summed(self, bank: str, row: Equation, solution: dict[Any, Form]) -> Form:
        """Return the sum of a lane's combination over all lanes, in sums of givens."""
        drawn = dict(row.right)
        for label, coefficient in row.left.items():
            combine(drawn, solution.get(label, {label: self.field.one}), coefficient)
        if any(label[0] in ("e", "s") for label in drawn):
            what = f"bank '{bank}' fixes a node that it shares"
            remedy = "put an inductor or a hysteron in each lane, so that its current is a state"
            raise NetworkError(what, f"elements.{bank}", remedy=remedy)
        return {("sum", label): coefficient for label, coefficient in drawn.items()}

    def _solution(self, asked: Form, own: dict[Any, Form], shared: dict[Any, Form]) -> Answer:
        """Return a combination of unknowns in terms of givens, as (every lane, own lane)."""
        lane: Form = {}
        for label, coefficient in asked.items():
            combine(lane, own.get(label, {label: self.field.one}), coefficient)
        full: Form = {}
        for label in [label for label in lane if label in shared]:
            combine(full, shared[label], lane.pop(label))
        return full, lane


def _across(branch: Branch, factor: Any) -> Form:
    """Return ``factor*(e_a - e_b)``, the reference nodes being at zero."""
    form: Form = {}
    for node, value in zip(branch, (factor, -factor), strict=True):
        if not is_reference(node):
            accumulate(form, ("e", node), value)
    return form


def _book(rows: dict[str, Equation], branch: Branch, through: Equation, one: Any) -> None:
    """Add a through variable to the balances of its branch: out of node one, into node two."""
    for node, sign in zip(branch, (one, -one), strict=True):
        if not is_reference(node):
            row = rows.setdefault(node, Equation())
            combine(row.left, through.left, sign)
            combine(row.right, through.right, sign)


def _negated(form: Form) -> Form:
    return {label: -coefficient for label, coefficient in form.items()}
