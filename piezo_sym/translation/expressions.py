"""Expressions of printed text, Python's or C's, as values in normal form.

Input: a tree of Python's `ast`, into which `c_reader` parses C too, and what names stand for.
Output: a value and its shape.  Nothing is executed; what is not in the grammar is refused.

    sum, difference, product, quotient, negative, rational power, comparison, ``a or b``,
    ``a if test else b``, and calls of the functions below.

Identities, for all real numbers: expm1(z) = exp(z) - 1; fabs, sign, minimum, maximum and clip by
their cases, clip(x, a, b) = min(max(x, a), b); copysign(w, z) = |w| sign(z), of z = 0 nothing is
known.
"""

import ast
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import final

from piezo_sym.translation.field import GeneratorField, NotShownError, Value
from piezo_sym.translation.functions import call, power, raised, size_of
from piezo_sym.translation.signs import choose, compare, on_path, side_of

MOST_MAGNITUDE = 300
MOST_WHOLE = 2**31 - 1
_ARGUMENTS = {"choice": 3, "pow": 2, "copysign": 2, "minimum": 2, "maximum": 2, "clip": 3}
#: NumPy's functions that return integers for integer arguments; these may overflow.
_INTEGERS = frozenset({"abs", "sign", "minimum", "maximum", "clip"})
_OPERATORS = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!="}


@final
@dataclass(frozen=True)
class Shape:
    """The kind of an expression (number, integer, condition, array), and the banks of its axes."""

    #: "" for a number of one state, "whole" for an integer, "test" for a condition; for arrays
    #: "maybe" (lanes, if the parameters of a bank are lists), "lanes", "row" and "column" (lanes of
    #: the one or other axis of a matrix) and "pair".
    kind: str = ""
    #: bank, other: the bank of an array's lanes; for a pair, the banks of row and column.
    bank: str = ""
    other: str = ""
    #: Whether it is a choice between equal integers, allowed only as a part of a real expression:
    #: arrays of integers wrap round, and C truncates their quotients.
    integers: bool = False

    @property
    def is_whole(self) -> bool:
        """Whether it is of integers."""
        return self.kind == "whole" or self.integers


PLAIN, WHOLE, TEST = Shape(), Shape("whole"), Shape("test")
Read = tuple[Value, Shape]
Leaf = Callable[[ast.expr], Read]


