"""Elements rewritten as others: the states of a storage as stores, a stop as a store with a slip.

Input: the tables of elements.  Output: tables of the kinds in `kinds`.
"""

from collections.abc import Iterator, Mapping
from typing import Any

from .kinds import Kind
from .laws import need, parse

#: For each size field of a stop: the kind of its store, and the letters of effort and rate.
SIZES = {"stiffness": ("spring", "f", "v"), "capacitance": ("capacitor", "v", "i")}


def stem(name: str) -> str:
    """Return the name of an element in the spec; for one state of a storage, the storage's name."""
    return name.partition(".")[0]


def joins(kind: Kind, entry: Mapping[str, Any]) -> bool:
    """Return whether an element has lanes that are in parallel with one state."""
    alone = "count" in entry and not {"slip", "bank", "series"} & {*entry}
    return alone and kind.form == "store" and kind.across


def parts(elements: Mapping[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the elements, a storage as one store for each state, or a body for an entropy."""
    for name, entry in elements.items():
        named = name.isidentifier() and not entry["kind"].startswith("=")
        need(named, f"elements.{name[:60]} has a wrong key, or no name")
        if entry["kind"] != "storage":
            yield name, entry
            continue
        rates = [own["rate"] for own in entry["states"].values()]
        valid = set(entry) == {"kind", "energy", "states"} and rates.count("entropy") < 2 and rates
        need(valid, f"elements.{name} has a wrong key, or two entropies")
        for state, own in entry["states"].items():
            part = {**own, "kind": f"={own['rate']}", "energy": entry["energy"], "state": state}
            del part["rate"]
            yield name if own["rate"] == "entropy" else f"{name}.{state}", part


def slipping_store(name: str, entry: Mapping[str, Any]) -> dict[str, Any]:
    """Return a stop as a spring or capacitor whose slip takes the rate beyond the limit."""
    (size,) = (field for field in SIZES if field in entry)
    kind, f, v, limit = *SIZES[size], entry["limit"]
    parse(limit)  # it must be a law by itself, before it is put into brackets
    slip = f"({v} if {f} >= ({limit}) else 0) if {v} > 0 else ({v} if {f} <= -({limit}) else 0)"
    given = {"kind": kind, "slip": slip, "discontinuous": True, "state": f"z_{name}"}
    others = {field: entry[field] for field in entry if field not in ("kind", "limit")}
    known = {"between", "count", "bank", "series", "heats", "state", size}
    need(known >= set(others), f"{name} has a wrong key")
    return given | others
