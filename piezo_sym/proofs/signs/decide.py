"""Whether a function of one real variable is nowhere negative: proved, refuted, or open.

Input: a tree in one name.  Output: a `Decision`.  Both rays x = t and x = -t, t > 0, are cut into
windows, the last to infinity, until an enclosure shows f >= 0 on each.  Where f touches zero at a
number c, so are rays x = c + t and x = c - t: the jets at c are exact, as in Taylor's theorem.
Work is counted in derivatives on windows, not in seconds: the same decision on every machine.
"""

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import final

from piezo_sym.expressions.tree import Expr, LaneSum, names, walk
from piezo_sym.proofs.signs.certificate import Windows
from piezo_sym.proofs.signs.enclosures import Window, enclose, value
from piezo_sym.proofs.signs.intervals import INF
from piezo_sym.proofs.signs.shift import recentred
from piezo_sym.report import Verdict

#: Derivatives on windows that are evaluated before a decision is left open.
BUDGET = 1000
#: Orders of derivatives tried on each window, and those tried at both ends of a ray.
ORDERS, MORE_ORDERS = (0, 2), (0, 2, 8)
#: Below the first and beyond the second of these t, more orders are tried.
NEAR, FAR = 2.0**-4, 8.0
#: A window narrower than this times its distance (or 1) is not cut further.
NARROWEST = 2.0**-16
#: Undecided windows after which the search stops.
MOST_UNDECIDED = 3
#: A window from here to infinity is not cut further.
FARTHEST = 2.0**20
#: Windows tried on each side of a point where f touches zero.
MOST_BESIDE = 12
#: Distances from zero at which f is evaluated first.
STEPS = (
    *(Fraction(n, 2) for n in range(2, 21)),
    *(Fraction(10) ** n for n in range(2, 7)),
    *(Fraction(1, n) for n in (2, 10, 100, 1000)),
)
ZERO = Fraction(0)


@final
@dataclass(frozen=True, slots=True)
class Decision:
    """A verdict, with x where f < 0 if REFUTED, the reason if OPEN, and the windows if PROVED."""

    verdict: Verdict
    witness: Fraction | None = None
    reason: str = ""
    rays: tuple[Windows, ...] = ()


def decide_sign(f: Expr, name: str, budget: int = BUDGET) -> Decision:
    """Return the decision whether f is defined and f >= 0 for every real value of `name`.

    PROVED is a theorem; REFUTED has a rational number at which f < 0.  At most `budget` derivatives
    on windows are evaluated.
    """
    if others := [other for other in names(f) if other != name]:
        return Decision(Verdict.OPEN, reason=f"depends on {', '.join(others)} too")
    if any(isinstance(node, LaneSum) for node in walk(f)):
        return Decision(Verdict.OPEN, reason="sums over lanes")
    try:
        return _at_points(f) or _on_rays(f, name, budget)
    except (ArithmeticError, RecursionError) as error:
        return Decision(Verdict.OPEN, reason=f"has no bounds: {error}")


def _at_points(f: Expr) -> Decision | None:
    """Return REFUTED if f < 0 at a simple number, OPEN if f may have no value at one, else None."""
    gaps = []
    for x in (ZERO, *(side * step for step in STEPS for side in (1, -1))):
        found = value(f, x)
        if found is None:
            gaps.append(x)
        elif found.hi < 0:
            return Decision(Verdict.REFUTED, x)
    if gaps:
        return Decision(Verdict.OPEN, reason=f"has no value at {gaps[0]}, as far as is known")
    return None


def _on_rays(f: Expr, name: str, budget: int) -> Decision:
    """Return the decision on f >= 0 at zero and on both rays."""
    reasons: list[str] = []
    shown: list[Windows] = []
    at_zero = value(f, ZERO)
    if at_zero is None or at_zero.lo < 0:
        reasons.append(f"is not told from zero at {name} = 0")
    for side in (-1, 1):
        decision, budget = _search(f, name, side, budget)
        if decision.verdict is Verdict.REFUTED:
            return decision
        reasons += [decision.reason] if decision.verdict is Verdict.OPEN else []
        shown += decision.rays
    if reasons:
        return Decision(Verdict.OPEN, reason=reasons[0])
    return Decision(Verdict.PROVED, rays=tuple(shown))


