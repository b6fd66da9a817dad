"""The published system against Kirchhoff's laws, exactly, for banks of 1 to 3 lanes.

Input: a `Spec` and the "system" of ``proofs.json``.  Output: a `Finding`.

A lane of a bank draws the current of its own inductor, a state, from the nodes it shares; so shared
rates have sums over lanes with coefficients that no count is in, and products of two sums at most
(heats).  An identity in which no more than two sums are multiplied, in a row of its own lane or
none, concerns three lanes at once at most: it holds for every count if it does for 1, 2 and 3.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

from . import laws
from .field import Field, Ratio, constant
from .laws import KINKS, InputError, Node, need, num, parse, sym, symbols, walk
from .network import Flows, SingularError, exchange, flows
from .spec import Element, Spec

MAX_TEXT, MOST_SUMS, MOST_COUNT, MAX_NAMES, MAX_CHAIN = 100_000, 2, 3, 1000, 50
PLAIN = ("sum", "+", "neg", "*", "/", "**", "sym")


class Finding(NamedTuple):
    """What a check finds: reasons by subject ("system", "energy"), what letters are in states.

    `divisors` must be nonzero for the network to have one solution.
    """

    reasons: dict[str, str]
    divisors: dict[Node, None]
    letters: dict[str, Node]


class _Published:
    """The published text, parsed; no more sums over lanes are multiplied than can be checked."""

    def __init__(self, spec: Spec, system: Mapping[str, Any]) -> None:
        try:
            self.states = [(s["name"], s["element"], s["bank"]) for s in system["states"]]
            names = system["names"].items()
            self.names = {n: (str(e["element"]), e["role"], e["bank"]) for n, e in names}
            self.laws = {n: parse(e["law"], MAX_TEXT, False) for n, e in names}
            self.rates, self.outputs = (
                {n: parse(text, MAX_TEXT, False) for n, text in system[table].items()}
                for table in ("rates", "outputs")
            )
            self.energy = parse(system["energy"], MAX_TEXT, False)
        except (KeyError, TypeError, AttributeError) as error:
            raise InputError(f"the published system is not complete: {error}") from None
        free = not any(n in spec.words and spec.words[n][0] != "T" for n in self.names)
        need(free and len(self.names) <= MAX_NAMES, "a published name is taken, or too many are")
        self.order: dict[str, int] = {}
        for tree in (*self.laws.values(), *self.rates.values(), *self.outputs.values()):
            self.sums(tree, 0)

    def sums(self, node: Node, depth: int) -> int:
        """Return how many sums over lanes are multiplied at most."""
        need(depth <= MAX_CHAIN, "published names are defined by themselves")
        if node.op == "sym":
            if node.value in self.laws and node.value not in self.order:
                self.order[node.value] = self.sums(self.laws[node.value], depth + 1)
            return self.order.get(node.value, 0)
        own = [self.sums(arg, depth) for arg in node.args]
        found = sum(own) if node.op == "*" else max(own, default=0) + (node.op == "sum")
        whole = node.op == "**" and node.value > 0 and node.value.denominator == 1
        found = found * int(node.value) if whole else found
        plain = whole or node.op not in ("/", "**") or not own[-1]
        need(plain, "a published divisor or root has a sum over lanes")
        need(found <= MOST_SUMS, f"more than {MOST_SUMS} published sums over lanes are multiplied")
        return found if node.op in PLAIN else 0


class _Comparison:
    """One comparison, for one size of every bank; the algebra of its network."""

    def __init__(self, spec: Spec, text: _Published, count: int, finding: Finding) -> None:
        self.spec, self.text, self.finding, self.one = spec, text, finding, constant(1)
        self.counts = {e.name: count for e in spec.of("hysteron") if e.lanes is not None}
        self.field, self.known = Field(), dict[Any, Ratio]()

    # What symbols stand for

    def symbol(self, meaning: tuple[str, str], lane: int) -> Ratio:
        role, owner = meaning
        lists = {"p": self.spec.lists, "x": self.counts, "E": self.counts}
        per_lane = owner in lists.get(role, ())
        need(lane > 0 or not per_lane, f"{owner!r} is of a lane, and stands outside of lanes")
        return self.field.symbol((role, owner, lane if per_lane else 0))

    def law(self, element: Element, field: str, lane: int, letter: Ratio | None = None) -> Ratio:
        tree = element.law if field == "law" else element.laws.get(field, element.costate)

        def word(name: tuple[str, str]) -> Ratio:
            return letter if letter and name[0] == "z" else self.symbol(name, lane)

        return self.field.of(tree or num(0), word)

    def given(self, role: str, owner: str, lane: int) -> Ratio:
        return self.symbol((role, self.spec.elements[owner].input if role == "u" else owner), lane)

    def state(self, element: Element, lane: int) -> Ratio:
        return self.given("T" if element.kind.form == "body" else "E", element.name, lane)

    def published(self, node: Node, bound: Mapping[str, int]) -> Ratio:
        """Return a published text, its lanes bound."""
        if not any(part.op == "sum" for part in walk(node)):
            return self.field.of(node, lambda name: self.name(name, bound))
        need(node.op != "if", "a published choice has a sum over lanes")
        if node.op == "sum":
            need(node.value in self.counts, f"{node.value!r} is no bank")
            rows = range(1, self.counts[node.value] + 1)
            terms = (self.published(node.args[0], {**bound, node.value: lane}) for lane in rows)
            return sum(terms, constant(0))
        inner = [self.published(arg, bound) for arg in node.args]
        shell = Node(node.op, tuple(sym(n) for n in range(len(inner))), node.value)
        return self.field.of(shell, inner.__getitem__)

    def name(self, name: str, bound: Mapping[str, int]) -> Ratio:
        """Return what a published name stands for."""
        if name not in self.text.names:
            role, owner = self.spec.words.get(name, ("T", ""))
            need(role != "T", f"unknown published name {name[:60]!r}")
            bank = self.spec.lists.get(owner, "") if role == "p" else owner
            return self.symbol((role, owner), bound.get(bank, 0))
        element, role, bank = self.text.names[name]
        lane = bound.get(bank, 0) if bank else 0
        need(lane > 0 or not bank, f"{name!r} is of a lane, and stands outside of lanes")
        if (name, lane) not in self.known:
            found = self.published(self.text.laws[name], {bank: lane} if bank else {})
            store = self.spec.elements.get(element)
            if role in ("costate", "temperature") and store is not None and store.costate:
                self._equal("system", found, self.law(store, "costate", lane), name)
                found = self.state(store, lane)
            self.known[name, lane] = found
        return self.known[name, lane]

    # The comparison

    def check(self) -> None:
        """Compare rates and outputs, and close the balances."""
        own, power = flows(self.spec, self.counts, self), constant(0)
        self._keep(own)
        for name, y in own.conjugates.items():
            element, given = self.spec.elements[name], self.published(self.text.outputs[name], {})
            self._equal("system", given, y, f"output of {name}")
            ambient = element.kind.form == "ambient"
            u = exchange(element, self) if ambient else self.given("u", name, 0)
            power = power + given * u
        for (name, lane), rate in own.rates.items():
            element = self.spec.elements[name]
            given = self.published(self.text.rates[element.state], {name: lane} if lane else {})
            self._equal("system", given, rate, f"rate of {element.state}")
            power = power - self.state(element, lane) * given
        self._equal("energy", power, constant(0), "dU/dt - y^T u")
        self._gradient()

    def _equal(self, subject: str, given: Ratio, own: Ratio, what: str) -> None:
        if not self.field.is_zero(given - own):
            self.finding.reasons.setdefault(subject, f"{what} is not that of the network")

    def _keep(self, own: Flows) -> None:
        """Keep what must be nonzero, and what letters are in terms of states and inputs."""
        determinant = constant(1)
        for pivot in own.pivots:
            determinant = determinant * pivot
        for tree in self.field.factors(determinant):
            spelled = laws.replaced(tree, lambda key: sym(key if key[-1] else key[:2]))
            self.finding.divisors[spelled] = None
        for (name, _), form in own.forms.items():
            terms = [self._term(name, *term) for term in form.items()]
            if all(terms):
                self.finding.letters[name] = Node("+", (num(0), *filter(None, terms)))

    def _term(self, name: str, label: Any, factor: Ratio) -> Node | None:
        """Return a term of a letter as a tree, if it is one of its own lane."""
        source = self.spec.elements[label[1]]
        foreign = source.lanes is not None and source.name != name
        if label[0] == "W" or foreign or factor.number is None:
            return None
        of = sym(("u", source.input)) if label[0] == "u" else source.costate or num(0)
        return Node("*", (num(factor.number), of))

    def _gradient(self) -> None:
        """Compare dU/dx with the co-states; a choice in U may be of parameters alone."""
        energy, states = self.text.energy, self.spec.states
        for term in energy.args if energy.op == "+" else (energy,):
            for part in walk(term.args[0] if term.op == "sum" else term):
                chooser = part.args[0] if part.op == "if" else part
                moves = part.op in ("if", *KINKS) and any(s in states for s in symbols(chooser))
                need(part.op != "sum" and not moves, "the energy has choices of states")
        for state, name in states.items():
            total = constant(0)
            for term in energy.args if energy.op == "+" else (energy,):
                inner = term.args[0] if term.op == "sum" else term
                bound = {term.value: 1} if term.op == "sum" else {}
                if state in symbols(inner):
                    total = total + self.published(laws.derivative(inner, state), bound)
            own = self.law(self.spec.elements[name], "costate", 1 if name in self.counts else 0)
            self._equal("energy", total, own, f"dU/d{state}")


def check_system(spec: Spec, system: Mapping[str, Any]) -> Finding:
    """Return what is found of a published system."""
    finding, banks = Finding({}, {}, {}), {e.name for e in spec.elements.values() if e.lanes}
    try:
        text = _Published(spec, system)
        expected = [(s, name, name if name in banks else None) for s, name in spec.states.items()]
        ports = {e.name for e in spec.of("source", "ambient")}
        tables = set(text.rates) == set(spec.states) and set(text.outputs) == ports
        need(text.states == expected and tables, "states or ports are not those of the spec")
        for count in range(1, MOST_COUNT + 1 if banks else 2):
            if not finding.reasons:
                _Comparison(spec, text, count, finding).check()
    except (InputError, SingularError, RecursionError) as error:
        finding.reasons.setdefault("system", str(error))
    return finding
