"""The checker's own reader of specs.

Input: TOML.  Output: a `Spec`: elements with their laws in symbols that have an owner, the domain
(assumptions of the spec, requirements of kinds, widths >= 0), values in SI.
Symbols are pairs: ("p", parameter), ("u", input), ("x", element) its state, ("z", element) the
letter of its dissipative law, ("r", element) the rate of its slip, ("T", body).
"""

import re
import tomllib
from collections.abc import Iterator, Mapping
from fractions import Fraction
from typing import Any, NamedTuple

from . import laws
from .field import Field
from .functions import KINKS
from .kinds import KINDS, REFERENCES, UNITS, Kind
from .laws import InputError, Node, build, cancelled, compare, need, num, subs, sym, symbols
from .parts import joins, parts, slipping_store, stem
from .units import Dimension, faults, unit

DOTTED, MAX_BYTES = re.compile(r"(\s*\.\s*[\w\"'-]+){9}"), 500_000
TABLES = ("model", "parameters", "inputs", "domain", "initial", "elements")
Symbol = tuple[str, str]


class Element(NamedTuple):
    """An element: `laws` by field, `costate` dU/dx, a dissipative `law` in the letter `letter`.

    If `across`, it imposes its across variable, else its through variable; a store that `follows`
    other stores imposes the other one.  `bodies` are those that it heats, conducts between, or
    reads T of.  `lanes` is (bank, size), `chain` the end nodes of lanes in series.  A node
    ("T", body) has the potential T, and draws entropy from the body.
    """

    name: str
    kind: Kind
    laws: Mapping[str, Node]
    state: str
    costate: Node | None
    law: Node | None
    letter: str
    pairs: tuple[tuple[Any, Any], ...]
    across: bool
    bodies: tuple[str, ...]
    input: str
    lanes: tuple[str, int] | None
    chain: tuple[str, str] | None
    jumps: bool
    follows: bool = False


class Spec(NamedTuple):
    """A spec: `words` are the meanings of names in [domain], `initial` is by element.

    `states` has the element of each state, `lists` the bank of each parameter with a value per
    lane, `faults` the faults of units.
    """

    parameters: Mapping[str, tuple[Fraction, ...]]
    inputs: Mapping[str, tuple[Fraction, ...]]
    words: Mapping[str, Symbol]
    states: Mapping[str, str]
    elements: Mapping[str, Element]
    initial: Mapping[str, tuple[Node, ...]]
    conditions: tuple[Node, ...]
    lists: Mapping[str, str]
    faults: list[str]

    def of(self, *forms: str) -> Iterator[Element]:
        """Return the elements of some forms, in order."""
        return (e for e in self.elements.values() if e.kind.form in forms)


