"""Proposition 3 and eqs. (9)-(13), typed from the paper; nothing here uses the derivation.

States (q, p, Q_C, phi_1 ... phi_r, S), inputs (F_ext, V_in, lam*(T_e/T - 1)), T = T_0 exp(S/c_0).
"""

from dataclasses import dataclass

import sympy as sp

POSITIVE = ("M", "k", "C", "L", "T_0", "c_0")
NONNEGATIVE = ("d", "rho", "i_0", "lam")
REAL = ("q_l", "a", "q", "p", "Q_C", "S", "F_ext", "V_in", "T_e")


@dataclass(frozen=True)
class Paper:
    """The paper's model with r hysterons."""

    r: int

    def __getattr__(self, name: str) -> sp.Symbol:
        if name in POSITIVE:
            return sp.Symbol(name, positive=True)
        if name in NONNEGATIVE:
            return sp.Symbol(name, nonnegative=True)
        if name in REAL:
            return sp.Symbol(name, real=True)
        raise AttributeError(name)

    @property
    def n(self) -> int:
        return 4 + self.r

    @property
    def phi(self) -> list[sp.Symbol]:
        return [sp.Symbol(f"phi_{j + 1}", real=True) for j in range(self.r)]

    @property
    def x(self) -> sp.Matrix:
        return sp.Matrix([self.q, self.p, self.Q_C, *self.phi, self.S])

    @property
    def T(self) -> sp.Expr:
        return self.T_0 * sp.exp(self.S / self.c_0)

    @property
    def alpha(self) -> sp.Expr:
        return self.a * self.T / self.T_0

    def w(self, z: sp.Expr) -> sp.Expr:
        """The operator w_T of section 4.1."""
        slope = self.rho / (self.T - self.T_0)
        return sp.Piecewise(
            (slope * (z - self.i_0), z > self.i_0),
            (slope * (z + self.i_0), z < -self.i_0),
            (0, True),
        )

    @property
    def J0(self) -> sp.Matrix:
        """Eq. (15)."""
        J = sp.zeros(self.n, self.n)
        J[0, 1], J[1, 0] = 1, -1
        J[1, 2], J[2, 1] = self.alpha, -self.alpha
        for j in range(self.r):
            J[2, 3 + j], J[3 + j, 2] = 1, -1
        return J

    @property
    def J_d(self) -> sp.Matrix:
        J = sp.zeros(self.n, self.n)
        J[self.n - 1, 1], J[1, self.n - 1] = 1, -1
        return J

    def J_j(self, j: int) -> sp.Matrix:
        J = sp.zeros(self.n, self.n)
        J[self.n - 1, 3 + j], J[3 + j, self.n - 1] = 1, -1
        return J

    @property
    def R_d(self) -> sp.Expr:
        return self.d * self.p / self.M / self.T

    def R_j(self, j: int) -> sp.Expr:
        return self.w(self.phi[j] / self.L) / self.T

    @property
    def g(self) -> sp.Matrix:
        g = sp.zeros(self.n, 3)
        g[1, 0] = 1
        for j in range(self.r):
            g[3 + j, 1] = 1
        g[self.n - 1, 2] = 1
        return g

    @property
    def u(self) -> sp.Matrix:
        return sp.Matrix([self.F_ext, self.V_in, self.lam * (self.T_e / self.T - 1)])

    @property
    def y(self) -> sp.Matrix:
        return sp.Matrix([self.p / self.M, sum(phi / self.L for phi in self.phi), self.T])

    @property
    def U(self) -> sp.Expr:
        """Eq. (6), with f_h the integral of T."""
        stored = sum(phi**2 / (2 * self.L) for phi in self.phi)
        return (
            self.Q_C**2 / (2 * self.C)
            + stored
            + self.p**2 / (2 * self.M)
            + self.k * (self.q - self.q_l) ** 2 / 2
            + self.c_0 * self.T
        )

    @property
    def rhs(self) -> sp.Matrix:
        """Eqs. (9)-(13)."""
        v = self.p / self.M
        i = [phi / self.L for phi in self.phi]
        spring, coupling = self.k * (self.q - self.q_l), self.alpha * self.Q_C / self.C
        sigma = (sum(z * self.w(z) for z in i) + self.d * v**2) / self.T
        return sp.Matrix(
            [
                v,
                -spring - self.d * v + coupling + self.F_ext,
                sum(i) - self.alpha * v,
                *(self.V_in - self.Q_C / self.C - self.w(z) for z in i),
                sigma + self.lam * (self.T_e / self.T - 1),
            ]
        )
