"""A spec under other names: every parameter, input, state, element and node has a new one.

Input: a spec as data, and new names.  Output: data of the same model.  States that the spec does
not name follow their element, as the rules for names say, and so do temperatures.
"""

from tests.search.laws import put, read, text
from tests.search.reading import STORES, state_of

#: The fields of an element that are laws.
FIELDS = ("mass", "stiffness", "rest", "capacitance", "inductance", "temperature", "force")
FIELDS += ("velocity", "voltage", "current", "ratio", "conductance")
NODES = ("between", "electrical", "mechanical", "at")
REFERENCES = {"wall", "gnd"}


def symbols(data):
    """Return what a person names in a spec: symbols, elements, nodes."""
    stateful = {n: e for n, e in data["elements"].items() if "state" in e}
    states = [e["state"] for e in stateful.values()]
    nodes = {n for e in data["elements"].values() for key in NODES for n in _nodes(e, key)}
    own = (*data["parameters"], *data["inputs"], *states)
    return own, tuple(data["elements"]), tuple(sorted(nodes - REFERENCES))


def _nodes(element, key):
    """Return the nodes of a field; a conduction's ends are bodies."""
    if key not in element or element["kind"] == "conduction":
        return []
    return [element[key]] if isinstance(element[key], str) else element[key]


def words(data, new):
    """Return old -> new of everything that stands in laws, [domain], [initial] and rows."""
    elements = data["elements"]
    found = {name: new[0].get(name, name) for name in symbols(data)[0]}
    for name, element in elements.items():
        other = new[1].get(name, name)
        if element["kind"] in STORES or element["kind"] == "thermal_mass":
            moved = {
                **element,
                **({"state": found[element["state"]]} if "state" in element else {}),
            }
            found[state_of(name, element)] = state_of(other, moved)
        if element["kind"] == "thermal_mass":
            found[f"T_{name}"] = f"T_{other}"
    return found


def renamed(data, new):
    """Return a spec with new names: `new` maps symbols, elements and nodes, each old -> new."""
    found = words(data, new)
    trees = {old: ("name", name) for old, name in found.items()}

    def law(source):
        return text(put(read(source), trees))

    made = {"model": data["model"], "elements": {}}
    made["domain"] = {"assume": [law(part) for part in data["domain"]["assume"]]}
    for table in ("parameters", "inputs", "initial"):
        made[table] = {found[name]: entry for name, entry in data.get(table, {}).items()}
    made["initial"] = {n: law(v) if isinstance(v, str) else v for n, v in made["initial"].items()}
    for name, element in data["elements"].items():
        made["elements"][new[1].get(name, name)] = _element(element, new, found, law)
    return made


def _element(element, new, found, law):
    made = dict(element)
    for key in FIELDS:
        if key in element and not (key == "temperature" and element["kind"] == "transducer"):
            made[key] = law(element[key])
    for key in NODES:
        if key in element:
            table = new[1] if element["kind"] == "conduction" else new[2]
            value = element[key]
            one = isinstance(value, str)
            made[key] = table.get(value, value) if one else [table.get(n, n) for n in value]
    for key in ("heats", "body", "temperature"):
        if key in element and element["kind"] != "thermal_mass":
            made[key] = new[1].get(element[key], element[key])
    for key in ("state", "input"):
        if key in element:
            made[key] = found[element[key]]
    return made
