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
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from .kinds import GIVES, KINDS, REFERENCES, STATES, UNITS, Kind
from .laws import (
    FUNCTIONS,
    InputError,
    Node,
    compare,
    num,
    number,
    parse,
    parse_condition,
    put,
    replaced,
    sym,
    symbols,
    walk,
)
from .units import Dimension, Unit, check, dimension_of, unit

NAME = re.compile(r"[A-Za-z](?:[A-Za-z0-9_]*[A-Za-z0-9])?")
NODE = re.compile(r"[A-Za-z0-9_.+-]{1,40}")
MAX_BYTES, MAX_NESTING, MAX_ELEMENTS, MAX_COUNT = 500_000, 20, 500, 1_000_000
RESERVED = {"i", "v", "f", "T", "np", "if", "else", "sum", *FUNCTIONS}
Symbol = tuple[str, str]


@dataclass(frozen=True)
class Element:
    """An element: its kind, its laws in symbols, its branches.

    Attributes
    ----------
    laws : by field; `costate` of a store or body, `law` of a dissipative element.
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


@dataclass(frozen=True)
class Spec:
    """What a spec says; `conditions` are (text, comparison) pairs, `initial` by element."""

    name: str
    parameters: Mapping[str, tuple[Fraction, ...]]
    lists: frozenset[str]
    inputs: Mapping[str, Fraction]
    elements: Mapping[str, Element]
    states: Mapping[str, str]
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
    known = {"model", "parameters", "inputs", "domain", "initial", "elements"}
    if unknown := set(data) - known:
        raise InputError(f"unknown table {sorted(unknown)[0]!r}")
    tables = {name: _table(data.get(name, {}), name) for name in known}
    return _Reader(tables).spec()


def _toml(text: str) -> dict[str, Any]:
    if len(text) > MAX_BYTES:
        raise InputError("the spec is too large")
    bare = re.sub(r'"(?:\\.|[^"\\\n])*"|\'[^\'\n]*\'|#[^\n]*', "", text)
    depth = deepest = 0
    for c in bare:
        depth += (c in "[{") - (c in "]}")
        deepest = max(deepest, depth)
    dots = max(part.count(".") for part in re.split(r"[=,{}\[\]\n]", bare))
    if deepest > MAX_NESTING or dots > 8:
        raise InputError("the spec is nested too deeply")
    try:
        return tomllib.loads(text, parse_float=number)
    except (tomllib.TOMLDecodeError, RecursionError, ValueError) as error:
        raise InputError(f"not TOML: {str(error)[:100]}") from None


def _table(value: Any, where: str) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise InputError(f"{where} is no table")
    return value


def _text(value: Any, where: str) -> str:
    if not isinstance(value, str):
        raise InputError(f"{where} is no text")
    return value


def _value(value: Any, where: str) -> Fraction:
    if isinstance(value, bool) or not isinstance(value, int | Fraction):
        raise InputError(f"{where} is no number")
    if abs(value) > 10**300:
        raise InputError(f"{where} is too large")
    return Fraction(value)


class _Reader:
    """Reads the tables in an order in which each knows the names it may use."""

    def __init__(self, tables: dict[str, dict[str, Any]]) -> None:
        self.tables, self.faults = tables, list[str]()
        self.units: dict[Symbol, Dimension] = {}
        self.parameters = dict(self._values("parameters", "value"))
        self.inputs = {n: v[0] for n, v in self._values("inputs", "default").items()}
        self.lists = {
            n for n, p in tables["parameters"].items() if isinstance(p.get("value"), list)
        }
        raw = {name: _table(e, f"elements.{name}") for name, e in tables["elements"].items()}
        if not raw or len(raw) > MAX_ELEMENTS:
            raise InputError(f"{len(raw)} elements; 1 to {MAX_ELEMENTS} are read")
        self.kinds = {name: self._kind(name, e) for name, e in raw.items()}
        self.bodies = [n for n, k in self.kinds.items() if k.form == "body"]
        self.states = self._states(raw)
        self.words = self._words()
        self.elements = {name: self._element(name, e) for name, e in raw.items()}

    def spec(self) -> Spec:
        """Return what was read, with domain and starts."""
        self._domains()
        conditions = tuple(dict.fromkeys(self._conditions()))
        initial = dict(self._initial())
        self._lane_lists(conditions)
        name = _text(self.tables["model"].get("name"), "model.name")
        return Spec(
            name,
            self.parameters,
            frozenset(self.lists),
            self.inputs,
            self.elements,
            self.states,
            conditions,
            initial,
            tuple(self.faults),
        )

    # Names and values

    def _values(self, table: str, field: str) -> dict[str, tuple[Fraction, ...]]:
        found = {}
        for name, entry in self.tables[table].items():
            where = f"{table}.{name}"
            _table(entry, where)
            if set(entry) - {field, "unit", "doc"} or (table == "parameters" and not entry):
                raise InputError(f"{where} has an unknown key")
            given = entry.get(field, 0 if table == "inputs" else None)
            values = given if isinstance(given, list) and given else [given]
            scale: Unit = unit(_text(entry.get("unit"), f"{where}.unit"))
            found[name] = tuple(_value(v, where) * scale.factor for v in values)
            self.units["p" if table == "parameters" else "u", name] = scale.dimension
        return found

    def _kind(self, name: str, entry: dict[str, Any]) -> Kind:
        kind = KINDS.get(_text(entry.get("kind"), f"elements.{name}.kind"))
        if kind is None or not NAME.fullmatch(name):
            raise InputError(f"elements.{name}: unknown kind, or no name")
        fields = (*kind.nodes, *kind.laws, *kind.others)
        needed = {field for field in fields if not field.endswith("?")} | {"kind"}
        if set(entry) - {field.rstrip("?") for field in fields} - {"kind"} or needed - set(entry):
            raise InputError(f"elements.{name} has an unknown or a missing key")
        return kind

    def _states(self, raw: dict[str, dict[str, Any]]) -> dict[str, str]:
        found: dict[str, str] = {}
        for name, entry in raw.items():
            letter = STATES.get(entry["kind"])
            if letter:
                symbol = _text(entry.get("state", f"{letter}_{name}"), f"elements.{name}.state")
                if symbol in found:
                    raise InputError(f"two states are called {symbol!r}")
                found[symbol] = name
                self.units["x", name] = dimension_of(UNITS[letter])
        return found

    def _words(self) -> dict[str, Symbol]:
        """Return what each name of the domain means; a name has one meaning."""
        one = len(self.bodies) == 1
        heat = {("T" if one else f"T_{name}"): ("T", name) for name in self.bodies}
        self.units |= dict.fromkeys(heat.values(), dimension_of("K"))
        groups: list[dict[str, Symbol]] = [
            {name: ("p", name) for name in self.parameters},
            {name: ("u", name) for name in self.inputs},
            {name: ("x", element) for name, element in self.states.items()},
        ]
        words: dict[str, Symbol] = {}
        for group in groups:
            for name, meaning in group.items():
                if name in words or name in heat or name in RESERVED or not NAME.fullmatch(name):
                    raise InputError(f"name {name[:60]!r} is taken, or no name")
                words[name] = meaning
        return words | heat

    def _resolved(self, tree: Node, words: Mapping[str, Symbol], where: str) -> Node:
        def change(name: Any) -> Node:
            if name not in words:
                raise InputError(f"{where}: unknown name {str(name)[:60]!r}")
            return sym(words[name])

        return replaced(tree, change)

    # Elements

    def _element(self, name: str, entry: dict[str, Any]) -> Element:
        kind, where = self.kinds[name], f"elements.{name}"
        bodies = self._bodies_of(entry, kind, where)
        laws = {}
        for field, (unit_text, letters) in kind.laws.items():
            field = field.rstrip("?")
            if field in entry:
                at = f"{where}.{field}"
                laws[field] = self._law(entry[field], name, letters, bodies, unit_text, at)
        law, across = _given(laws, kind)
        if kind.form == "resistor" and len(laws) != 1:
            raise InputError(f"{where} needs exactly one law")
        source = _text(entry.get("input", ""), where)
        if "input" in kind.others and source not in self.inputs:
            raise InputError(f"{where}: {source[:60]!r} is no input")
        if kind.form in ("source", "ambient"):
            given = GIVES[kind.domain[0], kind.across] if kind.form == "source" else "K"
            if self.units["u", source] != dimension_of(given):
                self.faults.append(f"{where}.input is not in {given}")
        count, jumps = entry.get("count"), entry.get("discontinuous", False)
        if count is not None and (isinstance(count, bool) or not isinstance(count, int)):
            raise InputError(f"{where}.count is no whole number")
        if not isinstance(jumps, bool) or (count is not None and not 1 <= count <= MAX_COUNT):
            raise InputError(f"{where}.count or .discontinuous is out of range")
        state = next((s for s, owner in self.states.items() if owner == name), "")
        return Element(
            name=name,
            kind=kind,
            laws=laws,
            state=state,
            costate=_costate(entry["kind"], laws, name),
            law=law,
            pairs=tuple(self._pair(entry[field], f"{where}.{field}") for field in kind.nodes),
            across=across,
            bodies=bodies,
            input=source,
            count=count,
            jumps=jumps,
        )

    def _law(
        self, text: Any, name: str, letters: str, bodies: tuple[str, ...], needed: str, where: str
    ) -> Node:
        tree = parse(text)
        words: dict[str, Symbol] = {p: ("p", p) for p in self.parameters}
        units = {symbol: self.units[symbol] for symbol in words.values()}
        for letter in letters.split():
            if letter == "T":
                owner = (bodies or tuple(self.bodies) if len(self.bodies) == 1 else bodies)[:1]
                words |= {"T": ("T", owner[0])} if owner else {}
                continue
            words[letter] = ("x" if letter in STATES.values() else "z", name)
            electrical = "electrical" in self.kinds[name].domain
            across = "V" if electrical else "m/s"
            units[words[letter]] = dimension_of(UNITS.get(letter, across))
        made = self._resolved(tree, words, where)
        self.faults += check(made, self.units | units, dimension_of(needed), where)
        return made

    def _bodies_of(self, entry: dict[str, Any], kind: Kind, where: str) -> tuple[str, ...]:
        given = [entry[f] for f in ("heats", "temperature", "body") if f.rstrip("?") in entry]
        if kind.form == "body":
            return ()
        if kind.form == "conduction":
            given = entry["between"] if isinstance(entry["between"], list) else []
            if len(given) != 2 or given[0] == given[1]:
                raise InputError(f"{where}.between names no two bodies")
        for body in given:
            if body not in self.bodies:
                raise InputError(f"{where}: {str(body)[:60]!r} is no thermal_mass")
        return tuple(given)

    def _pair(self, value: Any, where: str) -> tuple[str, str]:
        pair = [value, "wall"] if where.endswith(".at") else value
        if not isinstance(pair, list) or len(pair) != 2 or pair[0] == pair[1]:
            raise InputError(f"{where} is no pair of nodes")
        if not all(isinstance(node, str) and NODE.fullmatch(node) for node in pair):
            raise InputError(f"{where} names no nodes")
        return pair[0], pair[1]

    def _domains(self) -> None:
        """Refuse a node in two domains."""
        found = dict(REFERENCES)
        for element in self.elements.values():
            own = element.kind.domain
            for pair, domain in zip(element.pairs, own * len(element.pairs), strict=False):
                for node in pair:
                    if found.setdefault(node, domain) != domain:
                        raise InputError(f"node {node!r} is in two domains")

    # The domain, and where a run starts

    def _conditions(self) -> Iterator[tuple[str, Node]]:
        given = self.tables["domain"].get("assume", [])
        if set(self.tables["domain"]) - {"assume"} or not isinstance(given, list):
            raise InputError("domain.assume is no list")
        made = []
        for text in given:
            tree = self._resolved(parse_condition(text), self.words, "domain.assume")
            self.faults += check(tree, self.units, None, f"domain.assume {text!r}")
            made.append((text, tree))
        yield from made
        for name, element in self.elements.items():
            for required in _required(element):
                yield f"{name}: a law of its kind is positive", compare(required, ">", 0)
        for where, tree in [*made, *((n, t) for n, e in self.elements.items() for t in _laws(e))]:
            for width in _widths(tree):
                if any(role == "z" for role, _ in symbols(width)):
                    raise InputError(f"{where}: a width depends on the law's letter")
                yield f"{where}: a width is not negative", compare(width, ">=", 0)

    def _initial(self) -> Iterator[tuple[str, tuple[Node, ...]]]:
        words = {n: s for n, s in self.words.items() if s[0] in "pu"}
        for symbol, given in self.tables["initial"].items():
            where = f"initial.{symbol}"
            owner = self.states.get(symbol)
            if owner is None:
                raise InputError(f"{where}: no such state")
            values = given if isinstance(given, list) and given else [given]
            count = self.elements[owner].count
            if isinstance(given, list) and len(values) != count:
                raise InputError(f"{where} has a list of another length")
            made = []
            for value in values:
                if isinstance(value, str):
                    tree = self._resolved(parse(value), words, where)
                    self.faults += check(tree, self.units, self.units["x", owner], where)
                    made.append(tree)
                else:
                    made.append(num(_value(value, where)))
            yield owner, tuple(made)

    def _lane_lists(self, conditions: tuple[tuple[str, Node], ...]) -> None:
        """Refuse lists but for parameters that one bank alone uses, with as many values."""
        for name in self.lists:
            users = {n for n, e in self.elements.items() if ("p", name) in _used(e)}
            count = self.elements[next(iter(users))].count if len(users) == 1 else None
            if count is None or len(self.parameters[name]) != count:
                raise InputError(f"parameters.{name}: a list, but no bank of as many lanes")
            for text, tree in conditions:
                lanes = {n for role, n in symbols(tree) if role == "x" and self.elements[n].count}
                lanes |= {
                    n
                    for role, p in symbols(tree)
                    if role == "p" and p in self.lists
                    for n, e in self.elements.items()
                    if ("p", p) in _used(e)
                }
                if ("p", name) in symbols(tree) and lanes - users:
                    raise InputError(f"{text!r} mixes lanes of two banks")


def _given(laws: Mapping[str, Node], kind: Kind) -> tuple[Node | None, bool]:
    """Return a dissipative law, and whether the element imposes an across variable."""
    for field in ("voltage", "velocity", "current", "force"):
        if field in laws and kind.form in ("resistor", "hysteron"):
            return laws[field], kind.across and field in ("voltage", "velocity")
    return None, kind.across


def _laws(element: Element) -> Iterator[Node]:
    yield from element.laws.values()


def _used(element: Element) -> set[Symbol]:
    return {symbol for law in element.laws.values() for symbol in symbols(law)}


def _costate(kind: str, laws: Mapping[str, Node], name: str) -> Node | None:
    """Return dU/dx of a store or body as a law of its state."""
    if kind == "thermal_mass":
        return laws["temperature"]
    if kind == "spring":
        rest = laws.get("rest", num(0))
        return Node("*", (laws["stiffness"], Node("+", (sym(("x", name)), Node("neg", (rest,))))))
    if kind in STATES:
        field = next(iter(laws))
        return Node("/", (sym(("x", name)), laws[field]))
    return None


def _required(element: Element) -> Iterator[Node]:
    """Yield what an element's kind requires to be positive."""
    if element.kind.form == "body":
        names = symbols(element.laws["temperature"])
        yield from (sym(symbol) for symbol in names if symbol[0] == "p")
    elif element.kind.form in ("store", "hysteron"):
        yield next(iter(element.laws.values()))


def _widths(tree: Node) -> Iterator[Node]:
    for node in walk(tree):
        if node.op in ("deadzone", "saturate"):
            width = node.args[1]
            if not (width.op == "num" and width.value >= 0):
                yield width


def costate_law(element: Element, at: Node) -> Node:
    """Return the co-state of a store or body for another tree in place of its state."""
    return put(element.costate or num(0), {("x", element.name): at})
