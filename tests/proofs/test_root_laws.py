"""Laws of a rational power with a unit: orifices, and others whose force grows as a root."""

import numpy as np
import pytest

from piezo_sym import derive, simulate, verify
from piezo_sym.proofs import Verdict
from piezo_sym.spec.load import parse

TEXT = """
[model]
name = "orifice"
[parameters]
m = {{ value = 1.0, unit = "kg" }}
k = {{ value = 4.0, unit = "N/m" }}
d = {{ value = 0.4, unit = "{unit}" }}
v_0 = {{ value = 0.1, unit = "m/s" }}
T_0 = {{ value = 300.0, unit = "K" }}
c = {{ value = 2.0, unit = "J/K" }}
[domain]
assume = ["d >= 0", "v_0 > 0"]
[elements]
spring = {{ kind = "spring", between = ["tip", "wall"], stiffness = "k", state = "q" }}
mass = {{ kind = "mass", at = "tip", mass = "m", state = "p" }}
damper = {{ kind = "damper", between = ["tip", "wall"], force = "{law}", heats = "body" }}
body = {{ kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }}
"""


UNIT = "N/(m/s)**(1/2)"


def verdicts(law, unit):
    rows = verify(derive(parse(TEXT.format(law=law, unit=unit)))).rows
    return {(row.id, row.element): row.verdict for row in rows}


@pytest.mark.some(1)
@pytest.mark.parametrize(
    ("law", "unit"),
    [
        ("d*sign(v)*sqrt(abs(v))", "N/(m/s)**(1/2)"),
        ("d*sign(v)*sqrt(abs(v))", "N*(s/m)^(1/2)"),
        ("d*sign(v)*abs(v)**(1/3)", "N/(m/s)**(1/3)"),
        ("d*v*abs(v)**(-1/2) if abs(v) > v_0 else d*v/sqrt(v_0)", "N/(m/s)**(1/2)"),
    ],
)
def test_a_root_law_with_its_unit_is_passive(law, unit):
    found = verdicts(law, unit)
    assert found["units", ""] is Verdict.PROVED
    assert found["passive", "damper"] is Verdict.PROVED


ROOTS = ("d*sign(v)*sqrt(abs(v))", "d*v/sqrt(abs(v) + v_0)", "d*v/v_0*sqrt(abs(v))")


@pytest.mark.long
@pytest.mark.parametrize("law", ROOTS)
def test_a_root_law_is_proved_altogether_and_runs_through_rest(law):
    """The printed slope is no 0/0 at rest, where that of a root alone is infinite."""
    assert set(verdicts(law, UNIT).values()) == {Verdict.PROVED}
    model, how = parse(TEXT.format(law=law, unit=UNIT)), {"duration": 4.0, "times": 9}
    run, other = (
        simulate(model, initial={"q": 0.0, "p": 1.0}, **more, **how)
        for more in ({}, {"method": "Radau", "rtol": 1e-10})
    )
    np.testing.assert_allclose(run.q, other.q, atol=1e-6)
    assert np.abs(run.energy_residual).max() < 1e-14 * np.abs(run.energy).max()


@pytest.mark.some(1)
@pytest.mark.parametrize("law", ["k*q*sqrt(abs(q)/q_0)", "k*q*(abs(q)/q_0)**(1/3)"])
def test_a_store_with_a_root_in_its_law_runs_through_rest(law):
    """No quadrature is exact at such a kink; what it leaves out falls below round-off near it."""
    text = TEXT.format(law="d*v", unit="N*s/m").replace('stiffness = "k"', f'force = "{law}"')
    text = text.replace("v_0 =", 'q_0 = { value = 0.1, unit = "m" }\nv_0 =')
    model = parse(text.replace('"v_0 > 0"', '"q_0 > 0", "k > 0"'))
    how = {"duration": 4.0, "times": 9, "initial": {"q": 0.1, "p": 1.0}}
    run, other = simulate(model, **how), simulate(model, method="Radau", rtol=1e-10, **how)
    np.testing.assert_allclose(run.q, other.q, atol=1e-6)
    assert np.abs(run.energy_residual).max() < 1e-14 * np.abs(run.energy).max()


@pytest.mark.some(2)
@pytest.mark.parametrize(
    "law",
    [
        "d*v/v_0*sqrt(1 - cos(v/v_0))",
        "d*v/v_0*(cosh(v/v_0) - 1)**(1/3)",
        "d*v/v_0*sqrt(cosh(v/v_0) - 1)",
        "d*v/v_0*sqrt(log(1 + (v/v_0)**2))",
        "d*(sqrt(v/v_0) if v > 0 else -sqrt(-v/v_0))",
        "d*(sqrt(v/v_0 - 1) if v >= v_0 else 0)",
    ],
)
def test_a_slope_that_is_divided_by_a_root_that_may_be_zero_is_left_open(law):
    """The printed Jacobian is 0/0 there, also where the law has a slope."""
    assert verdicts(law, "N")["program", ""] is Verdict.OPEN


@pytest.mark.parametrize("law", ["d*v/v_0*sqrt(1 + (v/v_0)**2)", "d*v/v_0*sqrt(2 - cos(v/v_0))"])
def test_a_root_that_is_never_zero_has_a_slope(law):
    assert verdicts(law, "N")["program", ""] is Verdict.PROVED


@pytest.mark.some(1)
@pytest.mark.parametrize("unit", ["N*s/m", "N", "N/(m/s)**(1/3)", "N*(m/s)**(1/2)"])
def test_another_unit_is_refuted(unit):
    assert verdicts("d*sign(v)*sqrt(abs(v))", unit)["units", "damper"] is Verdict.REFUTED


@pytest.mark.some(2)
@pytest.mark.parametrize("law", ["-d*sign(v)*sqrt(abs(v))", "d*sqrt(abs(v))", "d*sqrt(v)"])
def test_a_root_law_that_may_give_work_is_not_proved(law):
    assert verdicts(law, "N/(m/s)**(1/2)")["passive", "damper"] is not Verdict.PROVED
