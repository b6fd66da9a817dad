"""The published system against Kirchhoff's laws, exactly, for banks of 1 to 3 lanes.

Input: a `Spec` and the "system" of ``proofs.json``.  Output: a `Finding`: what does not agree, and
what has to be nonzero for the network to have one solution.

A lane of a bank draws the current of its own inductor, a state, from the nodes it shares; so shared
rates have sums over lanes with coefficients that no count is in, and products of two sums at most
(heats).  An identity in which no more than two sums are multiplied, in a row of its own lane or
none, concerns three lanes at once at most: it holds for every count if it does for 1, 2 and 3.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

from .field import Field, Ratio, constant
from .laws import InputError, Node, num, parse, put, replaced, sym, symbols, walk
from .network import Solution, is_linear, lanes, parts, solve
from .point import derivative
from .spec import Element, Spec

MAX_TEXT, MOST_SUMS, MOST_COUNT, MAX_NAMES = 200_000, 2, 3, 2000
KINKED = ("if", "abs", "sign", "min", "max", "deadzone", "saturate")


@dataclass
class Finding:
    """What a check of a system finds: reasons by subject, and trees that must be nonzero."""

    reasons: dict[str, str] = field(default_factory=dict)
    divisors: dict[Node, None] = field(default_factory=dict)
    letters: dict[str, Node] = field(default_factory=dict)
    energy: Node | None = None

    def say(self, subject: str, good: bool, reason: str) -> None:
        """Keep the first reason of a subject."""
        if not good:
            self.reasons.setdefault(subject, reason)


class Published:
    """The published text, parsed; names resolve to rational functions lane by lane."""

    def __init__(self, spec: Spec, system: Mapping[str, Any]) -> None:
        self.spec = spec
        try:
            self.states = [(s["name"], s["element"], s["bank"]) for s in system["states"]]
            self.names = {n: (e["element"], e["role"], e["bank"]) for n, e in system["names"].items()}
            texts = {n: e["law"] for n, e in system["names"].items()}
            groups = {key: dict(system[key]) for key in ("rates", "outputs")}
            self.energy = parse(system["energy"], True, MAX_TEXT)
        except (KeyError, TypeError, AttributeError, ValueError) as error:
            raise InputError(f"the published system lacks {error}") from None
        if len(texts) > MAX_NAMES or any(set(g) - set(map(str, g)) for g in groups.values()):
            raise InputError("the published system has too many names")
        self.laws = {name: parse(text, True, MAX_TEXT) for name, text in texts.items()}
        self.rates, self.outputs = (
            {name: parse(text, True, MAX_TEXT) for name, text in groups[key].items()}
            for key in ("rates", "outputs")
        )
        self.meanings: dict[str, tuple[str, str]] = {}
        self.meanings |= {name: ("p", name) for name in spec.parameters}
        self.meanings |= {name: ("u", name) for name in spec.inputs}
        self.meanings |= {name: ("x", owner) for name, owner in spec.states.items()}
        if taken := set(self.meanings) & set(self.names):
            raise InputError(f"the name {sorted(taken)[0]!r} is a symbol of the spec")
        self.order: dict[str, int] = {}
        for tree in (*self.laws.values(), *self.rates.values(), *self.outputs.values()):
            self.sums(tree, 0)

    def sums(self, node: Node, depth: int) -> int:
        """Return how many sums over lanes are multiplied at most; refuse what is beyond proof."""
        if depth > 50:
            raise InputError("published names are defined by themselves")
        if node.op == "sym":
            if node.value in self.laws and node.value not in self.order:
                self.order[node.value] = self.sums(self.laws[node.value], depth + 1)
            return self.order.get(node.value, 0)
        own = [self.sums(arg, depth) for arg in node.args]
        found = max(own, default=0)
        if node.op == "sum":
            found += 1
        elif node.op == "*":
            found = sum(own)
        elif node.op == "**" and node.value > 0 and node.value.denominator == 1:
            found *= int(node.value)
        elif node.op in ("/", "**") and own[-1]:
            raise InputError("a published divisor or power has a sum over lanes")
        if found > MOST_SUMS:
            raise InputError(f"more than {MOST_SUMS} published sums over lanes are multiplied")
        return 0 if node.op not in ("sum", "+", "neg", "*", "/", "**", "sym", "num") else found


class Comparison:
    """One comparison, for one size of every bank."""

    def __init__(self, spec: Spec, text: Published, count: int, finding: Finding) -> None:
        self.spec, self.text, self.finding = spec, text, finding
        self.counts = {e.name: count for e in spec.of("hysteron") if e.count is not None}
        self.field = Field()
        self.known: dict[Any, Ratio] = {}

    # What symbols stand for

    def symbol(self, meaning: tuple[str, str], lane: int) -> Ratio:
        """Return the atom of a symbol of the spec, in a lane."""
        role, owner = meaning
        per_lane = owner in (self.spec.lists if role == "p" else self.counts if role in "xE" else ())
        if per_lane and not lane:
            raise InputError(f"{owner!r} is of a lane, and stands outside of lanes")
        return self.field.symbol((role, owner, lane if per_lane else 0))

    def law(self, tree: Node, lane: int, letter: Ratio | None = None) -> Ratio:
        """Return a law of the spec."""

        def word(meaning: tuple[str, str]) -> Ratio:
            return letter if meaning[0] == "z" and letter else self.symbol(meaning, lane)

        return self.field.of(tree, word)

    def published(self, node: Node, bound: Mapping[str, int]) -> Ratio:
        """Return a published text, its lanes bound."""
        if any(part.op == "sum" for part in walk(node)):
            if node.op == "sum":
                if node.value not in self.counts:
                    raise InputError(f"{node.value!r} is no bank")
                rows = lanes(self.spec.elements[node.value], self.counts)
                terms = [self.published(node.args[0], {**bound, node.value: j}) for j in rows]
                return sum(terms[1:], terms[0])
            inner = {("part", n): self.published(arg, bound) for n, arg in enumerate(node.args)}
            shell = Node(node.op, tuple(sym(key) for key in inner), node.value)
            if node.op == "if":
                raise InputError("a published choice has a sum over lanes")
            return self.field.of(shell, inner.__getitem__)
        return self.field.of(node, lambda name: self.name(name, bound))

    def name(self, name: str, bound: Mapping[str, int]) -> Ratio:
        """Return what a published name stands for."""
        meaning = self.text.meanings.get(name)
        if meaning:
            owner = meaning[1]
            if meaning[0] == "p" and owner in self.spec.lists:
                used = (n for n in self.counts if self._uses(n, owner))
                return self.symbol(meaning, bound.get(next(used, ""), 0))
            return self.symbol(meaning, bound.get(owner, 0) if meaning[0] == "x" else 0)
        if name not in self.text.names:
            raise InputError(f"unknown published name {name[:60]!r}")
        element, role, bank = self.text.names[name]
        lane = bound.get(bank, 0) if bank else 0
        if bank and not lane:
            raise InputError(f"{name!r} is of a lane of {bank!r}, and stands outside of lanes")
        if (name, lane) not in self.known:
            own = {**bound, bank: lane} if bank else {b: n for b, n in bound.items() if b == bank}
            self.known[name, lane] = self._named(name, element, role, own, lane)
        return self.known[name, lane]

    def _uses(self, bank: str, parameter: str) -> bool:
        laws = self.spec.elements[bank].laws.values()
        return any(("p", parameter) in symbols(law) for law in laws)

    def _named(self, name: str, element: str, role: str, bound: Mapping[str, int], lane: int) -> Ratio:
        """Return a name's law; a co-state or temperature that is the spec's own is an atom."""
        found = self.published(self.text.laws[name], bound)
        owner = self.spec.elements.get(element)
        if role not in ("costate", "temperature") or owner is None or owner.costate is None:
            return found
        own = self.law(owner.costate, lane)
        if not self.field.is_zero(found - own):
            self.finding.say("system", False, f"{name} is not the law of {element}")
            return found
        return self.state(owner, lane)

    def state(self, element: Element, lane: int) -> Ratio:
        """Return the atom of a co-state or temperature."""
        return self.symbol(("T" if element.kind.form == "body" else "E", element.name), lane)

    # Kirchhoff's laws

    def check(self) -> None:
        """Compare rates and outputs, and close the balances."""
        ratio = {e.name: self.law(e.laws["ratio"], 0) for e in self.spec.of("coupling")}
        slope = {
            (e.name, lane): self.law(e.law, lane, constant(1))
            for e in self.spec.of("resistor", "hysteron")
            for lane in lanes(e, self.counts)
            if e.law is not None and is_linear(e.law, ("z", e.name))
        }
        solution = solve(self.spec, self.counts, ratio, slope, constant(1))
        determinant = constant(1)
        for pivot in solution.pivots:
            determinant = determinant * pivot
        if not self.field.is_zero(determinant - constant(1)):
            trees = self.field.factors(determinant.top)
            self.finding.divisors |= dict.fromkeys(replaced(tree, _unlaned) for tree in trees)
        rates = dict(self._rates(solution))
        power = self._inputs(dict(self._outputs(solution)))
        heat = constant(0)
        for (name, lane), own in rates.items():
            element = self.spec.elements[name]
            text = self.text.rates[element.state]
            given = self.published(text, {name: lane} if lane else {})
            self._equal("system", given, own, f"rate of {element.state}")
            power = power - self.state(element, lane) * given
            heat = heat + given if element.kind.form == "body" else heat
        self._equal("energy", power, constant(0), "dU/dt - y^T u")
        self._gradient()

    def _equal(self, subject: str, given: Ratio, own: Ratio, what: str) -> None:
        same = self.field.is_zero(given - own)
        self.finding.say(subject, same, f"{what} is not that of the network")

    def _given(self, form: Mapping[Any, Ratio], outputs: Mapping[Any, Ratio]) -> Ratio:
        total = constant(0)
        for label, factor in form.items():
            if label[0] == "W" and label not in outputs:
                raise InputError("laws that are not linear depend on each other")
            if label[0] == "W":
                total = total + factor * outputs[label]
            elif label[0] == "u":
                total = total + factor * self.symbol(("u", self.spec.elements[label[1]].input), 0)
            else:
                total = total + factor * self.state(self.spec.elements[label[1]], label[2])
        return total

    def _solved(self, solution: Solution) -> list[tuple[Any, Element, Ratio, Ratio]]:
        """Return the processes, those that are not linear first: others may depend on them."""
        self.outputs: dict[Any, Ratio] = {}
        order = [
            part for part in parts(self.spec, self.counts) if part.role == "law"
        ]
        order.sort(key=lambda p: is_linear(self.spec.elements[p.element].law or num(0), ("z", p.element)))
        found = []
        for part in order:
            element = self.spec.elements[part.element]
            form = solution.through[part] if part.across else solution.across[part]
            linear = is_linear(element.law or num(0), ("z", element.name))
            z = self._given(form, self.outputs if linear else {})
            W = self.law(element.law or num(0), part.lane, z)
            label = ("W", part.element, part.lane)
            self.outputs[label] = W
            self._tie(element, form)
            found.append((label, element, z, W))
        return found

    def _tie(self, element: Element, form: Mapping[Any, Ratio]) -> None:
        """Keep what a letter is in terms of states and inputs, if it is so lane by lane."""
        terms = []
        for label, factor in form.items():
            source = self.spec.elements[label[1]]
            foreign = source.count is not None and source.name != element.name
            if label[0] == "W" or foreign or not factor.top.is_constant():
                return
            of = sym(("u", source.input)) if label[0] == "u" else source.costate or num(0)
            lead = factor.top.leading_coefficient()
            terms.append(Node("*", (num(Fraction(int(lead.p), int(lead.q))), of)))
        self.finding.letters[element.name] = Node("+", tuple(terms)) if terms else num(0)

    def _rates(self, solution: Solution) -> Iterator[tuple[tuple[str, int], Ratio]]:
        """Yield the rate of every state, as the network has it."""
        flows = {body.name: constant(0) for body in self.spec.of("body")}
        heat = {body.name: self.state(body, 0) for body in self.spec.of("body")}
        for _, element, z, W in self._solved(solution):
            flows[element.bodies[0]] = flows[element.bodies[0]] + W * z / heat[element.bodies[0]]
        for element in self.spec.of("conduction", "ambient"):
            lam, first = self.law(element.laws["conductance"], 0), element.bodies[0]
            if element.kind.form == "ambient":
                flows[first] = flows[first] + self._exchange(element)
                continue
            second = element.bodies[1]
            power = lam * (heat[first] - heat[second])
            flows[first] = flows[first] - power / heat[first]
            flows[second] = flows[second] + power / heat[second]
        for part in parts(self.spec, self.counts):
            if part.role == "store":
                form = solution.through[part] if part.across else solution.across[part]
                yield (part.element, part.lane), self._given(form, self.outputs)
        yield from (((body, 0), flow) for body, flow in flows.items())

    def _exchange(self, element: Element) -> Ratio:
        """Return what an environment brings, lam*(T_e/T - 1)."""
        T = self.symbol(("T", element.bodies[0]), 0)
        ratio = self.symbol(("u", element.input), 0) / T
        return self.law(element.laws["conductance"], 0) * (ratio - constant(1))

    def _outputs(self, solution: Solution) -> Iterator[tuple[str, Ratio]]:
        """Yield the conjugate output of every port, as the network has it."""
        for part in parts(self.spec, self.counts):
            if part.role == "source":
                form = solution.through[part] if part.across else solution.across[part]
                y = self._given(form, self.outputs)
                yield part.element, -y if part.across else y
        for element in self.spec.of("ambient"):
            yield element.name, self.symbol(("T", element.bodies[0]), 0)

    def _inputs(self, outputs: Mapping[str, Ratio]) -> Ratio:
        """Compare the outputs; return the power put in."""
        power = constant(0)
        for name, own in outputs.items():
            element = self.spec.elements[name]
            given = self.published(self.text.outputs[name], {})
            self._equal("system", given, own, f"output of {name}")
            ambient = element.kind.form == "ambient"
            u = self._exchange(element) if ambient else self.symbol(("u", element.input), 0)
            power = power + given * u
        return power

    def _gradient(self) -> None:
        """Compare dU/dx with the co-states."""
        terms = self.text.energy.args if self.text.energy.op == "+" else (self.text.energy,)
        for name in self.spec.states.values():
            element, symbol = self.spec.elements[name], self.spec.elements[name].state
            lane = 1 if name in self.counts else 0
            total = constant(0)
            for term in terms:
                inner = term.args[0] if term.op == "sum" else term
                if any(part.op == "sum" or part.op in KINKED for part in walk(inner)):
                    raise InputError("the energy has choices, or sums in products")
                bound = {term.value: 1} if term.op == "sum" else {}
                if symbol in symbols(inner):
                    total = total + self.published(derivative(inner, symbol), bound)
            own = self.law(element.costate or num(0), lane)
            self._equal("energy", total, own, f"dU/d{symbol}")


def _unlaned(key: Any) -> Node:
    return sym(key if key[2] else key[:2])


def check_system(spec: Spec, system: Mapping[str, Any]) -> Finding:
    """Return what is found of a published system."""
    finding = Finding()
    try:
        text = Published(spec, system)
        expected = [
            (symbol, owner, owner if spec.elements[owner].count is not None else None)
            for symbol, owner in spec.states.items()
        ]
        ports = {e.name for e in spec.of("source", "ambient")}
        finding.say("system", text.states == expected, "the states are not those of the spec")
        finding.say("system", set(text.rates) == set(spec.states), "a rate is missing")
        finding.say("system", set(text.outputs) == ports, "an output is missing")
        banks = any(e.count is not None for e in spec.of("hysteron"))
        for count in range(1, MOST_COUNT + 1 if banks else 2):
            if not finding.reasons:
                Comparison(spec, text, count, finding).check()
        finding.energy = text.energy
    except (InputError, ArithmeticError, Exception) as error:  # noqa: BLE001
        finding.say("system", False, str(error))
    return finding
