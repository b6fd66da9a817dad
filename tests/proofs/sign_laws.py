"""Laws for tests of signs: random ones, and their values by mpmath, not by the package."""

import operator
from fractions import Fraction

import mpmath
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st

from piezo_sym.expressions.functions import FUNCTIONS
from piezo_sym.expressions.parse import parse_law
from piezo_sym.expressions.tree import Add, Call, Cmp, Div, If, Mul, Neg, Num, Pow, Sym

steady = settings(
    deadline=None,
    derandomize=True,
    database=None,
    max_examples=50,
    suppress_health_check=[HealthCheck.filter_too_much, HealthCheck.too_slow],
)

X = Sym("x")
COMPARE = {"<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge}


def law(text):
    return parse_law(text, "test")


def numbers():
    return st.builds(Fraction, st.integers(-9, 9), st.sampled_from([1, 2, 3, 10]))


def laws(leaves=7):
    """Return a strategy for trees in x, kinks and jumps included."""

    def grown(part):
        one = st.sampled_from([name for name, r in FUNCTIONS.items() if len(r.slopes) == 1])
        two = st.sampled_from(["min", "max", "deadzone", "saturate"])
        exponents = st.sampled_from([Fraction(e) for e in (2, 3, -1, Fraction(1, 2))])
        condition = st.builds(Cmp, st.sampled_from(sorted(COMPARE)), part, part)
        return st.one_of(
            st.builds(Neg, part),
            st.lists(part, min_size=2, max_size=3).map(lambda terms: Add(tuple(terms))),
            st.builds(Mul, part, part),
            st.builds(Div, part, part),
            st.builds(Pow, part, exponents),
            st.builds(lambda f, a: Call(f, (a,)), one, part),
            st.builds(lambda f, a, b: Call(f, (a, b)), two, part, part),
            st.builds(If, part, condition, part),
        )

    return st.recursive(st.just(X) | numbers().map(Num), grown, max_leaves=leaves)


def precise(tree, x, digits=40):
    """Return the value of a tree of one name, or None where it has none."""
    with mpmath.workdps(digits):
        try:
            exact = isinstance(x, Fraction)
            value = _value(tree, mpmath.mpf(x.numerator) / x.denominator if exact else x)
        except (ArithmeticError, ValueError):
            return None
        return value if mpmath.isfinite(value) else None


def _value(tree, x):
    match tree:
        case Num(value):
            return mpmath.mpf(value.numerator) / value.denominator
        case Sym():
            return x
        case Neg(arg):
            return -_value(arg, x)
        case Add(terms):
            return mpmath.fsum(_value(term, x) for term in terms)
        case Mul(left, right):
            return _value(left, x) * _value(right, x)
        case Div(left, right):
            return _value(left, x) / _value(right, x)
        case Pow(base, exponent):
            return _power(_value(base, x), exponent)
        case Call(function, args):
            return _call(function, *(_value(arg, x) for arg in args))
        case If(then, Cmp(op, left, right), other):
            return _value(then if COMPARE[op](_value(left, x), _value(right, x)) else other, x)
    raise TypeError(tree)


def _power(base, exponent):
    if exponent.denominator == 1:
        return base**exponent.numerator
    if base < 0 or (base == 0 and exponent < 0):
        raise ValueError(base)
    return base ** (mpmath.mpf(exponent.numerator) / exponent.denominator)


def _call(function, z, w=None):
    if (function == "log" and z <= 0) or (function == "sqrt" and z < 0):
        raise ValueError(z)
    if function == "exp" and z > 1e6:
        raise ValueError(z)
    choices = {
        "abs": abs,
        "sign": mpmath.sign,
        "min": lambda z: min(z, w),
        "max": lambda z: max(z, w),
        "deadzone": lambda z: max(z - w, 0) + min(z + w, 0),
        "saturate": lambda z: min(max(z, -w), w),
    }
    return choices.get(function, getattr(mpmath, function, None))(z)
