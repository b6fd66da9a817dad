"""Points inside a domain that a person would not think of.

Input: a `Spec`.  Output: arrays, one per variable, all inside as far as floats tell; and exact
points, of which it is certain.  Points come from the spec's own values, simple numbers, sizes from
1e-12 to 1e12 and equal names, are moved to the edges of the domain and to both sides of them, and
near what a law's edges ask for.
"""

import numpy as np

from tests.search.laws import names
from tests.search.values import DoubtError, NoValueError, exact, floats, rational, sign

SIMPLE = np.array([0, 1, -1, 2, -2, 3, -3, 0.5, -0.5, 4, -4, 0.25, 8, -8, 10, 100, -100])
NUDGES = np.array([0, 0, 2.0**-40, -(2.0**-40), 2.0**-20, -(2.0**-20), 0.01, -0.01, 0.5, -0.5])
SIZE = 1200


class Points:
    """Points of a domain, and ways to get more of them."""

    def __init__(self, spec, random, size=SIZE):
        self.spec, self.random = spec, random
        self.depends = [set(self.free_names(condition)) for condition in spec.domain]
        self.found = {}
        self.values = self.inside(self._repaired(self._drawn(size)))
        self.count = len(self.values[spec.free[0]])

    def whole(self, free):
        """Return the values of all variables, from those of the free ones."""
        at = dict(free)
        with np.errstate(all="ignore"):
            for name, law in self.spec.derived.items():
                at[name] = np.broadcast_to(floats(law, at), at[self.spec.free[0]].shape)
        return at

    def inside(self, free, moved=None):
        """Return the points that lie in the domain, with all variables; `moved`: what changed."""
        at = self.whole(free)
        kept = np.ones(at[self.spec.free[0]].shape, bool)
        with np.errstate(all="ignore"):
            for condition, depends in zip(self.spec.domain, self.depends, strict=True):
                if moved is None or moved & depends:
                    kept &= np.broadcast_to(floats(condition, at) > 0, kept.shape)
        return {name: values[kept] for name, values in at.items()}

    def _drawn(self, size):
        """Return values of every sort; each point has one sort for most of its names."""
        random, free = self.random, self.spec.free
        sort = random.integers(0, 5, size)
        at = {}
        for name in free:
            own = np.full(size, float(self.spec.own[name]))
            wide = random.choice([1, -1], size) * 10.0 ** random.uniform(-4, 4, size)
            widest = random.choice([1, -1], size) * 10.0 ** random.uniform(-12, 12, size)
            near = np.round(random.uniform(-4, 4, size) * 64) / 64
            here = np.where(random.random(size) < 0.15, random.integers(0, 5, size), sort)
            here = np.where((sort == 0) & (random.random(size) < 0.2), 1, here)
            at[name] = np.choose(here, [own, random.choice(SIMPLE, size), wide, near, widest])
        for name in free:
            other = at[free[random.integers(len(free))]] * random.choice([1, -1, 2, 0.5], size)
            equal = random.random(size) < 0.08
            at[name] = np.where(equal, other * (1 + random.choice(NUDGES, size)), at[name])
        return at

    def _repaired(self, at):
        """Move points across conditions that they break, one name at a time."""
        for condition in [*self.spec.domain, *self.spec.domain]:
            found = self.free_names(condition)
            whole = self.whole(at)
            with np.errstate(all="ignore"):
                broken = ~np.broadcast_to(floats(condition, whole) > 0, at[self.spec.free[0]].shape)
            if not found or not broken.any():
                continue
            name = found[self.random.integers(len(found))]
            part = {n: v[broken] for n, v in at.items()}
            root = self.root(("-", condition[1], condition[2]), name, part)
            size = len(root)
            away = self.random.choice([0, 0, 1e-9, 1e-3, 1, 10], size) * (1 + np.abs(root))
            with np.errstate(all="ignore"):
                for side in (-1, 1, 0):
                    tried = {**part, name: root + side * away}
                    good = np.broadcast_to(floats(condition, self.whole(tried)) > 0, size)
                    part = {n: np.where(good, tried[n], v) for n, v in part.items()}
            for n, v in part.items():
                at[n][broken] = v
        return at

    def free_names(self, *trees):
        """Return the free names on which trees depend."""
        found = dict.fromkeys(names(*trees))
        for name, law in reversed(self.spec.derived.items()):
            if name in found:
                found |= dict.fromkeys(names(law))
        return [name for name in found if name in self.spec.own]

    def root(self, difference, name, at, steps=2):
        """Return the values of a name where a difference may vanish, by secants."""

        def value(x):
            return floats(difference, self.whole({**at, name: x}))

        here = at[name]
        other = here + 1 + np.abs(here)
        with np.errstate(all="ignore"):
            ends = value(other), value(here)
            for step in range(steps):
                moved = here - ends[1] * (here - other) / (ends[1] - ends[0])
                moved = np.where(np.isfinite(moved), moved, here)
                other, here = here, moved
                ends = ends[1], value(here) if step + 1 < steps else 0
        return here

    def near(self, difference, most=24):
        """Return points of the domain at and around the zeros of a difference."""
        if difference not in self.found:
            self.found[difference] = self._near(difference, most)
        return self.found[difference]

    def _near(self, difference, most):
        found = []
        if not self.count:
            return self.values
        for name in self.free_names(difference)[:4]:
            pick = self.random.integers(0, self.count, most)
            at = {n: self.values[n][pick] for n in self.spec.free}
            root = self.root(difference, name, at)
            for nudge in (0, 2.0**-40, -(2.0**-40), 2.0**-10, -(2.0**-10), 0.25, -0.25):
                found.append({**at, name: root + nudge * (1 + np.abs(root)) * (root != 0)})
                if nudge:
                    found[-1][name] = np.where(root == 0, nudge, found[-1][name])
        return self.inside(joined(found)) if found else self.values

    def around(self, at, width, moved):
        """Return points of the domain around some: each name of `moved` is moved or left."""
        size = len(at[self.spec.free[0]])
        tried = dict(at)
        for name in moved:
            v = at[name]
            step = width * self.random.standard_normal(size) * np.where(v == 0, 1, np.abs(v))
            tried[name] = np.where(self.random.random(size) < 0.5, v + step, v)
        return self.inside({name: tried[name] for name in self.spec.free}, set(moved))

    def beside(self, *trees):
        """Return the free names of trees, and those that a condition of the domain ties to them."""
        own = set(self.free_names(*trees))
        tied = set().union(*(depends for depends in self.depends if depends & own))
        return sorted(own | (tied if len(tied) < 8 else set()))

    def exactly(self, n, at=None):
        """Return one point exactly: its floats, moved onto the equalities of the domain."""
        at = self.values if at is None else at
        point = {name: rational(float(at[name][n])) for name in self.spec.free}
        for left, right in _equal(self.spec.domain):
            point = onto(("-", left, right), point, self.spec) or point
        return point


