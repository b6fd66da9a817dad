"""Laws as text to trees, read by a small parser of the checker's own.

Input: text of the law grammar (numbers, names, + - * / **, ``a if x < y else b``, functions; in a
published system ``sum(bank, law)`` too).  Output: `Node` trees with exact rationals.  A tree is
data; limits on length, nesting and digits keep hostile text from costing time.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction
from typing import Any, NamedTuple

MAX_LENGTH, MAX_DEPTH, MAX_DIGITS, MAX_EXPONENT, MAX_POWER = 1000, 60, 60, 400, 16
FUNCTIONS = {name: 1 for name in ("exp", "log", "sqrt", "sin", "cos", "tanh", "abs", "sign")}
FUNCTIONS |= {name: 2 for name in ("min", "max", "deadzone", "saturate")}
COMPARISONS = ("<", "<=", ">", ">=")
TOKEN = re.compile(
    r" *(?:(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)(?![A-Za-z0-9_.])"
    r"|(?P<name>[A-Za-z_][A-Za-z0-9_]*)|(?P<sign>\*\*|<=|>=|[-+*/(),<>]))"
)


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


def negated(condition: Node) -> Node:
    """Return the opposite of a comparison."""
    opposite = {"<": ">=", "<=": ">", ">": "<=", ">=": "<"}
    return Node("cmp", condition.args, opposite[condition.value])


def walk(node: Node) -> Iterator[Node]:
    """Yield a node and all that is in it."""
    stack = [node]
    while stack:
        top = stack.pop()
        yield top
        stack.extend(reversed(top.args))


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


def number(text: str) -> Fraction:
    """Return the exact value of a decimal number.

    Raises
    ------
    InputError
        If it is none, or has too many digits.
    """
    mantissa, _, exponent = text.strip().lower().replace("_", "").partition("e")
    try:
        if len(mantissa) > MAX_DIGITS or abs(int(exponent[:9] or 0)) > MAX_EXPONENT:
            raise InputError(f"number {text[:40]!r} has too many digits")
        return Fraction(f"{mantissa}e{exponent or 0}")
    except ValueError:
        raise InputError(f"{text[:40]!r} is no finite number") from None


def parse(text: Any, sums: bool = False, length: int = MAX_LENGTH) -> Node:
    """Return the tree of a law.

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
    tree = _Parser(text, sums, length).whole()
    if tree.op == "cmp":
        raise InputError(f"{text[:60]!r} is a comparison, not a law")
    return tree


def parse_condition(text: Any) -> Node:
    """Return the tree of one comparison; raises `InputError` if it is none."""
    tree = _Parser(text, False, MAX_LENGTH).whole()
    if tree.op != "cmp":
        raise InputError(f"{str(text)[:60]!r} is no comparison")
    return tree


class _Parser:
    """Precedence climbing, as Python reads the same text."""

    def __init__(self, text: Any, sums: bool, length: int) -> None:
        if not isinstance(text, str) or len(text) > length or not text.isascii():
            raise InputError(f"{str(text)[:60]!r} is no law of plain text, or too long")
        self.text, self.sums, self.depth, self.tokens = text, sums, 0, list[tuple[str, str]]()
        end, place = len(text.rstrip(" ")), 0
        while place < end:
            found = TOKEN.match(text, place)
            if found is None:
                raise self.fault()
            self.tokens.append((found.lastgroup or "", found.group(found.lastgroup or 0)))
            place = found.end()
        self.tokens.append(("end", ""))
        self.at = 0

    def fault(self) -> InputError:
        return InputError(f"{self.text[:60]!r} is not of the law grammar")

    def take(self, *wanted: str) -> str:
        """Return the next token if it is one of those wanted, else nothing."""
        text = self.tokens[self.at][1]
        if text not in wanted:
            return ""
        self.at += 1
        return text

    def need(self, wanted: str) -> None:
        if not self.take(wanted):
            raise self.fault()

    def whole(self) -> Node:
        tree = self.choice()
        if self.tokens[self.at][0] != "end":
            raise self.fault()
        return tree

    def choice(self) -> Node:
        self.depth += 1
        if self.depth > MAX_DEPTH:
            raise InputError(f"{self.text[:60]!r} is nested too deeply")
        tree = self.comparison()
        if self.take("if"):
            condition = self.comparison()
            self.need("else")
            other = self.choice()
            if condition.op != "cmp" or "cmp" in (tree.op, other.op):
                raise self.fault()
            tree = Node("if", (condition, tree, other))
        self.depth -= 1
        return tree

    def comparison(self) -> Node:
        left = self.sum()
        operator = self.take(*COMPARISONS)
        return self.made("cmp", (left, self.sum()), operator) if operator else left

    def made(self, op: str, args: tuple[Node, ...], value: Any = None) -> Node:
        if any(arg.op == "cmp" for arg in args):
            raise self.fault()
        return Node(op, args, value)

    def sum(self) -> Node:
        terms = [self.product()]
        while operator := self.take("+", "-"):
            term = self.product()
            terms.append(self.made("neg", (term,)) if operator == "-" else term)
        return terms[0] if len(terms) == 1 else self.made("+", tuple(terms))

    def product(self) -> Node:
        tree = self.unary()
        while operator := self.take("*", "/"):
            tree = self.made(operator, (tree, self.unary()))
        return tree

    def unary(self) -> Node:
        operator = self.take("-", "+")
        if not operator:
            return self.power()
        self.depth += 1
        if self.depth > MAX_DEPTH:
            raise InputError(f"{self.text[:60]!r} is nested too deeply")
        tree = self.unary()
        self.depth -= 1
        return self.made("neg", (tree,)) if operator == "-" else tree

    def power(self) -> Node:
        base = self.atom()
        if not self.take("**"):
            return base
        exponent = _constant(self.unary())
        if exponent is None or max(abs(exponent.numerator), exponent.denominator) > MAX_POWER:
            raise InputError(f"{self.text[:60]!r} has a power beyond small rationals")
        return self.made("**", (base,), exponent)

    def atom(self) -> Node:
        kind, text = self.tokens[self.at]
        self.at += 1
        if kind == "number":
            return num(number(text))
        if text == "(":
            tree = self.choice()
            self.need(")")
            return tree
        if kind != "name" or text in ("if", "else"):
            raise self.fault()
        return self.call(text) if self.take("(") else sym(text)

    def call(self, function: str) -> Node:
        if function == "sum" and self.sums:
            bank = self.tokens[self.at][1]
            self.at += 1
            self.need(",")
            args = (self.choice(),)
            self.need(")")
            return self.made("sum", args, bank)
        found = [self.choice()]
        while self.take(","):
            found.append(self.choice())
        self.need(")")
        if FUNCTIONS.get(function) != len(found):
            raise InputError(f"{function} of {len(found)} arguments is no function of laws")
        return self.made(function, tuple(found))


def _constant(node: Node) -> Fraction | None:
    """Return the value of an exponent written with numbers, - and /."""
    parts = [_constant(arg) for arg in node.args]
    if node.op == "num":
        return Fraction(node.value)
    if node.op == "neg" and parts[0] is not None:
        return -parts[0]
    if node.op == "/" and parts[0] is not None and parts[1]:
        return parts[0] / parts[1]
    return None
