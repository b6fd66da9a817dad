"""JSON Schema of a spec, draft 2020-12, for editors and for other programs' checks.

Input: the types of a spec (`Model` and the registered kinds).  Output: plain data, the same in
every run, that accepts every spec which `load` accepts and refuses unknown keys, missing keys and
values of the wrong type.  What holds between tables (names, laws, units) is left to `load`.
"""

import warnings
from collections.abc import Mapping
from typing import Any

from pydantic.json_schema import PydanticJsonSchemaWarning

from piezo_sym.spec.elements import KINDS
from piezo_sym.spec.elements.base import Element
from piezo_sym.spec.model import Model
from piezo_sym.spec.names import MAX_NAME, NAME

DIALECT = "https://json-schema.org/draft/2020-12/schema"
NAMES = {"pattern": f"^{NAME.pattern}$", "maxLength": MAX_NAME}
TABLES = {
    "parameters": "Constants of the model, by symbol.",
    "inputs": "Inputs of the model, by symbol, in the order in which modules take them.",
    "initial": "Initial states by symbol, in SI; 0 if not said; laws of parameters and inputs.",
    "components": "Other models as parts of this one, by name; see their fields.",
    "elements": "Elements by name; states and processes follow their order.",
    "banks": "Cells of several elements, many alike, by name; see their fields.",
}

Schema = dict[str, Any]


def schema() -> Schema:
    """Return the JSON Schema of a spec."""
    with warnings.catch_warnings():  # an empty table is a default that JSON Schema does not need
        warnings.simplefilter("ignore", PydanticJsonSchemaWarning)
        made = _tidy(Model.model_json_schema())
    for name, description in TABLES.items():
        made["properties"][name] |= {"description": description, "propertyNames": NAMES}
    definitions = made.pop("$defs")
    definitions["Header"]["properties"]["name"] |= NAMES
    for kind, element in KINDS.items():
        definitions[element.__name__] = _element(kind, element, definitions[element.__name__])
    made["properties"]["elements"]["additionalProperties"] = {"$ref": "#/$defs/Element"}
    definitions["Bank"]["properties"]["elements"] |= {
        "additionalProperties": {"$ref": "#/$defs/Element"},
        "propertyNames": NAMES,
    }
    definitions["Element"] = _union()
    return {"$schema": DIALECT, "title": "piezo_sym spec", **made, "$defs": definitions}


def _element(kind: str, element: type[Element], made: Schema) -> Schema:
    """Return a kind's schema, in which `kind` is required, and one field of each group."""
    made["properties"]["kind"] = {"const": kind, "description": "The kind of this element."}
    made["required"] = ["kind", *made.get("required", ())]
    groups = element.row.one_of
    if groups:
        made["allOf"] = [{"oneOf": [{"required": [f]} for f in group]} for group in groups]
    return made


def _union() -> Schema:
    """Return the schema of any element, told apart by `kind`.

    A chain of if and then names the wrong key, where a plain oneOf says only that no kind fits.
    Editors complete from the anyOf, which refuses nothing.
    """
    found = {kind: {"$ref": f"#/$defs/{element.__name__}"} for kind, element in KINDS.items()}
    return {
        "description": "An element of the network; its `kind` says which keys it has.",
        "type": "object",
        "required": ["kind"],
        "properties": {"kind": {"enum": list(KINDS)}},
        "allOf": [{"if": _is_of(kind), "then": reference} for kind, reference in found.items()],
        "anyOf": [*found.values(), True],
    }


def _is_of(kind: str) -> Schema:
    return {"properties": {"kind": {"const": kind}}, "required": ["kind"]}


def _tidy(node: Any) -> Any:
    """Return a schema without what TOML cannot say (null) and what some editors do not read."""
    if isinstance(node, list):
        return [_tidy(part) for part in node]
    if not isinstance(node, Mapping):
        return node
    made = {key: _tidy(value) for key, value in node.items() if not _idle(key, value)}
    if isinstance(made.get("description"), str):
        made["description"] = _flowing(made["description"])
    return _alike(_present(made))


def _idle(key: str, value: Any) -> bool:
    """Return whether an entry says nothing: a title made from a name, null where a key is left."""
    return (key == "title" and isinstance(value, str)) or (key == "default" and value is None)


def _flowing(text: str) -> str:
    """Return a docstring's description: each paragraph on one line, the sections left out."""
    about = text.partition("\n\nAttributes\n")[0]
    return "\n\n".join(" ".join(part.split()) for part in about.split("\n\n"))


def _present(made: Schema) -> Schema:
    """Return the schema of a field that may be left out: of what it is when it is there."""
    parts = made.get("anyOf", [])
    kept = [part for part in parts if part != {"type": "null"}]
    if len(kept) == len(parts):
        return made
    rest = {key: value for key, value in made.items() if key != "anyOf"}
    return {**kept[0], **rest} if len(kept) == 1 else {**rest, "anyOf": kept}


def _alike(made: Schema) -> Schema:
    """Return the schema of a tuple of like items with one schema for all, which every draft has."""
    items = made.get("prefixItems")
    if not items or any(item != items[0] for item in items):
        return made
    rest = {key: value for key, value in made.items() if key != "prefixItems"}
    return {**rest, "items": items[0]}