def joined(found):
    """Return points of several sets as one."""
    return {name: np.concatenate([part[name] for part in found]) for name in found[0]}


def _equal(domain):
    """Yield the sides of each pair of conditions that says left = right."""
    for n, (op, left, right) in enumerate(domain):
        for other in domain[:n]:
            ends = {"<=": ">=", ">=": "<="}
            turned = other == (op, right, left)
            if op in ends and (turned or other == (ends[op], left, right)):
                yield left, right


def filled(point, spec):
    """Return an exact point with its derived variables."""
    at = dict(point)
    for name, law in spec.derived.items():
        at[name] = exact(law, at)
    return at


def certain(point, spec, warm=True):
    """Return whether a point certainly lies in the domain."""
    try:
        at = filled(point, spec)
        return all(exact(c, at) for c in (*spec.domain, *(spec.warm if warm else ())))
    except (NoValueError, DoubtError):
        return False


def onto(difference, point, spec, only=None):
    """Return a point moved along one name to where a difference is exactly zero, or None."""
    for name in [n for n in names(difference) if n in point and (only is None or n in only)]:
        try:
            at = [exact(difference, filled({**point, name: rational(k)}, spec)) for k in (0, 1, 2)]
            slope = at[1] - at[0]
            if at[2] - at[1] == slope and slope != 0:
                moved = {**point, name: -at[0] / slope}
                if exact(difference, filled(moved, spec)) == 0:
                    return moved
        except (NoValueError, DoubtError):
            continue
    return None


def bisected(difference, name, point, spec, ends):
    """Return a point moved along a name to 270 bits from a zero of a difference, or None."""

    def side(x):
        return sign(exact(difference, filled({**point, name: x}, spec)))

    low, high = ends
    try:
        first, last = side(low), side(high)
        if first * last >= 0:
            return None
        for _ in range(270):
            middle = (low + high) / 2
            low, high = (middle, high) if side(middle) == first else (low, middle)
    except (NoValueError, DoubtError):
        return None
    return {**point, name: low}
