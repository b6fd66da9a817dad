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
from .kinds import GIVES, KINDS, LETTERS, REFERENCES, STATES, Kind
from .laws import InputError, Node, compare, made, need, num, parse, sym, symbols, walk
from .units import Dimension, check, unit

DOTTED = re.compile(r"(\s*\.\s*[\w\"'-]+){9}")
MAX_BYTES, MAX_ELEMENTS, MAX_COUNT = 500_000, 300, 1_000_000
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
    except (tomllib.TOMLDecodeError, RecursionError, ValueError) as error:
        raise InputError(f"not TOML: {str(error)[:100]}") from None
    need(not set(data) - set(TABLES), "the spec has an unknown table")
    return _Reader({name: _a(dict, data.get(name, {}), name) for name in TABLES}).spec()


def _a(kind: type, value: Any, where: str) -> Any:
    """Return a value of a type, a boolean being no number."""
    good = isinstance(value, kind) and isinstance(value, bool) == (kind is bool)
    need(good, f"{where} is no {kind.__name__}")
    return value


def _value(value: Any, where: str) -> Fraction:
    found = value if isinstance(value, Fraction) else Fraction(_a(int, value, where))
    need(abs(found) <= 10**300, f"{where} is too large")
    return found


class _Reader:
    """Reads the tables in an order in which each knows the names it may use."""

    def __init__(self, tables: dict[str, dict[str, Any]]) -> None:
        self.tables, self.faults, self.units = tables, list[str](), dict[Symbol, Dimension]()
        self.parameters = self._values("parameters", "value", "p")
        self.inputs = {n: v[0] for n, v in self._values("inputs", "default", "u").items()}
        raw = {name: _a(dict, e, f"elements.{name}") for name, e in tables["elements"].items()}
        need(0 < len(raw) <= MAX_ELEMENTS, f"{len(raw)} elements; 1 to {MAX_ELEMENTS} are read")
        self.kinds = {name: self._kind(name, entry) for name, entry in raw.items()}
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
        texts = {tree: text for text, tree in [*self._conditions()][::-1]}
        conditions = tuple((text, tree) for tree, text in texts.items())[::-1]
        lists, initial = dict(self._lists(conditions)), dict(self._initial())
        tables = (self.parameters, lists, self.inputs, self.elements, self.states, self.words)
        return Spec(*tables, conditions, initial, tuple(self.faults))

    def _values(self, table: str, field: str, role: str) -> dict[str, tuple[Fraction, ...]]:
        found = {}
        for name, entry in self.tables[table].items():
            where = f"{table}.{name}"
            unknown = set(_a(dict, entry, where)) - {field, "unit", "doc"}
            complete = not unknown and (field in entry or role == "u") and name.isidentifier()
            need(complete, f"{where} has a wrong key, or no name")
            given = entry.get(field, 0)
            scale = unit(_a(str, entry.get("unit"), f"{where}.unit"))
            values = given if isinstance(given, list) and given and role == "p" else [given]
            found[name] = tuple(_value(v, where) * scale.factor for v in values)
            self.units[role, name] = scale.dimension
        return found

    def _kind(self, name: str, entry: dict[str, Any]) -> Kind:
        kind = KINDS.get(str(entry.get("kind")))
        if kind is None or not name.isidentifier():
            raise InputError(f"elements.{name[:60]}: unknown kind, or no name")
        fields = {"kind", *kind.nodes, *kind.laws, *kind.others}
        needed = {field for field in fields if not field.endswith("?")}
        unknown = set(entry) - {field.rstrip("?") for field in fields}
        need(not unknown and needed <= set(entry), f"elements.{name} has a wrong key")
        return kind

    def _words(self, raw: dict[str, dict[str, Any]]) -> dict[str, Symbol]:
        """Return what each name of the domain means; a name has one meaning."""
        words, found = dict[str, Symbol](), [(n, ("p", n)) for n in self.parameters]
        found += [(n, ("u", n)) for n in self.inputs]
        for name, kind in self.kinds.items():
            for letter in (s for _, own in kind.laws.values() for s in own if s in STATES):
                state = raw[name].get("state", f"{letter}_{name}")
                found.append((_a(str, state, f"elements.{name}.state"), ("x", name)))
                self.units["x", name] = unit(LETTERS[letter]).dimension
        heat = {("T" if len(self.bodies) == 1 else f"T_{n}"): ("T", n) for n in self.bodies}
        self.units |= dict.fromkeys(heat.values(), unit("K").dimension)
        for word, meaning in found:
            need(word not in words and word not in heat, f"{word[:60]!r} is taken")
            words[word] = meaning
        return words | heat

    def _resolved(self, tree: Node, words: Mapping[str, Symbol], where: str) -> Node:
        for name in symbols(tree):
            need(name in words, f"{where}: unknown name {str(name)[:60]!r}")
        return laws.replaced(tree, lambda name: sym(words[name]))

    # Elements

    def _element(self, name: str, entry: dict[str, Any]) -> Element:
        kind, where = self.kinds[name], f"elements.{name}"
        bodies = self._bodies_of(entry, kind, where)
        fields = {field.rstrip("?"): law for field, law in kind.laws.items()}
        laws = {f: self._law(entry[f], name, bodies, *fields[f]) for f in fields if f in entry}
        source, count = _a(str, entry.get("input", ""), where), entry.get("count")
        if "input" in kind.others:
            need(source in self.inputs, f"{where}: {source[:60]!r} is no input")
            row = GIVES[kind.domains, kind.across] if kind.form == "source" else "K"
            fits = self.units["u", source] == unit(row).dimension
            self.faults += [] if fits else [f"{where}.input is not in {row}"]
        if count is not None:
            need(1 <= _a(int, count, where) <= MAX_COUNT, f"{where}.count is out of range")
        need(kind.form != "law" or len(laws) == 1, f"{where} needs exactly one law")
        field, dissipates = next(reversed(laws), ""), kind.form in ("law", "hysteron")
        parts = {"rest": num(0), **laws, "x": sym(("x", name))}
        costate = made(kind.costate, **parts) if kind.costate else None
        law, letter = (laws[field], fields[field][1][0]) if dissipates else (None, "")
        pairs = tuple(self._pair(entry[key], f"{where}.{key}") for key in kind.nodes)
        across = kind.across and (kind.form != "law" or field in ("voltage", "velocity"))
        jumps = _a(bool, entry.get("discontinuous", False), where)
        state = next((word for word, owner in self.states.items() if owner == name), "")
        given = (pairs, across, bodies, source, count, jumps)
        return Element(name, kind, laws, state, costate, law, letter, *given)

    def _law(self, text: Any, name: str, bodies: Any, needed: str, letters: Any) -> Node:
        words: dict[str, Symbol] = {p: ("p", p) for p in self.parameters}
        across = GIVES.get((self.kinds[name].domains, True), "1")
        for letter in letters:
            if letter == "T":
                owner = bodies or (tuple(self.bodies) if len(self.bodies) == 1 else ())
                words |= dict(zip("T", [("T", body) for body in owner], strict=False))
                continue
            words[letter] = ("x" if letter in STATES else "z", name)
            self.units[words[letter]] = unit(LETTERS.get(letter, across)).dimension
        law = self._resolved(parse(text, compares=False), words, f"elements.{name}")
        self.faults += check(law, self.units, unit(needed).dimension, f"elements.{name}")
        return law

    def _bodies_of(self, entry: dict[str, Any], kind: Kind, where: str) -> tuple[str, ...]:
        fields = ("heats", "body", "temperature") if kind.form != "body" else ()
        given = [entry[field] for field in fields if field in entry]
        if kind.form == "conduction":
            given = _a(list, entry["between"], where)
            need(len(given) == 2 and given[0] != given[1], f"{where} names no two bodies")
        need(all(b in self.bodies for b in given), f"{where} names what is no thermal_mass")
        return tuple(given)

    def _pair(self, value: Any, where: str) -> tuple[str, str]:
        pair = [value, "wall"] if where.endswith(".at") else _a(list, value, where)
        good = len(pair) == 2 and pair[0] != pair[1] and all(isinstance(n, str) for n in pair)
        need(good, f"{where} is no pair of nodes")
        return pair[0], pair[1]

    # The domain, and where a run starts

    def _conditions(self) -> Iterator[tuple[str, Node]]:
        table = self.tables["domain"]
        need(not set(table) - {"assume"}, "the domain has a wrong key")
        places = []
        for text in _a(list, table.get("assume", []), "domain.assume"):
            tree = self._resolved(parse(text, compares=True), self.words, "domain.assume")
            self.faults += check(tree, self.units, None, f"domain.assume {text!r}")
            places.append((text, tree))
        yield from places
        for name, element in self.elements.items():
            first = next(iter(element.laws.values()), num(1))
            body = [sym(symbol) for symbol in symbols(first) if symbol[0] == "p"]
            for required in (
                body if element.kind.form == "body" else [first] * bool(element.costate)
            ):
                yield f"{name}: its kind requires > 0", compare(required, ">")
            places += [(name, law) for law in element.laws.values()]
        places += [(f"initial.{n}", tree) for n, starts in self._initial() for tree in starts]
        for where, tree in places:
            for width in (n.args[1] for n in walk(tree) if n.op in ("deadzone", "saturate")):
                if width.op != "num" or width.value < 0:
                    given = any(role == "z" for role, _ in symbols(width))
                    need(not given, f"{where}: a width depends on the law's letter")
                    yield f"{where}: a width is >= 0", compare(width, ">=")

    def _initial(self) -> Iterator[tuple[str, tuple[Node, ...]]]:
        for state, given in self.tables["initial"].items():
            where, owner = f"initial.{state}", self.states.get(state, "")
            need(owner in self.elements, f"{where}: no such state")
            fits = not isinstance(given, list) or len(given) == self.elements[owner].lanes
            need(fits, f"{where} has a list of another length")
            starts = given if isinstance(given, list) else [given]
            yield owner, tuple(self._start(start, where, owner) for start in starts)

    def _start(self, given: Any, where: str, owner: str) -> Node:
        if not isinstance(given, str):
            return num(_value(given, where))
        words = {word: meaning for word, meaning in self.words.items() if meaning[0] in "pu"}
        tree = self._resolved(parse(given, compares=False), words, where)
        self.faults += check(tree, self.units, self.units["x", owner], where)
        return tree

    def _lists(self, conditions: tuple[tuple[str, Node], ...]) -> Iterator[tuple[str, str]]:
        """Yield the bank of each list; refuse those that are not of one bank's laws alone."""
        owner: dict[Symbol, str] = {("x", n): n for n, e in self.elements.items() if e.lanes}
        for name, values in self.parameters.items():
            if isinstance(self.tables["parameters"][name]["value"], list):
                laws = [(e, law) for e in self.elements.values() for law in e.laws.values()]
                users = {e.name: e.lanes for e, law in laws if ("p", name) in symbols(law)}
                good = [*users.values()] == [len(values)]
                need(good, f"parameters.{name}: a list, but no bank of its length")
                owner["p", name] = next(iter(users))
                yield name, owner["p", name]
        for text, tree in conditions:
            banks = {owner[symbol] for symbol in symbols(tree) if symbol in owner}
            need(len(banks) < 2, f"{text!r} mixes lanes of two banks")
