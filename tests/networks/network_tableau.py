"""Kirchhoff's and Newton's laws solved numerically, from the spec alone.

Input: a spec as plain data, states and inputs by name.  Output: rates, outputs and productions.
Nothing of the package is used: every lane of a bank is a pair of branches of its own, every node's
potential and every branch's through variable is an unknown, and one dense system holds all laws.
Laws that are not linear are found by Newton's iteration.  Where the laws tie co-states to each
other, what they allow is the null space of those ties, found numerically (`Joint`).
"""

from dataclasses import dataclass, field, replace

import numpy as np
from kinds import KINDS
from law_values import value

REFERENCES = {"e": "gnd", "m": "wall", "r": "frame", "h": "tank", "": ":zero"}
NODES = dict.fromkeys(name for kind in KINDS.values() for name in kind.nodes)
SLOPE_STEP, ENERGY_STEP = 1e-6, 2e-5
CLOSE = 1e-12
MOST_STEPS = 60
SINGULAR = 1e-9


@dataclass(frozen=True)
class Branch:
    """A branch and its law: `given` for the across or the through variable, or `law` for it."""

    element: str
    nodes: tuple[str, str]
    across: bool
    given: float = 0.0
    law: object = None
    state: str = ""


@dataclass(frozen=True)
class Joint:
    """Stores whose co-states depend on each other, by their branches: e = Z e[kept].

    Joinable are those that nothing else is tied to, whose co-states rise by constant slopes.
    """

    stores: tuple
    kept: tuple
    Z: object
    joinable: bool


@dataclass(frozen=True)
class Answer:
    """What the laws say: the rates by state, the outputs by port, the productions by process."""

    rates: dict = field(default_factory=dict)
    outputs: dict = field(default_factory=dict)
    productions: dict = field(default_factory=dict)
    size: float = 1.0


