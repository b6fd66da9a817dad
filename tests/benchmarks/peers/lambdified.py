"""Today's usual way: lambdified SymPy, integrated by SciPy's solve_ivp.

Input: a problem.  Output: `LSODA` and `RK45`, with the rates as `lambdify` prints them for NumPy,
its default; and `LSODA_MATH`, with Python's own floats and common subexpressions, which few people
write and which is several times faster.
"""

from functools import partial

from piezo_sym.bench.problem import batch, solver
from tests.benchmarks.peers.peer import Peer

LSODA = Peer("LSODA on lambdified SymPy", "sympy", partial(solver, "LSODA", "numpy", False), batch)
RK45 = Peer("RK45 on lambdified SymPy", "sympy", partial(solver, "RK45", "numpy", False))
LSODA_MATH = Peer(
    "LSODA on lambdified SymPy, math and cse", "sympy", partial(solver, "LSODA", "math", True)
)
