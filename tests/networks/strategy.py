"""Random networks: specs as plain data, over every kind of element.

Output: `network`, which draws one, and `explore`, which checks many.  A network has a tree
of elements that give the across variable of each node (capacitor, mass, source, resistor), and
chords that give their through variable (inductor, spring, hysteron, damper); that is a network with
one solution.  Then a few elements are put anywhere, and most such networks have none, or need a law
the other way round, or stores that depend on others are to be joined.
"""

from dataclasses import dataclass, field
from random import Random

from kinds import KINDS
from network_tableau import NODES, entropy_of, state

from piezo_sym import Model, PiezoError, derive

REFERENCE = {"e": "gnd", "m": "wall", "r": "frame", "h": "tank"}
DISSIPATIVE = {"e": "resistor", "m": "damper", "r": "rotational_damper", "h": "orifice"}
CHORDS = {"e": "inductor", "m": "spring", "r": "torsion_spring", "h": "inertance"}
TOGETHER = ("em", "em", "em", "er", "mr", "hm", "rh", "emr", "rhm")
COUNTS = ((1, 1), (2, 0), (0, 2), (2, 1), (1, 2), (3, 0), (0, 3), (1, 3), (3, 2))
THREE = ((1, 1, 1), (2, 1, 1), (1, 2, 1))
HEAT = ("ambient", "conduction", "heat_source")
TWO_PAIRS = ("coupling", "storage")
LANED = ("store", "law", "store, law", "stop")
WORDS = ("x", "u", "p", "h", "F", "J", "out", "n", "z", "W")


def _often(domain, role):
    """Return the kinds for a role in a domain, each as often as it weighs."""
    fit = {n: kind for n, kind in KINDS.items() if domain in kind.domains and getattr(kind, role)}
    return tuple(name for name, kind in fit.items() for _ in range(kind.weight))


TREE = {domain: _often(domain, "in_tree") for domain in REFERENCE}
CHORD = {domain: _often(domain, "is_chord") for domain in REFERENCE}


@dataclass
class Draft:
    """A spec in the making: what is drawn so far, and what an element may ask for.

    `linear` says that all resistors and dampers are, so that they may be in loops; `role` is "tree"
    or "chord": whether the next element gives the across or the through variable, or "tied" where
    it is to depend on others.
    """

    rng: Random
    nodes: dict = field(default_factory=lambda: {d: [node] for d, node in REFERENCE.items()})
    parameters: dict = field(default_factory=dict)
    inputs: dict = field(default_factory=dict)
    assume: list = field(default_factory=list)
    elements: dict = field(default_factory=dict)
    bodies: dict = field(default_factory=dict)  # the lowest temperature of each
    words: list = field(default_factory=lambda: list(WORDS))
    linear: bool = False
    role: str = "chord"
    ends: tuple = ()
    name: str = ""
    kind: str = ""
    lanes: int | None = None  # of the next element

    def one_in(self, number):
        """Return whether a rare thing happens."""
        return self.rng.randrange(100) < 100 // number

    def pick(self, items):
        """Return one of some things."""
        return self.rng.choice(list(items))

    def some(self, low, high):
        """Return a whole number from one to another."""
        return self.rng.randint(low, high)

    def mixed(self, items):
        """Return some things in any order."""
        return self.rng.sample(items, len(items))

    def parameter(self, letter, unit, low=0.5, high=4.0):
        """Return a parameter: new, a list of values for lanes, or one of another element."""
        name = f"{letter}_{self.name}"
        shared = [n for n in self.parameters if n.startswith(f"{letter}_") and self._is_plain(n)]
        if shared and self.one_in(8):
            return self.pick(shared)
        step, odd = (high - low) / 1000, 3.71e-4  # no ratio is 1: generic networks are meant
        listed = self.lanes is not None and self.one_in(2)
        numbers = (low + step * self.some(0, 1000) + odd for _ in range(self.lanes or 1))
        drawn = [round(number, 7) for number in numbers]
        drawn = drawn if listed else drawn[0]
        self.parameters[name] = {"value": drawn, "unit": unit}
        return name

    def _is_plain(self, parameter):
        return not isinstance(self.parameters[parameter]["value"], list)

    def input(self, unit, default=0.0):
        """Return an input of a unit: one that is there, or a new one."""
        there = [name for name, entry in self.inputs.items() if entry["unit"] == unit]
        if there and self.one_in(2):
            return self.pick(there)
        name = f"in_{len(self.inputs)}"
        self.inputs[name] = {"unit": unit, "default": default}
        return name

    def pair(self, domain):
        """Return the ends of the next element in a domain: those asked for, or any two nodes."""
        if self.ends and self.ends[0] == domain:
            return list(self.ends[1])
        first = self.pick(self.nodes[domain])
        return [first, self.pick([n for n in self.nodes[domain] if n != first])]

    def at(self):
        """Return a node of the kind's domain that moves."""
        domain = KINDS[self.kind].domains
        return next(n for n in self.pair(domain) if n != REFERENCE[domain])

    def can_couple(self, kind, domain):
        """Return whether there are nodes for the other pair of a coupling that has one in a domain.

        The first domain of a kind goes with any of its others.
        """
        if kind == "thermoelectric":
            return len(self.bodies) > 1
        first, *others = KINDS[kind].domains
        there = [d for d in KINDS[kind].domains if len(self.nodes[d]) > 1]
        if not others:
            return bool(there)
        return any(d in there for d in others) if domain == first else first in there

    def body(self):
        """Return the name of a body."""
        return self.pick(self.bodies)

    def states(self):
        """Return the symbols of the states so far, but for those of banks."""
        there = [(n, e) for n, e in self.elements.items() if "count" not in e]
        return [state(n, e) for n, e in there if KINDS[e["kind"]].letter]

    def state(self):
        """Return the symbol of a state, if it has one of its own."""
        if self.words and self.one_in(6):
            return {"state": self.words.pop(self.some(0, len(self.words) - 1))}
        return {}

    def add(self, kind, role, ends=(), cell=None):
        """Put an element into the spec: one, a bank, or one of each cell of a bank."""
        self.name = f"{kind[:3]}{len(self.elements)}"
        self.kind, self.role, self.ends = kind, role, ends
        name, bank = self.name, self._bank() if cell is None else cell
        self.lanes = bank.get("count")
        self.elements[name] = {"kind": kind, **bank, **KINDS[kind].draw(self)}
        self.lanes = None
        return name

    def _bank(self):
        """Return the count of lanes in parallel, if the next element has some."""
        form, often = KINDS[self.kind].form, KINDS[self.kind].form in ("store, law", "stop")
        fit = form in LANED and self.role == "chord" and not KINDS[self.kind].across
        return {"count": self.pick((1, 2, 3, 4))} if fit and self.one_in(2 if often else 6) else {}


