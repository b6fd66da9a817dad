"""Laws as text to trees, by a small parser of the checker's own.

Input: text of the law grammar (numbers, names, + - * / **, ``a if x < y else b``, functions; in a
published system ``sum(bank, law)`` too).  Output: `Node` trees with exact rationals.  A tree is
data; limits on length, nesting and digits keep hostile text from costing time.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction
from typing import Any, NamedTuple

MAX_LENGTH, MAX_DEPTH, MAX_DIGITS, MAX_EXPONENT, MAX_POWER = 1000, 100, 60, 400, 16
FUNCTIONS = dict.fromkeys(("exp", "log", "sqrt", "sin", "cos", "tanh", "abs", "sign"), 1)
FUNCTIONS |= dict.fromkeys(("min", "max", "deadzone", "saturate"), 2)
KINKED = ("abs", "sign", "min", "max", "deadzone", "saturate")
BINDS = {"if": 1, "<": 2, "<=": 2, ">": 2, ">=": 2, "+": 3, "-": 3, "*": 4, "/": 4, "**": 6}
PREFIX = 5
TOKEN = re.compile(
    r" *((?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?(?![A-Za-z0-9_.])"
    r"|[A-Za-z_][A-Za-z0-9_]*|\*\*|<=|>=|[-+*/(),<>]) *"
)
OPPOSITE = {"<": ">=", "<=": ">", ">": "<=", ">=": "<"}


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


def num(value: int | Fraction) -> Node:
    """Return a number."""
    return Node("num", (), Fraction(value))


def sym(name: Any) -> Node:
    """Return a symbol."""
    return Node("sym", (), name)


def compare(left: Node, operator: str, right: Node | int) -> Node:
    """Return a comparison."""
    return Node("cmp", (left, right if isinstance(right, Node) else num(right)), operator)


def minus(left: Node, right: Node) -> Node:
    """Return a difference."""
    return Node("+", (left, Node("neg", (right,))))


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


def unkinked(node: Node) -> Node:
    """Return a function with kinks written as a choice, by its definition."""
    x, y, zero = node.args[0], node.args[-1], num(0)
    if node.op == "abs":
        return Node("if", (compare(x, ">=", 0), x, Node("neg", (x,))))
    if node.op == "sign":
        below = Node("if", (compare(x, "<", 0), num(-1), zero))
        return Node("if", (compare(x, ">", 0), num(1), below))
    if node.op in ("min", "max"):
        return Node("if", (compare(x, "<=" if node.op == "min" else ">=", y), x, y))
    if node.op == "saturate":
        return Node("min", (Node("max", (x, Node("neg", (y,)))), y))
    above, below = Node("max", (minus(x, y), zero)), Node("min", (Node("+", (x, y)), zero))
    return Node("+", (above, below))


def number(text: str) -> Fraction:
    """Return the exact value of a decimal number; raises `InputError` if it is none."""
    mantissa, _, exponent = text.strip().lower().replace("_", "").partition("e")
    try:
        if len(mantissa) > MAX_DIGITS or abs(int(exponent[:9] or 0)) > MAX_EXPONENT:
            raise InputError(f"number {text[:40]!r} has too many digits")
        return Fraction(f"{mantissa}e{exponent or 0}")
    except ValueError:
        raise InputError(f"{text[:40]!r} is no finite number") from None


def parse(text: Any, sums: bool = False, length: int = MAX_LENGTH) -> Node:
    """Return the tree of a law, or of a comparison.

    Parameters
    ----------
    text : the law.
    sums : whether ``sum(bank, law)`` is allowed.
    length : the most characters.

    Raises
    ------
    InputError
        If the text is not of the grammar.
    """
    if not isinstance(text, str) or len(text) > length or not text.isascii():
        raise InputError(f"{str(text)[:60]!r} is no law of plain text, or too long")
    return _Parser(text, sums).whole()


def parse_law(text: Any, sums: bool = False, length: int = MAX_LENGTH) -> Node:
    """Return the tree of a law that is no comparison."""
    tree = parse(text, sums, length)
    if tree.op == "cmp":
        raise InputError(f"{text[:60]!r} is a comparison, not a law")
    return tree


class _Parser:
    """Precedence climbing, as Python reads the same text."""

    def __init__(self, text: str, sums: bool) -> None:
        self.text, self.sums, self.depth, place = text, sums, 0, 0
        self.tokens: list[str] = []
        while found := TOKEN.match(text, place):
            self.tokens.append(found[1])
            place = found.end()
        if place < len(text):
            raise self.fault()
        self.tokens = ["", *reversed(self.tokens)]

    def fault(self, why: str = "is not of the law grammar") -> InputError:
        return InputError(f"{self.text[:60]!r} {why}")

    def need(self, *wanted: str) -> str:
        if self.tokens[-1] not in wanted:
            raise self.fault()
        return self.tokens.pop()

    def whole(self) -> Node:
        tree = self.expression(0)
        if self.tokens != [""]:
            raise self.fault()
        return tree

    def made(self, op: str, *args: Node, value: Any = None) -> Node:
        if any((arg.op == "cmp") != (op == "if" and n == 0) for n, arg in enumerate(args)):
            raise self.fault()
        return Node(op, args, value)

    def expression(self, least: int) -> Node:
        self.depth += 1
        if self.depth > MAX_DEPTH:
            raise self.fault("is nested too deeply")
        tree = self.operand()
        while (power := BINDS.get(self.tokens[-1], -1)) >= least:
            operator = self.tokens.pop()
            if operator == "if":
                condition = self.expression(2)
                self.need("else")
                tree = self.made("if", condition, tree, self.expression(1))
                continue
            right = self.expression(PREFIX if operator == "**" else power + 1)
            if operator == "**":
                tree = self.made("**", tree, value=self.exponent(right))
            elif operator in "+-":
                term = self.made("neg", right) if operator == "-" else right
                tree = self.made("+", *(tree.args if tree.op == "+" else (tree,)), term)
            elif power == BINDS["<"]:
                tree = self.made("cmp", tree, right, value=operator)
            else:
                tree = self.made(operator, tree, right)
        self.depth -= 1
        return tree

    def operand(self) -> Node:
        token = self.tokens[-1]
        if not token or token in ("if", "else"):
            raise self.fault()
        self.tokens.pop()
        if token[0].isdigit() or token[0] == ".":
            return num(number(token))
        if token in "+-":
            tree = self.expression(PREFIX)
            return self.made("neg", tree) if token == "-" else tree
        if token == "(":
            tree = self.expression(0)
            self.need(")")
            return tree
        if not (token[0].isalpha() or token[0] == "_"):
            raise self.fault()
        if self.tokens[-1] != "(":
            return sym(token)
        self.tokens.pop()
        bank = self.tokens.pop() if token == "sum" and self.sums and self.tokens[-1] else None
        args = [] if bank is None else [self.argument(",")]
        args += [self.expression(0)] if not args else []
        while self.need(",", ")") == ",":
            args.append(self.expression(0))
        if len(args) != (1 if bank else FUNCTIONS.get(token)):
            raise self.fault(f"calls {token[:20]} in a way that laws do not have")
        return self.made(token, *args, value=bank)

    def argument(self, before: str) -> Node:
        self.need(before)
        return self.expression(0)

    def exponent(self, node: Node) -> Fraction:
        """Return the value of an exponent written with numbers, - and /."""
        sign = 1
        while node.op == "neg":
            sign, node = -sign, node.args[0]
        parts = [arg.value if arg.op == "num" else None for arg in node.args] or [node.value, 1]
        if node.op not in ("num", "/") or None in parts or not parts[1]:
            raise self.fault("has a power that is no number")
        value = sign * Fraction(parts[0]) / parts[1]
        if max(abs(value.numerator), value.denominator) > MAX_POWER:
            raise self.fault("has a power beyond small rationals")
        return value
