"""Laws as nested tuples: read from text, written as text, searched and changed.

Input: a law or a comparison as text.  Output: ``(head, *parts)``, the head an operator or a
function: ``("num", q)``, ``("name", s)``, ``("**", base, q)`` and ``("if", then, test, other)``.
Nothing of the package is used.
"""

import ast
from fractions import Fraction
from functools import lru_cache

BINARY = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/"}
COMPARE = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">="}
BINDS = {"if": 0, "+": 1, "-": 1, "*": 2, "/": 2, "neg": 3, "**": 4}
TWO = ("min", "max", "deadzone", "saturate")
ZERO, ONE = ("num", Fraction(0)), ("num", Fraction(1))


def read(text):
    """Return the tree of a law or a comparison."""
    return _tree(ast.parse(text.strip(), mode="eval").body)


def _tree(node):
    match node:
        case ast.Constant(value):
            return ("num", Fraction(repr(value)))
        case ast.Name(name):
            return ("name", name)
        case ast.UnaryOp(ast.USub(), arg):
            return ("neg", _tree(arg))
        case ast.BinOp(base, ast.Pow(), exponent):
            return ("**", _tree(base), number(_tree(exponent)))
        case ast.BinOp(left, op, right):
            return (BINARY[type(op)], _tree(left), _tree(right))
        case ast.Compare(left, [op], [right]):
            return (COMPARE[type(op)], _tree(left), _tree(right))
        case ast.IfExp(test, then, other):
            return ("if", _tree(then), _tree(test), _tree(other))
        case ast.Call(ast.Name(function), args):
            return (function, *map(_tree, args))
    raise ValueError(ast.dump(node))


def number(node):
    """Return the value of an exponent."""
    match node:
        case ("num", value):
            return value
        case ("neg", arg):
            return -number(arg)
        case ("/", top, bottom):
            return number(top) / number(bottom)
    raise ValueError(node)


def text(node, binds=0):
    """Return a tree as text."""
    head, *parts = node
    match head:
        case "num":
            return _digits(parts[0])
        case "name":
            return parts[0]
        case "neg":
            found = f"-{text(parts[0], 3)}"
        case "**":
            found = f"{text(parts[0], 5)}**({parts[1]})"
        case "if":
            found = f"{text(parts[0], 1)} if {text(parts[1])} else {text(parts[2])}"
        case "+" | "-" | "*" | "/":
            own = BINDS[head]
            found = f"{text(parts[0], own)} {head} {text(parts[1], own + 1)}"
        case "<" | "<=" | ">" | ">=":
            return f"{text(parts[0], 1)} {head} {text(parts[1], 1)}"
        case _:
            return f"{head}({', '.join(map(text, parts))})"
    return f"({found})" if BINDS[head] < binds else found


def _digits(value):
    if value.denominator == 1 and abs(value) < 10**6:
        return str(value)
    short = repr(float(value))
    return short if Fraction(short) == value else f"({value.numerator}/{value.denominator})"


def parts_of(node):
    """Return the direct parts of a tree."""
    return tuple(part for part in node[1:] if isinstance(part, tuple))


def walk(node):
    """Yield a tree and all that is in it."""
    yield node
    for part in parts_of(node):
        yield from walk(part)


@lru_cache(maxsize=20_000)
def names(*nodes):
    """Return the names in trees, each once."""
    return tuple(dict.fromkeys(n[1] for node in nodes for n in walk(node) if n[0] == "name"))


def put(node, found):
    """Return a tree with names replaced by trees."""
    if node[0] == "name":
        return found.get(node[1], node)
    return (node[0], *(put(p, found) if isinstance(p, tuple) else p for p in node[1:]))


def changed(node, path, new):
    """Return a tree with the part at a path, indices from the top, replaced."""
    if not path:
        return new
    n = path[0]
    return (*node[:n], changed(node[n], path[1:], new), *node[n + 1 :])


def paths(node, before=()):
    """Yield (path, part) of every part of a tree, itself included."""
    yield before, node
    for n, part in enumerate(node):
        if n and isinstance(part, tuple):
            yield from paths(part, (*before, n))


def edges(node):
    """Yield (kind, difference): where it is zero, a law may bend, jump or end.

    The kind is "jump" where a branch changes, "bend" at a kink, "pole" for what a law divides by,
    "end" where a root or a logarithm ends.
    """
    for part in walk(node):
        match part:
            case ("<" | "<=" | ">" | ">=", left, right):
                yield "jump", ("-", left, right)
            case ("sign", z):
                yield "jump", z
            case ("abs", z):
                yield "bend", z
            case ("min" | "max", z, w):
                yield "bend", ("-", z, w)
            case ("deadzone" | "saturate", z, w):
                yield "bend", ("-", z, w)
                yield "bend", ("+", z, w)
            case ("/", _, z) if names(z):
                yield "pole", z
            case ("sqrt" | "log", z) if names(z):
                yield "end", z
            case ("**", z, exponent) if names(z) and exponent.denominator > 1:
                yield "end", z
            case ("**", z, exponent) if names(z) and exponent < 0:
                yield "pole", z


def widths(node):
    """Yield the half widths in a law, plain numbers aside."""
    for part in walk(node):
        if part[0] in {"deadzone", "saturate"} and part[2][0] != "num":
            yield part[2]
