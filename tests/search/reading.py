"""A spec's text to its domain and its claims, read without the package.

Input: TOML.  Output: a `Spec`.  Variables are parameters and inputs, states, temperatures and
co-states; a temperature or a co-state that takes every value whatever the rest is stands as a free
variable of its own, else it is a law of its state.  A letter is a co-state, or minus one.
"""

import tomllib
from dataclasses import dataclass, field, replace
from fractions import Fraction

from tests.search.laws import ONE, ZERO, edges, names, put, read, widths

#: Stores: the letter of the state, and the co-state as text, of fields in braces.
STORES = {
    "mass": ("p", "p/({mass})"),
    "spring": ("q", "({stiffness})*(q - ({rest}))"),
    "capacitor": ("Q", "Q/({capacitance})"),
    "inductor": ("phi", "phi/({inductance})"),
    "hysteron": ("phi", "phi/({inductance})"),
}
POSITIVE = ("mass", "stiffness", "capacitance", "inductance")
#: Dissipative laws: field -> (letter, the kind of store that gives it).
LAWS = {
    "force": ("v", "mass"),
    "velocity": ("f", "spring"),
    "voltage": ("i", "inductor"),
    "current": ("v", "capacitor"),
}
DISSIPATIVE = ("damper", "resistor", "hysteron")


@dataclass(frozen=True)
class Claim:
    """A property of an element: `trees` in the variables of the spec, and the letter's tree."""

    id: str
    element: str
    trees: tuple
    letter: tuple = ()


@dataclass
class Spec:
    """What the oracle knows of a spec.

    Attributes
    ----------
    free : the names drawn; `derived` : name -> law, of other names before it.
    fixed : the names of parameters; a law may jump where only these change.
    own : the values that the spec gives.
    domain, warm : comparisons; the second that derived temperatures are positive.
    words : element -> what its witness calls letters and temperatures: name -> tree.
    hot : body -> its temperature's name.
    """

    text: str
    data: dict = field(repr=False)
    free: list = field(default_factory=list)
    derived: dict = field(default_factory=dict)
    fixed: tuple = ()
    own: dict = field(default_factory=dict)
    domain: list = field(default_factory=list)
    claims: dict = field(default_factory=dict)
    words: dict = field(default_factory=dict)
    hot: dict = field(default_factory=dict)
    warm: list = field(default_factory=list)


def spec_of(text):
    """Return what a spec claims."""
    spec = Spec(text, tomllib.loads(text))
    spec.fixed = tuple(spec.data.get("parameters", {}))
    spec.free = [*spec.fixed, *spec.data.get("inputs", {})]
    for table, key in (("parameters", "value"), ("inputs", "default")):
        entries = spec.data.get(table, {}).items()
        spec.own |= {name: _first(entry.get(key, 0)) for name, entry in entries}
    elements = spec.data["elements"]
    bodies = [name for name, e in elements.items() if e["kind"] == "thermal_mass"]
    spec.hot = {b: "T" if len(bodies) == 1 else f"T_{b}" for b in bodies}
    assumed = [read(part) for part in spec.data.get("domain", {}).get("assume", [])]
    needed = [c for name, e in elements.items() for c in _needs(spec, name, e)]
    needed += [(">=", width, ZERO) for condition in assumed for width in widths(condition)]
    spec.domain = list(dict.fromkeys([*assumed, *needed]))
    used = set(names(*spec.domain))
    for name, element in elements.items():
        _add_state(spec, name, element, used)
    for name, element in elements.items():
        _add_claims(spec, name, element)
    partial = [c for c in spec.domain if {"end", "pole"} & {kind for kind, _ in edges(c)}]
    spec.claims["welldef", ""] = Claim("domain", "", tuple(partial))
    spec.words[""] = {}
    return spec


def _first(value):
    value = value[0] if isinstance(value, list) else value
    return Fraction(repr(value))


def state_of(name, element):
    """Return the symbol of an element's state."""
    letter = "S" if element["kind"] == "thermal_mass" else STORES[element["kind"]][0]
    return element.get("state", f"{letter}_{name}")


def _needs(spec, name, element):
    """Yield the conditions that a kind adds to the domain, in the domain's words."""
    words = {"T": ("name", spec.hot.get(element.get("heats", element.get("temperature")), "T"))}
    if element["kind"] in STORES:
        words[STORES[element["kind"]][0]] = ("name", state_of(name, element))
    if element["kind"] == "thermal_mass":
        yield from (
            (">", ("name", n), ZERO) for n in names(read(element["temperature"])) if n != "S"
        )
    for key, law in element.items():
        if key in POSITIVE:
            yield (">", put(read(law), words), ZERO)
        if key in {*POSITIVE, *LAWS, "ratio", "conductance"} and isinstance(law, str):
            yield from ((">=", put(w, words), ZERO) for w in widths(read(law)))


