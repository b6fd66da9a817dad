"""The forms of stores: with one state, with a slip, and with a slip that a limit makes.

Input: a `Size` and an element.  Output: `Form`s, their ports.  With
q' = v - slip(f, v) a spring slips in series, with Q' = i - slip(v, i) a capacitor in parallel; the
product of co-state and slip heats a body.  What yields has a set-valued slip: below its limit
nothing slips, at the limit all that would go beyond it does.  As a law of effort and rate, this is
the rate projected on |effort| <= limit.
"""

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, final

from piezo_sym.expressions.calculus import add, div, inserted, mul, neg
from piezo_sym.expressions.energies import slope, without_common_factors
from piezo_sym.expressions.parse import parse_law
from piezo_sym.expressions.tree import ZERO, Call, Cmp, Div, Expr, If, Mul, Num, Sym, rename
from piezo_sym.spec.elements.base import Fault, Form, positive, state_symbol
from piezo_sym.spec.elements.domains import PhysicalDomain, PhysicalVariable, PowerVariable
from piezo_sym.spec.elements.forms import placed, places, said
from piezo_sym.spec.elements.marks import BodyName, Fields, Jumps, OptionalBody, Pair, law_field
from piezo_sym.spec.elements.ports import Branch, DissipativePort, Port, Storage


@final
@dataclass(frozen=True)
class Size:
    """What makes an energy store of a domain: its stiffness, capacitance, mass ...

    Attributes
    ----------
    imposes : which variable its co-state is.
    size, unit : the field.
    symbol : a parameter for it, in the example.
    stiff : whether the co-state is the size times the extension beyond `rest`, not state over size.
    slips : whether it may have a slip, in series with a spring, in parallel to a capacitor.
    """

    domain: PhysicalDomain
    imposes: PowerVariable
    size: str
    unit: str
    symbol: str
    stiff: bool = False
    slips: bool = False

    @property
    def at(self) -> bool:
        """Whether it stands at one node; the other is the reference."""
        return self.domain.mechanical and self.imposes is PowerVariable.ACROSS

    @property
    def out(self) -> PhysicalVariable:
        """The variable that it imposes, its co-state."""
        return self.domain.variable(self.imposes)

    @property
    def driven(self) -> PhysicalVariable:
        """The variable that its state is the integral of."""
        return self.domain.variable(self.imposes.other)


def store(own: Size) -> Form:
    """Return the form of a kind that is one store."""
    out, letter = own.out, own.out.state_letter
    one_of = (own.size, out.name, "energy")

    def ports(element: Any, name: str, branch: Branch) -> tuple[Port, ...]:
        state, branch = state_symbol(element, name), placed(element, branch, own.domain)
        (field,) = (field for field in one_of if getattr(element, field) is not None)
        law, energy = rename(element.law(field), {letter: state}), None
        if field == "energy":
            law, energy = slope(law, state), law
        elif field == own.size:
            law = without_common_factors(_costate(own, element, state), state)
        if element.joined > 1:
            law, energy = _of_all(law, energy, state, element.joined)
        port = replace(_storage(own, element, name, branch, law), energy=energy)
        slips = getattr(element, "slip", None) is not None
        return _slipping(own, element, port, name) if slips else (port,)

    def requires(element: Any, name: str) -> tuple[Cmp, ...]:
        """Return that its size is positive, if it is given, and no quotient like sinh(q)/q."""
        if getattr(element, own.size) is None:
            return ()
        state = state_symbol(element, name)
        law, size = _costate(own, element, state), rename(element.law(own.size), {letter: state})
        return (positive(size),) if without_common_factors(law, state) == law else ()

    return Form(
        fields=_fields(own),
        doc=_store_doc(own),
        ports=ports,
        role=("store", own.domain, own.imposes),
        one_of=one_of,
        letter=letter,
        unit=lambda _: out.state_unit,
        fault=lambda element: _fault(own, element),
        requires=requires,
        has_lanes=True,
        joins=lambda element: _joins(own, element),
    )


