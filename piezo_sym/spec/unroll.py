"""Banks written out: a model in which every lane is an element of its own.

Input: a `Model` and a size for each bank.  Output: a `Model` without banks, to be derived like any
other; it shows explicit matrices, and checks the derivation that keeps sizes symbolic.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from piezo_sym.errors import UsageError, nearest, quote
from piezo_sym.expressions.parse import parse_condition
from piezo_sym.expressions.tree import names
from piezo_sym.spec.elements.domains import REFERENCES
from piezo_sym.spec.elements.ports import Branch
from piezo_sym.spec.model import Model
from piezo_sym.spec.rename import Renaming
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
    sizes, owners, inner = {**banks(model), **counts}, bank_of(model), _inner(model)
    listed, values = lane_parameters(model), model.parameters.items()
    of_lanes = bank_states(model) | {n: listed[n] for n, p in values if isinstance(p.value, tuple)}
    lanes = {symbol: sizes[bank] for symbol, bank in of_lanes.items()}

    def parameter(name: str, lane: int) -> Any:
        own = model.parameters[name]
        return own.model_copy(update={"value": _of_lane(own.value, lane, lanes[name])})

    def element(name: str, lane: int) -> dict[str, Any]:
        own, bank = model.elements[name], owners[name]
        nodes = {node: f"{node}.{lane}" for node in inner}
        nodes |= _link(own.chain, bank, lane, sizes[bank])
        made = _in_lane(lanes, lane, lambda node: nodes.get(node, node)).fields(own, name)
        return made | {"count": None, "bank": None, "series": None}

    def start(symbol: str, lane: int) -> Any:
        given = _of_lane(model.initial[symbol], lane, lanes[symbol])
        return _in_lane(lanes, lane).start(given)

    data = model.model_dump()
    data["parameters"] = _spread(model.parameters, lanes, parameter)
    in_bank = {name: sizes[bank] for name, bank in owners.items()}
    data["elements"] = _spread(model.elements, in_bank, element)
    data["initial"] = _spread(model.initial, lanes, start)
    data["domain"] = {"assume": tuple(_assumed(model, lanes))}
    return Model(**data)


def _in_lane(lanes: Iterable[str], lane: int, node: Callable[[str], str] = str) -> Renaming:
    """Return the names of a lane's own symbols, lanes counted from 1."""
    return Renaming({symbol: f"{symbol}_{lane}" for symbol in lanes}, node=node)


def _assumed(model: Model, lanes: Mapping[str, int]) -> Iterator[str]:
    for text in model.domain.assume:
        used = names(parse_condition(text, "domain.assume"))
        count = max((lanes[word] for word in used if word in lanes), default=0)
        yield from (_in_lane(lanes, lane).text(text) for lane in range(1, count + 1))
        if not count:
            yield text


def _spread(
    table: Mapping[str, Any], sizes: Mapping[str, int], made: Callable[[str, int], Any]
) -> dict[str, Any]:
    """Return a table with a row for each lane; refuse a lane under a name that is taken."""
    rows: dict[str, Any] = {}
    for name, row in table.items():
        lanes = range(1, sizes.get(name, 0) + 1)
        for own, value in [(f"{name}_{n}", made(name, n)) for n in lanes] or [(name, row)]:
            if own in rows:
                what = f"a lane would be called {quote(own)}, and that name is taken"
                raise UsageError(what, "expand", remedy=f"rename '{own}' in the spec")
            rows[own] = value
    return rows


def _of_lane(values: Any, lane: int, size: int) -> Any:
    """Return what a lane has of the values of a bank."""
    if not isinstance(values, tuple):
        return values
    return values[lane - 1] if len(values) == size else values[0]


def _check_counts(model: Model, counts: Mapping[str, int]) -> None:
    for name, count in counts.items():
        if name not in banks(model):
            known = nearest(name, banks(model))
            raise UsageError(f"{quote(name)} is no bank of '{model.name}'", "expand", remedy=known)
        if isinstance(count, bool) or not isinstance(count, int) or count < 1:
            raise UsageError(f"{quote(count)} is no size", f"expand: {name}", "1, 2, 3 ...")


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
        for _, node in element.named("node"):
            users.setdefault(node, set()).add(element.bank_of(name))
    return {n for n, own in users.items() if len(own) == 1 and None not in own} - {*REFERENCES}
