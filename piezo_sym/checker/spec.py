"""A spec's text to what the checker knows of it, by a reader that shares nothing with the package.

Input: TOML.  Output: a `Spec`: elements with their laws in symbols that have an owner, the whole
domain (what the spec assumes, what kinds require, widths that are not negative), values in SI.
Symbols are pairs: ("p", parameter), ("u", input), ("x", element) its state, ("z", element) the
letter of its dissipative law, ("T", body).
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Mapping
from fractions import Fraction
from typing import Any, NamedTuple

from .kinds import GIVES, KINDS, LETTERS, REFERENCES, STATES, Kind
from .laws import FUNCTIONS, InputError, Node, compare, minus, num, number, parse, parse_law
from .laws import replaced, sym, symbols, walk
from .units import Dimension, check, unit

NAME = re.compile(r"[A-Za-z](?:[A-Za-z0-9_]*[A-Za-z0-9])?")
NODE = re.compile(r"[A-Za-z0-9_.+-]{1,40}")
MAX_BYTES, MAX_NESTING, MAX_DOTS, MAX_ELEMENTS, MAX_COUNT = 500_000, 20, 8, 300, 1_000_000
RESERVED = {"i", "v", "f", "T", "np", "if", "else", "sum", *FUNCTIONS}
TABLES = ("model", "parameters", "inputs", "domain", "initial", "elements")
Symbol = tuple[str, str]


class Element(NamedTuple):
    """An element: its kind, its laws in symbols, its branches.

    Attributes
    ----------
    laws : by field; `costate` is dU/dx of a store or body, `law` that of a dissipative element.
    pairs : the nodes of its branch, or of both of a coupling.
    across : whether what it imposes (co-state, W or input) is an across variable.
    bodies : the body it heats, or reads T of; both of a conduction.
    """

    name: str
    kind: Kind
    laws: Mapping[str, Node]
    state: str
    costate: Node | None
    law: Node | None
    pairs: tuple[tuple[str, str], ...]
    across: bool
    bodies: tuple[str, ...]
    input: str
    count: int | None
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
    """Return what a spec says.

    Raises
    ------
    InputError
        If it is no spec that the checker knows; one line says why.
    """
    data = _toml(text)
    _need(not set(data) - set(TABLES), "the spec has an unknown table")
    return _Reader({name: _a(dict, data.get(name, {}), name) for name in TABLES}).spec()


def _toml(text: str) -> dict[str, Any]:
    bare = re.sub(r'"(?:\\.|[^"\\\n])*"|\'[^\'\n]*\'|#[^\n]*', "", text[: MAX_BYTES + 1])
    depth = deepest = 0
    for c in bare:
        depth += (c in "[{") - (c in "]}")
        deepest = max(deepest, depth)
    dots = max(part.count(".") for part in re.split(r"[=,{}\[\]\n]", bare))
    _need(len(text) <= MAX_BYTES, "the spec is too large")
    _need(deepest <= MAX_NESTING and dots <= MAX_DOTS, "the spec is nested too deeply")
    try:
        return tomllib.loads(text, parse_float=number)
    except (tomllib.TOMLDecodeError, RecursionError, ValueError) as error:
        raise InputError(f"not TOML: {str(error)[:100]}") from None


def _need(good: bool, reason: str) -> None:
    if not good:
        raise InputError(reason)


def _a(kind: type, value: Any, where: str) -> Any:
    """Return a value of a type, a boolean being no number."""
    good = isinstance(value, kind) and isinstance(value, bool) == (kind is bool)
    _need(good, f"{where} is no {kind.__name__}")
    return value


def _value(value: Any, where: str) -> Fraction:
    found = value if isinstance(value, Fraction) else Fraction(_a(int, value, where))
    _need(abs(found) <= 10**300, f"{where} is too large")
    return found


class _Reader:
    """Reads the tables in an order in which each knows the names it may use."""

    def __init__(self, tables: dict[str, dict[str, Any]]) -> None:
        self.tables, self.faults, self.units = tables, list[str](), dict[Symbol, Dimension]()
        self.parameters = self._values("parameters", "value", "p")
        self.inputs = {n: v[0] for n, v in self._values("inputs", "default", "u").items()}
        raw = {name: _a(dict, e, f"elements.{name}") for name, e in tables["elements"].items()}
        _need(0 < len(raw) <= MAX_ELEMENTS, f"{len(raw)} elements; 1 to {MAX_ELEMENTS} are read")
        self.kinds = {name: self._kind(name, entry) for name, entry in raw.items()}
        self.bodies = [name for name, kind in self.kinds.items() if kind.form == "body"]
        self.words = self._words(raw)
        self.states = {word: owner for word, (role, owner) in self.words.items() if role == "x"}
        self.elements = {name: self._element(name, entry) for name, entry in raw.items()}

    def spec(self) -> Spec:
        """Return what was read, with domain and starts."""
        domains = dict(REFERENCES)
        for element in self.elements.values():
            for pair, domain in zip(element.pairs, element.kind.domains, strict=True):
                for node in pair:
                    good = domains.setdefault(node, domain) == domain
                    _need(good, f"node {node!r} is in two domains")
        conditions = tuple({tree: text for text, tree in self._conditions()}.items())
        made = tuple((text, tree) for tree, text in conditions)
        lists, initial = dict(self._lists(made)), dict(self._initial())
        tables = (self.parameters, lists, self.inputs, self.elements, self.states, self.words)
        return Spec(*tables, made, initial, tuple(self.faults))

    def _values(self, table: str, field: str, role: str) -> dict[str, tuple[Fraction, ...]]:
        found = {}
        for name, entry in self.tables[table].items():
            where = f"{table}.{name}"
            unknown = set(_a(dict, entry, where)) - {field, "unit", "doc"}
            _need(not unknown and (field in entry or role == "u"), f"{where} has a wrong key")
            given = entry.get(field, 0)
            scale = unit(_a(str, entry.get("unit"), f"{where}.unit"))
            values = given if isinstance(given, list) and given and role == "p" else [given]
            found[name] = tuple(_value(v, where) * scale.factor for v in values)
            self.units[role, name] = scale.dimension
        return found

    def _kind(self, name: str, entry: dict[str, Any]) -> Kind:
        kind = KINDS.get(str(entry.get("kind")))
        if kind is None or not NAME.fullmatch(name):
            raise InputError(f"elements.{name[:60]}: unknown kind, or no name")
        fields = {"kind", *kind.nodes, *kind.laws, *kind.others}
        needed = {field for field in fields if not field.endswith("?")}
        unknown = set(entry) - {field.rstrip("?") for field in fields}
        _need(not unknown and needed <= set(entry), f"elements.{name} has a wrong key")
        return kind

    def _words(self, raw: dict[str, dict[str, Any]]) -> dict[str, Symbol]:
        """Return what each name of the domain means; a name has one meaning."""
        one, words = len(self.bodies) == 1, dict[str, Symbol]()
        found: list[tuple[str, Symbol]] = [(name, ("p", name)) for name in self.parameters]
        found += [(name, ("u", name)) for name in self.inputs]
        for name, entry in raw.items():
            if letter := STATES.get(entry["kind"]):
                state = _a(str, entry.get("state", f"{letter}_{name}"), f"elements.{name}.state")
                found.append((state, ("x", name)))
                self.units["x", name] = unit(LETTERS[letter]).dimension
        heat = {("T" if one else f"T_{name}"): ("T", name) for name in self.bodies}
        self.units |= dict.fromkeys(heat.values(), unit("K").dimension)
        for word, meaning in found:
            taken = word in words or word in heat or word in RESERVED
            _need(not taken and bool(NAME.fullmatch(word)), f"{word[:60]!r} is taken, or no name")
            words[word] = meaning
        return words | heat

    def _resolved(self, tree: Node, words: Mapping[str, Symbol], where: str) -> Node:
        for name in symbols(tree):
            _need(name in words, f"{where}: unknown name {str(name)[:60]!r}")
        return replaced(tree, lambda name: sym(words[name]))

    # Elements

    def _element(self, name: str, entry: dict[str, Any]) -> Element:
        kind, where = self.kinds[name], f"elements.{name}"
        bodies = self._bodies_of(entry, kind, where)
        laws = {
            field.rstrip("?"): self._law(entry[field.rstrip("?")], name, bodies, letters, needed)
            for field, (needed, letters) in kind.laws.items()
            if field.rstrip("?") in entry
        }
        source, count = _a(str, entry.get("input", ""), where), entry.get("count")
        if "input" in kind.others:
            _need(source in self.inputs, f"{where}: {source[:60]!r} is no input")
            given = GIVES[kind.domains, kind.across] if kind.form == "source" else "K"
            fits = self.units["u", source] == unit(given).dimension
            self.faults += [] if fits else [f"{where}.input is not in {given}"]
        if count is not None:
            _need(1 <= _a(int, count, where) <= MAX_COUNT, f"{where}.count is out of range")
        _need(kind.form != "law" or len(laws) == 1, f"{where} needs exactly one law")
        field = next(reversed(laws), "")
        pairs = tuple(self._pair(entry[key], f"{where}.{key}") for key in kind.nodes)
        return Element(
            name=name,
            kind=kind,
            laws=laws,
            state=next((word for word, meaning in self.words.items() if meaning == ("x", name)), ""),
            costate=_costate(entry["kind"], laws, name),
            law=laws[field] if kind.form in ("law", "hysteron") else None,
            pairs=pairs,
            across=kind.across and (kind.form != "law" or field in ("voltage", "velocity")),
            bodies=bodies,
            input=source,
            count=count,
            jumps=_a(bool, entry.get("discontinuous", False), where),
        )

    def _law(
        self, text: Any, name: str, bodies: tuple[str, ...], letters: str, needed: str
    ) -> Node:
        words: dict[str, Symbol] = {p: ("p", p) for p in self.parameters}
        across = "V" if "E" in self.kinds[name].domains else "m/s"
        for letter in letters.split():
            if letter == "T":
                owner = bodies or (tuple(self.bodies) if len(self.bodies) == 1 else ())
                words |= {"T": ("T", body) for body in owner[:1]}
                continue
            words[letter] = ("x" if letter in STATES.values() else "z", name)
            self.units[words[letter]] = unit(LETTERS.get(letter, across)).dimension
        made = self._resolved(parse_law(text), words, f"elements.{name}")
        self.faults += check(made, self.units, unit(needed).dimension, f"elements.{name}")
        return made

    def _bodies_of(self, entry: dict[str, Any], kind: Kind, where: str) -> tuple[str, ...]:
        given = [entry[f] for f in ("heats", "temperature", "body") if f in entry]
        if kind.form == "conduction":
            given = _a(list, entry["between"], where)
            _need(len(given) == 2 and given[0] != given[1], f"{where} names no two bodies")
        given = [] if kind.form == "body" else given
        _need(all(b in self.bodies for b in given), f"{where} names what is no thermal_mass")
        return tuple(given)

    def _pair(self, value: Any, where: str) -> tuple[str, str]:
        pair = [value, "wall"] if where.endswith(".at") else _a(list, value, where)
        named = all(isinstance(node, str) and NODE.fullmatch(node) for node in pair)
        _need(named and len(pair) == 2 and pair[0] != pair[1], f"{where} is no pair of nodes")
        return pair[0], pair[1]

    # The domain, and where a run starts

    def _conditions(self) -> Iterator[tuple[str, Node]]:
        table = self.tables["domain"]
        _need(not set(table) - {"assume"}, "the domain has a wrong key")
        made = []
        for text in _a(list, table.get("assume", []), "domain.assume"):
            tree = self._resolved(parse(text), self.words, "domain.assume")
            _need(tree.op == "cmp", f"{str(text)[:60]!r} is no comparison")
            self.faults += check(tree, self.units, None, f"domain.assume {text!r}")
            made.append((text, tree))
        yield from made
        for name, element in self.elements.items():
            for required in _required(element):
                yield f"{name}: its kind requires > 0", compare(required, ">", 0)
            made += [(name, law) for law in element.laws.values()]
        for where, tree in made:
            for width in _widths(tree):
                given = any(role == "z" for role, _ in symbols(width))
                _need(not given, f"{where}: a width depends on the law's letter")
                yield f"{where}: a width is >= 0", compare(width, ">=", 0)

    def _initial(self) -> Iterator[tuple[str, tuple[Node, ...]]]:
        words = {word: meaning for word, meaning in self.words.items() if meaning[0] in "pu"}
        for state, given in self.tables["initial"].items():
            where, owner = f"initial.{state}", self.states.get(state, "")
            _need(owner in self.elements, f"{where}: no such state")
            count = self.elements[owner].count
            listed = isinstance(given, list)
            _need(not listed or len(given) == count, f"{where} has a list of another length")
            made = []
            for value in given if listed else [given]:
                if not isinstance(value, str):
                    made.append(num(_value(value, where)))
                    continue
                made.append(self._resolved(parse_law(value), words, where))
                self.faults += check(made[-1], self.units, self.units["x", owner], where)
            yield owner, tuple(made)

    def _lists(self, conditions: tuple[tuple[str, Node], ...]) -> Iterator[tuple[str, str]]:
        """Yield the bank of each list; refuse those that are not of one bank's laws alone."""
        used = {
            name: {s for law in e.laws.values() for s in symbols(law)}
            for name, e in self.elements.items()
        }
        owner: dict[Symbol, str] = {("x", n): n for n, e in self.elements.items() if e.count}
        for name, values in self.parameters.items():
            if isinstance(self.tables["parameters"][name]["value"], list):
                users = [user for user, own in used.items() if ("p", name) in own]
                count = self.elements[users[0]].count if len(users) == 1 else None
                _need(count == len(values), f"parameters.{name}: a list, but no bank of its length")
                owner["p", name] = users[0]
                yield name, users[0]
        for text, tree in conditions:
            banks = {owner[symbol] for symbol in symbols(tree) if symbol in owner}
            _need(len(banks) < 2, f"{text!r} mixes lanes of two banks")


def _costate(kind: str, laws: Mapping[str, Node], name: str) -> Node | None:
    """Return dU/dx of a store or body as a law of its state."""
    if kind == "thermal_mass":
        return laws["temperature"]
    if kind == "spring":
        return Node("*", (laws["stiffness"], minus(sym(("x", name)), laws.get("rest", num(0)))))
    return Node("/", (sym(("x", name)), next(iter(laws.values())))) if kind in STATES else None


def _required(element: Element) -> Iterator[Node]:
    """Yield what an element's kind requires to be positive."""
    if element.kind.form == "body":
        yield from (sym(s) for s in symbols(element.laws["temperature"]) if s[0] == "p")
    elif element.costate:
        yield next(iter(element.laws.values()))


def _widths(tree: Node) -> Iterator[Node]:
    for node in walk(tree):
        if node.op in ("deadzone", "saturate"):
            width = node.args[1]
            if not (width.op == "num" and width.value >= 0):
                yield width
