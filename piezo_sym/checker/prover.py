"""Claims on laws for every real number of a domain, decided by cvc5.

Input: trees.  Output: whether a claim follows.  Laws and conditions are stated in full, choices as
`ite`.  Every function is a symbol with implications that hold for all real numbers; their premise
is the function's own domain, as in b != 0 -> q*b = a, never the path on which it stands.
"""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import reduce
from time import monotonic
from typing import Any, NamedTuple

import cvc5
from cvc5 import Kind

from .field import Field
from .functions import KINKS, SMOOTH
from .laws import Node, build, compare, increasing, negated, num, sym, symbols, unkinked

EFFORT, MILLISECONDS, SECONDS, MOST_PAIRS = 100_000, 8000, 300, 12
KINDS = {"+": Kind.ADD, "*": Kind.MULT, "neg": Kind.NEG, "if": Kind.ITE, "=": Kind.EQUAL}
KINDS |= {"<": Kind.LT, "<=": Kind.LEQ, ">": Kind.GT, ">=": Kind.GEQ, "!=": Kind.DISTINCT}


class Claim(NamedTuple):
    """A comparison (also ``!=`` and ``=``) that must follow where `path` is taken."""

    claim: Node
    path: tuple[Node, ...] = ()


def true(left: Node, operator: str, right: Node | int = 0, path: tuple[Node, ...] = ()) -> Claim:
    """Return the `Claim` that a comparison is true where `path` is taken."""
    return Claim(compare(left, operator, right), path)


def guarded(path: tuple[Node, ...], tree: Node) -> Node:
    """Return a law that is a tree where a path is taken, and zero elsewhere."""
    return reduce(lambda inner, step: Node("if", (step, inner, num(0))), reversed(path), tree)


class _Query:
    """Trees as terms of cvc5, equal parts shared, with facts on the functions in them."""

    def __init__(self) -> None:
        self.make = cvc5.TermManager()
        self.solver, self.real = cvc5.Solver(self.make), self.make.getRealSort()
        self.solver.setLogic("QF_NRA")
        for option, most in {"rlimit-per": EFFORT, "tlimit-per": MILLISECONDS}.items():
            self.solver.setOption(option, str(most))
        self.known, self.calls = dict[Node, Any](), dict[Any, list[tuple[Node, Node]]]()

    def add(self, fact: Node, *premises: Node, holds: bool = True) -> None:
        """Assert that premises imply a comparison, or its opposite unless it `holds`."""
        term = self.term(fact) if holds else self.make.mkTerm(Kind.NOT, self.term(fact))
        for premise in premises:
            term = self.make.mkTerm(Kind.IMPLIES, self.term(premise), term)
        self.solver.assertFormula(term)

    def term(self, node: Node) -> Any:
        """Return the term of a tree, the same for the same tree."""
        if node not in self.known:
            self.known[node] = self._term(node)
        return self.known[node]

    def _term(self, node: Node) -> Any:
        args, kind = node.args, KINDS.get(node.value if node.op == "cmp" else node.op)
        if node.op == "num":
            return self.make.mkReal(node.value.numerator, node.value.denominator)
        if node.op in KINKS:
            return self.term(unkinked(node))
        if node.op in "+*" and len(args) == 1:
            return self.term(args[0])
        if kind:
            return self.make.mkTerm(kind, *map(self.term, args))
        if node.op == "**":
            return self.term(self._power(args[0], Fraction(node.value)))
        if node.op == "/" and args[1].op == "num" and args[1].value:
            return self.term(Node("*", (num(1 / args[1].value), args[0])))
        if node.op == "/" and args[0].op == "neg":  # as -(a/b), to share a/b
            return self.term(build("-(x/z)", x=args[0].args[0], z=args[1]))
        if node.op == "sym":
            return self.make.mkConst(self.real, f"y{len(self.known)}")
        y = sym(("value", node))
        if node.op == "/":
            self.add(compare(Node("*", (y, args[1])), "=", args[0]), compare(args[1], "!="))
        elif node.op in SMOOTH:
            self._function(node.op, y, *args)
        return self.term(y)

    def _power(self, x: Node, exponent: Fraction) -> Node:
        """Return x**(p/q) as a product of y, with x >= 0 -> y >= 0 and y**q = x."""
        y, order = x, exponent.denominator
        if order > 1:
            y = sym(("root", x, order))
            self.add(compare(y, ">="), compare(x, ">="))
            self.add(compare(Node("*", (y,) * order), "=", x), compare(x, ">="))
        size = Node("*", (num(1), *[y] * abs(exponent.numerator)))
        return size if exponent >= 0 else Node("/", (num(1), size))

    def _function(self, name: str, y: Node, x: Node, *more: Node) -> None:
        """Assert the facts on a value of a smooth function, and on pairs with earlier values."""
        if (name, x.op) in (("log", "exp"), ("exp", "log")):  # log(exp(a)) = a, exp(log(a)) = a > 0
            self.add(compare(y, "=", x.args[0]), *[compare(x.args[0], ">")] * (name == "exp"))
        others, known = self.calls.setdefault((name, *more), []), SMOOTH[name]
        pairs = [(known.pairs, {"a": a, "b": b}) for a, b in others[:MOST_PAIRS]]
        for texts, words in [(known.facts, dict[str, Node]()), *pairs]:
            for text in texts.split(";"):
                *premises, fact = (build(t.strip(), x=x, y=y, **words) for t in text.split(":"))
                self.add(fact, *premises)
        others.append((x, y))