@final
@dataclass(frozen=True)
class Expressions:
    """Reads expressions."""

    field: GeneratorField  # of the values
    numbers: Mapping[float, Fraction]  # see `Proved`
    #: Reads what the language or its names give a meaning: names, subscripts, other calls.
    leaf: Leaf
    functions: Mapping[str, str]  # the function of laws behind each function name in the text
    whole_division: bool  # whether a quotient of integers is an integer, as in C

    def __call__(self, node: ast.expr) -> Read:
        """Return an expression's value and shape."""
        match node:
            case ast.Constant(number):
                return self._number(number)
            case ast.UnaryOp(ast.USub(), arg):
                value, shape = self.any(arg)
                return self._bounded((-value, shape), node)
            case ast.BinOp():
                return self._operations(node)
            case ast.Compare(left, [operator], [right]) if type(operator) in _OPERATORS:
                first, second = self.numeric(left), self.numeric(right)
                joined(first[1], second[1], node)
                op = _OPERATORS[type(operator)]
                return compare(op, first[0], second[0]), TEST
            case ast.BoolOp(ast.Or(), nodes) if self.whole_division:
                one = none = self.field.one
                for part in nodes:
                    none = none * (one - self.test(part))
                return one - none, TEST
            case ast.IfExp(test, then, other) if self.whole_division:
                return self.choice(test, then, other)
            case ast.Call(function, args, []) if ast.unparse(function) in self.functions:
                return self._call(self.functions[ast.unparse(function)], args, node)
        return self.leaf(node)

    def any(self, node: ast.expr) -> Read:
        """Return an expression that is no condition."""
        value, shape = self._part(node)
        if shape.integers:
            raise refused(node, "a choice of integers")
        return value, shape

    def _part(self, node: ast.expr) -> Read:
        value, shape = self(node)
        if shape == TEST:
            raise refused(node, "a condition as a number")
        return value, shape

    def numeric(self, node: ast.expr) -> Read:
        """Return an expression as a real number."""
        return self._real(self.any(node))

    def _real(self, read: Read) -> Read:
        value, shape = read
        if shape == WHOLE:
            return value, PLAIN
        return value, replace(shape, integers=False) if shape.integers else shape

    def whole(self, node: ast.expr) -> Value:
        """Return an integer: an index or a size."""
        value, shape = self(node)
        if shape != WHOLE:
            raise refused(node, "no integer")
        return value

    def test(self, node: ast.expr) -> Value:
        """Return a condition: 1 where it holds."""
        value, shape = self(node)
        if shape != TEST:
            raise refused(node, "a number as a condition")
        return value

    def choice(self, condition: ast.expr, then: ast.expr, other: ast.expr) -> Read:
        """Return the value of a choice; either of its two values need exist only where chosen."""
        field, test, parts = self.field, self.test(condition), list[Read]()
        for chosen, node in ((test, then), (field.one - test, other)):
            with on_path(field, field.path and field.path * chosen):
                parts.append(self._part(node))
        (first, shape), (second, shape_of_other) = map(self._real, parts)
        whole = all(own.is_whole for _, own in parts)
        if whole and first != second:
            raise refused(then, "a choice of integers")
        value = first if whole else choose(test, first, second)
        shape = joined(joined(shape, shape_of_other, then), self.shape_of(condition), condition)
        return value, replace(shape, integers=whole)

    def shape_of(self, condition: ast.expr) -> Shape:
        """Return the shape of the numbers that a condition compares."""
        if isinstance(condition, ast.Compare):
            sides = self.numeric(condition.left)[1], self.numeric(condition.comparators[0])[1]
            return joined(joined(*sides, condition), PLAIN, condition)
        return PLAIN

    def _number(self, value: object) -> Read:
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise NotShownError(f"{str(value)[:20]!r} is no number")
        if value and not 10.0**-MOST_MAGNITUDE <= abs(value) <= 10**MOST_MAGNITUDE:
            raise NotShownError("a number is too large")
        if isinstance(value, int):
            return self.field.number(value), WHOLE
        return self.field.number(self.numbers.get(value) or Fraction(repr(value))), PLAIN

    def _operations(self, node: ast.expr) -> Read:
        """Return a sum or product of many, its operators taken from left to right."""
        rest: list[ast.BinOp] = []
        while isinstance(node, ast.BinOp):
            rest.append(node)
            node = node.left
        made = self._part(node)
        for part in reversed(rest):
            made = self._operation(made, part.op, self._part(part.right), part)
        return made

    def _operation(self, left: Read, operator: ast.operator, right: Read, node: ast.expr) -> Read:
        if left[1].integers or right[1].integers:
            if left[1].is_whole and right[1].is_whole:
                raise refused(node, "a choice of integers")
            left, right = self._real(left), self._real(right)
        shape = joined(left[1], right[1], node)
        if shape != WHOLE or isinstance(operator, ast.Div):
            left, right = self._real(left), self._real(right)
        match operator:
            case ast.Add():
                return self._bounded((left[0] + right[0], shape), node)
            case ast.Sub():
                return self._bounded((left[0] - right[0], shape), node)
            case ast.Mult():
                return self._bounded((left[0] * right[0], shape), node)
            case ast.Div() if shape != WHOLE or not self.whole_division:
                shape = PLAIN if shape == WHOLE else shape
                return left[0] * power(right[0], Fraction(-1)), shape
            case ast.Pow() if right[0].constant is not None and not self.whole_division:
                return self._bounded((power(left[0], right[0].constant), left[1]), node)
        raise refused(node, "an operator")

    def _bounded(self, read: Read, node: ast.expr) -> Read:
        """Return a value as it is; refuse an integer that may wrap round in C or in NumPy."""
        if read[1] == WHOLE and abs(read[0].constant or Fraction(0)) > MOST_WHOLE:
            raise refused(node, "an integer that is too large")
        return read

    def _call(self, function: str, nodes: list[ast.expr], node: ast.expr) -> Read:
        if function == "choice" and len(nodes) == 3:
            return self.choice(*nodes)
        given = [self.any(arg) for arg in nodes]
        whole = function in _INTEGERS and all(own == WHOLE for _, own in given)
        read, shape = [self._real(part) for part in given], PLAIN
        for _, own in read:
            shape = joined(shape, own, node)
        args = [value for value, _ in read]
        if len(args) != _ARGUMENTS.get(function, 1):
            raise refused(node, "a call")
        value, shape = self.apply(function, args), joined(shape, PLAIN, node)
        return value, WHOLE if whole and not self.whole_division else shape

    def apply(self, function: str, args: list[Value]) -> Value:
        """Return a function of values."""
        field, z, w = self.field, args[0], args[-1]
        match function:
            case "expm1":
                return call("exp", z) - field.one
            case "sqrt":
                return power(z, Fraction(1, 2))
            case "abs":
                return size_of(z)
            case "sign":
                return side_of(z)
            case "minimum":
                return choose(compare("<=", z, w), z, w)
            case "maximum":
                return choose(compare(">=", z, w), z, w)
            case "clip":
                return self.apply("minimum", [self.apply("maximum", args[:2]), w])
            case "pow":
                exponent = w.constant
                return raised(z, w) if exponent is None else power(z, exponent)
            case "copysign":
                unknown = field.generator("unknown", None, (f"copysign {len(field.gens)}", None, 0))
                of_zero = compare("==", w, field.zero) * unknown
                return size_of(z) * (side_of(w) + of_zero)
        return call(function, z)


def refused(node: ast.AST, what: str) -> NotShownError:
    """Return the error, to be raised, that `what` at a node is outside the grammar."""
    return NotShownError(f"{what} outside the grammar: {ast.unparse(node)[:60]}")


def joined(left: Shape, right: Shape, node: ast.AST) -> Shape:
    """Return the shape of an operation on values of two shapes."""
    if left == right:
        return left
    if not left.bank or not right.bank:
        return left if left.bank else right if right.bank else PLAIN
    kinds = {left.kind: left, right.kind: right}
    if kinds.keys() == {"maybe", "lanes"} and left.bank == right.bank:
        return kinds["lanes"]
    if kinds.keys() == {"row", "column"}:
        return Shape("pair", kinds["row"].bank, kinds["column"].bank)
    raise refused(node, "lanes of two banks")