def _bodies(draft):
    for _ in range(draft.some(1, 3)):
        draft.add("thermal_mass", "chord")


def _tree(draft, domain, count):
    """Put an element between each new node and an earlier one."""
    for n in range(count):
        node, earlier = f"{domain}{n}", draft.nodes[domain]
        kind = draft.pick(TREE[domain])
        if KINDS[kind].form == "coupling" and not draft.can_couple(kind, domain):
            kind = DISSIPATIVE[domain]
        other = REFERENCE[domain] if KINDS[kind].nodes == ("at",) else draft.pick(earlier)
        ends = draft.mixed([node, other])
        draft.add(kind, "tree", (domain, ends))
        draft.nodes[domain] = [*earlier, node]


def _chords(draft):
    """Put a chord at each node that has one attachment, and some more."""
    for domain in REFERENCE:
        for node in draft.nodes[domain][1:]:
            others = [n for n in draft.nodes[domain] if n != node]
            if _uses(draft, node) < 2 or draft.one_in(3):
                _chord(draft, domain, draft.mixed([node, draft.pick(others)]))


def _chord(draft, domain, ends):
    kind = draft.pick(CHORD[domain])
    if KINDS[kind].form in TWO_PAIRS and not draft.can_couple(kind, domain):
        kind = CHORDS[domain]
    if KINDS[kind].nodes == ("at",) and REFERENCE[domain] not in ends:
        kind = DISSIPATIVE[domain]
    draft.add(kind, "chord", (domain, ends))
    if kind == "hysteron" and not draft.one_in(4):
        draft.add(kind, "chord", (domain, ends[::-1]))


def _uses(draft, node):
    elements = draft.elements.values()
    ends = [element.get(f, ()) for element in elements for f in NODES]
    inner = [s for element in elements for s in element.get("states", {}).values()]
    ends += [s["between"] for s in inner if "between" in s]
    return sum(node == end or node in end for end in ends if not isinstance(end, str)) + sum(
        node == end for end in ends if isinstance(end, str)
    )


def _heat(draft):
    for _ in range(draft.some(0, 2)):
        kind = draft.pick(HEAT)
        if kind != "conduction" or len(draft.bodies) > 1:
            draft.add(kind, "chord")


def _anywhere(draft):
    """Put an element of any kind at any nodes: most such networks have no solution."""
    there = {domain for domain, nodes in draft.nodes.items() if len(nodes) > 1}
    fit = [kind for domain in sorted(there) for kind in (*TREE[domain], *CHORD[domain])]
    couples = {kind for kind in fit if KINDS[kind].form in TWO_PAIRS}
    first = {kind: KINDS[kind].domains[0] for kind in couples}
    lost = {k for k in couples if first[k] not in there or not draft.can_couple(k, first[k])}
    draft.add(draft.pick([k for k in fit if k not in lost]), draft.pick(("tree", "chord")))


def _cells(draft):
    """Put cells with a node of their own, at which a store or a law gives the across variable."""
    domain = draft.pick(sorted(d for d, nodes in draft.nodes.items() if len(nodes) > 1))
    cell = {"bank": f"cells{len(draft.elements)}", "count": draft.pick((1, 2, 3))}
    inside, there = f"{cell['bank']}.inside", draft.nodes[domain]
    if draft.one_in(3):
        _chain(draft, domain, cell, inside)
        return
    for role, kinds in (("tree", TREE), ("chord", CHORD), ("chord", CHORD))[: draft.pick((2, 3))]:
        kind = draft.pick([kind for kind in kinds[domain] if KINDS[kind].form in LANED])
        other = REFERENCE[domain] if KINDS[kind].nodes == ("at",) else draft.pick(there)
        draft.add(kind, role, (domain, draft.mixed([inside, other])), cell)


