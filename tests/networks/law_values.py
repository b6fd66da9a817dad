"""The value of a law's text, found without the package: Python's own tree, walked.

Input: the text of a law and a number for each of its names.  Output: a number.
"""

import ast
import math
import operator

import numpy as np

OPERATORS = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.USub: operator.neg,
}


def table(z, *knots):
    """Return NumPy's interpolation, continued by the slopes at both ends."""
    x, y = knots[::2], knots[1::2]
    low, high = (np.diff(y[s]) / np.diff(x[s]) for s in (slice(2), slice(-2, None)))
    beyond = float(low[0] * min(z - x[0], 0) + high[0] * max(z - x[-1], 0))
    return float(np.interp(z, x, y)) + beyond


FUNCTIONS = {  # smooth functions are those of `math`
    "abs": abs,
    "sign": np.sign,
    "min": min,
    "max": max,
    "deadzone": lambda z, w: max(z - w, 0) + min(z + w, 0),
    "table": table,
    "saturate": lambda z, w: min(max(z, -w), w),
}


def value(text, words):
    """Return the value of a law."""
    return _value(ast.parse(text, mode="eval").body, words)


def _value(node, words):
    match node:
        case ast.Constant(number):
            return number
        case ast.Name(name):
            return words[name]
        case ast.UnaryOp(op, arg):
            return OPERATORS[type(op)](_value(arg, words))
        case ast.BinOp(left, op, right):
            return OPERATORS[type(op)](_value(left, words), _value(right, words))
        case ast.Call(ast.Name(name), args):
            function = FUNCTIONS.get(name) or getattr(math, name)
            return function(*(_value(arg, words) for arg in args))
        case ast.Compare(left, [op], [right]):
            return OPERATORS[type(op)](_value(left, words), _value(right, words))
        case ast.IfExp(test, then, other):
            return _value(then if _value(test, words) else other, words)
    raise TypeError(ast.dump(node))
