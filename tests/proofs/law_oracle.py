"""What a law does, found by looking: its text at very many points, without the package.

Python's own tree of the text is walked with NumPy to search, with mpmath (60 digits) to confirm,
and with `Fraction` where the text is rational.
"""

import ast
from fractions import Fraction
from typing import ClassVar

import mpmath
import numpy as np

DIGITS = 60
#: exp of more than this is skipped: neither a value nor the lack of one.
LARGEST_EXPONENT = 10_000
COMPARE = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">="}
HOLDS = {
    "<": lambda a, b: a < b,
    "<=": lambda a, b: a <= b,
    ">": lambda a, b: a > b,
    ">=": lambda a, b: a >= b,
}


class TooLargeError(Exception):
    """A value beyond what is looked at."""


class NotRationalError(Exception):
    """A function in a text that should be rational."""


def tree_of(text):
    return ast.parse(text, mode="eval").body


def number(node):
    """Return a constant as the text has it: exact."""
    return Fraction(repr(node.value))


class Floats:
    """Arithmetic on arrays: the search."""

    functions: ClassVar = {
        "exp": np.exp,
        "log": np.log,
        "sqrt": np.sqrt,
        "sin": np.sin,
        "cos": np.cos,
        "tanh": np.tanh,
        "abs": np.abs,
        "sign": np.sign,
        "min": np.minimum,
        "max": np.maximum,
        "deadzone": lambda z, w: np.maximum(z - w, 0) + np.minimum(z + w, 0),
        "saturate": lambda z, w: np.minimum(np.maximum(z, -w), w),
    }

    @staticmethod
    def constant(value):
        return float(value)

    @staticmethod
    def choice(condition, then, other):
        return np.where(condition, then(), other())

    @staticmethod
    def divide(a, b):
        return np.divide(a, b)

    @staticmethod
    def power(a, exponent):
        return np.power(a, float(exponent))


class Digits:
    """Arithmetic with 60 digits: the confirmation."""

    @staticmethod
    def _exp(z):
        if z > LARGEST_EXPONENT:
            raise TooLargeError
        return mpmath.exp(z)

    @staticmethod
    def _log(z):
        if z <= 0:
            raise ValueError(z)
        return mpmath.log(z)

    @staticmethod
    def _sqrt(z):
        if z < 0:
            raise ValueError(z)
        return mpmath.sqrt(z)

    functions: ClassVar = {
        "exp": _exp,
        "log": _log,
        "sqrt": _sqrt,
        "sin": mpmath.sin,
        "cos": mpmath.cos,
        "tanh": mpmath.tanh,
        "abs": abs,
        "sign": mpmath.sign,
        "min": min,
        "max": max,
        "deadzone": lambda z, w: max(z - w, 0) + min(z + w, 0),
        "saturate": lambda z, w: min(max(z, -w), w),
    }

    @staticmethod
    def constant(value):
        return mpmath.mpf(value.numerator) / value.denominator

    @staticmethod
    def choice(condition, then, other):
        return then() if condition else other()

    @staticmethod
    def divide(a, b):
        return a / b

    @staticmethod
    def power(a, exponent):
        if exponent.denominator == 1:
            return a**exponent.numerator
        if a < 0 or (a == 0 and exponent < 0):
            raise ValueError(a)
        return a ** (mpmath.mpf(exponent.numerator) / exponent.denominator)


class Rationals:
    """Arithmetic with fractions: exact, or not rational."""

    functions: ClassVar = {
        "abs": abs,
        "sign": lambda z: Fraction((z > 0) - (z < 0)),
        "min": min,
        "max": max,
        "deadzone": lambda z, w: max(z - w, Fraction(0)) + min(z + w, Fraction(0)),
        "saturate": lambda z, w: min(max(z, -w), w),
    }

    @staticmethod
    def constant(value):
        return value

    choice = Digits.choice
    divide = Digits.divide

    @staticmethod
    def power(a, exponent):
        if exponent.denominator != 1:
            raise NotRationalError
        return a**exponent.numerator


