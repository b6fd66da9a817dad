"""The forms of elements with a branch: store, dissipation and source, each for any domain.

A form says once, for all domains, its fields, its docstring and its port.
"""

from dataclasses import dataclass, replace
from typing import Any, ClassVar, final

from piezo_sym.expressions.calculus import add, neg
from piezo_sym.expressions.energies import slope, without_common_factors
from piezo_sym.expressions.tree import Cmp, Div, Expr, Mul, Sym, rename
from piezo_sym.spec.elements import slips
from piezo_sym.spec.elements.base import Form, State, positive, state_symbol
from piezo_sym.spec.elements.domains import PhysicalDomain, PhysicalVariable, PowerVariable
from piezo_sym.spec.elements.marks import (
    BodyName,
    Fields,
    InputName,
    Jumps,
    Node,
    Pair,
    law_field,
)
from piezo_sym.spec.elements.ports import Branch, DissipativePort, Port, Source, Storage


@final
@dataclass(frozen=True)
class Store(Form):
    """An energy store that imposes its co-state.

    Attributes
    ----------
    size, unit : the field that is its stiffness, capacitance, mass ...
    symbol : a parameter for it, in the example.
    stiff : whether the co-state is the size times the extension beyond `rest`, not state over size.
    at : whether it stands at one node; the other is the reference.
    slips : whether it may have a slip, in series with a spring, in parallel to a capacitor.
    """

    has_lanes: ClassVar[bool] = True

    domain: PhysicalDomain
    imposes: PowerVariable
    size: str
    unit: str
    symbol: str
    stiff: bool = False
    at: bool = False
    slips: bool = False

    @property
    def costate(self) -> PhysicalVariable:
        """The variable that it imposes."""
        return self.domain.variable(self.imposes)

    @property
    def letter(self) -> str:
        """The letter of its state."""
        return self.costate.state_letter

    @property
    def one_of(self) -> tuple[str, ...]:
        """Its size, its co-state or its energy."""
        return (self.size, self.costate.name, "energy")

    @property
    def fields(self) -> Fields:
        """Its nodes, what its energy is, and rest."""
        letter = {self.letter: self.costate.state_unit}
        laws = {
            self.size: law_field(self.unit, letter, self.symbol, None),
            self.costate.name: law_field(self.costate.unit, letter, default=None),
            "energy": law_field("J", letter, default=None),
        }
        rest = {"rest": law_field(self.costate.state_unit, {}, default="0")} if self.stiff else {}
        more = slips.fields(self.domain, self.imposes) if self.slips else {}
        return {**_places(self.domain, self.at), **laws, **rest, **more}

    @property
    def doc(self) -> str:
        """State, co-state, energy."""
        out, driven = self.costate, self.domain.variable(self.imposes.other)
        stiff = f"{self.size}*({self.letter} - rest)"
        law = stiff if self.stiff else f"{self.letter}/{self.size}"
        return (
            f"State {self.letter} [{out.state_unit}], the {out.state}, is the integral of the "
            f"{_said(driven, self.at)}; co-state the {_said(out, self.at)}, "
            f"{out.prefix} = {law} [{out.unit}]; energy the integral of {out.prefix} "
            f"over {self.letter}. Instead of `{self.size}`, `{out.name}` gives {out.prefix} or "
            f"`energy` the energy [J], as a law of {self.letter}."
            f"{slips.about(self.domain, self.imposes) if self.slips else ''}"
        )

    def ports(self, element: Any, name: str, branch: Branch) -> tuple[Port, ...]:
        """Return the store, and its slip if it has one."""
        if getattr(element, "slip", None) is None:
            return (self.port(element, name, branch),)
        own, slip = slips.beside(self.domain, self.imposes, element, name, branch)
        return (self.port(element, name, own), slip)

    def port(self, element: Any, name: str, branch: Branch) -> Storage:
        """Return the store, whose state is the integral of the conjugate variable."""
        state = state_symbol(element, name)
        energy = self._given(element, "energy", state)
        law = self._law(element, state) if energy is None else slope(energy, state)
        branch = _placed(element, branch, self.domain)
        return replace(self.storage(element, name, branch, state, law), energy=energy)

    def storage(self, element: Any, name: str, branch: Branch, state: str, law: Expr) -> Storage:
        """Return a store of this form with a co-state."""
        costate = self.costate
        return Storage(
            state=state,
            law=law,
            costate=f"{costate.prefix}_{name}",
            branch=branch,
            domain=self.domain,
            imposes=self.imposes,
            units=(costate.state_unit, costate.unit),
            doc=f"{costate.state} of {element.kind} '{name}'",
        )

    def _given(self, element: Any, field: str, state: str) -> Expr | None:
        """Return a law of the element in its state's symbol, if it is given."""
        if getattr(element, field) is None:
            return None
        return rename(element.law(field), {self.letter: state})

    def _law(self, element: Any, state: str) -> Expr:
        """Return the co-state."""
        size = self._given(element, self.size, state)
        if size is None:
            return rename(element.law(self.costate.name), {self.letter: state})
        return without_common_factors(self._by_size(element, size, state), state)

    def _by_size(self, element: Any, size: Expr, state: str) -> Expr:
        """Return the co-state that a size gives; it may be 0/0 where its limit has a value."""
        if not self.stiff:
            return Div(Sym(state), size)
        return Mul(size, add(Sym(state), neg(element.law("rest"))))

    def states(self, element: Any, name: str) -> tuple[State, ...]:
        """Return its state."""
        return (State(state_symbol(element, name), self.costate.state_unit),)

    def fault(self, element: Any) -> tuple[str, str, str, str] | None:
        """Return that a rest belongs to a stiffness, and what is heated to a slip."""
        if self.slips and (fault := slips.fault(element)):
            return fault
        if self.in_series(element) and (fault := slips.alike(element, self.costate, self.size)):
            return fault
        rest = type(element).model_fields["rest"].default if self.stiff else None
        if self.stiff and getattr(element, self.size) is None and element.rest != rest:
            given = next(name for name in self.one_of if getattr(element, name) is not None)
            remedy = f"write {self.letter} - ({element.rest}) in the law, and leave rest out"
            return ".rest", f"rest is given beside {given}", f"rest beside {self.size}", remedy
        return None

    def in_series(self, _: Any) -> bool:
        """Return whether lanes share what drives them: if each gives an across variable."""
        return self.imposes is PowerVariable.ACROSS

    def requires(self, element: Any) -> tuple[Cmp, ...]:
        """Return that its size is positive, if it is given, and no quotient like sinh(q)/q."""
        if getattr(element, self.size) is None:
            return ()
        size = element.law(self.size)
        law = self._by_size(element, size, self.letter)
        return (positive(size),) if without_common_factors(law, self.letter) == law else ()


