"""The types of the fields of kinds, marked with what a field names, or with the units of a law.

Input: nothing; these are the types.  Output: annotations for `base.Kind`.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Any, final

from pydantic import (
    Field,
    GetJsonSchemaHandler,
    StrictBool,
    StrictInt,
    StrictStr,
    StringConstraints,
)
from pydantic_core import CoreSchema

from piezo_sym.expressions.parse import parse_law
from piezo_sym.expressions.tree import Expr
from piezo_sym.spec.elements.domains import DOMAINS

MAX_COUNT = 1_000_000
#: The fields of a kind: type, default, and value in the example.
Fields = dict[str, tuple[Any, Any, Any]]


@final
@dataclass(frozen=True)
class Letters:
    """Marks a field as a law: its unit, and the letters it may use besides parameters."""

    units: Mapping[str, str]  # the unit of each letter, such as ``{"i": "A", "T": "K"}``
    unit: str  # the unit of the law itself
    #: Pairs (field, unit): the unit of the law if that field is given.
    instead: tuple[tuple[str, str], ...] = ()
    #: Whether it may use states and temperatures of other elements, by their names.
    sees: bool = False
    own: bool = False  # whether its letters are the states that the element lists

    def of(self, element: Any) -> "Letters":
        """Return the letters and units of a law in one element."""
        given = (unit for field, unit in self.instead if getattr(element, field) is not None)
        own = element.own_states("") if self.own else {}
        return replace(self, units={**self.units, **own}, unit=next(given, self.unit), instead=())

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """Return the field's JSON Schema with these letters in its description."""
        letters = ", ".join(f"{name} [{unit}]" for name, unit in self.units.items())
        also = f" and the letters {letters}" if letters else ""
        others = "".join(f" ({unit} with {field})" for field, unit in self.instead)
        more = ", states and temperatures T_<body>" if self.sees else ""
        text = f"A law in {self.unit}{others}, as text, of parameters{more}{also}."
        return {**handler(schema), "description": text}


@final
@dataclass(frozen=True)
class LawField:
    """A law of an element: its place, text, letters and units."""

    element: str
    field: str
    text: str
    mark: Letters

    @property
    def where(self) -> str:
        """Its place in the spec."""
        return f"elements.{self.element}.{self.field}"

    @property
    def letters(self) -> tuple[str, ...]:
        """The letters it may use besides parameters."""
        return tuple(self.mark.units)

    @property
    def tree(self) -> Expr:
        """The parsed law."""
        return parse_law(self.text, self.where)


@final
@dataclass(frozen=True)
class Refers:
    """Marks a field that holds names, `to` a 'node', an 'input' or a 'thermal_mass'."""

    to: str


_AT_REST = ", ".join(f"'{domain.reference}' ({domain.name})" for domain in DOMAINS)
Node = Annotated[
    StrictStr,
    StringConstraints(pattern=r"^[A-Za-z0-9_.+-]{1,40}$"),
    Refers("node"),
    Field(description=f"A node, any label; references: {_AT_REST}."),
]
Pair = Annotated[
    tuple[Node, Node], Refers("node"), Field(description="Two nodes, [first, second].")
]
OptionalPair = Annotated[Pair | None, Refers("node")]
Law = StrictStr  # each field adds its `Letters`
InputName = Annotated[
    StrictStr, Refers("input"), Field(description="Name of an input, a key of [inputs].")
]
BodyName = Annotated[
    StrictStr, Refers("thermal_mass"), Field(description="Name of an element of kind thermal_mass.")
]
OptionalBody = Annotated[BodyName | None, Refers("thermal_mass")]
BodyPair = Annotated[
    tuple[StrictStr, StrictStr],
    Refers("thermal_mass"),
    Field(description="Names of two elements of kind thermal_mass, [first, second]."),
]
StateName = Annotated[
    StrictStr | None,
    Field(description="Symbol of the state; if not given, the kind's letter, '_' and the name."),
]
Count = Annotated[
    StrictInt,
    Field(ge=1, le=MAX_COUNT, description="Size of the bank; without it there is one lane."),
]
BankName = Annotated[
    StrictStr | None,
    Field(description="Bank whose cell it is a part of, as [banks] writes it; else its own name."),
]
Ends = Annotated[
    Pair | None,
    Refers("node"),
    Field(description="Two nodes, the ends of the chain that lanes in series make."),
]
Jumps = Annotated[StrictBool, Field(description="Whether the law jumps on purpose.")]


def law_field(
    unit: str,
    letters: Mapping[str, str],
    sample: str = "",
    default: Any = ...,
    *,
    sees: bool = False,
    **instead: str,
) -> tuple[Any, Any, Any]:
    """Return a field that is a law; `default` None makes it optional, ``...`` required."""
    mark = Letters(letters, unit, tuple(instead.items()), sees)
    return (Annotated[Law | None if default is None else Law, mark], default, sample)
