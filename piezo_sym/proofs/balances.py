"""The obligations that algebra decides: skew, casimir, energy, entropy, exergy, environment.

Input: an `IPHS`.  Output: obligations with residuals.  In named co-states a residual has a normal
form, a polynomial in independent symbols and in sums over lanes: zero proves the property for every
state, input, parameter and bank size.
"""

from collections.abc import Container, Iterator
from dataclasses import replace

import sympy as sp

from piezo_sym.algebra.integrals import vanishes
from piezo_sym.algebra.lanes import LaneMatrix
from piezo_sym.expressions.calculus import add
from piezo_sym.expressions.energies import slope
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import ZERO, Call, Cmp, Div, Expr, Mul, Num, Sym, names
from piezo_sym.iphs import IPHS
from piezo_sym.iphs.definitions import Energy
from piezo_sym.proofs.assumptions import Assumptions, Law
from piezo_sym.proofs.branches import TooManyBranchesError, branches, parts
from piezo_sym.proofs.continuity import jump_questions
from piezo_sym.proofs.laws import value_questions
from piezo_sym.proofs.obligations import NEVER, Obligation, Question, Residual
from piezo_sym.spec.elements.ports import (
    Body,
    Conductor,
    DissipativePort,
    Exchange,
    HeatInput,
    Source,
    Storage,
)
from piezo_sym.spec.tables import greater


def skew(iphs: IPHS) -> Obligation:
    """State that J0 and every J_k are skew, for every pair of lanes of every bank."""
    system = iphs.system
    matrices = [("J0", system.J0)]
    matrices += [(f"J_{slot.label}", system.J(k)) for k, slot in enumerate(system.processes)]
    found = [
        residual
        for name, matrix in matrices
        for residual in _entries(f"({name} + {name}^T)", matrix + matrix.T)
    ]
    statement = "J0 + J0^T = 0 and J_k + J_k^T = 0"
    latex = r"J_0 + J_0^\top = 0,\quad J_k + J_k^\top = 0"
    return Obligation("skew", "", statement, latex, residuals=tuple(found))


def casimir(iphs: IPHS) -> Obligation:
    """State that the entropy is a Casimir function of J0."""
    found = tuple(_entries("J0 dS/dx", iphs.system.J0 @ iphs.system.dS))
    latex = r"J_0 \, \partial S/\partial x = 0"
    return Obligation("casimir", "", "J0 dS/dx = 0", latex, residuals=found)


def energy(iphs: IPHS, assumptions: Assumptions) -> Obligation:
    """State the first law: U does not jump, dU/dx = E, and dU/dt is the supply rate."""
    system = iphs.system
    balance = (system.E.T @ system.rhs - system.y.T @ system.u)[0, 0]
    found = (*_gradient(iphs, assumptions), Residual("dU/dt - y^T u", balance))
    obligation = Obligation("energy", "", "dU/dt = y^T u", r"\dot U = y^\top u", residuals=found)
    laws = [Law("", "U", energy.law, derived=energy.derived) for energy in iphs.energies]
    return obligation.asking(
        lambda: (q for law in laws for q in jump_questions(law, assumptions)), "an energy"
    )


def entropy(iphs: IPHS) -> Obligation:
    """State the entropy balance: production of the processes plus supply of the inputs, eq. (5)."""
    system = iphs.system
    produced = system.R.T @ system.bracket + system.y_s.T @ system.u
    balance = (system.dS.T @ system.rhs - produced)[0, 0]
    statement = "dS/dt = sum_k gamma_k {S,U}_k^2 + y_s^T u"
    latex = r"\dot S = \sum_k \gamma_k \{S,U\}_{J_k}^2 + y_s^\top u"
    if not system.D.is_zero:  # a source drives a process: R_k is not gamma_k {S,U}_k there
        statement = "dS/dt = sum_k R_k z_k + y_s^T u (input map g depends on u)"
        latex = r"\dot S = \sum_k R_k \{S,U\}_{J_k} + y_s^\top u"
    residual = Residual("dS/dt - sigma - y_s^T u", balance)
    return Obligation("entropy", "", statement, latex, residuals=(residual,))


