"""The condition for [domain] under which a refuted law takes power in.

Input: the law of a refuted row.  Output: the condition, or None.  A law c*f, where f takes
power in, does so where c >= 0; factors of c that the domain keeps from being negative are left out.
"""

from collections.abc import Callable, Iterator
from functools import reduce

from piezo_sym.errors import STICKING
from piezo_sym.expressions.calculus import mul
from piezo_sym.expressions.tidying import tidied
from piezo_sym.expressions.tree import ONE, ZERO, Call, Cmp, Div, Expr, Mul, Neg, Pow, names
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
#: Functions that are positive wherever they have a value.
ABOVE = frozenset({"exp", "cosh"})


def mending(law: Expr, letter: str, shown: Shown) -> Cmp | None:
    """Return the condition under which a law has the sign of its letter; None if none is found.

    A conductance has the letter '' and must be >= 0.
    """
    slope = slope_of(law, letter) if letter else None
    factors = list(_factors(law if slope is None else slope))
    rest = [f for f in factors if letter and letter in names(f)]
    if letter and slope is None and not (rest and shown(reduce(mul, rest), letter)):
        return None
    kept = [f for f in factors if f not in rest and not shown(f, "")]
    return Cmp(">=", reduce(mul, kept), ZERO) if any(map(names, kept)) else None


def without_factors(claim: Cmp, positive: Callable[[Expr], bool]) -> Cmp:
    """Return a claim on the sign of a product as one on those factors that are not positive."""
    if claim.op not in {">", ">=", "!="} or claim.right != ZERO:
        return claim
    factors = (f for f in _factors(claim.left) if not (isinstance(f, Call) and f.function in ABOVE))
    kept = [f for f in factors if not positive(f)] or [claim.left]
    return Cmp(claim.op, tidied(reduce(mul, kept)), ZERO)


def at_root(claim: Cmp) -> Cmp:
    """Return a claim that an even power is positive, or not zero, as one that its base is not."""
    match claim:
        case Cmp(">" | "!=", Pow(base, exponent), right) if right == ZERO and exponent % 2 == 0:
            return Cmp("!=", base, ZERO)
    return claim


def _factors(law: Expr) -> Iterator[Expr]:
    """Yield factors whose product has the sign of a law."""
    match law:
        case Mul(left, right) | Div(left, right):
            yield from (*_factors(left), *_factors(right))
        case Neg(arg):
            yield from (Neg(ONE), *_factors(arg))
        case _:
            yield law
