"""A spec at one point, exactly, by the checker's reader: rationals, else enclosures that tell.

Input: the checker's `Spec`, and numbers for parameters, inputs and states.  Output: a `Point`.
What 8192 bits do not decide is None: it cannot be told.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any, final

from flint import arb, ctx, fmpq

from piezo_sym.checker.laws import InputError, Node, derivative, num, symbols
from piezo_sym.checker.network import Flows, SingularError, flows
from piezo_sym.checker.spec import Element, Spec
from piezo_sym.falsify.numbers import CannotTell, NoValue, compute, exact, holds

PRECISIONS = (128, 512, 2048, 8192)
MAX_LANES = 64
Given = Mapping[str, Any]
Values = tuple[Any, ...]


@final
@dataclass
class Point:
    """What a spec says at a point; None where it cannot be told or (`undefined`) has no value.

    Per element and lane: `letters` z, `outputs` W, `heats` W*z, `productions`; per body:
    `temperatures`, `slopes` dT/dS; `conductances`; per state symbol and lane: `rates`.
    `conditions` says of each of the domain whether it holds, `inside` whether all do.
    """

    letters: dict[str, Values] = field(default_factory=dict)
    outputs: dict[str, Values] = field(default_factory=dict)
    heats: dict[str, Values] = field(default_factory=dict)
    productions: dict[str, Values] = field(default_factory=dict)
    temperatures: dict[str, Any] = field(default_factory=dict)
    slopes: dict[str, Any] = field(default_factory=dict)
    conductances: dict[str, Any] = field(default_factory=dict)
    rates: dict[str, Values] = field(default_factory=dict)
    conditions: tuple[bool | None, ...] = ()
    sigma: Any = None
    undefined: tuple[str, ...] = ()

    @property
    def inside(self) -> bool | None:
        """Whether the point is in the domain."""
        told = self.conditions
        return False if False in told else None if None in told else True


def evaluate(
    spec: Spec,
    parameters: Given | None = None,
    inputs: Given | None = None,
    states: Given | None = None,
    counts: Mapping[str, int] | None = None,
) -> Point:
    """Return what a spec says at a point, exactly.

    Parameters
    ----------
    spec : from `read_spec`.
    parameters, inputs : numbers in SI by name, or a sequence with one per lane; the spec's own
        values where nothing is given.
    states : numbers by state symbol, a sequence with one per lane for a bank; else [initial].
    counts : size of each bank.
    """
    before = ctx.prec
    try:
        for bits in PRECISIONS:
            ctx.prec = bits
            evaluation = _Evaluation(spec, counts or {})
            evaluation.read(parameters or {}, inputs or {}, states or {})
            found = evaluation.point()
            if not evaluation.untold:
                break
    finally:
        ctx.prec = before
    return found


@final
class _Lane(dict[Any, Any]):
    """The values of names in one lane, each looked up when it is asked for."""

    def __init__(self, known: Mapping[Any, list[Any]], lane: int, letters: Mapping[Any, Any]):
        super().__init__(letters)
        self.known, self.lane = known, lane

    def __missing__(self, name: Any) -> Any:
        """Return the value of a name that is no letter."""
        found = self.known[name]
        return found[max(self.lane - 1, 0) % len(found)]


@final
class _Evaluation:
    """One evaluation, the algebra of its network; what cannot be told is no number (nan)."""

    def __init__(self, spec: Spec, counts: Mapping[str, int]) -> None:
        self.spec, self.one, self.rational = spec, exact(1), True
        self.untold, self.undefined = False, dict[str, None]()
        self.counts = {e.name: e.lanes for e in spec.of("hysteron") if e.lanes} | dict(counts)
        if max(self.counts.values(), default=0) > MAX_LANES:
            raise InputError(f"a point is computed for banks of {MAX_LANES} lanes at most")
        self.known: dict[Any, list[Any]] = {}

    def read(self, parameters: Given, inputs: Given, states: Given) -> None:
        """Take the numbers of a point; temperatures follow."""
        for name, own in self.spec.parameters.items():
            self.known["p", name] = _list(parameters.get(name, own))
        for name, default in self.spec.inputs.items():
            self.known["u", name] = _list(inputs.get(name, default))
        for state, owner in self.spec.states.items():
            starts = self.spec.initial.get(owner, (num(0),))
            given = states.get(state)
            told = (self.told(tree, state, n) for n, tree in enumerate(starts, 1))
            self.known["x", owner] = list(told) if given is None else _list(given)
        for body in self.spec.of("body"):
            T = self.told(body.laws["temperature"], body.name)
            self.known["T", body.name] = [arb(0) if T == 0 else T]  # W*z/T is then no number

    def words(self, lane: int, letters: Mapping[Any, Any] | None = None) -> dict[Any, Any]:
        """Return the values of names in one lane, and of letters."""
        return _Lane(self.known, lane, letters or {})

    def told(self, tree: Node, where: str, lane: int = 0, letter: Any = None) -> Any:
        """Return a law's value; nan if it has none or it cannot be told."""
        words = self.words(lane, {} if letter is None else {("z", where): letter})
        try:
            return compute(tree, words)
        except NoValue:
            self.undefined[where] = None
        except CannotTell:
            self.untold = True
        return arb("nan")

    def like(self, _: tuple[str, int]) -> Any:
        """Return how many lanes are like this one: it alone, each is there."""
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
        made = Point()
        try:
            self._book(flows(self.spec, self.counts, self), made)
        except SingularError:
            if self.rational:  # else more digits may find a pivot
                raise
            self.untold = True
        for body in self.spec.of("body"):
            slope = derivative(body.laws["temperature"], ("x", body.name))
            made.temperatures[body.name] = _plain(self.known["T", body.name][0])
            made.slopes[body.name] = _plain(self.told(slope, body.name))
        for e in self.spec.of("conduction", "ambient"):
            made.conductances[e.name] = _plain(self.law(e, "conductance", 0))
        made.conditions = tuple(map(self._holds, self.spec.conditions))
        made.undefined += tuple(self.undefined)
        return made

    def _book(self, found: Flows, made: Point) -> None:
        """Book letters, outputs, heats, productions, rates and their total."""
        total = exact(0)
        for (name, lane), W in found.outputs.items():
            z, T = found.letters[name, lane], self.given("T", self.spec.elements[name].bodies[0], 0)
            total = total + W * z / T
            values = {"letters": z, "outputs": W, "heats": W * z, "productions": W * z / T}
            for where, number in values.items():
                book = getattr(made, where)
                book[name] = (*book.get(name, ()), _plain(number))
        for e in self.spec.of("conduction"):
            first, second = (self.given("T", body, 0) for body in e.bodies)
            power = self.law(e, "conductance", 0) * (first - second)
            made.productions[e.name] = (_plain(power * (first - second) / (first * second)),)
            total = total + power * (first - second) / (first * second)
        for (name, _), rate in found.rates.items():
            state = self.spec.elements[name].state
            made.rates[state] = (*made.rates.get(state, ()), _plain(rate))
        made.sigma = _plain(total)

    def _holds(self, condition: Node) -> bool | None:
        """Return whether a condition holds, in every lane."""
        lanes = max((len(self.known[s]) for s in symbols(condition)), default=1)
        told: list[bool | None] = []
        for lane in range(1, lanes + 1):
            try:
                told.append(holds(condition, self.words(lane)))
            except NoValue:
                told.append(False)
            except CannotTell:
                self.untold = True
                told.append(None)
        return False if False in told else None if None in told else True


def _list(given: Any) -> list[Any]:
    several = isinstance(given, Sequence) and not isinstance(given, str)
    return [exact(v) for v in given] if several else [exact(given)]


def _plain(number: Any) -> Any:
    if isinstance(number, fmpq):
        return Fraction(int(number.p), int(number.q))
    return number if number.is_finite() else None
