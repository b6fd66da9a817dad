"""What every kind of element is: a frozen record of spec fields that states its ports.

Input: a row of the table of kinds.  Output: a pydantic type whose values state `Port` records.  A
kind is made of `Form`s, which say its fields, its docstring and its ports; see `forms`.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, ClassVar, Literal, Self, cast, final

from pydantic import BaseModel, ConfigDict, create_model, model_validator

from piezo_sym.expressions.parse import parse_law
from piezo_sym.expressions.tree import ZERO, Cmp, Expr
from piezo_sym.spec.elements.marks import (
    BankName,
    Count,
    Ends,
    Fields,
    Letters,
    Refers,
    StateName,
)
from piezo_sym.spec.elements.ports import Branch, Port

_LANES = (
    "With `count` it is a bank of lanes j = 1..count: in parallel; in series if they give an "
    "across variable, as capacitors that slip, or stand in a chain between the nodes `series`."
)
#: Where types of elements are found by their names, when they are unpickled.
MODULE = "piezo_sym.spec.elements"


class Frozen(BaseModel):
    """Base of the tables of a spec: frozen, and closed to unknown keys."""

    model_config = ConfigDict(frozen=True, extra="forbid")


@final
@dataclass(frozen=True)
class State:
    """A state of an element: its symbol, its unit, and whether it is the entropy of a body."""

    symbol: str
    unit: str
    is_entropy: bool = False


class Form(ABC):
    """A part of a kind: a store, a dissipation, a coupling, a source, a body ...; see `forms`.

    What `has_lanes` may stand for many of its kind, a bank.
    """

    has_lanes: ClassVar[bool] = False

    @property
    def one_of(self) -> tuple[str, ...]:
        """Fields of which exactly one is to be given, such as a law and its inverse."""
        return ()

    @property
    def letter(self) -> str:
        """The letter of its state; empty for those without one."""
        return ""

    @property
    @abstractmethod
    def fields(self) -> Fields:
        """What a spec says of it; nodes first."""

    @property
    @abstractmethod
    def doc(self) -> str:
        """Its law, state and signs, in words."""

    @abstractmethod
    def port(self, element: Any, name: str, branch: Branch) -> Port:
        """Return the first port of an element called `name`; `branch` is where it stands."""

    def ports(self, element: Any, name: str, branch: Branch) -> tuple[Port, ...]:
        """Return all of its ports."""
        return (self.port(element, name, branch),)

    def states(self, element: Any, name: str) -> tuple[State, ...]:
        """Return the states of an element called `name`."""
        del element, name
        return ()

    def fault(self, element: Any) -> tuple[str, str, str, str] | None:
        """Return what is wrong with fields taken together: place, what, expected, remedy."""
        del element
        return None

    def in_series(self, _: Any) -> bool:
        """Return whether lanes of an element are in series, if it has some."""
        return False

    def requires(self, element: Any) -> tuple[Cmp, ...]:
        """Return the conditions that this part of an element adds to the domain."""
        del element
        return ()

    def starts(self, element: Any, name: str) -> tuple[Cmp, ...]:
        """Return the conditions on where the states of an element called `name` start."""
        del element, name
        return ()


@final
@dataclass(frozen=True)
class Kind:
    """A row of the table of kinds.

    Attributes
    ----------
    name : as a spec gives it.
    forms : its parts; two are in series.
    about : what it is, on one line.
    """

    name: str
    forms: tuple[Form, ...]
    about: str

    @property
    def has_lanes(self) -> bool:
        """Whether its elements may stand for the lanes of a bank."""
        return all(form.has_lanes for form in self.forms)

    @property
    def letter(self) -> str:
        """The letter of its state; empty for kinds without one."""
        return next((form.letter for form in self.forms if form.letter), "")

    @property
    def one_of(self) -> tuple[tuple[str, ...], ...]:
        """Groups of fields, of each of which exactly one is to be given."""
        return tuple(form.one_of for form in self.forms if form.one_of)

    @property
    def fields(self) -> Fields:
        """The fields of its elements."""
        found = {name: field for form in self.forms for name, field in form.fields.items()}
        first: Fields = {name: found.pop(name) for name in ("between", "at") if name in found}
        types = {"count": Count | None, "bank": BankName, "series": Ends} if self.has_lanes else {}
        count: Fields = {name: (kind, None, None) for name, kind in types.items()}
        state: Fields = {"state": (StateName, None, None)} if self.letter else {}
        return {**first, **count, **found, **state}

    @property
    def doc(self) -> str:
        """The text of `piezo-sym kinds`, of the schema and of the type of its elements."""
        lanes = (_LANES,) * self.has_lanes
        parts = (self.about, *(form.doc for form in self.forms), *lanes)
        return "\n\n".join((*parts, f"Example: {self.example}"))

    @property
    def example(self) -> str:
        """An element of this kind, as a line of [elements]."""
        given = {name: sample for name, (*_, sample) in self.fields.items() if sample}
        pairs = {"kind": self.name, **given}.items()
        return f"{self.name} = {{ {', '.join(f'{key} = {_toml(v)}' for key, v in pairs)} }}"

    def made(self) -> "type[Element]":
        """Return the type of its elements."""
        title = "".join(word.capitalize() for word in self.name.split("_"))
        fields: Any = {name: field[:2] for name, field in self.fields.items()}
        fields["kind"] = (Literal[self.name], self.name)
        fields |= {"__base__": Element, "__module__": MODULE, "__doc__": self.doc}
        made = cast("type[Element]", create_model(title, **fields))
        made.row = self
        return made


class Element(Frozen):
    """An element of a network; the type of each kind derives from it directly."""

    row: ClassVar[Kind]

    kind: str

    @model_validator(mode="after")
    def _one_of_each(self) -> Self:
        for group in self.row.one_of:
            given = [field for field in group if getattr(self, field) is not None]
            if len(given) != 1:
                none = "neither" if len(group) == 2 else "none"
                said = f"both {' and '.join(given)}" if given else none
                message = f"exactly one of {', '.join(group)}; {said} given"
                raise ValueError(message)
        return self

    def ports(self, name: str) -> tuple[Port, ...]:
        """Return the ports of this element, called `name` in its spec."""
        first, last = getattr(self, "between", ("", ""))
        forms = self.row.forms
        nodes = (first, *(f"{name}:inner" for _ in forms[1:]), last)
        parts = zip(forms, pairwise(nodes), strict=True)
        return tuple(port for form, branch in parts for port in form.ports(self, name, branch))

    def own_states(self, name: str) -> tuple[State, ...]:
        """Return the states of this element, called `name` in its spec, in order."""
        return tuple(state for form in self.row.forms for state in form.states(self, name))

    def requires(self) -> tuple[Cmp, ...]:
        """Return the conditions that this element adds to the domain."""
        return tuple(condition for form in self.row.forms for condition in form.requires(self))

    def starts(self, name: str) -> tuple[Cmp, ...]:
        """Return the conditions on where the states of this element, called `name`, start."""
        return tuple(condition for form in self.row.forms for condition in form.starts(self, name))

    def bank_of(self, name: str) -> str | None:
        """Return the bank that this element, called `name`, has one lane of: its own, or a cell's.

        None where no `count` is given; a count of 1 is a bank, too.
        """
        given = getattr(self, "count", None) is not None
        return (getattr(self, "bank", None) or name) if given else None

    @property
    def chain(self) -> Branch | None:
        """The ends of the chain in which its lanes stand one after the other, if they do."""
        if getattr(self, "count", None) is None:
            return None
        alone = getattr(self, "bank", None) is None
        own = alone and any(form.in_series(self) for form in self.row.forms)
        return getattr(self, "series", None) or (getattr(self, "between", None) if own else None)

    @property
    def is_body(self) -> bool:
        """Whether it has an entropy, and others may heat it."""
        return any(state.is_entropy for state in self.own_states(""))

    @property
    def letter(self) -> str:
        """The letter of its state; empty for those without one."""
        return self.row.letter

    def law(self, field: str) -> Expr:
        """Return the tree of a law field."""
        return parse_law(getattr(self, field), field)

    def laws(self) -> Iterator[tuple[str, str, Letters]]:
        """Yield (field, text, letters and units) of each law that is given."""
        for field, info in type(self).model_fields.items():
            text = getattr(self, field)
            for mark in info.metadata:
                if isinstance(mark, Letters) and text is not None:
                    yield field, text, mark.of(self)

    def references(self) -> Iterator[tuple[str, str, str]]:
        """Yield (field, 'input' or 'thermal_mass', the name given)."""
        return (row for row in self.named() if row[1] != "node")

    def named(self) -> Iterator[tuple[str, str, str]]:
        """Yield (field, what it refers to, the name given); nodes, too."""
        for field, info in type(self).model_fields.items():
            for mark in info.metadata:
                given = getattr(self, field)
                if isinstance(mark, Refers) and given is not None:
                    names = given if isinstance(given, tuple) else (given,)
                    yield from ((field, mark.to, name) for name in names)
        for state in getattr(self, "states", {}).values():
            yield from (("states", "node", node) for node in state.between or ())


def positive(law: Expr) -> Cmp:
    """Return the condition that a law is positive."""
    return Cmp(">", law, ZERO)


def state_symbol(element: Element, name: str) -> str:
    """Return the symbol of an element's state: as given, else its kind's letter and its name."""
    return getattr(element, "state", None) or f"{element.letter}_{name}"


def _toml(value: Any) -> str:
    """Return a text, a list or a table of such, as TOML."""
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, dict):
        return f"{{ {', '.join(f'{key} = {_toml(v)}' for key, v in value.items())} }}"
    return f"[{', '.join(map(_toml, value))}]"
