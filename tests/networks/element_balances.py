"""What the quantities of elements must fulfil, from the spec alone: nothing of the package is used.

Energies add up, heats are those of processes, what a coupling takes it gives, and both of
Kirchhoff's laws hold: at each node, and as Tellegen's theorem.
"""

from collections import defaultdict

import numpy as np
from kinds import KINDS
from network_tableau import pairs_of

REFERENCES = {"wall", "gnd", "frame", "tank", ":zero"}
MECHANICAL = {"N", "N*m"}  # units of efforts that are forces: these add up at nodes


def quantities(module, spec, x, u, p):
    """Return {element: {quantity: value}}, a bank's lanes summed, but for what they share.

    Lanes are in parallel, and share voltage, velocity, pressure; those in series share what flows.
    """
    values, found, row = module.elements(x, u, p), defaultdict(dict), 0
    for record in module.ELEMENTS:
        element, _, word = record.name.rpartition(".")
        count = getattr(p, f"{record.bank}_count") if record.bank else 1
        lanes = values[row : row + count]
        row += count
        own = spec["elements"][element]
        series = "series" in own or (own["kind"] == "capacitor" and "bank" not in own)
        through, across = {"A", "N", "N*m", "m**3/s"}, {"V", "m/s", "rad/s", "Pa", "K"}
        shared = record.unit in (through if series else across)
        found[element][word] = lanes[0] if shared else lanes.sum(axis=0)
        found[element][f"unit of {word}"] = record.unit
    assert row == len(values)
    return found


def check_elements(module, spec, x, u, share=1e-11):
    """Check the quantities of all elements at one state."""
    p = module.Parameters()
    found = quantities(module, spec, x, u, p)
    assert found.keys() == spec["elements"].keys()
    energies = [q["energy"] for q in found.values() if "energy" in q]
    size = sum(map(abs, energies))
    assert abs(sum(energies) - module.energy(x, p)) <= share * size
    heats = [q["heat"] for q in found.values() if "heat" in q]
    carried = [q["power"] for e, q in found.items() if spec["elements"][e]["kind"] == "conduction"]
    assert np.isclose(sum(heats) + sum(carried), module.heat(x, u, p).sum(), rtol=1e-11)
    check_tellegen(spec, found, share)
    check_nodes(spec, found, share)
    speed = module.rhs(x, u, p)
    scale = 1e-6 * np.abs(x).max(initial=1e-9) / np.abs(speed).max(initial=1e-30)
    ahead, behind = (quantities(module, spec, x + s * scale * speed, u, p) for s in (1, -1))
    total = sum(abs(one["power"]) for one in found.values())
    for name, one in found.items():
        if "energy" in one and "heat" not in one:
            growth = (ahead[name]["energy"] - behind[name]["energy"]) / (2 * scale)
            rounding = 1e-14 * abs(one["energy"]) / scale + 1e-9 * total
            assert abs(growth - one["power"]) <= 1e-3 * abs(one["power"]) + rounding, name


def check_tellegen(spec, found, share):
    """Check that power is conserved: what flows into elements and is no heat adds up to zero."""
    powers = []
    for name, one in found.items():
        kind = spec["elements"][name]["kind"]
        if KINDS[kind].form == "coupling":
            pairs = [one[f"effort_{n}"] * one[f"flow_{n}"] for n in (1, 2)]
            assert abs(sum(pairs)) <= share * abs(pairs[0])
            assert abs(pairs[0] - one["power"]) <= share * abs(pairs[0])
        elif kind != "conduction":
            powers += [one["power"], -one.get("heat", 0.0)]
    assert abs(sum(powers)) <= share * max(sum(map(abs, powers)), 1e-30)


def check_nodes(spec, found, share):
    """Check that what flows out of each node adds up to zero, in every element that says so."""
    drawn = defaultdict(list)
    for name, element in spec["elements"].items():
        one = found[name]
        for pair, end in branches(element):
            unit = one.get(f"unit of effort{end}")
            through = one[f"effort{end}" if unit in MECHANICAL else f"flow{end}"]
            for node, sign in zip(pair, (1, -1), strict=False):
                drawn[node].append(sign * through)
    for node, parts in drawn.items():
        if node not in REFERENCES and not node.endswith(":body"):
            assert abs(sum(parts)) <= share * sum(map(abs, parts)), (node, parts)


def branches(element):
    """Yield the nodes of each branch of an element, and how its quantities' names end."""
    if KINDS[element["kind"]].form == "coupling":
        yield from ((pair, f"_{n}") for n, pair in enumerate(pairs_of(element), 1))
        return
    states = element.get("states", {})
    for symbol, state in states.items():
        if "between" in state:
            yield state["between"], f"_{symbol}" if len(states) > 1 else ""
    if element["kind"] != "conduction":
        if "between" in element:
            yield element["between"], ""
        elif "at" in element:
            yield (element["at"],), ""
