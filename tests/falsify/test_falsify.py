"""The net: claims forged as PROVED are caught where they are false, and true ones pass."""

import numpy as np
import pytest

from piezo_sym import derive, load
from piezo_sym.codegen import template_of
from piezo_sym.errors import ContradictionError
from piezo_sym.falsify import falsify, module_from
from piezo_sym.spec.load import parse
from tests.falsify.specs import AMBIENT, INPUT, MASS, SPRING, built, damper, module_of

PASSIVE = ("passive", "damper")
HYSTERONS = """
[inputs]
V = { unit = "V", default = 0.0 }
[elements.h]
kind = "hysteron"
between = ["in", "gnd"]
count = 1
inductance = "L"
voltage = "R*i"
heats = "body"
state = "phi_h"
[elements.h_j]
kind = "hysteron"
between = ["in", "gnd"]
inductance = "L"
voltage = "R*i*(1 - (i/i_1)**2)"
heats = "body"
state = "psi"
[elements.source]
kind = "voltage_source"
between = ["in", "gnd"]
input = "V"
"""
ELSE = (
    "F_1*v/v_1*(exp(v/v_1) - 2.7*v/v_1) if a > 0"
    " else F_1*v/v_1*(exp(v/v_1 - 0.37) - 2.72*(v/v_1 - 0.37))"
)
SIDE = "(sqrt(a/a_1) if a > 0 else {})"
#: Wrongly PROVED once, each false at the values that it ships with.
ONCE_PROVED = {
    "a root in a branch not taken": (
        damper("a*v") + SPRING.format(f"k*(1 + {SIDE.format(0)})"),
        ("a_1 > 0",),
        {"a": -1.0},
    ),
    "a root in the domain": (damper("a*v"), ("a_1 > 0", f"{SIDE.format(1)} >= 0"), {"a": -1.0}),
    "the other branch": (damper(ELSE), ("F_1 > 0", "v_1 > 0"), {"a": -1.0}),
    "two names alike": (HYSTERONS, ("phi_h**2 < L*L*i_1*i_1", "i_1 > 0", "R > 0"), {}),
    "a width in the domain": (
        damper("(a - b)*v"),
        ("saturate(a, b) < 0",),
        {"a": -5.0, "b": 1.0},
    ),
}
POSITIVE = ("a > 0", "b > 0", "a_1 > 0", "v_1 > 0", "F_1 > 0")
#: Laws that are active on a small set only.
WEDGES = {
    "a wedge": "a*v*(v - v_1)*(v - 1.001*v_1)/v_1**2",
    "a wedge, expanded": "F_1*v/v_1*((v/v_1)**2 - 2.001*v/v_1 + 1.001)",
    "a wedge away from names": "F_1*v/v_1*((v/v_1 - 0.37)**2 - 0.000001)",
    "a corner of parameters": "a*v*(1 if b > 1e-9*a_1 else -1)",
    "near the reference": "a*v*(1 if abs(T - T_0) > 1e-6*T_0 else -1)",
    "beyond 1e6": "a*v if abs(v) < 1e6*v_1 else -a*v",
    "two parameters alike": "a*v*(1 if abs(b - a_1) > 0 else -1)",
    "on a kink alone": "a*v*(1 if abs(v - v_1) > 0 else -1)",
    "at two thresholds": "a*v*(-1 if abs(v - v_1) + abs(v_1*(b - a_1)/a_1) < 1e-6*v_1 else 1)",
    "a narrow wedge": "F_1*v/v_1*((v/v_1 - 0.37)**2 - 1e-18)",
    "a speck in two": "F_1*v/v_1*((v/v_1 - 0.37)**2 + (b/a_1 - 2.2)**2 - 1e-8)",
    "a speck in three": (
        "F_1*v/v_1*((v/v_1 - 0.37)**2 + (b/a_1 - 2.2)**2 + (T/T_0 - 1.3)**2 - 1e-6)"
    ),
    "far out": "a*v*(1 if abs(v) < 1e100*v_1 else -1)",
}


def attacked(iphs, *claims, points=20_000, **more):
    return falsify(iphs, module_of(iphs), claims, points=points, **more)


def of_names(law, *assume):
    """Return the conditions of `POSITIVE` on the names of a law."""
    return (*(c for c in POSITIVE if c.split()[0] in law), *assume)


