"""The tables of a spec, field by field, as frozen pydantic types.

Input: TOML data or Python arguments.  Output: `Header`, `Parameter`, `Input`, `Domain`, `Bank`,
`Component` and the type of an element, each checked by itself; `checks` compares them.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Annotated, Any, Union, final

from pydantic import (
    AfterValidator,
    BeforeValidator,
    Field,
    InstanceOf,
    PlainSerializer,
    PrivateAttr,
    StrictStr,
    StringConstraints,
    WithJsonSchema,
)

from piezo_sym.expressions.units import Unit, parse_unit, to_si
from piezo_sym.spec.elements import KINDS
from piezo_sym.spec.elements.base import Frozen
from piezo_sym.spec.elements.marks import Count, Ends, Node
from piezo_sym.spec.origins import Origins
from piezo_sym.spec.table import Table

MAX_TEXT = 400
MAX_SIZE = 1e300
Schema = dict[str, Any]


def _number(value: Any) -> float:
    """Accept an int or a float that is finite; not a boolean, not a quoted number."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise ValueError("a plain number")
    if isinstance(value, float) and not math.isfinite(value):
        raise ValueError("a finite number")
    if abs(value) > MAX_SIZE:
        raise ValueError("a number up to 1e300")
    return float(value) + 0.0  # -0.0 is 0.0


