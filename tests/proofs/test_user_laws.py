"""Laws as users write them, in the starter's damper: proved if true, refuted if they jump."""

import pytest

from piezo_sym import derive
from piezo_sym.errors import SpecError
from piezo_sym.proofs import Verdict, decide
from piezo_sym.spec.load import parse, starter

PARAMETERS = """
w = { value = 0.1, unit = "m/s" }
v_s = { value = 0.1, unit = "m/s" }
F_c = { value = 1.0, unit = "N" }
T_1 = { value = 300.0, unit = "K" }
n = { value = 2.0, unit = "1" }
tiny = { value = 1e-200, unit = "m/s" }
[inputs]"""
ASSUMED = 'assume = ["w > 0", "v_s > 0", "F_c >= 0", "T_1 > T_0", '
CONTINUOUS = (
    "F_c*(1 if v > w else (-1 if v < -w else v/w))",
    "d*v*min(1, max(0, T/T_0))",
    "d*v*saturate(T/T_0, 1)",
    "d*v*(0 if T < T_0 else ((T-T_0)/(T_1-T_0) if T < T_1 else 1))",
    "d*v_s*min(1, max(0, v/v_s))",
    "d*v if T > -T_0 else -d*v",
    "d*v if abs(v) <= w else (-d*w+2*d*(v+w) if v < -w else d*w+2*d*(v-w))",
    "d*v*(1/(n-1) if T < -T_0 else 1)",
    "(d if n <= 3/2 else d/(n - 1.5))*saturate(v, w)",
)
JUMPING = (
    "d*v if abs(v) <= w else (2*d*v if v < -w else d*v)",
    "d*v + d*w*sign(v)*sign(abs(v))",
    "d*v + d*w*sign(v)*sign(v/v_s)*sign(v*v_s)",
    "(d*v + F_c if v > w else d*v) if 2*v > 2*w else d*v",
    "F_c*sign(v)",
)
WITHOUT_VALUE = ("d*v/max(0, T/T_0 - 1)", "d*v/(0 if T < T_0 else 1)", "d*v/abs(sign(v))")


def rows(law, assumed=ASSUMED):
    text = starter("actuator").replace("[inputs]", PARAMETERS.strip(), 1)
    text = text.replace('force = "d*v"', f'force = "{law}"').replace("assume = [", assumed)
    return {(r.id, r.element): r for r in decide(derive(parse(text))).rows}


@pytest.mark.some(3)
@pytest.mark.parametrize("law", CONTINUOUS)
def test_a_continuous_law_is_proved(law):
    found = rows(law)
    for name in ("welldef", "continuous", "passive"):
        assert found[name, "damper"].verdict is Verdict.PROVED


@pytest.mark.some(2)
@pytest.mark.parametrize("law", JUMPING)
def test_a_law_that_jumps_is_refuted(law):
    row = rows(law)["continuous", "damper"]
    assert row.verdict is Verdict.REFUTED
    assert "discontinuous = true; friction that sticks is a 'stop', or" in row.reason
    assert "v" in row.witness


@pytest.mark.some(2)
@pytest.mark.parametrize("law", WITHOUT_VALUE)
def test_a_law_without_a_value_is_refuted_and_nothing_rests_on_it(law):
    found = rows(law)
    assert found["welldef", "damper"].verdict is Verdict.REFUTED
    for name in ("passive", "damper"), ("sigma", ""), ("exergy", ""):
        assert found[name].verdict is Verdict.OPEN
        assert "it rests on" in found[name].reason


def test_a_domain_without_the_values_given_is_refused():
    """In floating point 1e-200 squared is zero; exactly it is not."""
    with pytest.raises(SpecError, match="outside the domain: tiny = 1e-200"):
        rows("-d*v", ASSUMED + '"tiny > 0", "tiny*tiny <= 0*w*w", ')


def test_conditions_may_be_written_either_way():
    one = rows("d*(v + 4*v_s*sin(v/v_s))", 'assume = ["v_s > 0", "T_0/2 < T", ')
    other = rows("d*(v + 4*v_s*sin(v/v_s))", 'assume = ["0 < v_s", "T > T_0/2", ')
    assert {name: row.verdict for name, row in one.items()} == {
        name: row.verdict for name, row in other.items()
    }
    assert one["passive", "damper"].verdict is Verdict.PROVED
    assert ("invariant", "body") in one


def test_a_temperature_is_one_that_its_entropy_gives():
    """T = T_0*(1 + exp(S/c)) is above T_0: a law with T - T_0 is passive without assuming it."""
    text = starter("actuator").replace("T_0*exp(S/c)", "T_0*(1 + exp(S/c))")
    text = text.replace('force = "d*v"', 'force = "d*v*(T - T_0)/T_0"')
    row = next(
        r for r in decide(derive(parse(text))).rows if (r.id, r.element) == ("passive", "damper")
    )
    assert row.verdict is Verdict.PROVED


def test_many_kinks_in_the_domain_leave_rows_open_instead_of_raising():
    kinks = ", ".join(f'"abs(abs(abs(v_s - {n}*w)) - w) + abs(w) >= 0*w"' for n in range(1, 9))
    found = rows("d*v", ASSUMED + kinks + ", ")
    assert found["passive", "damper"].verdict in {Verdict.PROVED, Verdict.OPEN}


HUGE = (
    "d*w*exp(exp(exp(exp(exp(v/w)))))",
    "-d*v*exp(exp(1e9*v/w))",
    "d*v*sin(exp(exp(1e3*v/w)))",
)


@pytest.mark.some(1)
@pytest.mark.parametrize("law", HUGE)
def test_towers_of_exponentials_end(law):
    assert rows(law)["passive", "damper"].verdict is not Verdict.PROVED


@pytest.mark.long
def test_what_parameters_choose_is_proved_branch_by_branch():
    """The first branch alone has the sign that the second would need."""
    text = "F_c*v/v_s*(exp(v/v_s) - 2.7*v/v_s) if n > 0 else F_c*v/v_s*{}"
    false = rows(text.format("(exp(v/v_s - 0.37) - 2.72*(v/v_s - 0.37))"))
    assert false["passive", "damper"].verdict is Verdict.REFUTED
    true = rows(text.format("(exp(v/v_s - 0.37) - 2.7*(v/v_s - 0.37))"))
    assert true["passive", "damper"].verdict is Verdict.PROVED