@pytest.mark.some(3)
@pytest.mark.parametrize("row", ["passive", "sigma"])
@pytest.mark.parametrize("name", ONCE_PROVED)
def test_what_was_wrongly_proved_is_caught(tmp_path, name, row):
    elements, assume, values = ONCE_PROVED[name]
    iphs = built(tmp_path, elements, *assume, **values)
    element = iphs.system.processes[-1].label if row == "passive" else ""
    with pytest.raises(ContradictionError, match="a proof and a number disagree") as caught:
        attacked(iphs, (row, element))
    assert caught.value.exit_code == 3
    assert f"{row} of {element}" if element else row in str(caught.value)
    for shown in ("is PROVED, but", "T_0 = ", "S = "):
        assert shown in str(caught.value)


@pytest.mark.some(2)
@pytest.mark.parametrize("name", WEDGES)
def test_a_law_that_is_active_on_a_small_set_is_caught(tmp_path, name):
    law = WEDGES[name]
    with pytest.raises(ContradictionError, match=r"heat = -"):
        attacked(built(tmp_path, damper(law), *of_names(law)), PASSIVE, points=100_000)


@pytest.mark.parametrize(
    "law",
    [
        "F_1*v/v_1*(exp(v/v_1)*exp(-v/v_1) - 1 + 1e-17)",
        "a*v*((v/v_1 + 1)**2 - (v/v_1)**2 - 2*v/v_1)",
        "F_1*(v/v_1)**3*((v/v_1 - 1)**2 + 2*v/v_1 - 1)",
    ],
)
def test_a_true_law_that_rounds_below_zero_is_no_contradiction(tmp_path, law):
    (attack,) = attacked(built(tmp_path, damper(law), *of_names(law)), PASSIVE)
    assert attack.worst
    assert attack.points >= 20_000
    assert float(attack.worst["p"]) != 0


@pytest.mark.parametrize(
    ("law", "assume"),
    [
        ("a*v*a_1/(b - a_1)", ()),
        ("a*v*v_1/v", ()),
        ("a*sqrt(v*v_1)", ()),
        ("F_1*log(v/v_1 - 1)", ("p > M*v_1/2",)),
        ("a*v*(v_1/(v - v_1) if v > v_1 else v_1/(v - v_2))", ("v_2 < v_1",)),
        ("a*v/((2*b - 3*a_1)/a_1)", ()),
    ],
)
def test_a_law_without_a_value_somewhere_is_caught(tmp_path, law, assume):
    starts = ["p = 5.0"]
    iphs = built(tmp_path, damper(law), *of_names(law, *assume), starts=starts, v_2=0.5)
    with pytest.raises(ContradictionError, match="a law has no value"):
        attacked(iphs, ("welldef", "damper"))


@pytest.mark.parametrize(
    "law", ["a*v*(exp(v/v_1) - 1)*v_1/v if abs(v) > 0 else 0*a*v", "F_1*exp(exp(v/v_1))*v/v_1"]
)
def test_an_overflow_is_no_contradiction(tmp_path, law):
    (attack,) = attacked(built(tmp_path, damper(law), *of_names(law)), ("welldef", "damper"))
    assert not attack.worst


@pytest.mark.some(4)
@pytest.mark.parametrize(
    "law",
    [
        "a*v if v < v_1 else 2*a*v",
        "a*v if v > v_1 else 0",
        "a*v*(v_1**2/v**2 if v > 0 else 1)",
        "a*v_1**2/(v - v_1) if v > v_1 else 0",
        "a*v if v <= -v_1 else 2*a*v",
        "a*v + F_1*sign(v)",
        "a*v if T < 1.5*T_0 else a*v*T/T_0",
        "a*v*(1 + 1e-5*sign(v - v_1))",
    ],
)
def test_a_jump_is_caught(tmp_path, law):
    iphs = built(tmp_path, damper(law), *of_names(law))
    with pytest.raises(ContradictionError, match="its values differ by"):
        attacked(iphs, ("continuous", "damper"))


@pytest.mark.some(3)
@pytest.mark.parametrize(
    "law",
    [
        "F_1*v/v_1 if v < v_1 else F_1*(1 + 1e14*(v - v_1)/v_1)",
        "a*v if b > a_1 else 2*a*v",
        "F_1*sqrt(abs(v - v_1)/v_1)*sign(v - v_1)",
        "a*max(v, v_1) + a*min(v, 2*v_1)",
        "F_1*abs(sin(1e60*v/v_1))",
        "F_1*abs(sin(exp(exp(5*v/v_1)))) if v > v_1 else F_1*abs(sin(exp(exp(5))))",
    ],
)
def test_a_steep_law_and_a_choice_of_parameters_are_no_jumps(tmp_path, law):
    (attack,) = attacked(built(tmp_path, damper(law), *of_names(law)), ("continuous", "damper"))
    assert attack.points >= 20_000


