"""The net under the prover: rows about to be PROVED are attacked with numbers first.

Input: an `IPHS`, its generated NumPy module, the rows.  Output: an `Attack` per row; a point at
which exact arithmetic finds a row false raises `ContradictionError`.

stage    from -> to                              in
probe    IPHS -> laws and edges, printed         probe
space    module, probe -> columns of points      space
points   Space -> points inside the domain       points
claims   row -> a number negative where false    claims
hunt     points -> the worst ones of each row    hunt
exact    a point -> the row's exact value        exact, point, numbers
jumps    kinks -> a law's jump, exactly          jumps
"""

from __future__ import annotations

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
    claims : (id, element) of the rows; those that numbers say nothing of are left out.
    points : inside the domain; fewer only in tests of many small networks.

    Returns
    -------
    tuple of Attack
        No row was found false; `points` is 0 where no point of the domain was found.

    Raises
    ------
    ContradictionError
        If a row is false at a point, confirmed by exact arithmetic in the spec's own laws.
    """
    return Hunt(iphs, module, tuple(claims), points).attacks()
