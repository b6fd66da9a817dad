"""A spec at one point, exactly: rationals where all is rational, else enclosures that tell.

Input: a `Spec`, and numbers for parameters, inputs and states.  Output: a `Point`: letters and
outputs of every dissipative law per lane, temperatures, heats, rates, the production, and whether
each condition of the domain holds.  What 8192 bits do not decide is None: it cannot be told.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

from flint import arb, ctx, fmpq, fmpz

from .laws import InputError, Node, num, symbols
from .network import Solution, is_linear, lanes, parts, solve
from .spec import Element, Spec

PRECISIONS = (128, 512, 2048, 8192)
MAX_BITS, MAX_LANES = 40_000, 64
HUGE_EXP, HUGE = 2**34, 2**4096
Given = Mapping[str, Any]


class CannotTell(ArithmeticError):
    """The precision does not decide a comparison, or a number is beyond what is computed."""


class NoValue(ArithmeticError):
    """A law has no real value: a division by zero, a root or logarithm outside its domain."""


@dataclass
class Point:
    """What a spec says at a point; None where it cannot be told, `undefined` where it has no value.

    Per element and lane: `letters` z, `outputs` W, `heats` W*z, `productions`.  Per body:
    `temperatures`, `slopes` dT/dS.  Per state symbol and lane: `rates`.  `conditions` has (text,
    whether it holds) of the domain, `inside` whether all do.
    """

    letters: dict[str, tuple[Any, ...]] = field(default_factory=dict)
    outputs: dict[str, tuple[Any, ...]] = field(default_factory=dict)
    heats: dict[str, tuple[Any, ...]] = field(default_factory=dict)
    productions: dict[str, tuple[Any, ...]] = field(default_factory=dict)
    temperatures: dict[str, Any] = field(default_factory=dict)
    slopes: dict[str, Any] = field(default_factory=dict)
    conductances: dict[str, Any] = field(default_factory=dict)
    rates: dict[str, tuple[Any, ...]] = field(default_factory=dict)
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
    before, given = ctx.prec, (parameters or {}, inputs or {}, states or {}, counts or {})
    try:
        for bits in PRECISIONS:
            ctx.prec = bits
            evaluation = _Evaluation(spec, *given)
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
    return _plain(escalated(lambda: compute(tree, {k: exact(v) for k, v in words.items()})))


def escalated(made: Callable[[], Any]) -> Any:
    """Return what a computation gives at the first precision that decides it."""
    before = ctx.prec
    try:
        for bits in PRECISIONS:
            ctx.prec = bits
            try:
                return made()
            except CannotTell:
                if bits == PRECISIONS[-1]:
                    raise
    finally:
        ctx.prec = before


def exact(number: Any) -> Any:
    """Return a number as an exact rational of FLINT; enclosures stay."""
    if isinstance(number, arb | fmpq):
        return number
    ratio = Fraction(number)
    return fmpq(ratio.numerator, ratio.denominator)


def _plain(number: Any) -> Any:
    return Fraction(int(number.p), int(number.q)) if isinstance(number, fmpq) else number


def sign(number: Any) -> int:
    """Return the sign of a number; raises `CannotTell` if its enclosure does not tell."""
    if number > 0:
        return 1
    if number < 0:
        return -1
    if number == 0:
        return 0
    raise CannotTell


def holds(condition: Node, words: Mapping[Any, Any]) -> bool:
    """Return whether a comparison holds."""
    left, right = (compute(arg, words) for arg in condition.args)
    told = sign(left - right)
    return {"<": told < 0, "<=": told <= 0, ">": told > 0, ">=": told >= 0}[condition.value]


def compute(node: Node, words: Mapping[Any, Any]) -> Any:
    """Return the value of a law at the present precision; `words` has exact numbers."""
    if node.op == "num":
        return exact(node.value)
    if node.op == "sym":
        if words.get(node.value) is None:
            raise CannotTell
        return words[node.value]
    if node.op == "if":
        return compute(node.args[1 if holds(node.args[0], words) else 2], words)
    args = [compute(arg, words) for arg in node.args]
    found = _operation(node, args)
    if isinstance(found, fmpq) and found.p.bit_length() + found.q.bit_length() > MAX_BITS:
        found = arb(found)
    if not isinstance(found, fmpq) and not found.is_finite():
        raise CannotTell
    return found


def _operation(node: Node, args: list[Any]) -> Any:
    x, y = args[0], args[-1]
    match node.op:
        case "+":
            return sum(args[1:], x)
        case "neg":
            return -x
        case "*":
            return x * y
        case "/":
            return x / _nonzero(y)
        case "**":
            return _power(x, node.value)
        case "sqrt":
            return _power(x, Fraction(1, 2))
        case "abs":
            return abs(x)
        case "sign":
            return exact(sign(x))
        case "min" | "max":
            return _extreme(x, y, node.op)
        case "deadzone":
            zero = exact(0)
            return _extreme(x - y, zero, "max") + _extreme(x + y, zero, "min")
        case "saturate":
            return _extreme(_extreme(x, -y, "max"), y, "min")
    return _function(node.op, x)


def _nonzero(x: Any) -> Any:
    if sign(x) == 0:
        raise NoValue("division by zero")
    return x


def _extreme(x: Any, y: Any, which: str) -> Any:
    if isinstance(x, fmpq) and isinstance(y, fmpq):
        return min(x, y) if which == "min" else max(x, y)
    return arb(x).min(y) if which == "min" else arb(x).max(y)


def _power(x: Any, exponent: Fraction) -> Any:
    top, root = exponent.numerator, exponent.denominator
    if top < 0:
        x = _nonzero(x)
    if root > 1:
        if sign(x) < 0:
            raise NoValue("root of a negative number")
        x = _root(x, root)
    size = x ** abs(top)
    return 1 / size if top < 0 else size


def _root(x: Any, order: int) -> Any:
    if isinstance(x, fmpq):
        parts = [fmpz(part).root(order) for part in (x.p, x.q)]
        if parts[0] ** order == x.p and parts[1] ** order == x.q:
            return fmpq(*parts)
    return arb(x).root(order)


def _function(name: str, x: Any) -> Any:
    """Return exp, log, sin, cos or tanh; beyond all use it cannot be told."""
    if name == "log":
        if sign(x) <= 0:
            raise NoValue("logarithm of no positive number")
        return exact(0) if x == 1 else arb(x).log()
    if x == 0:
        return exact(1 if name in ("exp", "cos") else 0)
    if not abs(x) < (HUGE_EXP if name in ("exp", "tanh") else HUGE):
        raise CannotTell
    return getattr(arb(x), name)()


def derivative(node: Node, by: Any) -> Node:
    """Return the derivative of a law by a symbol, branch by branch."""
    zero, one = num(0), num(1)
    if node.op == "sym":
        return one if node.value == by else zero
    if by not in symbols(node):
        return zero
    if node.op == "if":
        return Node("if", (node.args[0], *(derivative(arg, by) for arg in node.args[1:])))
    inner = [derivative(arg, by) for arg in node.args]
    x, y, dx, dy = node.args[0], node.args[-1], inner[0], inner[-1]
    match node.op:
        case "+" | "neg":
            return Node(node.op, tuple(inner))
        case "*":
            return Node("+", (Node("*", (dx, y)), Node("*", (x, dy))))
        case "/":
            first, second = (
                Node("/", (dx, y)),
                Node("/", (Node("*", (x, dy)), Node("**", (y,), Fraction(2)))),
            )
            return first if dy == zero else Node("+", (first, Node("neg", (second,))))
        case "sign":
            return zero
        case "min" | "max" | "deadzone" | "saturate" | "abs":
            return derivative(unkinked(node), by)
    slopes = {
        "**": lambda: Node("*", (num(node.value or 0), Node("**", (x,), (node.value or 0) - 1))),
        "sqrt": lambda: Node("/", (num(Fraction(1, 2)), node)),
        "exp": lambda: node,
        "log": lambda: Node("/", (one, x)),
        "sin": lambda: Node("cos", (x,)),
        "cos": lambda: Node("neg", (Node("sin", (x,)),)),
        "tanh": lambda: Node("+", (one, Node("neg", (Node("**", (node,), Fraction(2)),)))),
    }
    return Node("*", (slopes[node.op](), dx))


def unkinked(node: Node) -> Node:
    """Return a function with kinks written as a choice, by its definition."""
    x, y = node.args[0], node.args[-1]
    minus, zero = Node("neg", (y,)), num(0)
    if node.op == "abs":
        return Node("if", (Node("cmp", (x, zero), ">="), x, Node("neg", (x,))))
    if node.op == "sign":
        below = Node("if", (Node("cmp", (x, zero), "<"), num(-1), zero))
        return Node("if", (Node("cmp", (x, zero), ">"), num(1), below))
    if node.op in ("min", "max"):
        return Node("if", (Node("cmp", (x, y), "<=" if node.op == "min" else ">="), x, y))
    if node.op == "saturate":
        return Node("min", (Node("max", (x, minus)), y))
    above, under = Node("+", (x, minus)), Node("+", (x, y))
    return Node("+", (Node("max", (above, zero)), Node("min", (under, zero))))


class _Evaluation:
    """One evaluation at a time; what cannot be told is left out of the words."""

    def __init__(
        self, spec: Spec, parameters: Given, inputs: Given, states: Given, counts: Mapping[str, int]
    ) -> None:
        self.spec = spec
        self.counts = {e.name: e.count or 1 for e in spec.of("hysteron") if e.count} | dict(counts)
        if max(self.counts.values(), default=0) > MAX_LANES:
            raise InputError(f"a point is computed for banks of {MAX_LANES} lanes at most")
        self.lanes: dict[Any, list[Any]] = {}
        self.undefined: list[str] = []
        self.untold = False
        for name, own in spec.parameters.items():
            self.lanes["p", name] = _list(parameters.get(name, own if len(own) > 1 else own[0]))
        for name, default in spec.inputs.items():
            self.lanes["u", name] = _list(inputs.get(name, default))
        for symbol, owner in spec.states.items():
            given = spec.initial.get(owner, (num(0),))
            self.lanes["x", owner] = (
                _list(states[symbol])
                if symbol in states
                else [self.told(t, self.words(n), symbol) for n, t in enumerate(given)]
            )

    def words(self, lane: int) -> dict[Any, Any]:
        """Return the values of names in one lane, from 0."""
        return {name: found[lane % len(found)] for name, found in self.lanes.items()}

    def told(self, tree: Node, words: Mapping[Any, Any], where: str) -> Any:
        """Return a law's value, or None if it has none or it cannot be told."""
        try:
            return compute(tree, words)
        except CannotTell:
            self.untold = True
            return None
        except NoValue:
            self.undefined.append(where)
            return None

    def point(self) -> Point:
        """Return the point."""
        made = Point()
        for body in self.spec.of("body"):
            law = body.laws["temperature"]
            slope = derivative(law, ("x", body.name))
            self.lanes["T", body.name] = [self.told(law, self.words(0), body.name)]
            made.temperatures[body.name] = self.lanes["T", body.name][0]
            made.slopes[body.name] = self.told(slope, self.words(0), body.name)
        solution = self._solution()
        for element in self.spec.of("resistor", "hysteron"):
            self._law(element, solution, made)
        self._rates(solution, made)
        made.conditions = tuple((text, self._holds(tree)) for text, tree in self.spec.conditions)
        made.undefined = tuple(dict.fromkeys(self.undefined))
        for name in ("temperatures", "slopes", "conductances"):
            setattr(made, name, {k: _plain(v) for k, v in getattr(made, name).items()})
        return made

    def _solution(self) -> Solution | None:
        """Return the solved network; None if a ratio or slope in it cannot be told."""
        ratio = {
            e.name: self.told(e.laws["ratio"], self.words(0), e.name)
            for e in self.spec.of("coupling")
        }
        slope = {}
        for e in self.spec.of("resistor", "hysteron"):
            letter = ("z", e.name)
            if e.law is not None and is_linear(e.law, letter):
                for lane in lanes(e, self.counts):
                    words = self.words(max(lane - 1, 0)) | {letter: exact(1)}
                    slope[e.name, lane] = self.told(e.law, words, e.name)
        if None in ratio.values() or None in slope.values():
            return None
        return solve(self.spec, self.counts, ratio, slope, exact(1))

    def _given(self, form: Mapping[Any, Any], outputs: Mapping[Any, Any]) -> Any:
        """Return the value of a combination of co-states, inputs and outputs."""
        total = exact(0)
        for label, factor in form.items():
            if label[0] == "u":
                found = self.lanes["u", self.spec.elements[label[1]].input][0]
            elif label[0] == "E":
                element = self.spec.elements[label[1]]
                found = self.told(
                    element.costate or num(0), self.words(max(label[2] - 1, 0)), label[1]
                )
            else:
                found = outputs.get(label)
            if found is None:
                return None
            total = total + factor * found
        return total

    def _law(self, element: Element, solution: Solution | None, made: Point) -> None:
        """Book letter, output, heat and production of one dissipative element, lane by lane."""
        found = []
        for part in parts(self.spec, self.counts):
            if solution is None or (part.element, part.role) != (element.name, "law"):
                continue
            form = solution.through[part] if part.across else solution.across[part]
            z = self._given(form, {})
            words = self.words(max(part.lane - 1, 0)) | {("z", element.name): z}
            output = self.told(element.law or num(0), words, element.name)
            temperature = made.temperatures.get(element.bodies[0])
            heat = None if z is None or output is None else output * z
            found.append((z, output, heat, _over(heat, temperature)))
        columns = zip(*found, strict=True) if found else ((), (), (), ())
        names = ("letters", "outputs", "heats", "productions")
        for name, column in zip(names, columns, strict=True):
            getattr(made, name)[element.name] = tuple(map(_plain, column))

    def _rates(self, solution: Solution | None, made: Point) -> None:
        """Book the rates of states and the production."""
        flows: dict[str, Any] = dict.fromkeys(made.temperatures, exact(0))
        for element in self.spec.of("resistor", "hysteron"):
            for produced in made.productions[element.name] or (None,):
                _add(flows, element.bodies[0], None if produced is None else exact(produced))
        for element in self.spec.of("conduction", "ambient"):
            conductance = self.told(element.laws["conductance"], self.words(0), element.name)
            made.conductances[element.name] = conductance
            self._exchange(element, conductance, flows, made)
        outputs = {
            ("W", name, lane if self.spec.elements[name].count is not None else 0): exact(w)
            for name, found in made.outputs.items()
            for lane, w in enumerate(found, 1)
            if w is not None
        }
        for part in parts(self.spec, self.counts) if solution else ():
            if part.role == "store" and solution:
                form = solution.through[part] if part.across else solution.across[part]
                symbol = self.spec.elements[part.element].state
                rate = _plain(self._given(form, outputs))
                made.rates[symbol] = (*made.rates.get(symbol, ()), rate)
        for body, flow in flows.items():
            made.rates[self.spec.elements[body].state] = (_plain(flow),)
        produced = [p for found in made.productions.values() for p in found]
        told = solution is not None and None not in produced
        made.sigma = _plain(sum(map(exact, produced), exact(0))) if told else None

    def _exchange(self, element: Element, lam: Any, flows: dict[str, Any], made: Point) -> None:
        """Book conduction and exchange with an environment."""
        heat = [made.temperatures[body] for body in element.bodies]
        if lam is None or None in heat or any(T == 0 for T in heat):
            for body in element.bodies:
                _add(flows, body, None)
            if element.kind.form == "conduction":
                made.productions[element.name] = (None,)
            return
        if element.kind.form == "ambient":
            given = self.lanes["u", element.input][0]
            _add(flows, element.bodies[0], lam * (given / heat[0] - 1))
            return
        power = lam * (heat[0] - heat[1])
        _add(flows, element.bodies[0], -power / heat[0])
        _add(flows, element.bodies[1], power / heat[1])
        made.productions[element.name] = (
            _plain(power * (heat[0] - heat[1]) / (heat[0] * heat[1])),
        )

    def _holds(self, condition: Node) -> bool | None:
        """Return whether a condition holds, in every lane."""
        used = [len(self.lanes[s]) for s in symbols(condition) if s in self.lanes]
        told: list[bool | None] = []
        for lane in range(max(used, default=1)):
            words = self.words(lane)
            try:
                told.append(holds(condition, words))
            except CannotTell:
                self.untold = True
                told.append(None)
            except NoValue:
                told.append(False)
        return False if False in told else None if None in told else True


def _list(given: Any) -> list[Any]:
    several = isinstance(given, Sequence) and not isinstance(given, str)
    return [exact(v) for v in given] if several else [exact(given)]


def _add(flows: dict[str, Any], body: str, flow: Any) -> None:
    flows[body] = None if flow is None or flows[body] is None else flows[body] + flow


def _over(heat: Any, temperature: Any) -> Any:
    known = heat is not None and temperature is not None and temperature != 0
    return heat / temperature if known else None
