"""Energies of a spec: fields that go together, and laws of stores that depend on one state.

A capacitor whose capacitance depends on a temperature has no energy of its charge alone, but one of
its charge and the body's entropy; an inductor whose inductance depends on a gap has one of its flux
linkage and the gap.  For these there is the kind `storage`.
"""

from collections.abc import Iterator, Mapping
from functools import reduce

from piezo_sym.errors import SpecError, listing, quote
from piezo_sym.expressions.calculus import add, neg
from piezo_sym.expressions.energies import antiderivative
from piezo_sym.expressions.parse import parse_condition
from piezo_sym.expressions.removable import factors
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import (
    ZERO,
    Add,
    Cmp,
    Div,
    Expr,
    Mul,
    Num,
    Sym,
    names,
    replace,
    walk,
)
from piezo_sym.spec.elements.domains import PowerVariable
from piezo_sym.spec.elements.marks import LawField
from piezo_sym.spec.elements.ports import Body, Storage
from piezo_sym.spec.fields import Tables
from piezo_sym.spec.tables import bank_of, bodies, condition_text, greater, heat_names, states

ALONE = "let it depend on parameters and its own state"
APART = "write lanes and dissipation apart from the store, which one storage can then replace"


def check_energies(spec: Tables) -> None:
    """Check the fields and laws of elements that store energy."""
    for name, element in spec.elements.items():
        if fault := element.form.fault(element):
            field, what, expected, remedy = fault
            raise SpecError(what, f"elements.{name}{field}", expected, remedy)
    hot = {"T": next(iter(bodies(spec)), ""), **heat_names(spec)}
    owners = states(spec)
    for name, element in spec.elements.items():
        for law in element.laws(name):
            own = {element.letter} if element.letter else {*getattr(element, "states", ())}
            if own and own.issuperset(law.letters):
                _check_law(spec, law, owners if element.is_body else owners | hot, hot)


def _check_law(
    spec: Tables, law: LawField, owners: Mapping[str, str], hot: Mapping[str, str]
) -> None:
    """Refuse a store's law that depends on states of other elements, which `owners` gives.

    `hot` is the body of each temperature.
    """
    known = {*spec.parameters, *law.letters}
    found = {w: owners[w] for w in names(law.tree) if w in owners and w not in known}
    found = {word: other for word, other in found.items() if other != law.element}
    if not found:
        return
    words, own = " and ".join(map(quote, found)), " and ".join(law.letters)
    what, remedy = f"the {law.field} depends on {words}", ALONE
    parts = tuple(dict.fromkeys((law.element, *found.values())))
    single = all(parts) and sum(spec.elements[part].is_body for part in parts) < 2
    storage = _storage(spec, parts, hot) if single else ""
    if not own and not storage:
        remedy = f"write {law.field} = 'a', a parameter in {law.mark.unit}"
        raise SpecError(what, law.where, "parameters alone: it is constant in a run", remedy)
    if alike := _same_motions(spec, law.element, found):
        meant = ", ".join(f"{other} for {word}" for word, other in alike.items())
        remedy = f"write {meant}: it has the same rate between the same nodes"
    elif single:
        given = f"{listing(map(quote, parts[:-1]))} and {quote(parts[-1])}"
        remedy = f"give one energy of all their states in place of {given}: {storage}"
        remedy = remedy if storage else f"{APART}; or {ALONE}"
    what += f", and then is no energy of {own or 'its own state'}"
    raise SpecError(what, law.where, "an energy of all states that it depends on", remedy)


def _same_motions(spec: Tables, name: str, found: Mapping[str, str]) -> dict[str, str]:
    """Return an element's own names for states of other elements that move as its own do.

    `found` has the element of each of these states; the result is {} unless all move alike.
    """
    own = {place: state for state, place in motions(spec, name).items()}
    moved = {
        word: motions(spec, other).get(word) if other else None for word, other in found.items()
    }
    if not all(place in own for place in moved.values()):
        return {}
    letter = spec.elements[name].letter
    return {word: letter or own[place] for word, place in moved.items() if place}


def motions(spec: Tables, name: str) -> dict[str, object]:
    """Return the branch whose across variable each state of an element is the integral of.

    Such states of stores in parallel move alike; charges and momenta do not.
    """
    ports = (port for port in spec.elements[name].ports(name) if isinstance(port, Storage))
    return {p.state: p.branch for p in ports if p.imposes is PowerVariable.THROUGH}


