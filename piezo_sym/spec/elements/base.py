"""What every kind of element is: a frozen record of spec fields that states its ports.

Input: the fields of one ``[elements.<name>]`` table.  Output: `Port` records.  A kind is a final
class: its fields, and the `Form` of its parts.
"""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, Any, ClassVar, Self, final

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    GetJsonSchemaHandler,
    StrictBool,
    StrictInt,
    StrictStr,
    StringConstraints,
    model_validator,
)
from pydantic_core import CoreSchema

from piezo_sym.expressions.parse import parse_law
from piezo_sym.expressions.tree import ZERO, Cmp, Expr
from piezo_sym.spec.elements.ports import Branch, Port

MAX_COUNT = 1_000_000


@final
@dataclass(frozen=True)
class Letters:
    """Marks a field as a law: the letters it may use besides parameters, and the units of all.

    Attributes
    ----------
    units : the unit of each letter, such as ``{"i": "A", "T": "K"}``.
    unit : the unit of the law itself.
    """

    units: Mapping[str, str]
    unit: str

    @property
    def names(self) -> tuple[str, ...]:
        """The letters."""
        return tuple(self.units)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """Return the field's JSON Schema with these letters in its description."""
        letters = ", ".join(f"{name} [{unit}]" for name, unit in self.units.items())
        also = f" and the letters {letters}" if letters else ""
        text = f"A law in {self.unit}, as text, of parameters{also}."
        return {**handler(schema), "description": text}


@final
@dataclass(frozen=True)
class Refers:
    """Marks a field as the name of something else in the spec: an 'input' or a 'thermal_mass'."""

    to: str


Node = Annotated[
    StrictStr,
    StringConstraints(pattern=r"^[A-Za-z0-9_.+-]{1,40}$"),
    Field(description="A node, any label; 'wall' (mechanical) and 'gnd' (electrical) are at rest."),
]
Pair = Annotated[tuple[Node, Node], Field(description="Two nodes, [first, second].")]
Law = StrictStr  # each field adds its `Letters`
InputName = Annotated[
    StrictStr, Refers("input"), Field(description="Name of an input, a key of [inputs].")
]
BodyName = Annotated[
    StrictStr, Refers("thermal_mass"), Field(description="Name of an element of kind thermal_mass.")
]
StateName = Annotated[
    StrictStr | None,
    Field(description="Symbol of the state; if not given, the kind's letter, '_' and the name."),
]
Count = Annotated[
    StrictInt,
    Field(ge=1, le=MAX_COUNT, description="Size of the bank; without it there is one hysteron."),
]
Jumps = Annotated[StrictBool, Field(description="Whether the law jumps on purpose.")]


class Frozen(BaseModel):
    """Base of the tables of a spec: frozen, and closed to unknown keys."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class Form(ABC):
    """A part of an element: a store, a dissipation, a coupling or a source; see `forms`."""

    @abstractmethod
    def port(self, element: Any, name: str, branch: Branch) -> Port:
        """Return the port of an element called `name`; `branch` is where it stands."""

    def requires(self, element: Any) -> tuple[Cmp, ...]:
        """Return the conditions that this part of an element adds to the domain."""
        del element
        return ()


class Element(Frozen):
    """An element of a network; every kind derives from it directly and is final."""

    #: The parts of the kind; two are in series.
    forms: ClassVar[tuple[Form, ...]] = ()
    #: The letter of the kind's state; empty for kinds without one.
    letter: ClassVar[str] = ""
    #: Fields of which exactly one is to be given: a law and its inverse.
    one_of: ClassVar[tuple[str, ...]] = ()

    kind: str

    @model_validator(mode="after")
    def _one_law(self) -> Self:
        given = [field for field in self.one_of if getattr(self, field) is not None]
        if self.one_of and len(given) != 1:
            said = f"both {' and '.join(given)}" if given else "neither"
            message = f"exactly one of {' and '.join(self.one_of)}; {said} given"
            raise ValueError(message)
        return self

    def ports(self, name: str) -> tuple[Port, ...]:
        """Return the ports of this element, called `name` in its spec."""
        first, last = getattr(self, "between", ("", ""))
        nodes = (first, *(f"{name}:inner" for _ in self.forms[1:]), last)
        return tuple(
            form.port(self, name, branch)
            for form, branch in zip(self.forms, pairwise(nodes), strict=True)
        )

    def requires(self) -> tuple[Cmp, ...]:
        """Return the conditions that this element adds to the domain."""
        return tuple(condition for form in self.forms for condition in form.requires(self))

    @property
    def is_bank(self) -> bool:
        """Whether the element is a bank of parallel lanes: `count` is given, be it 1."""
        return getattr(self, "count", None) is not None

    def law(self, field: str) -> Expr:
        """Return the tree of a law field."""
        return parse_law(getattr(self, field), field)


def positive(law: Expr) -> Cmp:
    """Return the condition that a law is positive."""
    return Cmp(">", law, ZERO)


def state_symbol(element: Element, name: str) -> str:
    """Return the symbol of an element's state: as given, else its kind's letter and its name."""
    return getattr(element, "state", None) or f"{element.letter}_{name}"
