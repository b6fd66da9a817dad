"""Springs that are odd in their length: the energy is a function of its magnitude."""

import subprocess
import sys
from math import exp, sqrt

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import quad, solve_ivp

from piezo_sym import derive, simulate, verify
from piezo_sym.proofs import Verdict
from piezo_sym.spec.load import parse
from tests.checker.stated import refused, stated

TEXT = """
[model]
name = "odd"
[parameters]
M = { value = 2.0, unit = "kg" }
k = { value = 5.0, unit = "N/m" }
r = { value = 0.3, unit = "m" }
[domain]
assume = ["M > 0", "k > 0", "r > 0"]
[initial]
q = 0.4
[elements]
spring = { kind = "spring", between = ["a", "wall"], force = "LAW", state = "q" }
mass = { kind = "mass", at = "a", mass = "M", state = "p" }
"""
k, r = 5.0, 0.3
#: Each law, and its force by hand where q > 0.
LAWS = {
    "k*q/(1 + abs(q)/r)": lambda q: k * q / (1 + q / r),
    "k*q/(1 + abs(q/r))": lambda q: k * q / (1 + q / r),
    "k*q*exp(-abs(q)/r)": lambda q: k * q * exp(-q / r),
    "k*q*sqrt(1 + abs(q)/r)": lambda q: k * q * sqrt(1 + q / r),
}


def force(law, q):
    return np.sign(q) * LAWS[law](abs(q))


@pytest.mark.some(1)
@pytest.mark.parametrize("law", LAWS)
def test_it_is_proved_and_has_the_energy_of_quadrature(law):
    text = TEXT.replace("LAW", law)
    iphs = derive(parse(text))
    assert {row.verdict for row in verify(iphs).rows} == {Verdict.PROVED}
    assert not refused(text, stated(text))
    values = {"M": 2.0, "k": k, "r": r, "p": 0.0}
    U = sp.lambdify(
        "q", iphs.U.subs({s: values[s.name] for s in iphs.U.free_symbols if s.name != "q"})
    )
    for q in (-0.9, -0.2, 0.1, 0.6):
        assert U(q) - U(0.0) == pytest.approx(quad(lambda z: force(law, z), 0, q)[0], rel=1e-9)


BUSY = """
import time
from piezo_sym.algebra import integrals
integrals.SECONDS, find = 1, integrals._antiderivative
integrals._antiderivative = lambda *request: time.sleep(1.2) or find(*request)
integrals.main()
"""


def test_what_a_busy_machine_does_to_the_search_does_not_decide_what_has_an_energy():
    """It is given processor time: sleep stands for a search that gets none for a while."""
    command, request = [sys.executable, "-c", BUSY], '["2*q", "q", []]'
    done = subprocess.run(command, input=request, capture_output=True, text=True, check=True)
    assert done.stdout == "q**2\n"


@pytest.mark.some(1)
@pytest.mark.parametrize("law", LAWS)
def test_it_swings_as_its_equation_typed_by_hand(law):
    run = simulate(parse(TEXT.replace("LAW", law)), duration=4.0, rtol=1e-9, times=[0.0, 4.0])
    options = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-14, "max_step": 1e-2}
    exact = solve_ivp(lambda _, x: (x[1] / 2.0, -force(law, x[0])), (0, 4.0), [0.4, 0.0], **options)
    assert np.array([run.q[-1], run.p[-1]]) == pytest.approx(exact.y[:, -1], abs=1e-8)
    assert abs(float(run.energy_residual[-1])) < 1e-13
