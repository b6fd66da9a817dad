"""Stores whose co-states depend on each other, joined into one state.

Input: the text of a spec.  Output: a `Spec` in which stores with dependent co-states follow others.
Of the co-states e = Z e_r that Kirchhoff's laws allow, e = (x - x_0)/c, the first in the spec are
kept; their states are Z^T x, and e_r = (Z^T c Z)^-1 (x_r - Z^T x_0).
"""

from .field import ONE, ZERO, Field, Ratio
from .laws import build, derivative, need, num, subs, sym, symbols, walk
from .network import Choice, Form, relations, solved
from .spec import Element, Spec
from .spec import read_spec as read

Row = dict[str, Ratio]
AFFINE = ("num", "sym", "+", "*", "/", "neg", "**")


class _Laws:
    """The algebra of a network in which everything but letters is a symbol."""

    def __init__(self) -> None:
        self.one, self.field = ONE, Field()

    def law(self, element: Element, field: str, _: int, *letters: Ratio) -> Ratio:
        """Return a law of an element for a value of its letter."""
        tree = element.law if field == "law" else element.laws[field]
        own = dict(zip((("z", element.name),), letters, strict=False))
        return self.field.of(tree or num(0), lambda n: own.get(n.value) or self.field.of(n))

    def weight(self, _: tuple[str, int]) -> Ratio:
        """Return 1: a bank has one lane here."""
        return ONE


def read_spec(text: str) -> Spec:
    """Return the spec with joined stores; raises `InputError` if the checker cannot read it."""
    spec, laws = read(text), _Laws()
    counts = {e.lanes[0]: 1 for e in spec.elements.values() if e.lanes}
    groups, order = list[dict[str, Row]](), [*spec.elements]

    def last(n: int, row: Form) -> Choice:
        rank = {label: (label[0] != "E", order.index(label[1])) for label in row}
        return (int(not row), n), max(row, key=rank.__getitem__, default=None)

    for label, row in solved(relations(spec, counts, laws), last)[0].items():
        stores = [spec.elements[name] for role, name, _ in (label, *row) if role == "E"]
        banked = any(store.lanes is not None for store in stores)
        if not row or len(row) + 1 != len(stores) or banked:
            return spec  # without a solution, or none that the checker finds
        own = {name: factor for (_, name, _), factor in row.items()}
        group = {name: {name: ONE} for name in own} | {label[1]: own}
        for other in [g for g in groups if not g.keys().isdisjoint(own)]:
            groups.remove(other)
            group |= other
        groups.append(group)
    for group in groups:
        spec = _joined(spec, laws.field, group)
    return spec


def _joined(spec: Spec, field: Field, Z: dict[str, Row]) -> Spec:
    """Return a spec in which stores follow the kept ones, whose rows of Z are unit vectors."""
    elements, states, initial = dict(spec.elements), dict(spec.states), dict(spec.initial)
    kept = [name for name in spec.elements if name in Z and Z[name] == {name: ONE}]
    # the row (Z^T c Z) e_r - (x_r - Z^T x_0) = 0 of each kept store; "" labels the constant
    rows: dict[str, Row] = {name: {"": -field.of(sym(("x", name)))} for name in kept}
    start = dict.fromkeys(kept, num(0))
    for name, row in Z.items():
        c, back = _compliance(spec.elements[name], field)
        for k, z in row.items():
            share, own = field.tree(z), spec.initial.get(name, (num(0),))[0]
            known = all(role == "p" for role, _ in symbols(share))
            need(known, "a rigid coupling has a ratio that is not of parameters alone")
            more = {other: z * c * entry for other, entry in row.items()} | {"": -z * c * back}
            rows[k] = {o: rows[k].get(o, ZERO) + more.get(o, ZERO) for o in {**rows[k], **more}}
            start[k] = build("x + z*a", x=start[k], z=share, a=own)
        if name not in kept:
            elements[name] = _following(elements[name], spec)
            del states[elements[name].state]
    found, *_ = solved(rows.values(), _first)
    need(len(found) == len(kept), "the stores that are joined are none together")
    for name, law in found.items():
        elements[name] = elements[name]._replace(costate=field.tree(law.get("", ZERO)))
        initial[name] = (start[name],)
    return spec._replace(elements=elements, states=states, initial=initial)


def _first(n: int, row: Form) -> Choice:
    found = next((name for name, factor in row.items() if name and factor != ZERO), None)
    return (int(found is None), n), found


def _compliance(store: Element, field: Field) -> tuple[Ratio, Ratio]:
    """Return c and the co-state at x = 0 of a store whose co-state is (x - x_0)/c."""
    law, x = store.costate or num(0), ("x", store.name)
    plain = all(n.op in AFFINE for n in walk(law) if x in symbols(n))
    slope = field.of(derivative(law, x))
    quadratic = plain and x not in symbols(field.tree(slope)) and store.kind.costate != "energy"
    need(quadratic, f"the energy of {store.name} is not quadratic")
    return ONE / slope, field.of(subs(law, {x: num(0)}))


def _following(store: Element, spec: Spec) -> Element:
    """Return a store as a follower, without a co-state law of its own."""
    others = (e for e in spec.elements.values() if e is not store)
    trees = [*spec.conditions, *(tree for e in others for tree in e.laws.values())]
    used = any(("x", store.name) in symbols(tree) for tree in trees)
    need(not used, f"a law or condition uses the state of {store.name}, which is joined")
    laws = {} if store.kind.form == "store" else store.laws
    need(store.law is None or store.kind.form != "store", f"{store.name} slips, and is joined")
    return store._replace(costate=None, laws=laws, follows=True)
