"""A spec's text to what the checker knows of it, by a reader that shares nothing with the package.

Input: TOML.  Output: a `Spec`: elements with their laws in symbols that have an owner, the whole
domain (what the spec assumes, what kinds require, widths that are not negative), values in SI.
Symbols are pairs: ("p", parameter), ("u", input), ("x", element) its state, ("z", element) the
letter of its dissipative law, ("T", body).
"""

import re
import tomllib
from collections.abc import Iterator, Mapping
from fractions import Fraction
from typing import Any, NamedTuple

from . import laws
from .field import Field
from .kinds import GIVES, KINDS, LETTERS, REFERENCES, STATES, Kind
from .laws import InputError, Node, compare, made, need, num, parse, put, sym, symbols, walk
from .units import Dimension, check, unit

DOTTED = re.compile(r"(\s*\.\s*[\w\"'-]+){9}")
MAX_BYTES = 500_000
TABLES = ("model", "parameters", "inputs", "domain", "initial", "elements")
Symbol = tuple[str, str]


class Element(NamedTuple):
    """An element: its kind, its laws in symbols, its branches.

    `costate` is dU/dx of a store or body, `law` that of a dissipative element and `letter` what the
    law calls its variable; `across` is whether what it imposes is an across variable; `bodies` are
    the body it heats or reads T of, or both of a conduction.
    """

    name: str
    kind: Kind
    laws: Mapping[str, Node]
    state: str
    costate: Node | None
    law: Node | None
    letter: str
    pairs: tuple[tuple[str, str], ...]
    across: bool
    bodies: tuple[str, ...]
    input: str
    lanes: int | None
    jumps: bool


class Spec(NamedTuple):
    """What a spec says; `conditions` are (text, comparison) pairs, `initial` is by element.

    `words` is what the names of [domain] mean, `lists` the parameters with one value per lane and
    their banks, `faults` what is wrong with its units.
    """

    parameters: Mapping[str, tuple[Fraction, ...]]
    lists: Mapping[str, str]
    inputs: Mapping[str, Fraction]
    elements: Mapping[str, Element]
    states: Mapping[str, str]
    words: Mapping[str, Symbol]
    conditions: tuple[tuple[str, Node], ...]
    initial: Mapping[str, tuple[Node, ...]]
    faults: tuple[str, ...]

    def of(self, *forms: str) -> Iterator[Element]:
        """Yield the elements of some forms, in order."""
        return (e for e in self.elements.values() if e.kind.form in forms)


