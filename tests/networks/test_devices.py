"""Shipped devices, each against a closed form or a published number."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from piezo_sym import Model, PiezoError, derive, linearize, load, operating_point, simulate, sine
from piezo_sym.proofs import obligations


def value(model, *names):
    return tuple(load(model).parameters[name].value for name in names)


def test_heat_exchanger_as_its_temperatures_decay():
    run = simulate("heat_exchanger", duration=12.0, rtol=1e-9, times=np.linspace(0, 12, 25))
    gap = 60 * np.exp(-0.5 * (1 / 2 + 1 / 3) * run.time)
    assert np.allclose(run.T_hot, 314 + 3 / 5 * gap, atol=1e-6)
    assert np.allclose(run.T_cold, 314 - 2 / 5 * gap, atol=1e-6)


def test_oscillator_decays_and_its_energy_ends_as_heat():
    run = simulate("oscillator", duration=100.0, rtol=1e-9, times=np.linspace(0, 100, 101))
    d, w = 0.2, np.sqrt(4 - 0.2**2)
    exact = np.exp(-d * run.time) * (np.cos(w * run.time) + d / w * np.sin(w * run.time))
    assert np.allclose(run.q, exact, atol=1e-6)
    assert float(run.T_body[-1]) == pytest.approx(301.0, abs=1e-6)


def test_thermistor_ends_at_400_kelvin():
    run = simulate("thermistor", duration=0.1, rtol=1e-7, times=[0.0, 0.1])
    assert float(run.T_body[-1]) == pytest.approx(400.0, rel=1e-7)


def impedance(frequency):
    """Return the impedance of the voice coil as its linearization has it, and as a formula has."""
    R, L, B, m, k, d = value("voice_coil", "R_0", "L", "Bl", "m", "k", "d")
    A, B_u, C, _ = (np.asarray(part) for part in linearize("voice_coil"))
    names = [*load("voice_coil").inputs]
    outputs = 1  # ports follow their inputs; the amplifier's is the first
    s = 2j * np.pi * frequency
    admittance = C[:outputs] @ np.linalg.solve(s * np.eye(len(A)) - A, B_u)
    formula = R + s * L + B**2 / (d + s * m + k / s)
    return 1 / admittance[0, names.index("V_in")], formula


@pytest.mark.parametrize("frequency", [5.0, 44.6, 300.0, 5e3])
def test_impedance_of_the_voice_coil_is_that_of_small(frequency):
    found, formula = impedance(frequency)
    assert found == pytest.approx(formula, rel=1e-6)


def test_cold_motor_turns_as_the_tutorial_says():
    given = {"al": 0.0, "n": 1.0, "J_l": 1e-9}
    run = simulate("dc_motor", inputs={"V_in": 1.0}, duration=8.0, rtol=1e-8, parameters=given)
    assert float(run.H[-1]) / 0.01 == pytest.approx(0.01 / (0.01**2 + 1.0 * 0.1), rel=1e-4)


def test_electromagnet_holds_its_armature_and_snaps_shut_beyond_a_third_of_the_gap():
    g, A, N, mu, k, R = value("electromagnet", "g", "A", "N", "mu", "k", "R")
    strongest = np.sqrt(8 * k * g**3 / (27 * mu * A * N**2))
    current = 0.9 * strongest
    rest = operating_point("electromagnet", inputs={"V_in": current * R})
    x = brentq(
        lambda x: k * x * (g + x) ** 2 + mu * A * N**2 * current**2 / 2, -g / 3, 0, xtol=1e-15
    )
    assert rest.initial["x"] == pytest.approx(x, rel=1e-6)
    assert rest.initial["phi"] == pytest.approx(mu * A * N**2 * current / (g + x), rel=1e-6)


def test_piston_has_the_period_of_ruechhardt():
    m, A, V, N, c_v, R, T = value("gas_piston", "m", "A", "V_0", "N", "c_v", "R", "T_0")
    gamma, p = 1 + R / c_v, N * R * T / V
    period = 2 * np.pi * np.sqrt(m * V / (gamma * p * A**2))
    run = simulate(
        "gas_piston",
        inputs={"F": -p * A},
        duration=3 * period,
        times=np.linspace(0, 3 * period, 3001),
        parameters={"lam": 0.0, "d": 0.0},
        initial={"q": 1e-3},
        rtol=1e-9,
    )
    up = np.flatnonzero(np.diff(np.sign(run.p.values)) < 0)
    found = np.diff(run.time.values[up]).mean()
    assert found == pytest.approx(period, rel=2e-3)


def test_cylinder_presses_and_moves_as_merritt_says():
    C_d, a, rho, A, d = value("hydraulic_cylinder", "C_d", "a", "rho", "A", "d")
    given = {"p_in": 1e7, "F": -4000.0}
    far = {"x_s": 10.0}
    run = simulate("hydraulic_cylinder", inputs=given, duration=8.0, rtol=1e-7, parameters=far)
    speed = float(run.p[-1]) / 50.0
    flow = brentq(
        lambda v: v * A - C_d * a * np.sqrt(2 / rho * (1e7 - (4000 + d * v) / A)), 0, 1, xtol=1e-14
    )
    assert speed == pytest.approx(flow, rel=1e-5)
    resting = simulate("hydraulic_cylinder", inputs=given, duration=20.0, rtol=1e-6)
    assert float(resting.q[-1]) == pytest.approx(0.05 + (1e7 * A - 4000) / 1e7, rel=1e-4)


def fill(x, y):
    """Return the part of its box that a closed loop fills."""
    area = abs(np.sum(np.roll(x, -1) * y - np.roll(y, -1) * x)) / 2
    return area / (np.ptp(x) * np.ptp(y))


@pytest.mark.some(1)
@pytest.mark.parametrize("frequency", [1.0, 20.0])
def test_loop_of_the_stack_is_that_of_a_measured_one_at_any_rate(frequency):
    drive = {"V_in": lambda t: 150 * np.sin(np.pi * frequency * t) ** 2}
    times = np.linspace(1, 3, 2001) / frequency
    run = simulate("stack_bouc_wen", inputs=drive, duration=3 / frequency, rtol=1e-6, times=times)
    x, V = (values[1000:2000] for values in (run.q.values, run.V_in.values))
    assert np.ptp(x) == pytest.approx(40.4e-6, rel=5e-3)
    assert fill(V, x) == pytest.approx(0.1054, abs=4e-3)
    assert x[0] == pytest.approx(run.q.values[0], rel=1e-4)  # it closes from the first period on


def test_stack_runs_as_a_hand_written_right_hand_side():
    names = ("m", "k", "d", "a", "C", "C_h", "V_h", "beta", "gam", "R", "c_0", "lam", "T_0")
    m, k, d, a, C, C_h, V_h, beta, gam, R, c_0, lam, T_0 = value("stack_bouc_wen", *names)

    def rates(t, x):
        q, p, Q, Q_h, S = x
        v, V, W, T = p / m, Q / C, Q_h / C_h, T_0 * np.exp(S / c_0)
        i = (150 * np.sin(2 * np.pi * 200 * t) - V - W) / R
        slip = (beta * abs(i) * np.sign(W) + gam * i) * abs(W / V_h)
        heat = R * i**2 + W * slip + d * v**2
        return v, a * V - k * q - d * v, i - a * v, i - slip, heat / T + lam * (300.0 / T - 1)

    times, signal = np.linspace(0, 0.01, 101), {"V_in": sine(150, 200), "T_e": 300.0}
    run = simulate("stack_bouc_wen", inputs=signal, duration=0.01, rtol=1e-9, times=times)
    short = {"rtol": 1e-12, "atol": 1e-16, "max_step": 2e-6}
    exact = solve_ivp(rates, (0, 0.01), [0.0] * 5, "DOP853", times, **short).y
    for name, values in zip(("q", "p", "Q", "Q_h", "S"), exact, strict=True):
        assert np.max(abs(run[name] - values)) < 1e-7 * np.max(abs(values)), name
    assert np.abs(run.energy_residual).max() < 1e-12
    slips = run.produced_hysteresis.values
    assert np.all(np.diff(slips) >= 0)


def cooler():
    """Return s, R, lam, c_c, c_h, T_0 of the Peltier cooler."""
    return value("peltier_cooler", "s", "R", "lam", "c_c", "c_h", "T_0")


def test_peltier_cooler_is_as_cold_as_ioffe_says_it_can_be():
    (s, R, lam, c_c, _, T_0), hot = cooler(), 320.0
    cold = brentq(lambda T: hot - T - s**2 / (R * lam) * T**2 / 2, 100.0, hot, xtol=1e-12)
    current = s * cold / R
    found = []
    for i in (0.9 * current, current, 1.1 * current):
        T = (lam * hot + R * i**2 / 2) / (lam + s * i)  # where the plate gains no heat
        rest = operating_point(
            "peltier_cooler",
            inputs={"V_in": R * i + s * (hot - T), "T_e": hot},
            parameters={"h": 1e7},
        )
        found.append(T_0 * np.exp(rest.initial["S_c"] / c_c))
        assert found[-1] == pytest.approx(T, rel=1e-7)
    assert found[1] == pytest.approx(cold, rel=1e-7)
    assert found[1] < min(found[0], found[2])


def test_peltier_cooler_runs_as_a_hand_written_right_hand_side():
    s, R, lam, c_c, c_h, T_0 = cooler()
    L, h, V, P, T_e = 1e-3, 50.0, 12.0, 3.0, 300.0

    def rates(_, x):
        i, T_c, T_h = x
        through, joule = lam * (T_h - T_c), R * i**2 / 2
        cold = joule + through + P - s * T_c * i
        warm = joule - through + s * T_h * i + h * (T_e - T_h)
        return (V - R * i - s * (T_h - T_c)) / L, cold / c_c, warm / c_h

    times = np.linspace(0.0, 5.0, 11)
    wanted = solve_ivp(
        rates, (0, 5), (0.0, T_0, T_0), "Radau", t_eval=times, rtol=1e-10, atol=1e-10
    ).y
    inputs = {"V_in": V, "P": P, "T_e": T_e}
    run = simulate("peltier_cooler", inputs=inputs, duration=5.0, rtol=1e-8, times=times)
    for found, exact in zip((run.phi / L, run.T_plate, run.T_sink), wanted, strict=True):
        assert np.allclose(found, exact, rtol=1e-6)
    assert np.abs(run.energy_residual).max() < 1e-12 * float(run.energy.max()) + 1e-9
    entropies = run.S_c + run.S_h
    brought = run.entropy_exchanged_load + run.entropy_exchanged_air
    made = run.produced_warm + run.produced_cool + run.produced_legs
    assert np.abs(entropies - made - brought).max() < 1e-11


def changed(couples=None, wire=None):
    """Return the Peltier cooler with a floor of its sink, and other elements."""
    spec = load("peltier_cooler").model_dump(exclude_none=True)
    spec["domain"]["assume"] = [*spec["domain"]["assume"], "T_sink > 0.5*T_0"]
    spec["elements"] |= {"couples": couples or spec["elements"]["couples"]}
    spec["elements"] |= {"wire": wire} if wire else {}
    return derive(Model(**spec))


def test_no_floor_is_claimed_of_a_body_from_which_a_current_may_take_entropy():
    plain = {"kind": "resistor", "between": ["b", "gnd"], "voltage": "R*i", "heats": "sink"}
    assert "invariant" in {row.id for row in obligations(changed(couples=plain))}
    assert "invariant" not in {row.id for row in obligations(changed())}


def test_current_that_a_thermoelectric_does_not_leave_free_is_refused():
    wire = {"kind": "capacitor", "between": ["b", "gnd"], "capacitance": "c_c"}
    with pytest.raises(PiezoError, match="put a resistor in series with 'couples'"):
        changed(wire=wire)


def laminate(given, V_u, V_l, F):
    """Return deflection and charges of a bender: the strain of each slice, and sums along it."""
    length, w, h, s, d, eps = (given[name] for name in ("l", "w", "h", "s", "d", "eps"))
    along, weight = np.polynomial.legendre.leggauss(3)
    rest, part = length * (1 - along) / 2, weight * length / 2  # up to the tip
    free = d * np.array([V_u, V_l]) / h  # by which a layer of its own would shorten
    stretch = -free.mean()
    # moment of the stresses (stretch - curvature*y + free)/s about the middle, against that of F
    curvature = (F * rest + w * h**2 / (2 * s) * (free[0] - free[1])) * 3 * s / (2 * w * h**3)
    strain = stretch - curvature * np.array([[h / 2], [-h / 2]])
    field = np.array([[V_u], [V_l]]) / h
    charge = w * (eps * field - d * (strain + d * field) / s) @ part
    return curvature * rest @ part, charge


SIZES = {"l": (0.01, 0.1), "w": (1e-3, 0.03), "h": (1e-4, 1e-3), "s": (1e-11, 3e-11)}


TINY = {"l": 0.0625, "w": 0.015625, "h": 6.948508081028393e-4, "s": 1.1397161768213753e-11}


@settings(max_examples=20)
@example(TINY, (0.5, 2.3141309788202364e-08), (0.0, 1.0, 2.107463779739776e-277))
@given(
    st.fixed_dictionaries({name: st.floats(*range_) for name, range_ in SIZES.items()}),
    st.tuples(st.floats(0.1, 0.9), st.floats(1e-8, 5e-8)),
    st.tuples(*[st.floats(-100.0, 100.0)] * 2, st.floats(-0.5, 0.5)),
)
def test_bender_rests_as_a_laminated_beam(sizes, coupling, drive):
    (k_31, eps), (V_b, V, F) = coupling, drive
    changed = sizes | {"eps": eps, "d": k_31 * np.sqrt(sizes["s"] * eps)}
    inputs = {"V_b": V_b, "V": V, "F": F}
    rest = operating_point("bimorph", inputs=inputs, parameters=changed).initial
    x, charges = laminate(changed, V_b - V, V, F)
    alpha = 3 * changed["w"] * changed["h"] * changed["d"] / (4 * changed["s"] * changed["l"])
    found = rest["Q_u"] + alpha * rest["x"], rest["Q_l"] - alpha * rest["x"]
    scale = laminate(changed, 200.0, -100.0, 0.5)
    assert rest["x"] == pytest.approx(x, rel=1e-8, abs=1e-9 * scale[0])
    assert found == pytest.approx(charges, rel=1e-8, abs=1e-9 * scale[1][0])


def test_bender_is_that_of_its_data_sheet():
    """1.3 mm and 0.3 N by 150 V across one layer, 300 nF in parallel, 60 Hz."""
    at = {"V_b": 150.0, "V": 0.0}
    assert operating_point("bimorph", inputs=at).initial["x"] == pytest.approx(1.3e-3, rel=1e-3)
    held = operating_point("bimorph", inputs=at | {"F": -0.3}).initial["x"]
    assert abs(held) < 0.01e-3
    A, B, C, D = (np.asarray(part) for part in linearize("bimorph", inputs={"V_b": 0.0, "V": 0.0}))
    s, V = 2j * np.pi * 0.01, [*load("bimorph").inputs].index("V")
    current = (C @ np.linalg.solve(s * np.eye(len(A)) - A, B) + D)[V, V]
    assert current / s == pytest.approx(300e-9, rel=2e-3)
    ringing = [root for root in np.linalg.eigvals(A) if root.imag > 0]
    assert abs(ringing[0]) / (2 * np.pi) == pytest.approx(60.0, rel=5e-3)


def lever():
    """Return force per volt, stiffness, way to the end stop and its stiffness, at the load."""
    k, a, n, k_l, g, k_e = value("amplified_stack", "k", "a", "n", "k_l", "g", "k_e")
    return a / n, k / n**2 + k_l, g * 1e-3, k_e


@pytest.mark.some(2)
@pytest.mark.parametrize(("V", "F", "reach"), [(50.0, 0, 0), (110.0, -20, 0), (150.0, 0, 1)])
def test_lever_moves_its_load_as_the_stiffnesses_say(V, F, reach):
    given, (a, k, g, k_e) = {"V": V, "F": F}, lever()
    rest = operating_point("amplified_stack", inputs=given).initial
    assert (rest["x"] > g) == reach
    wanted = (a * V + F + reach * k_e * g) / (k + reach * k_e)
    assert rest["x"] == pytest.approx(wanted, rel=1e-6)
    assert rest["x"] == pytest.approx(8 * rest["q"], rel=1e-6)
    run = simulate("amplified_stack", inputs=given, duration=0.1, rtol=1e-7, times=[0.0, 0.1])
    assert run.x.values[-1] == pytest.approx(rest["x"], rel=1e-5)


def test_load_is_stopped_and_both_laws_hold_over_the_contact():
    """It bounces, and goes no further than where a constant force would have it without losses."""
    run = simulate("amplified_stack", inputs={"V": 150.0}, duration=0.02, rtol=1e-8)
    a, k, g, k_e = lever()
    most = brentq(lambda x: a * 150 * x - k * x**2 / 2 - k_e * (x - g) ** 2 / 2, g, 1e-3)
    inside = run.x.values - g
    assert (inside[1:] * inside[:-1] < 0).sum() >= 3
    assert 0.7 * (most - g) < inside.max() < most - g
    assert np.abs(run.x_e - run.x).max() < 1e-15
    put_in = float(run.supplied_amplifier.max())
    lost = np.abs(run.energy_residual.values).max()
    assert lost <= 1e-12 * put_in + 4 * np.spacing(run.energy.values.max())
    assert np.diff(run.heat_bumper).min() >= 0
    assert float(run.heat_bumper[-1]) > 1e-3
