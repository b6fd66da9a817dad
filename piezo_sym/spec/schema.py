"""JSON Schema of a spec, draft 2020-12, for editors and for other programs' checks.

Input: the types of a spec (`Model` and the registered kinds).  Output: plain data, the same in
every run, that accepts every spec which `load` accepts and refuses unknown keys, missing keys and
values of the wrong type.  What holds between tables (names, laws, units) is left to `load`.
"""

from typing import Any, final

from pydantic.json_schema import GenerateJsonSchema

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


@final
class _Generator(GenerateJsonSchema):
    """Schemas without null, which TOML does not have, and titles, which only repeat names."""

    ignored_warning_kinds = {"non-serializable-default"}  # noqa: RUF012 - of empty tables

    def field_title_should_be_set(self, schema: Any) -> bool:
        del schema
        return False

    def nullable_schema(self, schema: Any) -> Schema:
        return self.generate_inner(schema["schema"])

    def default_schema(self, schema: Any) -> Schema:
        result = super().default_schema(schema)
        return {key: value for key, value in result.items() if (key, value) != ("default", None)}

    def tuple_schema(self, schema: Any) -> Schema:
        """Return one schema, `items`, for items that are alike: every draft has that."""
        result = super().tuple_schema(schema)
        items = result.get("prefixItems", [None])
        if None in items or any(item != items[0] for item in items):
            return result
        del result["prefixItems"]
        return result | {"items": items[0]}

    def model_schema(self, schema: Any) -> Schema:
        """Return a schema described by the docstring, each paragraph on one line."""
        result = super().model_schema(schema)
        del result["title"]
        about = result.get("description", "").partition("\n\nAttributes\n")[0].split("\n\n")
        return result | {"description": "\n\n".join(" ".join(part.split()) for part in about)}


def schema() -> Schema:
    """Return the JSON Schema of a spec."""
    spec = Model.model_json_schema(schema_generator=_Generator)
    for name, description in TABLES.items():
        spec["properties"][name] |= {"description": description, "propertyNames": NAMES}
    definitions = spec.pop("$defs")
    definitions["Header"]["properties"]["name"] |= NAMES
    for kind, element in KINDS.items():
        definitions[element.__name__] = _element(kind, element, definitions[element.__name__])
    spec["properties"]["elements"]["additionalProperties"] = {"$ref": "#/$defs/Element"}
    definitions["Bank"]["properties"]["elements"] |= {
        "additionalProperties": {"$ref": "#/$defs/Element"},
        "propertyNames": NAMES,
    }
    definitions["Element"] = _union()
    return {"$schema": DIALECT, "title": "piezo_sym spec", **spec, "$defs": definitions}


def _element(kind: str, element: type[Element], kind_schema: Schema) -> Schema:
    """Return a kind's schema, in which `kind` and one of its alternative fields are required."""
    kind_schema["properties"]["kind"] = {"const": kind, "description": "The kind of this element."}
    kind_schema["required"] = ["kind", *kind_schema.get("required", ())]
    if group := element.form.one_of:
        kind_schema["allOf"] = [{"oneOf": [{"required": [field]} for field in group]}]
    return kind_schema


def _union() -> Schema:
    """Return the schema of an element of any kind.

    With if/then on `kind`, an error names the wrong key; with oneOf, it would only say that no kind
    fits.  The anyOf, which refuses nothing, is there for completion in editors.
    """
    refs = {kind: {"$ref": f"#/$defs/{element.__name__}"} for kind, element in KINDS.items()}
    return {
        "description": "An element of the network; its `kind` says which keys it has.",
        "type": "object",
        "required": ["kind"],
        "properties": {"kind": {"enum": list(KINDS)}},
        "allOf": [
            {"if": {"properties": {"kind": {"const": kind}}, "required": ["kind"]}, "then": of_kind}
            for kind, of_kind in refs.items()
        ],
        "anyOf": [*refs.values(), True],
    }
