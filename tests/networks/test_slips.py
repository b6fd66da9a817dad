"""Slips: springs and capacitors with a second law, of their effort and the rate that drives them.

References are right-hand sides typed by hand, Dahl's closed form, and laws evaluated by hand.
"""

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from piezo_sym import PiezoError, derive, load, simulate, sine
from piezo_sym.proofs import decide
from piezo_sym.spec.load import parse

SPECS = Path(__file__).with_name("specs")
TEXT = (SPECS / "slips.toml").read_text(encoding="utf-8")
WEN = "(beta*abs(v)*sign(f) + gam*v)*abs(f/f_0)**n"
DRIVE = {"F": sine(40, 1.1), "V": sine(12, 2.3)}

DAHL = """[model]
name = "dahl"
[parameters]
k = { value = 3.0, unit = "N/m" }
F_c = { value = 2.0, unit = "N" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 9.0, unit = "J/K" }
[inputs]
w = { unit = "m/s" }
[domain]
assume = ["F_c > 0"]
[elements]
drive = { kind = "velocity_source", at = "tip", input = "w" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)" }
[elements.spring]
kind = "spring"
between = ["tip", "wall"]
stiffness = "k"
slip = "abs(v)*f/F_c"
heats = "body"
"""


def rates(t, x):
    """Return the rates of `slips.toml`, by hand; states p, z, q_dahl, Q_stack, S."""
    p, z, q, Q, S = x
    v, f, g, V, T = p, 40 * z, 80 * q, Q / 1e-3, 300 * np.exp(S / 20)
    slip = (0.7 * abs(v) * np.sign(f) + 0.3 * v) * abs(f / 2) ** 2
    dahl = abs(v) * g / 2
    through = (12 * np.sin(2 * np.pi * 2.3 * t) - V) / 10
    current = through - 0.2 * v
    leak = 0.7 * abs(current) * V / 5 * 300 / T
    heat = f * slip + g * dahl + V * leak + through**2 * 10
    force = 40 * np.sin(2 * np.pi * 1.1 * t) - f - g + 0.2 * V
    return [force, v - slip, v - dahl, current - leak, heat / T]


@pytest.mark.some(1)
@pytest.mark.parametrize("rtol", [1e-3, 1e-6, 1e-9])
def test_a_run_is_that_of_the_equations_by_hand_and_both_laws_close(rtol):
    run = simulate(load(SPECS / "slips.toml"), inputs=DRIVE, duration=2.0, rtol=rtol)
    exact = solve_ivp(
        rates, (0, 2), [0.0] * 5, "DOP853", run.time.values, rtol=1e-12, atol=1e-14, max_step=2e-3
    )
    for name, values in zip(("p", "z", "q_dahl", "Q_stack", "S"), exact.y, strict=True):
        assert np.max(abs(run[name].values - values)) <= 10 * rtol * np.max(abs(values)), name
    assert np.max(abs(run.energy_residual.values)) < 1e-13 * np.max(abs(run.energy.values))
    for element in ("wen", "dahl", "stack", "amplifier"):
        produced = run[f"produced_{element}"].values
        assert np.all(np.diff(produced) >= 0)
        assert produced[-1] > 0
    total = sum(run[f"produced_{e}"] for e in ("wen", "dahl", "stack", "amplifier"))
    assert np.allclose(total, run.entropy - run.entropy[0], rtol=0, atol=1e-12)


def test_dahls_loop_is_that_of_its_closed_form_at_any_rate():
    model, loops = parse(DAHL), []
    for slow in (1.0, 1e-3):
        drive = {"w": ([0, 1 / slow, 1 / slow, 3 / slow], [slow, slow, -slow, -slow])}
        run = simulate(
            model, inputs=drive, duration=3 / slow, rtol=1e-10, times=np.linspace(0, 3 / slow, 301)
        )
        x = np.minimum(run.time * slow, 2 - run.time * slow).values
        first = 2 * (1 - np.exp(-3 * x / 2))
        back = -2 + (2 * (1 - np.exp(-1.5)) + 2) * np.exp(-3 * (1 - x) / 2)
        loops.append(3 * run.q_spring.values)
        assert np.max(abs(loops[-1] - np.where(run.time * slow <= 1, first, back))) < 1e-8
    assert np.allclose(*loops, rtol=0, atol=1e-8)


def rows_of(text):
    return {(row.id, row.element): row for row in decide(derive(parse(text))).rows}


def test_bouc_wen_is_refuted_beyond_its_condition_with_numbers():
    rows = rows_of(TEXT.replace('"beta >= abs(gam)"', '"beta >= 0"'))
    row = rows["passive", "wen"]
    beta, gam, f, v, f_0, n = (
        Fraction(row.witness[n]) for n in ("beta", "gam", "f", "v", "f_0", "n")
    )
    sign = (f > 0) - (f < 0)
    power = (beta * abs(v) * sign + gam * v) * abs(f / f_0) ** n * f
    assert row.verdict.value == "REFUTED"
    assert power < 0 <= beta < abs(gam)
    assert row.reason.split("= ")[1].split(";")[0] == str(power)
    assert rows["rate-independent", "wen"].verdict.value == "PROVED"
    assert rows["sigma", ""].reason == "it rests on passive of wen, which is REFUTED"


GOES_BY_MORE = {
    "v**2*f/(m*V_0)": lambda v, f: v**2 * f,
    "abs(v)*f/(f_0 + m*abs(v))": lambda v, f: abs(v) * f / (1 + abs(v)),
    "f": lambda v, f: f + 0 * v,
    "v*abs(v)*f": lambda v, f: v * abs(v) * f,
}