class Tableau:
    """All branches of a spec at one state, and what they do."""

    def __init__(self, spec, states, inputs):
        self.spec, self.states, self.inputs = spec, states, inputs
        self.branches, self.temperatures = [], {}
        self.couplings, self.costates, self.limits = [], {}, {}
        self.inner = self._inner()
        elements = spec["elements"].items()
        for name, element in elements:
            if entropy_of(name, element):
                self.temperatures[name] = self._temperature(name, element)
        self.pumped = {body for _, element in elements for body in element.get("bodies", ())}
        for name, element in elements:
            self._add(name, element)
        names = dict.fromkeys(n for pair in self._all_nodes() for n in pair)
        self.nodes = {n: k for k, n in enumerate(n for n in names if n not in REFERENCES.values())}
        self.joint = self._joined()
        self._give()

    def _lanes(self, name, element):
        """Yield the lanes of an element, each with its label and its nodes, some its own."""
        inner = self.inner.get(bank_of(name, element), set())
        for lane in range(element.get("count", 1)):
            own = {node: f"{node}:{lane}" for node in inner}
            if "series" in element:  # one lane after the other, from one end to the other
                joints = [f"{element['bank']}:joint {n}" for n in range(1, element["count"])]
                places = [element["series"][0], *joints, element["series"][1]]
                own |= dict(zip(element["series"], places[lane : lane + 2], strict=True))
            label = f"{name}_{lane + 1}" if "count" in element else name
            yield lane, label, tuple(own.get(node, node) for node in nodes_of(element))

    def _inner(self):
        """Return the nodes that elements of one bank alone name, by their bank."""
        users, found = {}, {}
        for name, element in self.spec["elements"].items():
            parts = [element, *element.get("states", {}).values()]
            nodes = [n for part in parts for f in NODES for n in part.get(f, ()) if f != "at"]
            for node in [*nodes, *([element["at"]] if "at" in element else [])]:
                users.setdefault(node, set()).add(bank_of(name, element))
            for node in element.get("series", ()):
                users.setdefault(node, set()).add(None)
        for node, banks in users.items():
            if len(banks) == 1 and banks != {None} and node not in REFERENCES.values():
                found.setdefault(*banks, set()).add(node)
        return found

    def words(self, lane=0):
        """Return the values of the parameters, those of one lane where they are listed."""
        given = {n: p["value"] for n, p in self.spec["parameters"].items()}
        return {n: v[lane % len(v)] if isinstance(v, list) else v for n, v in given.items()}

    def seen(self, lane=0):
        """Return the values of all that laws see: states and temperatures, too."""
        hot = {f"T_{name}": value for name, value in self.temperatures.items()}
        return {**self.words(lane), **self.states, **hot}

    def _add(self, name, element):
        kind = KINDS[element["kind"]]
        if kind.form == "store, law":
            for lane, label, (a, b) in self._lanes(name, element):
                self._store(label, lane, element, (a, f"{label}:inner"), name)
                self._resistor(label, lane, element, (f"{label}:inner", b), name)
        elif kind.form == "store":
            for lane, label, nodes in self._lanes(name, element):
                self._store(label, lane, element, nodes, name)
        elif kind.form == "stop":
            self._stops(name, element)
        elif kind.form == "storage":
            self._storage(name, element)
        elif kind.form == "source":
            given = self.inputs[element["input"]] * (1 if kind.across else -1)
            self.branches.append(Branch(name, nodes_of(element), kind.across, given))
        elif kind.form == "law":
            for lane, label, nodes in self._lanes(name, element):
                self._resistor(label, lane, element, nodes, name)
        elif kind.form == "coupling":
            self.couplings.append((name, element))
        if name in self.pumped:
            given = self.temperatures[name]
            self.branches.append(Branch(name, (f"{name}:body", ":zero"), across=True, given=given))

    def _temperature(self, name, element):
        """Return the temperature of a body, or of a storage with an entropy."""
        symbol = entropy_of(name, element)
        if "energy" in element:
            return slope(element["energy"], {**self.words(), **self.states}, symbol)
        return value(element["temperature"], {**self.words(), "S": self.states[symbol]})

    def _store(self, label, lane, element, nodes, name):
        kind = KINDS[element["kind"]]
        symbol = state(name, element) + label.removeprefix(name)

        def costate(x):
            words = {**self.words(lane), kind.letter: x}
            if "energy" in element:
                return slope(element["energy"], words, kind.letter)
            if kind.itself in element:
                return value(element[kind.itself], words)
            return kind.costate(x, lambda f, other=None: value(element.get(f, other), words))

        self.costates[len(self.branches)] = symbol, costate
        self.branches.append(Branch(label, nodes, kind.across))

    def _stops(self, name, element):
        """Add a spring, or one in each lane; its limit counts when it is booked."""
        for lane, label, nodes in self._lanes(name, element):
            symbol, words = state(name, element) + label.removeprefix(name), self.words(lane)
            force = self.states[symbol] * value(element["stiffness"], words)
            self.limits[label] = symbol, value(element["limit"], words)
            self.branches.append(Branch(label, nodes, False, force))

    def _storage(self, name, element):
        """Add a branch for each state; co-states are differences of the energy."""
        for symbol, entry in element["states"].items():
            if entry["rate"] == "entropy":
                continue
            given = slope(element["energy"], {**self.words(), **self.states}, symbol)
            nodes = tuple(entry["between"])
            across = entry["rate"] in {"current", "force", "torque", "flow"}
            self.branches.append(Branch(name, nodes, across, given, state=symbol))

    def _resistor(self, label, lane, element, nodes, name):
        text, letter, across = law_of(element)
        words = self.seen(lane)
        for other, part in self.spec["elements"].items():
            same = other == name or (
                "count" in part and bank_of(other, part) == element.get("bank")
            )
            if same and KINDS[part["kind"]].letter:
                symbol = state(other, part)
                words[symbol] = self.states[symbol + label.removeprefix(name)]
        words = {**words, "T": self.temperatures[element["heats"]]}
        law = lambda z: float(value(text, {**words, letter: z}))  # noqa: E731
        self.branches.append(Branch(label, nodes, across, law=law))

    # Stores

    def _joined(self):
        """Return the stores that the laws tie to each other, and what may be their co-states."""
        left, sizes, _ = np.linalg.svd(self._given())
        ties = left[:, sizes <= SINGULAR][len(self.nodes) :]
        tied = [k for k in range(len(self.branches)) if abs(ties[k]).max(initial=0.0) > SINGULAR]
        stores = [k for k in tied if k in self.costates]
        _, sizes, right = np.linalg.svd(ties[stores].T)
        allowed = right[np.count_nonzero(sizes > SINGULAR) :].T
        ranks = [_rank(allowed[: n + 1]) for n in range(len(stores))]
        kept = [n for n, rank in enumerate(ranks) if rank > (ranks[n - 1] if n else 0)]
        joinable = [] != stores == tied and all(map(self._is_quadratic, stores))
        Z = allowed @ np.linalg.inv(allowed[kept])
        free = bool(abs(Z).max(axis=1, initial=0.0).all())  # none is forced to be zero
        return Joint(tuple(stores), tuple(kept), Z, joinable and free)

    def _is_quadratic(self, store):
        _, costate = self.costates[store]
        slopes = np.diff([costate(x) for x in (-2.0, -1.0, 0.0, 1.0, 2.0)])
        _, element = self._element(self.branches[store].element)
        return bool(np.ptp(slopes) <= SINGULAR * abs(slopes).max()) and "count" not in element

    def _give(self):
        """Give all co-states: of those that are tied, what the joined states say."""
        stores, kept, Z = self.joint.stores, self.joint.kept, self.joint.Z
        given = {k: f(self.states[x]) for k, (x, f) in self.costates.items() if k not in stores}
        if self.joint.joinable:
            laws = [self.costates[k][1] for k in stores]
            compliances = np.array([1 / (law(1.0) - law(0.0)) for law in laws])
            rests = np.array([-law(0.0) for law in laws]) * compliances
            x = np.array([self.states[self.costates[stores[n]][0]] for n in kept])
            e = Z @ np.linalg.solve(Z.T @ (compliances[:, None] * Z), x - Z.T @ rests)
            given |= dict(zip(stores, e, strict=True))
        for k, value_there in given.items():
            self.branches[k] = replace(self.branches[k], given=value_there)

    def _join_rates(self, rates):
        """Replace the rates of stores that are tied by those of the joined states, Z^T x'."""
        symbols = [self.costates[k][0] for k in self.joint.stores]
        own = np.array([rates.pop(symbol) for symbol in symbols])
        for n, rate in zip(self.joint.kept, self.joint.Z.T @ own, strict=True):
            rates[symbols[n]] = rate

    # The laws

    def matrix(self, slopes):
        """Return the system's matrix, for laws that rise by `slopes` (0: a given output)."""
        count, size = len(self.nodes), len(self.branches) + 2 * len(self.couplings)
        matrix = np.zeros((count + size, count + size))
        for k, branch in enumerate(self.branches):
            row = count + k
            self._balance(matrix, branch.nodes, row)
            across, through = (1.0, -slopes[k]) if branch.across else (-slopes[k], 1.0)
            self._across(matrix, row, branch.nodes, across)
            matrix[row, row] += through
        for k, (_, element) in enumerate(self.couplings):
            self._couple(matrix, element, count + len(self.branches) + 2 * k)
        return matrix

    def _all_nodes(self):
        yield from (branch.nodes for branch in self.branches)
        for _, element in self.couplings:
            yield from pairs_of(element)

    def _balance(self, matrix, nodes, column):
        for node, sign in zip(nodes, (1, -1), strict=True):
            if node in self.nodes:
                matrix[self.nodes[node], column] += sign

    def _across(self, matrix, row, nodes, factor):
        for node, sign in zip(nodes, (factor, -factor), strict=True):
            if node in self.nodes:
                matrix[row, self.nodes[node]] += sign

    def _couple(self, matrix, element, row):
        first, second = pairs_of(element)
        self._balance(matrix, first, row)
        self._balance(matrix, second, row + 1)
        kind = KINDS[element["kind"]]
        hot = {"T": self.temperatures[element["temperature"]]} if "temperature" in element else {}
        ends = zip(("T_1", "T_2"), element.get("bodies", ()), strict=False)
        hot |= {letter: self.temperatures[body] for letter, body in ends}
        ratio = value(element[kind.ratio], {**self.seen(), **hot})
        if not kind.across:
            matrix[row, row], matrix[row + 1, row + 1] = 1, 1
            self._across(matrix, row, second, -ratio)
            self._across(matrix, row + 1, first, ratio)
        else:
            self._across(matrix, row, first, 1)
            self._across(matrix, row, second, -ratio)
            matrix[row + 1, row + 1], matrix[row + 1, row] = 1, ratio

    def is_regular(self):
        """Return whether the laws have one solution when nonlinear laws give what they give."""
        return bool(np.linalg.svd(self._given(), compute_uv=False)[-1] > SINGULAR)

    def has_nonlinear_loop(self):
        """Return whether what a nonlinear law gives changes what one is given, its own or not."""
        answers, count = np.linalg.pinv(self._given(), rcond=SINGULAR), len(self.nodes)
        laws = [k for k, b in enumerate(self.branches) if b.law and _linear_slope(b) is None]
        taken = [self._given_row(self.branches[k], count + k) for k in laws]
        gains = [row @ answers[:, count + k] for row in taken for k in laws]
        return bool(max(map(abs, gains), default=0.0) > SINGULAR)

    def _given(self):
        """Return the matrix in which each nonlinear law gives a number."""
        return self.matrix([_linear_slope(branch) or 0.0 for branch in self.branches])

    def _given_row(self, branch, column):
        """Return the row that reads the variable that a law is given."""
        row = np.zeros((1, len(self.nodes) + len(self.branches) + 2 * len(self.couplings)))
        if branch.across:
            row[0, column] = 1.0
        else:
            self._across(row, 0, branch.nodes, 1.0)
        return row[0]

    # The solution

    def solve(self):
        """Return (across, through) of every branch, by Newton's iteration."""
        given = np.zeros(len(self.branches))
        for _ in range(MOST_STEPS):
            slopes = [_slope(branch, z) for branch, z in zip(self.branches, given, strict=True)]
            matrix = self.matrix(slopes)
            right = np.zeros(len(matrix))
            for k, (branch, z, slope) in enumerate(zip(self.branches, given, slopes, strict=True)):
                value_there = branch.law(z) - slope * z if branch.law else branch.given
                right[len(self.nodes) + k] = value_there
            solution = self._solved(matrix, right)
            across, through = self._variables(solution)
            size = max(1.0, abs(solution).max())
            found = np.where([branch.across for branch in self.branches], through, across)
            found[abs(found) <= CLOSE * size] = 0.0  # rounding must not choose a law's branch
            change = abs(found - given).max(initial=0.0)
            given = found
            if change <= CLOSE * size:
                return across, through, size
        raise AssertionError("the laws were not solved")

    def _solved(self, matrix, right):
        """Return a solution: where stores are tied, one of many with the same joined rates."""
        if self.joint.stores:
            return np.linalg.lstsq(matrix, right, rcond=CLOSE)[0]
        return np.linalg.solve(matrix, right)

    def _variables(self, solution):
        potential = {n: solution[k] for n, k in self.nodes.items()}
        across = [
            potential.get(a, 0.0) - potential.get(b, 0.0)
            for a, b in (branch.nodes for branch in self.branches)
        ]
        count = len(self.nodes)
        return np.array(across), solution[count : count + len(self.branches)]

    def answer(self):
        """Return rates, outputs and productions at the state."""
        across, through, size = self.solve()
        found = Answer(size=size)
        flows = dict.fromkeys(self.temperatures, 0.0)
        for branch, e, t in zip(self.branches, across, through, strict=True):
            self._book(found, flows, branch, e, t)
        self._join_rates(found.rates)
        for name, element in self.spec["elements"].items():
            self._book_heat(found, flows, name, element)
        for name, flow in flows.items():
            found.rates[entropy_of(name, self.spec["elements"][name])] = flow
        return found

    def _book(self, found, flows, branch, e, t):
        name, element = self._element(branch.element)
        if branch.law:
            heat = e * t
            temperature = self.temperatures[element["heats"]]
            found.productions[branch.element] = heat / temperature
            flows[element["heats"]] += heat / temperature
        elif branch.state:
            found.rates[branch.state] = t if branch.across else e
        elif name in flows:
            flows[name] += t
        elif branch.element in self.limits:
            symbol, limit = self.limits[branch.element]
            slip = e if t * np.sign(e) >= limit and e != 0 else 0.0
            found.rates[symbol] = e - slip
            produced = t * slip / self.temperatures[element["heats"]]
            found.productions[branch.element] = produced
            flows[element["heats"]] += produced
        elif KINDS[element["kind"]].form == "source":
            found.outputs[name] = -t if branch.across else e
        else:
            symbol = state(name, element) + branch.element.removeprefix(name)
            found.rates[symbol] = t if branch.across else e

    def _element(self, label):
        elements = self.spec["elements"]
        name = label if label in elements else label.rpartition("_")[0]
        return name, elements[name]

    def _book_heat(self, found, flows, name, element):
        if element["kind"] == "conduction":
            first, second = element["between"]
            hot, cold = self.temperatures[first], self.temperatures[second]
            words = {**self.seen(), "T_1": hot, "T_2": cold}
            heat = value(element["conductance"], words) * (hot - cold)
            flows[first] -= heat / hot
            flows[second] += heat / cold
            found.productions[name] = heat / cold - heat / hot
        if element["kind"] == "heat_source":
            own = self.temperatures[element["into"]]
            flows[element["into"]] += self.inputs[element["input"]] / own
            found.outputs[name] = own
        if element["kind"] == "ambient":
            own = self.temperatures[element["body"]]
            outside = self.inputs[element["input"]]
            words = {**self.seen(), "T": own, "T_e": outside}
            conductance = value(element["conductance"], words)
            flows[element["body"]] += conductance * (outside / own - 1)
            found.outputs[name] = own