def _storage(spec: Tables, parts: tuple[str, ...], hot: Mapping[str, str]) -> str:
    """Return the text of a `storage` that has the energies of some stores and bodies; '' if none.

    It has no lanes, and no law beside its energy.  The law of the body, one at most, takes the
    place of its temperatures, `hot`.
    """
    ports = {part: spec.elements[part].ports(part) for part in parts}
    stores = {n: [p for p in own if isinstance(p, Storage | Body)] for n, own in ports.items()}
    heated = {name: p for name, own in stores.items() for p in own if isinstance(p, Body)}
    others = any(len(own) != len(stores[name]) for name, own in ports.items())
    if others or not bank_of(spec).keys().isdisjoint(parts):
        return ""
    warm = {word: heated[body].law for word, body in hot.items() if body in heated}
    energies = (_energy(own[0], warm) for own in stores.values())
    energy = " + ".join(spell(law) if law else "<its energy>" for law in energies)
    listed = ", ".join(f"{p.state} = {_state(p)}" for own in stores.values() for p in own)
    name = next(iter(heated), parts[0])
    needs = ", ".join(f'"{condition_text(c)}"' for c in _needed(spec, stores, warm))
    made = f'{name} = {{ kind = "storage", energy = "{energy}", states = {{ {listed} }} }}'
    return f"{made}, and add to assume in [domain]: {needs}" if needs else made


def _needed(
    spec: Tables, stores: Mapping[str, list[Storage | Body]], warm: Mapping[str, Expr]
) -> Iterator[Cmp]:
    """Yield the conditions that [domain] lacks: those that the kinds of the elements require.

    Divisors must be positive, inner ones first.  With a body, so must be the factors of laws for
    which kinds require nothing, as the k of the force k*q*T/T_0, and the temperature, which then
    depends on the states of the stores, too.
    """
    known = {_normal_form(parse_condition(text, "domain.assume")) for text in spec.domain.assume}
    free: set[Expr] = {Sym(symbol) for symbol in states(spec)}
    sizes = {n: spec.elements[n].form.requires(spec.elements[n], n) for n in stores}
    needed = [condition for of_kind in sizes.values() for condition in of_kind]
    for name, port in ((name, port) for name, own in stores.items() for port in own):
        trees = reversed([*walk(replace(port.law, warm))])
        needed += [Cmp(">", node.right, ZERO) for node in trees if isinstance(node, Div)]
        rising = _positive_factors(port) if warm and not sizes[name] else ()
        needed += [Cmp(">", factor, ZERO) for factor in rising]
    needed = [Cmp(c.op, replace(c.left, warm), c.right) for c in needed]
    needed += [Cmp(">", Sym(f"T_{n}"), ZERO) for n in stores if spec.elements[n].is_body]
    for condition in dict.fromkeys(needed):
        if _normal_form(condition) not in known and condition.left not in free and names(condition):
            yield condition


def _normal_form(condition: Cmp) -> tuple[str, frozenset[Expr]]:
    """Return a condition as the sign of a sum, and its terms in any order."""
    turned = greater(condition)
    total = add(turned.left, neg(turned.right))
    return turned.op, frozenset(total.terms if isinstance(total, Add) else (total,))


def _positive_factors(port: Storage | Body) -> Iterator[Expr]:
    """Yield the factors without the state in each term of a store's law."""
    for term in port.law.terms if isinstance(port.law, Add) else (port.law,):
        above, below = factors(term, most=1)
        if not any(isinstance(factor, Num) and factor.value < 0 for factor in above):
            yield from (f for f in (*above, *below) if port.state not in names(f))


def _energy(port: Storage | Body, warm: Mapping[str, Expr]) -> Expr | None:
    """Return the energy of a store or body, with laws in place of temperatures, if it is found."""
    given = port.energy is not None
    found = port.energy if given else antiderivative(replace(port.law, warm), port.state)
    if found is None:
        return None
    whole = replace(found, warm) if given else found
    above, below = factors(whole, most=1)  # 1/(L/x) is x/L
    top = reduce(Mul, above)
    return Div(top, reduce(Mul, below)) if below else top


def _state(port: Storage | Body) -> str:
    """Return the state of a port as a `storage` has it."""
    if isinstance(port, Body):
        return '{ rate = "entropy" }'
    rate = port.domain.variable(port.imposes.other).name
    nodes = ", ".join(f'"{node}"' for node in port.branch)
    return f'{{ rate = "{rate}", between = [{nodes}] }}'
