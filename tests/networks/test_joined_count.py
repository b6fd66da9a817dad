"""`count` of stores that have one across variable: one state, the sum of theirs."""

import pytest
import sympy as sp
from scipy.integrate import quad

from piezo_sym import PiezoError, derive, simulate, sine, verify
from piezo_sym.proofs import Verdict
from piezo_sym.spec.load import parse
from tests.checker.stated import refused, stated

HEAD = """
[model]
name = "several"
[parameters]
M = { value = SIZE, unit = "UNIT" }
w = { value = 2, unit = "OUT" }
d = { value = 0.3, unit = "OTHER" }
T_0 = { value = 300, unit = "K" }
c = { value = 2, unit = "J/K" }
[inputs]
u = { unit = "FED" }
[domain]
assume = ["M > 0", "w > 0", "d > 0", "T_0 > 0", "c > 0"]
[initial]
START
[elements]
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
"""
#: The units of the size, the co-state, a damping and the input; where it stands; size and co-state.
KINDS = {
    "mass": ("kg", "m/s", "N*s/m", "N", 'at = "a"', "mass", "velocity", "p"),
    "inertia": ("kg*m**2", "rad/s", "N*m*s", "N*m", 'at = "a"', "inertia", "angular_velocity", "L"),
    "capacitor": ("F", "V", "S", "A", 'between = ["a", "gnd"]', "capacitance", "voltage", "Q"),
    "accumulator": (
        "m**3/Pa",
        "Pa",
        "m**3/s/Pa",
        "m**3/s",
        'between = ["a", "tank"]',
        "capacitance",
        "pressure",
        "V",
    ),
}
REST = {
    "mass": """
r = { kind = "damper", between = ["a", "wall"], force = "d*v", heats = "body" }
f = { kind = "force_source", at = "a", input = "u" }
""",
    "inertia": """
r = { kind = "rotational_damper", between = ["a", "frame"], torque = "d*omega", heats = "body" }
f = { kind = "torque_source", at = "a", input = "u" }
""",
    "capacitor": """
r = { kind = "resistor", between = ["a", "gnd"], current = "d*v", heats = "body" }
f = { kind = "current_source", between = ["a", "gnd"], input = "u" }
""",
    "accumulator": """
r = { kind = "orifice", between = ["a", "tank"], flow = "d*dp", heats = "body" }
f = { kind = "flow_source", between = ["a", "tank"], input = "u" }
""",
}


def spec(kind, law, count=None, start="", size=0.7):
    """Return a spec with stores of a kind, a damper and a source; {x} is the letter of its law."""
    *units, place, field, costate, letter = KINDS[kind]
    text = HEAD.replace("START", start).replace("SIZE", str(size))
    for name, unit in zip(("UNIT", "OUT", "OTHER", "FED"), units, strict=True):
        text = text.replace(f'"{name}"', f'"{unit}"')
    law = law.format(x=letter, size=field, costate=costate)
    several = "" if count is None else f"count = {count}, "
    own = f'store = {{ kind = "{kind}", {place}, state = "x", {several}{law} }}\n'
    return text + own + REST[kind]


def meant(text, iphs):
    """Return an expression by hand in the symbols of a system."""
    return sp.sympify(text, {s.name: s for s in iphs.symbols.symbols.values()})


def derived(*args, **options):
    return derive(parse(spec(*args, **options)))


@pytest.mark.some(2)
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    ("law", "count", "energy"),
    [
        ('{size} = "M"', 3, "x**2/(2*3*M)"),
        ('{size} = "M"', 1, "x**2/(2*M)"),
        ('{costate} = "{x}/M + w*({x}/(M*w))**3"', 3, "3*((x/3)**2/2/M + (x/3)**4/(4*M**3*w**2))"),
        ('energy = "{x}**2/(2*M)"', 4, "4*(x/4)**2/(2*M)"),
    ],
)
def test_alike_stores_in_parallel_have_the_energy_of_all(kind, law, count, energy):
    iphs = derived(kind, law, count)
    assert sp.simplify(iphs.U - meant(f"{energy} + T_0*c*exp(S/c)", iphs)) == 0
    rate = meant(f"-d*({sp.diff(sp.sympify(energy), 'x')}) + u", iphs)
    (found,) = (r for s, r in zip(iphs.x, iphs.rhs, strict=True) if s.name == "x")
    assert sp.simplify(iphs.in_states(found) - rate) == 0
    assert {row.verdict for row in verify(iphs).rows} == {Verdict.PROVED}
    text = spec(kind, law, count)
    assert not refused(text, stated(text))


