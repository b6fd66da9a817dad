"""Elements as others: the states of a storage as stores, a stop as a store that slips.

Input: the tables of elements.  Output: tables of the kinds in `kinds`.
"""

from collections.abc import Iterator, Mapping
from typing import Any

from .laws import need, parse

#: What a stop of this size is a kind of, and the letters of its effort and its rate.
SIZES = {"stiffness": ("spring", "f", "v"), "capacitance": ("capacitor", "v", "i")}


def whole(name: str) -> str:
    """Return the element of the spec that an element, perhaps a state of a storage, is of."""
    return name.partition(".")[0]


def parts(elements: Mapping[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the elements, and for a storage a store of each of its states, or a body."""
    for name, entry in elements.items():
        named = name.isidentifier() and not entry["kind"].startswith("=")
        need(named, f"elements.{name[:60]} has a wrong key, or no name")
        if entry["kind"] != "storage":
            yield name, entry
            continue
        rates = [own["rate"] for own in entry["states"].values()]
        good = set(entry) == {"kind", "energy", "states"} and rates.count("entropy") < 2 and rates
        need(good, f"elements.{name} has a wrong key, or two entropies")
        for state, own in entry["states"].items():
            part = {**own, "kind": f"={own['rate']}", "energy": entry["energy"], "state": state}
            del part["rate"]
            yield name if own["rate"] == "entropy" else f"{name}.{state}", part


def slipping(name: str, entry: Mapping[str, Any]) -> dict[str, Any]:
    """Return a stop as a spring or capacitor with a slip, that of the rate it is projected on."""
    (size,) = (field for field in SIZES if field in entry)
    kind, f, v, limit = *SIZES[size], entry["limit"]
    parse(limit)  # it is put into brackets
    slip = f"({v} if {f} >= ({limit}) else 0) if {v} > 0 else ({v} if {f} <= -({limit}) else 0)"
    given = {"kind": kind, "slip": slip, "discontinuous": True, "state": f"z_{name}"}
    others = {field: entry[field] for field in entry if field not in ("kind", "limit")}
    need(
        {"between", "count", "bank", "series", "heats", "state", size} >= set(others),
        f"{name} has a wrong key",
    )
    return given | others
