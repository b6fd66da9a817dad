"""Operating points against closed forms, and what is said where there is none."""

from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

from piezo_sym import load, operating_point, simulate, sine
from piezo_sym.errors import RunError, UsageError
from piezo_sym.spec.load import parse, starter
from tests.networks.test_acceptance import SPECS

pytestmark = pytest.mark.filterwarnings("error")


def test_the_actuator_rests_where_its_forces_balance() -> None:
    """At rest k (q - q_l) = alpha V_C + F, alpha = a T / T_0 (eq. 9), T = T_e and no current."""
    found = operating_point("piezo_stack", inputs={"V_in": 100.0, "F_ext": 3.0})
    T = 298.15
    q = (10.0 * T / 296.15 * 100.0 + 3.0) / 5e5
    assert found.initial["q"] == pytest.approx(q, rel=1e-13)
    assert found.initial["Q_C"] == pytest.approx(5e-6 * 100.0, rel=1e-13)
    assert found.temperatures == {"body": pytest.approx(T, rel=1e-13)}
    assert list(found.outputs) == ["y_load", "y_supply", "y_ambient"]
    assert found.stable
    assert found.undetermined == ("phi[1]", "phi[2]")  # they circulate within the dead zones
    shown = repr(found)
    assert shown.startswith(f"OperatingPoint(q = {q:.6g}, p = 0, Q_C = 0.0005, phi = [0, 0], S = ")
    assert "; y_load = 0, y_supply = 0, y_ambient = 298.15, " in shown  # not 1e-36, of round-off
    assert shown.endswith("; history decides: phi[1], phi[2])")
    assert np.abs(found.initial["phi"]).max() < 1e-15


@pytest.mark.some(1)
@pytest.mark.parametrize("volts", [0.0, 60.0])
def test_the_starter_rests_though_its_entropy_starts_at_zero(volts: float, tmp_path: Path) -> None:
    spec = tmp_path / "first.toml"
    spec.write_text(starter("first", "NAME"))
    found = operating_point(spec, inputs={"V_in": volts})
    assert found.initial["q"] == pytest.approx(5.0 * volts / 2e7, rel=1e-12)
    assert found.temperatures == {"body": pytest.approx(293.15, rel=1e-12)}


def test_a_held_body_says_what_heat_holds_it() -> None:
    found = operating_point("piezo_stack", inputs={"V_in": 100.0}, temperatures={"body": 400.0})
    assert found.temperatures["body"] == pytest.approx(400.0, rel=1e-14)
    assert found.initial["q"] == pytest.approx(10.0 * 400.0 / 296.15 * 100.0 / 5e5, rel=1e-13)
    assert found.holding == {"body": pytest.approx(2.0 * (400.0 - 298.15), rel=1e-12)}


def test_a_run_from_an_operating_point_stays_there() -> None:
    spec = SPECS / "two_sources_on_one_input.toml"
    found = operating_point(spec)
    run = simulate(spec, duration=10.0, initial=found.initial, times=11)
    for name, value in found.initial.items():
        assert np.abs(run[name].values - value).max() <= 1e-12 * max(1.0, abs(value))


def test_a_run_goes_to_the_operating_point() -> None:
    spec = SPECS / "two_sources_on_one_input.toml"
    found = operating_point(spec)
    run = simulate(spec, duration=3e4, times=2, rtol=1e-9)
    for name, value in found.initial.items():
        assert float(run[name][-1]) == pytest.approx(value, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("lanes", [1, 16])
def test_a_bank_has_a_value_per_lane(lanes: int) -> None:
    found = operating_point("piezo_stack", parameters={"hysteron_count": lanes})
    assert np.shape(found.initial["phi"]) == (lanes,)
    assert found.x.shape == (4 + lanes,)


@pytest.mark.parametrize(
    ("spec", "inputs", "said"),
    [
        ("a2_oscillator", {}, "rest leaves the temperature of 'body' open"),
        ("a1_two_bodies", {}, "rest leaves the temperature of 'hot' open"),
        ("series_across_a_capacitor", {}, "'Q_store' goes on and on"),
        ("resistor_across_a_source", {}, "'S' goes on and on"),
    ],
)
def test_where_there_is_none_the_reason_is_said(
    spec: str, inputs: dict[str, float], said: str
) -> None:
    with pytest.raises(RunError, match=said) as error:
        operating_point(SPECS / f"{spec}.toml", inputs=inputs)
    assert "temperatures={" in str(error.value)


def test_following_the_remedy_leads_to_a_point() -> None:
    """A2 ends at 301 K; held there it rests without any heat."""
    found = operating_point(SPECS / "a2_oscillator.toml", temperatures={"body": 301.0})
    assert found.holding["body"] == pytest.approx(0.0, abs=1e-12)
    assert found.initial["q"] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"inputs": {"V": 1.0}}, "operating_point.inputs: unknown name 'V'"),
        ({"inputs": {"V_in": "1"}}, "operating_point.inputs.V_in: ''1'' is not a finite number"),
        ({"temperatures": {"T": 300.0}}, "operating_point.temperatures: unknown name 'T'"),
        ({"temperatures": {"body": -1.0}}, "operating_point.temperatures.body: -1.0 is not pos"),
    ],
)
def test_wrong_arguments_are_named(given: dict[str, object], said: str) -> None:
    with pytest.raises(UsageError) as error:
        operating_point(load("piezo_stack"), **given)
    assert str(error.value).startswith(said.replace("''", "'"))


