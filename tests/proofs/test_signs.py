"""Signs of functions: what holds is proved, what fails is refuted by a number, the rest is open."""

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from piezo_sym.expressions.tree import Add, LaneSum, Mul, Num
from piezo_sym.proofs import Verdict
from piezo_sym.proofs.signs.decide import decide_sign
from tests.proofs.sign_laws import X, law, laws, precise, steady

#: W with W(x)*x >= 0 for every x.
PASSIVE = """
tanh(x); x*exp(-x**2); x + sin(x); tanh(4*x)*(1 + sin(3*x)/2); x/(1 + abs(x)); 0*x; x**2*sign(x)
sign(x)*log(1 + abs(x)); x + 2*sin(x); x + 4*sin(x); x + 4.6*sin(x); x**3 - x + 2*tanh(x)
exp(x) - exp(-x); x*abs(x); sqrt(abs(x))*sign(x); deadzone(tanh(x), 1/2); log(1 + x**2)*x
x*exp(-abs(x)); exp(x) - 1; 1 - exp(-x); deadzone(x, 1)*exp(-x**2); saturate(x, 1/3); x - sin(x)
x*(2 - cos(x)); x - tanh(x); x*(1 + cos(x)); x if abs(x) < 1 else sign(x); x**5 - x**3 + x
x**9 + x**8 + x**7; (x - 1)**2*tanh(x); x*(3*x - 1)**2; x*(x - 1)*(x - 1); x/sqrt(1 + x**2)
max(x - 1/3, 0) + min(x + 1/3, 0); x*(exp(-x**2) + 1/10); tanh(x) - x*exp(-x**2)/2
tanh(x) - 0.9*x*exp(-abs(x)); x*exp(x/10); (1 + 2*exp(-(10*x)**2))*tanh(100*x) + x/10
0.1 - 0.1*exp(-3*x); tanh(x/100); sign(x)
"""
#: W with W(x)*x < 0 somewhere.
ACTIVE = """
x - 1.2*tanh(x); sin(x); x*(exp(-x**2) - 0.1); tanh(x) - 0.4*x; x + 5*sin(x); x + 4.61*sin(x)
x*cos(x); -x; x - 1; tanh(x) - x; deadzone(x, 1) - x*exp(-x**2); x*(0.001 - exp(-abs(x)))
tanh(x) - 1.1*x*exp(-abs(x)); x*((x - 1)**2 - 0.001); x - 1.001*tanh(x); sign(x) - x/1000
x if x < 3 else -x; deadzone(x, 2) - deadzone(x, 1); x**3 - x; log(1 + abs(x)); -tanh(x)
x if abs(x) < 7.3 else 7 - x; x*((x - 2.718)**2 - 1e-6)
"""
#: W with W(x)*x >= 0 that intervals do not tell, or without a value somewhere.
UNTOLD = """
x*(x**4 - 4*x**2 + 4); 1/x; tanh(x)/x*x; x - log(1 + x**2)/2; x*exp(-x**2) - x*exp(-2*x**2)
sqrt(x)**2; x*log(abs(x))**2
"""


def split(text):
    return [part.strip() for line in text.strip().splitlines() for part in line.split(";")]


def power_of(text):
    """Return W(x)*x."""
    return Mul(law(text), X)


@pytest.mark.parametrize("text", split(PASSIVE))
def test_a_passive_law_is_proved(text):
    decision = decide_sign(power_of(text), "x")
    assert (decision.verdict, decision.witness, decision.reason) == (Verdict.PROVED, None, "")


@pytest.mark.some(7)
@pytest.mark.parametrize("text", split(PASSIVE))
def test_a_proved_law_less_a_little_is_not(text):
    """W(0)*0 is 0; and W is less than a little near 0, unless it jumps there."""
    lowered = Add((power_of(text), Num(Fraction(-1, 10**6))))
    assert decide_sign(lowered, "x").verdict is Verdict.REFUTED
    if text != "sign(x)":
        assert decide_sign(power_of(f"({text}) - 1e-9"), "x").verdict is not Verdict.PROVED


@pytest.mark.parametrize("text", split(ACTIVE))
def test_an_active_law_is_refuted_by_a_number(text):
    decision = decide_sign(power_of(text), "x")
    assert decision.verdict is Verdict.REFUTED
    assert precise(power_of(text), decision.witness, 50) < 0
    assert len(str(decision.witness)) < 12


