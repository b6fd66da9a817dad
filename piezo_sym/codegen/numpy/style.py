"""The spelling of expressions in NumPy, and the parameters that they need as NumPy's numbers.

Input: a tree.  Output: one line of NumPy.  A dead zone prints as ``z - clip(z, -w, w)``, one pass
over an array instead of five.  `np.where` computes both sides of a choice, and Python's own floats
raise an error where they divide by zero; NumPy's give inf, as C does.  What is positive by its form
divides without error.
"""

from collections.abc import Collection, Iterable
from dataclasses import dataclass
from fractions import Fraction
from typing import final

from piezo_sym.codegen.program import Quantity
from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.text import (
    ATOM,
    POWER,
    PRODUCT,
    SUM,
    Piece,
    Style,
    decimal,
    enclose,
    write,
)
from piezo_sym.expressions.tidying import sign_of
from piezo_sym.expressions.tree import Div, Expr, If, Node, Pow, Sym, names, walk

STRENGTHS = {"atom": ATOM, "sum": SUM}


@final
@dataclass(frozen=True)
class _Operand:
    """A piece in the template of a record, where ``{x:sum}`` adds parentheses if x needs them."""

    piece: Piece

    def __format__(self, strength: str) -> str:
        return enclose(self.piece, STRENGTHS[strength]) if strength else self.piece[0]


def _number(value: Fraction) -> Piece:
    if value < 0:
        return f"-{enclose(_number(-value), PRODUCT)}", SUM
    text = decimal(value)
    if text and len(text) <= 20:
        return text, ATOM
    if value.denominator == 1 or text:
        return repr(float(value)), ATOM
    return f"{value.numerator}/{value.denominator}", PRODUCT


def _power(base: Piece, exponent: Fraction) -> Piece:
    if exponent == Fraction(1, 2):
        return f"np.sqrt({base[0]})", ATOM
    if exponent.denominator == 1 and exponent > 0:
        return f"{enclose(base, ATOM)}**{exponent.numerator}", POWER
    return f"{enclose(base, ATOM)}**({enclose(_number(exponent), SUM)})", POWER


def _call(function: str, args: tuple[Piece, ...]) -> Piece:
    record = RECORDS[function]
    if "{" not in record.numpy:
        return f"{record.numpy}({', '.join(text for text, _ in args)})", ATOM
    text = record.numpy.format(x=_Operand(args[0]), w=_Operand(args[-1]))
    return text, STRENGTHS[record.binds]


def _choose(then: Piece, test: str, other: Piece) -> Piece:
    parts = [then[0], other[0]]
    if all(part.removeprefix("-").isdecimal() for part in parts):
        parts = [f"{part}.0" for part in parts]  # an array of floats, as other values are
    return f"np.where({test}, {', '.join(parts)})", ATOM


NUMPY = Style(
    number=_number,
    name=lambda name: (name, ATOM),
    power=_power,
    call=_call,
    choose=_choose,
    lane_sum=lambda arg, _: (f"np.sum({arg[0]}, axis=0)", ATOM),
)


def numpy_text(node: Expr) -> str:
    """Return an expression as NumPy; names are locals of the generated function."""
    return write(node, NUMPY)


def divisors(
    roots: Iterable[Node],
    quantities: Iterable[Quantity],
    parameters: Collection[str],
    positive: Collection[str],
) -> frozenset[str]:
    """Return the parameters by which choices divide other parameters, or of which they take roots.

    `parameters` are names of Python's floats; quantities made of them alone are floats, too.  Those
    in `positive` are so in the domain; b - r of two such may be zero.
    """
    values, floats, above = {q.name: q.value for q in quantities}, {*parameters}, {*positive}
    for name, value in values.items():
        floats |= {name} if {*names(value)} <= floats else set()
        above |= {name} if sign_of(value, above) == 1 else set()
    trees = [*roots, *values.values()]
    left: list[Node] = [n for tree in trees for n in walk(tree) if isinstance(n, If)]
    seen, found = set[str](), set[str]()
    while left:
        for part in walk(left.pop()):
            if isinstance(part, Sym) and part.name in values.keys() - seen:
                seen.add(part.name)
                left.append(values[part.name])
            below = _below(part)
            if below and {*names(part)} <= floats and sign_of(below, above) != 1:
                found.update(names(below))
    for name in reversed(values):
        found.update(names(values[name]) if name in found else ())
    return frozenset(found & {*parameters})


def _below(node: Node) -> Expr | None:
    """Return what a node divides by, or takes a root of."""
    match node:
        case Div(_, bottom):
            return bottom
        case Pow(base, exponent) if exponent < 0 or exponent.denominator != 1:
            return base
    return None
