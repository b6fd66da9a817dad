"""Stores with dependent co-states, joined into few states that have the energy of all.

Input: solved junction laws with followers, which impose their rates.  Output: the circuit without
followers, and a `Joint` for each group of stores.  With the co-states e = Z e_r that the junctions
allow, rests x_0 and e = Q (x - x_0),

    x_r = Z^T x     e_r = A^-1 y     U_r = y^T A^-1 y/2     y = x_r - Z^T x_0     A = Z^T Q^-1 Z.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import final

import sympy as sp

from piezo_sym.algebra.symbols import coefficient
from piezo_sym.errors import NetworkError, SpecError, listing, quote
from piezo_sym.expressions.calculus import add, div, inserted, mul, neg, power
from piezo_sym.expressions.exact_eval import evaluate
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import ONE, ZERO, Add, Div, Expr, Mul, Neg, Num, Sym, names
from piezo_sym.network.inverse import constant_slope
from piezo_sym.network.kirchhoff import Laws
from piezo_sym.spec.circuit import Circuit, Placed
from piezo_sym.spec.elements.ports import Coupling, Storage
from piezo_sym.spec.model import Model
from piezo_sym.spec.tables import laws, starts

#: Tolerance on co-states of initial values, relative to their terms.
CLOSE = 1e-9
#: The most states of one joint; the inverse of a larger matrix would have thousands of terms.
MOST_KEPT = 3
TWO = Num(Fraction(2))


@final
@dataclass(frozen=True)
class Member:
    """A store that is joined with others."""

    #: element, store: as the spec declares them.
    element: str
    store: Storage
    #: Its row of Z: the weights of the kept stores' co-states in its own.
    shares: tuple[Expr, ...]
    #: compliance, rest: 1/Q and x_0: its co-state is (x - x_0)/compliance.
    compliance: Expr
    rest: Expr

    @property
    def energy(self) -> Expr:
        """The energy of this store alone, in its co-state."""
        return Div(mul(self.compliance, power(Sym(self.store.costate), Fraction(2))), TWO)


@final
@dataclass(frozen=True)
class Joint:
    """Joined stores: those kept, whose states remain, and their followers."""

    kept: tuple[Member, ...]
    followers: tuple[Member, ...]

    @property
    def members(self) -> tuple[Member, ...]:
        """The kept stores, then the followers."""
        return (*self.kept, *self.followers)

    def state_texts(self) -> Iterator[str]:
        """Yield each kept state as the sum that it stands for: p = (p of m1) + (p_2 of m2)/n."""
        for n, kept in enumerate(self.kept):
            terms = (
                mul(m.shares[n], Sym(f"({m.store.state} of {m.element})")) for m in self.members
            )
            yield f"{kept.store.state} = {spell(add(*terms))}"

    def costate(self, member: Member) -> Expr:
        """Return the co-state of a member in terms of those of the kept stores."""
        costates = (Sym(other.store.costate) for other in self.kept)
        return add(*map(mul, member.shares, costates))

    def start(self, model: Model, state: str) -> Expr:
        """Return the initial value Z^T x of a kept state."""
        n = next(n for n, member in enumerate(self.kept) if member.store.state == state)
        return add(*(mul(m.shares[n], *starts(model, m.store.state)) for m in self.members))


def join_stores(laws: Laws) -> tuple[Circuit, tuple[Joint, ...]]:
    """Return the circuit without followers, and the joints that contain them.

    Raises `SpecError` if initial values disagree, or a law or condition depends on the state of a
    follower.  Raises `NetworkError` if too many states are joined with each other.
    """
    Z = [
        {number: laws.expression(share) for (_, number), share in laws.answers["R", m][0].items()}
        for m in range(len(laws.followers))
    ]
    circuit, joints = laws.circuit, list[Joint]()
    ratios = {port.name: port.ratio for _, port in circuit.of(Coupling)}
    for kept, followers in _groups(Z):
        states = [laws.states[n] for n in kept] + [laws.followers[m] for m in followers]
        stores = [(placed, port) for placed, port in states if isinstance(port, Storage)]
        rows = [{n: sp.S.One} for n in kept] + [Z[m] for m in followers]
        shares = sp.Matrix([[row.get(n, sp.S.Zero) for n in kept] for row in rows])
        joint = _joint(stores, shares, ratios)
        _check_uses(circuit, joint)
        _check_starts(circuit.model, joint)
        for (placed, _), port in zip(stores, _kept_stores(joint, shares, ratios), strict=False):
            circuit = circuit.replaced(placed, port)
        joints.append(joint)
    removed = [placed for placed, _ in laws.followers]
    ports = tuple(placed for placed in circuit.ports if placed not in removed)
    return replace(circuit, ports=ports), tuple(joints)


def _groups(Z: list[dict[int, sp.Expr]]) -> list[tuple[list[int], list[int]]]:
    """Return (kept, followers) of each group of stores whose rows of Z overlap."""
    groups: list[tuple[list[int], list[int]]] = []
    for m, row in enumerate(Z):
        near = [group for group in groups if not row.keys().isdisjoint(group[0])]
        groups = [group for group in groups if group not in near]
        kept = sorted({*row, *(n for group in near for n in group[0])})
        groups.append((kept, [*(other for group in near for other in group[1]), m]))
    return [(kept, sorted(followers)) for kept, followers in groups]


def _joint(
    stores: list[tuple[Placed, Storage]], shares: sp.Matrix, ratios: Mapping[str, Expr]
) -> Joint:
    """Return the joint of stores with their rows of Z, the kept ones first."""
    members = [
        Member(
            placed.element,
            store,
            tuple(inserted(coefficient(share), ratios) for share in shares.row(i)),
            _compliance(store),
            _rest(store),
        )
        for i, (placed, store) in enumerate(stores)
    ]
    count = shares.cols
    if count > MOST_KEPT:
        named = listing(quote(member.element) for member in members)
        remedy = "put a spring or damper, or a resistor, between some of them"
        raise NetworkError(
            f"{named} are joined into {count} states that depend on each other",
            "network",
            f"at most {MOST_KEPT}",
            remedy,
        )
    return Joint(tuple(members[:count]), tuple(members[count:]))


def _compliance(store: Storage) -> Expr:
    """Return 1/Q of a store with a quadratic energy."""
    slope = constant_slope(store.law, store.state) or ONE
    return slope.right if isinstance(slope, Div) and slope.left == ONE else div(ONE, slope)


def _rest(store: Storage) -> Expr:
    """Return the state at which a store's co-state is zero."""
    match store.law:
        case Div(Sym(), _) | Mul(_, Sym()):
            return ZERO
        case Mul(_, Add((Sym(), Neg(rest)))):
            return rest
    return neg(mul(_compliance(store), inserted(store.law, {store.state: ZERO})))


