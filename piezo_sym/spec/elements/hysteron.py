"""Hysteron: an inductor and a nonlinear resistor in series, alone or as a bank in parallel."""

from typing import Annotated, ClassVar, Literal, final

from pydantic import Field, StrictInt

from piezo_sym.expressions.tree import Cmp, Div, Sym
from piezo_sym.spec.elements.base import (
    BodyName,
    Element,
    Jumps,
    Law,
    Letters,
    Pair,
    StateName,
    positive,
    state_symbol,
)
from piezo_sym.spec.elements.ports import Domain, Port, Resistor, Storage, Variable

MAX_COUNT = 1_000_000
Count = Annotated[
    StrictInt,
    Field(ge=1, le=MAX_COUNT, description="Size of the bank; without it there is one hysteron."),
]


@final
class Hysteron(Element):
    """A hysteron between two nodes, eq. (12), the second term of (6), Assumption 2.

    State phi [Wb], the flux linkage of its inductor; co-state the current i = phi/inductance [A];
    energy phi**2/(2*inductance).  Its resistor drops V = voltage(i, T) [V] along the current, and
    V*i heats a body.  With `count` it is a bank of lanes j = 1..count in parallel.
    """

    letter: ClassVar[str] = "phi"

    kind: Literal["hysteron"] = "hysteron"
    between: Pair
    count: Count | None = None
    inductance: Annotated[Law, Letters({"phi": "Wb"}, unit="H")]
    voltage: Annotated[Law, Letters({"i": "A", "T": "K"}, unit="V")]
    heats: BodyName
    discontinuous: Jumps = False
    state: StateName = None

    @property
    def is_bank(self) -> bool:
        """Whether `count` is given, be it 1."""
        return self.count is not None

    def ports(self, name: str) -> tuple[Port, ...]:
        """Return the inductor and the resistor, in series at a node of the element's own."""
        first, second = self.between
        inner = f"{name}:inner"
        return (
            Storage(
                state=state_symbol(self, name),
                letter="phi",
                law=Div(Sym("phi"), self.law("inductance")),
                costate=f"i_{name}",
                branch=(first, inner),
                domain=Domain.ELECTRICAL,
                imposes=Variable.THROUGH,
                units=("Wb", "A"),
                doc=f"flux linkage of hysteron '{name}'",
            ),
            Resistor(
                letter="i",
                law=self.law("voltage"),
                field="voltage",
                output=f"V_{name}",
                effort=f"i_{name}",
                branch=(inner, second),
                domain=Domain.ELECTRICAL,
                imposes=Variable.ACROSS,
                heats=self.heats,
            ),
        )

    def requires(self) -> tuple[Cmp, ...]:
        """Inductance is positive."""
        return (positive(self.law("inductance")),)