def sigma(iphs: IPHS) -> Obligation:
    """State the second law: the entropy production of the processes is not negative."""
    statement = "sigma = sum_k W_k z_k/T_k >= 0"
    latex = r"\sigma = \sum_k W_k z_k / T_k \ge 0"
    return Obligation("sigma", "", statement, latex, rests_on=premises(iphs))


def premises(iphs: IPHS) -> tuple[tuple[str, str], ...]:
    """Return the obligations that the second law rests on."""
    bodies = [("temperature", placed.element) for placed, _ in iphs.circuit.of(Body)]
    laws = [
        ("passive", placed.element) for placed, _ in iphs.circuit.of(DissipativePort, Conductor)
    ]
    return (*bodies, *laws)


def exergy(iphs: IPHS, assumptions: Assumptions) -> Iterator[Obligation]:
    """Yield the exergy balance d(U - T_e S)/dt <= 0 at one constant T_e, if there is one."""
    exchanges = tuple(iphs.circuit.of(Exchange))
    if not exchanges:
        return
    system, common = iphs.system, iphs.symbols[exchanges[0][1].input]
    fixed = {iphs.symbols[port.input]: common for _, port in exchanges}
    fixed |= {iphs.symbols[port.input]: sp.S.Zero for _, port in iphs.circuit.of(Source, HeatInput)}
    rate = (system.y.T @ system.u)[0, 0] - common * (system.dS.T @ system.rhs)[0, 0]
    lost = sum(lam * (T - common) ** 2 / T for lam, T, _ in _exchanges(iphs))
    residual = (rate + common * system.sigma).xreplace(fixed) + lost.xreplace(fixed)
    obligation = Obligation(
        "exergy",
        "",
        "d(U - T_e S)/dt <= 0 where other inputs are 0, T_e constant",
        r"\frac{d}{dt}(U - T_e S) = -T_e\,\sigma - \lambda (T - T_e)^2/T \le 0",
        assumptions.texts,
        residuals=(Residual("d(U - T_e S)/dt + T_e sigma + lam (T - T_e)^2/T", residual),),
        rests_on=(("sigma", ""),),
    )
    yield obligation.asking(lambda: _exchange_questions(iphs, assumptions), "a conductance")


def environment(iphs: IPHS, assumptions: Assumptions) -> Iterator[Obligation]:
    """Yield the entropy balance of the system with its environment, if there is one."""
    if not any(True for _ in iphs.circuit.of(Exchange)):
        return
    system = iphs.system
    taken = sum(lam * (T_e - T) / T_e for lam, T, T_e in _exchanges(iphs))
    crossed = sum(lam * (T_e - T) ** 2 / (T * T_e) for lam, T, T_e in _exchanges(iphs))
    total = (system.dS.T @ system.rhs)[0, 0] - taken - system.sigma - crossed
    heat = {iphs.symbols[port.input]: sp.S.Zero for _, port in iphs.circuit.of(HeatInput)}
    residual = Residual("dS/dt + dS_e/dt - sigma - lam (T_e - T)^2/(T T_e)", total.xreplace(heat))
    counted = "environment counted" + ", heat sources 0" * bool(heat)
    obligation = Obligation(
        "environment",
        "",
        f"sigma + lam (T_e - T)^2/(T T_e) >= 0, {counted}",
        r"\sigma + \lambda (T_e - T)^2/(T\,T_e) \ge 0",
        assumptions.texts,
        residuals=(residual,),
        rests_on=(("sigma", ""),),
    )
    yield obligation.asking(lambda: _exchange_questions(iphs, assumptions), "a conductance")


def _exchanges(iphs: IPHS) -> Iterator[tuple[sp.Expr, sp.Symbol, sp.Symbol]]:
    """Yield (lam, T, T_e) of each heat exchange."""
    for _, port in iphs.circuit.of(Exchange):
        temperature = iphs.circuit.bodies[port.body].temperature
        conductance = iphs.symbols.law(port.conductance, {})
        yield conductance, iphs.symbols[temperature], iphs.symbols[port.input]


def _exchange_questions(iphs: IPHS, assumptions: Assumptions) -> Iterator[Question]:
    """Yield the questions on heat exchange: conductance >= 0 and T_e > 0."""
    for placed, port in iphs.circuit.of(Exchange):
        warm, conducts = Cmp(">", Sym(port.input), ZERO), Cmp(">=", port.conductance, ZERO)
        yield from value_questions(port.conductance, assumptions)
        label = f"{spell(port.conductance)} >= 0 ({placed.element})"
        yield assumptions.question(label, conducts)
        yield assumptions.question(f"{port.input} > 0", warm)


