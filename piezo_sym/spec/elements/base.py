"""The base of all kinds of elements: a frozen record of spec fields that gives its ports.

Input: a row of the table of kinds.  Output: a pydantic type whose values give `Port` records.  A
kind has a `Form`, which holds its fields, its docstring and its ports; see `forms`.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, Self, final

from pydantic import (
    BaseModel,
    ConfigDict,
    SerializerFunctionWrapHandler,
    create_model,
    model_serializer,
    model_validator,
)

from piezo_sym.expressions.parse import parse_law
from piezo_sym.expressions.tree import ZERO, Cmp, Expr
from piezo_sym.spec.elements.domains import PhysicalDomain, PowerVariable
from piezo_sym.spec.elements.marks import (
    BankName,
    Count,
    Ends,
    Fields,
    LawField,
    Letters,
    Refers,
    StateName,
)
from piezo_sym.spec.elements.ports import Branch, Port, Storage
from piezo_sym.spec.write import inline

_LANES = (
    "With `count` it is a bank of lanes j = 1..count: in parallel; in series if they give an "
    "across variable, as capacitors that slip, or stand in a chain between the nodes `series`. "
    "Parallel stores of one across variable, as masses or capacitors, are joined: one state, the "
    "sum of theirs, which starts at `count` times `initial`."
)
ACROSS, ENTROPY_UNIT = PowerVariable.ACROSS, "J/K"
#: A place in an element, the fault there, what is expected, and the remedy.
Fault = tuple[str, str, str, str]
#: The module in which pickle looks up the types of elements.
MODULE = "piezo_sym.spec.elements"


class Frozen(BaseModel):
    """Base of the tables of a spec: frozen, and closed to unknown keys."""

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)


@final
@dataclass(frozen=True, eq=False)
class Form:
    """What kinds are made of: a store, a dissipation, a coupling, a source, a body; see `forms`."""

    fields: Fields  # the fields of a spec, nodes first
    doc: str  # its law, state and signs, in words
    #: (element, its name, its branch) -> the ports.
    ports: Callable[[Any, str, Branch], tuple[Port, ...]]
    role: tuple[Any, ...] = ()  # the key by which `kind_of` finds it
    #: Fields of which exactly one has to be given, such as a law and its inverse.
    one_of: tuple[str, ...] = ()
    #: letter, unit: of its state; empty if it has none.
    letter: str = ""
    unit: Callable[[Any], str] = lambda _: ""
    #: Element -> a fault of its fields taken together, if there is one.
    fault: Callable[[Any], Fault | None] = lambda _: None
    #: (element, its name) -> the conditions that it adds to the domain.
    requires: Callable[[Any, str], tuple[Cmp, ...]] = lambda *_: ()
    #: (element, its name) -> the conditions on its initial states.
    starts: Callable[[Any, str], tuple[Cmp, ...]] = lambda *_: ()
    has_lanes: bool = False  # whether an element may be a bank, by `count`
    #: Element -> whether `count` of them are joined into one state instead.
    joins: Callable[[Any], bool] = lambda _: False
    #: The pairs of domains that a coupling may couple, with the unit of its ratio.
    ratios: tuple[tuple[PhysicalDomain, PhysicalDomain, str], ...] = ()


class Element(Frozen):
    """An element of a network; the type of each kind derives from it directly."""

    form: ClassVar[Form]

    kind: str

    @model_validator(mode="after")
    def _one_of_each(self) -> Self:
        group = self.form.one_of
        given = [field for field in group if getattr(self, field) is not None]
        if group and len(given) != 1:
            none = "neither" if len(group) == 2 else "none"
            said = f"both {' and '.join(given)}" if given else none
            message = f"exactly one of {', '.join(group)}; {said} given"
            raise ValueError(message)
        return self

    @model_serializer(mode="wrap")
    def _with_kind(self, fields: SerializerFunctionWrapHandler) -> dict[str, Any]:
        return {"kind": self.kind, **fields(self)}

    def ports(self, name: str) -> tuple[Port, ...]:
        """Return the ports of this element, called `name` in its spec."""
        return self.form.ports(self, name, getattr(self, "between", ("", "")))

    def own_states(self, name: str) -> dict[str, str]:
        """Return the unit of each state of this element, called `name` in its spec, in order."""
        if self.letter:
            return {state_symbol(self, name): self.form.unit(self)}
        return {symbol: state.unit for symbol, state in getattr(self, "states", {}).items()}

    def bank_of(self, name: str) -> str | None:
        """Return the bank of this element, called `name`: that of its cell, or one named after it.

        None if no `count` is given, or if all are joined; a count of 1 is a bank, too.
        """
        given = getattr(self, "count", None) is not None and not self.form.joins(self)
        return (getattr(self, "bank", None) or name) if given else None

    @property
    def joined(self) -> int:
        """How many equal elements are joined into this one."""
        return (getattr(self, "count", None) or 1) if self.form.joins(self) else 1

    @property
    def chain(self) -> Branch | None:
        """The two ends of the chain that its lanes form, if they are in series."""
        if self.bank_of("") is None:
            return None
        alone = getattr(self, "bank", None) is None
        across = (p for p in self.ports("") if isinstance(p, Storage) and p.imposes is ACROSS)
        own = alone and any(across)
        return getattr(self, "series", None) or (getattr(self, "between", None) if own else None)

    @property
    def is_body(self) -> bool:
        """Whether it has an entropy, and others may heat it."""
        return ENTROPY_UNIT in self.own_states("").values()

    @property
    def letter(self) -> str:
        """The letter of its state; empty for those without one."""
        return self.form.letter

    def law(self, field: str) -> Expr:
        """Return the tree of a law field."""
        return parse_law(getattr(self, field), field)

    def laws(self, name: str) -> Iterator[LawField]:
        """Yield the laws of this element, called `name` in its spec."""
        for field, mark in self.law_fields():
            if (text := getattr(self, field)) is not None:
                yield LawField(name, field, text, mark.of(self))

    def law_fields(self) -> Iterator[tuple[str, Letters]]:
        """Yield the fields of this kind that are laws, and their marks."""
        for field, info in type(self).model_fields.items():
            yield from ((field, mark) for mark in info.metadata if isinstance(mark, Letters))

    def named(self, *to: str) -> Iterator[tuple[str, str]]:
        """Yield (field, name) for names of a 'node', 'input' or 'thermal_mass', as `to` says."""
        for field, info in type(self).model_fields.items():
            given = getattr(self, field)
            refers = any(isinstance(mark, Refers) and mark.to in to for mark in info.metadata)
            if refers and given is not None:
                names = given if isinstance(given, tuple) else (given,)
                yield from ((field, name) for name in names)
        for state in getattr(self, "states", {}).values() if "node" in to else ():
            yield from (("states", node) for node in state.between or ())


def positive(law: Expr) -> Cmp:
    """Return the condition that a law is positive."""
    return Cmp(">", law, ZERO)


def state_symbol(element: Element, name: str) -> str:
    """Return the symbol of an element's state: as given, or from its letter and the name."""
    given = getattr(element, "state", None)
    return f"{element.letter}_{name}" if given is None else str(given)


