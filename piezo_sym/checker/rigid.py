"""Stores whose co-states depend on each other, joined into one state.

Input: the text of a spec.  Output: a `Spec` in which a store that others decide follows them.  Of
co-states e = Z e_r that Kirchhoff's laws allow, e = (x - x_0)/c, those come first in the spec that
are kept; their states are Z^T x, and e_r = (x_r - Z^T x_0)/(Z^T c Z), where Z^T c Z is diagonal.
"""

from typing import Any

from .field import ONE, ZERO, Field, Ratio
from .laws import derivative, made, need, num, put, sym, symbols, walk
from .network import Form, relations
from .spec import Element, Spec
from .spec import read_spec as read

Row = dict[str, Ratio]
AFFINE = ("num", "sym", "+", "*", "/", "neg", "**")


class _Laws:
    """The algebra of a network in which all that is not given is a symbol."""

    def __init__(self) -> None:
        self.one, self.field = ONE, Field()

    def law(self, element: Element, field: str, _: int, *letters: Ratio) -> Ratio:
        """Return a law of an element, its letter being given."""
        tree = element.law if field == "law" else element.laws[field]
        own = dict(zip((("z", element.name),), letters, strict=False))
        return self.field.of(tree or num(0), lambda n: own.get(n.value) or self.field.of(n))

    def like(self, _: tuple[str, int]) -> Ratio:
        """Return 1: a bank has one lane here."""
        return ONE


def read_spec(text: str) -> Spec:
    """Return what a spec says; raises `InputError` if it is none that the checker knows."""
    spec, laws = read(text), _Laws()
    counts = {e.lanes[0]: 1 for e in spec.elements.values() if e.lanes}
    groups = list[dict[str, Row]]()
    for (_, last, _), row in _reduced(relations(spec, counts, laws), [*spec.elements]).items():
        stores = [spec.elements[name] for role, name, _ in row if role == "E"]
        if not 1 < len(row) == len(stores) or any(store.lanes is not None for store in stores):
            return spec  # its laws have no solution, or none that is known here
        own = {name: -factor for (_, name, _), factor in row.items() if name != last}
        group = {name: {name: ONE} for name in own} | {last: own}
        for other in [g for g in groups if not g.keys().isdisjoint(own)]:
            groups.remove(other)
            group |= other
        groups.append(group)
    for group in groups:
        spec = _joined(spec, laws.field, group)
    return spec


def _reduced(found: list[Form], order: list[str]) -> dict[Any, Form]:
    """Return relations, each solved for the co-state that stands last in the spec."""
    rows = dict[Any, Form]()
    for row in found:
        for last, other in rows.items():
            _less(row, last, other)
        if row:
            last = max(row, key=lambda label: (label[0] != "E", order.index(label[1])))
            row = {label: factor / row[last] for label, factor in row.items()}
            for other in rows.values():
                _less(other, last, row)
            rows[last] = row
    return rows


def _less(row: Form, label: Any, other: Form) -> None:
    """Take from a row what makes it free of a label."""
    if factor := row.get(label):
        for key, value in other.items():
            row[key] = row[key] - factor * value if key in row else -factor * value
            if row[key] == 0:
                del row[key]


def _joined(spec: Spec, field: Field, Z: dict[str, Row]) -> Spec:
    """Return a spec in which some stores follow those whose rows of Z are their own."""
    elements, states, initial = dict(spec.elements), dict(spec.states), dict(spec.initial)
    kept = [name for name in spec.elements if name in Z and Z[name] == {name: ONE}]
    A = [[ZERO for _ in kept] for _ in kept]
    y = [field.of(sym(("x", name))) for name in kept]
    start = [num(0) for _ in kept]
    for name, row in Z.items():
        c, back = _compliance(spec.elements[name], field)
        for k, z in ((k, row[other]) for k, other in enumerate(kept) if other in row):
            share, own = field.tree(z), spec.initial.get(name, (num(0),))[0]
            known = all(role == "p" for role, _ in symbols(share))
            need(known, "a rigid coupling has a ratio that is not of parameters alone")
            A[k] = [a + z * c * row.get(o, ZERO) for a, o in zip(A[k], kept, strict=True)]
            y[k] += z * c * back
            start[k] = made("x + z*a", x=start[k], z=share, a=own)
        if name not in kept:
            elements[name] = _following(elements[name], spec)
            del states[elements[name].state]
    for name, law, first in zip(kept, _solved(A, y), start, strict=True):
        elements[name] = elements[name]._replace(costate=field.tree(law))
        initial[name] = (first,)
    return spec._replace(elements=elements, states=states, initial=initial)


def _compliance(store: Element, field: Field) -> tuple[Ratio, Ratio]:
    """Return c and the co-state at x = 0 of a store whose co-state is (x - x_0)/c."""
    law, x = store.costate or num(0), ("x", store.name)
    plain = all(n.op in AFFINE for n in walk(law) if x in symbols(n))
    slope = field.of(derivative(law, x))
    quadratic = plain and x not in symbols(field.tree(slope))
    need(
        quadratic and store.kind.costate != "energy", f"the energy of {store.name} is not quadratic"
    )
    return ONE / slope, field.of(put(law, {x: num(0)}))


def _following(store: Element, spec: Spec) -> Element:
    """Return a store that follows others: its co-state is no law of its own state."""
    others = (e for e in spec.elements.values() if e is not store)
    trees = [*spec.conditions, *(tree for e in others for tree in e.laws.values())]
    used = any(("x", store.name) in symbols(tree) for tree in trees)
    need(not used, f"a law or condition uses the state of {store.name}, which is joined")
    laws = {} if store.kind.form == "store" else store.laws
    need(store.law is None or store.kind.form != "store", f"{store.name} slips, and is joined")
    return store._replace(costate=None, laws=laws, follows=True)


def _solved(A: list[list[Ratio]], y: list[Ratio]) -> list[Ratio]:
    """Return A^-1 y."""
    rows = [[*row, right] for row, right in zip(A, y, strict=True)]
    for k, row in enumerate(rows):
        row[:] = [entry / row[k] for entry in row]
        for other in rows:
            if other is not row:
                other[:] = [one - other[k] * entry for one, entry in zip(other, row, strict=True)]
    return [row[-1] for row in rows]
