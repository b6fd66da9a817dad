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

from .laws import KINKED, Node, compare, negated, num, parse, put, sym, symbols, unkinked, walk

EFFORT, SPLIT_EFFORT, MILLISECONDS, SECONDS = 150_000, 40_000, 8_000, 300
MOST_PAIRS, DEEPEST = 12, 5
KINDS = {"<": Kind.LT, "<=": Kind.LEQ, ">": Kind.GT, ">=": Kind.GEQ, "=": Kind.EQUAL}
KINDS |= {"+": Kind.ADD, "*": Kind.MULT, "neg": Kind.NEG}
#: What is known of y = f(x), and of two values y and b of f at x and a: "premise: fact".
FACTS = {
    "exp": "y > 0; y >= 1 + x; x <= 0: y <= 1; x <= 0: y <= 1 + x + x**2/2; x < 1: y*(1 - x) <= 1;"
    "x >= 0: y >= 1 + x + x**2/2 + x**3/6; x <= 0: y*(1 - x + x**2/2 - x**3/6) <= 1",
    "log": "x > 0: y <= x - 1; x > 0: x*y >= x - 1; x > 0: x*y**2 <= (x - 1)**2",
    "sin": "y <= 1; y >= -1; x >= 0: y <= x; x <= 0: y >= x; x >= 0: y >= x - x**3/6;"
    "x <= 0: y <= x - x**3/6",
    "cos": "y <= 1; y >= -1; y >= 1 - x**2/2; y <= 1 - x**2/2 + x**4/24",
    "tanh": "y < 1; y > -1; x >= 0: y <= x; x <= 0: y >= x; x >= 0: y >= x - x**3/3; x > 0: y > 0;"
    "x <= 0: y <= x - x**3/3; x < 0: y < 0; x >= 0: (1 - y)*(1 + x + x**2) <= 1;"
    "x <= 0: (1 + y)*(1 - x + x**2) <= 1",
}
RISING = "x < a: y < b; x > a: y > b"
PAIRS = {
    "exp": f"{RISING}; x + a <= 0: y*b <= 1; x + a >= 0: y*b >= 1",
    "log": f"{RISING}; x*a >= 1: y + b >= 0; x*a <= 1: y + b <= 0",
    "tanh": f"{RISING}; x + a <= 0: y + b <= 0; x + a >= 0: y + b >= 0",
}


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
        self.known: dict[Node, Any] = {}
        self.calls: dict[str, list[tuple[Node, Node]]] = {}
        self.assumed = {condition: True for condition in assumed}
        self.assumed |= {negated(condition): False for condition in self.assumed}

    def holds(self, condition: Node) -> Any:
        """Return the term of a comparison."""
        if condition in self.assumed:
            return self.tm.mkBoolean(self.assumed[condition])
        return self.plain(condition)

    def plain(self, condition: Node) -> Any:
        """Return the term of a comparison as it stands."""
        left, right = map(self.term, condition.args)
        if condition.value == "!=":
            return self.tm.mkTerm(Kind.NOT, self.tm.mkTerm(Kind.EQUAL, left, right))
        return self.tm.mkTerm(KINDS[condition.value], left, right)

    def know(self, fact: Node, premise: Node | None = None) -> None:
        """Assert a comparison, or that it holds where its premise does."""
        term = self.plain(fact)
        if premise:
            term = self.tm.mkTerm(Kind.IMPLIES, self.plain(premise), term)
        self.solver.assertFormula(term)

    def term(self, node: Node) -> Any:
        """Return the term of a tree, the same for the same tree."""
        if node not in self.known:
            self.known[node] = self._made(node)
        return self.known[node]

    def _made(self, node: Node) -> Any:
        if node.op == "num":
            return self.tm.mkReal(f"{node.value.numerator}/{node.value.denominator}")
        if node.op == "sym":
            return self.tm.mkConst(self.tm.getRealSort(), f"x{len(self.known)}")
        if node.op == "if" and node.args[0] in self.assumed:
            return self.term(node.args[1 if self.assumed[node.args[0]] else 2])
        if node.op == "if":
            parts = [self.holds(node.args[0]), *map(self.term, node.args[1:])]
            return self.tm.mkTerm(Kind.ITE, *parts)
        if node.op in KINKED:
            return self.term(unkinked(node))
        if node.op in KINDS:
            args = [self.term(arg) for arg in node.args]
            return args[0] if node.op == "+" and len(args) == 1 else self.tm.mkTerm(KINDS[node.op], *args)
        x, y = node.args[0], sym(("value", node))
        if node.op == "/":
            bottom = node.args[1]
            if bottom.op == "num" and bottom.value:
                return self.term(Node("*", (num(1 / bottom.value), x)))
            self.know(compare(Node("*", (y, bottom)), "=", x), compare(bottom, "!=", 0))
        elif node.op in ("**", "sqrt"):
            return self.term(self._power(x, node.value if node.op == "**" else Fraction(1, 2)))
        else:
            self._function(node, x, y)
        return self.term(y)

    def _power(self, x: Node, exponent: Fraction) -> Node:
        """Return x**(p/q) in products, by y with x >= 0 -> y >= 0 and y**q = x."""
        if exponent.denominator > 1:
            y = sym(("root", exponent.denominator, x))
            raised = _times(y, exponent.denominator)
            for fact in (compare(y, ">=", 0), compare(raised, "=", x)):
                self.know(fact, compare(x, ">=", 0))
            x = y
        size = _times(x, abs(exponent.numerator))
        return size if exponent >= 0 else Node("/", (num(1), size))

    def _function(self, node: Node, x: Node, y: Node) -> None:
        """Assert what is known of exp, log, sin, cos or tanh, alone and of two values of one."""
        inverse = {"exp": "log", "log": "exp"}.get(node.op)
        if x.op == inverse:  # exp(log(a)) = a where a > 0, log(exp(a)) = a
            a = x.args[0]
            self.know(compare(y, "=", a), compare(a, ">", 0) if inverse == "log" else None)
        self._facts(FACTS[node.op], {"x": x, "y": y}, ())
        others = self.calls.setdefault(node.op, [])
        for a, b in others[:MOST_PAIRS]:
            inside = (compare(x, ">", 0), compare(a, ">", 0)) if node.op == "log" else ()
            self._facts(PAIRS.get(node.op, ""), {"x": x, "y": y, "a": a, "b": b}, inside)
            for turned in (a, Node("neg", (a,))) if node.op in ("sin", "cos") else ():
                odd = node.op == "sin" and turned is not a
                self.know(compare(y, "=", Node("neg", (b,)) if odd else b), compare(x, "=", turned))
        others.append((x, y))

    def _facts(self, texts: str, words: dict[str, Node], inside: tuple[Node, ...]) -> None:
        for text in filter(None, texts.split(";")):
            *premises, fact = (put(parse(part), words) for part in text.split(":"))
            terms = [self.plain(part) for part in (*inside, *premises)]
            known = self.plain(fact)
            for premise in terms:
                known = self.tm.mkTerm(Kind.IMPLIES, premise, known)
            self.solver.assertFormula(known)

    def check(self) -> str:
        """Return sat, unsat or unknown."""
        result = self.solver.checkSat()
        return "unsat" if result.isUnsat() else "sat" if result.isSat() else "unknown"