def evaluate(node, values, kind):
    """Return the value of a text's tree in one of the three arithmetics."""

    def of(part):
        return evaluate(part, values, kind)

    match node:
        case ast.Constant():
            return kind.constant(number(node))
        case ast.Name(name):
            return values[name]
        case ast.UnaryOp(_, arg):
            return -of(arg)
        case ast.BinOp(left, ast.Pow(), right):
            return kind.power(of(left), exponent_of(right))
        case ast.BinOp(left, op, right):
            a, b = of(left), of(right)
            if isinstance(op, ast.Div):
                return kind.divide(a, b)
            return a + b if isinstance(op, ast.Add) else a - b if isinstance(op, ast.Sub) else a * b
        case ast.Compare(left, [op], [right]):
            return HOLDS[COMPARE[type(op)]](of(left), of(right))
        case ast.IfExp(test, then, other):
            return kind.choice(of(test), lambda: of(then), lambda: of(other))
        case ast.Call(ast.Name(name), args):
            if name not in kind.functions:
                raise NotRationalError
            return kind.functions[name](*map(of, args))
    raise TypeError(ast.dump(node))


def exponent_of(node):
    return evaluate(node, {}, Rationals)


def floats(node, points):
    with np.errstate(all="ignore"):
        size = len(next(iter(points.values())))
        return np.broadcast_to(evaluate(node, points, Floats), (size,))


def precise(node, values):
    """Return the value to 60 digits.

    Raises
    ------
    ArithmeticError, ValueError
        Where there is none.
    """
    with mpmath.workdps(DIGITS):
        exact = {name: Digits.constant(Fraction(value)) for name, value in values.items()}
        return evaluate(node, exact, Digits)


def rational(node, values):
    """Return the exact value, or None if the text is not rational."""
    try:
        return evaluate(node, values, Rationals)
    except NotRationalError:
        return None


def names_of(*nodes):
    calls = {n.func.id for node in nodes for n in ast.walk(node) if isinstance(n, ast.Call)}
    found = [n.id for node in nodes for n in ast.walk(node) if isinstance(n, ast.Name)]
    return tuple(name for name in dict.fromkeys(found) if name not in calls)


def edges(node):
    """Yield (left, right) of each comparison on which the value depends."""
    for part in ast.walk(node):
        match part:
            case ast.Compare(left, _, [right]):
                yield left, right
            case ast.Call(ast.Name("abs" | "sign"), [z]):
                yield z, ast.Constant(0)
            case ast.Call(ast.Name("min" | "max"), [z, w]):
                yield z, w
            case ast.Call(ast.Name("deadzone" | "saturate"), [z, w]):
                yield z, w
                yield z, ast.UnaryOp(ast.USub(), w)


def widths(node):
    """Yield what the contracts take to be >= 0: half widths."""
    for part in ast.walk(node):
        if isinstance(part, ast.Call) and part.func.id in {"deadzone", "saturate"}:
            yield ast.Compare(part.args[1], [ast.GtE()], [ast.Constant(0)])


SIMPLE = np.array([0, 1, -1, 2, -2, 3, 0.5, -0.5, 5, -5, 10, -10, 0.1, 100, 300])
NEAR = np.array([0, 1e-9, -1e-9, 1e-4, -1e-4, 0.01, -0.01])


