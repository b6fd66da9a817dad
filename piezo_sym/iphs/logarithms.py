"""Logarithms in integrated energies, of what is positive in the domain.

1/(q - a) integrates to log(q - a) as well as to log(a - q).  Both have one slope; which of them has
a value is up to the domain, which integration does not know.

Input: an energy, and the spec that it is of.  Output: an energy of the same slope.  Nothing rests
on the choice: row welldef shows that an energy has a value, row energy that its slope is the law.
"""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from fractions import Fraction

from piezo_sym.expressions.calculus import neg
from piezo_sym.expressions.exact_eval import Value, all_hold, value_of
from piezo_sym.expressions.tidying import collected
from piezo_sym.expressions.tree import ZERO, Call, Cmp, Expr, If, names, rebuild, walk
from piezo_sym.spec.circuit import Circuit
from piezo_sym.spec.model import Model
from piezo_sym.spec.tables import starts

Point = Mapping[str, Value]
#: Values of a state that are looked at, times its own start and the parameters of its energy.
TIMES = (Fraction(1), Fraction(-1), Fraction(1, 2), Fraction(-1, 2), Fraction(2), Fraction(-2))
NEAR = Fraction(1, 10**12)


def with_values(energy: Expr, state: str, circuit: Circuit) -> Expr:
    """Return an energy with log(-a) in place of log(a) where a < 0 in the domain.

    That is judged at some points, on each branch at those that lie on it; they satisfy the
    conditions on parameters, inputs and this state. Where signs differ, the first decides.
    """
    if not any(isinstance(n, Call) and n.function == "log" for n in walk(energy)):
        return energy
    used = {state, *circuit.model.parameters, *circuit.model.inputs}
    domain = [c.tree for c in circuit.conditions if used.issuperset(names(c.tree))]
    points = [*_points(energy, state, circuit.model)]
    return _turned(energy, [point for point in points if all_hold(domain, point)])


def _points(energy: Expr, state: str, model: Model) -> Iterator[Point]:
    """Yield the spec's own values, of the first lane and the last, with some values of a state."""
    own: dict[str, Value] = {name: Fraction(entry.si) for name, entry in model.inputs.items()}
    for lane in (0, -1):
        own |= {name: Fraction(p.lanes[lane]) for name, p in model.parameters.items()}
        with suppress(ArithmeticError, ValueError):
            start = value_of(starts(model, state)[lane], own)
            sizes = [own[name] for name in names(energy) if name in model.parameters]
            yield from ({**own, state: start + size * NEAR} for size in (0, *sizes))
            yield from ({**own, state: start - size * NEAR} for size in sizes)
            yield from ({**own, state: size * times} for size in (start, *sizes) for times in TIMES)


def _turned(node: Expr, points: Sequence[Point]) -> Expr:
    match node:
        case If(then, condition, other):
            on = [point for point in points if all_hold((condition,), point)]
            off = [point for point in points if all_hold((condition,), point) is False]
            return If(_turned(then, on), condition, _turned(other, off))
        case Call("log", (arg,)):
            inner = _turned(arg, points)
            below = [all_hold((Cmp("<", inner, ZERO),), point) for point in points]
            above = [all_hold((Cmp(">", inner, ZERO),), point) for point in points]
            turned = any(below) and (below[0] or not any(above))
            return Call("log", (collected(neg(inner)) if turned else inner,))
    return rebuild(node, lambda part: _turned(part, points))
