"""Whether a function of one real variable is nowhere negative: proved, refuted, or open.

Input: a tree in one name and a domain.  Output: a `Decision`.  The domain is cut at zero and at its
ends; from each of these points c, rays x = c + t and x = c - t, t > 0, are cut into windows until
an enclosure shows f >= 0 on each, a window to infinity among them.  Near a zero of f at c the jets
there are exact: that is Taylor's theorem.  Work is counted in derivatives on windows, not in
seconds: the same law gives the same decision everywhere.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import final

from piezo_sym.expressions.tree import Expr, LaneSum, names, walk
from piezo_sym.proofs.report import Verdict
from piezo_sym.proofs.signs.certificate import Windows
from piezo_sym.proofs.signs.enclosures import Window, enclose, value
from piezo_sym.proofs.signs.intervals import INF
from piezo_sym.proofs.signs.shift import recentred

#: Derivatives on windows that are looked at before a decision is left open.
BUDGET = 1000
#: Orders of derivatives tried on each window, and those tried at both ends of a ray.
ORDERS, MORE_ORDERS = (0, 2), (0, 2, 8)
#: Below the first and beyond the second of these t, more orders are tried.
NEAR, FAR = 2.0**-4, 8.0
#: A window narrower than this times its distance (or 1) is not cut further.
NARROWEST = 2.0**-16
#: Windows that could not be decided before the search stops.
MOST_UNDECIDED = 3
#: Beyond this no window is cut off from one to infinity.
FARTHEST = 2.0**20
#: Windows tried on each side of a point where f touches zero.
MOST_BESIDE = 12


@final
@dataclass(frozen=True, slots=True)
class Decision:
    """What was found: for REFUTED where f is negative, for OPEN why, for PROVED the windows."""

    verdict: Verdict
    witness: Fraction | None = None
    reason: str = ""
    rays: tuple[Windows, ...] = ()


@final
@dataclass(frozen=True, slots=True)
class Span:
    """The reals between two ends; None is an end at infinity."""

    lo: Fraction | None = None
    hi: Fraction | None = None
    lo_included: bool = True
    hi_included: bool = True

    def __post_init__(self) -> None:
        """Refuse ends in the wrong order."""
        if self.lo is not None and self.hi is not None and self.lo > self.hi:
            raise ValueError(f"no number lies from {self.lo} to {self.hi}")

    def __contains__(self, x: Fraction) -> bool:
        """Return whether a number is in the domain."""
        above = self.lo is None or x > self.lo or (x == self.lo and self.lo_included)
        below = self.hi is None or x < self.hi or (x == self.hi and self.hi_included)
        return above and below


REALS = Span()


@final
@dataclass(frozen=True, slots=True)
class Ray:
    """The points centre + side*t, 0 < t <= length; `tree` is f as a function of t."""

    tree: Expr
    centre: Fraction
    side: int
    length: float

    def point(self, t: Fraction) -> Fraction:
        """Return the x of a t."""
        return self.centre + self.side * t


def decide_sign(f: Expr, name: str, domain: Span = REALS, budget: int = BUDGET) -> Decision:
    """Return whether f is defined and f >= 0 for every value of `name` in the domain.

    Parameters
    ----------
    f : a tree whose only name is `name`.
    budget : derivatives on windows to look at.

    Returns
    -------
    Decision
        PROVED is a theorem.  REFUTED gives a rational number in the domain at which f < 0.
    """
    if others := [other for other in names(f) if other != name]:
        return Decision(Verdict.OPEN, reason=f"depends on {', '.join(others)} too")
    if any(isinstance(node, LaneSum) for node in walk(f)):
        return Decision(Verdict.OPEN, reason="sums over lanes")
    try:
        return _at_points(f, domain) or _on_rays(f, name, domain, budget)
    except (ArithmeticError, RecursionError) as error:
        return Decision(Verdict.OPEN, reason=f"has no bounds: {error}")


def _at_points(f: Expr, domain: Span) -> Decision | None:
    """Return a refutation by a simple number, or that f may have no value at one of them."""
    gaps = []
    for x in (x for x in _simple_numbers(domain) if x in domain):
        found = value(f, x)
        if found is None:
            gaps.append(x)
        elif found.hi < 0:
            return Decision(Verdict.REFUTED, x)
    if gaps:
        return Decision(Verdict.OPEN, reason=f"has no value at {gaps[0]}, as far as is known")
    return None


def _simple_numbers(domain: Span) -> Iterator[Fraction]:
    """Yield numbers of few digits, most of them near zero or near an end of the domain."""
    steps = [Fraction(n, 2) for n in range(2, 21)]
    steps += [Fraction(10) ** n for n in range(2, 7)]
    steps += [Fraction(1, 2), *(Fraction(1, 10) ** n for n in range(1, 4))]
    for start in dict.fromkeys((Fraction(0), domain.lo, domain.hi)):
        if start is not None:
            yield from (start, *(start + side * step for step in steps for side in (1, -1)))


def _on_rays(f: Expr, name: str, domain: Span, budget: int) -> Decision:
    """Cut the domain into rays and prove f >= 0 on each, and at the points where they start."""
    reasons: list[str] = []
    shown: list[Windows] = []
    left = budget
    for point in (point for point in _starts(domain) if point in domain):
        found = value(f, point)
        if found is None or found.lo < 0:
            reasons.append(f"is not told from zero at {name} = {point}")
    for ray in _rays(f, domain):
        decision, left = _search(f, name, ray, left)
        if decision.verdict is Verdict.REFUTED:
            return decision
        reasons += [decision.reason] if decision.verdict is Verdict.OPEN else []
        shown += decision.rays
    if reasons:
        return Decision(Verdict.OPEN, reason=reasons[0])
    return Decision(Verdict.PROVED, rays=tuple(shown))


def _starts(domain: Span) -> list[Fraction]:
    """Return the points where rays start: the finite ends, and zero if it is inside."""
    points = {end for end in (domain.lo, domain.hi) if end is not None}
    return sorted(points | ({Fraction(0)} if Fraction(0) in domain else set()))


def _rays(f: Expr, domain: Span) -> Iterator[Ray]:
    """Yield rays that cover the domain, its starting points aside."""
    points = _starts(domain)
    if domain.lo is None:
        yield _ray(f, points[0], -1, INF)
    for a, b in pairwise(points):
        half = _not_below((b - a) / 2)
        yield _ray(f, a, 1, half)
        yield _ray(f, b, -1, half)
    if domain.hi is None:
        yield _ray(f, points[-1], 1, INF)


def _ray(f: Expr, centre: Fraction, side: int, length: float) -> Ray:
    return Ray(recentred(f, centre, side), centre, side, length)


def _not_below(x: Fraction) -> float:
    near = float(x)
    return near if near >= x else math.nextafter(near, INF)


def _search(f: Expr, name: str, ray: Ray, budget: int) -> tuple[Decision, int]:
    """Return the decision on one ray and what is left of the budget."""
    pieces = [(0.0, ray.length)]
    undecided: list[str] = []
    shown: list[tuple[float, float, int]] = []
    others: list[Windows] = []
    while pieces and len(undecided) < MOST_UNDECIDED:
        if budget <= 0:
            return Decision(Verdict.OPEN, reason="needs more work than the budget allows"), 0
        a, b = pieces.pop()
        order, work = _order(ray.tree, a, b)
        budget -= work
        if order is not None:
            shown.append((a, b, order))
            continue
        x = ray.point(_simplest(a, b))
        found = value(f, x)
        if found is not None and found.hi < 0:
            return Decision(Verdict.REFUTED, x), budget
        if not _narrow(a, b):
            middle = _middle(a, b)
            pieces += [(middle, b), (a, middle)]
        elif a > 0 and b < INF and (touching := _touching(f, ray, a, b)) is not None:
            others += touching
        else:
            undecided.append(f"is not told from zero near {name} = {float(x):.9g}")
    if undecided:
        return Decision(Verdict.OPEN, reason=undecided[0]), budget
    rays = (Windows(ray.centre, ray.side, tuple(shown)), *others)
    return Decision(Verdict.PROVED, rays=rays), budget


def _order(tree: Expr, a: float, b: float) -> tuple[int | None, int]:
    """Return how many derivatives show f >= 0 on a < t <= b, if any do, and how many were tried."""
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


def _touching(f: Expr, ray: Ray, a: float, b: float) -> tuple[Windows, ...] | None:
    """Return how f >= 0 is shown from the simplest number in a <= t <= b to both sides, or None.

    Where f touches zero at that number, the jets there are exact.
    """
    middle = ray.point(_simplest(a, b))
    found = value(f, middle)
    if found is None or found.lo < 0:
        return None
    ends = sorted((ray.point(Fraction(a)), ray.point(Fraction(b))))
    shown = [
        _beside(f, middle, side, _not_below(abs(end - middle)))
        for side, end in ((-1, ends[0]), (1, ends[1]))
        if end != middle
    ]
    both = tuple(windows for windows in shown if windows is not None)
    return both if len(both) == len(shown) else None


def _beside(f: Expr, centre: Fraction, side: int, length: float) -> Windows | None:
    """Return how f >= 0 is shown on 0 < t <= length, after a few cuts at most, or None."""
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
    """Return the number of smallest denominator in [a, b]; next to infinity, a whole number."""
    if b == INF:
        return Fraction(math.floor(a) + 1)
    return _between(Fraction(a), Fraction(b))


def _between(a: Fraction, b: Fraction) -> Fraction:
    """Return the simplest fraction of [a, b], 0 <= a, by the continued fraction of its ends."""
    whole = Fraction(math.ceil(a))
    if whole <= b:
        return whole
    below = Fraction(math.floor(a))
    return below + 1 / _between(1 / (b - below), 1 / (a - below))
