"""Properties of a spec that several stages read from its tables.

Input: the tables of a spec.  Output: its states, banks, bodies, laws and conditions, in declaration
order.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import final

from piezo_sym.expressions.calculus import increasing, mul
from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.parse import parse_condition, parse_law
from piezo_sym.expressions.text import SPEC, write_comparison
from piezo_sym.expressions.tree import ZERO, Call, Cmp, Expr, Node, Num, names, rename, walk
from piezo_sym.spec.elements.base import Element, state_symbol
from piezo_sym.spec.elements.marks import LawField
from piezo_sym.spec.fields import Tables


@final
@dataclass(frozen=True)
class Condition:
    """A condition of the domain, with its place in the spec."""

    where: str
    tree: Cmp


def laws(spec: Tables) -> Iterator[LawField]:
    """Yield the laws of all elements."""
    return (law for name, element in spec.elements.items() for law in element.laws(name))


def states(spec: Tables) -> dict[str, str]:
    """Return the element of each state symbol, in declaration order."""
    return {s: name for name, e in spec.elements.items() for s in e.own_states(name)}


def starts(spec: Tables, symbol: str) -> tuple[Expr, ...]:
    """Return the initial value of a state: one, or one per lane where lanes differ.

    The state of joined stores starts at the sum of their initial values.
    """
    start = spec.initial.get(symbol, 0.0)
    parts = start if isinstance(start, tuple) else (start,)
    trees = tuple(
        parse_law(part, f"initial.{symbol}") if isinstance(part, str) else Num(Fraction(repr(part)))
        for part in parts
    )
    count = spec.joined.get(symbol)
    return tuple(mul(Num(Fraction(count)), tree) for tree in trees) if count else trees


def bodies(spec: Tables) -> tuple[str, ...]:
    """Return the names of the elements that have an entropy."""
    return tuple(name for name, e in spec.elements.items() if e.is_body)


def bank_of(spec: Tables) -> dict[str, str]:
    """Return the bank of each element that has one."""
    names = ((name, e.bank_of(name)) for name, e in spec.elements.items())
    return {name: bank for name, bank in names if bank is not None}


def bank_states(spec: Tables) -> dict[str, str]:
    """Return the bank of each state that has a value per lane."""
    owners = bank_of(spec)
    return {s: owners[name] for s, name in states(spec).items() if name in owners}


def banks(spec: Tables) -> dict[str, int]:
    """Return the size of each bank."""
    return {bank: spec.elements[name].count for name, bank in bank_of(spec).items()}


def alone(users: Iterable[tuple[str, str | None]]) -> dict[str, str]:
    """Return the names that one bank alone uses, with that bank; `users` are names and banks."""
    found: dict[str, set[str | None]] = {}
    for name, bank in users:
        found.setdefault(name, set()).add(bank)
    single = {name: banks.pop() for name, banks in found.items() if len(banks) == 1}
    return {name: bank for name, bank in single.items() if bank is not None}


def temperatures(spec: Tables) -> dict[str, str]:
    """Return the body of each temperature symbol.

    The symbol is ``T`` if there is one body and T means nothing else, otherwise ``T_<element>``.
    """
    names = bodies(spec)
    single = len(names) == 1 and "T" not in {*spec.parameters, *spec.inputs, *states(spec)}
    return {"T": names[0]} if single else {f"T_{name}": name for name in names}


def heat_names(spec: Tables) -> dict[str, str]:
    """Return the body of each name of a temperature: its symbol, and ``T_<element>``."""
    return {**temperatures(spec), **{f"T_{body}": body for body in bodies(spec)}}


def seen(spec: Tables) -> Iterator[str]:
    """Yield the states and temperatures that a law with `Letters.sees` may use.

    States of banks are left out: only laws in the same lane may use them.
    """
    lanes = bank_states(spec)
    yield from (symbol for symbol in states(spec) if symbol not in lanes)
    yield from (f"T_{body}" for body in bodies(spec))


def in_words(spec: Tables, law: LawField, hot: Mapping[str, str]) -> Expr:
    """Return a law in the symbols of [domain]; `hot` is the temperature symbol of each body.

    The letter of a dissipative law's variable, which [domain] has no symbol for, stays.
    """
    return rename(law.tree, meanings(spec, law, hot))


def meanings(spec: Tables, law: LawField, hot: Mapping[str, str]) -> dict[str, str]:
    """Return the symbols of [domain] for the names in a law that differ from them."""
    element = spec.elements[law.element]
    warm = [hot[given] for _, given in element.named("thermal_mass")]
    warm = warm or list(hot.values())[: len(hot) == 1]
    symbols = dict(zip(("T_1", "T_2"), warm, strict=False)) | dict(zip("T", warm, strict=False))
    if element.letter:
        symbols[element.letter] = state_symbol(element, law.element)
    if hasattr(element, "input"):
        symbols["T_e"] = element.input
    symbols = {letter: word for letter, word in symbols.items() if letter in law.letters}
    return (_body_temperatures(law.tree, hot) if law.mark.sees else {}) | symbols


def _body_temperatures(node: Node, hot: Mapping[str, str]) -> dict[str, str]:
    """Return the symbols of [domain] for each ``T_<element>`` in a tree."""
    return {n: hot[n[2:]] for n in names(node) if n.startswith("T_") and n[2:] in hot}


def conditions(spec: Tables) -> tuple[Condition, ...]:
    """Return the domain: the spec's assumptions, then what its kinds and half widths require."""
    hot, assumed = {body: word for word, body in temperatures(spec).items()}, list[Condition]()
    for n, text in enumerate(spec.domain.assume):
        tree = parse_condition(text, where := f"domain.assume[{n}]")
        sides = (tree.left, tree.right)
        left, right = (rename(side, _body_temperatures(side, hot)) for side in sides)
        assumed.append(Condition(where, Cmp(tree.op, left, right)))
    required = [
        Condition(f"elements.{name}", test)
        for name, element in spec.elements.items()
        for test in element.form.requires(element, name)
    ]
    places: list[tuple[str, Node]] = [(w.where, in_words(spec, w, hot)) for w in laws(spec)]
    places += [*((c.where, c.tree) for c in assumed), *initial_laws(spec)]
    widths = (Condition(where, test) for where, tree in places for test in _width_tests(tree))
    unique: dict[Cmp, Condition] = {}
    for condition in (*assumed, *required, *widths):
        unique.setdefault(condition.tree, condition)
    return tuple(unique.values())


