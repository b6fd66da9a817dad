"""Claims on laws for every real number of a domain, asked of cvc5.

Input: trees.  Output: whether a claim follows.  Laws and conditions go whole, choices as `ite`.
Every function is a symbol of which implications are known that hold for all real numbers, their
premise being the function's own domain: b != 0 -> q*b = a.  Nothing is assumed of a path.
"""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from time import monotonic
from typing import NamedTuple

import cvc5

from .laws import KINKS, Node, compare, made, negated, num, symbols, unkinked

EFFORT, MILLISECONDS, SECONDS, MOST_PAIRS = 100_000, 8000, 300, 12
OPERATIONS = {"+": "+", "*": "*", "neg": "-", "if": "ite"}
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
RISING = "x < a: y < b; x > a: y > b; x >= a: y >= b; x <= a: y <= b"
MIRROR = "x + a <= 0: y + b <= 0; x + a >= 0: y + b >= 0"
PAIRS = {
    "exp": f"{RISING}; x + a <= 0: y*b <= 1; x + a >= 0: y*b >= 1",
    "log": f"x > 0: a > 0: {RISING.replace('; ', '; x > 0: a > 0: ')}",
    "tanh": f"{RISING}; {MIRROR}",
    "sin": "x <= a: x >= a: y <= b; x <= a: x >= a: y >= b;"
    "x + a <= 0: x + a >= 0: y + b <= 0; x + a <= 0: x + a >= 0: y + b >= 0",
    "cos": "(x - a)*(x + a) <= 0: (x - a)*(x + a) >= 0: y <= b",
}
PAIRS["cos"] += f"; {PAIRS['cos'].replace('y <= b', 'y >= b')}"


class Claim(NamedTuple):
    """A comparison (``!=`` and ``=`` too) that is to follow where `path` is taken."""

    path: tuple[Node, ...]
    claim: Node


