"""What a spec says of the columns of points: which stay positive, which are alike.

Input: a system and its `Space`.  Output: masks and pairs of columns.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from piezo_sym.expressions.tree import Cmp, Num, Sym
from piezo_sym.falsify.space import Mask, Space
from piezo_sym.iphs import IPHS
from piezo_sym.spec.tables import conditions, greater
from piezo_sym.spec.units import parse_unit


def positive(iphs: IPHS, space: Space) -> Mask:
    """Return which columns the domain keeps from being negative."""
    found = set()
    for condition in conditions(iphs.model):
        match greater(condition.tree):
            case Cmp(_, Sym(name), Num(value)) if value >= 0:
                found.add(name)
    return np.array([name in found for name, _ in space.columns])


def pairs(space: Space) -> Any:
    """Return pairs of columns of equal dimension."""
    units = {f.name: parse_unit(f.unit).dimension for f in space.fields}
    columns = [(n, units[name]) for n, (name, _) in enumerate(space.columns)]
    pairs = [(a, b) for a, one in columns for b, other in columns if a != b and one == other]
    return np.array(pairs, dtype=np.int64).reshape(-1, 2)