def _width_tests(law: Node) -> Iterator[Cmp]:
    """Yield the condition ``width >= 0`` for each half width in a law that is no number >= 0."""
    for node in walk(law):
        if isinstance(node, Call) and RECORDS[node.function].width:
            width = node.args[1]
            if not (isinstance(width, Num) and width.value >= 0):
                yield Cmp(">=", width, ZERO)


def orders(spec: Tables, domain: Iterable[Condition]) -> Iterator[Condition]:
    """Yield the conditions that the knots of each table in the spec and its domain increase."""
    parts: list[LawField | Condition] = [*laws(spec), *domain]
    places = [*((part.where, part.tree) for part in parts), *initial_laws(spec)]
    tests = (Condition(where, order) for where, tree in places for order in increasing(tree))
    yield from dict.fromkeys(tests)


def inputs_of(elements: Iterable[Element]) -> set[str]:
    """Return the inputs that elements name."""
    return {given for e in elements for _, given in e.named("input")}


def unused_inputs(spec: Tables) -> list[str]:
    """Return the inputs that no element names, and no initial value uses."""
    used = inputs_of(spec.elements.values())
    used |= {word for _, tree in initial_laws(spec) for word in names(tree)}
    return [name for name in spec.inputs if name not in used]


def unused_parameters(spec: Tables) -> list[str]:
    """Return the parameters that no law or initial value uses; conditions on them may."""
    trees = [*(law.tree for law in laws(spec)), *(tree for _, tree in initial_laws(spec))]
    used = {word for tree in trees for word in names(tree)}
    return [name for name in spec.parameters if name not in used]


def without_default(spec: Tables, words: Iterable[str]) -> str:
    """Return what to do about the first input among names that is 0 where none is given, or ''."""
    for word in words:
        if word in spec.inputs and spec.inputs[word].default == 0:
            value = " (default = 293.15)" if spec.inputs[word].unit == "K" else ""
            return f"input {word} is 0, as it has no other default: give it one{value}"
    return ""


def greater(condition: Cmp) -> Cmp:
    """Return an equivalent comparison by > or >=: for < and <=, the sides are swapped."""
    turned = {"<": ">", "<=": ">="}
    if condition.op not in turned:
        return condition
    return Cmp(turned[condition.op], condition.right, condition.left)


def condition_text(condition: Cmp) -> str:
    """Return a condition as a reader would write it."""
    return write_comparison(condition, SPEC)


def lane_parameters(spec: Tables, domain: Iterable[Condition]) -> dict[str, str]:
    """Return the bank of each parameter that one bank alone uses: it may have a value per lane.

    `domain` is the spec's own, from `conditions`.
    """
    owners, lanes = bank_of(spec), bank_states(spec)
    words = [({*names(w.tree)} - {*w.letters}, owners.get(w.element)) for w in laws(spec)]
    for where, tree in initial_laws(spec):
        words.append(({*names(tree)}, lanes.get(where.removeprefix("initial."))))
    single = alone((word, bank) for used, bank in words for word in used)
    candidates = {word: single[word] for word in spec.parameters if word in single}
    lanes |= candidates
    groups = [names(condition.tree) for condition in domain]
    mixed = {n for g in groups if len({lanes[n] for n in g if n in lanes}) > 1 for n in g}
    return {word: bank for word, bank in candidates.items() if word not in mixed}


def initial_laws(spec: Tables) -> Iterator[tuple[str, Expr]]:
    """Yield the laws in initial values, each with its place."""
    for symbol in spec.initial:
        yield from ((f"initial.{symbol}", tree) for tree in starts(spec, symbol))