def _gradient(iphs: IPHS, assumptions: Assumptions) -> Iterator[Residual]:
    """Yield the residual dU/dx - E for each state.

    Where its normal form is not zero, the slope of the energies is compared branch by branch with
    the law in the spec, provided that E is that law.
    """
    stored: dict[str, list[tuple[Energy, sp.Expr]]] = {}
    for energy in iphs.energies:
        law = iphs.symbols.law(energy.law, {})
        for name in names(energy.law):
            stored.setdefault(name, []).append((energy, law))
    stores = iphs.circuit.of(Storage, Body)
    for (_, port), (_, costate) in zip(stores, iphs.costates, strict=True):
        state = iphs.symbols[port.state]
        own = stored.get(port.state, [])
        # factors without the state are taken out: SymPy is slow to differentiate the product
        parts = (law.as_independent(state, as_Add=False) for _, law in own)
        difference = sp.Add(*(factor * sp.diff(part, state) for factor, part in parts)) - costate
        residual, empty = sp.expand(sp.together(difference)), tuple[Question, ...]()
        rise = add(*(slope(energy.law, port.state) for energy, _ in own))
        if residual != 0 and costate == iphs.symbols.law(port.law, {}):
            try:
                empty = tuple(_slope_questions(iphs, rise, port.law, port.state, assumptions))
                residual = residual if empty else sp.S.Zero
            except TooManyBranchesError:
                pass
        derived = any(energy.derived for energy, _ in own)
        yield Residual(f"dU/d{port.state}", residual, empty, derived)


def _slope_questions(
    iphs: IPHS, slope: Expr, law: Expr, state: str, assumptions: Assumptions
) -> Iterator[Question]:
    """Ask whether each branch on which an energy's slope is not the co-state is empty.

    If a branch is an edge, a = b, slope and co-state are compared on the edge alone, with the slope
    of either side: rows ``continuous`` show that neither energy nor law jumps.
    """
    known = tuple(condition.tree for condition in iphs.circuit.conditions)
    positive = {c.left for c in map(greater, known) if c.op == ">" and c.right == ZERO}
    for branch in branches(Call("together", (slope, law)), known):
        where = tuple(_numerator(condition, positive) for condition in branch.conditions)
        left, right = (iphs.symbols.law(part, {}) for part in parts(branch))
        at = dict(_state_on_edge(iphs, where, iphs.symbols[state]))
        if not vanishes((left - right).xreplace(at)):
            asked = assumptions.question(f"dU/d{state} is the co-state", NEVER)
            yield replace(asked, where=(*known, *branch.conditions), branch=branch.conditions)


def _numerator(condition: Cmp, positive: Container[Expr]) -> Cmp:
    """Return a comparison with zero without its positive divisors and numeric factors."""

    def plain(node: Expr) -> Expr:
        match node:
            case Div(left, right) if right in positive:
                return plain(left)
            case Div(left, Num(value)) | Mul(Num(value), left) if value > 0:
                return plain(left)
        return node

    left = plain(condition.left) if condition.right == ZERO else condition.left
    return Cmp(condition.op, left, condition.right)


def _state_on_edge(
    iphs: IPHS, where: tuple[Cmp, ...], state: sp.Symbol
) -> Iterator[tuple[sp.Symbol, sp.Expr]]:
    """Yield the state and its value if a branch is an edge, at which it has just one."""
    for condition in where:
        if condition.op == ">=" and Cmp("<=", condition.left, condition.right) in where:
            left, right = (iphs.symbols.law(e, {}) for e in (condition.left, condition.right))
            slope = sp.diff(left - right, state)
            if state not in slope.free_symbols and slope.is_nonzero:
                yield state, sp.expand(state - (left - right) / slope)
                return


def _entries(name: str, matrix: LaneMatrix) -> Iterator[Residual]:
    for (r, c), full, own in matrix.entries():
        place = f"{name}[{matrix.rows[r].label}, {matrix.cols[c].label or 1}]"
        yield from (Residual(place, expr) for expr in (full, own) if expr != 0)