@final
@dataclass(frozen=True)
class Dissipation(Form):
    """A law for one variable of a branch, given the other; their product heats a body.

    `gives` is what a law may give; `symbol` a law for the first of these, in the example.
    """

    has_lanes: ClassVar[bool] = True

    domain: PhysicalDomain
    gives: tuple[PowerVariable, ...]
    symbol: str

    @property
    def one_of(self) -> tuple[str, ...]:
        """A law and its inverse."""
        names = tuple(self.domain.variable(v).name for v in self.gives)
        return names if len(names) > 1 else ()

    @property
    def fields(self) -> Fields:
        """Its nodes, laws, and the body it heats."""
        default = None if self.one_of else ...
        laws: Fields = {}
        for v in self.gives:
            out, given = self.domain.variable(v), self.domain.variable(v.other)
            sample = "" if laws else self.symbol
            letters = {given.letter: given.unit, "T": "K"}
            laws[out.name] = law_field(out.unit, letters, sample, default, sees=True)
        heats = {"heats": (BodyName, ..., "body"), "discontinuous": (Jumps, False, None)}
        return {**_places(self.domain), **laws, **heats}

    @property
    def doc(self) -> str:
        """Its law or laws, and the heat."""
        found = [(self.domain.variable(v), self.domain.variable(v.other)) for v in self.gives]
        laws = ", or ".join(
            f"its {_word(out)} [{out.unit}] is a law of {given.letter}, the {_said(given)} "
            f"[{given.unit}]"
            for out, given in found
        )
        out, given = found[0]
        return (
            f"{laws[0].upper()}{laws[1:]}; T [K] is the temperature of the body that it `heats` "
            f"with {_word(out)} times {_word(given)}."
        )

    def port(self, element: Any, name: str, branch: Branch) -> DissipativePort:
        """Return the process, in the causality in which the law is given."""
        field = {v: self.domain.variable(v).name for v in self.gives}
        imposes = next(v for v in self.gives if getattr(element, field[v]) is not None)
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
class Imposed(Form):
    """A variable of a branch that an input gives."""

    domain: PhysicalDomain
    imposes: PowerVariable
    symbol: str
    at: bool = False

    @property
    def fields(self) -> Fields:
        """Its nodes and its input."""
        return {**_places(self.domain, self.at), "input": (InputName, ..., self.symbol)}

    @property
    def doc(self) -> str:
        """What the input is, and its conjugate output."""
        given, output = (self.domain.variable(v) for v in (self.imposes, self.imposes.other))
        node = "its node" if self.at else "its first node"
        verb = f"is given into {node}"
        if self.imposes is PowerVariable.ACROSS:
            verb = f"is that of {node}{'' if self.at else ' relative to its second'}"
        return (
            f"Its input, a {_word(given)} [{given.unit}], {verb}; output is the {_word(output)} "
            f"[{output.unit}], so that output times input is the power put in."
        )

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
            doc=f"{_word(output)} {verb} {element.kind} '{name}'",
        )


def _word(variable: PhysicalVariable) -> str:
    return variable.name.replace("_", " ")


def _said(variable: PhysicalVariable, at: bool = False) -> str:
    """Return a variable and how it counts; at one node, of that node."""
    return f"{_word(variable)} {'at its node' if at else variable.sense}"


def _places(domain: PhysicalDomain, at: bool = False) -> Fields:
    if at:
        return {"at": (Node, ..., domain.node)}
    return {"between": (Pair, ..., [domain.node, domain.reference])}


def _placed(element: Any, branch: Branch, domain: PhysicalDomain) -> Branch:
    """Return the branch, which for an element at one node ends at the reference."""
    return (element.at, domain.reference) if hasattr(element, "at") else branch
