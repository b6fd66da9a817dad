"""The published system against Kirchhoff's laws, exactly, for banks of 1 to 3 lanes.

Input: a `Spec` and the "system" of ``proofs.json``.  Output: a `Finding`.  A lane of a bank draws
the current of its own inductor, a state, from the nodes it shares; so shared rates have sums over
lanes with coefficients that no count is in, and products of two sums at most (heats).  An identity
in which no more than two sums are multiplied, in a row of its own lane or none, concerns three
lanes at once at most: it holds for every count if it does for 1, 2 and 3.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

from . import laws
from .field import Field, Ratio, constant
from .laws import KINKS, InputError, Node, need, num, parse, put, sym, symbols, walk
from .network import Flows, SingularError, exchange, flows
from .spec import Element, Spec

MAX_TEXT, MOST_SUMS, MOST_COUNT, MAX_NAMES, MAX_CHAIN = 100_000, 2, 3, 1000, 50


class Finding(NamedTuple):
    """Reasons by subject ("system", "energy"), what must not be zero, letters by states."""

    reasons: dict[str, str]
    divisors: dict[Node, None]
    letters: dict[str, Node]


class _Published:
    """The published text, parsed; no more sums over lanes are multiplied than can be checked."""

    def __init__(self, spec: Spec, system: Mapping[str, Any]) -> None:
        self.states = [(s["name"], s["element"], s["bank"]) for s in system["states"]]
        self.names = {n: (e["element"], e["role"], e["bank"]) for n, e in system["names"].items()}
        self.energy, self.order = parse(system["energy"], MAX_TEXT, False), dict[str, int]()
        texts = (
            {n: e["law"] for n, e in system["names"].items()},
            system["rates"],
            system["outputs"],
        )
        self.laws, self.rates, self.outputs = (
            {name: parse(text, MAX_TEXT, False) for name, text in table.items()} for table in texts
        )
        free = not any(n in spec.words and spec.words[n][0] != "T" for n in self.names)
        need(free and len(self.names) <= MAX_NAMES, "a published name is taken, or too many are")
        for table in (self.laws, self.rates, self.outputs):
            for tree in table.values():
                self.sums(tree, 0)

    def sums(self, node: Node, depth: int) -> int:
        """Return how many sums over lanes are multiplied at most."""
        need(depth <= MAX_CHAIN, "published names are defined by themselves")
        if node.op == "sym":
            if node.value in self.laws and node.value not in self.order:
                self.order[node.value] = self.sums(self.laws[node.value], depth + 1)
            return self.order.get(node.value, 0)
        own = [self.sums(arg, depth) for arg in node.args]
        power = node.value if node.op == "**" else 1
        found = sum(own) if node.op == "*" else max(own, default=0) + (node.op == "sum")
        if node.op == "if":
            found = own[0] + max(own[1:])
        elif node.op in KINKS:
            found *= 2
        whole = node.op not in ("/", "**") or (power > 0 and power.denominator == 1 and not own[1:])
        need(whole or not own[-1], "a published divisor or root has a sum over lanes")
        need(found * power <= MOST_SUMS, f"more than {MOST_SUMS} published sums are multiplied")
        return int(found * power)


class _Comparison:
    """One comparison, for one size of every bank; the algebra of its network."""

    def __init__(self, spec: Spec, text: _Published, count: int, finding: Finding) -> None:
        self.spec, self.text, self.finding, self.one = spec, text, finding, constant(1)
        self.counts = {e.name: count for e in spec.of("hysteron") if e.lanes is not None}
        self.field, self.known = Field(), dict[Any, Ratio]()

    def symbol(self, meaning: tuple[str, str], lane: int) -> Ratio:
        role, owner = meaning
        per_lane = owner in (
            self.spec.lists if role == "p" else self.counts if role in "xE" else ()
        )
        need(lane > 0 or not per_lane, f"{owner!r} is of a lane, and stands outside of lanes")
        return self.field.of(sym((role, owner, lane if per_lane else 0)))

    def law(self, element: Element, field: str, lane: int, letter: Ratio | None = None) -> Ratio:
        tree = element.law if field == "law" else element.laws.get(field, element.costate)

        def word(name: tuple[str, str]) -> Ratio:
            return letter if letter and name[0] == "z" else self.symbol(name, lane)

        return self.field.of(tree or num(0), word)

    def given(self, role: str, owner: str, lane: int) -> Ratio:
        return self.symbol((role, self.spec.elements[owner].input if role == "u" else owner), lane)

    def published(self, node: Node, bound: Mapping[str, int]) -> Ratio:
        """Return a published text, its lanes bound."""
        if not any(part.op == "sum" for part in walk(node)):
            return self.field.of(node, lambda name: self.name(name, bound))
        need(node.op != "if", "a published choice has a sum over lanes")
        if node.op == "sum":
            need(node.value in self.counts, f"{node.value!r} is no bank")
            lanes = range(1, self.counts[node.value] + 1)
            terms = (self.published(node.args[0], {**bound, node.value: lane}) for lane in lanes)
            return sum(terms, constant(0))
        inner = [self.published(arg, bound) for arg in node.args]
        shell = Node(node.op, tuple(sym(n) for n in range(len(inner))), node.value)
        return self.field.of(shell, inner.__getitem__)

    def name(self, name: str, bound: Mapping[str, int]) -> Ratio:
        """Return what a published name stands for: a co-state for itself, once it is compared."""
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
                found = self.given("T" if store.kind.form == "body" else "E", store.name, lane)
            self.known[name, lane] = found
        return self.known[name, lane]

    def check(self) -> None:
        """Compare rates and outputs, and close the balances."""
        own, power = flows(self.spec, self.counts, self), constant(0)
        self._keep(own)
        for name, y in own.conjugates.items():
            element, given = self.spec.elements[name], self.published(self.text.outputs[name], {})
            self._equal("system", given, y, f"output of {name}")
            ambient = element.kind.form == "ambient"
            power += given * (exchange(element, self) if ambient else self.given("u", name, 0))
        for (name, lane), rate in own.rates.items():
            element = self.spec.elements[name]
            given = self.published(self.text.rates[element.state], {name: lane} if lane else {})
            self._equal("system", given, rate, f"rate of {element.state}")
            power -= self.given("T" if element.kind.form == "body" else "E", name, lane) * given
        self._equal("energy", power, constant(0), "dU/dt - y^T u")
        self._gradient()

    def _equal(self, subject: str, given: Ratio, own: Ratio, what: str) -> None:
        if not self.field.is_zero(given - own):
            self.finding.reasons.setdefault(subject, f"{what} is not that of the network")

    def _keep(self, own: Flows) -> None:

        elements, lists = self.spec.elements, self.spec.lists
        for pivot in own.pivots:
            tree = self.field.tree(pivot).args[0]
            words = {key: sym(key if key[-1] else key[:2]) for key in symbols(tree)}
            self.finding.divisors[put(tree, words)] = None
        for (name, lane), letter in own.letters.items():
            tree, lanes = self.field.tree(letter), {name: lane}
            costates = {k: elements[k[1]].costate for k in symbols(tree) if k[0] == "E"}
            words = {k: costates.get(k) or sym(k[:2]) for k in symbols(tree)}
            self.finding.letters.pop(name, None)
            if all(k[2:] in ((), (0,), (lanes.get(lists.get(k[1], k[1])),)) for k in words):
                self.finding.letters[name] = put(tree, words)

    def _gradient(self) -> None:
        energy, states = self.text.energy, self.spec.states
        terms = [
            (term.args[0], {term.value: 1}) if term.op == "sum" else (term, {})
            for term in (energy.args if energy.op == "+" else (energy,))
        ]
        for term, bound in terms:
            for role, owner in (self.spec.words.get(name, ("", "")) for name in symbols(term)):
                need(role in ("p", "x"), "the energy has other names than states and parameters")
                need(role == "p" or not bound or owner in bound, "a bank's energy has other states")
        for part in (part for term, _ in terms for part in walk(term)):
            chooser = part.args[0] if part.op == "if" else part
            moves = part.op in ("if", *KINKS) and any(s in states for s in symbols(chooser))
            need(part.op != "sum" and not moves, "the energy has choices of states")
        for state, name in states.items():
            slopes = [
                self.published(laws.derivative(term, state), bound)
                for term, bound in terms
                if state in symbols(term)
            ]
            own = self.law(self.spec.elements[name], "costate", int(name in self.counts))
            self._equal("energy", sum(slopes, constant(0)), own, f"dU/d{state}")


def check_system(spec: Spec, system: Any) -> Finding:
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
    except (KeyError, TypeError, AttributeError) as error:
        finding.reasons.setdefault("system", f"the published system is not complete: {error}")
    return finding
