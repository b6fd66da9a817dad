"""The forms of stores: with one state, with a slip, and with a slip at a limit.

Input: a `Size`.  Output: a `Form`.  With q' = v - slip(f, v) a spring slips in series, with
Q' = i - slip(v, i) a capacitor in parallel; the product of co-state and slip heats a body.  The
slip of a stop is set-valued: zero below the limit, and at the limit the part of the rate that would
exceed it.  As a law of effort and rate, this is the rate projected on |effort| <= limit.
"""

from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from typing import Any, final

from piezo_sym.expressions.calculus import add, div, inserted, mul, neg
from piezo_sym.expressions.energies import slope
from piezo_sym.expressions.parse import parse_law
from piezo_sym.expressions.removable import at_rest, slope_at, value_at, without_common_factors
from piezo_sym.expressions.tree import ZERO, Call, Cmp, Div, Expr, If, Mul, Num, Sym, rename
from piezo_sym.spec.elements.base import Fault, Form, positive, state_symbol
from piezo_sym.spec.elements.domains import PhysicalDomain, PhysicalVariable, PowerVariable
from piezo_sym.spec.elements.forms import placed, places, with_sense
from piezo_sym.spec.elements.marks import BodyName, Fields, Jumps, OptionalBody, Pair, law_field
from piezo_sym.spec.elements.ports import Branch, DissipativePort, Port, Storage


@final
@dataclass(frozen=True)
class Size:
    """The parameter of an energy store in a domain: its stiffness, capacitance, mass ..."""

    domain: PhysicalDomain
    imposes: PowerVariable  # which variable the store's co-state is
    #: field, unit: the field that gives it, and its unit.
    field: str
    unit: str
    symbol: str  # the parameter for it in the example
    stiff: bool = False  # whether the co-state is size*(state - rest), not state/size
    #: Whether the store may have a slip, in series with a spring, in parallel to a capacitor.
    slips: bool = False

    @property
    def at(self) -> bool:
        """Whether the store stands at one node; the other is the reference."""
        return self.domain.mechanical and self.imposes is PowerVariable.ACROSS

    @property
    def out(self) -> PhysicalVariable:
        """The variable that the store imposes, its co-state."""
        return self.domain.variable(self.imposes)

    @property
    def driven(self) -> PhysicalVariable:
        """The variable whose integral the state is."""
        return self.domain.variable(self.imposes.other)


def store(size: Size) -> Form:
    """Return the form of a kind that is one store."""
    out, letter = size.out, size.out.state_letter
    one_of = (size.field, out.name, "energy")

    def ports(element: Any, name: str, branch: Branch) -> tuple[Port, ...]:
        state, branch = state_symbol(element, name), placed(element, branch, size.domain)
        (field,) = (field for field in one_of if getattr(element, field) is not None)
        law, energy = rename(element.law(field), {letter: state}), None
        if field == "energy":
            law, energy = slope(law, state), law
        else:
            law = _continued(size, element, state) if field == size.field else at_rest(law, state)
        if element.joined > 1:
            law, energy = _joined_law(law, energy, state, element.joined)
        port = replace(_storage(size, element, name, branch, law), energy=energy)
        slips = getattr(element, "slip", None) is not None
        return _with_slip(size, element, port, name) if slips else (port,)

    return Form(
        fields=_fields(size),
        doc=_store_doc(size),
        ports=ports,
        role=("store", size.domain, size.imposes),
        one_of=one_of,
        letter=letter,
        unit=lambda _: out.state_unit,
        fault=partial(_fault, size),
        requires=partial(_positive_size, size),
        has_lanes=True,
        joins=partial(_joins, size),
    )


def yielding(*sizes: Size) -> Form:
    """Return the form of a stop: a store, of one of some sizes, whose effort has a limit."""
    first = sizes[0]
    fields = {
        size.field: law_field(size.unit, {}, size.symbol if size is first else "", None)
        for size in sizes
    }
    others: dict[str, Any] = {size.field: size.out.unit for size in sizes[1:]}

    def meant(element: Any) -> Size:
        return next(size for size in sizes if getattr(element, size.field) is not None)

    def ports(element: Any, name: str, branch: Branch) -> tuple[Port, ...]:
        size = meant(element)
        law = _costate(size, element, state_symbol(element, name))
        return _with_slip(size, element, _storage(size, element, name, branch, law), name)

    def requires(element: Any, _: str) -> tuple[Cmp, ...]:
        limit = Cmp(">=", element.law("limit"), ZERO)
        return positive(element.law(meant(element).field)), limit

    def starts(element: Any, name: str) -> tuple[Cmp, ...]:
        costate = _costate(meant(element), element, state_symbol(element, name))
        return (Cmp("<=", Call("abs", (costate,)), element.law("limit")),)

    between = (Pair, ..., [first.domain.node, first.domain.reference])
    limit = law_field(first.out.unit, {}, "F_c", **others)
    return Form(
        fields={"between": between, **fields, "limit": limit, "heats": (BodyName, ..., "body")},
        doc=_stop_doc(sizes),
        ports=ports,
        one_of=tuple(size.field for size in sizes),
        letter="z",
        unit=lambda element: meant(element).out.state_unit,
        requires=requires,
        starts=starts,
        has_lanes=True,
    )


