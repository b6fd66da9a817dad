"""Claims on laws for every real number of a domain, asked of cvc5.

Input: trees.  Output: whether a claim follows.  Laws and conditions go whole, choices as `ite`.
Every function is a symbol of which implications are known that hold for all real numbers, their
premise being the function's own domain: b != 0 -> q*b = a.  Nothing is assumed of a path.  What
is left undecided is split by a comparison in it and its opposite, which together are all there is.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from time import monotonic
from typing import Any, NamedTuple

import cvc5
from cvc5 import Kind

from .laws import Node, compare, negated, num, symbols, walk
from .point import unkinked

EFFORT, SPLIT_EFFORT, MILLISECONDS, SECONDS = 150_000, 40_000, 8_000, 300
MOST_PAIRS, DEEPEST = 20, 5
KINKED = ("abs", "sign", "min", "max", "deadzone", "saturate")
COMPARE = {"<": Kind.LT, "<=": Kind.LEQ, ">": Kind.GT, ">=": Kind.GEQ}


class Claim(NamedTuple):
    """A comparison (``!=`` and ``=`` too) that is to follow where `path` is taken."""

    path: tuple[Node, ...]
    claim: Node


class Encoder:
    """Trees as terms, and the facts on the functions in them."""

    def __init__(self, effort: int, assumed: Iterable[Node] = ()) -> None:
        self.tm = cvc5.TermManager()
        self.solver = cvc5.Solver(self.tm)
        self.solver.setOption("rlimit-per", str(effort))
        self.solver.setOption("tlimit-per", str(MILLISECONDS))
        self.solver.setLogic("QF_NRA")
        self.known: dict[Any, Any] = {}
        self.calls: dict[str, list[tuple[Any, Any]]] = {}
        self.assumed = {condition: True for condition in assumed}
        self.assumed |= {negated(condition): False for condition in self.assumed}

    def real(self, value: Any) -> Any:
        """Return a number's term."""
        ratio = Fraction(value)
        return self.tm.mkReal(f"{ratio.numerator}/{ratio.denominator}")

    def fresh(self) -> Any:
        """Return a new real constant."""
        return self.tm.mkConst(self.tm.getRealSort(), f"y{len(self.known)}")

    def make(self, kind: Kind, *args: Any) -> Any:
        """Return a term; numbers stand for themselves."""
        plain = (self.real(a) if isinstance(a, int | Fraction) else a for a in args)
        return self.tm.mkTerm(kind, *plain)

    def holds(self, condition: Node) -> Any:
        """Return the term of a comparison."""
        if condition in self.assumed:
            return self.tm.mkBoolean(self.assumed[condition])
        left, right = map(self.term, condition.args)
        if condition.value in ("=", "!="):
            same = self.make(Kind.EQUAL, left, right)
            return same if condition.value == "=" else self.make(Kind.NOT, same)
        return self.make(COMPARE[condition.value], left, right)

    def term(self, node: Node) -> Any:
        """Return the term of a tree, the same for the same tree."""
        if node not in self.known:
            self.known[node] = self._made(node)
        return self.known[node]

    def _made(self, node: Node) -> Any:
        if node.op == "num":
            return self.real(node.value)
        if node.op == "sym":
            return self.fresh()
        if node.op == "if":
            if node.args[0] in self.assumed:
                return self.term(node.args[1 if self.assumed[node.args[0]] else 2])
            return self.make(Kind.ITE, self.holds(node.args[0]), *map(self.term, node.args[1:]))
        if node.op in KINKED:
            return self.term(unkinked(node))
        args = [self.term(arg) for arg in node.args]
        kinds = {"+": Kind.ADD, "*": Kind.MULT, "neg": Kind.NEG}
        if node.op in kinds:
            return self.make(kinds[node.op], *args)
        if node.op == "/" and node.args[1].op == "num" and node.args[1].value:
            return self.make(Kind.MULT, self.real(1 / node.args[1].value), args[0])
        if node.op == "/":
            return self.quotient(args[0], args[1])
        if node.op in ("**", "sqrt"):
            return self.power(args[0], node.value if node.op == "**" else Fraction(1, 2))
        return self.function(node, args[0])

    def fact(self, premise: Any, *facts: Any) -> None:
        """Assert that something is known where its premise holds."""
        for known in facts:
            self.solver.assertFormula(self.make(Kind.IMPLIES, premise, known) if premise else known)

    def quotient(self, top: Any, bottom: Any) -> Any:
        """Return q with bottom != 0 -> q*bottom = top."""
        q = self.fresh()
        here = self.make(Kind.NOT, self.make(Kind.EQUAL, bottom, 0))
        self.fact(here, self.make(Kind.EQUAL, self.make(Kind.MULT, q, bottom), top))
        return q

    def power(self, x: Any, exponent: Fraction) -> Any:
        """Return x**(p/q), by a root y with x >= 0 -> y >= 0 and y**q = x."""
        if exponent.denominator > 1:
            y = self.fresh()
            here = self.make(Kind.GEQ, x, 0)
            raised = self.times(y, exponent.denominator)
            self.fact(here, self.make(Kind.GEQ, y, 0), self.make(Kind.EQUAL, raised, x))
            x = y
        size = self.times(x, abs(exponent.numerator))
        return size if exponent > 0 else self.quotient(self.real(1), size)

    def times(self, x: Any, count: int) -> Any:
        """Return x*...*x."""
        return self.real(1) if count == 0 else x if count == 1 else self.make(Kind.MULT, *([x] * count))

    def function(self, node: Node, x: Any) -> Any:
        """Return the symbol of exp, log, sin, cos or tanh, with bounds and relations."""
        y, name, inner = self.fresh(), node.op, node.args[0]
        getattr(self, f"_{name}")(x, y)
        inverse = {"exp": "log", "log": "exp"}.get(name)
        if inner.op == inverse:  # exp(log(a)) = a where a > 0, log(exp(a)) = a
            a = self.term(inner.args[0])
            premise = self.make(Kind.GT, a, 0) if name == "exp" else None
            self.fact(premise, self.make(Kind.EQUAL, y, a))
        others = self.calls.setdefault(name, [])
        for x_2, y_2 in others[:MOST_PAIRS]:
            self._pair(name, (x, y), (x_2, y_2))
        others.append((x, y))
        return y

    def _exp(self, x: Any, y: Any) -> None:
        one, square = self.make(Kind.ADD, 1, x), self.make(Kind.MULT, Fraction(1, 2), x, x)
        cube = self.make(Kind.MULT, Fraction(1, 6), x, x, x)
        left, right = self.make(Kind.LEQ, x, 0), self.make(Kind.GEQ, x, 0)
        turned = self.make(Kind.MULT, y, self.make(Kind.SUB, 1, x))
        self.fact(None, self.make(Kind.GT, y, 0), self.make(Kind.GEQ, y, one))
        self.fact(self.make(Kind.LT, x, 1), self.make(Kind.LEQ, turned, 1))
        self.fact(right, self.make(Kind.GEQ, y, self.make(Kind.ADD, one, square, cube)))
        self.fact(left, self.make(Kind.LEQ, y, 1))
        self.fact(left, self.make(Kind.LEQ, y, self.make(Kind.ADD, one, square)))

    def _log(self, x: Any, y: Any) -> None:
        less = self.make(Kind.SUB, x, 1)
        upper = self.make(Kind.LEQ, y, less)
        self.fact(self.make(Kind.GT, x, 0), upper, self.make(Kind.GEQ, self.make(Kind.MULT, x, y), less))

    def _sin(self, x: Any, y: Any) -> None:
        self.fact(None, self.make(Kind.LEQ, y, 1), self.make(Kind.GEQ, y, -1))
        self._below_its_argument(x, y, Fraction(1, 6))

    def _tanh(self, x: Any, y: Any) -> None:
        self.fact(None, self.make(Kind.LT, y, 1), self.make(Kind.GT, y, -1))
        for kind in (Kind.GT, Kind.LT):
            self.fact(self.make(kind, x, 0), self.make(kind, y, 0))
        self._below_its_argument(x, y, Fraction(1, 3))

    def _below_its_argument(self, x: Any, y: Any, third: Fraction) -> None:
        cubic = self.make(Kind.SUB, x, self.make(Kind.MULT, third, x, x, x))
        for side, other in ((Kind.GEQ, Kind.LEQ), (Kind.LEQ, Kind.GEQ)):
            self.fact(self.make(side, x, 0), self.make(other, y, x), self.make(side, y, cubic))

    def _cos(self, x: Any, y: Any) -> None:
        square = self.make(Kind.MULT, Fraction(1, 2), x, x)
        fourth = self.make(Kind.MULT, Fraction(1, 24), x, x, x, x)
        least = self.make(Kind.SUB, 1, square)
        self.fact(None, self.make(Kind.LEQ, y, 1), self.make(Kind.GEQ, y, -1))
        self.fact(None, self.make(Kind.GEQ, y, least))
        self.fact(None, self.make(Kind.LEQ, y, self.make(Kind.ADD, least, fourth)))

    def _pair(self, name: str, first: tuple[Any, Any], second: tuple[Any, Any]) -> None:
        """Assert what two values of one function have to do with each other."""
        (x, y), (x_2, y_2) = first, second
        opposite = self.make(Kind.EQUAL, self.make(Kind.ADD, x, x_2), 0)
        if name in ("sin", "cos"):
            self.fact(self.make(Kind.EQUAL, x, x_2), self.make(Kind.EQUAL, y, y_2))
        else:
            rises = self.make(Kind.EQUAL, self.make(Kind.LT, x, x_2), self.make(Kind.LT, y, y_2))
            same = self.make(Kind.EQUAL, self.make(Kind.EQUAL, x, x_2), self.make(Kind.EQUAL, y, y_2))
            inside = [self.make(Kind.GT, a, 0) for a in (x, x_2)]
            self.fact(self.make(Kind.AND, *inside) if name == "log" else None, rises, same)
        reflected = {"cos": self.make(Kind.EQUAL, y, y_2), "exp": self.make(Kind.EQUAL, self.make(Kind.MULT, y, y_2), 1)}
        if name != "log":
            total = self.make(Kind.EQUAL, self.make(Kind.ADD, y, y_2), 0)
            self.fact(opposite, reflected.get(name, total))

    def check(self) -> str:
        """Return sat, unsat or unknown."""
        result = self.solver.checkSat()
        return "unsat" if result.isUnsat() else "sat" if result.isSat() else "unknown"