def _not_below(x: Fraction) -> float:
    """Return a double >= x."""
    near = float(x)
    return near if near >= x else math.nextafter(near, INF)


def _search(f: Expr, name: str, side: int, budget: int) -> tuple[Decision, int]:
    """Return the decision on the ray x = side*t, t > 0, and the rest of the budget."""
    tree, pieces = recentred(f, ZERO, side), [(0.0, INF)]
    undecided: list[str] = []
    shown: list[tuple[float, float, int]] = []
    others: list[Windows] = []
    while pieces and len(undecided) < MOST_UNDECIDED:
        if budget <= 0:
            return Decision(Verdict.OPEN, reason="needs more work than the budget allows"), 0
        a, b = pieces.pop()
        order, work = _order(tree, a, b)
        budget -= work
        if order is not None:
            shown.append((a, b, order))
            continue
        x = side * _simplest(a, b)
        found = value(f, x)
        if found is not None and found.hi < 0:
            return Decision(Verdict.REFUTED, x), budget
        if not _narrow(a, b):
            middle = _middle(a, b)
            pieces += [(middle, b), (a, middle)]
        elif a > 0 and b < INF and (touching := _touching(f, side, a, b)) is not None:
            others += touching
        else:
            undecided.append(f"is not told from zero near {name} = {float(x):.9g}")
    if undecided:
        return Decision(Verdict.OPEN, reason=undecided[0]), budget
    rays = (Windows(ZERO, side, tuple(shown)), *others)
    return Decision(Verdict.PROVED, rays=rays), budget


def _order(tree: Expr, a: float, b: float) -> tuple[int | None, int]:
    """Return the number of derivatives that show f >= 0 on a < t <= b, or None, and the work."""
    at_an_end = (a == 0 and b <= NEAR) or (a >= FAR and b == INF)
    work = 0
    for order in MORE_ORDERS if at_an_end else ORDERS:
        work += order + 1
        found = enclose(tree, Window(a, b, order)).inner
        if found and found[0].lo >= 0:
            return order, work
    return None, work


def _narrow(a: float, b: float) -> bool:
    return a >= FARTHEST if b == INF else b - a <= NARROWEST * max(1.0, b)


def _middle(a: float, b: float) -> float:
    return max(1.0, 2 * a) if b == INF else a + (b - a) / 2


def _touching(f: Expr, side: int, a: float, b: float) -> tuple[Windows, ...] | None:
    """Return windows that show f >= 0 on both sides of the simplest number in [a, b], or None."""
    middle = side * _simplest(a, b)
    found = value(f, middle)
    if found is None or found.lo < 0:
        return None
    ends = sorted((side * Fraction(a), side * Fraction(b)))
    shown = [
        _beside(f, middle, way, _not_below(abs(end - middle)))
        for way, end in ((-1, ends[0]), (1, ends[1]))
        if end != middle
    ]
    both = tuple(windows for windows in shown if windows is not None)
    return both if len(both) == len(shown) else None


def _beside(f: Expr, centre: Fraction, side: int, length: float) -> Windows | None:
    """Return windows that show f >= 0 on 0 < t <= length, after a few cuts at most, or None."""
    tree = recentred(f, centre, side)
    pieces = [(0.0, length)]
    shown: list[tuple[float, float, int]] = []
    for _ in range(MOST_BESIDE):
        a, b = pieces.pop()
        order, _ = _order(tree, a, b)
        if order is None:
            pieces += [(_middle(a, b), b), (a, _middle(a, b))]
        else:
            shown.append((a, b, order))
        if not pieces:
            return Windows(centre, side, tuple(shown))
    return None


def _simplest(a: float, b: float) -> Fraction:
    """Return the number of smallest denominator in [a, b], an integer if b is infinite."""
    if b == INF:
        return Fraction(math.floor(a) + 1)
    return _between(Fraction(a), Fraction(b))


def _between(a: Fraction, b: Fraction) -> Fraction:
    """Return the simplest fraction in [a, b], 0 <= a, by the continued fraction of its ends."""
    integer = Fraction(math.ceil(a))
    if integer <= b:
        return integer
    below = Fraction(math.floor(a))
    return below + 1 / _between(1 / (b - below), 1 / (a - below))