def _add_state(spec, name, element, used):
    """Add a store's state and co-state, or a body's temperature, free or derived.

    Where both are free, the state stands in its own element's claims only.
    """
    kind = element["kind"]
    if kind not in STORES and kind != "thermal_mass":
        return
    state = state_of(name, element)
    spec.free.append(state)
    start = spec.data.get("initial", {}).get(state, 0)
    spec.own[state] = Fraction(0) if isinstance(start, str) else _first(start)
    letter, law = _law_of_state(element)
    if kind == "thermal_mass":
        made, free = (
            spec.hot[name],
            law[0] == "*" and law[1][0] == "name" and _is_exponential(law[2]),
        )
        (spec.domain if free else spec.warm).append((">", ("name", made), ZERO))
    else:
        size = law[1] if kind == "spring" else law[2]
        made, free = f"~{name}", letter not in names(size)
    if free and state not in used:
        spec.free.append(made)
        spec.own[made] = spec.own[law[1][1]] if kind == "thermal_mass" else Fraction(0)
    else:
        spec.derived[made] = put(law, {letter: ("name", state)})


def _law_of_state(element):
    """Return a state's letter, and the co-state or temperature as a tree of it."""
    if element["kind"] == "thermal_mass":
        return "S", read(element["temperature"])
    letter, law = STORES[element["kind"]]
    return letter, read(law.format(**{"rest": "0", **element}))


def _is_exponential(law):
    match law:
        case ("exp", ("/", ("name", "S"), ("name", _))):
            return True
    return False


def _add_claims(spec, name, element):
    kind = element["kind"]
    body = element.get("heats", element.get("temperature"))
    words = {"T": ("name", spec.hot.get(body, "T"))}
    trees = []
    if kind in STORES or kind == "thermal_mass":
        letter, law = _law_of_state(element)
        trees.append(put(law, {letter: ("name", state_of(name, element))}))
    if kind == "thermal_mass":
        spec.claims["temperature", name] = Claim("temperature", name, tuple(trees))
    if kind in DISSIPATIVE:
        key = next(key for key in LAWS if key in element)
        letter, word = _drive(spec, name, element, key), LAWS[key][0]
        words[word] = letter
        trees.append(put(read(element[key]), words))
        spec.claims["passive", name] = Claim("passive", name, (trees[-1],), letter)
        turned = put(read(element[key]), {**words, word: ("neg", letter)})
        spec.claims["odd", name] = Claim("odd", name, (("+", trees[-1], turned),), letter)
    if kind in {"transducer", "ambient", "conduction"}:
        trees.append(put(read(element.get("ratio", element.get("conductance"))), words))
    if kind == "conduction":
        spec.claims["passive", name] = Claim("passive", name, tuple(trees), ONE)
    spec.words[name] = words
    for claim in ("welldef", "continuous"):
        if trees and not (claim == "continuous" and element.get("discontinuous")):
            spec.claims[claim, name] = Claim(claim, name, tuple(trees))


def _drive(spec, name, element, key):
    """Return a law's letter: the co-state of the store that drives it, with its sign."""
    if element["kind"] == "hysteron":
        return ("name", f"~{name}")
    first, second = element["between"]
    for other, store in spec.data["elements"].items():
        if store["kind"] != LAWS[key][1]:
            continue
        a, b = store.get("between", (store.get("at"), "wall"))
        if key in {"force", "current"} and {a, b} == {first, second}:
            return ("name", f"~{other}") if a == first else ("neg", ("name", f"~{other}"))
        inner = first if second in {"wall", "gnd"} else second
        if key in {"voltage", "velocity"} and inner in {a, b}:
            same = (b == inner) == (first == inner)
            return ("name", f"~{other}") if same else ("neg", ("name", f"~{other}"))
    if key in {"force", "current"}:
        ends = [_across(spec, end) for end in (first, second)]
        if None not in ends:
            return ("+", ends[0], ("neg", ends[1]))
    spec.free.append(f"~{name}")  # nothing that the oracle knows: any number
    spec.own[f"~{name}"] = Fraction(0)
    return ("name", f"~{name}")


def _across(spec, node):
    """Return the speed or the potential of a node that a mass or a source gives, or None."""
    if node in {"wall", "gnd"}:
        return ("num", Fraction(0))
    for name, element in spec.data["elements"].items():
        ends = element.get("between", [element.get("at"), "wall"])
        if ends[0] == node and ends[1] in {"wall", "gnd"}:
            if element["kind"] in {"mass", "capacitor"}:
                return ("name", f"~{name}")
            if element["kind"] in {"velocity_source", "voltage_source"}:
                return ("name", element["input"])
    return None


def moving(spec):
    """Return the free names along which a law may not jump: all but the parameters."""
    return [name for name in spec.free if name not in spec.fixed]


def total(spec):
    """Return a spec with the conditions only that always have a value."""
    partial, used = spec.claims["welldef", ""].trees, set(names(*spec.domain))
    derived = {name: law for name, law in spec.derived.items() if name in used}
    domain = [c for c in spec.domain if c not in partial]
    return replace(spec, domain=domain, derived=derived, warm=[])
