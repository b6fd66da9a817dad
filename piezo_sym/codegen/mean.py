"""Mean values over a step: the mean-value discrete gradient, and laws averaged across kinks.

Input: a law, and its variables before and after the step.  Output: the integral over s in [0, 1] of
the law at ``old + s*(new - old)``, as a tree.  For a co-state law dU/dx this is the discrete
gradient: its product with ``new - old`` is U(new) - U(old), to round-off.

    affine              its value at the middle
    x**n                sum of old**i*new**(n - i)/(n + 1)
    exp(a*x + b)        its old value times phi1(a*(new - old)), phi1(d) = (exp(d) - 1)/d
    max(x, 0)           ramp(old, new): no difference of integrals, so nothing cancels
    deadzone(x, w)      mean_deadzone(old, new, w), likewise
    tanh(x)             mean_tanh(old, new): a step may pass its bend as if it were a kink
    else                Gauss quadrature, exact to round-off for smooth laws over a step

`lead` is how far the law's last value is above its mean; it too is found without a difference.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction

from piezo_sym.expressions.calculus import add, derivative, div, mul, neg, power
from piezo_sym.expressions.tree import (
    Add,
    Call,
    Div,
    Expr,
    Mul,
    Neg,
    Num,
    Pow,
    names,
    replace,
)

HALF = Num(Fraction(1, 2))
#: Nodes and weights of Gauss's rule with eight nodes on [-1, 1], to 20 digits; both signs occur.
GAUSS = tuple(
    (Fraction(node), Fraction(weight))
    for node, weight in (
        ("0.18343464249564980494", "0.36268378337836198297"),
        ("0.52553240991632898582", "0.31370664587788728734"),
        ("0.79666647741362673959", "0.22238103445337447054"),
        ("0.96028985649753623168", "0.10122853629037625915"),
    )
)


def mean(law: Expr, old: Mapping[str, Expr], new: Mapping[str, Expr]) -> Expr:
    """Return the mean of a smooth law between two points.

    Parameters
    ----------
    law : a tree.
    old, new : what its variables are before and after; they move together along a line.
    """
    if old.keys().isdisjoint(names(law)):
        return law
    if is_affine(law, old.keys()):
        return replace(law, {name: _middle(old[name], new[name]) for name in old})

    def part(inner: Expr) -> Expr:
        return mean(inner, old, new)

    match law:
        case Neg(arg):
            return neg(part(arg))
        case Add(terms):
            return add(*map(part, terms))
        case Mul(left, right) if old.keys().isdisjoint(names(left)):
            return mul(left, part(right))
        case Mul(left, right) if old.keys().isdisjoint(names(right)):
            return mul(part(left), right)
        case Div(left, right) if old.keys().isdisjoint(names(right)):
            return div(part(left), right)
        case Call("exp", (arg,)) if is_affine(arg, old.keys()):
            return mul(replace(law, old), Call("phi1", (_moved(arg, old, new),)))
        case Pow(base, exponent) if _is_monomial(exponent) and is_affine(base, old.keys()):
            return _monomial(replace(base, old), replace(base, new), exponent.numerator)
    return _quadrature(law, old, new)


def lead(law: Expr, letter: str, old: Expr, new: Expr) -> Expr:
    """Return ``(E(new) - mean of E)/(new - old)``, the mean of s E'(old + s*(new - old)).

    Where E' >= 0 every term of it is >= 0, so that rounding cannot change its sign.

    Parameters
    ----------
    law : a smooth law E.
    letter, old, new : its variable, and what that is before and after.
    """
    slope = derivative(law, letter)
    if letter not in names(slope):
        return mul(HALF, slope)
    moved = add(new, neg(old))
    terms = []
    for share, weight in _nodes():
        there = add(old, mul(share, moved))
        terms.append(mul(mul(weight, share), replace(slope, {letter: there})))
    return add(*terms)


def mean_excess(
    old_value: Expr, cold: Expr, arg: Expr, old: Mapping[str, Expr], new: Mapping[str, Expr]
) -> Expr:
    """Return the mean of ``cold*(exp(arg) - 1)``, whose old value is given, without cancellation.

    It is ``old_value*phi1(d) + cold*d*phi2(d)``, d the change of `arg`, phi2 = (phi1 - 1)/d.
    """
    moved = _moved(arg, old, new)
    return add(
        mul(old_value, Call("phi1", (moved,))),
        mul(mul(cold, moved), Call("phi2", (moved,))),
    )


def exponent(value: Expr) -> Expr:
    """Return the argument of the exponential in ``T_0*expm1(S/c_0)``."""
    match value:
        case Mul(_, Call("expm1", (arg,))):
            return arg
    msg = "an excess is a constant times an exponential less one"
    raise TypeError(msg)


def mean_across_kinks(law: Expr, letter: str, old: Expr, new: Expr) -> Expr | None:
    """Return the mean of a law with kinks whose integral is known, or None for other laws.

    Parameters
    ----------
    law : sums of the letter, and of functions with kinks and tanh of it, times factors free of it.
    old, new : the letter's values before and after.
    """
    if letter not in names(law):
        return law
    if is_affine(law, {letter}):
        return replace(law, {letter: _middle(old, new)})
    ends = [lambda node: replace(node, {letter: old}), lambda node: replace(node, {letter: new})]

    def part(inner: Expr) -> Expr | None:
        return mean_across_kinks(inner, letter, old, new)

    match law:
        case Neg(arg):
            inner = part(arg)
            return None if inner is None else neg(inner)
        case Add(terms):
            parts = [known for term in terms if (known := part(term)) is not None]
            return add(*parts) if len(parts) == len(terms) else None
        case Mul(left, right) if letter not in names(left):
            inner = part(right)
            return None if inner is None else mul(left, inner)
        case Mul(left, right) if letter not in names(right):
            inner = part(left)
            return None if inner is None else mul(inner, right)
        case Div(left, right) if letter not in names(right):
            inner = part(left)
            return None if inner is None else div(inner, right)
        case Call(function, args) if all(is_affine(arg, {letter}) for arg in args):
            return _mean_of_kink(function, args, *ends)
    return None


End = Callable[[Expr], Expr]


def _mean_of_kink(function: str, args: tuple[Expr, ...], old: End, new: End) -> Expr | None:
    """Return the mean of a function with kinks, or of tanh; of some by means of max(x, 0)."""

    def ramp(arg: Expr) -> Expr:
        return Call("ramp", (old(arg), new(arg)))

    z, w = args[0], args[-1]
    middle = _middle(old(z), new(z))
    over, under = ramp(add(z, neg(w))), ramp(neg(add(z, w)))
    beyond = add(over, neg(under))
    if old(w) == new(w):
        beyond = Call("mean_deadzone", (old(z), new(z), w))
    match function:
        case "abs":
            return add(ramp(z), ramp(neg(z)))
        case "sign":
            return Call("mean_sign", (old(z), new(z)))
        case "tanh":
            return Call("mean_tanh", (old(z), new(z)))
        case "max":
            return add(_middle(old(w), new(w)), over)
        case "min":
            return add(middle, neg(over))
        case "deadzone":
            return beyond
        case "saturate":
            return add(middle, neg(beyond))
    return None


def is_affine(law: Expr, variables: Iterable[str]) -> bool:
    """Return whether a law is affine in some variables together."""
    known = set(variables)
    slopes = [derivative(law, name) for name in known]
    return all(known.isdisjoint(names(slope)) for slope in slopes)


def _middle(old: Expr, new: Expr) -> Expr:
    return old if old == new else mul(HALF, add(old, new))


def _moved(arg: Expr, old: Mapping[str, Expr], new: Mapping[str, Expr]) -> Expr:
    """Return the change of an affine law: slopes times the changes of its variables."""
    changes = [mul(derivative(arg, name), add(new[name], neg(old[name]))) for name in old]
    return add(*changes)


def _is_monomial(exponent: Fraction) -> bool:
    return exponent.denominator == 1 and 2 <= exponent <= 9


def _monomial(old: Expr, new: Expr, n: int) -> Expr:
    terms = [mul(power(old, Fraction(i)), power(new, Fraction(n - i))) for i in range(n + 1)]
    return div(add(*terms), Num(Fraction(n + 1)))


def _quadrature(law: Expr, old: Mapping[str, Expr], new: Mapping[str, Expr]) -> Expr:
    terms = []
    for share, weight in _nodes():
        at = {n: add(old[n], mul(share, add(new[n], neg(old[n])))) for n in old}
        terms.append(mul(weight, replace(law, at)))
    return add(*terms)


def _nodes() -> Iterator[tuple[Num, Num]]:
    """Yield the nodes and weights of Gauss's rule on [0, 1]."""
    for node, weight in GAUSS:
        for sign in (-1, 1):
            yield Num((1 + sign * node) / 2), Num(weight / 2)