def _text_or(read: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """Return a validator that leaves a text as it is, and applies `read` to other values."""
    return lambda value: value if isinstance(value, str) else read(value)


def _listed(read: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """Return a validator that applies `read` to a value, or to each item of a list."""
    return lambda value: (
        tuple(map(read, value)) if isinstance(value, (list, tuple)) and value else read(value)
    )


def _one_or_list(item: Schema) -> Schema:
    """Return the schema of an item or a list of them; each keyword applies to one type alone."""
    types = item["type"] if isinstance(item["type"], list) else [item["type"]]
    return item | {"type": [*types, "array"], "items": item, "minItems": 1}


def _plain(text: str) -> str:
    if not text.isprintable():
        raise ValueError("text on one line, without control characters")
    return text


#: The values that the validators above accept, stated for JSON Schema.
NUMBER: Schema = {"type": "number", "minimum": -MAX_SIZE, "maximum": MAX_SIZE}
LAW_OR_NUMBER: Schema = NUMBER | {"type": ["number", "string"]}

Number = Annotated[float, BeforeValidator(_number), WithJsonSchema(NUMBER)]
Values = Annotated[
    float | tuple[float, ...],
    BeforeValidator(_listed(_number)),
    WithJsonSchema(_one_or_list(NUMBER)),
]
Replacement = Annotated[
    str | float | tuple[float, ...],
    BeforeValidator(_text_or(_listed(_number))),
    WithJsonSchema(_one_or_list(NUMBER) | {"type": ["number", "string", "array"]}),
]
Start = Annotated[
    str | float | tuple[str | float, ...],
    BeforeValidator(_listed(_text_or(_number))),
    WithJsonSchema(_one_or_list(LAW_OR_NUMBER)),
]
Text = Annotated[StrictStr, StringConstraints(max_length=MAX_TEXT), AfterValidator(_plain)]


UnitText = Annotated[
    StrictStr,
    Field(
        description="Names joined by * and /, with powers: 'N*s/m', 'm**2', 'N/(m/s)**(1/2)', '1'."
    ),
]
Doc = Annotated[Text, Field(description="What it is, on one line.")]


@final
class Header(Frozen):
    """The [model] table: the model's name, and what a reader should know of it."""

    name: Annotated[StrictStr, Field(description="The model's name; names the generated files.")]
    title: Annotated[Text, Field(description="What it models, on one line.")] = ""
    source: Annotated[Text, Field(description="Where its equations and values are from.")] = ""


@final
class Parameter(Frozen):
    """A constant of the model: value in its unit; a list is a value for each lane of one bank."""

    value: Annotated[Values, Field(description="In `unit`; a list: one per lane of one bank.")]
    unit: UnitText
    doc: Doc = ""

    @property
    def dimension(self) -> Unit:
        """The parsed unit."""
        return parse_unit(self.unit)

    @property
    def lanes(self) -> tuple[float, ...]:
        """The values in coherent SI, one or one per lane."""
        values = self.value if isinstance(self.value, tuple) else (self.value,)
        return tuple(to_si(value, self.dimension) for value in values)

    @property
    def si(self) -> float | tuple[float, ...]:
        """The value in coherent SI, a tuple if it is given per lane."""
        return self.lanes if isinstance(self.value, tuple) else self.lanes[0]


@final
class Input(Frozen):
    """An input of the model, with the value it has where a run gives none."""

    unit: UnitText
    default: Annotated[Number, Field(description="In `unit`, where a run gives no value.")] = 0.0
    doc: Doc = ""

    @property
    def dimension(self) -> Unit:
        """The parsed unit."""
        return parse_unit(self.unit)

    @property
    def si(self) -> float:
        """The default in coherent SI."""
        return to_si(self.default, self.dimension)


@final
class Domain(Frozen):
    """The conditions under which proofs hold, and which every run keeps."""

    assume: Annotated[
        tuple[StrictStr, ...],
        Field(description="Comparisons of parameters, inputs, states and T, such as 'd >= 0'."),
    ] = ()


#: One of the registered kinds, told apart by `kind`.
AnyElement: Any = Annotated[Union[tuple(KINDS.values())], Field(discriminator="kind")]  # noqa: UP007


@final
@dataclass(frozen=True)
class Included:
    """The model of a component, and the text by which the spec names it, if there is one."""

    model: "Tables"
    text: str = field(default="", compare=False)


@final
class Component(Frozen):
    """A model as a part of another; its names get the component's name in front."""

    spec: Annotated[
        InstanceOf[Included],
        PlainSerializer(lambda included: included.text),
        WithJsonSchema({"type": "string"}),
        Field(description="A shipped name, or the path of a spec in this file's folder."),
    ]
    nodes: Annotated[
        Table[Node], Field(description="Its nodes on ours; others become '<component>.<node>'.")
    ] = Table()
    parameters: Annotated[
        Table[Replacement],
        Field(description="Values of its parameters, in its units, or parameters of this spec."),
    ] = Table()
    inputs: Annotated[
        Table[StrictStr],
        Field(description="Inputs of this spec for its own; others become '<component>_<input>'."),
    ] = Table()
    without: Annotated[
        tuple[StrictStr, ...],
        Field(description="Elements that are left out, with inputs that only they used."),
    ] = ()


@final
class Bank(Frozen):
    """Cells of several elements, all alike but for parameters and states that are lists."""

    count: Annotated[Count, Field(description="How many cells there are.")]
    series: Ends = None
    elements: Annotated[
        Table[AnyElement],
        Field(description="Of one cell, by name; nodes that stand in no other table are its own."),
    ]


class Tables(Frozen):
    """All tables of a spec, each right in itself."""

    model: Header
    parameters: Table[Parameter] = Table()
    inputs: Table[Input] = Table()
    domain: Domain = Domain()
    initial: Table[Start] = Table()
    components: Table[Component] = Table()
    elements: Table[AnyElement] = Table()
    banks: Table[Bank] = Table()

    _origins: Origins = PrivateAttr(Origins())

    @property
    def origins(self) -> Origins:
        """Where the rows of a flat model were written."""
        return self._origins

    @property
    def joined(self) -> dict[str, int]:
        """How many stores are joined into each state that `count` makes of several."""
        return self._joined

    @cached_property
    def _joined(self) -> dict[str, int]:  # private: iteration over a model skips such a name
        several = ((name, e) for name, e in self.elements.items() if e.joined > 1)
        return {s: e.joined for name, e in several for s in e.own_states(name)}
