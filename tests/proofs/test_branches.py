"""Branches of random laws: exactly where its conditions hold a branch is the law; one always is."""

import operator

import mpmath
from hypothesis import assume, given
from hypothesis import strategies as st

from piezo_sym.proofs.branches import (
    KINKED,
    OPPOSITE,
    TooManyBranchesError,
    branches,
    smooth_clauses,
    with_choices,
)
from piezo_sym.spec.expressions import Call, Cmp, If, walk
from piezo_sym.spec.text import spell
from tests.spec.spec_laws import laws, precise, steady

COMPARE = {"<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge}
NUMBERS = st.integers(-12, 12).map(lambda n: mpmath.mpf(n) / 4)
VALUES = st.fixed_dictionaries({"x": NUMBERS, "y": NUMBERS, "w": NUMBERS.map(abs)})
FAULTS = (ArithmeticError, ValueError, TypeError, OverflowError)


def value(tree, values):
    """Return the value of a law's text, or None where it has none."""
    try:
        return precise(spell(tree), values)
    except FAULTS:
        return None


def holds(condition, values):
    """Return whether a comparison holds, or None where a side has no value or they are close."""
    left, right = value(condition.left, values), value(condition.right, values)
    if left is None or right is None:
        return None
    if left != right and abs(left - right) < mpmath.mpf(10) ** -60 * (abs(left) + abs(right)):
        return None
    return COMPARE[condition.op](left, right)


def close(a, b):
    return abs(a - b) <= mpmath.mpf(10) ** -40 * (abs(a) + abs(b) + 1)


def branches_of(tree):
    try:
        return branches(tree)
    except TooManyBranchesError:
        assume(False)


def is_smooth(tree):
    return not any(
        isinstance(n, If) or (isinstance(n, Call) and n.function in KINKED) for n in walk(tree)
    )


@steady
@given(laws(), VALUES)
def test_one_branch_holds_and_it_is_the_law(tree, values):
    wanted = value(tree, values)
    assume(wanted is not None)
    taken = []
    for branch in branches_of(tree):
        assert is_smooth(branch.value)
        assert all(is_smooth(side) for c in branch.conditions for side in (c.left, c.right))
        outcome = [holds(condition, values) for condition in branch.conditions]
        if False in outcome:
            continue
        assume(None not in outcome)  # a comparison of this very branch is too close to call
        taken.append(branch)
    assert len(taken) == 1
    assert close(value(taken[0].value, values), wanted)


@steady
@given(laws(), VALUES)
def test_a_law_in_choices_is_the_same(tree, values):
    wanted = value(tree, values)
    assume(wanted is not None)
    found = with_choices(tree)
    assert not any(isinstance(n, Call) and n.function in KINKED for n in walk(found))
    after = value(found, values)
    assert after is not None
    assert close(after, wanted)


@steady
@given(laws(), laws(), st.sampled_from(sorted(COMPARE)), VALUES)
def test_clauses_hold_together_exactly_where_the_comparison_does(left, right, op, values):
    condition = Cmp(op, left, right)
    wanted = holds(condition, values)
    assume(wanted is not None)
    try:
        clauses = list(smooth_clauses(condition))
    except TooManyBranchesError:
        assume(False)
    outcomes = []
    for clause in clauses:
        each = [holds(part, values) for part in clause]
        assume(True in each or None not in each)
        outcomes.append(True in each)
    assert all(outcomes) == wanted


def test_opposites_are_opposite():
    for op, other in OPPOSITE.items():
        assert all(COMPARE[op](a, 0) != COMPARE[other](a, 0) for a in (-1, 0, 1))
