"""What a model could be run with instead: one file each, from the same explicit rates.

Input: a `Problem`.  Output: `PEERS`, each with a solver (tolerance -> state at the end), and with
rates of many states at once where it has them.  A peer that is not installed is left out.
"""

from tests.benchmarks.peers.casadi import CASADI
from tests.benchmarks.peers.diffrax import DIFFRAX
from tests.benchmarks.peers.heyoka import HEYOKA
from tests.benchmarks.peers.lambdified import LSODA, LSODA_MATH, RK45
from tests.benchmarks.peers.numba import NUMBA
from tests.benchmarks.peers.peer import Peer

#: All peers, in the order of the report.
PEERS = (LSODA, RK45, LSODA_MATH, NUMBA, CASADI, DIFFRAX, HEYOKA)

__all__ = ["LSODA", "PEERS", "Peer"]
