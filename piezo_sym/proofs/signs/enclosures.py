"""Enclosures of a law on an interval of its one letter, sharp enough to decide signs.

Input: a tree in one name, and a window a < t <= b of that name.  Output: an `Enclosure`: the jet on
the window, and the jets of its limits at both ends.  In every part of the tree, a coefficient whose
derivative has one sign is monotone and lies between its limits at the ends; that undoes most of the
cancellation in interval arithmetic.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial, reduce
from typing import final

from piezo_sym.expressions.calculus import choices, rule
from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.tree import Add, Call, Cmp, Div, Expr, If, Mul, Neg, Num, Pow, Sym
from piezo_sym.proofs.signs import intervals as iv
from piezo_sym.proofs.signs import jets
from piezo_sym.proofs.signs.intervals import INF, Interval
from piezo_sym.proofs.signs.jets import Jet
from piezo_sym.proofs.signs.shift import vanishes


@final
@dataclass(frozen=True, slots=True)
class Window:
    """The reals t with lo < t <= hi, 0 <= lo; derivatives up to `order` are evaluated."""

    lo: float
    hi: float
    order: int


@final
@dataclass(frozen=True, slots=True)
class Enclosure:
    """A function on a window."""

    inner: Jet  # its jet on the window
    #: left, right: jets of its one-sided limits at lo and hi, as long as they are known.
    left: Jet = ()
    right: Jet = ()
    #: The logarithmic derivative f'/f on the window (almost everywhere, if f is only Lipschitz);
    #: None if not known.
    growth: Interval | None = None


def enclose(tree: Expr, window: Window) -> Enclosure:
    """Return the enclosure of a tree and its derivatives on a window of its only name."""
    order = window.order
    variable = Enclosure(
        _variable(iv.interval(window.lo, window.hi, nonzero=True), order),
        _variable(iv.rational(Fraction(window.lo)), order),
        () if window.hi == INF else _variable(iv.rational(Fraction(window.hi)), order),
    )
    return _enclose(tree, variable, order)


def value(tree: Expr, at: Fraction) -> Interval | None:
    """Return an enclosure of a tree's value at a number; None if it is not known to have one."""
    found = _enclose(tree, Enclosure((iv.rational(at),)), 0).inner
    return found[0] if found else None


def _variable(at: Interval, order: int) -> Jet:
    return (at, iv.ONE, *(iv.ZERO for _ in range(order - 1)))[: order + 1]


def _enclose(node: Expr, x: Enclosure, order: int) -> Enclosure:
    """Return the enclosure of a tree for the enclosure `x` of its only name."""

    def of(part: Expr) -> Enclosure:
        return _enclose(part, x, order)

    match node:
        case Num(number):
            jet = jets.constant(number, order)
            return Enclosure(jet, jet, jet)
        case Sym():
            return x
        case Neg(arg):
            return _minus(of(arg))
        case Add(terms):
            return _cancelled(_sum([of(term) for term in terms]), node, x)
        case Mul(left, right):
            return _product(of(left), of(right))
        case Div(left, right):
            return _product(of(left), _power(of(right), Fraction(-1)))
        case Pow(base, exponent):
            return _power(of(base), exponent)
        case Call(function, args) if function in KINKED:
            return KINKED[function](*map(of, args))
        case Call("pow"):  # not known for an exponent that is no number
            return Enclosure(())
        case Call(function, args) if RECORDS[function].smooth:
            return _smooth(function, of(args[0]))
        case Call(function, args):
            formula = RECORDS[function].formula
            return of(rule(formula, args[0], args[-1]) if formula else choices(node))
        case If(then, Cmp(op, left, right), other):
            difference = _sum([of(left), _minus(of(right))])
            return _choice(of(then), op, difference.inner, of(other))
    raise TypeError(f"{type(node).__name__} is no law")


def _sum(parts: list[Enclosure]) -> Enclosure:
    return reduce(partial(_lifted, jets.plus), parts)


