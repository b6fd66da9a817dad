"""Counterexamples: points of the domain at which a claim certainly fails.

Input: a claim and the points of its spec.  Output: an exact point, or None.  Floats search, at the
edges of the law and by descent; exact arithmetic decides.
"""

import numpy as np

from tests.search.laws import edges, names
from tests.search.points import Points, bisected, certain, filled, joined, onto
from tests.search.reading import moving, total
from tests.search.values import DoubtError, NoValueError, exact, floats, rational, sign

MOST = 4
#: How many points a descent keeps, copies of each it moves, and by how much.
KEPT, COPIES, WIDTHS = 16, 5, (1, 0.3, 0.1, 0.02, 1e-3, 1e-5)
#: How near two points are at which a law may jump; the law's own scales are far above.
NEAR = tuple(rational(1) / 2**n for n in (100, 200))
GAPS = (2.0**-42, 2.0**-30, 2.0**-18)


def counterexample(claim, points):
    """Return a point at which a claim certainly fails, or None."""
    if not points.count:
        return None
    with np.errstate(all="ignore"):
        return SEARCHES[claim.id](claim, points)


def fails(claim, point, spec):
    """Return whether a claim certainly fails at an exact point of the domain."""
    warm = claim.id != "temperature"
    spec = total(spec) if claim.id == "domain" else spec
    return certain(point, spec, warm) and FAILS[claim.id](claim, point, spec)


def _edge_points(claim, points):
    """Return the points of the domain, and more where the laws bend, jump or end."""
    kinds = [edge for tree in claim.trees for _, edge in edges(tree)]
    letter = [claim.letter] if claim.letter and names(claim.letter) else []
    found = [points.near(edge) for edge in list(dict.fromkeys([*kinds, *letter]))[:10]]
    return joined([points.values, *found])


def _descended(objective, at, points, names):
    """Return points at which an objective is small: the best ones, moved by smaller steps."""
    found, best = [], _best(objective, at, KEPT)
    for width in WIDTHS:
        tried = {n: np.repeat(v, COPIES) for n, v in best.items()}
        best = _best(objective, joined([best, points.around(tried, width, names)]), KEPT)
        found.append(best)
    return joined(found)


def _best(objective, at, most):
    value = np.broadcast_to(objective(at), at[next(iter(at))].shape)
    order = np.argsort(np.where(np.isfinite(value), value, np.inf), kind="stable")[:most]
    return {name: v[order] for name, v in at.items()}


def _passive(claim, points):
    (law,), letter = claim.trees, claim.letter

    def power(at):
        return np.broadcast_to(floats(law, at) * floats(letter, at), at[points.spec.free[0]].shape)

    def slope(at):
        return floats(law, at) / floats(letter, at)

    at = _edge_points(claim, points)
    found, beside = _confirmed(claim, points, at, power(at)), points.beside(law, letter)
    for objective in (slope, power):
        if found is None:
            lower = _descended(objective, at, points, beside)
            found = _confirmed(claim, points, lower, power(lower))
    return found


def _confirmed(claim, points, at, value):
    """Return the first of the lowest points at which a claim fails exactly."""
    order = np.argsort(np.where(np.isfinite(value), value, np.inf), kind="stable")
    for n in [k for k in order[:MOST] if value[k] < 0]:
        point = points.exactly(n, at)
        if fails(claim, point, points.spec):
            return point
    return None


def _is_negative(claim, point, spec):
    try:
        at = filled(point, spec)
        return sign(exact(claim.trees[0], at)) * sign(exact(claim.letter, at)) < 0
    except (NoValueError, DoubtError):
        return False


def _welldef(claim, points):
    at = _edge_points(claim, points)
    found = None
    for law in claim.trees:
        found = found or _missing(claim, law, points, at)
        ends = [(kind, edge) for kind, edge in edges(law) if kind in {"end", "pole"}]
        for kind, end in dict.fromkeys(ends[:6]):
            if found is None:
                found = _ended(claim, law, (kind, end), points, at)
    return found


def _missing(claim, law, points, at):
    bad = np.flatnonzero(
        ~np.isfinite(np.broadcast_to(floats(law, at), at[points.spec.free[0]].shape))
    )
    for n in bad[:MOST]:
        point = points.exactly(n, at)
        if fails(claim, point, points.spec):
            return point
    return None


def _ended(claim, law, edge, points, at):
    """Return a point past the end of a root or logarithm, or on what a law divides by."""
    kind, end = edge
    near = np.abs if kind == "pole" else np.positive
    lower = _descended(lambda at: near(floats(end, at)), at, points, points.beside(end))
    size = np.abs(np.broadcast_to(floats(end, lower), lower[points.spec.free[0]].shape))
    for n in np.argsort(size, kind="stable")[:MOST]:
        point = onto(end, points.exactly(n, lower), points.spec) if size[n] < 1 else None
        if point is not None and fails(claim, point, points.spec):
            return point
    return _missing(claim, law, points, lower)


def _has_no_value(claim, point, spec):
    at = filled(point, spec)
    return any(not has_value(law, at) for law in claim.trees)


def has_value(law, at):
    """Return whether a law has a value, or may have."""
    try:
        exact(law, at)
    except NoValueError:
        return False
    except DoubtError:
        return True
    return True


def _continuous(claim, points):
    for law in claim.trees:
        jumping = [edge for kind, edge in edges(law) if kind == "jump"]
        for edge in dict.fromkeys(jumping[:8]):
            for name in points.free_names(edge):
                found = name in moving(points.spec) and _jump(law, edge, name, points)
                if found:
                    return found
    return None


