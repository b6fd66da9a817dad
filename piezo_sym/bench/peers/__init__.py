"""What a model could be run with instead: one file each, from the same explicit rates.

Input: a `Problem`.  Output: `PEERS`, each with a solver (tolerance -> state at the end), and with
rates of many states at once where it has them.  A peer that is not installed is left out.
"""

from piezo_sym.bench.peers.casadi import CASADI
from piezo_sym.bench.peers.diffrax import DIFFRAX
from piezo_sym.bench.peers.heyoka import HEYOKA
from piezo_sym.bench.peers.lambdified import LSODA, LSODA_MATH, RK45, field
from piezo_sym.bench.peers.numba import NUMBA
from piezo_sym.bench.peers.peer import Peer

#: All peers, in the order of the report.
PEERS = (LSODA, RK45, LSODA_MATH, NUMBA, CASADI, DIFFRAX, HEYOKA)

__all__ = ["LSODA", "PEERS", "Peer", "field"]
