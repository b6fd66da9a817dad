"""The published system against Kirchhoff's laws, exactly, for banks of 1 to 3 lanes.

Input: a `Spec` and the "system" of ``proofs.json``.  Output: a `Finding`.

A lane of a bank draws the current of its own inductor, a state, from the nodes it shares; so shared
rates have sums over lanes with coefficients that no count is in, and products of two sums at most
(heats).  An identity in which no more than two sums are multiplied, in a row of its own lane or
none, concerns three lanes at once at most: it holds for every count if it does for 1, 2 and 3.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from .field import Field, Ratio, constant
from .laws import KINKED, InputError, Node, num, parse_law, replaced, sym, symbols, walk
from .network import Flows, SingularError, exchange, flows
from .point import derivative
from .spec import Element, Spec

MAX_TEXT, MOST_SUMS, MOST_COUNT, MAX_NAMES = 100_000, 2, 3, 1000
PLAIN = ("sum", "+", "neg", "*", "/", "**", "sym", "num")


@dataclass
class Finding:
    """What a check finds: reasons by subject ("system", "energy"), what letters are in states.

    `divisors` must be nonzero for the network to have one solution.
    """

    reasons: dict[str, str] = field(default_factory=dict)
    divisors: dict[Node, None] = field(default_factory=dict)
    letters: dict[str, Node] = field(default_factory=dict)

    def say(self, subject: str, good: bool, reason: str) -> None:
        """Keep the first reason of a subject."""
        if not good:
            self.reasons.setdefault(subject, reason)


class Published:
    """The published text, parsed; no more sums over lanes are multiplied than can be checked."""

    def __init__(self, spec: Spec, system: Mapping[str, Any]) -> None:
        try:
            self.states = [(s["name"], s["element"], s["bank"]) for s in system["states"]]
            names = system["names"].items()
            self.names = {n: (str(e["element"]), e["role"], e["bank"]) for n, e in names}
            self.laws = {n: parse_law(e["law"], True, MAX_TEXT) for n, e in names}
            self.rates, self.outputs = (
                {n: parse_law(text, True, MAX_TEXT) for n, text in system[table].items()}
                for table in ("rates", "outputs")
            )
            self.energy = parse_law(system["energy"], True, MAX_TEXT)
        except (KeyError, TypeError, AttributeError) as error:
            raise InputError(f"the published system is not complete: {error}") from None
        taken = set(self.names) & {word for word, (role, _) in spec.words.items() if role != "T"}
        if taken or len(self.names) > MAX_NAMES:
            raise InputError("a published name is a symbol of the spec, or there are too many")
        self.order: dict[str, int] = {}
        for tree in (*self.laws.values(), *self.rates.values(), *self.outputs.values()):
            self.sums(tree, 0)

    def sums(self, node: Node, depth: int) -> int:
        """Return how many sums over lanes are multiplied at most."""
        if depth > 50:
            raise InputError("published names are defined by themselves")
        if node.op == "sym":
            if node.value in self.laws and node.value not in self.order:
                self.order[node.value] = self.sums(self.laws[node.value], depth + 1)
            return self.order.get(node.value, 0)
        own = [self.sums(arg, depth) for arg in node.args]
        found = sum(own) if node.op == "*" else max(own, default=0)
        whole = node.op == "**" and node.value > 0 and node.value.denominator == 1
        if node.op in ("/", "**") and own[-1] and not whole:
            raise InputError("a published divisor or root has a sum over lanes")
        found = found * int(node.value) if whole else found + (node.op == "sum")
        if found > MOST_SUMS:
            raise InputError(f"more than {MOST_SUMS} published sums over lanes are multiplied")
        return found if node.op in PLAIN else 0


class Comparison:
    """One comparison, for one size of every bank; the algebra of its network."""

    def __init__(self, spec: Spec, text: Published, count: int, finding: Finding) -> None:
        self.spec, self.text, self.finding, self.one = spec, text, finding, constant(1)
        self.counts = {e.name: count for e in spec.of("hysteron") if e.count is not None}
        self.field, self.known = Field(), dict[Any, Ratio]()

    # What symbols stand for

    def symbol(self, meaning: tuple[str, str], lane: int) -> Ratio:
        """Return the atom of a symbol of the spec, in a lane."""
        role, owner = meaning
        per_lane = owner in (self.spec.lists if role == "p" else self.counts if role in "xE" else ())
        if per_lane and not lane:
            raise InputError(f"{owner!r} is of a lane, and stands outside of lanes")
        return self.field.symbol((role, owner, lane if per_lane else 0))

    def law(self, element: Element, field: str, lane: int, letter: Ratio | None = None) -> Ratio:
        """Return a law of the spec."""
        tree = element.law if field == "law" else element.laws.get(field, element.costate)
        own = letter or constant(0)
        return self.field.of(
            tree or num(0), lambda name: own if name[0] == "z" else self.symbol(name, lane)
        )

    def given(self, role: str, owner: str, lane: int) -> Ratio:
        """Return the atom of an input, a co-state or a temperature."""
        return self.symbol((role, self.spec.elements[owner].input if role == "u" else owner), lane)

    def state(self, element: Element, lane: int) -> Ratio:
        """Return the atom of a co-state or temperature."""
        return self.given("T" if element.kind.form == "body" else "E", element.name, lane)

    def published(self, node: Node, bound: Mapping[str, int]) -> Ratio:
        """Return a published text, its lanes bound."""
        if not any(part.op == "sum" for part in walk(node)):
            return self.field.of(node, lambda name: self.name(name, bound))
        if node.op == "sum":
            if node.value not in self.counts:
                raise InputError(f"{node.value!r} is no bank")
            total = constant(0)
            for lane in range(1, self.counts[node.value] + 1):
                total = total + self.published(node.args[0], {**bound, node.value: lane})
            return total
        if node.op == "if":
            raise InputError("a published choice has a sum over lanes")
        inner = [self.published(arg, bound) for arg in node.args]
        shell = Node(node.op, tuple(sym(n) for n in range(len(inner))), node.value)
        return self.field.of(shell, inner.__getitem__)

    def name(self, name: str, bound: Mapping[str, int]) -> Ratio:
        """Return what a published name stands for."""
        if name not in self.text.names:
            meaning = self.spec.words.get(name, ("T", ""))
            if meaning[0] == "T":
                raise InputError(f"unknown published name {name[:60]!r}")
            own = self.spec.lists.get(meaning[1], "") if meaning[0] == "p" else meaning[1]
            return self.symbol(meaning, bound.get(own, 0))
        bank = self.text.names[name][2]
        lane = bound.get(bank, 0) if bank else 0
        if bank and not lane:
            raise InputError(f"{name!r} is of a lane of {bank!r}, and stands outside of lanes")
        if (name, lane) not in self.known:
            self.known[name, lane] = self._named(name, lane, {bank: lane} if bank else {})
        return self.known[name, lane]

    def _named(self, name: str, lane: int, bound: Mapping[str, int]) -> Ratio:
        """Return a name's law; a co-state or temperature that is the spec's own is an atom."""
        element, role, _ = self.text.names[name]
        found, owner = self.published(self.text.laws[name], bound), self.spec.elements.get(element)
        if role not in ("costate", "temperature") or owner is None or owner.costate is None:
            return found
        same = self.field.is_zero(found - self.law(owner, "costate", lane))
        self.finding.say("system", same, f"{name} is not the law of {element}")
        return self.state(owner, lane)

    # The comparison

    def check(self) -> None:
        """Compare rates and outputs, and close the balances."""
        own = flows(self.spec, self.counts, self)
        self._keep(own)
        power = constant(0)
        for name, y in own.conjugates.items():
            element, given = self.spec.elements[name], self.published(self.text.outputs[name], {})
            self._equal("system", given, y, f"output of {name}")
            ambient = element.kind.form == "ambient"
            power = power + given * (exchange(element, self) if ambient else self.given("u", name, 0))
        for (name, lane), rate in own.rates.items():
            element = self.spec.elements[name]
            given = self.published(self.text.rates[element.state], {name: lane} if lane else {})
            self._equal("system", given, rate, f"rate of {element.state}")
            power = power - self.state(element, lane) * given
        self._equal("energy", power, constant(0), "dU/dt - y^T u")
        self._gradient()

    def _equal(self, subject: str, given: Ratio, own: Ratio, what: str) -> None:
        same = self.field.is_zero(given - own)
        self.finding.say(subject, same, f"{what} is not that of the network")

    def _keep(self, own: Flows) -> None:
        """Keep what must be nonzero, and what letters are in terms of states and inputs."""
        determinant = constant(1)
        for pivot in own.pivots:
            determinant = determinant * pivot
        for tree in self.field.factors(determinant):
            spelled = replaced(tree, lambda key: sym(key if key[2] else key[:2]))
            self.finding.divisors[spelled] = None
        for (name, _), form in own.forms.items():
            terms = [self._term(name, label, factor) for label, factor in form.items()]
            known = tuple(term for term in terms if term)
            if known and len(known) == len(terms):
                self.finding.letters[name] = Node("+", known)

    def _term(self, name: str, label: Any, factor: Ratio) -> Node | None:
        """Return a term of a letter as a tree, if it is one of its own lane."""
        source = self.spec.elements[label[1]]
        foreign = source.count is not None and source.name != name
        if label[0] == "W" or foreign or factor.number is None:
            return None
        of = sym(("u", source.input)) if label[0] == "u" else source.costate or num(0)
        return Node("*", (num(factor.number), of))

    def _gradient(self) -> None:
        """Compare dU/dx with the co-states; a choice in U may be of parameters alone."""
        energy = self.text.energy
        for name in self.spec.states.values():
            element, symbol, total = self.spec.elements[name], self.spec.elements[name].state, constant(0)
            for term in energy.args if energy.op == "+" else (energy,):
                inner = term.args[0] if term.op == "sum" else term
                for part in walk(inner):
                    chooser = part.args[0] if part.op == "if" else part
                    moving = part.op in (*KINKED, "if") and set(symbols(chooser)) & set(self.spec.states)
                    if part.op == "sum" or moving:
                        raise InputError("the energy has choices of states, or sums in products")
                if symbol in symbols(inner):
                    bound = {term.value: 1} if term.op == "sum" else {}
                    total = total + self.published(derivative(inner, symbol), bound)
            own = self.law(element, "costate", 1 if name in self.counts else 0)
            self._equal("energy", total, own, f"dU/d{symbol}")


def check_system(spec: Spec, system: Mapping[str, Any]) -> Finding:
    """Return what is found of a published system."""
    finding = Finding()
    try:
        text = Published(spec, system)
        banks = {e.name for e in spec.of("hysteron") if e.count is not None}
        expected = [(s, name, name if name in banks else None) for s, name in spec.states.items()]
        ports = {e.name for e in spec.of("source", "ambient")}
        finding.say("system", text.states == expected, "the states are not those of the spec")
        finding.say("system", set(text.rates) == set(spec.states), "rates are not those of states")
        finding.say("system", set(text.outputs) == ports, "outputs are not those of ports")
        for count in range(1, MOST_COUNT + 1 if banks else 2):
            if not finding.reasons:
                Comparison(spec, text, count, finding).check()
    except (InputError, SingularError, RecursionError) as error:
        finding.say("system", False, str(error))
    return finding
