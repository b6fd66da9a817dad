"""Rows about to be called PROVED are tried at many points first, to find errors of the prover.

Input: an `IPHS`, its generated NumPy module, the rows.  Output: an `Attack` per row.  If exact
arithmetic finds a row false at a point, `ContradictionError` is raised.

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

__all__ = ["POINTS", "Attack", "falsify", "module_from"]


def falsify(
    iphs: IPHS,
    module: ModuleType,
    claims: Iterable[tuple[str, str]],
    *,
    points: int = POINTS,
) -> tuple[Attack, ...]:
    """Attack rows that are about to be called PROVED.

    Parameters
    ----------
    iphs : the system.
    module : its NumPy module, from `module_from` and the text about to be written.
    claims : (id, element) of the rows; rows that cannot be evaluated at a point are left out.
    points : how many points inside the domain are tried; fewer in tests of many small networks.

    Returns
    -------
    tuple of Attack
        One per row, in their order; `points` is 0 if no point of the domain was found.

    Raises
    ------
    ContradictionError
        If a row is false at a point, confirmed by exact arithmetic.
    """
    return Hunt(iphs, module, tuple(claims), points).attacks()
