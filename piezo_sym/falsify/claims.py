"""Rows as trees that are negative where the row is false.

Input: a `Probe`, and a row.  Output: a `Claim`.
"""

from collections.abc import Collection
from dataclasses import dataclass
from typing import final

from piezo_sym.expressions.calculus import add, div, mul, neg
from piezo_sym.expressions.tree import ONE, Cmp, Expr, Mul, Sym
from piezo_sym.falsify.probe import Probe
from piezo_sym.spec.elements.ports import (
    Body,
    Conductor,
    DissipativePort,
    Exchange,
    HeatInput,
    Source,
)

#: Tolerance for rounding on a balance, relative to its scale.
TOLERANCE = 1e-9


@final
@dataclass(frozen=True)
class Inequality:
    """The claim that a value is >= 0, or > 0 if `strict`, in every lane of a bank.

    The size of `scale`, the sum of the absolute values of its terms, distinguishes rounding from a
    change of sign.
    """

    name: str
    value: Expr
    scale: Expr
    strict: bool = False
    bank: str | None = None


@final
@dataclass(frozen=True)
class Claim:
    """A row that can be evaluated at a point."""

    #: id, element: of the row.
    id: str
    element: str
    #: The inequalities that the row claims; none for `welldef` and `continuous`.
    says: tuple[Inequality, ...] = ()
    where: tuple[Cmp, ...] = ()  # conditions under which the row applies
    #: zero, equal: inputs that the row assumes to be zero, and inputs it assumes to be equal.
    zero: tuple[str, ...] = ()
    equal: tuple[str, ...] = ()

    @property
    def is_smooth(self) -> bool:
        """Whether value/scale varies smoothly, so that the attack can descend along it."""
        return self.id in {"passive", "conductance", "temperature"}


def claim_of(probe: Probe, id_: str, element: str) -> Claim | None:
    """Return the claim of a row, or None if it cannot be evaluated at a point."""
    circuit = probe.iphs.circuit
    ports = circuit.by_element.get(element)
    # for a storage with an entropy, the body, which need not be its last port
    match id_, circuit.bodies.get(element) or (ports[-1] if ports else None):
        case (("passive" | "conductance"), DissipativePort()):
            heat = Sym(f"heat {element}")
            size = Mul(*(probe.law(what, element)[0] for what in ("output", "effort")))
            power = Inequality("heat", heat, size, bank=probe.defined[heat.name][1])
            return Claim(id_, element, (power,))
        case (("passive" | "conductance"), (Conductor() | Exchange())):
            return Claim(id_, element, (_conducts(probe, element),))
        case "temperature", Body():
            law, slope = (probe.law(what, element)[0] for what in ("temperature", "slope"))
            hot = Inequality("temperature", Sym(f"temperature {element}"), law, strict=True)
            return Claim(id_, element, (hot, Inequality("slope", slope, slope, strict=True)))
        case "sigma", _:
            total = probe.produced
            return Claim(id_, element, (Inequality("sigma", total, total),))
        case "environment", _:
            zero = tuple(port.input for _, port in circuit.of(HeatInput))
            made = _balance(probe, "the production", circuit.bodies, ONE)
            return Claim(id_, "", (made,), zero=zero)
        case "exergy", _:
            outside = tuple(port.input for _, port in circuit.of(Exchange))
            driven = (port.input for _, port in circuit.of(Source, HeatInput))
            lost = _balance(probe, "the exergy lost", circuit.bodies, Sym(outside[0]))
            zero = tuple(name for name in driven if name not in outside)
            return Claim(id_, "", (lost,), zero=zero, equal=outside)
        case "invariant", Body():
            return _coldest(probe, element)
        case (("welldef" | "continuous"), _):
            return Claim(id_, element)
    return None


def _conducts(probe: Probe, element: str) -> Inequality:
    law, _ = probe.law("conductance", element)
    return Inequality("conductance", law, law)


def _balance(probe: Probe, name: str, bodies: Collection[str], factor: Expr) -> Inequality:
    """Return the claim that factor*dS/dt of `bodies` is at least what their environments give.

    Environments give entropy if the factor is 1, else heat.
    """
    circuit = probe.iphs.circuit
    rates = [Sym(f"rate {b.state}") for placed, b in circuit.of(Body) if placed.element in bodies]
    value, scale = [mul(factor, add(*rates))], [mul(factor, add(*rates, probe.produced))]
    for placed, port in circuit.of(Exchange):
        if port.body in bodies:
            outside, hot = Sym(port.input), Sym(f"temperature {port.body}")
            lam, _ = probe.law("conductance", placed.element)
            flow = mul(lam, add(outside, neg(hot)))
            taken = div(flow, outside) if factor == ONE else flow
            value.append(neg(taken))
            scale += [taken, mul(factor, div(flow, hot))]
    return Inequality(name, add(*value), add(*scale))


def _coldest(probe: Probe, element: str) -> Claim:
    """Return the claim that a body gains entropy while all that it touches is warmer."""
    circuit, hot = probe.iphs.circuit, Sym(f"temperature {element}")
    own = [(placed.element, port) for placed, port in circuit.of(Exchange) if port.body == element]
    where = [Cmp("<", hot, Sym(port.input)) for _, port in own]
    for _, c in circuit.of(Conductor):
        for one, other in ((c.first, c.second), (c.second, c.first)):
            where += [Cmp("<=", hot, Sym(f"temperature {other}"))] if one == element else []
    gained = _balance(probe, "the entropy gained, times T", (element,), hot)
    conducts = (_conducts(probe, name) for name, _ in own)
    return Claim("invariant", element, (gained, *conducts), tuple(where))