def element_type(name: str, about: str, form: Form) -> type[Element]:
    """Return the pydantic type of a kind's elements.

    Its docstring is the text of `piezo-sym kinds` and of the schema.

    Parameters
    ----------
    name : the kind, as `kind` gives it in a spec.
    about : what it is, on one line.
    """
    fields = _fields(form)
    sample = {field: given for field, (*_, given) in fields.items() if given}
    example = f"Example: {name} = {inline({'kind': name, **sample})}"
    types: Any = {field: row[:2] for field, row in fields.items()}
    types["kind"] = (Literal[name], name)
    made = create_model(
        "".join(word.capitalize() for word in name.split("_")),
        __base__=Element,
        __module__=MODULE,
        __doc__="\n\n".join((about, form.doc, *(_LANES,) * form.has_lanes, example)),
        **types,
    )
    made.form = form
    return made


def _fields(form: Form) -> Fields:
    """Return all fields of a kind's elements: nodes, size of a bank, what is its form's, state."""
    others = dict(form.fields)
    nodes: Fields = {name: others.pop(name) for name in ("between", "at") if name in others}
    types = {"count": Count | None, "bank": BankName, "series": Ends} if form.has_lanes else {}
    lanes: Fields = {name: (kind, None, None) for name, kind in types.items()}
    state: Fields = {"state": (StateName, None, None)} if form.letter else {}
    return {**nodes, **lanes, **others, **state}
