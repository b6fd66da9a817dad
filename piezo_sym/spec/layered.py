"""A stack layer by layer: the shipped actuator cut into n layers, each with a body of its own.

Input: the number of layers.  Output: a `Model` of ordinary elements.  Layers are in series for
forces and in parallel for the supply, and conduct heat to their neighbours.  The whole stack has
the stiffness, damping, capacitance, hysterons and heat capacity of `piezo_stack`, for every n.
"""

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

from piezo_sym.errors import UsageError, quote
from piezo_sym.spec.load import load
from piezo_sym.spec.model import Model
from piezo_sym.spec.rename import Renaming
from piezo_sym.spec.tables import states

#: The elements that are not repeated per layer.
ONCE = ("ambient", "load", "supply")


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
    stack = load("piezo_stack")
    title = f"Piezoelectric stack of {n} layers that conduct heat"
    source = f"{stack.model.source}, cut into layers; conductance between them: a choice"
    hot = ["T > T_0"] if n == 1 else [f"T_body_{j} > T_0" for j in range(1, n + 1)]
    return Model(
        model={"name": "layered_stack", "title": title, "source": source},
        parameters=_layer_parameters(stack, n),
        inputs=stack.inputs,
        domain={"assume": [*hot, *stack.domain.assume[1:], "lam_l >= 0"]},
        initial={f"S_{j}": stack.initial["S"] for j in range(1, n + 1)},
        elements=dict(_elements(stack, n)),
    )


def _layer_parameters(stack: Model, n: int) -> dict[str, Any]:
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
    rows: dict[str, Any] = {
        name: {**dict(stack.parameters[name]), "value": _times(stack, name, share), "doc": doc}
        for name, (share, doc) in shares.items()
    }
    doc = "heat conductance from a layer to the next"
    return {**rows, "lam_l": {"value": _times(stack, "lam", n), "unit": "W/K", "doc": doc}}


def _times(stack: Model, name: str, share: Fraction | int) -> float:
    return float(Fraction(repr(stack.parameters[name].value)) * share)


def _elements(stack: Model, n: int) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the layers from the wall to the tip, the contacts of their bodies, and the ends."""
    for j in range(1, n + 1):
        layer = _layer_names(stack, j)
        for name in (name for name in stack.elements if name not in ONCE):
            fields = layer.fields(stack.elements[name], name).items()
            yield layer.element(name), {k: v for k, v in fields if k not in ("count", "rest")}
    for j in range(1, n):
        pair = (f"body_{j}", f"body_{j + 1}")
        yield f"contact_{j}", {"kind": "conduction", "between": pair, "conductance": "lam_l"}
    once = {name: dict(stack.elements[name]) for name in ONCE}
    yield "base", once["ambient"] | {"body": "body_1"}
    yield "top", once["ambient"] | {"body": f"body_{n}"}
    yield "load", once["load"] | {"at": f"x_{n}"}
    yield "supply", once["supply"]


def _layer_names(stack: Model, j: int) -> Renaming:
    """Return the names of the elements, states and nodes of layer j."""
    nodes = {"tip": f"x_{j}", "wall": f"x_{j - 1}" if j > 1 else "wall", "cap": f"cap_{j}"}
    words = {symbol: f"{symbol.removesuffix('_C')}_{j}" for symbol in states(stack)}
    return Renaming(words, lambda name: f"{name}_{j}", lambda node: nodes.get(node, node))