class Prover:
    """Answers claims under the conditions of a domain, and `ties` between names and states."""

    def __init__(self, domain: Sequence[Node], ties: Sequence[Node] = ()) -> None:
        self.domain, self.ties, self.deadline = tuple(domain), tuple(ties), monotonic() + SECONDS
        self.answers: dict[Any, str] = {}

    def proves(self, claim: Node, path: tuple[Node, ...] = ()) -> bool:
        """Return whether a claim follows from the domain and a path."""
        key = (claim, path)
        if key not in self.answers:
            everything = (*self.domain, *self.ties)
            for where in dict.fromkeys((self._near((claim, *path)), self.domain, everything)):
                result = self._ask(claim, (*where, *path), EFFORT)
                if result == "unknown":
                    result = self._split(claim, (*where, *path), (), 0)
                self.answers[key] = result
                if result == "unsat":
                    break
        return self.answers[key] == "unsat"

    def _near(self, about: Iterable[Node]) -> tuple[Node, ...]:
        """Return the conditions on the symbols of a claim alone."""
        names = {name for tree in about for name in symbols(tree)}
        return tuple(c for c in self.domain if set(symbols(c)) <= names)

    def _ask(
        self, claim: Node, where: tuple[Node, ...], effort: int, assumed: tuple[Node, ...] = ()
    ) -> str:
        if monotonic() > self.deadline:
            return "out of time"
        encoder = Encoder(effort, assumed)
        for condition in where:
            encoder.fact(None, encoder.holds(condition))
        for condition in assumed:
            left, right = map(encoder.term, condition.args)
            encoder.fact(None, encoder.make(COMPARE[condition.value], left, right))
        encoder.fact(None, encoder.make(Kind.NOT, encoder.holds(claim)))
        return encoder.check()

    def _split(self, claim: Node, where: tuple[Node, ...], assumed: tuple[Node, ...], depth: int) -> str:
        """Return the answer from a comparison in the claim and its opposite, each assumed."""
        found = next((c for c in choices(claim) if c not in assumed and negated(c) not in assumed), None)
        if found is None or depth == DEEPEST:
            return "unknown"
        for side in (found, negated(found)):
            result = self._ask(claim, where, SPLIT_EFFORT, (*assumed, side))
            if result == "unknown":
                result = self._split(claim, where, (*assumed, side), depth + 1)
            if result != "unsat":
                return result
        return "unsat"