SMALL = ("v_1 > 0", "n > 0", "n < 0.001")


def test_a_power_with_a_small_exponent_is_no_jump_and_a_jump_beside_a_large_one_is_caught(tmp_path):
    law, row = "F_1*sign(v)*abs(v/v_1)**n", ("continuous", "damper")
    assert attacked(built(tmp_path, damper(law), *SMALL), row)[0].points >= 20_000
    with pytest.raises(ContradictionError, match="its values differ by"):
        attacked(built(tmp_path, damper(f"{law} + F_1*sign(v)"), *SMALL[:2]), row)


def test_a_jump_of_a_store_is_told_from_one_of_a_law_beside_it(tmp_path):
    """A damper that jumps on purpose where the mass has a kink makes all rates jump there."""
    beside = damper("F_1*sign(v)") + "discontinuous = true\n"
    kink = beside.replace('mass = "M"', 'velocity = "p/M if p < 0 else 2*p/M"')
    jump = beside.replace('mass = "M"', 'velocity = "p/M if p < M*v_1 else 2*p/M"')
    (attack,) = attacked(built(tmp_path, kink, "F_1 > 0"), ("continuous", "mass"))
    assert attack.points >= 20_000
    with pytest.raises(ContradictionError, match="its values differ by"):
        attacked(built(tmp_path, jump, "F_1 > 0"), ("continuous", "mass"))


def test_a_power_that_overflows_where_the_law_is_zero_is_no_rounding(tmp_path):
    iphs = built(tmp_path, damper("a*v*abs(b/a_1)**n"), "a > 0", "a_1 > 0", "n > 0", n=1.5)
    (attack,) = attacked(iphs, PASSIVE, points=100_000)
    assert not attack.worst


@pytest.mark.parametrize(
    ("heat", "assume"),
    [
        ("T_0*(1 - S/c_0)", ()),
        ("T_0*(2 + S/c_0 - (S/c_0)**2)", ("S >= 0", "S < c_0")),
        ("T_0*(1 + (S/c_0)**3)", ("T > T_0/2",)),
        ("T_0*(1 + S/c_0)", ()),
    ],
)
def test_a_temperature_that_falls_or_is_not_positive_is_caught(tmp_path, heat, assume):
    iphs = built(tmp_path, damper("a*v"), "a > 0", *assume, heat=heat)
    with pytest.raises(
        ContradictionError, match=r"temperature of body is PROVED, but (temperature|slope) ="
    ):
        attacked(iphs, ("temperature", "body"))


def test_a_temperature_that_is_known_to_be_positive_is_not(tmp_path):
    iphs = built(tmp_path, damper("a*v"), "a > 0", "T > T_0/2", heat="T_0*(1 + S/c_0)")
    assert not attacked(iphs, ("temperature", "body"))[0].worst


@pytest.mark.parametrize(
    "row", [("passive", "ambient"), ("exergy", ""), ("environment", ""), ("invariant", "body")]
)
def test_a_conductance_that_may_be_negative_breaks_all_that_rests_on_it(tmp_path, row):
    elements = damper("a*v") + AMBIENT.format("lam") + INPUT.format(301.0)
    iphs = built(tmp_path, elements, "a >= 0", "T > T_0/2", "T_e > 0")
    with pytest.raises(ContradictionError):
        attacked(iphs, row)


@pytest.fixture(scope="module")
def stack():
    return derive(load("piezo_stack"))


@pytest.fixture(scope="module")
def rows():
    bodies = [(row, "body") for row in ("temperature", "invariant")]
    laws = [(p, e) for p in ("passive", "welldef", "continuous") for e in ("hysteron", "damper")]
    return (
        *bodies,
        *laws,
        ("passive", "ambient"),
        ("sigma", ""),
        ("exergy", ""),
        ("environment", ""),
    )


