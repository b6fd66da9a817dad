"""What mends a refuted law: the condition for [domain] under which it takes power in.

Input: the law of a refuted row.  Output: the condition, or None.  A law c*f, where f takes
power in, does so where c >= 0; factors of c that the domain keeps from being negative are left out.
For a law that jumps, what to write instead is the same for all: `JUMPS` and `MEETS`.
"""

from collections.abc import Callable, Iterator
from functools import reduce

from piezo_sym.errors import STICKING
from piezo_sym.expressions.calculus import mul
from piezo_sym.expressions.tree import ONE, ZERO, Cmp, Div, Expr, Mul, Neg, names
from piezo_sym.network import slope_of

#: What to write for a law that jumps, as the end of a reason.
JUMPS = f"; a law that jumps on purpose says discontinuous = true; {STICKING}"
#: What to write where no law may jump: stores, temperatures, conductances, ratios.
MEETS = (
    "; only a law of dissipation may jump: let the two branches have one value there, as "
    "'a if x < b else a + c*(x - b)' does at b"
)
#: Whether law*letter, or a law without letter, is shown to be >= 0 in the domain.
Shown = Callable[[Expr, str], bool]


def mending(law: Expr, letter: str, shown: Shown) -> Cmp | None:
    """Return the condition under which a law has the sign of its letter; None if none is found.

    A conductance has the letter '' and must be >= 0.
    """
    slope = slope_of(law, letter) if letter else None
    factors = list(sign_factors(law if slope is None else slope))
    rest = [f for f in factors if letter and letter in names(f)]
    if letter and slope is None and not (rest and shown(reduce(mul, rest), letter)):
        return None
    kept = [f for f in factors if f not in rest and not shown(f, "")]
    return Cmp(">=", reduce(mul, kept), ZERO) if any(map(names, kept)) else None


def sign_factors(law: Expr) -> Iterator[Expr]:
    """Yield factors whose product has the sign of a law."""
    match law:
        case Mul(left, right) | Div(left, right):
            yield from (*sign_factors(left), *sign_factors(right))
        case Neg(arg):
            yield from (Neg(ONE), *sign_factors(arg))
        case _:
            yield law
