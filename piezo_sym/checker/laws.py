"""Texts of laws to trees, by Python's own parser and without running them; operations on trees.

Input: text of the law grammar; in a published system also ``sum(bank, law)``.  Output: `Node` trees
with exact rationals.  Limits on length, nesting and digits bound the cost of hostile text.
"""

import ast
import operator
import re
from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction
from functools import cache, reduce
from itertools import pairwise
from typing import Any, NamedTuple

from .functions import KINKS, SMOOTH

MAX_LENGTH, MAX_TABLE, MAX_DIGITS, MAX_EXPONENT, MAX_POWER, MAX_KNOTS = 1000, 4000, 60, 400, 16, 64
PLAIN = re.compile(
    r"(?a)(?>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?(?![A-Za-z0-9_.])|[A-Za-z_]\w*|[-+*/(),<>=]| )*+"
)
OPERATORS = {ast.Mult: "*", ast.Div: "/", ast.USub: "neg", ast.UAdd: "+"}
OPERATORS |= {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">="}
OPPOSITE = {"<": ">=", "<=": ">", ">": "<=", ">=": "<"}
#: Operations that apply to numbers, rational functions and power series alike.
ARITHMETIC: dict[str, Callable[..., Any]] = {"*": operator.mul, "/": operator.truediv}
ARITHMETIC |= {"neg": operator.neg, "+": lambda *terms: sum(terms[1:], terms[0])}
#: The derivatives of operations on x and z; dx and dz are the derivatives of x and z.
SLOPES = {"*": "dx*z + x*dz", "/": "dx/z - x*dz/z**2", "neg": "-dx"}
_TEXTS = KINKS | {name: known.slope for name, known in SMOOTH.items()}
ARGUMENTS = {name: 1 + ("z" in text) for name, text in _TEXTS.items() if text}


class InputError(Exception):
    """The checker does not accept a spec or its proofs; the message says why in one line."""


class Node(NamedTuple):
    """A part of a law, with its arguments (of ``if``: comparison, then, else) and `value`.

    The value is a number, a name (sym), an exponent (``**``), an operator (cmp) or a bank (sum).
    """

    op: str
    args: tuple["Node", ...] = ()
    value: Any = None


def need(condition: object, reason: str) -> None:
    """Raise `InputError` with a reason unless a condition is true."""
    if not condition:
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
    """Yield a node and all its parts."""
    yield node
    for arg in node.args:
        yield from walk(arg)


def symbols(node: Node) -> dict[Any, None]:
    """Return the symbols of a tree, in order."""
    return dict.fromkeys(n.value for n in walk(node) if n.op == "sym")


def subs(node: Node, values: Mapping[Any, Node]) -> Node:
    """Return a tree with some symbols replaced by trees."""
    if node.op == "sym":
        return values.get(node.value, node)
    return Node(node.op, tuple(subs(arg, values) for arg in node.args), node.value)


def build(text: str, **parts: Node) -> Node:
    """Return the tree of a text, its names replaced by trees."""
    return subs(parse(text), parts)


def unkinked(node: Node) -> Node:
    """Return a function with kinks written as a choice, by its definition."""
    if node.op == "table":
        return _halved(node.args[0], node.args[1:])
    return build(KINKS[node.op], x=node.args[0], z=node.args[-1])


def _halved(x: Node, knots: tuple[Node, ...]) -> Node:
    """Return a table as a choice of two halves, or if it has two knots, as a line."""
    if len(knots) > 4:
        n = len(knots) // 4 * 2
        halves = (Node("table", (x, *own)) for own in (knots[: n + 2], knots[n:]))
        return Node("if", (compare(x, "<", knots[n]), *halves))
    a, y, b, z = knots
    known = [own.value for own in knots if own.op == "num"]
    slope = build("(z - y)/(b - a)", a=a, b=b, y=y, z=z)
    if len(known) == 4 and known[0] != known[2]:
        slope = num((known[3] - known[1]) / (known[2] - known[0]))
    return build("m*x" if b == z == num(0) else "y + m*(x - a)", m=slope, x=x, a=a, y=y)