def yielding(*stores: Size) -> Form:
    """Return the form of a spring or capacitor, one of `stores`, that yields at a limit."""
    first = stores[0]
    sizes = {
        own.size: law_field(own.unit, {}, own.symbol if own is first else "", None)
        for own in stores
    }
    others: dict[str, Any] = {own.size: own.out.unit for own in stores[1:]}

    def meant(element: Any) -> Size:
        return next(own for own in stores if getattr(element, own.size) is not None)

    def ports(element: Any, name: str, branch: Branch) -> tuple[Port, ...]:
        own = meant(element)
        law = _costate(own, element, state_symbol(element, name))
        return _slipping(own, element, _storage(own, element, name, branch, law), name)

    def requires(element: Any, _: str) -> tuple[Cmp, ...]:
        limit = Cmp(">=", element.law("limit"), ZERO)
        return positive(element.law(meant(element).size)), limit

    def starts(element: Any, name: str) -> tuple[Cmp, ...]:
        costate = _costate(meant(element), element, state_symbol(element, name))
        return (Cmp("<=", Call("abs", (costate,)), element.law("limit")),)

    between = (Pair, ..., [first.domain.node, first.domain.reference])
    limit = law_field(first.out.unit, {}, "F_c", **others)
    return Form(
        fields={"between": between, **sizes, "limit": limit, "heats": (BodyName, ..., "body")},
        doc=_stop_doc(stores),
        ports=ports,
        one_of=tuple(own.size for own in stores),
        letter="z",
        unit=lambda element: meant(element).out.state_unit,
        requires=requires,
        starts=starts,
        has_lanes=True,
    )


def _fields(own: Size) -> Fields:
    out, letters = own.out, {own.out.state_letter: own.out.state_unit}
    fields = {
        **places(own.domain, own.at),
        own.size: law_field(own.unit, letters, own.symbol, None),
        out.name: law_field(out.unit, letters, default=None),
        "energy": law_field("J", letters, default=None),
    }
    if own.stiff:
        fields["rest"] = law_field(out.state_unit, {}, default="0")
    if own.slips:
        known = {out.letter: out.unit, own.driven.letter: own.driven.unit, "T": "K"}
        fields["slip"] = law_field(own.driven.unit, known, default=None, sees=True)
        fields |= {"heats": (OptionalBody, None, None), "discontinuous": (Jumps, False, None)}
    return fields


def _store_doc(own: Size) -> str:
    out, driven, letter = own.out, own.driven, own.out.state_letter
    slip = (
        f" With `slip` [{driven.unit}], a law of {out.letter}, its {out.name}, and of "
        f"{driven.letter}, its {driven.name}, the state's rate is {driven.letter} - slip, and "
        f"{out.name} times slip `heats` a body with the temperature T."
    )
    return (
        f"State {letter} [{out.state_unit}], the {out.state}, is the integral of the "
        f"{said(driven, own.at)}; co-state the {said(out, own.at)}, {out.prefix} = "
        f"{f'{own.size}*({letter} - rest)' if own.stiff else f'{letter}/{own.size}'} "
        f"[{out.unit}]; energy the integral of {out.prefix} over {letter}. Instead of "
        f"`{own.size}`, `{out.name}` gives {out.prefix} or `energy` the energy [J], as a law of "
        f"{letter}.{slip if own.slips else ''}"
    )


def _stop_doc(stores: tuple[Size, ...]) -> str:
    kinds = ", or ".join(
        f"with `{own.size}` a store of the co-state {own.out.prefix} = "
        f"{f'{own.size}*z' if own.stiff else f'z/{own.size}'} [{own.out.unit}]"
        for own in stores
    )
    return (
        f"{kinds[0].upper()}{kinds[1:]}, whose magnitude never exceeds `limit`: what would go "
        "beyond it slips, and co-state times slip `heats` a body. Steps are exact along their "
        "own path; `rhs` at the limit is the projected rate. The Jenkins element, the stop "
        "operator, a cell of Maxwell-slip. It is no end stop: that is a spring with "
        'force = "k_c*max(q - gap, 0)".'
    )


