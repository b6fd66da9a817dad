"""Spec data out: TOML text in the layout of the shipped specs, and the canonical hash.

Input: plain data of a spec, as TOML gives it.  Output: text, or a SHA-256.  Nothing here needs the
spec's types, so that a run can compare a module with its spec without loading them.
"""

import hashlib
import json
from collections.abc import Mapping
from typing import Any

ORDERED = ("parameters", "inputs", "elements")
MAX_SIZE = 1e300
#: Values that an entry has where it is left out; a law "0" says something, but as a rest.
NOTHING: tuple[Any, ...] = (None, False, "", [])
NO_REST = ["rest", "0"]


def to_toml(data: Mapping[str, Any]) -> str:
    """Return spec data as TOML: a line for each parameter and input, a table for each element."""
    single = ("model", "parameters", "inputs", "domain", "initial")
    blocks = [_table(name, data[name]) for name in single if data.get(name)]
    for kind in ("components", "elements", "banks"):
        blocks += [_table(f"{kind}.{name}", row) for name, row in data.get(kind, {}).items()]
    return "\n".join(blocks)


def _table(name: str, fields: Mapping[str, Any]) -> str:
    return "\n".join([f"[{name}]", *_pairs(fields), ""])


def _pairs(row: Mapping[str, Any]) -> list[str]:
    return [f"{_key(key)} = {inline(value)}" for key, value in row.items()]


def _key(key: str) -> str:
    return _dumped({key: 0}).partition(" =")[0]


def inline(value: Any) -> str:
    """Return a value as TOML on one line."""
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(inline(item) for item in value)}]"
    if isinstance(value, Mapping):
        return f"{{ {', '.join(_pairs(value))} }}"
    return _dumped({"value": value}).partition("= ")[2]


def _dumped(pair: Mapping[str, Any]) -> str:
    import tomli_w

    return tomli_w.dumps(pair).strip()


def spec_hash(data: Mapping[str, Any]) -> str:
    """Return the SHA-256 of spec data.

    Order counts where it means something: among parameters, inputs, elements and their states.
    Entries without effect (0, "", false, an empty list, a rest "0") are left out of the hash.
    """
    rows = {name: _rows(table, name in ORDERED) for name, table in data.items()}
    tables = {name: table for name, table in rows.items() if table}
    canonical = json.dumps(sorted(tables.items()), ensure_ascii=True, separators=(",", ":"))
    return hashlib.sha256(canonical.encode()).hexdigest()


def _rows(table: Mapping[str, Any], ordered: bool) -> list[Any]:
    rows = [[key, _canonical(value, key == "states")] for key, value in table.items()]
    said = (row for row in rows if row[1] not in NOTHING and row != NO_REST)
    return rows if ordered else sorted(said)


def _canonical(value: Any, ordered: bool = False) -> Any:
    match value:
        case bool() | str() | None:
            return value
        case int() | float() if abs(value) <= MAX_SIZE:
            return float(value) + 0.0  # -0.0 is 0.0
        case Mapping():
            return _rows(value, ordered)
        case list() | tuple():
            return [_canonical(item) for item in value]
    return str(value)  # nan, a date: no valid spec has them, so their hash must differ from any
