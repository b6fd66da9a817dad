"""Laws as text to trees, by a small parser of the checker's own, and trees from trees.

Input: text of the law grammar (numbers, names, + - * / **, ``a if x < y else b``, functions; in a
published system ``sum(bank, law)`` too).  Output: `Node` trees with exact rationals.  A tree is
data; limits on length, nesting and digits keep hostile text from costing time.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction
from functools import cache
from math import ceil, comb, prod
from typing import Any, NamedTuple

MAX_LENGTH, MAX_DEPTH, MAX_DIGITS, MAX_EXPONENT, MAX_POWER = 1000, 100, 60, 400, 16
MAX_TERMS = 600
FUNCTIONS = dict.fromkeys(("exp", "log", "sqrt", "sin", "cos", "tanh", "abs", "sign"), 1)
FUNCTIONS |= dict.fromkeys(("min", "max", "deadzone", "saturate"), 2)
BINDS = {"if": 1, "<": 2, "<=": 2, ">": 2, ">=": 2, "+": 3, "-": 3, "*": 4, "/": 4, "**": 6}
PREFIX = 5
TOKEN = re.compile(
    r" *((?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?(?![A-Za-z0-9_.])"
    r"|[A-Za-z_][A-Za-z0-9_]*|\*\*|<=|>=|[-+*/(),<>]) *"
)
OPPOSITE = {"<": ">=", "<=": ">", ">": "<=", ">=": "<"}
#: Functions with kinks, by their definition, and derivatives of y = f(x).
KINKS = {
    "abs": "x if x >= 0 else -x",
    "sign": "1 if x > 0 else -1 if x < 0 else 0",
    "min": "x if x <= z else z",
    "max": "x if x >= z else z",
    "deadzone": "max(x - z, 0) + min(x + z, 0)",
    "saturate": "min(max(x, -z), z)",
}
SLOPES = {"exp": "y", "log": "1/x", "sin": "cos(x)", "cos": "-sin(x)", "tanh": "1 - y**2"}
SLOPES |= {"sqrt": "1/(2*y)", "*": "dx*z + x*dz", "/": "dx/z - x*dz/z**2", "neg": "-dx"}


class InputError(Exception):
    """The spec or the published system is not what the checker reads; one line says why."""


class Node(NamedTuple):
    """A part of a law: an operation, its arguments, and a value where it has one.

    ``num`` has a rational, ``sym`` a name, ``**`` an exponent, ``cmp`` an operator and ``sum`` a
    bank as `value`; ``if`` has the arguments (comparison, then, else).
    """

    op: str
    args: tuple[Node, ...] = ()
    value: Any = None


def need(good: bool, reason: str) -> None:
    """Refuse what is not good."""
    if not good:
        raise InputError(reason)


def num(value: int | Fraction) -> Node:
    """Return a number."""
    return Node("num", (), Fraction(value))


def sym(name: Any) -> Node:
    """Return a symbol."""
    return Node("sym", (), name)


def compare(left: Node, operator: str, right: Node | int | Fraction = 0) -> Node:
    """Return a comparison."""
    return Node("cmp", (left, right if isinstance(right, Node) else num(right)), operator)


def negated(condition: Node) -> Node:
    """Return the opposite of a comparison."""
    return Node("cmp", condition.args, OPPOSITE[condition.value])


def walk(node: Node) -> Iterator[Node]:
    """Yield a node and all that is in it."""
    stack = [node]
    while stack:
        stack.extend(reversed((top := stack.pop()).args))
        yield top


def symbols(node: Node) -> dict[Any, None]:
    """Return the symbols of a tree, in order."""
    return dict.fromkeys(n.value for n in walk(node) if n.op == "sym")


def replaced(node: Node, change: Callable[[Any], Node]) -> Node:
    """Return a tree with every symbol changed."""
    if node.op == "sym":
        return change(node.value)
    return Node(node.op, tuple(replaced(arg, change) for arg in node.args), node.value)


def put(node: Node, values: Mapping[Any, Node]) -> Node:
    """Return a tree with some symbols replaced by trees."""
    return replaced(node, lambda name: values.get(name, sym(name)))


def made(text: str, **parts: Node) -> Node:
    """Return the tree of a text, its names replaced by trees."""
    return put(_known(text), parts)


@cache
def _known(text: str) -> Node:
    return parse(text)


def unkinked(node: Node) -> Node:
    """Return a function with kinks written as a choice, by its definition."""
    return made(KINKS[node.op], x=node.args[0], z=node.args[-1])


def derivative(node: Node, by: Any) -> Node:
    """Return the derivative of a law by a symbol, branch by branch."""
    if by not in symbols(node) or node.op == "sym":
        return num(int(node.op == "sym" and node.value == by))
    if node.op in KINKS:
        return derivative(unkinked(node), by)
    if node.op == "if":
        return Node("if", (node.args[0], *(derivative(arg, by) for arg in node.args[1:])))
    inner = tuple(derivative(arg, by) for arg in node.args)
    x, z, dx, dz = node.args[0], node.args[-1], inner[0], inner[-1]
    if node.op == "+":
        return Node("+", inner)
    if node.op == "**":
        return made("n*y*dx", n=num(node.value), y=Node("**", (x,), node.value - 1), dx=dx)
    if node.op == "/" and dz == num(0):
        return Node("/", (dx, z))
    slope = made(SLOPES[node.op], x=x, y=node, z=z, dx=dx, dz=dz)
    return slope if node.op in ("*", "/", "neg") else Node("*", (slope, dx))


def _terms(node: Node, most: int) -> int:
    """Return how many terms a law has when it is multiplied out; refuse too many."""
    parts = [_terms(arg, most) for arg in node.args]
    found = 1 if node.op not in ("+", "neg") else sum(parts)
    if node.op in "*/":
        found = prod(parts)
    elif node.op == "**":
        found = comb(parts[0] + ceil(abs(node.value)) - 1, ceil(abs(node.value)))
    need(found <= most, "a law is too large when it is multiplied out")
    return found


def number(text: str) -> Fraction:
    """Return the exact value of a decimal number."""
    mantissa, _, exponent = text.strip().lower().replace("_", "").partition("e")
    try:
        small = len(mantissa) <= MAX_DIGITS and abs(int(exponent[:9] or 0)) <= MAX_EXPONENT
        need(small, f"number {text[:40]!r} has too many digits")
        return Fraction(f"{mantissa}e{exponent or 0}")
    except ValueError:
        raise InputError(f"{text[:40]!r} is no finite number") from None


def parse(text: Any, length: int = MAX_LENGTH, compares: bool | None = None) -> Node:
    """Return the tree of a law, or of a comparison if it `compares` (None: of either).

    Raises
    ------
    InputError
        If the text is not of the grammar.
    """
    plain = isinstance(text, str) and len(text) <= length and text.isascii()
    need(plain, f"{str(text)[:60]!r} is no law of plain text, or too long")
    parser = _Parser(text, sums=length > MAX_LENGTH)
    tree = parser.expression(0)
    parser.need(parser.tokens == [""])
    need(compares in (None, tree.op == "cmp"), f"{text[:60]!r} is a comparison, or should be one")
    _terms(tree, MAX_TERMS * length // MAX_LENGTH)
    return tree


class _Parser:
    """Precedence climbing, as Python reads the same text."""

    def __init__(self, text: str, sums: bool) -> None:
        self.text, self.sums, self.depth, place = text, sums, 0, 0
        self.tokens: list[str] = []
        while found := TOKEN.match(text, place):
            self.tokens.append(found[1])
            place = found.end()
        self.tokens = ["", *reversed(self.tokens)]
        self.need(place == len(text))

    def need(self, good: bool, why: str = "is not of the law grammar") -> None:
        need(good, f"{self.text[:60]!r} {why}")

    def take(self, *wanted: str) -> str:
        self.need(self.tokens[-1] in wanted)
        return self.tokens.pop()

    def made(self, op: str, *args: Node, value: Any = None) -> Node:
        chosen = [arg.op == "cmp" for arg in args]
        self.need(not any(chosen[1:] if op == "if" else chosen) and (op != "if" or chosen[0]))
        return Node(op, args, value)

    def expression(self, least: int) -> Node:
        self.depth += 1
        self.need(self.depth <= MAX_DEPTH, "is nested too deeply")
        tree = self.operand()
        while (power := BINDS.get(self.tokens[-1], -1)) >= least:
            operator = self.tokens.pop()
            right = self.expression({"if": 2, "**": PREFIX}.get(operator, power + 1))
            if operator == "if":
                self.take("else")
                tree = self.made("if", right, tree, self.expression(1))
            elif operator == "**":
                tree = self.made("**", tree, value=self.exponent(right))
            elif operator in "+-":
                term = self.made("neg", right) if operator == "-" else right
                tree = self.made("+", *(tree.args if tree.op == "+" else (tree,)), term)
            elif operator in OPPOSITE:
                tree = self.made("cmp", tree, right, value=operator)
            else:
                tree = self.made(operator, tree, right)
        self.depth -= 1
        return tree

    def operand(self) -> Node:
        token = self.tokens[-1]
        self.need(token not in ("", "if", "else") and token not in OPPOSITE)
        self.tokens.pop()
        if token[0].isdigit() or token[0] == ".":
            return num(number(token))
        if token in "+-":
            tree = self.expression(PREFIX)
            return self.made("neg", tree) if token == "-" else self.made("+", tree)
        if token == "(":
            tree = self.expression(0)
            self.take(")")
            return tree
        self.need(token[0].isalpha() or token[0] == "_")
        return self.call(token) if self.tokens[-1] == "(" else sym(token)

    def call(self, function: str) -> Node:
        self.tokens.pop()
        bank, args = None, list[Node]()
        if function == "sum" and self.sums:
            bank = self.operand().value
            self.take(",")
        while not args or self.take(",", ")") == ",":
            args.append(self.expression(0))
        count = FUNCTIONS.get(function) if bank is None else 1
        self.need(len(args) == count, "calls what laws do not have")
        return self.made(function, *args, value=bank)

    def exponent(self, node: Node) -> Fraction:
        """Return the value of an exponent written with numbers, - and /."""
        parts = [self.exponent(arg) for arg in node.args]
        self.need(node.op in ("num", "neg", "/") and parts[1:] != [0], "has no rational power")
        value = parts[0] / parts[1] if node.op == "/" else -parts[0] if parts else node.value
        size = max(abs(value.numerator), value.denominator)
        self.need(size <= MAX_POWER, "has a power beyond small rationals")
        return Fraction(value)