def _cancelled(total: Enclosure, tree: Expr, x: Enclosure) -> Enclosure:
    """Return a sum with an exact zero at its left end, or its point, if its terms cancel there."""
    if x.left and _cancels(total.left, tree, x.left[0]):
        left = (iv.ZERO, *total.left[1:])
        return Enclosure(_sharpened(total.inner, left, total.right), left, total.right)
    if not x.left and _cancels(total.inner, tree, x.inner[0]):
        return Enclosure((iv.ZERO,))
    return total


def _cancels(jet: Jet, tree: Expr, at: Interval) -> bool:
    """Return whether a limit whose enclosure contains zero is exactly zero."""
    vague = jet and jet[0].exact is None and jet[0].lo <= 0 <= jet[0].hi
    return bool(vague) and at.exact is not None and vanishes(tree, at.exact)


def _lifted(operation: Callable[..., Jet], *parts: Enclosure) -> Enclosure:
    """Return an operation on jets applied on the window and at its ends, sharpened."""
    inner = operation(*(part.inner for part in parts))
    left = operation(*(part.left for part in parts))
    right = operation(*(part.right for part in parts))
    return Enclosure(_sharpened(inner, left, right), left, right)


def _sharpened(inner: Jet, left: Jet, right: Jet) -> Jet:
    """Return a jet with each monotone coefficient narrowed to between its limits at the ends.

    A function that is locally Lipschitz in a < t < b with f' >= 0 almost everywhere does not
    decrease, so it lies between its limits at a and b; where f' > 0, it is above its limit at a.
    Likewise downward.  The highest derivative comes first, as it sharpens the next.
    """
    found = list(inner)
    for k in reversed(range(len(found) - 1)):
        first = left[k] if len(left) > k else iv.EVERYTHING
        last = right[k] if len(right) > k else iv.EVERYTHING
        found[k] = _monotone(found[k], found[k + 1], first, last)
    return tuple(found)


def _monotone(part: Interval, slope: Interval, first: Interval, last: Interval) -> Interval:
    if slope.lo >= 0:
        above = slope.nonzero and first.lo >= 0
        return iv.narrowed(part, first.lo, last.hi, nonzero=above)
    if slope.hi <= 0:
        below = slope.nonzero and first.hi <= 0
        return iv.narrowed(part, last.lo, first.hi, nonzero=below)
    return part


def _product(a: Enclosure, b: Enclosure) -> Enclosure:
    """Return a*b; (ab)'/(ab) = a'/a + b'/b."""
    first, second = _growth(a), _growth(b)
    growth = None if first is None or second is None else iv.plus(first, second)
    return _grown(_lifted(jets.times, a, b), growth)


def _power(a: Enclosure, exponent: Fraction) -> Enclosure:
    """Return a**e; (a^e)'/a^e = e a'/a."""
    growth = _growth(a)
    if growth is not None:
        growth = iv.times(iv.rational(exponent), growth)
    return _grown(_lifted(lambda jet: jets.power(jet, exponent), a), growth)


def _growth(a: Enclosure) -> Interval | None:
    """Return f'/f, or None if f may be zero."""
    below = iv.inverse(a.inner[0]) if len(a.inner) > 1 else None
    if a.growth is not None or below is None:
        return a.growth
    return iv.times(a.inner[1], below)


def _grown(a: Enclosure, growth: Interval | None) -> Enclosure:
    """Return a product sharpened by its growth: f' = f (f'/f), and f' >= 0 makes f monotone.

    The sum of products for f' would not show the sign of x exp(-x) far out: both of its terms are
    0 times infinity.
    """
    if growth is None or len(a.inner) < 2:
        return Enclosure(a.inner, a.left, a.right, growth)
    slope = iv.times(a.inner[0], growth)
    sharper = iv.narrowed(a.inner[1], slope.lo, slope.hi, slope.nonzero)
    inner = _sharpened((a.inner[0], sharper, *a.inner[2:]), a.left, a.right)
    return Enclosure(inner, a.left, a.right, growth)