def test_inputs_outside_the_domain_are_refused() -> None:
    with pytest.raises(RunError, match=r"outside the domain.* 'T_e > T_0' has margin -6\.15"):
        operating_point("piezo_stack", inputs={"T_e": 290.0})


PRESS = """
[model]
name = "press"
[parameters]
A = { value = 80, unit = "cm**2" }
m = { value = 120, unit = "kg" }
d = { value = 2000, unit = "N*s/m" }
k = { value = 5, unit = "N/mm" }
C_h = { value = 2e-13, unit = "m**3/Pa" }
K_l = { value = 3e-10, unit = "m**3/s/Pa" }
T_0 = { value = 293, unit = "K" }
c = { value = 30, unit = "kJ/K" }
lam = { value = 20, unit = "W/K" }
k_e = { value = 2e5, unit = "N/mm" }
gap = { value = 50, unit = "mm" }
[inputs]
p_s = { unit = "bar" }
T_e = { unit = "K", default = 293 }
[domain]
assume = ["d >= 0", "K_l >= 0", "lam >= 0", "T_e > 0"]
[elements]
pump = { kind = "pressure_source", between = ["p", "tank"], input = "p_s" }
valve = { kind = "orifice", between = ["p", "cyl"], flow = "K_l*dp", heats = "oil" }
volume = { kind = "accumulator", between = ["cyl", "tank"], capacitance = "C_h", state = "V" }
seal = { kind = "damper", between = ["ram", "wall"], force = "d*v", heats = "oil" }
spring = { kind = "spring", between = ["ram", "wall"], stiffness = "k", state = "x" }
bump = { kind = "spring", between = ["ram", "wall"], force = "k_e*max(q - gap, 0)", state = "x_e" }
mass = { kind = "mass", at = "ram", mass = "m", state = "p" }
oil = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
air = { kind = "ambient", body = "oil", conductance = "lam", input = "T_e" }
[elements.ram]
kind = "cylinder"
hydraulic = ["cyl", "tank"]
translation = ["ram", "wall"]
area = "A"
"""


@pytest.mark.some(3)
@pytest.mark.parametrize("pressure", [1e4, 1e5, 1e6])
@pytest.mark.parametrize("start", [0.0, 1e-3])
def test_springs_in_parallel_keep_their_difference(pressure: float, start: float) -> None:
    """A p = k x + k_e max(x_e - gap, 0) with x_e - x as at the start; V is 10 million times less.

    The slowest motion, a minute, is 10 million times as slow as the fastest.
    """
    A, k, k_e, gap = 80e-4, 5e3, 2e8, 50e-3
    found = operating_point(
        parse(PRESS), inputs={"p_s": pressure}, initial={"x_e": start, "x": 0.0}
    )
    free, touching = A * pressure / k, (A * pressure + k_e * (gap - start)) / (k + k_e)
    x = free if free + start < gap else touching
    assert found.initial["x"] == pytest.approx(x, rel=1e-12)
    assert found.initial["x_e"] == pytest.approx(x + start, rel=1e-12)
    assert found.initial["V"] == pytest.approx(2e-13 * pressure, rel=1e-12)
    assert (found.undetermined, found.stable) == ((), True)


LINEAR = """
[model]
name = "block"
[parameters]
T_0 = { value = 300, unit = "K" }
b = { value = 3, unit = "K**2/J" }
lam = { value = 2, unit = "W/K" }
[inputs]
T_e = { unit = "K", default = 293 }
[domain]
assume = ["T_e > 0", "lam >= 0", "T > 0", "b > 0"]
[elements]
block = { kind = "thermal_mass", temperature = "T_0 + b*S", state = "S" }
air = { kind = "ambient", body = "block", conductance = "lam", input = "T_e" }
"""


def test_a_body_is_held_at_a_temperature_beyond_twice_its_start() -> None:
    """The search for S = (T - T_0)/b passes entropies at which the law is below 0 K."""
    found = operating_point(parse(LINEAR), temperatures={"block": 900.0})
    assert found.initial["S"] == pytest.approx(200.0, rel=1e-13)


