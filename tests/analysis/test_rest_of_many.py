"""Where stops or slipping stores leave many states of rest, a run decides between them."""

import numpy as np
import pytest

from piezo_sym import linearize, operating_point, ramp, simulate
from piezo_sym.spec.load import parse

pytestmark = pytest.mark.filterwarnings("error")

#: A stop beside a spring: it yields at z = F_c/k_s, and what an overshoot slips stays.
STOP = """
[model]
name = "jenkins"
[parameters]
m = { value = 1.0, unit = "kg" }
k = { value = 100.0, unit = "N/m" }
k_s = { value = 100.0, unit = "N/m" }
F_c = { value = 5.0, unit = "N" }
d = { value = 2.0, unit = "N*s/m" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 10.0, unit = "J/K" }
lam = { value = 1.0, unit = "W/K" }
[inputs]
F = { unit = "N" }
T_e = { unit = "K", default = 300.0 }
[domain]
assume = ["d >= 0", "lam >= 0", "T_e > 0"]
[elements]
spring = { kind = "spring", between = ["tip", "wall"], stiffness = "k", state = "q" }
mass = { kind = "mass", at = "tip", mass = "m", state = "p" }
damp = { kind = "damper", between = ["tip", "wall"], force = "d*v", heats = "body" }
friction = { kind = "stop", between = ["tip", "wall"], stiffness = "k_s", limit = "F_c", heats = "body", state = "z" }
push = { kind = "force_source", at = "tip", input = "F" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
air = { kind = "ambient", body = "body", conductance = "lam", input = "T_e" }
"""  # noqa: E501


def test_rest_is_where_a_run_ends_whose_overshoot_slips() -> None:
    """The search's own motion, which is damped, ended at q = 60 mm, 12 mm short of the run."""
    spec = parse(STOP)
    found = operating_point(spec, inputs={"F": 11.0})
    run = simulate(spec, inputs={"F": 11.0}, duration=200.0, times=2, rtol=1e-9)
    for name in ("q", "z"):
        assert found.initial[name] == pytest.approx(float(run[name][-1]), rel=1e-6)
    assert abs(found.initial["z"] - 0.05) > 1e-3
    assert 0 < found.after < 100
    assert "one rest of many: where a run from the initial state rests, settled after" in repr(
        found
    )
    assert {"q", "z"} <= {*found.undetermined}


def test_the_end_of_a_slow_ramp_is_its_own_rest() -> None:
    """k q + F_c = F there; the step response rests elsewhere, and both are states of rest."""
    spec = parse(STOP)
    slow = simulate(spec, inputs={"F": ramp(0, 50, 0, 11)}, duration=120.0, times=2, rtol=1e-8)
    start = {name: slow[name].values[-1] for name in ("q", "p", "z", "S")}
    found = operating_point(spec, inputs={"F": 11.0}, initial=start)
    assert found.initial["q"] == pytest.approx((11.0 - 5.0) / 100.0, rel=5e-3)
    assert found.initial["q"] == pytest.approx(float(slow.q[-1]), rel=1e-6)
    assert found.after == 0
    assert operating_point(spec, inputs={"F": 11.0}).initial["q"] > 1.02 * found.initial["q"]


def test_a_store_that_slips_rests_where_a_run_ends() -> None:
    """Bouc-Wen: the search alone was off by 7 % in q, by 190 % in the charge that slips."""
    found = operating_point("stack_bouc_wen", inputs={"V_in": 100.0})
    run = simulate("stack_bouc_wen", inputs={"V_in": 100.0}, duration=50.0, times=2, rtol=1e-8)
    for name in ("q", "Q", "Q_h"):
        assert found.initial[name] == pytest.approx(float(run[name][-1]), rel=1e-4)


def test_no_run_holds_a_body_and_the_result_says_so() -> None:
    found = operating_point(parse(STOP), inputs={"F": 11.0}, temperatures={"body": 320.0})
    assert np.isnan(found.after)
    assert "one rest of many: as no run of 'initial' decides, a near one" in repr(found)


def test_the_only_rest_needs_no_run() -> None:
    found = operating_point("voice_coil", inputs={})
    assert found.after == 0
    assert "rest of many" not in repr(found)


def test_a_linear_model_says_which_stops_stick() -> None:
    """Beyond its limit, in motion, the stop yields; at rest below it, it adds its stiffness."""
    spec = parse(STOP)
    rest = linearize(spec, at=operating_point(spec, inputs={"F": 4.0}))
    moving = linearize(spec, at={"q": 0.08, "z": 0.05, "p": 0.1}, inputs={"F": 11.0})
    assert (rest.sticking, rest.yielding) == (("z",), ())
    assert (moving.sticking, moving.yielding) == ((), ("z",))
    assert repr(rest).endswith("; stops stick: z)")
    assert repr(moving).endswith("; stops yield: z)")
    assert "stops" not in repr(linearize("piezo_stack"))
