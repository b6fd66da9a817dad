"""What every kind of element is: a frozen record of spec fields that states its ports.

Input: the fields of one ``[elements.<name>]`` table.  Output: `Port` records.  A kind is a final
class in a file of its own, with one row in the registry (`elements/__init__.py`).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, ClassVar, final

from pydantic import BaseModel, ConfigDict, StrictStr, StringConstraints

from piezo_sym.spec.elements.ports import Port
from piezo_sym.spec.expressions import ZERO, Cmp, Expr
from piezo_sym.spec.parse import parse_law


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


@final
@dataclass(frozen=True)
class Refers:
    """Marks a field as the name of something else in the spec: an 'input' or a 'thermal_mass'."""

    to: str


Node = Annotated[StrictStr, StringConstraints(pattern=r"^[A-Za-z0-9_.+-]{1,40}$")]
Pair = tuple[Node, Node]
Law = StrictStr  # each field adds its `Letters`
InputName = Annotated[StrictStr, Refers("input")]
BodyName = Annotated[StrictStr, Refers("thermal_mass")]
StateName = StrictStr | None


class Element(BaseModel, ABC):
    """An element of a network; every kind derives from it directly and is final."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    #: The letter of the kind's state; empty for kinds without one.
    letter: ClassVar[str] = ""

    kind: str

    @abstractmethod
    def ports(self, name: str) -> tuple[Port, ...]:
        """Return the ports of this element, called `name` in its spec."""

    @property
    def is_bank(self) -> bool:
        """Whether the element is a bank of parallel lanes."""
        return False

    def requires(self) -> tuple[Cmp, ...]:
        """Return the conditions on parameters that this kind adds to the domain."""
        return ()

    def law(self, field: str) -> Expr:
        """Return the tree of a law field."""
        return parse_law(getattr(self, field), field)


def positive(law: Expr) -> Cmp:
    """Return the condition that a law is positive."""
    return Cmp(">", law, ZERO)


def state_symbol(element: Element, name: str) -> str:
    """Return the symbol of an element's state: as given, else its kind's letter and its name."""
    return getattr(element, "state", None) or f"{element.letter}_{name}"


def exactly_one(element: Element, *fields: str) -> None:
    """Raise unless exactly one of an element's fields is given."""
    given = [field for field in fields if getattr(element, field) is not None]
    if len(given) != 1:
        said = f"both {' and '.join(given)}" if given else "neither"
        message = f"exactly one of {' and '.join(fields)}; {said} given"
        raise ValueError(message)