def increasing(node: Node) -> Iterator[Node]:
    """Yield the conditions that the knots of a table increase, where that is not evident."""
    for a, b in pairwise(node.args[1::2] if node.op == "table" else ()):
        if not a.op == b.op == "num" or a.value >= b.value:
            yield compare(a, "<", b)


def on_pieces(node: Node, path: tuple[Node, ...] = ()) -> Iterator[tuple[Node, tuple[Node, ...]]]:
    """Yield a law on each piece of its tables, and the path of the piece."""
    table = next((part for part in walk(node) if part.op == "table"), None)
    if table is None:
        yield node, path
        return
    pieces = unkinked(table)
    side, *halves = pieces.args if pieces.op == "if" else (pieces, pieces)
    sides = ((side,), (negated(side),)) if pieces.op == "if" else ((),)
    for taken, half in zip(sides, halves, strict=True):
        yield from on_pieces(_swapped(node, table, half), (*path, *taken))


def _swapped(node: Node, old: Node, new: Node) -> Node:
    args = (_swapped(arg, old, new) for arg in node.args)
    return new if node == old else Node(node.op, tuple(args), node.value)


def cancelled(law: Node, factor: Node) -> Node:
    """Return a sum of products, a factor cancelled with an equal divisor, or else the same tree."""
    if law.op in ("+", "neg"):
        return Node(law.op, tuple(cancelled(term, factor) for term in law.args))
    sides = _factors(law)
    if not all(factor in side for side in sides):
        return law
    for side in sides:
        side[side.index(factor)] = num(1)
    return Node("/", tuple(reduce(lambda a, b: Node("*", (a, b)), side) for side in sides))


def _factors(node: Node) -> tuple[list[Node], list[Node]]:
    """Return the factors that a tree multiplies, and those that it divides by."""
    if node.op not in ("*", "/"):
        return [node], []
    (above, below), (more, less) = map(_factors, node.args)
    more, less = (more, less) if node.op == "*" else (less, more)
    return [*above, *more], [*below, *less]


def derivative(node: Node, by: Any) -> Node:
    """Return the derivative of a law in a symbol, on each branch; for a sum, that of one lane."""
    if by not in symbols(node) or node.op == "sym":
        return num(int(node.op == "sym" and node.value == by))
    if node.op in KINKS:  # again, as definitions such as that of saturate have kinks
        return derivative(unkinked(node), by)
    inner = tuple(arg if arg.op == "cmp" else derivative(arg, by) for arg in node.args)
    x, z, dx, dz = node.args[0], node.args[-1], inner[0], inner[-1]
    if node.op in ("+", "if", "sum"):
        return Node(node.op, inner) if node.op != "sum" else dx
    if node.op == "**":
        return build("n*y*dx", n=num(node.value), y=Node("**", (x,), node.value - 1), dx=dx)
    if node.op == "/" and dz == num(0):
        return Node("/", (dx, z))
    need(node.op != "pow" or dz == num(0), "an exponent changes")
    if node.op in SMOOTH:
        return Node("*", (build(SMOOTH[node.op].slope, x=x, y=node, z=z), dx))
    return build(SLOPES[node.op], x=x, z=z, dx=dx, dz=dz)


def number(text: str) -> Fraction:
    """Return the exact value of a decimal number."""
    mantissa, _, exponent = text.strip().lower().replace("_", "").partition("e")
    try:
        short = max(len(mantissa), len(exponent)) <= MAX_DIGITS
        small = short and abs(int(exponent or 0)) <= MAX_EXPONENT
        need(small, f"number {text[:40]!r} has too many digits")
        return Fraction(f"{mantissa}e{exponent or 0}")
    except ValueError:
        raise InputError(f"{text[:40]!r} is no finite number") from None


