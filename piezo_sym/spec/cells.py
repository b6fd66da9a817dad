"""Banks of cells, written out as elements that say which bank they are in.

Input: the tables of a spec.  Output: the elements of its [banks]: ``creep_spring`` of bank
``creep``, between ``tip`` and ``creep.inside``, one for each lane.  A node that no element outside
of [banks] names is a cell's own.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any

from piezo_sym.errors import SpecError, quote
from piezo_sym.spec.elements.base import Element
from piezo_sym.spec.elements.domains import REFERENCES
from piezo_sym.spec.fields import Tables
from piezo_sym.spec.names import check_name
from piezo_sym.spec.rename import Renaming


def cells(spec: Tables, outside: set[str]) -> Iterator[tuple[str, dict[str, Any], str]]:
    """Yield the name, the fields and the place of each element of a cell.

    Parameters
    ----------
    outside : the nodes of the elements that are in no cell.

    Raises
    ------
    SpecError
        If a bank has no elements, or one that cannot be in a cell, or a node has two meanings.
    """
    for bank, table in spec.banks.items():
        where = f"banks.{bank}"
        check_name(bank, where)
        if not table.elements:
            raise SpecError("has no elements", where, "at least one, in its table elements")
        for name, element in table.elements.items():
            place = f"{where}.elements.{name}"
            check_name(name, place)
            _check(element, place, where)
            node = partial(_node, bank, outside | {*(table.series or ())}, place)
            more = {"bank": bank, "count": table.count, "series": table.series}
            fields = Renaming({}, node=node).fields(element, name)
            yield f"{bank}_{name}", fields | more, place


def nodes_of(element: Element) -> Iterator[str]:
    """Yield the nodes that an element names."""
    return (node for _, to, node in element.named() if to == "node")


def _check(element: Element, place: str, where: str) -> None:
    if not element.row.has_lanes:
        what = f"a {element.kind} is in no cell of a bank"
        remedy = f"write it in [elements], with nodes that cells of {where} name, too"
        raise SpecError(what, place, "a store, a dissipative element, a stop or hysteron", remedy)
    for field in ("count", "bank", "series"):
        if getattr(element, field) is not None:
            what = f"{field} is given in a cell"
            expected = f"count and series in [{where}]"
            raise SpecError(what, f"{place}.{field}", expected, "leave it out")


def _node(bank: str, outside: set[str], place: str, node: str) -> str:
    """Return what a cell's node is called: its own name, where it stands outside of cells, too."""
    if node in REFERENCES or node in outside:
        return node
    own = f"{bank}.{node}"
    if own in outside:
        what = f"{quote(own)} is what node {quote(node)} of a cell of {quote(bank)} is called"
        raise SpecError(what, place, "one meaning of a node", f"rename {quote(node)} here")
    return own
