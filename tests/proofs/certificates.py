"""A certificate of a law's sign, checked by its text alone: at points, with 50 digits.

It takes plain data, as `Case.as_data` gives it, and raises AssertionError where a claim is false.
"""

import math
from fractions import Fraction
from itertools import pairwise

import mpmath

from tests.proofs import law_oracle as oracle

#: t in a window (lo, hi], as parts of it; beyond the last finite end, as multiples of it.
PARTS = [Fraction(n, 8) for n in range(1, 9)] + [Fraction(1, 1000)]
BEYOND = [Fraction(n) for n in (1, 2, 10, 300)]
TINY = mpmath.mpf(10) ** -25


def value(text, at):
    """Return the value of a text, or None where it has none that is looked at."""
    try:
        return oracle.precise(oracle.tree_of(text), at)
    except (ArithmeticError, ValueError, oracle.TooLargeError):
        return None


def holds(text, at):
    return bool(value(text, at))


def check(cases, law, letter, points):
    """Check a certificate of law*letter >= 0 at points of its domain, and all of its windows."""
    with mpmath.workdps(oracle.DIGITS):
        _check(cases, law, letter, points)


def _check(cases, law, letter, points):
    for term in (term for case in cases for term in case["terms"]):
        check_windows(term)
    for at in points:
        here = [case for case in cases if all(holds(guard, at) for guard in case["guards"])]
        whole = value(law, at)
        assert here or whole is None
        for case in here:
            check_case(case, whole, letter, at)


def check_case(case, whole, letter, at):
    """Check that the terms add up to the law, and that each is what it is said to be."""
    parts = [value(term["law"], at) for term in case["terms"]]
    if whole is None or None in parts:
        return
    assert close(mpmath.fsum(parts), whole, *parts)
    for term, part in zip(case["terms"], parts, strict=True):
        front = value(term["prefactor"], at)
        if front is None:
            continue
        assert term["sign"] * front >= -TINY
        if term["f"] is None:
            assert close(front, part * oracle.Digits.constant(at[letter]))
            continue
        s = oracle.Digits.constant(at[letter])
        for base, power in term["scale"].items():
            size, e = value(base, at), Fraction(power)
            assert size > 0
            s /= size ** (mpmath.mpf(e.numerator) / e.denominator)
        f = exactly(term["f"], s)
        assert f is None or close(front * f, part)


def exactly(text, s):
    """Return f(s) for an s of 60 digits."""
    try:
        return oracle.evaluate(oracle.tree_of(text), {"s": s}, oracle.Digits)
    except (ArithmeticError, ValueError, oracle.TooLargeError):
        return None


def close(a, b, *sizes):
    return abs(a - b) <= TINY * (1 + abs(a) + abs(b) + sum(map(abs, sizes)))


def check_windows(term):
    """Check that the rays cover all s, and that sign*f(s)*s >= 0 at points of each window."""
    if term["f"] is None:
        assert term["rays"] == []
        return
    pieces = []
    for ray in term["rays"]:
        centre, side = Fraction(ray["centre"]), ray["side"]
        assert side in (1, -1)
        signed(term, centre)
        for lo, hi, order in ray["windows"]:
            assert order in (0, 2, 8)
            ends = Fraction(lo), math.inf if hi == "inf" else Fraction(hi)
            assert 0 <= ends[0] < ends[1]
            pieces.append(sorted(centre + side * end for end in ends))
            for t in inside(*ends):
                signed(term, centre + side * t)
    pieces.sort()
    assert pieces[0][0] == -math.inf
    assert max(end for _, end in pieces) == math.inf
    for n, (_, after) in enumerate(pairwise(pieces)):
        assert after[0] <= max(end for _, end in pieces[: n + 1])


def inside(lo, hi):
    if hi == math.inf:
        return [lo + (lo or 1) * more for more in BEYOND]
    return [lo + (hi - lo) * part for part in PARTS]


def signed(term, s):
    f = exactly(term["f"], oracle.Digits.constant(Fraction(s)))
    assert f is None or term["sign"] * f * oracle.Digits.constant(Fraction(s)) >= -TINY