def _jump(law, edge, name, points, most=48):
    """Return a point at an edge next to which a law jumps along a name."""
    pick = points.random.integers(0, points.count, most)
    at = {n: points.values[n][pick] for n in points.spec.free}
    root = points.root(edge, name, at, 8)
    scale = np.where(root == 0, 1, np.abs(root))
    gaps = []
    for gap in GAPS:
        sides = [points.whole({**at, name: root + side * gap * scale}) for side in (-1, 0, 1)]
        low, here, high = (floats(law, side) for side in sides)
        gaps.append(np.fmax(np.abs(high - low), np.fmax(np.abs(high - here), np.abs(here - low))))
    size = 1e-7 * (np.abs(low) + np.abs(high))
    bad = np.flatnonzero(np.broadcast_to((gaps[0] > 0.3 * gaps[1]) & (gaps[0] > size), most))
    for n in bad[:MOST]:
        point = {k: rational(float(v[n])) for k, v in {**at, name: root}.items()}
        reach = (abs(point[name]) or rational(1)) / 2**36
        ends = point[name] - reach, point[name] + reach
        point = onto(edge, point, points.spec, {name}) or bisected(
            edge, name, point, points.spec, ends
        )
        if point is not None and _leaps(law, point, points.spec, {name: 1}):
            return point
    return None


def _leaps(law, point, spec, way):
    """Return whether a law jumps at a point along a way, as far as two pairs of points tell."""
    gaps = []
    for near in NEAR:
        values = []
        for side in (-1, 0, 1):
            moved = {n: v + side * near * way.get(n, 0) * (abs(v) or 1) for n, v in point.items()}
            if certain(moved, spec):
                try:
                    values.append(exact(law, filled(moved, spec)))
                except NoValueError:
                    continue
                except DoubtError:
                    return False
        if len(values) < 2:
            return False
        gaps.append(max(abs(a - b) for a in values for b in values))
    return bool(gaps[0] > rational(2.0**-60)) and bool(gaps[1] * 10 > gaps[0] * 9)


def _jumps_at(claim, point, spec):
    """Return whether a law jumps at a point along some way that leaves parameters alone."""
    free = [name for name in moving(spec) if name in _depends(claim, spec)]
    ways = [{name: 1} for name in free]
    ways += [{a: 1, b: k} for a in free for b in free if a < b for k in (1, -1, 2, -2)]
    if _has_no_value(claim, point, spec):
        return True
    return any(_leaps(law, point, spec, way) for law in claim.trees for way in ways)


def _depends(claim, spec):
    found = set(names(*claim.trees))
    for name, law in reversed(spec.derived.items()):
        found |= set(names(law)) if name in found else set()
    return found


def _temperature(claim, points):
    (law,) = claim.trees
    state = next(n for n in points.free_names(law) if n in moving(points.spec))
    at = _edge_points(claim, points)

    def rise(at):
        step = 2.0**-20 * (1 + np.abs(at[state]))
        value = floats(law, points.whole({**at, state: at[state] + step})) - floats(law, at)
        return value / step

    for objective in (lambda at: floats(law, at), rise):
        for tried in (at, _descended(objective, at, points, points.beside(law))):
            found = _confirmed(claim, points, tried, objective(tried))
            if found:
                return found
    return None


def _is_cold(claim, point, spec):
    """Return whether a temperature is not positive at a point, or does not rise there."""
    (law,) = claim.trees
    try:
        at = filled(point, spec)
        if sign(exact(law, at)) <= 0:
            return True
        ways = [(n, side) for n in names(law) if n in moving(spec) for side in (-1, 1)]
        return any(_sinks(law, point, spec, name, side) for name, side in ways)
    except NoValueError:
        return True
    except DoubtError:
        return False


def _sinks(law, point, spec, name, side):
    """Return whether a law falls, or has no slope, from a point to one side."""
    rises = []
    for near in NEAR:
        step = side * near * (1 + abs(point[name]))
        moved = {**point, name: point[name] + step}
        if not certain(moved, spec, warm=False):
            return False
        rises.append((exact(law, filled(moved, spec)) - exact(law, filled(point, spec))) / step)
    return bool(rises[1] < 0) or bool(rises[1] * 2**20 < rises[0])


def _odd(claim, points):
    law = claim.trees[0]
    at = _edge_points(claim, points)
    size = np.abs(np.broadcast_to(floats(law, at), at[points.spec.free[0]].shape))
    return _confirmed(claim, points, at, -size)


def _is_not_odd(claim, point, spec):
    try:
        return sign(exact(claim.trees[0], filled(point, spec))) != 0
    except (NoValueError, DoubtError):
        return False


def _undefined(claim, points):
    wider = Points(total(points.spec), points.random)
    return _welldef(claim, wider) if claim.trees and wider.count else None


def _lacks(claim, point, spec):
    """Return whether a condition certainly has no value where those before it hold."""
    at = filled(point, spec)
    for condition in claim.trees:
        try:
            if not exact(condition, at):
                return False
        except NoValueError:
            return True
        except DoubtError:
            return False
    return False


SEARCHES = {
    "passive": _passive,
    "odd": _odd,
    "domain": _undefined,
    "welldef": _welldef,
    "continuous": _continuous,
    "temperature": _temperature,
}
FAILS = {
    "passive": _is_negative,
    "odd": _is_not_odd,
    "domain": _lacks,
    "welldef": _has_no_value,
    "continuous": _jumps_at,
    "temperature": _is_cold,
}
