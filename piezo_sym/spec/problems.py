"""Field faults in one line: pydantic's list of errors to one `SpecError`.

Input: a `ValidationError` and the data it is about.  Output: the first fault, with its place as a
dotted path, what was expected there and, for unknown words, the nearest known one.
"""

from collections.abc import Iterable, Mapping
from typing import Any, get_args

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from piezo_sym.errors import SpecError, listing, nearest, quote
from piezo_sym.spec.elements import KINDS
from piezo_sym.spec.fields import Tables

ENTRIES = {  # what to write for an entry of a table
    "parameters": '{{ value = {value}, unit = "N/m" }}, with its own unit; "1" is none',
    "inputs": '{{ unit = "V" }}, with its own unit',
}
NEEDED = {  # examples of keys whose name alone does not say what to write
    "unit": 'unit = "N/m", say; unit = "1" where there is none',
    "heats": 'heats = "body", the name of an element of kind thermal_mass',
    "value": "value = 1.0, or a list of one per lane",
}


def first_problem(error: ValidationError) -> SpecError:
    """Return the first of pydantic's errors as a `SpecError`."""
    details = error.errors(include_url=False)
    # a misspelled key explains a missing one, so it comes first
    first, *others = sorted(details, key=lambda detail: detail["type"] != "extra_forbidden")
    problem = _problem(first)
    count = sum(not _explained(other, first, problem) for other in others)
    more = f"{count} more fault{'s' * (count > 1)} in this spec" if count else ""
    problem.remedy = "; ".join(filter(None, (problem.remedy, more)))
    return problem


def _explained(other: ErrorDetails, first: ErrorDetails, problem: SpecError) -> bool:
    """Return whether a key is missing only because the first fault is its misspelled name."""
    meant = problem.remedy == f"did you mean '{other['loc'][-1]}'?"
    return other["type"] == "missing" and meant and other["loc"][:-1] == first["loc"][:-1]


def _problem(detail: ErrorDetails) -> SpecError:
    place = [str(part) for part in detail["loc"]]
    known = _known(place)
    if "elements" in place[:3:2] and len(place) > (at := place.index("elements") + 2):
        del place[at]  # pydantic names the kind here
    where = ".".join(place) or "spec"
    value = detail.get("input")
    match detail["type"]:
        case "extra_forbidden":
            return SpecError(
                f"unknown key {quote(place[-1])}", where, remedy=nearest(place[-1], known)
            )
        case "missing" if isinstance(detail["loc"][-1], int):
            count = detail["loc"][-1]
            entries = "1 entry is given" if count == 1 else f"{count} entries are given"
            return SpecError(entries, ".".join(place[:-1]), f"at least {count + 1}")
        case "missing":
            return SpecError("is missing", where, remedy=_missing(place[-1], known))
        case "union_tag_invalid":
            kind = value.get("kind") if isinstance(value, Mapping) else value
            remedy = nearest(str(kind), KINDS)
            return SpecError(f"unknown kind {quote(kind)}", f"{where}.kind", remedy=remedy)
        case "union_tag_not_found":
            return SpecError("is missing", f"{where}.kind", f"one of {listing(KINDS, 20)}")
        case "string_pattern_mismatch":
            expected = "up to 40 letters, digits or . _ + -"
            return SpecError(f"{quote(value)} is not a label", where, expected)
        case "value_error" if isinstance(value, Mapping):
            return SpecError("its fields do not go together", where, _expected(detail))
        case "model_type" | "dict_type" if place[0] in ENTRIES and len(place) == 2:
            expected = ENTRIES[place[0]].format(value=_number(value))
            return SpecError(f"{quote(value)} does not fit", where, expected)
    return SpecError(f"{quote(value)} does not fit", where, _expected(detail))


def _missing(key: str, known: Iterable[str]) -> str:
    """Return what to write for a key that is missing."""
    more = NEEDED.get(key)
    return f"add {more}" if more else f"add it; known keys: {listing(known)}"


def _number(value: object) -> str:
    return str(value) if isinstance(value, int | float) else "1.0"


def _expected(detail: ErrorDetails) -> str:
    if detail["type"] == "tuple_type" and detail["loc"][-1] == "assume":
        return f'a list of conditions, such as ["{detail["input"]}"]'
    if detail["type"] == "string_type" and isinstance(detail["input"], int | float):
        key, value = detail["loc"][-1], detail["input"]
        return f'text: {key} = "a", where [parameters] has a = {{ value = {value}, unit = ... }}'
    if detail["type"] in {"tuple_type", "too_long"} and detail["loc"][-1] != "assume":
        return "a list of two names, such as ['a', 'b']"
    if detail["type"] == "value_error":
        return str(detail.get("ctx", {}).get("error", detail["msg"]))
    message = detail["msg"].removeprefix("Input should be ")
    return message[:1].lower() + message[1:]


def _known(place: list[str]) -> Iterable[str]:
    """Return the keys of the table in which `place` stands."""
    kind: Any = Tables
    if "elements" in place[:3:2] and len(place) > (at := place.index("elements") + 2):
        kind = KINDS.get(place[at])
    elif len(place) > 1:
        table = Tables.model_fields.get(place[0])
        kind = table and next(iter(get_args(table.annotation)), table.annotation)
    return tuple(getattr(kind, "model_fields", ()))