def read_spec(text: str) -> Spec:
    """Return the spec of a text; raises `InputError` if the checker cannot read it."""
    small = len(text) <= MAX_BYTES and not DOTTED.search(text)
    need(small, "the spec is too large, or nested too deeply")
    try:
        data = tomllib.loads(text, parse_float=laws.number)
        need(set(data) <= set(TABLES), "the spec has an unknown table")
        return _Reader({name: dict(data.get(name, {})) for name in TABLES}).spec()
    except (RecursionError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise InputError(f"the spec cannot be read: {str(error)[:100]}") from None


class _Reader:
    def __init__(self, tables: dict[str, dict[str, Any]]) -> None:
        self.tables, self.faults, self.units = tables, list[str](), dict[Symbol, Dimension]()
        entries, self.quotients = tables["elements"], dict[str, tuple[Node, ...]]()
        self.limits = {n: e["limit"] for n, e in entries.items() if e["kind"] == "stop"}
        entries |= {name: slipping_store(name, entries[name]) for name in self.limits}
        self.parameters = self._values("parameters", "value", "p")
        self.inputs = self._values("inputs", "default", "u")
        tables["elements"] = entries = dict(parts(entries))
        for name, entry in entries.items():
            need(entry["kind"] in KINDS, f"{entry['kind']!r} of {name} is a kind it does not know")
        self.kinds = {name: KINDS[entry["kind"]] for name, entry in entries.items()}
        need(bool(self.kinds), "no elements")
        self.bodies = [name for name, kind in self.kinds.items() if kind.form == "body"]
        self.joined = {n: e["count"] for n, e in entries.items() if joins(self.kinds[n], e)}
        banked = {n: e for n, e in entries.items() if "count" in e and n not in self.joined}
        counts = (isinstance(n, int) and n >= 1 for n in self.joined.values())
        need(all(counts), "a count is no whole number above 0")
        self.lanes = {("x", n): (e.get("bank", n), e["count"]) for n, e in banked.items()}
        single = len({*self.lanes.values()}) == len(dict(self.lanes.values()))
        single &= all(n == b or b not in self.kinds for (_, n), (b, _) in self.lanes.items())
        need(single, "a bank has two sizes, or the name of an element")
        self.words, self.domains = self._words(), {b: a for a, b in REFERENCES.items()}
        self.states = {word: owner for word, (role, owner) in self.words.items() if role == "x"}
        self.elements = {name: self._element(name) for name in self.kinds}

    def spec(self) -> Spec:
        initial = {self.states[state]: self._starts(state) for state in self.tables["initial"]}
        conditions = tuple(dict.fromkeys(self._conditions(initial)))
        tables = (self.parameters, self.inputs, self.words, self.states, self.elements)
        return Spec(*tables, initial, conditions, self._lists(conditions), self.faults)

    def _values(self, table: str, field: str, role: str) -> dict[str, tuple[Fraction, ...]]:
        found = {}
        for name, entry in self.tables[table].items():
            complete = set(entry) <= {field, "unit", "doc"} and (field in entry or role == "u")
            need(complete and name.isidentifier(), f"{table}.{name} has a wrong key, or no name")
            given, (factor, self.units[role, name]) = entry.get(field, 0), unit(entry["unit"])
            values = given if isinstance(given, list) and given and role == "p" else [given]
            found[name] = tuple(Fraction(value) * factor for value in values)
        return found

    def _words(self) -> dict[str, Symbol]:
        found = [(name, (role, name)) for role, name in self.units]
        for name, kind in self.kinds.items():
            if kind.costate:
                letter, own = next(iter(next(iter(kind.laws.values()))[1].items()))
                word = self.tables["elements"][name].get("state", f"{letter}_{name}")
                found.append((word, ("x", name)))
                self.units["x", name] = unit(own)[1]
        self.units |= {("T", name): unit("K")[1] for name in self.bodies}
        found += [(f"T_{name}", ("T", name)) for name in self.bodies]
        found += [("T", found[-1][1])] * (len(self.bodies) == 1 and "T" not in dict(found))
        need(len(dict(found)) == len(found), "a name has two meanings")
        return dict(found)

    def _resolved(self, text: Any, words: Mapping[str, Symbol], compares: bool = False) -> Node:
        tree = laws.parse(text, compares=compares)
        for part in tree.args if compares else (tree,):
            Field().of(part)  # raises if it is too large to be written out
        unknown = [str(name)[:60] for name in symbols(tree) if name not in words]
        need(not unknown, f"{text[:60]!r} has unknown names: {', '.join(unknown)}")
        return laws.subs(tree, {name: sym(words[name]) for name in symbols(tree)})

    def _element(self, name: str) -> Element:
        entry, kind = self.tables["elements"][name], self.kinds[name]
        needed = {field for field, must in kind.fields.items() if must}
        known = needed <= entry.keys() <= kind.fields.keys()
        need(known, f"elements.{name[:60]} has a wrong key, or no name")
        heats = [entry[f] for f in ("heats", "body", "into", "temperature") if f in entry]
        heats = entry["between"] if kind.form == "conduction" else entry.get("bodies", heats)
        bodies = () if kind.form == "body" else tuple(heats)
        warm = set(bodies) <= set(self.bodies) and len(set(bodies)) == len(bodies)
        need(warm, f"elements.{name} names what is no thermal_mass")
        ends = [end for end in kind.ends if end[0] in entry]
        coupled = kind.form == "coupling" and "bodies" not in kind.fields
        need(len(ends) == 2 or not coupled, f"elements.{name} needs two pairs of nodes")
        ratio = f"{UNITS[ends[0][1]][kind.across]}/({UNITS[ends[1][1]][1]})" if coupled else ""
        own = {f: self._law(name, f, bodies, ratio) for f in kind.laws if f in entry}
        field = next(reversed(own), "")
        dissipates = kind.form in ("law", "hysteron") or field == "slip"
        costate = self._costate(name, own)
        if count := self.joined.get(name):  # U(x) = count*U_j(x/count)
            share = Node("/", (sym(("x", name)), num(count)))
            costate = costate and laws.subs(costate, {("x", name): share})
        law, letter = (own[field], next(iter(kind.laws[field][1]))) if dissipates else (None, "")
        across = kind.across and (kind.form != "law" or field == next(iter(kind.laws)))
        source, lanes = entry.get("input", ""), self.lanes.get(("x", name))
        known = not {"bank", "series"} & {*entry} if lanes is None else lanes[1] >= 1
        alone = across and kind.form == "store" and "bank" not in entry
        pair = entry.get("series", entry.get("between") if alone else None) if lanes else None
        chain = (str(pair[0]), str(pair[1])) if pair and known and "at" not in entry else None
        known &= bool(pair) == bool(chain)
        need(known, f"elements.{name}.count is out of range")
        row = UNITS[ends[0][1]][kind.across] if kind.form == "source" else "KW"[kind.form == "heat"]
        if "input" in kind.fields and self.units["u", source] != unit(row)[1]:
            self.faults.append(f"elements.{name}.input is not in {row}")
        pairs = self._pairs(name, ends)
        hot: list[tuple[Any, Any]] = [(("T", name), REFERENCES["E"])] * (kind.form == "body")
        hot += [(("T", b), ("T", a)) for a, b in [bodies] * ("bodies" in kind.fields)]
        state = next((word for word, owner in self.states.items() if owner == name), "")
        others = ((*pairs, *hot), across, bodies, source, lanes, chain)
        jumps = entry.get("discontinuous", False)
        return Element(name, kind, own, state, costate, law, letter, *others, jumps)

    def _costate(self, name: str, own: dict[str, Node]) -> Node | None:
        """Return dU/dx from the one law of a store, or from its energy."""
        kind, first = self.kinds[name], next(iter(self.kinds[name].laws), "")
        given = [field for field in own if field not in ("rest", "slip")]
        single = len(given) == 1 and ("rest" not in own or given[0] == first)
        need(kind.form not in ("law", "store") or single, f"elements.{name} needs exactly one law")
        if "energy" in own:
            found = laws.derivative(own["energy"], ("x", name))
            own |= {"temperature": found} if kind.form == "body" else {}
            return found
        if kind.form == "body" or not kind.costate:
            return own.get(kind.costate)
        x, rest = sym(("x", name)), own.get("rest", num(0))
        x = build("x - z", x=x, z=rest) if rest != num(0) else x
        sized = given[0] == first
        limit = cancelled(law := build(kind.costate, **own, x=x) if sized else own[given[0]], x)
        there = subs(limit, {("x", name): rest})  # sinh(q)/q is 0/0 at rest, cosh(q)/q is 1/0
        zero, bent = Field().same(there, num(0)), {n.op for n in laws.walk(there)} & {"if", *KINKS}
        if limit != law and (zero or (sized and bent)):
            law, self.quotients[name] = limit, () if zero else (compare(there, "="),)
        return law

    def _pairs(self, name: str, ends: list[tuple[str, str]]) -> tuple[tuple[Any, Any], ...]:
        """Return the node pairs of an element; raises if a node is in two domains."""
        entry = self.tables["elements"][name]
        given = ((entry[key], REFERENCES[d]) if key == "at" else entry[key] for key, d in ends)
        pairs = tuple((a, b) for a, b in given)
        need(all(a != b and isinstance(a + b, str) for a, b in pairs), "no pair of nodes")
        for (_, d), (a, b) in zip(ends, pairs, strict=True):
            same = self.domains.setdefault(a, d) == d == self.domains.setdefault(b, d)
            need(same, f"a node of {name} is in two domains")
        return pairs

    def _law(self, name: str, field: str, bodies: tuple[str, ...], ratio: str) -> Node:
        entry, (needed, letters) = self.tables["elements"][name], self.kinds[name].laws[field]
        mine, kind = self.lanes.get(("x", name)), self.kinds[name]
        lanes = {s for s, own in self.lanes.items() if own != mine}
        need(field != "slip" or bool(bodies), f"elements.{name} slips, and heats nothing")
        stored = bool(kind.costate) and (kind.form, field) != ("hysteron", "voltage")
        stored = stored and field != "slip"
        roles = "p" if stored else "pxT"
        words = {w: s for w, s in self.words.items() if s[0] in roles and s not in lanes}
        warm = zip(bodies or self.bodies[: len(self.bodies) == 1], ("T T_1", "T_2"), strict=False)
        words |= {w: ("T", body) for body, own in warm for w in own.split() if w in letters}
        if field == "energy":
            states = (w for w, owner in self.states.items() if stem(owner) == stem(name))
            words |= {state: self.words[state] for state in states}
        words |= {"T_e": ("u", entry["input"])} if "T_e" in letters else {}
        for role, letter in zip("zr", (x for x in letters if x[0] != "T"), strict=False):
            words[letter] = ("x" if stored else role, name)
            self.units[words[letter]] = unit(letters[letter])[1]
        law = self._resolved(entry[field], words)
        self.faults += faults(law, self.units, unit(ratio or needed)[1], f"elements.{name}")
        return law

    def _conditions(self, initial: Mapping[str, tuple[Node, ...]]) -> Iterator[Node]:
        """Yield the assumptions of the spec, the requirements of its kinds, and widths >= 0."""
        table, trees = self.tables["domain"], [tree for own in initial.values() for tree in own]
        need(set(table) <= {"assume"}, "the domain has a wrong key")
        for text in table.get("assume", []):
            trees.append(self._resolved(text, self.words, compares=True))
            self.faults += faults(trees[-1], self.units, None, f"domain.assume {text!r}")
            yield trees[-1]
        for element in self.elements.values():
            trees += element.laws.values()
            first = element.laws.get(next(iter(element.kind.laws), ""))
            sized = element.costate and "energy" not in element.laws
            if first and sized and element.name not in self.quotients:
                own = [sym(symbol) for symbol in symbols(first) if symbol[0] == "p"]
                sizes = own if element.kind.form == "body" else [first]
                yield from (compare(tree, ">") for tree in sizes)
            yield from self.quotients.get(element.name, ())
            if limit := self.limits.get(element.name):
                words = {w: s for w, s in self.words.items() if s[0] == "p"}
                yield compare(self._resolved(limit, words), ">=")
        all_parts = (part for tree in trees for part in laws.walk(tree))
        for width in (p.args[1] for p in all_parts if p.op in ("deadzone", "saturate")):
            need(all(r not in "zr" for r, _ in symbols(width)), "a width has the letter of its law")
            yield compare(width, ">=")

    def _starts(self, state: str) -> tuple[Node, ...]:
        """Return the initial value of a state per lane: texts have units, numbers are in SI."""
        words = {word: meaning for word, meaning in self.words.items() if meaning[0] in "pu"}
        given, needed = self.tables["initial"][state], self.units["x", self.states[state]]
        trees, count = list[Node](), num(self.joined.get(self.states[state], 1))
        for start in given if isinstance(given, list) else [given]:
            text = isinstance(start, str)
            trees.append(self._resolved(start, words) if text else num(Fraction(start)))
            self.faults += faults(trees[-1], self.units, needed if text else None, "initial")
            trees[-1] = Node("*", (count, trees[-1]))
        return tuple(trees)

    def _lists(self, conditions: tuple[Node, ...]) -> dict[str, str]:
        """Return the bank of each list of values; raises if a condition mixes two banks."""
        banks, lists = {symbol: bank for symbol, (bank, _) in self.lanes.items()}, dict[str, str]()
        for name, values in self.parameters.items():
            if isinstance(self.tables["parameters"][name]["value"], list):
                own = [(e, law) for e in self.elements.values() for law in e.laws.values()]
                users = {e.lanes for e, law in own if ("p", name) in symbols(law)}
                bank, size = next(iter(users), None) or ("", 0)
                need(len(users) == 1 and size == len(values), f"parameters.{name} fits no bank")
                lists[name] = banks["p", name] = bank
        mixed = (len({banks[s] for s in symbols(tree) if s in banks}) > 1 for tree in conditions)
        need(not any(mixed), "a condition mixes lanes of two banks")
        return lists
