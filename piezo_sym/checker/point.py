"""A spec at one point, exactly: rationals where all is rational, else enclosures that tell.

Input: a `Spec`, and numbers for parameters, inputs and states.  Output: a `Point`.  What 8192 bits
do not decide is None: it cannot be told.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

from flint import arb, ctx, fmpq, fmpz

from .laws import InputError, Node, minus, num, symbols, unkinked
from .network import Flows, SingularError, flows
from .spec import Element, Spec

PRECISIONS = (128, 512, 2048, 8192)
MAX_BITS, MAX_LANES = 40_000, 64
HUGE = {"exp": 2**34, "tanh": 2**34, "sin": 2**4096, "cos": 2**4096}
Given = Mapping[str, Any]
Values = tuple[Any, ...]


class CannotTell(ArithmeticError):
    """The precision does not decide a comparison, or a number is beyond what is computed."""


class NoValue(ArithmeticError):
    """A law has no real value: a division by zero, a root or logarithm outside its domain."""


@dataclass
class Point:
    """What a spec says at a point; None where it cannot be told or (`undefined`) has no value.

    Per element and lane: `letters` z, `outputs` W, `heats` W*z, `productions`; per body:
    `temperatures`, `slopes` dT/dS; `conductances`; per state symbol and lane: `rates`.
    `conditions` has (text, whether it holds) of the domain, `inside` whether all do.
    """

    letters: dict[str, Values] = field(default_factory=dict)
    outputs: dict[str, Values] = field(default_factory=dict)
    heats: dict[str, Values] = field(default_factory=dict)
    productions: dict[str, Values] = field(default_factory=dict)
    temperatures: dict[str, Any] = field(default_factory=dict)
    slopes: dict[str, Any] = field(default_factory=dict)
    conductances: dict[str, Any] = field(default_factory=dict)
    rates: dict[str, Values] = field(default_factory=dict)
    conditions: tuple[tuple[str, bool | None], ...] = ()
    sigma: Any = None
    undefined: tuple[str, ...] = ()

    @property
    def inside(self) -> bool | None:
        """Whether the point is in the domain."""
        told = [holds for _, holds in self.conditions]
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


def value(tree: Node, words: Mapping[Any, Any]) -> Any:
    """Return the exact value of a law, a Fraction or an enclosure.

    Raises
    ------
    NoValue
        If it has none.
    CannotTell
        If no precision tells.
    """
    before, given = ctx.prec, {name: exact(number) for name, number in words.items()}
    try:
        for ctx.prec in PRECISIONS[:-1]:
            try:
                return _plain(compute(tree, given))
            except CannotTell:
                continue
        ctx.prec = PRECISIONS[-1]
        return _plain(compute(tree, given))
    finally:
        ctx.prec = before


def exact(number: Any) -> Any:
    """Return a number as an exact rational of FLINT; enclosures stay."""
    if not isinstance(number, int | float | Fraction):
        return number
    ratio = Fraction(number)
    return fmpq(ratio.numerator, ratio.denominator)


def real(number: Any) -> Any:
    """Return a rational as an enclosure."""
    return arb(number) if isinstance(number, fmpq) else number


def _plain(number: Any) -> Any:
    if isinstance(number, fmpq):
        return Fraction(int(number.p), int(number.q))
    return number if number is not None and number.is_finite() else None


def sign(number: Any) -> int:
    """Return the sign of a number; raises `CannotTell` if its enclosure does not tell."""
    told = 1 if number > 0 else -1 if number < 0 else 0 if number == 0 else None
    if told is None:
        raise CannotTell
    return told


def holds(condition: Node, words: Mapping[Any, Any]) -> bool:
    """Return whether a comparison holds."""
    told = sign(compute(minus(*condition.args), words))
    return {"<": told < 0, "<=": told <= 0, ">": told > 0, ">=": told >= 0}[condition.value]


def compute(node: Node, words: Mapping[Any, Any]) -> Any:
    """Return the value of a law at the present precision; `words` has exact numbers."""
    if node.op == "num":
        return exact(node.value)
    if node.op == "sym":
        return words[node.value]
    if node.op == "if":
        return compute(node.args[1 if holds(node.args[0], words) else 2], words)
    if node.op == "abs":
        node = Node("max", (node.args[0], Node("neg", node.args)))
    if node.op in ("deadzone", "saturate"):
        return compute(unkinked(node), words)
    args = [compute(arg, words) for arg in node.args]
    found = _operation(node, args[0], args[-1]) if node.op != "+" else sum(args[1:], args[0])
    if isinstance(found, fmpq):
        long = found.p.bit_length() + found.q.bit_length() > MAX_BITS
        return arb(found) if long else found
    if not found.is_finite():
        raise CannotTell
    return found


def _operation(node: Node, x: Any, y: Any) -> Any:
    match node.op:
        case "neg":
            return -x
        case "*":
            return x * y
        case "/":
            return x / _nonzero(y)
        case "**" | "sqrt":
            return _power(x, Fraction(1, 2) if node.op == "sqrt" else node.value)
        case "sign":
            return exact(sign(x))
        case "min" | "max":
            try:
                return x if (sign(x - y) >= 0) == (node.op == "max") else y
            except CannotTell:
                return real(x).min(y) if node.op == "min" else real(x).max(y)
        case "log":
            if sign(x) <= 0:
                raise NoValue("logarithm of no positive number")
            return exact(0) if x == 1 else real(x).log()
    if x == 0:
        return exact(1 if node.op in ("exp", "cos") else 0)
    if not abs(x) < HUGE[node.op]:
        raise CannotTell
    return getattr(real(x), node.op)()


def _nonzero(x: Any) -> Any:
    if sign(x) == 0:
        raise NoValue("division by zero")
    return x


def _power(x: Any, exponent: Fraction) -> Any:
    top, order = exponent.numerator, exponent.denominator
    x = _nonzero(x) if top < 0 else x
    if order > 1:
        if sign(x) < 0:
            raise NoValue("root of a negative number")
        roots = [fmpz(n).root(order) for n in (x.p, x.q)] if isinstance(x, fmpq) else [0, 0]
        rational = isinstance(x, fmpq) and fmpq(*roots) ** order == x
        x = fmpq(*roots) if rational else real(x).root(order)
    return 1 / x ** abs(top) if top < 0 else x**top


def derivative(node: Node, by: Any) -> Node:
    """Return the derivative of a law by a symbol, branch by branch."""
    zero, one, two = num(0), num(1), Fraction(2)
    if by not in symbols(node) or node.op == "sym":
        return num(int(node.op == "sym" and node.value == by))
    if node.op == "if":
        return Node("if", (node.args[0], *(derivative(arg, by) for arg in node.args[1:])))
    inner = tuple(derivative(arg, by) for arg in node.args)
    x, y, dx, dy = node.args[0], node.args[-1], inner[0], inner[-1]
    match node.op:
        case "+" | "neg":
            return Node(node.op, inner)
        case "*":
            return Node("+", (Node("*", (dx, y)), Node("*", (x, dy))))
        case "/":
            over = Node("/", (Node("*", (x, dy)), Node("**", (y,), two)))
            return Node("/", (dx, y)) if dy == zero else minus(Node("/", (dx, y)), over)
        case "min" | "max" | "deadzone" | "saturate" | "abs" | "sign":
            return derivative(unkinked(node), by)
        case "**":
            slope = Node("*", (num(node.value), Node("**", (x,), node.value - 1)))
        case "sqrt":
            slope = Node("/", (num(Fraction(1, 2)), node))
        case "log":
            slope = Node("/", (one, x))
        case "sin" | "cos":
            turned = Node("cos" if node.op == "sin" else "sin", (x,))
            slope = turned if node.op == "sin" else Node("neg", (turned,))
        case _:
            slope = node if node.op == "exp" else minus(one, Node("**", (node,), two))
    return Node("*", (slope, dx))


class _Evaluation:
    """One evaluation, the algebra of its network; what cannot be told is no number (nan)."""

    def __init__(self, spec: Spec, counts: Mapping[str, int]) -> None:
        self.spec, self.one, self.untold, self.undefined = spec, exact(1), False, dict[str, None]()
        self.counts = {e.name: e.count for e in spec.of("hysteron") if e.count} | dict(counts)
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
            self.known["T", body.name] = [self.told(body.laws["temperature"], body.name)]

    def words(self, lane: int) -> dict[Any, Any]:
        """Return the values of names in one lane."""
        return {name: found[max(lane - 1, 0) % len(found)] for name, found in self.known.items()}

    def told(self, tree: Node, where: str, lane: int = 0, letter: Any = None) -> Any:
        """Return a law's value; nan if it has none or it cannot be told."""
        words = self.words(lane) | ({} if letter is None else {("z", where): letter})
        try:
            return compute(tree, words)
        except NoValue:
            self.undefined[where] = None
        except CannotTell:
            self.untold = True
        return arb("nan")

    def law(self, element: Element, field: str, lane: int, letter: Any = None) -> Any:
        """Return the value of a law."""
        tree = element.law if field == "law" else element.laws[field]
        return self.told(tree or num(0), element.name, lane, letter)

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
        except (SingularError, ZeroDivisionError):
            self.untold, made.undefined = True, ("network",)
        for body in self.spec.of("body"):
            slope = derivative(body.laws["temperature"], ("x", body.name))
            made.temperatures[body.name] = _plain(self.known["T", body.name][0])
            made.slopes[body.name] = _plain(self.told(slope, body.name))
        for e in self.spec.of("conduction", "ambient"):
            made.conductances[e.name] = _plain(self.law(e, "conductance", 0))
        made.conditions = tuple((text, self._holds(tree)) for text, tree in self.spec.conditions)
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