class _Query:
    """Trees as SMT-LIB text, each part once, and the facts on the functions in them."""

    def __init__(self) -> None:
        self.lines = ["(set-logic QF_NRA)"]
        self.known: dict[Node, str] = {}
        self.calls: dict[str, list[tuple[Node, Node]]] = {}

    def holds(self, condition: Node) -> str:
        left, right = map(self.term, condition.args)
        if condition.value == "!=":
            return f"(not (= {left} {right}))"
        return f"({condition.value} {left} {right})"

    def term(self, node: Node) -> str:
        """Return the name of a tree's term, the same for the same tree."""
        if node not in self.known:
            text = self._text(node)
            name = self.known[node] = text if text.isalnum() else f"t{len(self.known)}"
            if name != text:
                self.lines.append(f"(define-fun {name} () Real {text})")
        return self.known[node]

    def _fresh(self, node: Node) -> Node:
        symbol = Node("sym", (), ("value", node))
        name = self.known[symbol] = f"y{len(self.known)}"
        self.lines.append(f"(declare-const {name} Real)")
        return symbol

    def _text(self, node: Node) -> str:
        args = node.args
        if node.op == "num":
            size = f"(/ {abs(node.value.numerator)}.0 {node.value.denominator}.0)"
            return size if node.value >= 0 else f"(- {size})"
        if node.op == "sym":
            return self.term(self._fresh(node))
        if node.op in KINKS:
            return self.term(unkinked(node))
        if node.op == "+" and len(args) == 1:
            return self.term(args[0])
        if node.op in OPERATIONS:
            parts = (self.holds(arg) if arg.op == "cmp" else self.term(arg) for arg in args)
            return f"({OPERATIONS[node.op]} {' '.join(parts)})"
        if node.op == "**":
            return self.term(self._power(args[0], Fraction(node.value)))
        if node.op == "/" and args[1].op == "num" and args[1].value:
            return self.term(Node("*", (num(1 / args[1].value), args[0])))
        if node.op == "/" and args[0].op == "neg":  # -(a/b), for a/b may be known
            return self.term(made("-(x/z)", x=args[0].args[0], z=args[1]))
        y = self._fresh(node)
        if node.op == "/":
            product = compare(Node("*", (y, args[1])), "=", args[0])
            self._know(product, compare(args[1], "!="))
        else:
            self._function(node.op, args[0], y)
        return self.term(y)

    def _know(self, fact: Node, *premises: Node) -> None:
        terms = " ".join(map(self.holds, (*premises, fact)))
        self.lines.append(f"(assert (=> {terms}))")

    def _power(self, x: Node, exponent: Fraction) -> Node:
        """Return x**(p/q) in products, by y with x >= 0 -> y >= 0 and y**q = x."""
        if exponent.denominator > 1:
            y = self._fresh(Node("root", (x,), exponent.denominator))
            inside, raised = compare(x, ">="), _times(y, exponent.denominator)
            self._know(compare(y, ">="), inside)
            self._know(compare(raised, "=", x), inside)
            x = y
        size = _times(x, abs(exponent.numerator))
        return size if exponent >= 0 else Node("/", (num(1), size))

    def _function(self, name: str, x: Node, y: Node) -> None:
        """Assert what is known of exp, log, sin, cos or tanh, alone and of two values of one."""
        if (name, x.op) in (("log", "exp"), ("exp", "log")):  # log(exp(a)) = a; a > 0 for the other
            inside = compare(x.args[0], ">") if name == "exp" else compare(num(1), ">")
            self._know(compare(y, "=", x.args[0]), inside)
        others = self.calls.setdefault(name, [])
        self._facts(FACTS[name], x=x, y=y)
        for a, b in others[:MOST_PAIRS]:
            self._facts(PAIRS[name], x=x, y=y, a=a, b=b)
        others.append((x, y))

    def _facts(self, texts: str, **words: Node) -> None:
        for text in texts.split(";"):
            *premises, fact = (made(part.strip(), **words) for part in text.split(":"))
            self._know(fact, compare(num(1), ">"), *premises)

    def answer(self) -> str:
        """Return sat, unsat or unknown."""
        solver = cvc5.Solver(cvc5.TermManager())
        for option, most in {"rlimit-per": EFFORT, "tlimit-per": MILLISECONDS}.items():
            solver.setOption(option, str(most))
        parser, text = cvc5.InputParser(solver), "\n".join([*self.lines, "(check-sat)"])
        parser.setStringInput(cvc5.InputLanguage.SMT_LIB_2_6, text, "query")
        found = ""
        while not (command := parser.nextCommand()).isNull():
            found += str(command.invoke(solver, parser.getSymbolManager()))
        return found.strip()


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
        query = _Query()
        terms = [*map(query.holds, where), f"(not {query.holds(claim)})"]
        query.lines += [f"(assert {term})" for term in terms]
        return monotonic() < self.deadline and query.answer() == "unsat"


def partial(node: Node, path: tuple[Node, ...] = ()) -> Iterator[Claim]:
    """Yield what must hold for a tree to have a value, where each part is reached."""
    if node.op == "if":
        yield from partial(node.args[0], path)
        yield from partial(node.args[1], (*path, node.args[0]))
        yield from partial(node.args[2], (*path, negated(node.args[0])))
        return
    for arg in node.args:
        yield from partial(arg, path)
    yield from (Claim(path, claim) for claim in needed(node))


def needed(node: Node) -> Iterator[Node]:
    """Yield what must hold of a function's arguments for it to have a value."""
    given = {"/": -1, "**": node.value}.get(node.op, 1)
    power, last = Fraction(given), node.args[-1] if node.args else node
    if node.op == "log" or (power < 0 and power.denominator > 1):
        yield compare(last, ">")
    elif power.denominator > 1:
        yield compare(last, ">=")
    elif power < 0 and not (last.op == "num" and last.value):
        yield compare(last, "!=")
