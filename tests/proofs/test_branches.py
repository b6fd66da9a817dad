"""Branches of random laws: exactly where its conditions hold a branch is the law; one always is."""

import operator

import mpmath
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from piezo_sym.expressions.parse import parse_condition, parse_law
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import Call, If, walk
from piezo_sym.proofs.branches import (
    KINKED,
    OPPOSITE,
    TooManyBranchesError,
    branches,
    cover,
    opposite,
    settled,
    with_choices,
)
from tests.spec.spec_laws import laws, precise, steady

COMPARE = {"<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge}
NUMBERS = st.integers(-12, 12).map(lambda n: mpmath.mpf(n) / 4)
VALUES = st.fixed_dictionaries({"x": NUMBERS, "y": NUMBERS, "w": NUMBERS})
FAULTS = (ArithmeticError, ValueError, TypeError, OverflowError)


def value(tree, values):
    """Return the value of a law's text, or None where it has none."""
    try:
        found = precise(spell(tree), values)
    except FAULTS:
        return None
    return found if mpmath.isfinite(found) else None  # 0**(-2/3) is inf to mpmath


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
@given(laws(), VALUES)
def test_the_branches_cover_every_point_and_not_all_of_them_do_without_one(tree, values):
    wanted = value(tree, values)
    assume(wanted is not None)
    found = branches_of(tree)
    claim = cover(found)
    assert value(claim.left, values) == 1
    taken = [b for b in found if all(holds(c, values) for c in b.conditions)]
    if len(found) > 1:
        others = tuple(branch for branch in found if branch not in taken)
        assert value(cover(others).left, values) == 0


@steady
@given(laws(), VALUES)
def test_what_is_known_to_hold_decides_choices(tree, values):
    wanted = value(tree, values)
    assume(wanted is not None)
    known = [n.condition for n in walk(with_choices(tree)) if isinstance(n, If)]
    true = [c for c in known if holds(c, values)]
    false = [opposite(c) for c in known if holds(c, values) is False]
    assert close(value(settled(tree, [*true, *false]), values), wanted)


GUARDED = """
(v if sqrt(v) > 1 else 2*v) if abs(v - 2) < 1 else v
b*(sqrt(a) if a > 0 else 0) + (1 if log(b) > 0 else 2) if b > 0 else 3
deadzone(sqrt(a), (1/b if b > 0 else 1)) if a > 0 else 0
"""


@pytest.mark.parametrize("text", GUARDED.strip().split("\n"))
def test_what_guards_a_choice_is_decided_before_it(text):
    """Every partial operation on a path has its guard before it: by values, in order."""
    tree = parse_law(text, "test")
    for branch in branches(tree):
        for step, condition in enumerate(branch.conditions):
            if "sqrt(v)" in spell(condition.left):
                guard = {c.op for c in branch.conditions[:step] if "v - 2" in spell(c.left)}
                assert guard
            if "sqrt(a)" in spell(condition.left) or "log(b)" in spell(condition.left):
                assert any(spell(c.left) in "ab" for c in branch.conditions[:step])


@pytest.mark.parametrize("text", ["saturate(x, w)", "deadzone(x, w)"])
@pytest.mark.parametrize("x", [-3, -1, 0, 1, 3])
@pytest.mark.parametrize("w", [-2, -1, 0, 1, 2])
def test_a_width_below_zero_follows_the_formula(text, x, w):
    """By hand: max(z - w, 0) + min(z + w, 0) and min(max(z, -w), w)."""
    wanted = max(x - w, 0) + min(x + w, 0) if text[0] == "d" else min(max(x, -w), w)
    values = {"x": mpmath.mpf(x), "w": mpmath.mpf(w)}
    assert value(with_choices(parse_law(text, "test")), values) == wanted


def test_a_condition_known_to_be_false_is_not_taken_for_true():
    """`b < 0` says nothing of the branches for widths that are not negative."""
    tree, below = parse_law("saturate(a, b)", "test"), parse_condition("b < 0", "test")
    values = {"a": mpmath.mpf(-5), "b": mpmath.mpf(-1)}
    assert value(settled(tree, [below]), values) == -1


def test_opposites_are_opposite():
    for op, other in OPPOSITE.items():
        assert all(COMPARE[op](a, 0) != COMPARE[other](a, 0) for a in (-1, 0, 1))
