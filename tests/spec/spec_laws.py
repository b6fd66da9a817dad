"""Random laws, and their values found without the package's own evaluation."""

import math
import re
from fractions import Fraction

import mpmath
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st

from piezo_sym.expressions.functions import FUNCTIONS
from piezo_sym.expressions.tree import (
    Add,
    Call,
    Cmp,
    Div,
    If,
    Mul,
    Neg,
    Num,
    Pow,
    Sym,
    children,
    names,
    walk,
)

steady = settings(
    deadline=None,
    derandomize=True,
    database=None,
    suppress_health_check=[HealthCheck.filter_too_much, HealthCheck.too_slow],
)

SMOOTH = tuple(name for name, record in FUNCTIONS.items() if record.smooth)
KINKED = ("abs", "sign")
TWO = ("min", "max")
WIDE = ("deadzone", "saturate")
WIDTHS = (Sym("w"), Num(Fraction(1, 2)))
NUMBER = re.compile(r"(?<![A-Za-z_0-9.])(\d+\.?\d*(?:e[+-]?\d+)?)")

numbers = st.builds(
    lambda top, bottom: Num(Fraction(top, bottom)),
    st.integers(0, 999),
    st.sampled_from([1, 2, 4, 5, 10, 1000]),
)
symbols = st.sampled_from(["x", "y", "w"]).map(Sym)


def minus(tree):
    """Return minus a law as Python binds it: the sign belongs to the first factor."""
    if isinstance(tree, Mul | Div):
        return type(tree)(minus(tree.left), tree.right)
    return Neg(tree)


def laws(*, terms=4, kinks=True, exponents=(2, 3, -1, Fraction(1, 2), Fraction(-2, 3))):
    """Return a strategy for trees as the parser gives them."""

    def grown(part):
        signed = part | part.map(Neg)
        first = part.filter(lambda tree: not isinstance(tree, Add))
        powers = st.sampled_from([Fraction(e) for e in exponents])
        grown = [
            part.map(minus),
            st.builds(
                lambda a, b: Add((a, *b)), first, st.lists(signed, min_size=1, max_size=terms - 1)
            ),
            st.builds(Mul, part, part),
            st.builds(Div, part, part),
            st.builds(Pow, part, powers),
            st.builds(lambda f, a: Call(f, (a,)), st.sampled_from(SMOOTH), part),
        ]
        if kinks:
            conditions = st.builds(Cmp, st.sampled_from(["<", "<=", ">", ">="]), part, part)
            grown += [
                st.builds(lambda f, a: Call(f, (a,)), st.sampled_from(KINKED), part),
                st.builds(lambda f, a, b: Call(f, (a, b)), st.sampled_from(TWO), part, part),
                st.builds(
                    lambda f, a, b: Call(f, (a, b)),
                    st.sampled_from(WIDE),
                    part,
                    st.sampled_from(WIDTHS),
                ),
                st.builds(If, part, conditions, part),
            ]
        return st.one_of(grown)

    return st.recursive(numbers | symbols, grown, max_leaves=8).filter(_acceptable)


def _acceptable(tree):
    """Return whether the parser takes a tree: no constant part but numbers, nothing over zero."""
    nodes = list(walk(tree))
    composite = [n for n in nodes if not isinstance(n, Num | Sym | Cmp) and not _constant(n)]
    divisors = [n.right for n in nodes if isinstance(n, Div)]
    return (
        all(names(n) for n in composite)
        and not any(_is_zero(d) for d in divisors)
        and _degree(tree) <= 32
        and _branches(tree) <= 18
    )


def _branches(node):
    """Return how many branches a law has at most, as one choice of all that it chooses."""
    inner = math.prod(_branches(part) for part in children(node))
    own = {**dict.fromkeys(TWO, 2), **dict.fromkeys(WIDE, 3), "abs": 2, "sign": 3}
    return inner * (2 if isinstance(node, Cmp) else own.get(getattr(node, "function", ""), 1))


def _constant(node):
    return isinstance(node, Num) or (isinstance(node, Neg) and isinstance(node.arg, Num))


def _is_zero(node):
    return (node.arg if isinstance(node, Neg) else node) == Num(Fraction(0))


def _degree(node):
    parts = [_degree(part) for part in children(node)]
    match node:
        case Mul() | Div():
            return sum(parts)
        case Pow(_, exponent):
            return parts[0] * max(abs(exponent), 1)
        case Sym():
            return 1
    return max(parts, default=0)


def _real(function, lowest, highest=math.inf):
    def guarded(z):
        if not lowest <= z <= highest:
            raise ValueError(z)
        return function(z)

    return guarded


def _sign(z):
    return 0 if z == 0 else z / abs(z)


def namespace(lib, real):
    """Return what a law's text may use, by the definitions of the language."""
    return {
        "__builtins__": {},
        **{name: getattr(lib, name) for name in SMOOTH},
        "exp": _real(lib.exp, -math.inf, 30 if lib is mpmath else 1e9),
        "log": lib.log if lib is math else _real(lib.log, mpmath.mpf("1e-60")),
        "sqrt": lib.sqrt if lib is math else _real(lib.sqrt, 0),
        "sinh": _real(lib.sinh, *((-30, 30) if lib is mpmath else (-1e9, 1e9))),
        "cosh": _real(lib.cosh, *((-30, 30) if lib is mpmath else (-1e9, 1e9))),
        "abs": abs,
        "sign": _sign,
        "min": lambda a, b: a if a <= b else b,
        "max": lambda a, b: a if a >= b else b,
        "deadzone": lambda z, w: max(z - w, real(0)) + min(z + w, real(0)),
        "saturate": lambda z, w: min(max(z, -w), w),
    }


def python_value(text, values):
    """Return the value that Python's own arithmetic gives the text of a law."""
    return float(eval(text, namespace(math, float), dict(values)))


def precise(text, values):
    """Return the value of a law's text to 80 digits, with every number in it exact."""
    exact = NUMBER.sub(r"real('\1')", text)
    with mpmath.workdps(80):
        scope = {name: mpmath.mpf(value) for name, value in values.items()}
        own = {"real": mpmath.mpf, "abs": lambda z: abs(mpmath.mpf(z))}  # of a root below 0: none
        return mpmath.mpf(eval(exact, namespace(mpmath, mpmath.mpf) | own, scope))
