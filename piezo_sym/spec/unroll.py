"""Banks written out: a model in which every lane is an element of its own.

Input: a `Model` and a size for each bank.  Output: a `Model` without banks, to be derived like any
other; it shows explicit matrices, and checks the derivation that keeps sizes symbolic.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from piezo_sym.errors import UsageError, nearest, quote
from piezo_sym.expressions.parse import parse_condition
from piezo_sym.expressions.tree import names
from piezo_sym.spec.cells import nodes_of
from piezo_sym.spec.elements.base import Element, state_symbol
from piezo_sym.spec.elements.domains import REFERENCES
from piezo_sym.spec.elements.ports import Branch
from piezo_sym.spec.model import Model
from piezo_sym.spec.rename import renamed, reworded, started
from piezo_sym.spec.tables import bank_of, bank_states, banks, lane_parameters


def unroll(model: Model, counts: Mapping[str, int]) -> Model:
    """Return the model with each lane as elements ``<element>_1`` ... ``<element>_<count>``.

    A parameter or initial value given as a list becomes one for each lane; if the list is of
    another length than asked for, its first value serves every lane.

    Raises
    ------
    UsageError
        If `counts` names no bank, or a size below 1.
    """
    _check_counts(model, counts)
    sizes = {**banks(model), **counts}
    owners = lane_parameters(model)
    split = {
        name: sizes[owners[name]]
        for name, p in model.parameters.items()
        if isinstance(p.value, tuple)
    }
    data = model.model_dump()
    data["parameters"] = _apart(_parameters(model, split))
    data["elements"] = _apart(_elements(model, sizes, split))
    data["initial"] = dict(_initial(model, sizes, split))
    data["domain"] = {"assume": tuple(_assumptions(model, sizes, split))}
    return Model(**data)


def _check_counts(model: Model, counts: Mapping[str, int]) -> None:
    for name, count in counts.items():
        if name not in banks(model):
            known = nearest(name, banks(model))
            raise UsageError(f"{quote(name)} is no bank of '{model.name}'", "expand", remedy=known)
        if isinstance(count, bool) or not isinstance(count, int) or count < 1:
            raise UsageError(f"{quote(count)} is no size", f"expand: {name}", "1, 2, 3 ...")


def _apart(rows: Any) -> dict[str, Any]:
    """Return the rows as a table; refuse a lane under a name that something else has."""
    table: dict[str, Any] = {}
    for name, row in rows:
        if name in table:
            what = f"a lane would be called {quote(name)}, and that name is taken"
            raise UsageError(what, "expand", remedy=f"rename '{name}' in the spec")
        table[name] = row
    return table


def _parameters(model: Model, split: Mapping[str, int]) -> Any:
    for name, parameter in model.parameters.items():
        if name not in split:
            yield name, parameter
            continue
        values = parameter.value if isinstance(parameter.value, tuple) else (parameter.value,)
        for lane in range(split[name]):
            value = values[lane] if len(values) == split[name] else values[0]
            yield f"{name}_{lane + 1}", parameter.model_copy(update={"value": value})


def _elements(model: Model, sizes: Mapping[str, int], split: Mapping[str, int]) -> Any:
    owners, symbols = bank_of(model), bank_states(model)
    inner = _inner(model)
    for name, element in model.elements.items():
        if name not in owners:
            yield name, element
            continue
        words = {*split, *(s for s, bank in symbols.items() if bank == owners[name])}
        for lane in range(1, sizes[owners[name]] + 1):
            nodes = {node: f"{node}.{lane}" for node in inner}
            nodes |= _link(element.chain, owners[name], lane, sizes[owners[name]])
            yield f"{name}_{lane}", _lane(name, element, _words(lane, words), nodes)


def _lane(
    name: str, element: Element, words: Mapping[str, str], nodes: Mapping[str, str]
) -> dict[str, Any]:
    """Return the fields of an element in one lane; `nodes` are those that the lane calls so."""
    made = renamed(element, words, str, lambda node: nodes.get(node, node))
    made |= {"count": None, "bank": None, "series": None}
    return made | ({"state": words[state_symbol(element, name)]} if element.letter else {})


def _link(chain: Branch | None, bank: str, lane: int, size: int) -> dict[str, str]:
    """Return what a lane calls the ends of a chain."""
    if chain is None:
        return {}
    ends = f"{bank}.{lane - 1}", f"{bank}.{lane}"
    return {
        chain[0]: chain[0] if lane == 1 else ends[0],
        chain[1]: chain[1] if lane == size else ends[1],
    }


def _inner(model: Model) -> set[str]:
    """Return the nodes that elements of one bank alone name."""
    users: dict[str, set[str | None]] = {}
    for name, element in model.elements.items():
        for node in nodes_of(element):
            users.setdefault(node, set()).add(element.bank_of(name))
    return {n for n, own in users.items() if len(own) == 1 and None not in own} - {*REFERENCES}


def _words(lane: int, split: Iterable[str]) -> dict[str, str]:
    """Return the names of a lane's own symbols, lanes counted from 1."""
    return {symbol: f"{symbol}_{lane}" for symbol in split}


def _initial(model: Model, sizes: Mapping[str, int], split: Mapping[str, int]) -> Any:
    lanes = bank_states(model)
    for symbol, start in model.initial.items():
        size = sizes.get(lanes.get(symbol, ""))
        if size is None:
            yield symbol, start
            continue
        starts = start if isinstance(start, tuple) else (start,)
        for lane in range(1, size + 1):
            own = starts[lane - 1] if len(starts) == size else starts[0]
            yield f"{symbol}_{lane}", started(own, _words(lane, split))


def _assumptions(model: Model, sizes: Mapping[str, int], split: Mapping[str, int]) -> Any:
    lanes = {s: sizes[bank] for s, bank in bank_states(model).items()}
    lanes |= split
    for text in model.domain.assume:
        used = names(parse_condition(text, "domain.assume"))
        count = max((lanes[word] for word in used if word in lanes), default=0)
        yield from (reworded(text, _words(lane, lanes)) for lane in range(1, count + 1))
        if not count:
            yield text