def _chain(draft, domain, cell, inside):
    """Put cells in series between a new node and another, and a chord that drives them."""
    node, other = f"{cell['bank']}.end", draft.pick(draft.nodes[domain])
    cell["series"] = draft.mixed([node, other])
    places = (
        ("tree", node, inside),
        ("tree", inside, other),
        ("chord", node, draft.pick((inside, other))),
    )
    for role, *ends in places[: draft.pick((2, 3))]:
        kinds = TREE[domain] if role == "tree" else CHORD[domain]
        fit = [k for k in kinds if KINDS[k].form in LANED and KINDS[k].nodes != ("at",)]
        draft.add(draft.pick(fit), role, (domain, draft.mixed(ends)), cell)
    draft.nodes[domain] = [*draft.nodes[domain], node]
    draft.add(CHORDS[domain], "chord", (domain, [node, draft.pick(draft.nodes[domain][:-1])]))


def _tied(draft):
    """Put stores whose co-states depend on others': two in series or in parallel, or on levers."""
    there = sorted(domain for domain, nodes in draft.nodes.items() if len(nodes) > 1)
    for n in range(draft.some(1, 2)):
        domain, node = draft.pick(there), f"tied{n}"
        springs, held = _inside(domain, "store", False), _inside(domain, "store", True)
        ways = [(springs, springs), (held, held, springs)]
        levers = [k for k in _inside(domain, "coupling", True) if draft.can_couple(k, domain)]
        ways += [(held, levers)] if levers else []
        shared = draft.pick(draft.nodes[domain])
        for kinds in draft.pick(ways):
            kind = draft.pick(kinds)
            other = shared if kinds is held else draft.pick(draft.nodes[domain])
            other = REFERENCE[domain] if KINDS[kind].nodes == ("at",) else other
            draft.add(kind, "tied", (domain, draft.mixed([node, other])))
        draft.nodes[domain] = [*draft.nodes[domain], node]


def _inside(domain, form, across):
    """Return the kinds of a form that have nodes of one domain alone."""
    fit = ((name, kind) for name, kind in KINDS.items() if domain == kind.domains)
    return [name for name, kind in fit if (kind.form, kind.across) == (form, across)]


def _adrift(elements):
    """Return the elements with nothing left at the electrical reference."""

    def loose(field):
        return ["loose" if node == "gnd" else node for node in field]

    return {
        name: {k: loose(v) if isinstance(v, list) else v for k, v in element.items()}
        for name, element in elements.items()
    }


def network(rng):
    """Draw a spec as plain data: the argument of `Model`, and what TOML text holds."""
    draft = Draft(rng)
    draft.linear = draft.one_in(3)
    _bodies(draft)
    domains = draft.pick(TOGETHER)
    counts = draft.pick(COUNTS if len(domains) == 2 else THREE)
    for domain, count in zip(domains, counts, strict=True):
        _tree(draft, domain, count)
    _chords(draft)
    _heat(draft)
    if draft.one_in(5):
        _cells(draft)
    if draft.one_in(5):
        _anywhere(draft)
    if draft.one_in(5):
        _tied(draft)
    order = draft.mixed(list(draft.elements))
    if draft.one_in(15):  # what holds a node may be missing, or a body
        order = order[1:]
    if draft.one_in(25):
        draft.elements = _adrift(draft.elements)
    bodies = [name for name in draft.bodies if name in order]
    above = [f"T_{n} > {draft.bodies[n]}" for n in bodies]
    if len(bodies) == 1:
        above = [f"T > {draft.bodies[bodies[0]]}"]
    return {
        "model": {"name": "network"},
        "parameters": draft.parameters,
        "inputs": draft.inputs,
        "domain": {"assume": [*above, *draft.assume]},
        "initial": {entropy_of(name, draft.elements[name]): 0.1 for name in bodies},
        "elements": {name: draft.elements[name] for name in order},
    }


class Rejected(Exception):
    """A check has nothing to say of a network."""


def assume(condition):
    """Reject a network unless a condition holds."""
    if not condition:
        raise Rejected


def explore(number, check, part=0):
    """Return what `check(spec, seed)` gave for each of a number of random networks.

    Each check, and each part of one, has networks of its own, the same in every run; those that it
    rejects do not count.
    """
    outcomes = []
    for n in range(20 * number):
        rng = Random(f"{check.__module__} {part} {n}")
        spec = network(rng)
        try:
            outcomes.append(check(spec, rng.randrange(10**6)))
        except Rejected:
            continue
        except Exception as error:
            error.add_note(f"network {n} of part {part} of {check.__module__}: {spec}")
            raise
        if len(outcomes) == number:
            break
    return outcomes


def derivable(spec):
    """Return the system of a network; a check rejects one that is refused."""
    try:
        return derive(Model(**spec))
    except PiezoError:
        raise Rejected from None
