"""Trees at many points at once, in floats.

Input: a tree, and the value of each name, of shape (points) or, in a bank, (lanes, points).
Output: an `Approx`.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, partial, reduce
from typing import Any, final

import numpy as np

from piezo_sym.expressions.calculus import choices, increasing, rule
from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.tree import (
    COMPARED,
    Add,
    Call,
    Cmp,
    Div,
    Expr,
    If,
    LaneSum,
    Mul,
    Neg,
    Num,
    Pow,
    Sym,
    knots,
)

#: A tree, and the bank of which it has a value per lane.
Row = tuple[Expr, str | None]


@final
@dataclass(frozen=True, slots=True)
class Approx:
    """A law in floats."""

    value: Any  # of the law
    #: The sum of the absolute values of its terms; value/size distinguishes cancellation from a
    #: change of sign.
    size: Any
    lost: Any = False  # mask of the points where it has no value on the branch taken


@final
class Floats(dict[Expr, Approx]):
    """The values of trees at points, each part computed once.

    `given` returns the value of a name, or None; `defined` has the trees of other names, `counts`
    the size of each bank.
    """

    def __init__(
        self, given: Callable[[str], Any], defined: Mapping[str, Row], counts: Mapping[str, int]
    ) -> None:
        super().__init__()
        self.given, self.defined, self.counts = given, defined, counts

    def __missing__(self, node: Expr) -> Approx:
        """Compute the value of a tree, and keep it."""
        self[node] = self._computed(node)
        return self[node]

    def _computed(self, node: Expr) -> Approx:
        match node:
            case Num(number):
                return _plain(np.float64(number))
            case Sym(name):
                known = self.given(name)
                return _plain(self[self.defined[name][0]].value if known is None else known)
            case LaneSum(arg, bank):
                own = self[arg]
                shape = self.counts[bank], *np.shape(own.value)[-1:]
                both = (np.broadcast_to(part, shape).sum(axis=0) for part in (own.value, own.size))
                return Approx(*both)
            case Neg(arg):
                inner = self[arg]
                return Approx(-inner.value, inner.size, inner.lost)
            case Add(terms):
                return reduce(partial(_each, np.add), (self[term] for term in terms))
            case Mul(left, right):
                return _each(np.multiply, self[left], self[right])
            case Div(left, right):
                b = self[right]
                return _each(np.divide, self[left], _plain(b.value, b.lost | (b.value == 0)))
            case Pow(base, exponent):
                return _power(self[base], exponent)
            case If(then, Cmp(op, left, right), other):
                taken = COMPARED[op](self[left].value, self[right].value)
                found = _each(partial(np.where, taken), self[then], self[other])
                lost = found.lost | self[left].lost | self[right].lost
                return Approx(found.value, found.size, lost)
            case Call("pow", (base, exponent)):
                a, w = self[base], self[exponent]
                lost = a.lost | w.lost | (a.value < 0) | (w.value <= 0)
                return _plain(a.value**w.value, lost)
            case Call(function, (arg,)) if RECORDS[function].smooth:
                return _smooth(function, self[arg])
            case Call():
                return self._kinked(node)
        raise TypeError(f"{type(node).__name__} is no law")

    def _kinked(self, node: Call) -> Approx:
        formula = RECORDS[node.function].formula
        inner = self[rule(formula, node.args[0], node.args[-1]) if formula else choices(node)]
        order = (self[c.left].value < self[c.right].value for c in increasing(node))
        lost = reduce(lambda out, rises: out | ~rises, order, inner.lost)
        return _plain(inner.value, lost, inner.size if knots(node) else None)


def _power(a: Approx, exponent: Fraction) -> Approx:
    integer = exponent.denominator == 1
    e = exponent.numerator if integer else float(exponent)
    lost = a.lost | (a.value == 0 if e < 0 else False) | (False if integer else a.value < 0)
    return _plain(a.value**e, lost, a.size**e if integer and e > 0 else None)


def _smooth(function: str, a: Approx) -> Approx:
    domain = RECORDS[function].domain
    outside = (a.value < 0 if "=" in domain else a.value <= 0) if domain else False
    return _plain(_function(function)(a.value), a.lost | outside)


def _plain(value: Any, lost: Any = False, size: Any = None) -> Approx:
    return Approx(value, np.abs(value) if size is None else size, lost)


def _each(operation: Callable[..., Any], a: Approx, b: Approx) -> Approx:
    """Return an operation applied to values and sizes; a choice is applied to `lost`, too."""
    chosen = isinstance(operation, partial)
    lost = operation(a.lost, b.lost) if chosen else a.lost | b.lost
    return Approx(operation(a.value, b.value), operation(a.size, b.size), lost)


@cache
def _function(name: str) -> Callable[[Any], Any]:
    own = getattr(np, RECORDS[name].numpy.removeprefix("np."), None)
    return own or np.vectorize(getattr(math, name), otypes=[float])