def _kept_stores(joint: Joint, Z: sp.Matrix, ratios: Mapping[str, Expr]) -> Iterator[Storage]:
    """Yield the kept stores with the energy of all: e_r = A^-1 y."""
    sizes = [sp.Dummy() for _ in joint.members]  # their compliances
    A = Z.T * sp.diag(*sizes) * Z

    def tree(expr: sp.Expr) -> Expr:
        """Return a polynomial in compliances, its terms in the order of their stores."""
        terms = []
        for powers, factor in sp.Poly(expr, *sizes).terms():
            term = inserted(coefficient(factor), ratios)
            for member, exponent in zip(joint.members, powers, strict=True):
                term = mul(term, power(member.compliance, Fraction(exponent))) if exponent else term
            terms.append(term)
        return add(*terms)

    divisor, adjugate = tree(A.det()), A.adjugate().applyfunc(sp.expand)
    y = []  # x_r - Z^T x_0
    for n, member in enumerate(joint.kept):
        rest = add(*(mul(other.shares[n], other.rest) for other in joint.members))
        y.append(add(Sym(member.store.state), neg(rest)))
    tops = [
        add(*(mul(tree(entry), y[m]) for m, entry in enumerate(adjugate.row(n))))
        for n in range(Z.cols)
    ]
    energy = div(add(*map(mul, y, tops)), mul(TWO, divisor)) if Z.cols > 1 else None
    for member, top in zip(joint.kept, tops, strict=True):
        others = listing(quote(other.element) for other in joint.followers)
        doc = f"{member.store.doc}, joined with {others}"
        yield replace(member.store, law=div(top, divisor), energy=energy, doc=doc)


def _check_uses(circuit: Circuit, joint: Joint) -> None:
    """Refuse laws and conditions that use the state of a follower."""
    used = [(c.where, {*names(c.tree)}) for c in circuit.conditions]
    used += [(law.where, {*names(law.tree)}.difference(law.letters)) for law in laws(circuit.model)]
    for store in (member.store for member in joint.followers):
        for where, words in used:
            if store.state in words:
                kept = listing(quote(member.store.state) for member in joint.kept)
                what = f"{quote(store.state)} is joined into {kept}, and no state of its own"
                raise SpecError(what, where, remedy=f"write it with {kept}: see piezo-sym show")


def _check_starts(model: Model, joint: Joint) -> None:
    """Refuse given initial values with co-states that joined stores cannot have together."""
    if model.initial.keys().isdisjoint(member.store.state for member in joint.members):
        return
    values = {n: p.si for n, p in model.parameters.items() if isinstance(p.si, float)}
    values |= {name: entry.si for name, entry in model.inputs.items()}
    costates = [_initial_costate(model, member, values) for member in joint.kept]
    for member in joint.followers:
        costate, store = _initial_costate(model, member, values), member.store
        terms = [evaluate(z, values) * e for z, e in zip(member.shares, costates, strict=True)]
        if abs(costate - sum(terms)) > CLOSE * max(abs(costate), *map(abs, terms)):
            given = listing(
                f"{other.store.costate} = {e:g} {other.store.units[1]}"
                for other, e in zip(joint.kept, costates, strict=True)
            )
            there = sum(terms) * evaluate(member.compliance, values) + evaluate(member.rest, values)
            start = f"{store.costate} = {costate:g}"
            what = f"{quote(member.element)} is joined, and starts with {start}"
            expected = f"{sum(terms):g} {store.units[1]}, as {given}"
            remedy = f"give {store.state} = {there / model.joined.get(store.state, 1):.12g}"
            raise SpecError(what, f"initial.{store.state}", expected, remedy)


def _initial_costate(model: Model, member: Member, values: Mapping[str, float]) -> float:
    """Return the co-state of a store at its given initial value."""
    (start,) = starts(model, member.store.state)
    try:
        beyond = evaluate(start, values) - evaluate(member.rest, values)
        return beyond / evaluate(member.compliance, values)
    except ArithmeticError as cause:
        what, remedy = "has no finite co-state", "check the values of its parameters"
        raise SpecError(what, f"initial.{member.store.state}", remedy=remedy) from cause