def _fields(size: Size) -> Fields:
    out, letters = size.out, {size.out.state_letter: size.out.state_unit}
    fields = {
        **places(size.domain, size.at),
        size.field: law_field(size.unit, letters, size.symbol, None),
        out.name: law_field(out.unit, letters, default=None),
        "energy": law_field("J", letters, default=None),
    }
    if size.stiff:
        fields["rest"] = law_field(out.state_unit, {}, default="0")
    if size.slips:
        known = {out.letter: out.unit, size.driven.letter: size.driven.unit, "T": "K"}
        fields["slip"] = law_field(size.driven.unit, known, default=None, sees=True)
        fields |= {"heats": (OptionalBody, None, None), "discontinuous": (Jumps, False, None)}
    return fields


def _store_doc(size: Size) -> str:
    out, driven, letter = size.out, size.driven, size.out.state_letter
    f, v = out.letter, driven.letter
    slip = (
        f" With `slip` [{driven.unit}], a law of {f}, its {out.name}, and of {v}, its {driven.name}"
        f" (Bouc-Wen's: (beta*abs({v})*sign({f}) + gam*{v})*abs({f}/{f}_0)**n), the state's rate is"
        f" {v} - slip, and {out.name} times slip `heats` a body with the temperature T."
    )
    return (
        f"State {letter} [{out.state_unit}], the {out.state}, is the integral of the "
        f"{with_sense(driven, size.at)}; co-state the {with_sense(out, size.at)}, {out.prefix} = "
        f"{f'{size.field}*({letter} - rest)' if size.stiff else f'{letter}/{size.field}'} "
        f"[{out.unit}]; energy the integral of {out.prefix} over {letter}. Instead of "
        f"`{size.field}`, `{out.name}` gives {out.prefix} or `energy` the energy [J], as a law of "
        f"{letter}.{slip if size.slips else ''}"
    )


def _stop_doc(sizes: tuple[Size, ...]) -> str:
    kinds = ", or ".join(
        f"with `{size.field}` a store of the co-state {size.out.prefix} = "
        f"{f'{size.field}*z' if size.stiff else f'z/{size.field}'} [{size.out.unit}]"
        for size in sizes
    )
    return (
        f"{kinds[0].upper()}{kinds[1:]}, whose magnitude never exceeds `limit`: what would go "
        "beyond it slips, and co-state times slip `heats` a body. Steps are exact on their path; "
        "`rhs` at the limit is the projected rate. The Jenkins element, a cell of Maxwell-slip. An "
        'end stop is a spring with force = "k_c*max(q - gap, 0)", or below "-k_c*max(-q - gap, 0)".'
    )


def _costate(size: Size, element: Any, state: str) -> Expr:
    """Return the co-state that a size gives; it may be 0/0 where it has a limit."""
    moved = _moved(size, element, state)
    value = rename(element.law(size.field), {size.out.state_letter: state})
    return Mul(value, moved) if size.stiff else Div(moved, value)


def _continued(size: Size, element: Any, state: str) -> Expr:
    """Return the co-state that a size gives, with its limit where it is 0/0 at rest."""
    return without_common_factors(_costate(size, element, state), state, _rest(size, element))


def _positive_size(size: Size, element: Any, name: str) -> tuple[Cmp, ...]:
    """Return the conditions that the size is positive, or >= 0 if it is 0/0 at rest, as sinh(q)/q.

    In that case its sign is that of state times co-state, which has a value at rest, too; its limit
    at rest is the co-state's slope.  With a kink at rest, it is bounded if the co-state is 0 there.
    """
    if getattr(element, size.field) is None:
        return ()
    state, rest = state_symbol(element, name), _rest(size, element)
    law = _continued(size, element, state)
    if law == _costate(size, element, state):
        return (positive(rename(element.law(size.field), {size.out.state_letter: state})),)
    limit = slope_at(law, state, rest)
    signs = mul(_moved(size, element, state), law), *((limit,) if limit else ())
    here = value_at(law, state, rest)
    bounded = (Cmp("<=", here, ZERO), Cmp(">=", here, ZERO)) if here not in (None, ZERO) else ()
    return (*(Cmp(">=", sign, ZERO) for sign in signs), *bounded)