def slope(energy, words, name):
    """Return the slope of an energy, by differences."""
    steps = (ENERGY_STEP, -ENERGY_STEP)
    high, low = (value(energy, {**words, name: words[name] + step}) for step in steps)
    return (high - low) / (2 * ENERGY_STEP)


def bank_of(name, element):
    """Return the bank of an element: its own name, or that of its cell; None if it has none."""
    return element.get("bank", name) if "count" in element else None


def state(name, element):
    """Return the symbol of an element's state."""
    return element.get("state", f"{KINDS[element['kind']].letter}_{name}")


def entropy_of(name, element):
    """Return the symbol of the entropy of an element that is a body, else an empty text."""
    if element["kind"] == "thermal_mass":
        return state(name, element)
    states = element.get("states", {}).items()
    return next((symbol for symbol, entry in states if entry["rate"] == "entropy"), "")


def nodes_of(element):
    """Return the two nodes of an element; one node means the reference of its domain, too."""
    at_rest = REFERENCES.get(KINDS[element["kind"]].domains)
    return tuple(element["between"]) if "between" in element else (element["at"], at_rest)


def pairs_of(element):
    """Return the two pairs of nodes of a coupling; each body is a node, too."""
    pairs = tuple(tuple(element[n]) for n in KINDS[element["kind"]].nodes if n in element)
    bodies = tuple(f"{body}:body" for body in reversed(element.get("bodies", ())))
    return (*pairs, bodies) if bodies else pairs


def law_of(element):
    """Return a dissipative law, its letter, and whether it gives the across variable."""
    laws = KINDS[element["kind"]].laws
    name = next(name for name in laws if name in element)
    return element[name], *laws[name]


def _linear_slope(branch):
    """Return the slope of a law that is linear in its letter, else None."""
    if branch.law is None:
        return None
    slopes = [branch.law(z) / z for z in (-3.1, -0.7, -0.03, 0.01, 0.4, 2.3)]
    return slopes[0] if np.ptp(slopes) <= 1e-12 * abs(slopes[0]) else None


def _slope(branch, z):
    linear = _linear_slope(branch)
    if branch.law is None or linear is not None:
        return linear or 0.0
    wide, narrow = (
        (branch.law(z + step) - branch.law(z - step)) / (2 * step)
        for step in (SLOPE_STEP, SLOPE_STEP / 2)
    )
    return wide if abs(narrow) <= 1.5 * abs(wide) else 0.0  # at a jump: what it gives is given


def _rank(matrix):
    return np.linalg.matrix_rank(matrix, tol=SINGULAR)