@pytest.mark.some(1)
@pytest.mark.parametrize("kind", KINDS)
def test_they_start_at_the_sum_of_their_states_and_run_as_one(kind):
    several = parse(spec(kind, '{size} = "M"', 3, "x = 0.2"))
    one = parse(spec(kind, '{size} = "3*M"', None, "x = 0.6"))
    first, second = (
        simulate(m, inputs={"u": sine(2.0, 3.0)}, duration=0.5, rtol=1e-9) for m in (several, one)
    )
    assert first.x[0] == second.x[0] == pytest.approx(0.6)
    assert first.x.attrs["long_name"].endswith(f"of {kind} 'store', 3 of them joined")
    assert first.x.values == pytest.approx(second.x.values, rel=1e-12)


def test_they_are_joined_with_others_like_them():
    """Three of M and one of 2*M at one node have the momentum of five of M."""
    other = 'last = { kind = "mass", at = "a", mass = "2*M", state = "y" }\n'
    text = spec("mass", '{size} = "M"', 3, "x = 0.2\ny = 0.4") + other
    iphs = derive(parse(text))
    assert sp.simplify(iphs.U - meant("x**2/(2*5*M) + T_0*c*exp(S/c)", iphs)) == 0
    assert simulate(parse(text), inputs={"u": 0.0}, duration=1e-6).x[0] == pytest.approx(1.0)
    assert not refused(text, stated(text))
    with pytest.raises(PiezoError, match=r"'last' is joined.*; give y = 0.4$"):
        derive(parse(text.replace("y = 0.4", "y = 0.5")))


def test_a_cell_has_them_at_nodes_that_it_shares():
    """Cells of a mass at the tip and a spring are springs, and the masses of all at the tip."""
    cells = """
[banks.cell]
count = 3
[banks.cell.elements]
m = { kind = "mass", at = "a", mass = "M", state = "y" }
s = { kind = "spring", between = ["a", "wall"], stiffness = "k", state = "q" }
"""
    text = spec("mass", '{size} = "M"').replace(
        "[inputs]", 'k = { value = 2, unit = "N/m" }\n[inputs]'
    )
    iphs = derive(parse(text + cells))
    assert [s.label for s in iphs.system.states] == ["S", "x", "q"]
    whole = iphs.expand({"cell": 1})
    assert sp.simplify(whole.U.diff(meant("x", whole)) - meant("x/(4*M)", whole)) == 0


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        (
            spec("mass", '{size} = "M"', 2, size=[1, 2]),
            "a list is given.*give different ones as elements",
        ),
        (spec("mass", '{size} = "M"', 2, "x = [1, 2]"), "2 values are given; expected one value"),
        (
            spec("mass", 'series = ["a", "wall"], {size} = "M"', 2),
            "one velocity, and series is given",
        ),
        (spec("capacitor", '{size} = "M"', 0), "count: 0 does not fit"),
    ],
)
def test_what_does_not_fit_is_refused(text, fault):
    with pytest.raises(PiezoError, match=fault) as caught:
        parse(text)
    assert caught.value.exit_code == 2


def test_a_model_is_the_same_before_and_after_it_is_asked_what_it_joins():
    one, two = (parse(spec("mass", '{size} = "M"', 3)) for _ in range(2))
    assert one.joined == {"x": 3}
    assert one == two
    assert dict(one).keys() == dict(two).keys()


def test_a_size_that_bends_at_zero_is_proved_for_several_too():
    """Each mass has v = p/(M + abs(p)/w): the energy of three is the integral of all three."""
    iphs = derived("mass", '{size} = "M*(1 + abs({x})/(M*w))"', 3)
    assert {row.verdict for row in verify(iphs).rows} == {Verdict.PROVED}
    size = meant("M", iphs), meant("w", iphs), meant("x", iphs), meant("S", iphs)
    values = dict(zip(size, (0.7, 2.0, 0.0, 0.0), strict=True))
    values |= {meant("T_0", iphs): 300.0, meant("c", iphs): 2.0}
    U = [float(iphs.U.subs(values | {size[2]: x})) for x in (0.0, -0.6, 0.9)]
    for found, x in zip(U[1:], (-0.6, 0.9), strict=True):
        own = quad(lambda p: p / (0.7 + abs(p) / 2.0), 0.0, x / 3)[0]
        assert found - U[0] == pytest.approx(3 * own, rel=1e-9)