def read_spec(text: str) -> Spec:
    """Return what a spec says; raises `InputError` if it is none that the checker knows."""
    small = len(text) <= MAX_BYTES and not DOTTED.search(text)
    need(small, "the spec is too large, or nested too deeply")
    try:
        data = tomllib.loads(text, parse_float=laws.number)
        need(set(data) <= set(TABLES), "the spec has an unknown table")
        return _Reader({name: dict(data.get(name, {})) for name in TABLES}).spec()
    except (RecursionError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise InputError(f"the spec cannot be read: {str(error)[:100]}") from None


class _Reader:
    """Reads the tables in an order in which each knows the names it may use."""

    def __init__(self, tables: dict[str, dict[str, Any]]) -> None:
        self.tables, self.faults, self.units = tables, list[str](), dict[Symbol, Dimension]()
        self.parameters = self._values("parameters", "value", "p")
        self.inputs = {n: v[0] for n, v in self._values("inputs", "default", "u").items()}
        raw = tables["elements"]
        need(bool(raw), "no elements")
        self.kinds = {name: KINDS[entry["kind"]] for name, entry in raw.items()}
        self.bodies = [name for name, kind in self.kinds.items() if kind.form == "body"]
        self.words = self._words(raw)
        self.states = {word: owner for word, (role, owner) in self.words.items() if role == "x"}
        self.elements = {name: self._element(name, entry) for name, entry in raw.items()}

    def spec(self) -> Spec:
        domains = dict(REFERENCES)
        for element in self.elements.values():
            for pair, own in zip(element.pairs, element.kind.domains, strict=True):
                same = all(domains.setdefault(node, own) == own for node in pair)
                need(same, f"a node of {element.name} is in two domains")
        initial = dict(self._initial())
        texts = {tree: text for text, tree in [*self._conditions(initial)][::-1]}
        conditions = tuple((text, tree) for tree, text in texts.items())[::-1]
        lists = dict(self._lists([tree for _, tree in conditions]))
        tables = (self.parameters, lists, self.inputs, self.elements, self.states, self.words)
        return Spec(*tables, conditions, initial, tuple(self.faults))

    def _values(self, table: str, field: str, role: str) -> dict[str, tuple[Fraction, ...]]:
        found = {}
        for name, entry in self.tables[table].items():
            complete = set(entry) <= {field, "unit", "doc"} and (field in entry or role == "u")
            need(complete and name.isidentifier(), f"{table}.{name} has a wrong key, or no name")
            given, scale = entry.get(field, 0), unit(entry["unit"])
            values = given if isinstance(given, list) and given and role == "p" else [given]
            found[name] = tuple(Fraction(value) * scale.factor for value in values)
            self.units[role, name] = scale.dimension
        return found

    def _words(self, raw: dict[str, dict[str, Any]]) -> dict[str, Symbol]:
        found = [(name, ("p", name)) for name in self.parameters]
        found += [(name, ("u", name)) for name in self.inputs]
        for name, kind in self.kinds.items():
            for letter in (s for _, own in kind.laws.values() for s in own if s in STATES):
                found.append((raw[name].get("state", f"{letter}_{name}"), ("x", name)))
                self.units["x", name] = unit(LETTERS[letter]).dimension
        one = len(self.bodies) == 1
        found += [("T" if one else f"T_{name}", ("T", name)) for name in self.bodies]
        self.units |= {("T", name): unit("K").dimension for name in self.bodies}
        need(len(dict(found)) == len(found), "a name has two meanings")
        return dict(found)

    def _resolved(self, text: Any, words: Mapping[str, Symbol], compares: bool) -> Node:
        tree = parse(text, compares=compares)
        for part in tree.args if compares else (tree,):
            Field().of(part)  # refuses what is too large to be written out
        unknown = [str(name)[:60] for name in symbols(tree) if name not in words]
        need(not unknown, f"{text[:60]!r} has unknown names: {', '.join(unknown)}")
        return put(tree, {name: sym(words[name]) for name in symbols(tree)})

    # Elements

    def _element(self, name: str, entry: dict[str, Any]) -> Element:
        kind, where = self.kinds[name], f"elements.{name[:60]}"
        fields = {"kind", *kind.nodes, *kind.laws, *kind.others}
        needed = {field for field in fields if not field.endswith("?")}
        known = needed <= set(entry) <= {field.rstrip("?") for field in fields}
        need(known and name.isidentifier(), f"{where} has a wrong key, or no name")
        heats = [entry[field] for field in ("heats", "body", "temperature") if field in entry]
        bodies = tuple(entry["between"] if kind.form == "conduction" else heats)
        bodies = () if kind.form == "body" else bodies
        good = set(bodies) <= set(self.bodies) and len(set(bodies)) == len(bodies)
        need(good, f"{where} names what is no thermal_mass")
        table = {field.rstrip("?"): law for field, law in kind.laws.items()}
        own = {f: self._law(entry[f], name, bodies, *table[f]) for f in table if f in entry}
        need(kind.form != "law" or len(own) == 1, f"{where} needs exactly one law")
        field, dissipates = next(reversed(own), ""), kind.form in ("law", "hysteron")
        parts = {"rest": num(0), **own, "x": sym(("x", name))}
        costate = made(kind.costate, **parts) if kind.costate else None
        law, letter = (own[field], table[field][1][0]) if dissipates else (None, "")
        across = kind.across and (kind.form != "law" or field in ("voltage", "velocity"))
        source, count = entry.get("input", ""), entry.get("count")
        need(count is None or count >= 1, f"{where}.count is out of range")
        if "input" in kind.others:
            row = GIVES[kind.domains, kind.across] if kind.form == "source" else "K"
            fits = self.units["u", source] == unit(row).dimension
            self.faults += [] if fits else [f"{where}.input is not in {row}"]
        pairs = tuple(self._pair(entry[key], key == "at") for key in kind.nodes)
        state = next((word for word, owner in self.states.items() if owner == name), "")
        jumps = entry.get("discontinuous", False)
        given = (pairs, across, bodies, source, count, jumps)
        return Element(name, kind, own, state, costate, law, letter, *given)

    def _law(self, text: Any, name: str, bodies: Any, needed: str, letters: Any) -> Node:
        words: dict[str, Symbol] = {p: ("p", p) for p in self.parameters}
        across = GIVES.get((self.kinds[name].domains, True), "1")
        for letter in letters:
            if letter == "T":
                owner = bodies or (self.bodies if len(self.bodies) == 1 else ())
                words |= dict([("T", ("T", body)) for body in owner][:1])
                continue
            words[letter] = ("x" if letter in STATES else "z", name)
            self.units[words[letter]] = unit(LETTERS.get(letter, across)).dimension
        law = self._resolved(text, words, compares=False)
        self.faults += check(law, self.units, unit(needed).dimension, f"elements.{name}")
        return law

    def _pair(self, value: Any, at: bool) -> tuple[str, str]:
        first, second = (value, "wall") if at else value
        need(first != second and isinstance(first + second, str), "no pair of nodes")
        return first, second

    # The domain, and where a run starts

    def _conditions(self, initial: Mapping[str, tuple[Node, ...]]) -> Iterator[tuple[str, Node]]:
        table, places = self.tables["domain"], list[tuple[str, Node]]()
        need(set(table) <= {"assume"}, "the domain has a wrong key")
        for text in table.get("assume", []):
            places.append((text, self._resolved(text, self.words, compares=True)))
            self.faults += check(places[-1][1], self.units, None, f"domain.assume {text!r}")
        yield from places
        for name, element in self.elements.items():
            first = next(iter(element.laws.values()), num(1))
            own = [sym(symbol) for symbol in symbols(first) if symbol[0] == "p"]
            for tree in own if element.kind.form == "body" else [first] * bool(element.costate):
                yield f"{name}: its kind requires > 0", compare(tree, ">")
            places += [(name, law) for law in element.laws.values()]
        places += [(f"initial.{name}", tree) for name, starts in initial.items() for tree in starts]
        for where, part in ((where, part) for where, tree in places for part in walk(tree)):
            if part.op in ("deadzone", "saturate"):
                given = any(role == "z" for role, _ in symbols(part.args[1]))
                need(not given, f"{where}: a width depends on the law's letter")
                yield f"{where}: a width is >= 0", compare(part.args[1], ">=")

    def _initial(self) -> Iterator[tuple[str, tuple[Node, ...]]]:
        words = {word: meaning for word, meaning in self.words.items() if meaning[0] in "pu"}
        for state, given in self.tables["initial"].items():
            owner, starts = self.states[state], given if isinstance(given, list) else [given]
            trees = list[Node]()
            for start in starts:
                text = isinstance(start, str)
                trees.append(self._resolved(start, words, False) if text else num(Fraction(start)))
                needed = self.units["x", owner] if text else None
                self.faults += check(trees[-1], self.units, needed, "initial")
            yield owner, tuple(trees)

    def _lists(self, conditions: list[Node]) -> Iterator[tuple[str, str]]:
        owner: dict[Symbol, str] = {("x", n): n for n, e in self.elements.items() if e.lanes}
        for name, values in self.parameters.items():
            if isinstance(self.tables["parameters"][name]["value"], list):
                own = [(e, law) for e in self.elements.values() for law in e.laws.values()]
                users = {e.name: e.lanes for e, law in own if ("p", name) in symbols(law)}
                good = [*users.values()] == [len(values)]
                need(good, f"parameters.{name}: a list, but no bank of its length")
                owner["p", name] = next(iter(users))
                yield name, owner["p", name]
        for tree in conditions:
            banks = {owner[symbol] for symbol in symbols(tree) if symbol in owner}
            need(len(banks) < 2, "a condition mixes lanes of two banks")