class Points:
    """Points of a domain: random ones of every size, simple ones, and ones near thresholds.

    Parameters
    ----------
    names : all names; the first is the law's letter.
    domain : comparisons as text trees.
    """

    def __init__(self, names, domain, random, size=6000):
        self.names, self.domain = names, domain
        drawn = {name: self._drawn(random, size) for name in names}
        for name in self._positive():
            drawn[name] = np.abs(drawn[name])
        for low, high in self._ordered():  # low < high
            shifted = drawn[low] + np.abs(self._drawn(random, size)) * random.choice(
                [1, 1e-3, 1e-6], size
            )
            drawn[high] = np.where(random.random(size) < 0.9, shifted, drawn[high])
        letter, *others = names
        near = drawn[random.choice(others)] if others else np.ones(size)
        for other in others:
            pick = random.random(size) < 0.4
            near = np.where(pick, drawn[other] * random.choice([1, 2, 0.5, 3], size), near)
        near = near * random.choice([1, -1], size) * (1 + random.choice(NEAR, size))
        drawn[letter] = np.where(random.random(size) < 0.4, near, drawn[letter])
        self.values = self.kept(drawn)

    def _drawn(self, random, size):
        wide = random.choice([1, -1], size) * 10 ** random.uniform(-4, 4, size)
        near = random.uniform(-4, 4, size)
        simple = random.choice(SIMPLE, size)
        return np.choose(random.integers(0, 3, size), [wide, near, simple])

    def _positive(self):
        for part in self.domain:
            match part:
                case ast.Compare(ast.Name(name), [ast.Gt() | ast.GtE()], [ast.Constant(0)]):
                    yield name

    def _ordered(self):
        for part in self.domain:
            match part:
                case ast.Compare(ast.Name(high), [ast.Gt() | ast.GtE()], [ast.Name(low)]):
                    yield low, high

    def kept(self, drawn):
        """Return the points that lie in the domain."""
        inside = np.ones(len(drawn[self.names[0]]), bool)
        for condition in self.domain:
            inside &= floats(condition, drawn)
        return {name: values[inside] for name, values in drawn.items()}

    def completed(self, values, most=30):
        """Yield exact points of the domain that have the values given of some names."""
        size = len(self.values[self.names[0]])
        given = {name: np.full(size, float(value)) for name, value in values.items()}
        kept = self.kept({**self.values, **given})
        for n in range(min(len(kept[self.names[0]]), most)):
            point = {**self.at(n, kept), **values}
            if inside(self.domain, point):
                yield point

    def at(self, n, values=None):
        """Return one point, exactly."""
        return {name: Fraction(float(v[n])) for name, v in (values or self.values).items()}


def inside(domain, values):
    """Return whether exact numbers lie in a domain, as far as they say."""
    known = [c for c in domain if set(names_of(c)) <= values.keys()]
    return all(bool(precise(condition, values)) for condition in known)


def most_negative(law, letter, points, most=5):
    """Return a point at which law*letter < 0 to 60 digits, or None."""
    power = floats(law, points.values) * points.values[letter]
    low = np.argsort(np.where(np.isnan(power), np.inf, power))[:most]
    tiny = np.flatnonzero(power < 0)[:most]
    for n in dict.fromkeys([*low, *tiny]):
        if power[n] < 0 and is_negative(law, letter, points.at(n)):
            return points.at(n)
    return None


def is_negative(law, letter, values):
    """Return whether law*letter < 0 by more than what 60 digits leave out."""
    try:
        value = precise(law, values)
    except (ArithmeticError, ValueError, TooLargeError):
        return False
    return value * mpmath.mpf(float(values[letter])) < 0 and abs(value) > mpmath.mpf(10) ** -40


def without_value(law, points, most=20):
    """Return a point at which a law has no value, or None."""
    bad = np.flatnonzero(~np.isfinite(floats(law, points.values)))
    for n in bad[:most]:
        if not has_value(law, points.at(n)):
            return points.at(n)
    return None


def has_value(law, values):
    try:
        precise(law, values)
    except (ArithmeticError, ValueError):
        return False
    except TooLargeError:
        return True
    return True


def not_odd(law, letter, points, most=20):
    """Return a point at which law(-z) != -law(z), or None."""
    mirrored = {**points.values, letter: -points.values[letter]}
    one, other = floats(law, points.values), floats(law, mirrored)
    size = np.abs(one) + np.abs(other)
    apart = np.flatnonzero((np.abs(one + other) > 1e-9 * size) & np.isfinite(size))
    for n in apart[:most]:
        if is_not_odd(law, letter, points.at(n)):
            return points.at(n)
    return None


def is_not_odd(law, letter, values):
    try:
        one = precise(law, values)
        other = precise(law, {**values, letter: -values[letter]})
    except (ArithmeticError, ValueError, TooLargeError):
        return False
    return abs(one + other) > mpmath.mpf(10) ** -40 * (abs(one) + abs(other))