@pytest.mark.some(2)
@pytest.mark.parametrize("law", GOES_BY_MORE)
def test_slips_that_depend_on_the_rate_are_refuted(law):
    row = rows_of(TEXT.replace(WEN, law))["rate-independent", "wen"]
    assert row.verdict.value == "REFUTED"
    assert not row.required
    at = {name: Fraction(value) for name, value in row.witness.items()}
    assert all(at[name] == 1 for name in at.keys() & {"m", "V_0", "f_0"})
    f, v = at["f"], at.get("v", Fraction(1))
    (factor,) = (value for name, value in at.items() if name.startswith("c"))
    slip = GOES_BY_MORE[law]
    assert slip(factor * v, f) != factor * slip(v, f)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('slip      = "abs(v)*f/f_0"\nheats     = "body"', 'slip = "v"', "slip is given without"),
        ('slip      = "abs(v)*f/f_0"', "", "heats is given without slip"),
        ('"abs(v)*f/f_0"', '"abs(i)*f/f_0"', "'i' has no meaning here; expected the letters f, v"),
        ('kind      = "spring"\nbetween   = ["tip", "wall"]\nstiffness = "2*k"',
         'kind = "torsion_spring"\nbetween = ["a", "frame"]\nstiffness = "2*k"', "slip"),
        ('["tip", "wall"]\nstiffness = "2*k"', '["tip", "mid"]\nstiffness = "2*k"', "'mid'"),
    ],
)  # fmt: skip
def test_slips_that_cannot_be_are_refused_in_one_line(old, new, said):
    assert old in TEXT
    with pytest.raises(PiezoError) as refused:
        derive(parse(TEXT.replace(old, new)))
    assert said in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("slipping", [("wen", "dahl"), ("wen",)])
def test_springs_in_series_are_not_joined_if_one_slips(slipping):
    """Their force is one: neither rate would be given, and the slip of one depends on the other."""
    text = TEXT.replace('["tip", "wall"]\nstiffness = "2*k"', '["mid", "wall"]\nstiffness = "2*k"')
    text = text.replace('["tip", "wall"]\nstiffness = "k"', '["tip", "mid"]\nstiffness = "k"')
    if "dahl" not in slipping:
        text = text.replace('slip      = "abs(v)*f/f_0"\nheats     = "body"', "")
    with pytest.raises(PiezoError, match=r"'wen', 'dahl' fix each other's force.*slips"):
        derive(parse(text))


def test_a_slip_goes_by_the_rate_that_a_resistor_lets_through():
    iphs = derive(parse(TEXT))
    symbols = iphs.symbols
    (rate,) = (expr for symbol, expr in iphs.rates if symbol == symbols["i_stack"])
    expected = symbols["i_amplifier"] - symbols["alpha_transducer"] * symbols["v_mass"]
    assert (rate - expected).expand() == 0
    assert iphs.rhs.has(symbols["R"])


def test_a_run_begins_at_rest_where_all_kinks_meet_and_the_drive_is_no_more_than_noise():
    """Near t = 0 the drive is a series whose noise, of either sign, is larger than its value."""
    run = simulate(
        load("stack_bouc_wen"),
        inputs={"V_in": lambda t: 150 * np.sin(np.pi * t) ** 2},
        duration=0.02,
        rtol=1e-8,
    )
    assert float(run.q[-1]) > 0
    assert np.max(abs(run.energy_residual.values)) < 1e-12


MORE = """s_1 = { value = 3.0, unit = "N*s/m" }
v_s = { value = 0.1, unit = "m/s" }
F_d = { value = 1.0, unit = "N" }
[inputs]"""
NAMED = {  # a law, and whether it goes with the rate alone
    "Dahl": ("abs(v)*f/f_0", "PROVED"),
    "Karnopp, smooth: it holds below f_0": ("max(v*f, 0)*deadzone(f, f_0)/f_0**2", "PROVED"),
    "Dupont, elastic before it slips": ("max(v*f, 0)*f*abs(f)/f_0**3", "PROVED"),
    "LuGre: bristles of Stribeck's curve": (
        "abs(v)*f/(f_0 + F_d*exp(-(v/v_s)**2))",
        "REFUTED",
    ),
}


def with_more(text):
    return text.replace("[inputs]", MORE).replace(
        '"f_0 > 0"', '"f_0 > 0", "v_s > 0", "F_d >= 0", "s_1 >= 0"'
    )


@pytest.mark.some(2)
@pytest.mark.parametrize("name", NAMED)
def test_known_models_of_friction_are_passive(name):
    law, by_rate = NAMED[name]
    rows = rows_of(with_more(TEXT.replace(WEN, law)))
    for row in ("welldef", "continuous", "passive"):
        assert rows[row, "wen"].verdict.value == "PROVED"
    assert rows["rate-independent", "wen"].verdict.value == by_rate
    assert rows["sigma", ""].verdict.value == "PROVED"


def test_damping_of_bristles_as_lugre_has_it_is_refuted_and_of_the_velocity_proved():
    """With s_1*dz/dt as a force on v the product may be negative: the known fault of LuGre."""
    bristle = "abs(v)*k*z/(f_0 + F_d*exp(-(v/v_s)**2))"
    damper = '[elements.loss]\nkind = "damper"\nbetween = ["tip", "wall"]\nheats = "body"\n'
    for force, verdict in ((f"s_1*(v - {bristle})", "REFUTED"), ("s_1*v", "PROVED")):
        text = with_more(TEXT.replace(WEN, NAMED["LuGre: bristles of Stribeck's curve"][0]))
        rows = rows_of(f'{text}\n{damper}force = "{force}"\n')
        assert rows["passive", "loss"].verdict.value == verdict
        assert rows["passive", "wen"].verdict.value == "PROVED"
    assert rows["sigma", ""].verdict.value == "PROVED"
