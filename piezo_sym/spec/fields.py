"""The tables of a spec, field by field, as frozen pydantic types.

Input: TOML data or Python arguments.  Output: `Header`, `Parameter`, `Input`, `Domain` and the type
of an element, each right in itself; what must hold between them is `check`'s.
"""

from __future__ import annotations

import math
from typing import Annotated, Any, Union, final

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    StrictStr,
    StringConstraints,
)

from piezo_sym.spec.elements import KINDS
from piezo_sym.spec.units import Unit, parse_unit, to_si

MAX_TEXT = 400
MAX_SIZE = 1e300


def _number(value: Any) -> float:
    """Accept an int or a float that is finite; not a boolean, not a quoted number."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise ValueError("a plain number")
    if isinstance(value, float) and not math.isfinite(value):
        raise ValueError("a finite number")
    if abs(value) > MAX_SIZE:
        raise ValueError("a number up to 1e300")
    return float(value)


def _values(value: Any) -> float | tuple[float, ...]:
    if isinstance(value, (list, tuple)) and value:
        return tuple(_number(item) for item in value)
    return _number(value)


def _law_or_number(value: Any) -> str | float:
    return value if isinstance(value, str) else _number(value)


def _start(value: Any) -> str | float | tuple[str | float, ...]:
    if isinstance(value, (list, tuple)) and value:
        return tuple(_law_or_number(item) for item in value)
    return _law_or_number(value)


def _plain(text: str) -> str:
    if not text.isprintable():
        raise ValueError("text on one line, without control characters")
    return text


Number = Annotated[float, BeforeValidator(_number)]
Values = Annotated[float | tuple[float, ...], BeforeValidator(_values)]
Start = Annotated[str | float | tuple[str | float, ...], BeforeValidator(_start)]
Text = Annotated[StrictStr, StringConstraints(max_length=MAX_TEXT), AfterValidator(_plain)]


class Frozen(BaseModel):
    """Base of the tables: frozen, and closed to unknown keys."""

    model_config = ConfigDict(frozen=True, extra="forbid")


@final
class Header(Frozen):
    """The [model] table: the model's name, and what a reader should know of it."""

    name: StrictStr
    title: Text = ""
    source: Text = ""


@final
class Parameter(Frozen):
    """A constant of the model: value in its unit; a list is a value for each lane of one bank."""

    value: Values
    unit: StrictStr
    doc: Text = ""

    @property
    def dimension(self) -> Unit:
        """The parsed unit."""
        return parse_unit(self.unit)

    @property
    def lanes(self) -> tuple[float, ...]:
        """The values in coherent SI, one or one a lane."""
        values = self.value if isinstance(self.value, tuple) else (self.value,)
        return tuple(to_si(value, self.dimension) for value in values)

    @property
    def si(self) -> float | tuple[float, ...]:
        """The value in coherent SI, a tuple if it is given a lane at a time."""
        return self.lanes if isinstance(self.value, tuple) else self.lanes[0]


@final
class Input(Frozen):
    """An input of the model, with the value it has where a run gives none."""

    unit: StrictStr
    default: Number = 0.0
    doc: Text = ""

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

    assume: tuple[StrictStr, ...] = ()


#: One of the registered kinds, told apart by `kind`.
AnyElement: Any = Annotated[Union[tuple(KINDS.values())], Field(discriminator="kind")]  # noqa: UP007