def _times(x: Node, count: int) -> Node:
    return num(1) if count == 0 else x if count == 1 else Node("*", (x,) * count)


class Prover:
    """Answers claims under the conditions of a domain, and `ties` between names and states."""

    def __init__(self, domain: Sequence[Node], ties: Sequence[Node] = ()) -> None:
        self.domain, self.ties, self.deadline = tuple(domain), tuple(ties), monotonic() + SECONDS
        self.answers: dict[Claim, bool] = {}

    def proves(self, claim: Node, path: tuple[Node, ...] = ()) -> bool:
        """Return whether a claim follows from the domain and a path."""
        key = Claim(path, claim)
        if key not in self.answers:
            names = {name for tree in (claim, *path) for name in symbols(tree)}
            near = tuple(c for c in self.domain if set(symbols(c)) <= names)
            tries = dict.fromkeys((near, self.domain, (*self.domain, *self.ties)))
            self.answers[key] = any(self._follows(claim, (*where, *path)) for where in tries)
        return self.answers[key]

    def _follows(self, claim: Node, where: tuple[Node, ...]) -> bool:
        result = self._ask(claim, where, EFFORT)
        return result == "unsat" or (result == "unknown" and self._split(claim, where, ()))

    def _ask(
        self, claim: Node, where: tuple[Node, ...], effort: int, assumed: tuple[Node, ...] = ()
    ) -> str:
        if monotonic() > self.deadline:
            return "out of time"
        encoder = Encoder(effort, assumed)
        for condition in where:
            encoder.solver.assertFormula(encoder.holds(condition))
        for condition in assumed:
            encoder.know(condition)
        encoder.solver.assertFormula(encoder.tm.mkTerm(Kind.NOT, encoder.holds(claim)))
        return encoder.check()

    def _split(self, claim: Node, where: tuple[Node, ...], assumed: tuple[Node, ...]) -> bool:
        """Return whether a claim follows from a comparison in it, and from its opposite."""
        settled = {*assumed, *map(negated, assumed)}
        found = next((c for c in choices(claim) if c not in settled), None)
        if found is None or len(assumed) == DEEPEST:
            return False
        for side in (found, negated(found)):
            result = self._ask(claim, where, SPLIT_EFFORT, (*assumed, side))
            open_ = result == "unknown" and self._split(claim, where, (*assumed, side))
            if result != "unsat" and not open_:
                return False
        return True


def choices(tree: Node) -> Iterator[Node]:
    """Yield the comparisons that choose in a tree, those of functions with kinks too."""
    for node in walk(tree):
        if node.op in KINKED:
            yield from choices(unkinked(node))
        elif node.op == "if":
            yield node.args[0]


def partial(node: Node, path: tuple[Node, ...] = ()) -> Iterator[Claim]:
    """Yield what must hold for a tree to have a value, where each part is reached."""
    first, last = (node.args[0], node.args[-1]) if node.args else (node, node)
    if node.op == "if":
        yield from partial(first, path)
        yield from partial(node.args[1], (*path, first))
        yield from partial(last, (*path, negated(first)))
        return
    for arg in node.args:
        yield from partial(arg, path)
    power = {"/": -1, "sqrt": Fraction(1, 2), "**": node.value}.get(node.op, 1)
    if node.op == "log" or (power < 0 and Fraction(power).denominator > 1):
        yield Claim(path, compare(last, ">", 0))
    elif Fraction(power).denominator > 1:
        yield Claim(path, compare(last, ">=", 0))
    elif power < 0 and not (last.op == "num" and last.value):
        yield Claim(path, compare(last, "!=", 0))