def jump(law, points, random, pairs=300):
    """Return a point next to which a law jumps, or None: edges are met on random segments."""
    size = len(points.values[points.names[0]])
    if size < 2:
        return None
    for left, right in edges(law):
        ends = [random.integers(0, size, pairs) for _ in range(2)]
        a, b = ({name: v[end] for name, v in points.values.items()} for end in ends)
        half = pairs // 2  # half of the segments change the letter alone
        for name in points.names[1:]:
            b[name] = np.concatenate([a[name][:half], b[name][half:]])
        below, above = _bracket(left, right, a, b)
        found = _apart(law, points, below, above)
        if found is not None:
            return found
    return None


def _bracket(left, right, a, b):
    """Return the points of each segment where left - right changes its sign, as (below, above)."""

    def side(t):
        at = {name: a[name] + t * (b[name] - a[name]) for name in a}
        return np.sign(floats(left, at) - floats(right, at))

    first, last = side(np.zeros(len(a[next(iter(a))]))), side(np.ones(len(a[next(iter(a))])))
    crossing = (first * last < 0) | ((first == 0) ^ (last == 0))
    a, b = ({name: v[crossing] for name, v in end.items()} for end in (a, b))
    first = first[crossing]
    low, high = np.zeros(len(first)), np.ones(len(first))
    for _ in range(60):
        middle = (low + high) / 2
        same = side(middle) == first
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    gaps = [1e-13, 1e-10, 1e-7]
    spread = lambda t: {name: a[name] + t * (b[name] - a[name]) for name in a}  # noqa: E731
    return [spread(low - gap) for gap in gaps], [spread(high + gap) for gap in gaps]


def _apart(law, points, below, above):
    """Return a point where the law differs on both sides however near they are."""
    sizes = []
    for one, other in zip(below, above, strict=True):
        x, y = floats(law, one), floats(law, other)
        legal = np.ones(len(x), bool)
        for condition in points.domain:
            legal &= floats(condition, one) & floats(condition, other)
        gap = np.abs(x - y)
        gap = np.where(gap > 1e-6 * (np.abs(x) + np.abs(y)), gap, 0)  # rounding aside
        sizes.append(np.where(legal & np.isfinite(gap), gap, 0))
    near, middle, _ = sizes  # what is continuous is smaller a thousand times, or thirty for roots
    bad = np.flatnonzero((near > 0) & (near > 0.2 * middle))
    for n in bad:
        one, other = points.at(n, below[0]), points.at(n, above[0])
        if is_jump_between(law, points.domain, one, other):
            return one
    return None


def is_jump_between(law, domain, one, other):
    """Return whether a law's difference between two points stays, however close they are moved."""
    with mpmath.workdps(DIGITS):
        try:
            start, end = precise(law, one), precise(law, other)
            first = max(abs(start), abs(end))
            for _ in range(130):
                middle = {name: (one[name] + other[name]) / 2 for name in one}
                value = precise(law, middle)
                if abs(value - start) < abs(value - end):
                    one, start = middle, value
                else:
                    other, end = middle, value
        except (ArithmeticError, ValueError, TooLargeError):
            return False
        pole = min(abs(start), abs(end)) > 10**6 * first  # no value there: not the law's fault
        return not pole and abs(start - end) > mpmath.mpf(10) ** -18 and inside(domain, one)


def jumps_at(law, domain, values, random):
    """Return whether a law jumps at a point: a value nearby that differs, however near it is."""
    values = {name: Fraction(value) for name, value in values.items()}
    with mpmath.workdps(DIGITS):
        centre = _value_or_none(law, values)
        for step in range(80):
            weights = random.integers(-9, 10, len(values))
            if step < 2 * len(values):  # first along each name alone
                weights = np.zeros(len(values), int)
                weights[step // 2] = 1 - 2 * (step % 2)
            found = []
            for size in (Fraction(1, 10**15), Fraction(1, 10**30)):
                moved = {
                    name: v + int(w) * size
                    for (name, v), w in zip(values.items(), weights, strict=True)
                }
                value = _value_or_none(law, moved) if inside(domain, moved) else centre
                found.append(value)
            if centre is None or None in found:
                continue
            if all(
                abs(value - centre) > mpmath.mpf(10) ** -9 * (1 + abs(centre)) for value in found
            ):
                return True
        return False


def _value_or_none(law, values):
    try:
        return precise(law, values)
    except (ArithmeticError, ValueError, TooLargeError):
        return None