def _moved(size: Size, element: Any, state: str) -> Expr:
    """Return a state minus its value at rest."""
    return add(Sym(state), neg(_rest(size, element)))


def _rest(size: Size, element: Any) -> Expr:
    return parse_law(getattr(element, "rest", "0"), "rest") if size.stiff else ZERO


def _storage(size: Size, element: Any, name: str, branch: Branch, law: Expr) -> Storage:
    several = f", {element.joined} of them joined" * (element.joined > 1)
    return Storage(
        state=state_symbol(element, name),
        law=law,
        costate=f"{size.out.prefix}_{name}",
        branch=branch,
        domain=size.domain,
        imposes=size.imposes,
        units=(size.out.state_unit, size.out.unit),
        doc=f"{size.out.state} of {element.kind} '{name}'" + several,
    )


def _with_slip(size: Size, element: Any, port: Storage, name: str) -> tuple[Port, ...]:
    """Return a store and its slip: in series if the co-state is a through variable."""
    (first, last), inner = port.branch, f"{name}:inner"
    series = size.imposes is PowerVariable.THROUGH
    here, there = ((inner, last), (first, inner)) if series else (port.branch, port.branch)
    limit = element.law("limit") if hasattr(element, "limit") else None
    slip = DissipativePort(
        letter=size.out.letter,
        law=element.law("slip") if limit is None else _projected_slip(size, limit),
        field="slip" if limit is None else "",
        output=f"slip_{name}",
        effort=f"{size.out.prefix}_{name}",
        branch=there,
        domain=size.domain,
        imposes=size.imposes.other,
        heats=element.heats,
        rate_letter=size.driven.letter,
        rate=f"{size.driven.prefix}_{name}",
        state=port.state,
        limit=limit,
    )
    return replace(port, branch=here), slip


def _projected_slip(size: Size, limit: Expr) -> Expr:
    """Return the slip of a stop: the rate, where it would lead beyond the limit."""
    f, v = Sym(size.out.letter), Sym(size.driven.letter)
    forth, back = Cmp(">=", f, limit), Cmp("<=", f, neg(limit))
    return If(If(v, forth, ZERO), Cmp(">", v, ZERO), If(v, back, ZERO))


def _joins(size: Size, element: Any) -> bool:
    """Return whether `count` of an element share an across variable, and so one state."""
    across = size.imposes is PowerVariable.ACROSS and element.bank is None
    return across and getattr(element, "slip", None) is None


def _joined_law(law: Expr, energy: Expr | None, state: str, count: int) -> tuple[Expr, Expr | None]:
    """Return the law and energy of `count` equal stores in parallel, joined into one state.

    x = count*x_j and U(x) = count*U_j(x/count), so that dU/dx is the co-state of each.
    """
    number = Num(Fraction(count))
    share = {state: div(Sym(state), number)}
    if isinstance(law, Div) and law.left == Sym(state):
        law = Div(law.left, mul(number, inserted(law.right, share)))
    else:
        law = inserted(law, share)
    return law, energy and mul(number, inserted(energy, share))


def _fault(size: Size, element: Any) -> Fault | None:
    """Return the first fault of fields that depend on each other, such as slip and heats."""
    slip = getattr(element, "slip", None)
    if size.slips and (slip is None) != (element.heats is None):
        given, other = ("heats", "slip") if slip is None else ("slip", "heats")
        remedy = f"add {other} = '...', or leave {given} out"
        return f".{given}", f"{given} is given without {other}", "both or none", remedy
    if _joins(size, element) and element.series is not None and element.count is not None:
        what = f"those that count joins have one {size.out.word}, and series is given"
        return ".series", what, "count alone", "leave series out"
    if size.stiff and getattr(element, size.field) is None and element.rest != "0":
        given = size.out.name if element.energy is None else "energy"
        remedy = f"write {size.out.state_letter} - ({element.rest}) in the law, and leave rest out"
        return ".rest", f"rest is given beside {given}", f"rest beside {size.field}", remedy
    return None