class Prover:
    """Decides claims under the conditions of a domain, and `ties` between names and states."""

    def __init__(self, domain: Sequence[Node], ties: Sequence[Node] = ()) -> None:
        self.domain, self.ties, self.deadline = tuple(domain), tuple(ties), monotonic() + SECONDS
        self.answers: dict[Claim, bool] = {}

    def proves(self, claim: Node, path: tuple[Node, ...] = ()) -> bool:
        """Return whether a claim follows from the domain and a path."""
        key = Claim(claim, path)
        if key not in self.answers:
            names = {name for tree in (claim, *path) for name in symbols(tree)}
            near = tuple(c for c in self.domain if set(symbols(c)) <= names)
            tries = dict.fromkeys((near, self.domain, (*self.domain, *self.ties)))
            same = claim.value == "=" and Field().same(*claim.args)
            follows = (self._follows(claim, (*where, *path)) for where in tries)
            self.answers[key] = same or any(follows)
        return self.answers[key]

    def _follows(self, claim: Node, where: tuple[Node, ...]) -> bool:
        query = _Query()
        for condition in where:
            query.add(condition)
        query.add(claim, holds=False)
        return monotonic() < self.deadline and bool(query.solver.checkSat().isUnsat())


def partial(node: Node, path: tuple[Node, ...] = ()) -> Iterator[Claim]:
    """Yield the claims under which a tree has a value: of each part, on the path to it."""
    condition = node.args[:1] if node.op == "if" else ()
    for n, arg in enumerate(node.args):
        side = condition if n == 1 else tuple(map(negated, condition)) if n == 2 else ()
        yield from partial(arg, (*path, *side))
    yield from (Claim(claim, path) for claim in needed(node))


def needed(node: Node) -> Iterator[Node]:
    """Yield the conditions on a node's arguments under which it has a value."""
    yield from increasing(node)
    power = Fraction({"/": -1, "**": node.value}.get(node.op, 1))
    if node.op == "pow":
        yield compare(node.args[1], ">")
    if node.op in ("log", "pow") or power.denominator > 1:
        yield compare(node.args[0], ">" if node.op == "log" or power < 0 else ">=")
    elif power < 0 and not (node.args[-1].op == "num" and node.args[-1].value):
        yield compare(node.args[-1], "!=")
