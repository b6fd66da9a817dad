"""Faults of a spec, a line each: pydantic's list of errors to one `SpecError` with notes.

Input: a `ValidationError` and the data it is about.  Output: the first fault, with its place as a
dotted path, what was expected there and, for unknown words, the nearest known one; and as many
lines of the same kind, its notes, as there are other faults.
"""

import json
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager
from typing import Any, get_args

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from piezo_sym.errors import SpecError, listing, nearest, quote, similar
from piezo_sym.expressions.grammar import MAX_LENGTH
from piezo_sym.expressions.incomplete import conditions_of
from piezo_sym.spec.elements import KINDS
from piezo_sym.spec.fields import Tables

ENTRIES = {  # what to write for an entry of a table
    "parameters": '{{ value = {value}, unit = "N/m" }}, with its own unit; "1" is none',
    "inputs": '{{ unit = "V" }}, with its own unit',
    "banks": "a table: [{where}] with count = 3, and below [{where}.elements] those of one cell",
    "elements": "a table: below [{where}] the lines of its elements, which stand there alone, such "
    'as {name} = {{ kind = "spring", between = ["tip", "wall"], stiffness = "k" }}',
}
NEEDED = {  # examples of keys whose name alone does not say what to write
    "unit": 'unit = "N/m", say; unit = "1" where there is none',
    "value": "value = 1.0, or a list of one per lane",
}
#: What to write for what has no kind of its own.
MEANT = {
    'write a spring with force = "k_c*max(q - gap, 0)"': ("end_stop", "endstop", "contact"),
    "hysteresis is a 'stop', or a 'slip' of a spring or capacitor: piezo-sym kinds stop": (
        *("dahl", "bouc_wen", "maxwell_slip", "play", "hysteresis", "slip", "lugre"),
    ),
    "write a 'velocity_source', with the rate of the displacement: a square for a triangle": (
        *("displacement_source", "position_source", "motion_source", "displacement", "motion"),
    ),
    "a bank is an element with count = 3, or a table [banks.<name>]: piezo-sym kinds": (
        *("bank", "bank_of", "cells", "ladder", "creep"),
    ),
}
#: A number in quotes, with a point or a comma.
NUMBER = re.compile(r"\s*[-+]?(\d+[.,]?\d*|[.,]\d+)([eE][-+]?\d+)?\s*")
#: The kind of a body that takes heat.
BODY = "thermal_mass"
#: The keys for the nodes of an element, each taken for the other.
NODES = {
    "at": "it stands at one node, and its other one is the reference",
    "between": "it has two nodes",
}
#: The faults that may have caused others come first: unknown keys, then missing ones.
FIRST = ("extra_forbidden", "missing")
#: The most faults that are shown.
MOST_FAULTS = 20


def all_problems(error: ValidationError, spec: Mapping[str, Any]) -> SpecError:
    """Return pydantic's errors on a spec as a `SpecError`; all but the first are its notes."""
    details = error.errors(include_url=False)
    place = {kind: n for n, kind in enumerate(FIRST)}
    details.sort(key=lambda detail: place.get(detail["type"], len(FIRST)))
    # a key is missing only because it stands there under a misspelled name
    unknown = [d for d in details if d["type"] == FIRST[0]]
    meant = {(*d["loc"][:-1], _meant_key(d, _left(d, spec))) for d in unknown}
    found = (
        _unknown_key(d, _left(d, spec)) if d["type"] == FIRST[0] else _problem(d, spec)
        for d in details
        if d["type"] != "missing" or d["loc"] not in meant
    )
    return together({str(fault): fault for fault in found}.values())


def together(faults: Iterable[SpecError]) -> SpecError:
    """Return the first of some errors; all others are its notes."""
    problem, *others = faults
    for other in others[: MOST_FAULTS - 1]:
        problem.add_note(str(other))
    if more := len(others[MOST_FAULTS - 1 :]):
        problem.add_note(f"{more} more fault{'s' * (more > 1)} in this spec")
    return problem


@contextmanager
def all_faults() -> Iterator[Callable[[], AbstractContextManager[None]]]:
    """Yield a context that catches a `SpecError`; raise all that were caught at the end.

    Of errors with the same text, as of one unknown word in two laws, the first is kept.
    """
    faults: dict[str, SpecError] = {}

    @contextmanager
    def kept() -> Iterator[None]:
        try:
            yield
        except SpecError as error:
            faults.setdefault(error.what, error)

    yield kept
    if faults:
        raise together(faults.values())


