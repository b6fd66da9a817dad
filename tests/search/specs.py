"""Specs drawn at random: about 20 laws in one network, on one set of names.

Input: a seed.  Output: `Made`: TOML, and what is known of its laws by construction.
"""

from dataclasses import dataclass, field
from random import Random

import tomli_w

from tests.search.forms import CONDITIONS
from tests.search.grammar import Grammar
from tests.search.laws import ZERO, read, text, widths
from tests.search.names import ELEMENTS, NODES, SYMBOLS
from tests.search.points import filled
from tests.search.reading import spec_of
from tests.search.values import DoubtError, NoValueError, exact, rational

LAWS = 20
#: Depths of the laws of one spec; the deep ones cost the prover most.
DEPTHS = ((0,), (0, 0, 0, 1), (0, 0, 0, 1), (0, 0, 1, 1), (0, 1, 1, 2))
#: Letters of states: in the law of a store they are not the parameter of that name.
LETTERS = frozenset({"p", "q", "Q", "S", "phi"})
ABOVE = (0.5, 1.0, 2.0, 0.25, 4.0, 3.0)
ANY = (-1.0, 1.0, -2.0, 0.5, 0.0, -0.5, 3.0, -3.0)


@dataclass
class Made:
    """A spec, and (id, element) -> whether a law has the property by construction."""

    data: dict
    labels: dict = field(default_factory=dict)

    @property
    def text(self):
        return tomli_w.dumps(self.data)


class Draft:
    """A spec in the making."""

    def __init__(self, random, fit, count=LAWS):
        self.random, self.fit, self.count = random, fit, count
        self.symbols = random.sample(SYMBOLS, len(SYMBOLS))
        self.names = list(
            {name.lower(): name for name in random.sample(ELEMENTS, len(ELEMENTS))}.values()
        )
        self.nodes = random.sample(NODES, len(NODES))
        self.elements, self.labels, self.inputs, self.paired = {}, {}, {}, ""
        self.depths = random.choice(DEPTHS)
        self.parameters = {}
        self.above = [self.parameter(ABOVE) for _ in range(3)]
        self.least = [self.parameter((*ABOVE, 0.0)) for _ in range(random.randint(1, 2))]
        self.any = [self.parameter(ANY) for _ in range(3)]
        self.bodies = [self.add(self.body()) for _ in range(random.choice((1, 1, 2)))]

    def parameter(self, values):
        name = next(name for name in self.symbols if name not in LETTERS)
        self.symbols.remove(name)
        self.parameters[name] = {"value": self.random.choice(values), "unit": "1"}
        return name

    def input(self):
        name = self.symbols.pop()
        self.inputs[name] = {"unit": "1", "default": 0.0}
        return name

    def add(self, element):
        """Put an element in, under a name drawn, its state's symbol too at times."""
        name = self.names.pop()
        if element["kind"] in STATEFUL and "state" not in element and self.random.random() < 0.15:
            element["state"] = self.symbols.pop()
        self.elements[name] = element
        return name

    def grammar(self, letter, hot="T"):
        return Grammar(self.random, letter, self.above, self.least, self.any, hot)

    def body(self):
        T, c, x = self.random.choices(self.above, k=3)
        laws = [f"{T}*exp(S/{c})"] * 60
        laws += [f"{T}*(1 + S/{c})", f"{T}*exp(S/{c}) + {x}", f"{T}*exp(S/{c}) - {x}"]
        laws += [f"{T}*exp(S/{c})*(sqrt({x}/{c}) if {x} > {c} else 1)", f"{T}*(1 + (S/{c})**2)"]
        return {"kind": "thermal_mass", "temperature": self.random.choice(laws)}

    def size(self, letter):
        """Return the law of a store: positive by its kind's requirement."""
        p, n = self.random.choice(self.above), self.random.choice(self.least)
        draw = self.random.random()
        if draw < 0.75:
            return p
        if draw < 0.85 and letter:
            bent = f"(1 + {n}*{letter}**2)"
            return f"{p}*{bent}" if letter == "q" else f"{p}/{bent}"
        least = self.grammar("", "").least_of(self.random.choice((1, 1, 2)))
        return f"{p}*(1 + {least.text})"

    def law(self, letter):
        """Return a law that the package reads, and what is known of it."""
        while True:
            drawn = self.grammar(letter).law(self.random.choice(self.depths))
            made = text(read(drawn.text))
            if len(made) < 400 and self.fit(made) and self._wide(made):
                return made, drawn

    def _wide(self, made):
        """Return whether all half widths are >= 0 at the values given, as the domain will ask."""
        at = {name: rational(entry["value"]) for name, entry in self.parameters.items()}
        try:
            return all(exact((">=", width, ZERO), at) for width in widths(read(made)))
        except (NoValueError, DoubtError, KeyError):
            return False

    def dissipate(self, kind, key, letter, between, **more):
        made, drawn = self.law(letter)
        body = self.random.choice(self.bodies)
        name = self.add({"kind": kind, "between": between, key: made, "heats": body, **more})
        for claim in ("welldef", "continuous", "passive"):
            own = getattr(drawn, "defined" if claim == "welldef" else claim)
            if own is not None:
                self.labels[claim, name] = own

    def turned(self, a, b):
        return [a, b] if self.random.random() < 0.7 else [b, a]


STATEFUL = {"mass", "spring", "inductor", "capacitor", "hysteron", "thermal_mass"}


def _mass(draft, count):
    node = draft.nodes.pop()
    draft.add({"kind": "mass", "at": node, "mass": draft.size("p")})
    draft.add({"kind": "force_source", "at": node, "input": draft.input()})
    if draft.random.random() < 0.5:
        between, law = draft.turned(node, "wall"), draft.size("q")
        draft.add({"kind": "spring", "between": between, "stiffness": law})
    for _ in range(count):
        draft.dissipate("damper", "force", "v", draft.turned(node, "wall"))