def _costate(own: Size, element: Any, state: str) -> Expr:
    """Return the co-state that a size gives; it may be 0/0 where its limit has a value."""
    size = rename(element.law(own.size), {own.out.state_letter: state})
    if not own.stiff:
        return Div(Sym(state), size)
    rest = parse_law(getattr(element, "rest", "0"), "rest")
    return Mul(size, add(Sym(state), neg(rest)))


def _storage(own: Size, element: Any, name: str, branch: Branch, law: Expr) -> Storage:
    several = f", {element.joined} of them joined" * (element.joined > 1)
    return Storage(
        state=state_symbol(element, name),
        law=law,
        costate=f"{own.out.prefix}_{name}",
        branch=branch,
        domain=own.domain,
        imposes=own.imposes,
        units=(own.out.state_unit, own.out.unit),
        doc=f"{own.out.state} of {element.kind} '{name}'" + several,
    )


def _slipping(own: Size, element: Any, port: Storage, name: str) -> tuple[Port, ...]:
    """Return a store beside its slip, which is in series if it gives a through variable."""
    (first, last), inner = port.branch, f"{name}:inner"
    series = own.imposes is PowerVariable.THROUGH
    here, there = ((inner, last), (first, inner)) if series else (port.branch, port.branch)
    limit = element.law("limit") if hasattr(element, "limit") else None
    slip = DissipativePort(
        letter=own.out.letter,
        law=element.law("slip") if limit is None else _projected(own, limit),
        field="slip" if limit is None else "",
        output=f"slip_{name}",
        effort=f"{own.out.prefix}_{name}",
        branch=there,
        domain=own.domain,
        imposes=own.imposes.other,
        heats=element.heats,
        rate_letter=own.driven.letter,
        rate=f"{own.driven.prefix}_{name}",
        state=port.state,
        limit=limit,
    )
    return replace(port, branch=here), slip


def _projected(own: Size, limit: Expr) -> Expr:
    """Return the slip of what yields: all of the rate that would lead beyond the limit."""
    f, v = Sym(own.out.letter), Sym(own.driven.letter)
    forth, back = Cmp(">=", f, limit), Cmp("<=", f, neg(limit))
    return If(If(v, forth, ZERO), Cmp(">", v, ZERO), If(v, back, ZERO))


def _joins(own: Size, element: Any) -> bool:
    """Return whether many of an element have one across variable, and so one state."""
    across = own.imposes is PowerVariable.ACROSS and element.bank is None
    return across and getattr(element, "slip", None) is None


def _of_all(law: Expr, energy: Expr | None, state: str, count: int) -> tuple[Expr, Expr | None]:
    """Return the law and energy of alike stores of one co-state: each has its share of the state.

    x = count*x_j and U(x) = count*U_j(x/count), so that dU/dx is the co-state of each.
    """
    number = Num(Fraction(count))
    share = {state: div(Sym(state), number)}
    if isinstance(law, Div) and law.left == Sym(state):
        law = Div(law.left, mul(number, inserted(law.right, share)))
    else:
        law = inserted(law, share)
    return law, energy and mul(number, inserted(energy, share))


def _fault(own: Size, element: Any) -> Fault | None:
    """Return that slip and heat, or rest and stiffness, belong together."""
    slip = getattr(element, "slip", None)
    if own.slips and (slip is None) != (element.heats is None):
        given, other = ("heats", "slip") if slip is None else ("slip", "heats")
        remedy = f"add {other} = '...', or leave {given} out"
        return f".{given}", f"{given} is given without {other}", "both or none", remedy
    if _joins(own, element) and element.series is not None and element.count is not None:
        what = f"those that count joins have one {own.out.word}, and series is given"
        return ".series", what, "count alone", "leave series out"
    if own.stiff and getattr(element, own.size) is None and element.rest != "0":
        given = own.out.name if element.energy is None else "energy"
        remedy = f"write {own.out.state_letter} - ({element.rest}) in the law, and leave rest out"
        return ".rest", f"rest is given beside {given}", f"rest beside {own.size}", remedy
    return None
