"""Creep of banks of viscoelastic cells over three decades, against closed forms.

A chain of Kelvin-Voigt cells stretches under a constant force F by sums of F/k (1 - exp(-t k/d)).
Where times d/k lie evenly over decades, that is a straight line over the logarithm of time.  Cells
of Maxwell side by side with a spring and a damper are one linear system, solved by eigenvalues.
"""

import numpy as np
import pytest

from piezo_sym import derive, simulate
from piezo_sym.errors import NetworkError
from piezo_sym.proofs import Verdict
from piezo_sym.spec.load import parse
from piezo_sym.verification import process

#: Those who run a model and those who look at its rows need the same report.
pytestmark = pytest.mark.usefixtures("known_reports")

PER_DECADE = 2
TIMES = np.logspace(0, 3, 31)
FORCE, STIFFNESS = 3.0, 40.0
RELAXATION = np.logspace(-3, 6, 9 * PER_DECADE + 1)
SPEC = """
[model]
name = "creep"
[parameters]
k   = {{ value = {k}, unit = "N/m" }}
d   = {{ value = {d}, unit = "N*s/m" }}
k_c = {{ value = {k}, unit = "N/m" }}
d_c = {{ value = {d_c}, unit = "N*s/m" }}
T_0 = {{ value = 300.0, unit = "K" }}
c   = {{ value = 2.0, unit = "J/K" }}
[domain]
assume = ["d > 0", "d_c > 0"]
[inputs]
F = {{ unit = "N", default = {F} }}
[elements]
load = {{ kind = "force_source", at = "tip", input = "F" }}
body = {{ kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }}
{more}
"""
KELVIN_VOIGT = """
[banks.ladder]
count = {count}
series = ["tip", "wall"]
[banks.ladder.elements]
spring = {{ kind = "spring", between = ["tip", "wall"], stiffness = "k_c", state = "q_c" }}
damper = {{ kind = "damper", between = ["tip", "wall"], force = "d_c*v", heats = "body" }}
"""
MAXWELL = """
spring = {{ kind = "spring", between = ["tip", "wall"], stiffness = "k", state = "q" }}
damper = {{ kind = "damper", between = ["tip", "wall"], force = "d*v", heats = "body" }}
[banks.cells]
count = {count}
[banks.cells.elements]
spring = {{ kind = "spring", between = ["tip", "inside"], stiffness = "k_c", state = "q_c" }}
damper = {{ kind = "damper", between = ["inside", "wall"], force = "d_c*v", heats = "body" }}
"""


def model(cells):
    """Return the model with a bank of cells that have the relaxation times."""
    more = cells.format(count=len(RELAXATION))
    d_c = (STIFFNESS * RELAXATION).tolist()
    text = SPEC.format(k=STIFFNESS, d=0.4, d_c=d_c, F=FORCE, more=more)
    unused = [] if cells is MAXWELL else ["k ", "d "]
    lines = [line for line in text.splitlines() if line[:2] not in unused]
    return parse("\n".join(lines).replace('"d > 0", ' if unused else "\0", ""))


def crept(model, of):
    """Return how far the state, or all lanes of it together, has gone by `TIMES`."""
    run = simulate(model, duration=TIMES[-1], times=np.array([0.0, *TIMES]), rtol=1e-9)
    found = run[of].sum([d for d in run[of].dims if d != "time"]).values
    assert abs(run["energy_residual"]).max() <= 1e-14 * run["energy"].max()
    return found[1:]


def test_a_ladder_creeps_by_the_logarithm_of_time():
    found = crept(model(KELVIN_VOIGT), "q_c")
    own = 1 - np.exp(-TIMES[:, None] / RELAXATION)
    assert np.allclose(found, FORCE / STIFFNESS * own.sum(axis=1), rtol=1e-7)
    decades = np.diff(found[::10])
    assert np.allclose(decades, PER_DECADE * FORCE / STIFFNESS, rtol=2e-3)


def test_cells_of_maxwell_creep_as_their_eigenvalues_say():
    count = len(RELAXATION)
    pull = np.full(count + 1, STIFFNESS)
    rates = np.diag([0.0, *(-1 / RELAXATION)]) - np.outer(np.ones(count + 1), pull) / 0.4
    rest = np.linalg.solve(rates, np.full(count + 1, -FORCE / 0.4))
    eigenvalues, vectors = np.linalg.eig(rates)
    shares = np.linalg.solve(vectors, -rest)
    wanted = rest[0] + (vectors[0] * shares * np.exp(TIMES[:, None] * eigenvalues)).sum(axis=1)
    assert np.allclose(crept(model(MAXWELL), "q"), wanted.real, rtol=1e-6)


@pytest.mark.parametrize("cells", [KELVIN_VOIGT, MAXWELL], ids=["ladder", "cells"])
def test_creep_is_proved_for_any_number_of_cells(cells):
    report = process.examined(model(cells))
    assert {row.verdict for row in report.rows if row.required} == {Verdict.PROVED}


@pytest.mark.parametrize(
    ("beside", "said"),
    [
        (
            'oil = { kind = "damper", between = ["tip", "wall"], force = "d*v", heats = "body" }',
            "connect 'oil' to another node than 'tip': cells in series follow the force",
        ),
        (
            'grip = { kind = "stop", between = ["tip", "wall"], stiffness = "k", limit = "F_c",'
            ' heats = "body", state = "z" }\n[parameters.F_c]\nvalue = 1.0\nunit = "N"',
            "connect 'grip' to another node than 'tip': cells in series follow the force",
        ),
        (
            'head = { kind = "mass", at = "tip", mass = "m", state = "p" }\n'
            '[parameters.m]\nvalue = 1.0\nunit = "kg"',
            "put a spring between them",
        ),
    ],
)
def test_what_a_chain_cannot_bear_at_its_end_is_told_where_to_go(beside, said):
    """A mass was advised in the first two cases, which the third refuses."""
    more = beside + "\n" + KELVIN_VOIGT.format(count=3)
    text = SPEC.format(k=4.0, d=1.0, d_c=1.0, F=1.0, more=more)
    with pytest.raises(NetworkError, match=said):
        derive(parse(text))