def test_a_way_out_of_the_domain_names_the_condition() -> None:
    """The body cools to 240 K, below the least temperature of the domain."""
    spec = LINEAR.replace('"T > 0"', '"T > 0", "T > T_m"')
    spec = spec.replace("[inputs]", 'T_m = { value = 250, unit = "K" }\n[inputs]')
    with pytest.raises(RunError) as error:
        operating_point(parse(spec), inputs={"T_e": 240.0})
    said = (
        "no state of rest is found: the way there leaves the domain, condition 'T > T_m' has margin"
    )
    assert said in str(error.value)
    assert "T_m = 250 K); expected T > T_m; change the inputs" in str(error.value)


CUSHION = """
[model]
name = "cushion"
[parameters]
k = { value = 4e7, unit = "N/m" }
m = { value = 0.2, unit = "kg" }
d = { value = 150.0, unit = "N*s/m" }
k_z = { value = [2e6, 5e5], unit = "N/m" }
F_z = { value = [5.0, 30.0], unit = "N" }
A = { value = 3.0, unit = "cm**2" }
p_0 = { value = 2.0, unit = "bar" }
V_0 = { value = 5.0, unit = "cm**3" }
T_0 = { value = 298.15, unit = "K" }
ga = { value = 1.4, unit = "1" }
c = { value = 20.0, unit = "J/K" }
lam = { value = 0.2, unit = "W/K" }
[inputs]
F = { unit = "N" }
T_e = { unit = "K", default = 298.15 }
[domain]
assume = ["d >= 0", "ga > 1", "p_0 > 0", "V_0 > 0", "T_0 > 0", "W < V_0", "F_z >= 0", "lam >= 0", "T_e > 0"]
[initial]
S = "c*log(T_e/T_0)"
[elements]
tip = { kind = "mass", at = "tip", mass = "m", state = "p" }
flexure = { kind = "spring", between = ["tip", "wall"], stiffness = "k", state = "q" }
friction = { kind = "damper", between = ["tip", "wall"], force = "d*v", heats = "body" }
load = { kind = "force_source", at = "tip", input = "F" }
stops = { kind = "stop", between = ["tip", "wall"], count = 2, stiffness = "k_z", limit = "F_z", heats = "body", state = "z" }
piston = { kind = "cylinder", hydraulic = ["oil", "tank"], translation = ["tip", "wall"], area = "A" }
film = { kind = "conduction", between = ["gas", "body"], conductance = "lam" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
air = { kind = "ambient", body = "body", conductance = "lam", input = "T_e" }
[elements.gas]
kind = "storage"
energy = "p_0*V_0/(ga - 1)*((1 - W/V_0)**(1 - ga)*exp(S_g*(ga - 1)*T_0/(p_0*V_0)) - 1) - p_0*W"
states = { W = { rate = "flow", between = ["oil", "tank"] }, S_g = { rate = "entropy" } }
"""  # noqa: E501


def test_a_stop_that_slipped_leaves_the_place_open_but_no_temperature() -> None:
    """Gas that is compressed more holds less entropy at the temperature of its surroundings."""
    found = operating_point(parse(CUSHION), inputs={"F": 500.0})
    assert found.temperatures == {
        "gas": pytest.approx(298.15, rel=1e-12),
        "body": pytest.approx(298.15, rel=1e-12),
    }
    assert abs(found.initial["z"][0]) <= 5.0 / 2e6
    assert {"q", "z[1]", "S_g"} <= {*found.undetermined}
    assert "S" not in found.undetermined


@pytest.mark.some(1)
@pytest.mark.parametrize("volts", [50.0, 100.0, 120.0, 150.0])
def test_stops_rest_within_their_limits(volts: float) -> None:
    """Long steps of the search, which is alone with a body held, moved them beyond."""
    held = {"body": 296.15}
    found = operating_point("stack_maxwell", inputs={"V_in": volts}, temperatures=held)
    p = load("stack_maxwell").parameters
    k, k_s, r = (np.array(p[name].si) for name in ("k", "k_s", "r"))
    z, q = np.array(found.initial["z"]), float(found.initial["q"])
    assert np.all(np.abs(z) <= r * (1 + 1e-12))
    yields = np.abs(z) > r * (1 - 1e-9)
    assert yields.any()
    assert np.allclose(z[~yields], q, rtol=1e-9)
    assert float(k * q + (k_s * z).sum()) == pytest.approx(float(p["a"].si) * volts, rel=1e-9)
    run = simulate("stack_maxwell", inputs={"V_in": volts}, initial=found.initial, duration=1e-2)
    assert float(np.abs(run.q - q).max()) <= 1e-9 * q


SOFTENING = Path(__file__).parent / "specs" / "warm_softening.toml"


