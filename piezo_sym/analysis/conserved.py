"""Linear functions of the state that a motion conserves, such as x_1 - x_2 of parallel springs.

Input: changes of the state of which they must be none, such as rates at several states, and the
sizes of the states.  Output: the functions; a basis of the moves that keep them.
"""

import numpy as np

from piezo_sym.run.checks import FloatArray

FLOOR = 1e-15  # least size of a row, so that none is 0
RANK_TOLERANCE = 1e-12  # singular values below are round-off
SHARE_TOLERANCE = 1e-9  # smaller coefficients of conserved functions are round-off


def conserved_functions(changes: FloatArray, size: FloatArray) -> FloatArray:
    """Return linear functions (k, n) of the state that are zero on all `changes` (n, many).

    Changes of a state are measured in its `size` (n,).
    """
    changes = changes / size[:, None]
    changes = changes[:, np.isfinite(changes).all(axis=0) & changes.any(axis=0)]
    changes /= np.abs(changes).max(axis=0, initial=0.0)  # else squares of tiny numbers underflow
    changes /= np.linalg.norm(changes, axis=0)
    rows = np.maximum(np.abs(changes).max(axis=1, initial=0.0), FLOOR)
    triangle = np.linalg.qr((changes / rows[:, None]).T, mode="r")
    _, values, right = np.linalg.svd(triangle)
    shares = right[int(np.sum(values > RANK_TOLERANCE)) :]
    return np.asarray(np.where(np.abs(shares) < SHARE_TOLERANCE, 0.0, shares) / rows / size)


def basis_of(functions: FloatArray, size: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return which states are coordinates z (n,), and the basis (n, k) of the moves that keep them.

    The other states, one per function, follow from z. A state that is conserved by itself is a
    coordinate.
    """
    shares, pivots = functions * size, []
    for k in range(len(shares)):
        pivots.append(int(np.argmax(np.abs(shares[k]))))
        shares[k] /= shares[k, pivots[k]]
        others = np.arange(len(shares)) != k
        shares[others] -= np.outer(shares[others, pivots[k]], shares[k])
        shares[np.abs(shares) < SHARE_TOLERANCE] = 0.0
    basis, coordinates = np.eye(size.size), np.ones(size.size, dtype=bool)
    for share, pivot in zip(shares, pivots, strict=True):
        if np.count_nonzero(share) > 1:
            basis[pivot] = -share * size[pivot] / size
            coordinates[pivot] = False
    return coordinates, basis[:, coordinates]
