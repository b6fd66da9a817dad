"""Definition 1 of the paper, in named co-states: an irreversible port-Hamiltonian system.

Input: a junction, the symbols of co-states E, law outputs W and inputs u.  Output: a `System`

    xdot = J_ir E + g u        J_ir = J0 + sum_k R_k J_k        R_k = W_k/T_k        (1), (3), (4)

where J_k couples the vector b_k of process k to the entropy of the body that it heats.  Here E, W,
T and the ratios are symbols; `definitions` gives them as functions of the state.  Proofs are about
this form, and generated code follows it line by line.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import final

import sympy as sp

from piezo_sym.algebra.lanes import ONE_SLOT, LaneMatrix, Slot, vector
from piezo_sym.algebra.notation import Entries


@final
@dataclass(frozen=True)
class System:
    """An irreversible port-Hamiltonian system in named co-states."""

    #: states, processes, ports: slots.
    states: tuple[Slot, ...]
    processes: tuple[Slot, ...]
    ports: tuple[Slot, ...]
    E: LaneMatrix  # co-states dU/dx, a vector over states
    dS: LaneMatrix  # gradient of the total entropy, a vector over states: 1 at each body's entropy
    #: The inputs of Definition 1, over ports; a heat exchange enters as lam*(T_e/T - 1).
    u: LaneMatrix
    W: LaneMatrix  # law outputs, over processes
    heats: tuple[int, ...]  # for each process the row of the entropy that it increases
    J0: LaneMatrix  # structure matrix of the energy-preserving elements, states by states
    #: B, D: columns b_k, d_k of the processes: z = B^T E + D^T u is conjugate to W.
    B: LaneMatrix
    D: LaneMatrix
    G: LaneMatrix  # input map of the junction laws, states by ports
    N: LaneMatrix  # direct coupling of ports, skew: a current source at a voltage source

    @cached_property
    def R(self) -> LaneMatrix:
        """The modulating functions R_k = W_k/T_k, eq. (4), over processes."""
        entries = {k: w / self.E[self.heats[k], 0] for k, w in enumerate(self.W)}
        return vector(self.processes, self.W.lanes, entries)

    @cached_property
    def drive(self) -> LaneMatrix:
        """The variables z = B^T E + D^T u, over processes; W_k z_k is the heat of process k."""
        return self.B.T @ self.E + self.D.T @ self.u

    @cached_property
    def bracket(self) -> LaneMatrix:
        """The thermodynamic driving forces {S, U}_{J_k} = dS^T J_k E, over processes.

        That is b_k^T E, less the temperature of the heated body where b_k takes from an entropy.
        """
        shares = self.B.T @ self.dS
        taken = {k: share * self.E[self.heats[k], 0] for k, share in enumerate(shares)}
        return self.B.T @ self.E - vector(self.processes, self.E.lanes, taken)

    @cached_property
    def z(self) -> LaneMatrix:
        """The driving forces z, brackets plus terms of inputs, over processes."""
        return self.bracket + self.D.T @ self.u

    @cached_property
    def J_ir(self) -> LaneMatrix:
        """The skew structure matrix of eq. (3)."""
        couplings = self.B @ self._heating
        return self.J0 + couplings.T - couplings

    @cached_property
    def g(self) -> LaneMatrix:
        """The input map of eq. (1); it depends on u where a source drives a process directly."""
        return self.G + (self.D @ self._heating).T

    @cached_property
    def rhs(self) -> LaneMatrix:
        """The rates J_ir E + g u, eq. (1), over states."""
        return self.J_ir @ self.E + self.g @ self.u

    @cached_property
    def y(self) -> LaneMatrix:
        """The conjugate outputs g^T E, eq. (2) (and N u), over ports."""
        return self.g.T @ self.E + self.N @ self.u

    @cached_property
    def y_s(self) -> LaneMatrix:
        """The entropy-conjugate outputs g^T dS/dx (the paper prints dU/dx), over ports."""
        return self.g.T @ self.dS

    @cached_property
    def sigma(self) -> sp.Expr:
        """The internal entropy production, sum_k W_k z_k/T_k, eq. (7)."""
        return (self.R.T @ self.z)[0, 0]

    def J(self, k: int) -> LaneMatrix:
        """Return J_k; for a bank that of lane j: `own` entries stand in that lane alone."""
        entropy = vector(self.states, self.E.lanes, {self.heats[k]: sp.S.One})
        columns = _column(self.B.full, k), _column(self.B.own, k)
        b, own = (LaneMatrix(self.states, ONE_SLOT, self.B.lanes, column) for column in columns)
        shared, lane = (entropy @ v.T - v @ entropy.T for v in (b, own))
        bank = self.processes[k].bank
        return LaneMatrix(self.states, self.states, self.B.lanes, shared.full, lane.full, bank)

    @cached_property
    def _heating(self) -> LaneMatrix:
        """The modulating functions as a matrix, R_k in the column of the entropy it increases."""
        entries = {(k, self.heats[k]): r for k, r in enumerate(self.R) if r != 0}
        return LaneMatrix(self.processes, self.states, self.R.lanes, entries)


def _column(entries: Entries, k: int) -> dict[tuple[int, int], sp.Expr]:
    return {(r, 0): entry for (r, c), entry in entries.items() if c == k}