def _hysterons(draft, count):
    node = draft.nodes.pop()
    draft.add({"kind": "voltage_source", "between": [node, "gnd"], "input": draft.input()})
    for n in range(count):
        more = {"inductance": draft.size("phi")}
        if draft.random.random() < 0.35:
            more["count"] = draft.random.randint(1, 3)
        if draft.random.random() < 0.1:
            more["state"] = draft.symbols.pop()
        first = next((name for name in draft.names if f"{name}_j" in draft.names), "")
        if n == 0 and first and draft.random.random() < 0.4:  # a bank, and one called as its lane
            others = [name for name in draft.names if name not in {first, f"{first}_j"}]
            draft.names = [*others, f"{first}_j", first]
            more = {"inductance": draft.size(""), "count": 2, "state": f"phi_{first}"}
            draft.paired = f"phi_{first}**2 < {more['inductance']}"
        if draft.names[-1].endswith("_j"):
            more["state"] = draft.symbols.pop()
        draft.dissipate("hysteron", "voltage", "i", draft.turned(node, "gnd"), **more)


def _resistors(draft, count):
    node = draft.nodes.pop()
    draft.add({"kind": "voltage_source", "between": [node, "gnd"], "input": draft.input()})
    for n in range(count):
        inner = f"{node}.{n}"
        between = draft.turned(node, inner)
        draft.add({"kind": "inductor", "between": between, "inductance": draft.size("phi")})
        draft.dissipate("resistor", "voltage", "i", draft.turned(inner, "gnd"))


def _capacitor(draft, count):
    node = draft.nodes.pop()
    draft.add({"kind": "capacitor", "between": [node, "gnd"], "capacitance": draft.size("Q")})
    draft.add({"kind": "current_source", "between": [node, "gnd"], "input": draft.input()})
    for _ in range(count):
        draft.dissipate("resistor", "current", "v", draft.turned(node, "gnd"))


def _springs(draft, count):
    node = draft.nodes.pop()
    draft.add({"kind": "velocity_source", "at": node, "input": draft.input()})
    for n in range(count):
        inner = f"{node}.{n}"
        law = draft.size("")
        draft.add({"kind": "spring", "between": draft.turned(node, inner), "stiffness": law})
        draft.dissipate("damper", "velocity", "f", draft.turned(inner, "wall"))


GROUPS = (_mass, _mass, _hysterons, _hysterons, _resistors, _capacitor, _springs)


def _contact(draft):
    """Put a conduction between the bodies, if there are two, and an ambient at times."""
    g = draft.grammar("", "")
    if len(draft.bodies) == 2:
        law = draft.random.choice((g.least_of(1).text, g.least_of(2).text, g.name()))
        if draft.fit(law):
            draft.add({"kind": "conduction", "between": draft.bodies, "conductance": law})
    if draft.random.random() < 0.3:
        law = draft.random.choice(draft.least)
        source, body = draft.input(), draft.bodies[0]
        draft.inputs[source]["default"] = 300.0
        draft.add({"kind": "ambient", "body": body, "conductance": law, "input": source})


def _domain(draft):
    """Return conditions: what the grammar counts on, and more that hold at the values given."""
    base = [f"{n} > 0" for n in draft.above] + [f"{n} >= 0" for n in draft.least]
    more = [draft.paired] if draft.paired and draft.random.random() < 0.7 else []
    made = {"parameters": draft.parameters, "inputs": draft.inputs, "elements": draft.elements}
    spec = spec_of(tomli_w.dumps({**made, "domain": {"assume": base}}))
    for _ in range(draft.random.choice((0, 0, 0, 1, 1, 2, 3))):
        for _ in range(20):
            more_now = _condition(draft, spec)
            if all(_holds(condition, spec) and draft.fit(condition) for condition in more_now):
                more += more_now
                break
    return base, more


def _condition(draft, spec):
    pick = draft.random.choice
    (a, b), (p, n) = draft.random.sample(draft.any, 2), (pick(draft.above), pick(draft.least))
    states = [
        s
        for s in spec.free
        if s not in spec.fixed and "~" not in s and s not in spec.data["inputs"]
    ]
    guard = draft.grammar("", "").guarded(1, least=True).text
    form = pick(CONDITIONS)
    T = pick([*spec.hot.values()])
    return [c.format(a=a, b=b, p=p, n=n, T=T, x=pick(states), g=guard) for c in form]


def _holds(condition, spec):
    """Return whether a condition holds at the values given, its half widths not negative."""
    try:
        at, tree = filled({n: rational(v) for n, v in spec.own.items()}, spec), read(condition)
        return exact(tree, at) and all(exact((">=", width, ZERO), at) for width in widths(tree))
    except (NoValueError, DoubtError, KeyError):
        return False


def draw(seed, fit, laws=LAWS):
    """Return a spec.

    Parameters
    ----------
    seed : text or a number; the same seed gives the same spec.
    fit : whether the package reads a law or a condition; it refuses what is too large.
    """
    random = Random(seed)
    draft = Draft(random, fit)
    groups = random.sample(GROUPS, random.choice((1, 2, 2, 3)))
    for n, group in enumerate(groups):
        group(draft, laws * (n + 1) // len(groups) - laws * n // len(groups))
    _contact(draft)
    base, more = _domain(draft)
    labels = {key: known for key, known in draft.labels.items() if known or not more}
    data = {
        "model": {"name": "drawn"},
        "parameters": draft.parameters,
        "inputs": draft.inputs,
        "domain": {"assume": [*base, *more]},
        "elements": draft.elements,
    }
    return Made(data, labels)
