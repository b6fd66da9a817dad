"""A stack layer by layer: the shipped actuator cut into n layers, each with a body of its own.

Input: the number of layers.  Output: a `Model` of ordinary elements.  Layers are in series for
forces and in parallel for the supply, and conduct heat to their neighbours.  The whole stack has
the stiffness, damping, capacitance, hysterons and heat capacity of `piezo_stack`, for every n.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

from piezo_sym.errors import UsageError, quote
from piezo_sym.spec.load import load
from piezo_sym.spec.model import Model

WHOLE = "piezo_stack"
Fields = dict[str, Any]


def layered(n: int) -> Model:
    """Return the stack of `piezo_stack` as n layers with heat conducted between them.

    Layer j = 1 ... n has a spring, a damper, a mass at its upper end, a capacitor behind a
    hysteron, a transducer and a body.  All hysterons in parallel are the paper's two, and the
    masses move the tip as its one mass does while forces are slow.  Each end of the stack exchanges
    heat with the environment, through half of the paper's conductance.  The paper has none between
    layers: here it is as large from end to end of the stack, so that it is hottest inside.

    Parameters
    ----------
    n : the number of layers.

    Raises
    ------
    UsageError
        If `n` is no positive whole number.
    """
    if isinstance(n, bool) or not isinstance(n, int) or n < 1:
        raise UsageError(f"{quote(n)} is no number of layers", "layered", "1, 2, 3 ...")
    whole = load(WHOLE)
    title = f"Piezoelectric stack of {n} layers that conduct heat"
    source = f"{whole.model.source}, cut into layers; conductance between them: a choice"
    hot = ["T > T_0"] if n == 1 else [f"T_body_{j} > T_0" for j in range(1, n + 1)]
    return Model(
        model={"name": "layered_stack", "title": title, "source": source},
        parameters=_of_a_layer(whole, n),
        inputs=whole.inputs,
        domain={"assume": [*hot, *whole.domain.assume[1:], "lam_l >= 0"]},
        initial={f"S_{j}": whole.initial["S"] for j in range(1, n + 1)},
        elements=dict(_elements(n)),
    )


def _of_a_layer(whole: Model, n: int) -> dict[str, Any]:
    """Return the parameters of one layer, and the heat conductance at each end of the stack."""
    shares: dict[str, tuple[Fraction | int, str]] = {
        "M": (Fraction(6 * n, (n + 1) * (2 * n + 1)), "mass of a layer"),
        "k": (n, "stiffness of a layer"),
        "d": (n, "damping of a layer"),
        "C": (Fraction(1, n), "capacitance of a layer"),
        "L": (Fraction(n, 2), "inductance of a layer's hysteron"),
        "rho": (Fraction(n, 2), "resistance law of a layer: slope rho/(T - T_0)"),
        "i_0": (Fraction(2, n), "half width of a layer's dead zone"),
        "a": (1, "transducer ratio of a layer at T_0"),
        "T_0": (1, "reference temperature"),
        "c_0": (Fraction(1, n), "heat capacity of a layer"),
        "lam": (Fraction(1, 2), "heat conductance from an end to the environment"),
    }
    made: dict[str, Any] = {
        name: {**dict(whole.parameters[name]), "value": _times(whole, name, share), "doc": doc}
        for name, (share, doc) in shares.items()
    }
    doc = "heat conductance from a layer to the next"
    return {**made, "lam_l": {"value": _times(whole, "lam", n), "unit": "W/K", "doc": doc}}


def _times(whole: Model, name: str, share: Fraction | int) -> float:
    return float(Fraction(repr(whole.parameters[name].value)) * share)


def _elements(n: int) -> Iterator[tuple[str, Fields]]:
    """Yield the layers from the wall to the tip, what joins their bodies, and the ends."""
    for j in range(1, n + 1):
        yield from _layer(j, (f"x_{j}", f"x_{j - 1}" if j > 1 else "wall"))
    for j in range(1, n):
        pair = (f"body_{j}", f"body_{j + 1}")
        yield f"contact_{j}", {"kind": "conduction", "between": pair, "conductance": "lam_l"}
    for name, j in (("base", 1), ("top", n)):
        given = {"conductance": "lam", "input": "T_e"}
        yield name, {"kind": "ambient", "body": f"body_{j}", **given}
    yield "load", {"kind": "force_source", "at": f"x_{n}", "input": "F_ext"}
    yield "supply", {"kind": "voltage_source", "between": ("in", "gnd"), "input": "V_in"}


def _layer(j: int, ends: tuple[str, str]) -> Iterator[tuple[str, Fields]]:
    body, cap = f"body_{j}", f"cap_{j}"
    across, law = (cap, "gnd"), "rho/(T - T_0)*deadzone(i, i_0)"
    hysteron = {"inductance": "L", "voltage": law, "heats": body, "state": f"phi_{j}"}
    heat = {"temperature": "T_0*exp(S/c_0)", "state": f"S_{j}"}
    pairs = {"electrical": across, "mechanical": ends, "temperature": body}
    yield f"spring_{j}", {"kind": "spring", "between": ends, "stiffness": "k", "state": f"q_{j}"}
    yield f"mass_{j}", {"kind": "mass", "at": ends[0], "mass": "M", "state": f"p_{j}"}
    capacitor = {"between": across, "capacitance": "C", "state": f"Q_{j}"}
    yield f"capacitor_{j}", {"kind": "capacitor", **capacitor}
    yield f"hysteron_{j}", {"kind": "hysteron", "between": ("in", cap), **hysteron}
    yield f"damper_{j}", {"kind": "damper", "between": ends, "force": "d*v", "heats": body}
    yield f"transducer_{j}", {"kind": "transducer", **pairs, "ratio": "a*T/T_0"}
    yield body, {"kind": "thermal_mass", **heat}
