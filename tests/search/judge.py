"""Verdicts against the oracle: what is false, and what is true but open.

Input: a spec's text and the rows of `verify`.  Output: `Fault` records and counts.
"""

from collections import Counter
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from tests.search.attack import counterexample, fails
from tests.search.laws import names, text
from tests.search.points import Points, bisected, certain, filled, onto
from tests.search.reading import moving, spec_of
from tests.search.values import DoubtError, NoValueError, digits, exact, rational, sign

ORDER = ("REFUTED", "OPEN", "PROVED")
#: Points of the domain that are tried for what a witness leaves open.
COMPLETIONS = 40


@dataclass(frozen=True)
class Fault:
    """A verdict that is false: `kind` says how; `at` where, as text."""

    kind: str
    id: str
    element: str
    at: str = ""


def merged(rows):
    """Return one (verdict, witness, reason) per property and element: the worst."""
    found = {}
    for row in rows:
        key = row["id"], row["element"]
        if key not in found or ORDER.index(row["verdict"]) < ORDER.index(found[key]["verdict"]):
            found[key] = row
    return found


def judge(source, rows, seed=0, labels=None):
    """Return the faults of the verdicts on a spec, and counts of all verdicts.

    Parameters
    ----------
    source : the spec's text.
    rows : dicts with id, element, verdict, witness, reason.
    labels : (id, element) -> True where a law has the property by construction.
    """
    spec, labels = spec_of(source), labels or {}
    points = Points(spec, np.random.default_rng(seed))
    faults, counts = [], Counter(points=points.count)
    for key, row in merged(rows).items():
        claim = spec.claims.get(key)
        if claim is None:
            continue
        verdict = row["verdict"]
        counts[f"{key[0]} {verdict}"] += 1
        found = None
        if verdict == "REFUTED":
            kind = witness_fault(claim, row["witness"] or {}, points)
        else:
            found = counterexample(claim, points)
            kind = "false PROVED" if found and verdict == "PROVED" else ""
        if verdict == "OPEN":
            counts[f"{key[0]} {_sort(row['reason'], found, labels.get(key))}"] += 1
        if labels.get(key) is False and verdict == "PROVED" and not found:
            kind = "doubtful PROVED"
        if labels.get(key) and (found or (verdict == "REFUTED" and not kind)):
            kind = "false label"
        if kind:
            at = shown(claim, found, spec) if found else str(row["witness"])
            faults.append(Fault(kind, *key, at))
            counts[kind] += 1
    return faults, counts


def _sort(reason, found, label):
    if "it rests on" in (reason or ""):
        return "open for another"
    return "open and false" if found else "open and true" if label else "open"


def shown(claim, point, spec):
    """Return a counterexample as text, with the laws' values to 60 digits."""
    used = [n for n in spec.free if n in set(names(*claim.trees, *spec.domain))]
    values = []
    for law in claim.trees:
        try:
            at = {n: v for n, v in filled(point, spec).items() if n in names(law)}
            values.append(f"{text(law)} = {float(digits(law, at)):.6g}")
        except (ArithmeticError, ValueError, AttributeError):
            values.append(f"{text(law)} has no value")
    return "; ".join([", ".join(f"{n} = {point[n]}" for n in used), *values])


def witness_fault(claim, witness, points):
    """Return what is wrong with a witness: nothing, that it breaks nothing, or that it may."""
    spec = points.spec
    try:
        given = {name: Fraction(value) for name, value in witness.items()}
    except ValueError:
        return "unread witness"
    for loose in (False, True):  # a co-state of which a state is given too
        states = moving(spec) if loose else ()
        at = _in_variables(claim, {n: v for n, v in given.items() if n not in states}, spec)
        tried = list(_completed(at, points)) if at is not None else []
        if any(fails(claim, point, spec) for point in tried):
            return "loose REFUTED" * loose
    known = at is not None and set(names(*claim.trees)) <= set(at)
    inside = known and any(certain(point, spec) for point in tried)
    strict = _in_variables(claim, given, spec)
    broken = strict is None or _outside(strict, spec) or _untied(strict, spec)
    return "false REFUTED" if inside or broken else "unconfirmed REFUTED"


def _outside(at, spec):
    """Return whether a condition is certainly broken, whatever the names not given are."""
    for condition in spec.domain:
        try:
            if set(names(condition)) <= set(at) and not exact(condition, at):
                return True
        except (NoValueError, DoubtError):
            continue
    return False


def _untied(at, spec):
    """Return whether a co-state or temperature certainly is not what the rest says it is."""
    for name, law in spec.derived.items():
        if name in at and set(names(law)) <= set(at):
            try:
                if sign(exact(law, at) - at[name]) != 0:
                    return True
            except (NoValueError, DoubtError):
                continue
    return False


def _in_variables(claim, given, spec):
    """Return a witness in the variables of the spec, None if two values of one differ."""
    words, at = spec.words[claim.element], {}
    for name, value in given.items():
        tree = words.get(name, ("name", name))
        value = -rational(value) if tree[0] == "neg" else rational(value)
        name = tree[1][1] if tree[0] == "neg" else tree[1]
        if at.setdefault(name, value) != value:
            return None
    return at


def _completed(at, points):
    """Yield whole points with the values of a witness, the rest from the spec and from points."""
    spec = points.spec
    fixed = {name: value for name, value in at.items() if name in spec.own}
    own = {name: rational(value) for name, value in spec.own.items()}
    for n in range(-1, min(points.count, COMPLETIONS)):
        point = {**(points.exactly(n) if n >= 0 else own), **fixed}
        for name in [name for name in spec.derived if name in at]:
            point = _tied(name, point, at[name], fixed, spec)
        if all(_agrees(name, point, at[name], spec) for name in spec.derived if name in at):
            yield point


def _tied(name, point, value, fixed, spec):
    """Return a point moved along a state that is not given, to where a co-state has its value."""
    law = spec.derived[name]
    state = {n for n in names(law) if n in moving(spec) and n not in fixed}
    number = ("num", Fraction(int(value.p), int(value.q)))
    difference, wide = ("-", law, number), rational(2.0**40)
    found = onto(difference, point, spec, state)
    for one in () if found else state:
        found = found or bisected(difference, one, point, spec, (-wide, wide))
    return found or point


def _agrees(name, point, value, spec):
    try:
        return abs(filled(point, spec)[name] - value) < rational(2.0**-200)
    except (NoValueError, DoubtError):
        return False