def _smooth(function: str, arg: Enclosure) -> Enclosure:
    found = _lifted(lambda jet: jets.applied(function, jet), arg)
    growth = arg.inner[1] if function == "exp" and len(arg.inner) > 1 else None
    return _grown(found, growth)  # exp(a)'/exp(a) = a'


def _minus(a: Enclosure) -> Enclosure:
    return replace(_lifted(jets.minus, a), growth=a.growth)


def _absolute(z: Enclosure) -> Enclosure:
    """Return abs(z) by the branch taken on the window; with a kink inside, as Lipschitz."""
    if not z.inner or z.inner[0].lo >= 0:
        return z
    if z.inner[0].hi <= 0:
        return _minus(z)
    slopes = tuple(iv.hull(slope, iv.minus(slope)) for slope in z.inner[1:2])
    left, right = (tuple(iv.magnitude(end) for end in side[:1]) for side in (z.left, z.right))
    return Enclosure((iv.magnitude(z.inner[0]), *slopes), left, right)


def _sign(z: Enclosure) -> Enclosure:
    """Return sign(z); no limits where z may be zero, as it may jump."""
    if not z.inner:
        return z
    at = z.inner[0]
    if at.exact == 0 or (at.nonzero and not at.lo < 0 < at.hi):
        jet = jets.constant(Fraction((at.lo >= 0) - (at.hi <= 0)), len(z.inner) - 1)
        return Enclosure(jet, jet, jet)
    return Enclosure((iv.interval(0.0 if at.lo >= 0 else -1.0, 0.0 if at.hi <= 0 else 1.0),))


def _larger(a: Enclosure, b: Enclosure) -> Enclosure:
    """Return max(a, b) by the branch taken on the window; with a kink inside, as Lipschitz."""
    difference = _sum([a, _minus(b)]).inner
    if not difference:
        return Enclosure(())
    if difference[0].lo >= 0:
        return a
    if difference[0].hi <= 0:
        return b
    slopes = tuple(iv.hull(x, y) for x, y in zip(a.inner[1:2], b.inner[1:2], strict=False))
    left, right = _larger_end(a.left, b.left), _larger_end(a.right, b.right)
    return Enclosure((_larger_value(a.inner[0], b.inner[0]), *slopes), left, right)


def _larger_end(a: Jet, b: Jet) -> Jet:
    return tuple(_larger_value(x, y) for x, y in zip(a[:1], b[:1], strict=False))


def _larger_value(a: Interval, b: Interval) -> Interval:
    if a.exact is not None and b.exact is not None:
        return iv.rational(max(a.exact, b.exact))
    return iv.interval(max(a.lo, b.lo), max(a.hi, b.hi))


#: Functions with kinks; the formulas of other kinked functions use these.
KINKED: Mapping[str, Callable[..., Enclosure]] = {
    "abs": _absolute,
    "sign": _sign,
    "max": _larger,
    "min": lambda a, b: _minus(_larger(_minus(a), _minus(b))),
}


def _choice(then: Enclosure, op: str, difference: Jet, other: Enclosure) -> Enclosure:
    """Return the branch that is taken, or if that is not known, the hull of both values."""
    if not difference:
        return Enclosure(())
    holds = _holds(op, difference[0])
    if holds is not None:
        return then if holds else other
    if not then.inner or not other.inner:
        return Enclosure(())
    return Enclosure((iv.hull(then.inner[0], other.inner[0]),))


def _holds(op: str, difference: Interval) -> bool | None:
    """Return whether ``difference op 0`` holds everywhere (True), nowhere (False), or neither."""
    above = _positive(difference if op in (">", "<=") else iv.minus(difference))
    if above is None or op in (">", "<"):
        return above
    return not above  # a <= 0 is not a > 0, and a >= 0 is not -a > 0


def _positive(a: Interval) -> bool | None:
    if a.lo >= 0 and a.nonzero:
        return True
    return False if a.hi <= 0 else None