@cache
def parse(text: Any, length: int = MAX_LENGTH, compares: bool | None = None) -> Node:
    """Return the tree of a law, of a comparison if `compares`, or of either if that is None."""
    most = max(length, MAX_TABLE) if re.search(r"\btable *\(", str(text)) else length
    plain = isinstance(text, str) and len(text) <= most and PLAIN.fullmatch(text)
    need(plain, f"{str(text)[:60]!r} is no law of plain text, or too long")
    try:
        tree = _tree(ast.parse(text.strip(), mode="eval").body, text.strip())
    except (SyntaxError, ValueError, LookupError, ArithmeticError, RecursionError, MemoryError):
        raise InputError(f"{text[:60]!r} is not of the law grammar") from None
    summed = length <= MAX_LENGTH and any(part.op == "sum" for part in walk(tree))
    expected = compares in (None, tree.op == "cmp") and not summed
    need(expected, f"{text[:60]!r} is a comparison, or should be one, or has sums")
    return tree


def _tree(node: ast.AST, text: str) -> Node:
    """Return the tree of a part of a text; raises ValueError if it is not of the law grammar."""

    def of(*parts: ast.AST) -> tuple[Node, ...]:
        found = tuple(_tree(part, text) for part in parts)
        if any(part.op == "cmp" for part in found):
            raise ValueError("a comparison inside a law")
        return found

    match node:
        case ast.Constant():
            return num(number(text[node.col_offset : node.end_col_offset]))
        case ast.UnaryOp(ast.USub(), ast.Constant() as size):
            return num(-_tree(size, text).value)
        case ast.Name(name):
            return sym(name)
        case ast.BinOp(base, ast.Pow(), exponent):
            return _power(*of(base, exponent))
        case ast.BinOp(_, ast.Add() | ast.Sub()):
            terms = list[Node]()
            while isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub):
                (term,) = of(node.right)
                terms.append(term if isinstance(node.op, ast.Add) else Node("neg", (term,)))
                node = node.left
            return Node("+", (*of(node), *reversed(terms)))
        case ast.BinOp(op=op) | ast.UnaryOp(op=op) | ast.Compare(ops=[op]) if type(op) in OPERATORS:
            args = of(*(part for part in ast.iter_child_nodes(node) if isinstance(part, ast.expr)))
            name = OPERATORS[type(op)]
            return Node("cmp", args, name) if name in OPPOSITE else Node(name, args)
        case ast.IfExp(ast.Compare() as test, then, other):
            return Node("if", (_tree(test, text), *of(then, other)))
        case ast.Call(ast.Name("sum"), [ast.Name(bank), law], []):
            return Node("sum", of(law), bank)
        case ast.Call(ast.Name("sqrt"), [arg], []):
            return Node("**", of(arg), Fraction(1, 2))
        case ast.Call(ast.Name("table"), args, []) if len(args) % 2:
            need(2 <= len(args) // 2 <= MAX_KNOTS, "a table has too few knots, or too many")
            return Node("table", of(*args))
        case ast.Call(ast.Name(name), args, []) if ARGUMENTS.get(name) == len(args):
            return Node(name, of(*args))
    raise ValueError(node)


def _power(base: Node, exponent: Node) -> Node:
    """Return a power; with names in the exponent by exp and log, or `pow` if the base chooses."""
    parts = [base]
    for part in parts:
        parts += part.args[: {"*": 2, "/": 1}.get(part.op, 0)]
    chooses = any(part.op in ("if", "pow", *KINKS) for part in parts)
    if symbols(exponent) and exponent.op != "neg" and chooses:
        return Node("pow", (base, exponent))
    if symbols(exponent):
        return Node("exp", (Node("*", (exponent, Node("log", (base,)))),))
    power = _value(exponent)
    need(max(abs(power.numerator), power.denominator) <= MAX_POWER, "a power is too large")
    return Node("**", (base,), power)


def _value(node: Node) -> Fraction:
    """Return the value of a numeric exponent."""
    args = [_value(arg) for arg in node.args]
    return ARITHMETIC[node.op](*args) if args else Fraction(node.value)
