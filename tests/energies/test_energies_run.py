"""Runs of stores that are no ratios, against right-hand sides by hand; proofs of their systems."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from piezo_sym import derive, simulate, verify
from piezo_sym.spec.load import parse
from piezo_sym.verification import process

from .devices import DEVICES, SPRING

#: Those who run a model and those who look at its rows need the same report.
pytestmark = pytest.mark.usefixtures("known_reports")

#: Ways to run, and how far off the end may be.
WAYS = (
    ({"rtol": 1e-9}, 1e-8),
    ({"rtol": 1e-4}, 1e-3),
    ({"step": 2.5e-4}, 5e-2),  # "play" swings with 500 rad/s at a limit
    ({"step": 1e-3, "order": 6}, 1e-3),
)
FAST = {("magnet", 0), ("gas", 0), ("stop", 0), ("hard", 0), ("bump", 0), ("gas", 2), ("stop", 2)}
CASES = [
    pytest.param(name, *way, marks=() if (name, n) in FAST else pytest.mark.long, id=f"{name}_{n}")
    for name in DEVICES
    for n, way in enumerate(WAYS)
]


def ran(name, **options):
    text, _, inputs, _ = DEVICES[name]
    return simulate(parse(text), duration=0.3, inputs=inputs, times=40, **options)


@pytest.fixture(scope="module")
def exact():
    """Return the state of a device at the end, by hand."""

    def at_end(name, start):
        rates, kinked = DEVICES[name][1], name in {"stop", "stop_by_energy", "play"}
        options = {"max_step": 2e-5, "rtol": 1e-11} if kinked else {"rtol": 1e-13}
        found = solve_ivp(rates, (0, 0.3), start, method="DOP853", atol=1e-14, **options)
        return found.y[:, -1], np.abs(found.y).max(axis=1)

    return at_end


@pytest.mark.some(1)
@pytest.mark.parametrize(("name", "way", "bound"), CASES)
def test_runs_agree_with_rates_by_hand_and_close_both_balances(name, way, bound, exact):
    run = ran(name, **way)
    states = np.array([run[word].values for word in DEVICES[name][3]])
    wanted, size = exact(name, states[:, 0])
    assert (np.abs(states[:, -1] - wanted) / size).max() <= bound
    assert float(np.abs(run.energy_residual).max()) <= 1e-12 * float(np.abs(run.energy).max())
    entropy = float(np.abs(run.entropy).max() + np.abs(run.entropy - run.entropy[0]).max())
    assert float(np.abs(run.entropy_residual).max()) <= 1e-12 * entropy


@pytest.mark.some(2)
@pytest.mark.parametrize("name", DEVICES)
def test_all_of_it_is_proved(name):
    report = process.examined(parse(DEVICES[name][0]))
    report.raise_if_not_proved()
    assert {row.id for row in report.rows} >= {"energy", "entropy", "program", "units"}


def test_a_law_or_an_energy_is_what_a_stiffness_is():
    laws = ('stiffness = "k"', 'force = "k*q"', 'energy = "k*q**2/2"')
    systems = [derive(parse(SPRING.format(name="one", law=law))) for law in laws]
    assert len({system.rhs for system in systems}) == 1
    assert len({system.U for system in systems}) == 1


def test_two_ways_to_say_a_stop_run_alike():
    one, other = ran("stop", rtol=1e-6), ran("stop_by_energy", rtol=1e-6)
    assert np.array_equal(one.q.values, other.q.values)


@pytest.mark.some(1)
@pytest.mark.parametrize(
    "energy",
    [
        "U_0*exp(S/(N*c_v))*(1 + A*q/V_0)**(-2/5) - 2*T_0*S",
        "U_0*(1 + A*q/V_0)**(-2/5) + U_0*S**2/(N*c_v)**2 + T_0*S",
    ],
)
def test_a_gas_that_is_not_warm_everywhere_is_refuted_with_a_state(energy):
    text = DEVICES["gas"][0]
    old = text[text.index('energy = "') :].splitlines()[0]
    report = verify(derive(parse(text.replace(old, f'energy = "{energy}"'))))
    (row,) = (r for r in report.rows if (r.id, r.element) == ("temperature", "gas"))
    assert row.verdict.value == "REFUTED"
    assert "S" in row.witness


SOFT = """
[model]
name = "soft"
[parameters]
m = { value = 1.0, unit = "kg" }
F_s = { value = 2.0, unit = "N" }
w = { value = 1e-4, unit = "m" }
[domain]
assume = ["w > 0"]
[initial]
q = 0.2
[elements]
mass = { kind = "mass", at = "tip", mass = "m", state = "p" }
spring = { kind = "spring", between = ["tip", "wall"], force = "F_s*tanh(q/w)", state = "q" }
"""


def test_the_energy_of_a_tanh_is_finite_far_from_rest_and_exact_near_it():
    """q = 2000 w: cosh(q/w) overflowed."""
    model = parse(SOFT)
    process.examined(model).raise_if_not_proved()
    run = simulate(model, duration=1.2, rtol=1e-6)  # through rest, to the other side
    assert run.q.values[-1] < -0.01
    z = run.q.values / 1e-4
    by_hand = run.p.values**2 / 2 + 2e-4 * (abs(z) - np.log(2) + np.log1p(np.exp(-2 * abs(z))))
    assert np.allclose(run.energy.values, by_hand, rtol=1e-14, atol=0)
    assert float(np.abs(run.energy_residual).max()) <= 1e-12 * float(run.energy.max())
    near = simulate(model, duration=1e-9, initial={"q": 1e-9}).energy.values[0]
    assert near == pytest.approx(2e-4 * (1e-5) ** 2 / 2, rel=0, abs=1e-15 * 2e-4)
