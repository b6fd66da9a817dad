"""A spec at one point, exactly, by the checker's reader: rationals, else enclosures that decide.

Input: the checker's `Spec`, and numbers for parameters, inputs and states.  Output: a `Point`.
What 8192 bits do not decide is nan.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, final

from flint import arb, ctx, fmpq

from piezo_sym.checker.laws import InputError, Node, derivative, num, symbols
from piezo_sym.checker.network import Flows, SingularError, flows
from piezo_sym.checker.spec import Element, Spec
from piezo_sym.falsify.numbers import CannotTell, NoValue, compute, exact, holds

PRECISIONS = (128, 512, 2048, 8192)
MAX_LANES = 64
NAN = arb("nan")
Numbers = Mapping[str, Sequence[float | Fraction]]
Values = dict[tuple[str, str], list[Any]]


@final
@dataclass(frozen=True)
class Point:
    """What a spec says at a point, as exact rationals or enclosures; nan if it cannot be told.

    Attributes
    ----------
    values : one per lane, by quantity and name: output W, heat W*z and production of an element,
        production of all elements (name ""), conductance, temperature T and slope dT/dS of a body,
        rate of a state, input.
    inside : whether the point is in the domain; None if it cannot be told.
    undefined : the elements that have a law without a value here.
    """

    values: Mapping[tuple[str, str], list[Any]]
    inside: bool | None
    undefined: tuple[str, ...]

    def get(self, what: str, name: str) -> list[tuple[Any, Any]]:
        """Return the values of a quantity, each with the size 0, for nothing is rounded."""
        return [(value, 0) for value in self.values.get((what, name), [NAN])]


def evaluate(spec: Spec, numbers: Numbers, counts: Mapping[str, int]) -> Point:
    """Return what a spec says at a point, exactly.

    Parameters
    ----------
    spec : from `read_spec`.
    numbers : of every parameter, input and state by name, in SI, one per lane.
    counts : size of each bank.

    Raises
    ------
    InputError
        If a bank has more than `MAX_LANES` lanes.
    SingularError
        If the network has no single solution there.
    """
    if max(counts.values(), default=0) > MAX_LANES:
        raise InputError(f"a point is computed for banks of {MAX_LANES} lanes at most")
    for bits in PRECISIONS:
        with ctx.workprec(bits):
            evaluation = _Evaluation(spec, numbers, counts)
            found = evaluation.point()
        if not evaluation.untold:
            break
    return found


@final
class _Evaluation:
    """One evaluation at one precision, the algebra of its network (see `flows`).

    `known` are the values of symbols, one per lane; `rational` says whether the network's
    coefficients are, `untold` whether more digits may tell more.
    """

    def __init__(self, spec: Spec, numbers: Numbers, counts: Mapping[str, int]) -> None:
        self.spec, self.counts, self.one, self.rational = spec, counts, exact(1), True
        self.untold, self.undefined = False, dict[str, None]()
        self.known = {spec.words[name]: [*map(exact, own)] for name, own in numbers.items()}
        for body in spec.of("body"):
            T = self.told(body.laws["temperature"], body.name)
            self.known["T", body.name] = [arb(0) if T == 0 else T]  # W*z/T is then no number

    def values_of(self, lane: int, letter: Any = None) -> Callable[[Any], Any]:
        """Return what gives the value of a symbol in one lane, and of the letter z."""

        def value(symbol: Any) -> Any:
            if symbol[0] == "z":
                return letter
            found = self.known[symbol]
            return found[max(lane - 1, 0) % len(found)]

        return value

    def told(self, tree: Node, where: str, lane: int = 0, letter: Any = None) -> Any:
        """Return a law's value; nan if it has none or it cannot be told."""
        try:
            return compute(tree, self.values_of(lane, letter))
        except NoValue:
            self.undefined[where] = None
        except CannotTell:
            self.untold = True
        return NAN

    def like(self, _: tuple[str, int]) -> Any:
        """Return how many lanes are like this one: it alone, for each is there."""
        return self.one

    def law(self, element: Element, field: str, lane: int, letter: Any = None) -> Any:
        """Return the value of a law."""
        tree = element.law if field == "law" else element.laws[field]
        found = self.told(tree or num(0), element.name, lane, letter)
        solving = field == "ratio" or letter is self.one
        self.rational &= isinstance(found, fmpq) or not solving
        return found

    def given(self, role: str, owner: str, lane: int) -> Any:
        """Return an input, a co-state or a temperature."""
        element = self.spec.elements[owner]
        if role == "E":
            return self.told(element.costate or num(0), owner, lane)
        return self.known[role, element.input if role == "u" else owner][0]

    def point(self) -> Point:
        """Return the point."""
        values: Values = {("input", name): self.known["u", name] for name in self.spec.inputs}
        try:
            self._flowing(flows(self.spec, self.counts, self), values)
        except SingularError:
            if self.rational:  # else more digits may find a pivot
                raise
            self.untold = True
        for body in self.spec.of("body"):
            slope = derivative(body.laws["temperature"], ("x", body.name))
            values["temperature", body.name] = [_finite(self.known["T", body.name][0])]
            values["slope", body.name] = [_finite(self.told(slope, body.name))]
        for e in self.spec.of("conduction", "ambient"):
            values["conductance", e.name] = [_finite(self.law(e, "conductance", 0))]
        inside = _all(self._holds(condition) for condition in self.spec.conditions)
        return Point(values, inside, tuple(self.undefined))

    def _flowing(self, found: Flows, values: Values) -> None:
        """Add outputs, heats, productions and rates of a solved network."""

        def add(what: str, name: str, value: Any) -> None:
            values.setdefault((what, name), []).append(_finite(value))

        for (name, lane), W in found.outputs.items():
            z, T = found.letters[name, lane], self.given("T", self.spec.elements[name].bodies[0], 0)
            add("output", name, W)
            add("heat", name, W * z)
            add("production", "", W * z / T)
        for e in self.spec.of("conduction"):
            first, second = (self.given("T", body, 0) for body in e.bodies)
            power = self.law(e, "conductance", 0) * (first - second)
            add("production", "", power * (first - second) / (first * second))
        for (name, _), rate in found.rates.items():
            add("rate", self.spec.elements[name].state, rate)

    def _holds(self, condition: Node) -> bool | None:
        """Return whether a condition holds, in every lane; None if it cannot be told."""
        lanes = max((len(self.known[s]) for s in symbols(condition)), default=1)
        told: list[bool | None] = []
        for lane in range(1, lanes + 1):
            try:
                told.append(holds(condition, self.values_of(lane)))
            except NoValue:
                told.append(False)
            except CannotTell:
                self.untold = True
                told.append(None)
        return _all(told)


def _all(told: Iterable[bool | None]) -> bool | None:
    """Return whether all are true; None if that is not known."""
    found = set(told)
    return False if False in found else None if None in found else True


def _finite(number: Any) -> Any:
    return number if isinstance(number, fmpq) or number.is_finite() else NAN
