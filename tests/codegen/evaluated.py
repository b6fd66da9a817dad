"""Steps evaluated by Python, term by term: the meaning of the program, without any printer."""

import math

import numpy as np

from piezo_sym.expressions.tree import (
    COMPARISONS,
    Add,
    Call,
    Div,
    If,
    LaneSum,
    Mul,
    Neg,
    Num,
    Pow,
    Sym,
)


def phi(n, d):
    """Return phi_n: the series where it converges fast, else phi_n = (phi_(n-1) - 1/(n-1)!)/d."""
    if abs(d) < 1:
        return sum(d**k / math.factorial(k + n) for k in range(25))
    return math.exp(d) if n == 0 else (phi(n - 1, d) - 1 / math.factorial(n - 1)) / d


@np.vectorize
def ramp(a, b):
    """Return the mean of max(s, 0) for s from a to b."""
    if a >= 0 and b >= 0:
        return (a + b) / 2
    return 0.0 if a <= 0 and b <= 0 else max(a, b) ** 2 / (2 * abs(b - a))


@np.vectorize
def ramp_by_new(a, b):
    if a >= 0 and b >= 0:
        return 0.5
    if a <= 0 and b <= 0:
        return 0.0
    width = abs(b - a)
    return b / width - b**2 / (2 * width**2) if b > 0 else a**2 / (2 * width**2)


def mean_deadzone(a, b, w):
    return ramp(a - w, b - w) - ramp(-a - w, -b - w)


def mean_deadzone_by_new(a, b, w):
    return ramp_by_new(a - w, b - w) + ramp_by_new(-a - w, -b - w)


@np.vectorize
def mean_deadzone_by_width(a, b, w):
    """Return how much of 10^4 points on the way lies below the zone, less that above."""
    way = a + (np.arange(10_000) + 0.5) / 10_000 * (b - a)
    return float(np.mean(way < -w) - np.mean(way > w))


@np.vectorize
def mean_sign(a, b):
    return float(np.sign(a)) if a * b > 0 or a == b else (abs(b) - abs(a)) / (b - a)


@np.vectorize
def mean_tanh(a, b):
    """Return the mean of tanh(s) for s from a to b, by its integral, or nearly so."""
    if abs(b - a) < 1e-4:
        return np.tanh((a + b) / 2)
    ends = [abs(s) + np.log1p(np.exp(-2 * abs(s))) for s in (a, b)]
    return (ends[1] - ends[0]) / (b - a)


CALLS = {
    "exp": np.exp,
    "expm1": np.expm1,
    "log": np.log,
    "sin": np.sin,
    "cos": np.cos,
    "tanh": np.tanh,
    "atan": np.arctan,
    "sinh": np.sinh,
    "cosh": np.cosh,
    "erf": np.vectorize(math.erf),
    "sqrt": np.sqrt,
    "abs": np.abs,
    "sign": np.sign,
    "min": np.minimum,
    "max": np.maximum,
    "deadzone": lambda z, w: z - np.clip(z, -w, w),
    "saturate": lambda z, w: np.clip(z, -w, w),
    "phi1": np.vectorize(lambda d: phi(1, d)),
    "phi2": np.vectorize(lambda d: phi(2, d)),
    "phi3": np.vectorize(lambda d: phi(3, d)),
    "ramp": ramp,
    "ramp_by_new": ramp_by_new,
    "mean_deadzone": mean_deadzone,
    "mean_deadzone_by_new": mean_deadzone_by_new,
    "mean_deadzone_by_width": mean_deadzone_by_width,
    "mean_sign": mean_sign,
    "mean_sign_by_new": lambda old, new: 0 * (old + new),  # Newton's matrix may be rough
    "mean_tanh": mean_tanh,
    "mean_tanh_by_new": lambda old, new: (1 - np.tanh((old + new) / 2) ** 2) / 2,
}


def value(node, at):
    match node:
        case Num(number):
            return float(number)
        case Sym(name):
            return at[name]
        case Neg(arg):
            return -value(arg, at)
        case Add(terms):
            return sum(value(term, at) for term in terms)
        case Mul(left, right):
            return value(left, at) * value(right, at)
        case Div(left, right):
            return value(left, at) / value(right, at)
        case Pow(base, exponent):
            return value(base, at) ** float(exponent)
        case Call(function, args):
            return CALLS[function](*(value(arg, at) for arg in args))
        case If(then, condition, other):
            test = COMPARISONS[condition.op](value(condition.left, at), value(condition.right, at))
            return np.where(test, value(then, at), value(other, at))
        case LaneSum(arg, _):
            return np.sum(value(arg, at))
    raise TypeError(node)


def newton(step, names, lanes, x, u, h, constants, iterations=8):
    """Return the state after a step, and the values of all quantities there.

    Parameters
    ----------
    names : the states; `lanes` : for each, whether it is an array of lanes.
    x : a value or array a state.
    """
    new = list(x)
    for _ in range(iterations):
        at = {**constants, **u, step.h: h, **dict(zip(names, x, strict=True))}
        at |= dict(zip(step.after, new, strict=True))
        for quantity in step.quantities:
            found = value(quantity.value, at)
            at[quantity.name] = found + np.zeros(lanes[quantity.bank]) if quantity.bank else found
        for state, change in enumerate(step.changes):
            reactions = sum(
                at[value.name] * at[unknown.name] for value, unknown in change.reactions
            )
            new[state] = new[state] - (value(change.free, at) - reactions)
    return new, at
