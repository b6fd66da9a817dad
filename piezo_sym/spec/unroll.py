"""Banks written out: a model in which every lane is an element of its own.

Input: a `Model` and a size for each bank.  Output: a `Model` without banks, to be derived like any
other.  It shows explicit matrices, and checks the derivation that keeps sizes symbolic.
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
from piezo_sym.spec.tables import alone, bank_of, bank_states, banks, conditions, lane_parameters


def unroll(model: Model, counts: Mapping[str, int]) -> Model:
    """Return the model with each lane as elements ``<element>_1`` ... ``<element>_<count>``.

    A parameter or initial value given as a list becomes one for each lane; if the list is of
    another length than asked for, its first value serves every lane.  Raises `UsageError` if
    `counts` names no bank, or a size below 1.
    """
    _check_counts(model, counts)
    sizes, owners, inner = {**banks(model), **counts}, bank_of(model), _cell_nodes(model)
    listed, values = lane_parameters(model, conditions(model)), model.parameters.items()
    of_lanes = bank_states(model) | {n: listed[n] for n, p in values if isinstance(p.value, tuple)}
    lanes = {symbol: sizes[bank] for symbol, bank in of_lanes.items()}

    def parameter(name: str, lane: int) -> Any:
        row = model.parameters[name]
        return row.model_copy(update={"value": _of_lane(row.value, lane, lanes[name])})

    def element(name: str, lane: int) -> dict[str, Any]:
        original, bank = model.elements[name], owners[name]
        nodes = {node: f"{node}.{lane}" for node in inner}
        nodes |= _chain_nodes(original.chain, bank, lane, sizes[bank])
        fields = _lane_names(lanes, lane, lambda node: nodes.get(node, node)).fields(original, name)
        return fields | {"count": None, "bank": None, "series": None}

    def start(symbol: str, lane: int) -> Any:
        given = _of_lane(model.initial[symbol], lane, lanes[symbol])
        return _lane_names(lanes, lane).start(given)

    data = model.model_dump()
    data["parameters"] = _with_lanes(model.parameters, lanes, parameter)
    in_bank = {name: sizes[bank] for name, bank in owners.items()}
    data["elements"] = _with_lanes(model.elements, in_bank, element)
    data["initial"] = _with_lanes(model.initial, lanes, start)
    data["domain"] = {"assume": tuple(_assumed(model, lanes))}
    return Model(**data)


def _lane_names(lanes: Iterable[str], lane: int, node: Callable[[str], str] = str) -> Renaming:
    """Return the new names of the symbols `lanes` and of nodes in a lane, counted from 1."""
    return Renaming({symbol: f"{symbol}_{lane}" for symbol in lanes}, node=node)


def _assumed(model: Model, lanes: Mapping[str, int]) -> Iterator[str]:
    for text in model.domain.assume:
        used = names(parse_condition(text, "domain.assume"))
        count = max((lanes[word] for word in used if word in lanes), default=0)
        yield from (_lane_names(lanes, lane).text(text) for lane in range(1, count + 1))
        if not count:
            yield text


def _with_lanes(
    table: Mapping[str, Any], sizes: Mapping[str, int], lane_row: Callable[[str, int], Any]
) -> dict[str, Any]:
    """Return a table with a row for each lane; refuse a lane whose name is taken."""
    rows: dict[str, Any] = {}
    for name, row in table.items():
        lanes = range(1, sizes.get(name, 0) + 1)
        for new, value in [(f"{name}_{n}", lane_row(name, n)) for n in lanes] or [(name, row)]:
            if new in rows:
                what = f"a lane would be called {quote(new)}, and that name is taken"
                raise UsageError(what, "expand", remedy=f"rename '{new}' in the spec")
            rows[new] = value
    return rows


def _of_lane(values: Any, lane: int, size: int) -> Any:
    """Return the value of one lane, counted from 1, from those of a bank."""
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


def _chain_nodes(chain: Branch | None, bank: str, lane: int, size: int) -> dict[str, str]:
    """Return the nodes between which a lane stands, by the ends of its chain."""
    if chain is None:
        return {}
    ends = f"{bank}.{lane - 1}", f"{bank}.{lane}"
    return {
        chain[0]: chain[0] if lane == 1 else ends[0],
        chain[1]: chain[1] if lane == size else ends[1],
    }


def _cell_nodes(model: Model) -> set[str]:
    """Return the nodes that elements of one bank alone name."""
    named = ((e.bank_of(name), e.named("node")) for name, e in model.elements.items())
    return alone((node, bank) for bank, nodes in named for _, node in nodes).keys() - REFERENCES