@pytest.mark.some(3)
@pytest.mark.parametrize("text", split(UNTOLD))
def test_what_is_not_told_is_open_and_says_where(text):
    decision = decide_sign(power_of(text), "x")
    assert decision.verdict is Verdict.OPEN
    assert decision.witness is None
    assert "x = " in decision.reason or "no value at" in decision.reason


@pytest.mark.long
@steady
@given(laws(9), st.booleans())
def test_verdicts_on_random_laws_are_true(tree, times_x):
    f = Mul(tree, X) if times_x else tree
    decision = decide_sign(f, "x", budget=300)
    if decision.verdict is Verdict.REFUTED:
        assert precise(f, decision.witness, 50) < 0
    if decision.verdict is Verdict.PROVED:
        values = [precise(f, x, 30) for x in GRID]
        assert all(v is None or v >= -1e-25 * (1 + abs(v)) for v in values)


SCALES = [Fraction(10) ** n for n in range(-6, 7)]
GRID = [side * scale * step / 7 for side in (1, -1) for scale in SCALES for step in range(1, 40, 3)]
GRID += [Fraction(n, 20) for n in range(-100, 101)]

NEAR_ZERO = st.sampled_from(
    ["x", "sin(x)", "tanh(x)", "exp(x) - 1", "x**3", "x*abs(x)", "x*exp(-x)"]
)


@pytest.mark.long
@steady
@given(st.lists(st.tuples(st.integers(-6, 6), NEAR_ZERO), min_size=2, max_size=4))
def test_verdicts_on_sums_that_vanish_at_zero_are_true(terms):
    text = " + ".join(f"({weight})*({part})" for weight, part in terms)
    decision = decide_sign(power_of(text), "x", budget=400)
    if decision.verdict is Verdict.REFUTED:
        assert precise(power_of(text), decision.witness, 50) < 0
    if decision.verdict is Verdict.PROVED:
        values = [precise(power_of(text), x, 60) for x in GRID]
        assert all(v is None or v >= -1e-40 * (1 + abs(v)) for v in values)


CASES = [
    ("(x - 1/3)*tanh(x - 1/3)", Verdict.PROVED),
    ("exp(x) - 1 - x", Verdict.PROVED),
    ("sqrt(x)", Verdict.OPEN),
    ("1/(x - 300)**2", Verdict.OPEN),
    ("1 - exp(x - 301)", Verdict.REFUTED),
    ("-x", Verdict.REFUTED),
    ("x", Verdict.REFUTED),
]


@pytest.mark.parametrize(("text", "verdict"), CASES)
def test_both_sides_of_zero_are_looked_at(text, verdict):
    assert decide_sign(law(text), "x").verdict is verdict


def test_a_jump_below_zero_at_one_point_is_seen():
    """Only at x = 1/4 is it negative."""
    text = "x**2 - (1 if x <= 0.25 else 0)*(1 if x >= 0.25 else 0)"
    assert decide_sign(law(text), "x").verdict is not Verdict.PROVED
    assert decide_sign(law(text.replace("0.25", "0")), "x").witness == 0


#: Zero, but no interval of doubles says so.
NOUGHT = "(sin(1)**2 + cos(1)**2 - 1)"
ONLY_AT = "(1 if 3*x <= {n} else 0)*(1 if 3*x >= {n} else 0)"


@pytest.mark.parametrize("n", [0, 7])
def test_a_single_point_that_is_not_told_keeps_the_decision_open(n):
    text = f"(3*x - {n})**2 + {ONLY_AT.format(n=n)}*{NOUGHT}"
    assert decide_sign(law(text), "x").verdict is Verdict.OPEN


@pytest.mark.parametrize("side", ["+", "-"])
def test_a_dip_next_to_a_zero_is_not_overlooked(side):
    text = f"(x - 7/3)*(x - 7/3 {side} 1e-9)"
    assert decide_sign(law(text), "x").verdict is not Verdict.PROVED


@pytest.mark.parametrize("text", ["abs(x - 777.7) - 0.1", "abs(x + 777.7) - 0.1"])
def test_far_out_is_looked_at_on_both_sides(text):
    assert decide_sign(law(text), "x").verdict is Verdict.REFUTED


def test_other_names_and_sums_over_lanes_are_open():
    assert decide_sign(law("r*x**2"), "x").reason == "depends on r too"
    assert decide_sign(LaneSum(X, "bank"), "x").reason == "sums over lanes"


def test_the_budget_ends_the_search():
    decision = decide_sign(power_of("x + 4.6*sin(x)"), "x", budget=3)
    assert decision.verdict is Verdict.OPEN
    assert "budget" in decision.reason