def choices(tree: Node) -> Iterator[Node]:
    """Yield the comparisons that choose in a tree, those of functions with kinks too."""
    for node in walk(tree):
        if node.op in KINKED:
            yield from choices(unkinked(node))
        elif node.op == "if":
            yield node.args[0]


def partial(node: Node, path: tuple[Node, ...] = (), relax: bool = False) -> Iterator[Claim]:
    """Yield what must hold for a tree to have a value, where each part is reached."""
    if node.op == "if":
        condition = node.args[0]
        yield from partial(condition, path, relax)
        for side, arg in zip((condition, negated(condition)), node.args[1:], strict=True):
            wide = {"<": "<=", ">": ">="}.get(side.value, side.value) if relax else side.value
            yield from partial(arg, (*path, Node("cmp", side.args, wide)), relax)
        return
    for arg in node.args:
        yield from partial(arg, path, relax)
    first = node.args[0] if node.args else node
    if node.op == "/" and not (node.args[1].op == "num" and node.args[1].value):
        yield Claim(path, compare(node.args[1], "!=", 0))
    elif node.op == "sqrt" or (node.op == "**" and node.value.denominator > 1 and node.value > 0):
        yield Claim(path, compare(first, ">=", 0))
    elif node.op == "log" or (node.op == "**" and node.value.denominator > 1):
        yield Claim(path, compare(first, ">", 0))
    elif node.op == "**" and node.value < 0:
        yield Claim(path, compare(first, "!=", 0))
