"""The published system against Kirchhoff's laws, exactly, for banks of any number of lanes.

Input: a `Spec` and the "system" of ``proofs.json``.  Output: a `Finding`.  A lane of a bank draws
the current of its own inductor, a state, from shared nodes; so shared rates have sums over lanes
with coefficients free of counts, and products of at most two sums (heats).  An identity with at
most two sums in a product, in the row of one lane or of none, involves at most three lanes.  So a
bank has three lanes here, each with a symbol for the number of lanes like it: then sums, and
functions of sums, are equal only if they are equal for all counts.
"""

from collections.abc import Mapping
from operator import mul
from typing import Any

from . import laws
from .field import ONE, ZERO, Field, Ratio
from .functions import KINKS
from .laws import InputError, Node, build, need, num, parse, subs, sym, symbols, walk
from .network import Flows, SingularError, Slot, flows
from .parts import stem
from .prover import Claim, partial
from .spec import Element, Spec

MAX_TEXT, MOST_SUMS, LANES, MAX_NAMES, MAX_CHAIN = 100_000, 2, 3, 1000, 50


class _Published:
    """The published text, parsed; raises if more sums are multiplied than can be checked."""

    def __init__(self, spec: Spec, system: Mapping[str, Any]) -> None:
        self.states = [(s["name"], s["element"], s["bank"]) for s in system["states"]]
        self.names = {n: (e["element"], e["role"], e["bank"]) for n, e in system["names"].items()}
        self.energy, self.order = parse(system["energy"], MAX_TEXT, False), dict[str, int]()
        named = {name: entry["law"] for name, entry in system["names"].items()}
        self.laws, self.rates, self.outputs = (
            {name: parse(text, MAX_TEXT, False) for name, text in table.items()}
            for table in (named, system["rates"], system["outputs"])
        )
        free = not any(n in spec.words and spec.words[n][0] != "T" for n in self.names)
        need(free and len(self.names) <= MAX_NAMES, "a published name is taken, or too many are")
        for table in (self.laws, self.rates, self.outputs, {"": self.energy}):
            for tree in table.values():
                self.sums(tree, 0)
        owners = [(s, name, spec.elements[name].lanes) for s, name in spec.states.items()]
        expected = [(s, stem(name), own[0] if own else None) for s, name, own in owners]
        ports = {e.name for e in spec.of("source", "ambient", "heat")}
        tables = set(self.rates) == set(spec.states) and set(self.outputs) == ports
        need(self.states == expected and tables, "states or ports are not those of the spec")

    def sums(self, node: Node, depth: int) -> int:
        """Return the largest number of sums over lanes in a product."""
        need(depth <= MAX_CHAIN, "published names are defined by themselves")
        if node.op == "sym":
            if node.value in self.laws and node.value not in self.order:
                self.order[node.value] = self.sums(self.laws[node.value], depth + 1)
            return self.order.get(node.value, 0)
        own = [self.sums(arg, depth) for arg in node.args]
        power = node.value if node.op == "**" else 1
        found = sum(own) if node.op == "*" else max(own, default=0) + (node.op == "sum")
        if node.op == "if":
            need(all(n.op != "sum" for n in walk(node)), "a published choice has a sum over lanes")
            found = own[0] + max(own[1:])
        elif node.op in KINKS:
            found *= 2
        plain = node.op not in ("/", "**") or (power > 0 and power.denominator == 1 and not own[1:])
        need(plain or not own[-1], "a published divisor or root has a sum over lanes")
        need(found * power <= MOST_SUMS, f"more than {MOST_SUMS} published sums are multiplied")
        return int(found * power)


