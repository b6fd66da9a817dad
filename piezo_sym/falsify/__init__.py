"""Evaluates rows that are about to be called PROVED at many points, to find errors of the prover.

Input: an `IPHS`, its generated NumPy module, the rows.  Output: an `Attack` per row, or
`ContradictionError` if a row is false at a point by exact arithmetic.

stage    from -> to                              in
probe    IPHS -> laws and edges, as trees        probe
space    module, probe -> columns of points      space, floats
points   Space -> points inside the domain       points
claims   row -> numbers, negative where false    claims
hunt     points -> the worst ones of each row    hunt
exact    a point -> the row's exact value        exact
jumps    kinks -> a law's jump, exactly          jumps
"""

from collections.abc import Iterable
from types import ModuleType

from piezo_sym.falsify.hunt import POINTS, Attack, Hunt
from piezo_sym.falsify.probe import module_from
from piezo_sym.iphs import IPHS

__all__ = ["POINTS", "Attack", "Hunt", "falsify", "module_from"]


def falsify(
    iphs: IPHS, module: ModuleType, claims: Iterable[tuple[str, str]], *, points: int = POINTS
) -> tuple[Attack, ...]:
    """Return the attack on each of some rows that can be evaluated at a point, in their order.

    `module` is the system's NumPy module, from `module_from`; `claims` are the (id, element) of the
    rows; `points` is the number of points inside the domain.  Raises `ContradictionError` if a row
    is false at a point, confirmed by exact arithmetic.
    """
    hunt = Hunt(iphs, module, rows := tuple(claims), points)
    hunt.search()
    return tuple(filter(None, map(hunt.attack, rows)))
