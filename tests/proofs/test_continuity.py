"""Continuity where branches meet in ways that a slip of the pen gives: equal edges, poles, gaps."""

import pytest

from piezo_sym.proofs import Verdict
from tests.proofs.law_edits import law
from tests.proofs.test_mutations import contradiction, verdicts

P, R, O = Verdict.PROVED, Verdict.REFUTED, Verdict.OPEN  # noqa: E741
CASES = [
    # one edge, written in two ways: the middle branch is never taken
    ("R*(i - i_0) if i > i_0 else R*(i + i_0) if -i < -i_0 else 0*i", "", {P}),
    ("(R if -i < -i_0 else 0*R) if i > i_0 else 0*R", "R > 0", {R}),
    ("(R if 2*i > 0 else 0*R) if i > 0 else 0*R", "R > 0", {R}),
    ("(R if i**3 > 0 else 0*R) if i > 0 else 0*R", "R > 0", {R}),
    ("R*i if T > -T_0 else a*i", "T_0 > 0", {P}),  # an edge outside the domain
    ("R*i if sign(T) > 0 else a*i", "", {P}),  # an edge between numbers
    ("R*i if i*i >= 0 else a", "", {P}),  # the other branch is never taken
    # a value at the edge itself that neither side has
    ("R*i if i > 0 else R*i if i < 0 else R", "R > 0", {R}),
    # no value at the edge on one side
    ("1/i if i > 0 else 0", "", {R}),
    ("sin(i)/i if i > 0 else 1", "", {O}),
    ("sin(i)/i if i > 0 else 2", "", {O}),
    ("exp(-1/i) if i > 0 else 0", "", {O}),
    ("(1 if exp(1/i) > 0 else 0) if i**2 > 0 else 0", "", {R, O}),
    # slopes that may differ, values that may not
    ("tanh(1000000*i) if i > 0 else i**3", "", {P}),
    ("sqrt(i) if i > 0 else -sqrt(-i)", "", {P}),
    ("R*i if i < i_0 else R*i + 0.000001*R", "R > 0", {R}),
    ("log(1 + i) if i > 0 else i", "", {P}),
    # a function has one value at equal arguments
    ("exp(saturate(i, i_0))", "i_0 > 0", {P}),
    ("tanh(saturate(deadzone(i, i_0), i_0*R))", "i_0 > 0, R > 0", {P}),
    ("sin(i if i < i_0 else i_0)", "", {P}),
    ("log(1 + (i if i > 0 else i**2))", "", {P}),
    ("sqrt(i**4) if i > 0 else sqrt(i**6)", "", {P}),
    ("exp(saturate(i, i_0)) if i < i_0 else exp(2*i_0)", "i_0 > 0", {R, O}),
]


@pytest.mark.some(8)
@pytest.mark.parametrize(("text", "domain", "wanted"), CASES)
def test_branches_that_meet(text, domain, wanted):
    made = law(text, domain)
    assert made.conditions
    row = verdicts(made)["continuous"]
    assert row.verdict in wanted
    assert contradiction(made, row) is None


def test_a_law_of_very_many_branches_is_open():
    text = " + ".join(f"deadzone(i, {n})" for n in range(1, 5))
    row = verdicts(law(text, ""))["continuous"]
    assert row.verdict is O
    assert "use fewer kinks" in row.reason