def _left(detail: ErrorDetails, spec: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the known keys of the table with an unknown key, without those an element has."""
    _, known = _place(detail)
    if "elements" not in detail["loc"][:-1]:
        return known
    table: Any = spec
    for part in detail["loc"][:-1]:  # pydantic's place also has the kind
        table = table.get(part, table) if isinstance(table, Mapping) else {}
    return tuple(key for key in known if key not in table) or known


def _meant_key(detail: ErrorDetails, known: Iterable[str]) -> str:
    """Return the known key that an unknown one may be meant for, or ''."""
    key = str(detail["loc"][-1])
    other = next((node for node in NODES if node in known and key in NODES), "")
    return other or similar(key, known)


def _unknown_key(detail: ErrorDetails, known: Iterable[str]) -> SpecError:
    key, meant = str(detail["loc"][-1]), _meant_key(detail, known)
    remedy = nearest(key, known)
    if key in NODES and meant in NODES:
        remedy = f"did you mean '{meant}'? {NODES[meant]}"
    return SpecError(f"unknown key {quote(key)}", _place(detail)[0], remedy=remedy)


def meant_kind(kind: str) -> str:
    """Return what to write instead of an unknown kind: another element, or a similar name."""
    word = kind.lower().replace("-", "_")
    return next((say for say, words in MEANT.items() if word in words), nearest(kind, KINDS))


def _place(detail: ErrorDetails) -> tuple[str, tuple[str, ...]]:
    """Return the dotted path of what a detail is about, and the keys of the table it stands in."""
    place = [str(part) for part in detail["loc"]]
    table: Any = Tables
    if "elements" in place[:3:2] and len(place) > (at := place.index("elements") + 2):
        table = KINDS.get(place.pop(at))  # pydantic names the kind here
    elif len(place) > 1:
        field = Tables.model_fields.get(place[0])
        table = field and next(iter(get_args(field.annotation)), field.annotation)
    return ".".join(place) or "spec", tuple(getattr(table, "model_fields", ()))


def _problem(detail: ErrorDetails, spec: Mapping[str, Any]) -> SpecError:
    place, value = [str(part) for part in detail["loc"]], detail.get("input")
    where, known = _place(detail)
    match detail["type"]:
        case "missing" if isinstance(detail["loc"][-1], int):
            entries = "1 entry is given" if len(value) == 1 else "no entry is given"
            return SpecError(entries, where.rpartition(".")[0], "two names, such as ['a', 'b']")
        case "missing":
            return SpecError("is missing", where, remedy=_missing(place[-1], known, spec))
        case "union_tag_invalid":
            kind = value.get("kind") if isinstance(value, Mapping) else value
            remedy = meant_kind(str(kind))
            return SpecError(f"unknown kind {quote(kind)}", f"{where}.kind", remedy=remedy)
        case "union_tag_not_found":
            return SpecError("is missing", f"{where}.kind", f"one of {listing(KINDS, 20)}")
        case "string_pattern_mismatch":
            expected = "up to 40 letters, digits or . _ + -"
            return SpecError(f"{quote(value)} is not a label", where, expected)
        case "value_error" if isinstance(value, Mapping):
            return SpecError("its fields do not go together", where, _expected(detail))
        case "model_type" | "dict_type" if (table := place[len(place) > 2 and -1]) in ENTRIES:
            name = value[0] if isinstance(value, list) and value else "spring"
            number = value if isinstance(value, int | float) else "1.0"
            expected = ENTRIES[table].format(value=number, where=where, name=name)
            return SpecError(f"{quote(value)} does not fit", where, expected)
        case "value_error" if isinstance(value, str) and NUMBER.fullmatch(value):
            remedy = f"write {value.replace(',', '.').strip()}, with a point and without quotes"
            return SpecError(f"{quote(value)} is a text", where, _expected(detail), remedy)
    return SpecError(f"{quote(value)} does not fit", where, _expected(detail))


def _missing(key: str, known: Iterable[str], spec: Mapping[str, Any]) -> str:
    """Return what to write for a key that is missing."""
    more = NEEDED.get(key) if key != "heats" else _heats(spec)
    return f"add {more}" if more else f"add it; known keys: {listing(known)}"


def _heats(spec: Mapping[str, Any]) -> str:
    """Return what to write for the body that an element heats: one of the spec, if it has any."""
    elements = spec.get("elements")
    table = elements if isinstance(elements, Mapping) else {}
    hot = [n for n, e in table.items() if isinstance(e, Mapping) and e.get("kind") == BODY]
    if not hot:
        return f'heats = "body", and an element body of kind {BODY}: `piezo-sym kinds {BODY}`'
    return f'heats = "{hot[0]}", {f"or another {BODY}" if hot[1:] else f"the {BODY}"}'


def _expected(detail: ErrorDetails) -> str:
    if detail["type"] == "tuple_type" and detail["loc"][-1] == "assume":
        given = detail["input"]
        short = isinstance(given, str) and len(given) <= MAX_LENGTH
        parts = conditions_of(given) if short else ["d >= 0"]
        return f"a list of conditions, such as {json.dumps(parts)}"
    number = detail["type"] == "string_type" and isinstance(detail["input"], int | float)
    if number and "elements" in detail["loc"]:
        key, value = detail["loc"][-1], detail["input"]
        return f'text: {key} = "a", where [parameters] has a = {{ value = {value}, unit = ... }}'
    if number and detail["loc"][0] == "components" and "inputs" in detail["loc"]:
        return "the name of an input of this spec; for a fixed value, give that one a default"
    if detail["type"] in {"tuple_type", "too_long"} and detail["loc"][-1] != "assume":
        return "a list of two names, such as ['a', 'b']"
    if detail["type"] == "value_error":
        return str(detail.get("ctx", {}).get("error", detail["msg"]))
    message = detail["msg"].removeprefix("Input should be ")
    return message[:1].lower() + message[1:]