def test_a_store_whose_temperature_depends_on_its_position_is_held_at_a_temperature() -> None:
    """U = k (1 - b (h - T_0)) q**2/2 + c h with h = T_0 exp(S/c): F = k (1 - b (h - T_0)) q = 1."""
    k, b, d, T_0, c, lam, T = 4.0, 1e-3, 0.4, 300.0, 2.0, 0.1, 340.0

    def position(h: float) -> float:
        return float(1 / (k * (1 - b * (h - T_0))))

    def ratio(h: float) -> float:  # of temperature and h
        return float(1 - k * b * position(h) ** 2 / (2 * c))

    h = float(brentq(lambda h: h * ratio(h) - T, 300, 400, xtol=1e-12))
    q = position(h)
    found = operating_point(SOFTENING, temperatures={"body": T})
    assert found.temperatures["body"] == pytest.approx(T, rel=1e-13)
    assert found.initial["q"] == pytest.approx(q, rel=1e-12)
    assert found.initial["S"] == pytest.approx(c * np.log(h / T_0), rel=1e-11)
    assert found.holding["body"] == pytest.approx(lam * (T - T_0), rel=1e-12)
    # the stiffness at this temperature: h changes with q
    stiffness = k * (1 - b * (h - T_0)) - k * b * q * (h * k * b * q / c / ratio(h))
    assert found.eigenvalues[0].real == pytest.approx(-d / 2, rel=1e-6)
    assert abs(found.eigenvalues[0]) ** 2 == pytest.approx(stiffness, rel=1e-6)


def test_what_is_held_has_no_open_temperature_where_history_decides(tmp_path: Path) -> None:
    text = SOFTENING.read_text().replace("warm_softening", "warm_hysteretic")
    text = text.replace("[inputs]", 'f_b = { value = 0.2, unit = "N" }\n[inputs]')
    text = text.replace("assume = [", 'assume = ["f_b > 0", ')
    spring = 'k2 = { kind = "spring", between = ["tip", "wall"], stiffness = "k", state = "z", '
    spring += 'slip = "(0.6*abs(v)*sign(f) + 0.4*v)*abs(f/f_b)", heats = "body" }'
    (tmp_path / "held.toml").write_text(text.replace("[elements]", f"[elements]\n{spring}"))
    found = operating_point(tmp_path / "held.toml", temperatures={"body": 340.0})
    assert found.temperatures["body"] == pytest.approx(340, rel=1e-13)
    assert {"z", "q"} <= {*found.undetermined}


SMALL = Path(__file__).parent / "specs" / "small_stage.toml"


@pytest.mark.parametrize("c", [1e-4, 1e-7, 1e-8])
def test_however_small_the_capacity_the_stiffness_is_that_at_constant_temperature(c: float) -> None:
    """U = k q**2/2 + c h (1 + al q/g): T = h (1 + al q/g), F = k q + c h al/g."""
    k, g, m, T, ratio = 1e6, 1e-6, 1e-6, 310.0, float(np.sqrt(c / 1e-7))
    al = 0.1 / ratio
    options = {"parameters": {"c": c, "al": al}, "inputs": {"F": 8.0 * ratio}}
    found = operating_point(SMALL, temperatures={"body": T}, **options)
    q = found.initial["q"]
    assert found.temperatures["body"] == pytest.approx(T, rel=1e-12)
    slope = al / g / (1 + al * q / g)
    stiffness = k - c * T * slope**2
    assert abs(found.eigenvalues[0]) ** 2 * m == pytest.approx(stiffness, rel=1e-6)


def test_the_greatest_temperature_at_rest_is_approached_and_not_passed() -> None:
    """With b = 0.02/K no state of rest is warmer than 330.76963 K."""
    soft = {"b": 0.02}
    found = operating_point(SOFTENING, parameters=soft, temperatures={"body": 330.7686})
    assert found.temperatures["body"] == pytest.approx(330.7686, rel=1e-11)
    for T in (330.7697, 330.8):
        with pytest.raises(RunError, match="no state of rest is found"):
            operating_point(SOFTENING, parameters=soft, temperatures={"body": T})


def test_an_input_that_varies_is_told_what_there_is_for_it() -> None:
    with pytest.raises(UsageError, match="varies in time; expected a constant; for a period: per"):
        operating_point("piezo_stack", inputs={"V_in": sine(100.0, 50.0)})


def test_creep_by_a_power_of_the_force_rests_though_it_never_quite_does() -> None:
    """z' = vb (f/Fb)**3 decays as the root of time: at rest f = 0, and the spring has the load."""
    spec = Path(__file__).parent / "specs" / "creep_of_third_power.toml"
    found = operating_point(spec, inputs={"F": 1.0})
    assert found.initial["q"] == pytest.approx(1.0 / 1e3, rel=1e-6)
    assert abs(found.initial["z"]) < 1e-6 * found.initial["q"]
