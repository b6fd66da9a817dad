"""What several stages read from the tables of a spec.

Input: the tables of a spec.  Output: its states, banks, bodies,
laws and conditions, in declaration order.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import final

from piezo_sym.expressions.calculus import increasing, mul
from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.parse import parse_condition, parse_law
from piezo_sym.expressions.text import SPEC, write_comparison
from piezo_sym.expressions.tree import ZERO, Call, Cmp, Expr, Node, Num, names, rename, walk
from piezo_sym.spec.elements.base import state_symbol
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
    return {s.symbol: name for name, e in spec.elements.items() for s in e.own_states(name)}


def starts(spec: Tables, symbol: str) -> tuple[Expr, ...]:
    """Return the initial value of a state, one or one per lane where lanes differ.

    A state that is the sum of those of alike stores starts at the sum of their initial values.
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
    found = ((name, e.bank_of(name)) for name, e in spec.elements.items())
    return {name: bank for name, bank in found if bank is not None}


def bank_states(spec: Tables) -> dict[str, str]:
    """Return the bank of each state that has a value per lane."""
    owners = bank_of(spec)
    return {s: owners[name] for s, name in states(spec).items() if name in owners}


def banks(spec: Tables) -> dict[str, int]:
    """Return the size of each bank."""
    return {bank: spec.elements[name].count for name, bank in bank_of(spec).items()}


def temperatures(spec: Tables) -> dict[str, str]:
    """Return the body of each temperature symbol: ``T`` of the only one, else ``T_<element>``.

    Where something else of the spec is called T, it is ``T_<element>``, too.
    """
    found = bodies(spec)
    single = len(found) == 1 and "T" not in {*spec.parameters, *spec.inputs, *states(spec)}
    return {"T": found[0]} if single else {f"T_{name}": name for name in found}


def seen(spec: Tables) -> Iterator[str]:
    """Yield the names that a law may use that sees more than its own state.

    These are states, but for those of banks, which only laws in the same lane see, and
    ``T_<element>``.
    """
    lanes = bank_states(spec)
    yield from (symbol for symbol in states(spec) if symbol not in lanes)
    yield from (f"T_{body}" for body in bodies(spec))


def in_words(spec: Tables, law: LawField, hot: Mapping[str, str]) -> Expr:
    """Return a law in the words of [domain], `hot` being the temperature symbol of each body.

    A dissipative law keeps its letter.
    """
    return rename(law.tree, meanings(spec, law, hot))


def meanings(spec: Tables, law: LawField, hot: Mapping[str, str]) -> dict[str, str]:
    """Return what names in a law are called in [domain], if they are called differently there."""
    element = spec.elements[law.element]
    named = [hot[given] for _, given in element.named("thermal_mass")]
    named = named or list(hot.values())[: len(hot) == 1]
    found = dict(zip(("T_1", "T_2"), named, strict=False)) | dict(zip("T", named, strict=False))
    if element.letter:
        found[element.letter] = state_symbol(element, law.element)
    if hasattr(element, "input"):
        found["T_e"] = element.input
    found = {letter: word for letter, word in found.items() if letter in law.letters}
    return (_by_body(law.tree, hot) if law.mark.sees else {}) | found


def _by_body(node: Node, hot: Mapping[str, str]) -> dict[str, str]:
    """Return what [domain] calls the temperatures in a tree that go by their bodies."""
    return {n: hot[n[2:]] for n in names(node) if n.startswith("T_") and n[2:] in hot}


def conditions(spec: Tables) -> tuple[Condition, ...]:
    """Return the domain: what the spec assumes, then what its kinds and half widths need."""
    hot, assumed = {body: word for word, body in temperatures(spec).items()}, list[Condition]()
    for n, text in enumerate(spec.domain.assume):
        tree = parse_condition(text, where := f"domain.assume[{n}]")
        left, right = (rename(side, _by_body(side, hot)) for side in (tree.left, tree.right))
        assumed.append(Condition(where, Cmp(tree.op, left, right)))
    found: dict[Cmp, Condition] = {}
    needed = [
        Condition(f"elements.{name}", need)
        for name, element in spec.elements.items()
        for need in element.row.form.requires(element, name)
    ]
    for condition in [*assumed, *needed, *_not_negative(spec, hot, assumed)]:
        found.setdefault(condition.tree, condition)
    return tuple(found.values())


def _not_negative(
    spec: Tables, hot: Mapping[str, str], assumed: list[Condition]
) -> Iterator[Condition]:
    """Yield that each half width is >= 0, in laws, assumptions and initial values."""
    for law in laws(spec):
        yield from (Condition(law.where, width) for width in _widths(in_words(spec, law, hot)))
    for where, node in [*((c.where, c.tree) for c in assumed), *initial_laws(spec)]:
        yield from (Condition(where, width) for width in _widths(node))


def _widths(law: Node) -> Iterator[Cmp]:
    """Yield that each half width in a law is >= 0, except for numbers that are."""
    for node in walk(law):
        if isinstance(node, Call) and RECORDS[node.function].width:
            width = node.args[1]
            if not (isinstance(width, Num) and width.value >= 0):
                yield Cmp(">=", width, ZERO)


def orders(spec: Tables) -> Iterator[Condition]:
    """Yield that the knots of each table increase, wherever it stands in the spec."""
    parts: list[LawField | Condition] = [*laws(spec), *conditions(spec)]
    places = [*((part.where, part.tree) for part in parts), *initial_laws(spec)]
    found = (Condition(where, order) for where, tree in places for order in increasing(tree))
    yield from dict.fromkeys(found)


def greater(condition: Cmp) -> Cmp:
    """Return a comparison with > or >=; the sides of one with < or <= are swapped."""
    turned = {"<": ">", "<=": ">="}
    if condition.op not in turned:
        return condition
    return Cmp(turned[condition.op], condition.right, condition.left)


def condition_text(condition: Cmp) -> str:
    """Return a condition as a reader would write it."""
    return write_comparison(condition, SPEC)


def lane_parameters(spec: Tables) -> dict[str, str]:
    """Return the bank of each parameter that only this bank uses: it may have a value per lane."""
    users: dict[str, set[str | None]] = {}
    owners, lanes = bank_of(spec), bank_states(spec)
    for law in laws(spec):
        for word in set(names(law.tree)) - set(law.letters):
            users.setdefault(word, set()).add(owners.get(law.element))
    for where, tree in initial_laws(spec):
        for word in names(tree):
            users.setdefault(word, set()).add(lanes.get(where.removeprefix("initial.")))
    single = {word: next(iter(found)) for word, found in users.items() if len(found) == 1}
    own = {word: bank for word in spec.parameters if (bank := single.get(word))}
    lanes |= own
    groups = [names(condition.tree) for condition in conditions(spec)]
    mixed = {n for g in groups if len({lanes[n] for n in g if n in lanes}) > 1 for n in g}
    return {word: bank for word, bank in own.items() if word not in mixed}


def initial_laws(spec: Tables) -> Iterator[tuple[str, Expr]]:
    """Yield the laws in initial values, each with its place."""
    for symbol in spec.initial:
        yield from ((f"initial.{symbol}", tree) for tree in starts(spec, symbol))
