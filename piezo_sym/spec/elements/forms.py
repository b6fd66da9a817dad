"""The forms of elements: store, dissipation, coupling and source, each for any domain.

Input: an element, its name in the spec and the branch on which it stands.  Output: a `Port`.
"""

from dataclasses import dataclass
from typing import Any, final

from piezo_sym.expressions.calculus import add, neg
from piezo_sym.expressions.tree import Cmp, Div, Expr, Mul, Sym, rename
from piezo_sym.spec.elements.base import Form, positive, state_symbol
from piezo_sym.spec.elements.ports import (
    Branch,
    Coupling,
    DissipativePort,
    PhysicalDomain,
    PowerVariable,
    Source,
    Storage,
)


@final
@dataclass(frozen=True)
class Store(Form):
    """An energy store that imposes its co-state; `field` is its stiffness, capacitance, mass ..."""

    domain: PhysicalDomain
    imposes: PowerVariable
    field: str

    def port(self, element: Any, name: str, branch: Branch) -> Storage:
        """Return the store, whose state is the integral of the conjugate variable."""
        costate, state = self.domain.variable(self.imposes), state_symbol(element, name)
        return Storage(
            state=state,
            law=self._costate(element, state),
            costate=f"{costate.prefix}_{name}",
            branch=_placed(element, branch, self.domain),
            domain=self.domain,
            imposes=self.imposes,
            units=(costate.state_unit, costate.unit),
            doc=f"{costate.state} of {element.kind} '{name}'",
        )

    def _costate(self, element: Any, state: str) -> Expr:
        """Return the co-state: stiffness times extension beyond rest, or state over capacitance."""
        size = rename(element.law(self.field), {element.letter: state})
        if self.field != "stiffness":
            return Div(Sym(state), size)
        return Mul(size, add(Sym(state), neg(element.law("rest"))))

    def requires(self, element: Any) -> tuple[Cmp, ...]:
        """Return that `field` is positive."""
        return (positive(element.law(self.field)),)


@final
@dataclass(frozen=True)
class Dissipation(Form):
    """A law for one variable of a branch, given the other; their product heats a body."""

    domain: PhysicalDomain

    def port(self, element: Any, name: str, branch: Branch) -> DissipativePort:
        """Return the process, in the causality in which the law is given."""
        imposes = next(
            v for v in PowerVariable if getattr(element, self.domain.variable(v).name, None)
        )
        output, effort = self.domain.variable(imposes), self.domain.variable(imposes.other)
        return DissipativePort(
            letter=effort.letter,
            law=element.law(output.name),
            field=output.name,
            output=f"{output.prefix}_{name}",
            effort=f"{effort.prefix}_{name}",
            branch=branch,
            domain=self.domain,
            imposes=imposes,
            heats=element.heats,
        )


@final
@dataclass(frozen=True)
class PairCoupling(Form):
    """A coupling of two pairs of nodes, each a field of the element with its domain."""

    first: tuple[str, PhysicalDomain]
    second: tuple[str, PhysicalDomain]
    gyrates: bool = False

    def port(self, element: Any, name: str, branch: Branch) -> Coupling:
        """Return the coupling; it has two branches of its own."""
        del branch
        return Coupling(
            first=getattr(element, self.first[0]),
            first_domain=self.first[1],
            second=getattr(element, self.second[0]),
            second_domain=self.second[1],
            ratio=element.law("ratio"),
            name=f"{'alpha' if self.gyrates else 'n'}_{name}",
            body=getattr(element, "temperature", None),
            gyrates=self.gyrates,
        )


@final
@dataclass(frozen=True)
class Imposed(Form):
    """A variable of a branch that an input gives."""

    domain: PhysicalDomain
    imposes: PowerVariable

    def port(self, element: Any, name: str, branch: Branch) -> Source:
        """Return the port; its output is the conjugate variable."""
        given = self.domain.variable(self.imposes)
        output = self.domain.variable(self.imposes.other)
        verb = "given by" if self.imposes is PowerVariable.ACROSS else "at"
        return Source(
            input=element.input,
            branch=_placed(element, branch, self.domain),
            domain=self.domain,
            imposes=self.imposes,
            units=(given.unit, output.unit),
            doc=f"{output.name} {verb} {element.kind} '{name}'",
        )


def _placed(element: Any, branch: Branch, domain: PhysicalDomain) -> Branch:
    """Return the branch, which for an element at one node ends at the reference."""
    return (element.at, domain.reference) if hasattr(element, "at") else branch
