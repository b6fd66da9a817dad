"""A spec with a false verdict to the smallest one that has it still.

Input: a spec as data, and a test of whether it is still at fault.  Output: data.  Elements,
conditions and fields go first, then parts of laws give way to their own parts, names or numbers,
then what nothing uses any more.
"""

import copy
import time

from tests.search.laws import ONE, ZERO, changed, names, paths, read, text
from tests.search.reading import LAWS, POSITIVE

TEXTS = (*LAWS, *POSITIVE, "ratio", "conductance", "temperature")


def shrunk(data, still, seconds=120, element=""):
    """Return the smallest spec found within a time; the law at fault is tried alone first.

    Parameters
    ----------
    still : data -> whether the fault is there.
    """
    end = time.monotonic() + seconds
    before, others = None, [n for n, e in data["elements"].items() if n != element and _is_bent(e)]
    if still(_linear(data, others)):
        data = _linear(data, others)
    while data != before and time.monotonic() < end:
        before = data
        for steps in (_plain, _halves, _elements, _assumed, _fields, _laws, _conditions, _unused):
            data = _taken(data, steps, still, end)
    return data


def _taken(data, steps, still, end):
    """Return the data after each step that leaves the fault in it."""
    taken = True
    while taken and time.monotonic() < end:
        taken = False
        for smaller in steps(data):
            if time.monotonic() > end:
                return data
            if still(smaller):
                data, taken = smaller, True
                break
    return data


def _without(data, table, keys):
    made = copy.deepcopy(data)
    for key in keys:
        del made[table][key]
    return made


def _plain(data):
    """Yield the spec with the laws of a part of its elements linear: these cost no time."""
    found = [n for n, e in data["elements"].items() if _is_bent(e)]
    for parts in (2, 4, 8):
        size = max(len(found) // parts, 1)
        for n in range(0, len(found), size):
            yield _linear(data, found[n : n + size])


def _is_bent(element):
    return any(key in element and element[key] != LAWS[key][0] for key in LAWS)


def _linear(data, elements):
    made = copy.deepcopy(data)
    for name in elements:
        key = next(key for key in LAWS if key in made["elements"][name])
        made["elements"][name][key] = LAWS[key][0]
    return made


def _halves(data):
    """Yield the spec without half, a quarter, an eighth of its dissipative elements."""
    found = list(data["elements"])
    for parts in (2, 4, 8):
        size = max(len(found) // parts, 1)
        for n in range(0, len(found), size):
            yield _without(data, "elements", found[n : n + size])
            yield _without(data, "elements", _dissipative(data, found[n : n + size]))


def _dissipative(data, keys):
    return [key for key in keys if "heats" in data["elements"][key]]


def _elements(data):
    for name in data["elements"]:
        yield _without(data, "elements", [name])
        for other in data["elements"]:
            if "between" in data["elements"][name] and other != name:
                yield _without(data, "elements", [name, other])


def _assumed(data):
    for n in range(len(data["domain"]["assume"])):
        made = copy.deepcopy(data)
        del made["domain"]["assume"][n]
        yield made


def _fields(data):
    for name, element in data["elements"].items():
        for key in {"count", "state"} & set(element):
            made = copy.deepcopy(data)
            del made["elements"][name][key]
            yield made
        if element.get("temperature", "") != "T_0*exp(S/T_0)" and element["kind"] == "thermal_mass":
            made = copy.deepcopy(data)
            made["elements"][name]["temperature"] = "T_0*exp(S/T_0)"
            made["parameters"]["T_0"] = {"value": 1.0, "unit": "1"}
            yield made


def _laws(data):
    for name, element in data["elements"].items():
        for key in [key for key in TEXTS if key in element]:
            for smaller in _smaller(element[key]):
                made = copy.deepcopy(data)
                made["elements"][name][key] = smaller
                yield made


def _conditions(data):
    for n, condition in enumerate(data["domain"]["assume"]):
        for smaller in _smaller(condition):
            made = copy.deepcopy(data)
            made["domain"]["assume"][n] = smaller
            yield made


def _smaller(law):
    """Yield a law with a part replaced by a part of its own, a name, 1 or 0: shorter texts only."""
    tree = read(law)
    compares = {"<", "<=", ">", ">="}
    for path, part in paths(tree):
        if part[0] in {"num", "name", *compares}:
            continue
        own = [p for p in part[1:] if isinstance(p, tuple) and p[0] not in compares]
        for new in (*own, ONE, ZERO, *(("name", n) for n in names(part))):
            made = text(changed(tree, path, new))
            if len(made) < len(law):
                yield made


def _unused(data):
    """Yield the spec without the parameters and inputs that no text has in it."""
    texts = [str(v) for e in data["elements"].values() for v in e.values()]
    texts = " ".join([*texts, *data["domain"]["assume"]])
    used = set("".join(c if c.isalnum() or c == "_" else " " for c in texts).split())
    for table in ("parameters", "inputs"):
        unused = [name for name in data[table] if name not in used]
        if unused:
            yield _without(data, table, unused)