class Finding:
    """The comparison of a published system with the laws of its network.

    `reasons` says why a subject ("system", "energy") differs; `divisors` must not be zero; `values`
    are claims under which the energy, the sum of `terms`, has a value; `letters` are functions of
    states; `branched` has, by subject and name, differences to compare by branches, and states.
    """

    def __init__(self, spec: Spec, system: Any) -> None:
        self.spec, self.one, self.reasons = spec, ONE, dict[str, str]()
        self.divisors, self.letters = dict[Node, None](), dict[str, Node]()
        self.banks = {e.name: e.lanes[0] for e in spec.elements.values() if e.lanes}
        self.counts = dict.fromkeys(self.banks.values(), LANES)
        self.field, self.known, self.values = Field(), dict[Any, Ratio](), list[Claim]()
        self.terms, self.branched = list[Node](), dict[tuple[str, str], tuple[Node, Any]]()
        try:
            self.text = _Published(spec, system)
            self._check()
        except (InputError, SingularError, RecursionError) as error:
            self.reasons.setdefault("system", str(error))
        except (KeyError, TypeError, AttributeError) as error:
            self.reasons.setdefault("system", f"the published system is not complete: {error}")

    def symbol(self, meaning: tuple[str, str], lane: int) -> Ratio:
        """Return the atom of a symbol, with its lane if it has one."""
        role, owner = meaning
        banks = {"p": self.spec.lists, "x": self.banks, "E": self.banks}.get(role, ())
        need(lane > 0 or owner not in banks, f"{owner!r} is of a lane, and stands outside of lanes")
        return self.field.of(sym((role, owner, lane) if owner in banks else (role, owner)))

    def law(self, element: Element, field: str, lane: int, *letters: Ratio) -> Ratio:
        """Return a law of an element for values of its letter and, of a slip, its rate."""
        tree = element.law if field == "law" else element.laws.get(field, element.costate)
        own = dict(zip((("z", element.name), ("r", element.name)), letters, strict=False))

        def word(node: Node) -> Ratio:
            return own.get(node.value) or self.symbol(node.value, lane)

        return self.field.of(tree or num(0), word)

    def weight(self, slot: Slot) -> Ratio:
        """Return the symbol of the number of lanes like this one; 1 outside of banks."""
        bank = self.banks.get(slot[0], slot[0])
        return self.field.of(sym(("N", bank, slot[1]))) if slot[1] else ONE

    def given(self, role: str, owner: str, lane: int) -> Ratio:
        """Return the input, co-state or temperature (`role` u, E or T) of an element."""
        return self.symbol((role, self.spec.elements[owner].input if role == "u" else owner), lane)

    def published(self, node: Node, bound: Mapping[str, int]) -> Ratio:
        """Return the normal form of a published text; `bound` is the lane of each bank."""
        return self.field.of(node, lambda part: self.word(part, bound))

    def word(self, node: Node, bound: Mapping[str, int]) -> Ratio:
        """Return the normal form of a sum over lanes, or of a published name."""
        name = node.value
        if node.op == "sum":
            need(name in self.counts, f"{name!r} is no bank")
            lanes = range(1, self.counts[name] + 1)
            own = (self.published(node.args[0], {**bound, name: lane}) for lane in lanes)
            return sum(map(mul, [self.weight((name, lane)) for lane in lanes], own), ZERO)
        if name in self.text.names:
            bank = self.text.names[name][2]
            lane = bound.get(bank, 0)
            need(lane > 0 or not bank, f"{name!r} is of a lane, and stands outside of lanes")
            if (name, lane) not in self.known:
                self.known[name, lane] = self._named(name, lane)
            return self.known[name, lane]
        role, owner = self.spec.words.get(name, ("T", ""))
        need(role != "T", f"unknown published name {name[:60]!r}")
        bank = (self.spec.lists if role == "p" else self.banks).get(owner, "")
        return self.symbol((role, owner), bound.get(bank, 0))

    def _named(self, name: str, lane: int) -> Ratio:
        """Return the normal form of a name's law; a co-state is compared, and is a symbol."""
        owner, role, bank = self.text.names[name]
        found = self.published(self.text.laws[name], {bank: lane} if bank else {})
        stores = [e for e in self.spec.elements.values() if stem(e.name) == owner and e.costate]
        if role not in ("costate", "temperature") or not stores:
            return found
        same = (e for e in stores if self.field.is_zero(found - self.law(e, "costate", lane)))
        store = next(same, stores[0])
        self._equal("system", found, self.law(store, "costate", lane), name)
        return self._costate(store, lane)

    def _costate(self, store: Element, lane: int) -> Ratio:
        return self.symbol(("T" if store.kind.form == "body" else "E", store.name), lane)

    def _check(self) -> None:
        """Compare rates and outputs, and check the power balance and the gradient."""
        own, power = flows(self.spec, self.counts, self), ZERO
        self._keep(own)
        for name, (y, inflow) in own.ports.items():
            given = self.published(self.text.outputs[name], {})
            self._equal("system", given, y, f"output of {name}")
            power += y * inflow  # the published ones are shown to be equal
        for (name, lane), rate in own.rates.items():
            element = self.spec.elements[name]
            given = self.published(self.text.rates[element.state], {self.banks.get(name, ""): lane})
            self._equal("system", given, rate, f"rate of {element.state}")
            power -= self.weight((name, lane)) * self._costate(element, lane) * rate
        self._equal("energy", power, ZERO, "dU/dt - y^T u")
        self._gradient()

    def _equal(self, subject: str, given: Ratio, own: Ratio, what: str, slope: Any = ()) -> None:
        """Compare two expressions; if they may still agree branch by branch, keep the difference.

        `slope`, if given, is that difference as a tree in symbols of the spec, and the state.
        """
        if self.field.is_zero(given - own):
            return
        tree, *states = slope or (_without_lane(self.field.tree(given - own)),)
        ops = {part.op for part in walk(tree) if part.op != "**" or part.value.denominator > 1}
        if "sum" in ops or not ops & {"if", "**", *KINKS} or any(k[2:] for k in symbols(tree)):
            self.reasons.setdefault(subject, f"{what} is not that of the network")
        else:
            self.branched[subject, what] = tree, states

    def _keep(self, own: Flows) -> None:
        """Store the divisors, and each letter that is a function of states of its own lane."""
        for pivot in own.pivots:
            self.divisors[_without_lane(self.field.tree(pivot).args[0])] = None
            self.field.nonzero |= {Ratio(factor) for factor, _ in pivot.top.factor()[1]}
        elements, owners = self.spec.elements, {"p": self.spec.lists, "E": self.banks}
        for (name, lane), letter in own.letters.items():
            tree = self.field.tree(letter)
            costates = {key: elements[key[1]].costate for key in symbols(tree) if key[0] == "E"}
            words = {key: costates.get(key) or sym(key[:2]) for key in symbols(tree)}
            used = {(owners.get(k[0], {}).get(k[1], k[1]), k[2]) for k in words if k[2:]}
            if used <= {(self.banks.get(name), lane)}:
                self.letters[name] = subs(tree, words)

    def _gradient(self) -> None:
        """Check that the energy's derivatives, in a bank by one lane's state, are the co-states."""
        energy, states = self.text.energy, self.spec.states
        self.published(energy, {})  # raises if a name of a lane stands outside of sums
        words = {name: self.spec.words.get(name, ("", "")) for name in symbols(energy)}
        known = all(role in ("p", "x") for role, _ in words.values())
        need(known, "the energy has other names than states and parameters")
        for part in walk(energy):
            owners = {self.banks.get(states[s]) for s in symbols(part) if s in states}
            inside = [inner.op for inner in walk(part)]
            single = owners <= {part.value} and inside.count("sum") == 1
            single = single and not {"if", *KINKS} & {*inside}
            need(part.op != "sum" or single, "a bank's energy has other states, or choices")
        terms = energy.args if energy.op == "+" else (energy,)
        meanings = {name: sym(word) for name, word in words.items()}
        self.terms = [subs(term, meanings) for term in terms]
        self.values.extend(claim for term in self.terms for claim in partial(term))
        for state, name in states.items():
            lane = int(name in self.banks)
            bound = {self.banks.get(name, ""): lane}
            given = self.published(laws.derivative(energy, state), bound)
            own = self.law(self.spec.elements[name], "costate", lane)
            slope = laws.derivative(subs(energy, meanings), ("x", name))
            left = build("x - z", x=slope, z=self.spec.elements[name].costate or num(0))
            self._equal("energy", given, own, f"dU/d{state}", (left, ("x", name)))


def _without_lane(tree: Node) -> Node:
    """Return a tree of one lane in the symbols of conditions, which hold for each lane."""
    single = len({key[2:] for key in symbols(tree)} - {()}) < 2
    return subs(tree, {key: sym(key[:2]) for key in symbols(tree)}) if single else tree