def test_the_paper_holds_at_the_same_points_each_time(stack, rows):
    first, second = (falsify(stack, module_of(stack), rows) for _ in range(2))
    assert first == second
    assert [(attack.id, attack.element) for attack in first] == list(rows)
    assert not any(attack.worst for attack in first)
    assert all(attack.points >= 100_000 for attack in first if attack.id != "invariant")
    assert all(attack.points >= 10_000 for attack in first)


def test_rows_that_numbers_say_nothing_of_are_left_out(stack):
    assert attacked(stack, ("skew", ""), ("units", "damper"), ("odd", "damper")) == ()


def test_a_thin_domain_is_walked(tmp_path):
    law = "a*v*(1 if abs(v) < 1e6*v_1 else -1)"
    thin = ("a <= b", "b <= a", "v_1 > 0", "T < 1.0001*T_0", "T > 0.9999*T_0")
    iphs = built(tmp_path, damper("a*v"), *thin, "a >= 0", a=3.0)
    (attack,) = attacked(iphs, PASSIVE)
    assert attack.points >= 20_000
    with pytest.raises(ContradictionError):
        attacked(built(tmp_path, damper(law), *thin, "a >= 0", a=3.0), PASSIVE)


def test_a_domain_of_which_no_point_is_found_says_so(stack):
    module = module_of(stack)
    module.margins = lambda x, *_: np.full((len(module.DOMAIN), *x.shape[1:]), -1.0)
    assert [attack.points for attack in falsify(stack, module, [("sigma", "")])] == [0]


def test_the_module_is_attacked_not_the_spec(stack):
    """A module that differs from its spec is no contradiction of the proof, but it is told."""
    module = module_of(stack)
    heat = module.heat
    module.heat = lambda x, u, p: -np.abs(heat(x, u, p)) - 1
    (attack,) = falsify(stack, module, [("passive", "damper")])
    assert attack.worst


def test_a_mass_alone_has_nothing_to_jump(tmp_path):
    iphs = built(tmp_path, MASS + damper("a*v").removeprefix(MASS), "a > 0")
    (attack,) = attacked(iphs, ("continuous", "mass"))
    assert attack.points >= 20_000


def test_a_module_takes_parameters_of_a_bank_per_lane_and_point(stack):
    module, rng = module_of(stack), np.random.default_rng(3)
    x, u = rng.random((6, 5)) + 1, rng.random((3, 5)) + 300
    lanes = {name: rng.random((2, 5)) + 1 for name in ("L", "rho", "i_0")}
    together = module.Parameters(**lanes, T_0=rng.random(5) + 200)
    for function in ("rhs", "heat", "entropy_production", "margins", "jacobian"):
        found = getattr(module, function)(x, u, together)
        for n in range(5):
            own = {name: tuple(values[:, n]) for name, values in lanes.items()}
            alone = module.Parameters(**own, T_0=together.T_0[n])
            expected = getattr(module, function)(x[:, n], u[:, n], alone)
            np.testing.assert_allclose(found[..., n], expected, rtol=1e-13)


TWO_AMBIENTS = """
[model]
name = "two_ambients"
[parameters]
m = { value = 1.0, unit = "kg" }
d = { value = 1.0, unit = "N*s/m" }
k = { value = 1.0, unit = "N/m" }
T_0 = { value = 293.15, unit = "K" }
c = { value = 20.0, unit = "J/K" }
lam = { value = 0.2, unit = "W/K" }
[inputs]
T_e = { unit = "K", default = 293.15 }
[domain]
assume = ["d >= 0", "lam >= 0", "T_e > 0"]
[elements]
mass = { kind = "mass", at = "tip", mass = "m" }
springs = { kind = "spring", between = ["tip", "wall"], count = 3, stiffness = "k", state = "z" }
damper = { kind = "damper", between = ["tip", "wall"], force = "d*v", heats = "frame" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)" }
frame = { kind = "thermal_mass", temperature = "T_0*exp(S/c)" }
first = { kind = "ambient", body = "body", conductance = "lam", input = "T_e" }
second = { kind = "ambient", body = "frame", conductance = "lam", input = "T_e" }
"""


def test_a_bank_of_any_size_is_attacked_beside_two_ambients():
    """Points of the spec's own size were looked up in the domain of a smaller one."""
    iphs = derive(parse(TWO_AMBIENTS))
    module = module_from(template_of(iphs).filled(iphs.model.model_dump())[".py"])
    assert all(attack.points for attack in falsify(iphs, module, [("exergy", ""), ("sigma", "")]))
