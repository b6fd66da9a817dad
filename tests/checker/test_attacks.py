"""Forged proofs: each claims something false, or leaves out what makes it true."""

import re

import pytest
from stated import PIEZO_STACK, forged, mass, refused, stated
from test_certificates import HOLDS, NEAR_ZERO, SOFTPLUS, checked, term

from piezo_sym import derive
from piezo_sym.checker import read_spec
from piezo_sym.checker.field import Field
from piezo_sym.checker.laws import parse
from piezo_sym.checker.system import check_system
from piezo_sym.proofs import Verdict, decide
from piezo_sym.spec.load import parse as load_text

SPEC = read_spec(PIEZO_STACK)
SIDES = "(1 if a > 0 else 0)", "(1 if a > a_1 else 0)"
APART = "({} - {})".format(*SIDES)
COUNT = {"element": "hysteron", "role": "output", "bank": None, "law": "sum(hysteron, 1)"}
#: Terms that vanish for banks of 1, 2 and 3 lanes, N being the number of lanes.
FEW_LANES = (
    "(1 if N > 3 else 0)",
    "max(N - 3, 0)",
    "deadzone(N, 3)",
    "max(sum(hysteron, 1) - 3, 0)",
    "{0}*({0} - 1)*({0} - 2)*({0} - 3)".format("(N if a > 0 else N)"),
    "{0}*({0} - 1)*({0} - 2)*({0} - 3)".format("max(N, N)"),
    "((1 if (N - 1)*(N - 4) > 0 else 0) - (1 if (N - 1)*(N - 5) > 0 else 0))",
    "(sqrt(N*N) - N)*(N - 1)*(N - 2)*(N - 3)",
    "sin(N - 1)*sin(N - 2)*sin(N - 3)",
    "(exp((N - 1)*(N - 2)) - 1)*(exp(N - 3) - 1)",
    "((N - 1)*(N - 2) if N - 3.5 > 0 else 0)",
)


@pytest.mark.parametrize("zero", FEW_LANES)
def test_what_vanishes_for_few_lanes_is_seen(zero):
    system = stated(PIEZO_STACK)["system"]
    system["names"]["N"] = COUNT
    assert not check_system(SPEC, system).reasons
    system["rates"]["p"] += f" + F_ext*{zero}"
    assert "system" in check_system(SPEC, system).reasons


def _more_energy(system, text):
    system["energy"] += f" + {text}"


FORGERIES = {
    "no rate": lambda system: system["rates"].pop("q"),
    "one rate too many": lambda system: system["rates"].update(r="0"),
    "a rate of zero": lambda system: system["rates"].update(S="0"),
    "an entropy that only falls": lambda system: system["rates"].update(S="-F_damper*v_mass/T"),
    "a choice in a rate": lambda system: system["rates"].update(q="v_mass if T > T_0 else -v_mass"),
    "a name of itself": lambda system: system["names"]["F_damper"].update(
        law="F_damper + d*v_mass"
    ),
    "a name of the spec": lambda system: system["names"].update(d=COUNT),
    "an output's sign": lambda system: system["outputs"].update(load="-v_mass"),
    "the output of another port": lambda system: system["outputs"].update(load="T"),
    "an energy without a store": lambda system: system.update(
        energy=system["energy"].replace(" + p**2/(2*M)", "")
    ),
    "an energy of co-states": lambda system: _more_energy(system, "v_mass*F_spring"),
    "an energy of a temperature": lambda system: _more_energy(system, "1000*T*c_0"),
    "an energy of inputs": lambda system: _more_energy(system, "F_ext*T_e"),
    "an energy of each lane": lambda system: _more_energy(system, "sum(hysteron, k*q**2) - k*q**2"),
    "the co-state of another store": lambda system: system["names"]["v_mass"].update(law="p/L"),
}


@pytest.mark.parametrize("name", FORGERIES)
def test_a_forged_system_is_not_that_of_the_network(name):
    system = stated(PIEZO_STACK)["system"]
    FORGERIES[name](system)
    assert system != stated(PIEZO_STACK)["system"]
    assert check_system(SPEC, system).reasons


@pytest.mark.parametrize("condition", ["d >= 0", "T > T_0", "rho >= 0", "T_e > T_0"])
def test_a_condition_that_the_proofs_alone_have_is_none(condition):
    """All of the proofs is of the spec with the condition; the spec is without."""
    text = PIEZO_STACK.replace(f'"{condition}", ', "")
    assert text != PIEZO_STACK
    assert refused(text, stated(PIEZO_STACK))


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('"d*v"', '"-d*v"'),
        ('between = ["in", "gnd"]', 'between = ["gnd", "in"]'),
        ("count = 2 ", ""),
        ('ratio = "a*T/T_0"', 'ratio = "a*T_0/T"'),
        ('conductance = "lam"', 'conductance = "-lam"'),
        ('"T_0*exp(S/c_0)"', '"T_0*exp(-S/c_0)"'),
        ('heats = "body"\nstate = "phi"', 'heats = "body"\ndiscontinuous = true\nstate = "psi"'),
        ('electrical = ["cap", "gnd"]', 'electrical = ["in", "gnd"]'),
    ],
)
def test_proofs_of_another_spec_are_not_confirmed(old, new):
    text = PIEZO_STACK.replace(old, new)
    assert text != PIEZO_STACK
    assert refused(text, stated(PIEZO_STACK))


def test_divisors_that_vanish_somewhere_show_nothing():
    """The law gives power where both sides agree; there the stated term is 0/0."""
    law = f"a_1*v*(2*{APART}**2 - 1)"
    text = f"(a_1*v*{APART} + a_1*v*({SIDES[0]}*{SIDES[0]} - {SIDES[0]}))/{APART}"
    certificate = [{"guards": [], "terms": [term(text, "a_1*v_1", "s")]}]
    assert "prefactor*f(s)" in checked(law, certificate)


def test_a_law_without_f_needs_its_sign():
    terms = [term("a*v", "a*v*v", None, scale={})]
    assert "sign of a prefactor" in checked("a*v", [{"guards": [], "terms": terms}])
    terms = [term("a*v", "-a*v*v", None, sign=-1, scale={})]
    assert checked("a*v", [{"guards": [], "terms": terms}])


@pytest.mark.parametrize("guards", [[], ["a > 0", "a <= 0"], ["a > 1 - a"]])
def test_other_guards_show_nothing(guards):
    law = f"{NEAR_ZERO} if a > 0 else -{SOFTPLUS}"
    certificate = [{**HOLDS[NEAR_ZERO][0], "guards": guards}]
    assert checked(law, certificate)


@pytest.mark.parametrize(
    ("f", "window"),
    [
        ("s - 1/100", ["0", "inf", 0]),
        ("s*(s - 3)*(s - 3.001)", ["0", "inf", 0]),
        ("s if s < 5 else 5 - s", ["0", "inf", 0]),
        ("sqrt(abs(s))*sign(s - 1/10)", ["0", "inf", 0]),
        ("saturate(s, 1) - deadzone(s, 4)", ["0", "inf", 0]),
        ("sin(s)", ["0", "inf", 0]),
        ("s*log(abs(s))", ["0", "inf", 0]),
        ("s", ["0", "100", 0]),
        ("s", ["-1", "inf", 0]),
        ("s", ["1", "inf", 0]),
    ],
)
def test_windows_are_looked_at(f, window):
    rays = [{"centre": "0", "side": side, "windows": [window]} for side in (1, -1)]
    law = "F_1*({})".format(re.sub(r"\bs\b", "(v/v_1)", f))
    assert checked(law, [{"guards": [], "terms": [{**term(law, "F_1", f), "rays": rays}]}])


def test_windows_whose_ends_are_exchanged_cover_nothing():
    f, law = "s*(s - 1)*(s - 2)", "F_1*(v/v_1*(v/v_1 - 1)*(v/v_1 - 2))"
    right = [["1", "0", 0], ["2", "1", 0], ["2", "inf", 0]]
    rays = [
        {"centre": "0", "side": 1, "windows": right},
        {"centre": "0", "side": -1, "windows": [["0", "inf", 0]]},
    ]
    assert checked(law, [{"guards": [], "terms": [{**term(law, "F_1", f), "rays": rays}]}])


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        ("sqrt(x)**2", "x", True),
        ("sqrt(4*x)**2", "x", False),
        ("sqrt(-x)**2", "x", False),
        ("(8*x)**(1/3)*(8*x)**(2/3)", "x", False),
    ],
)
def test_a_root_keeps_the_factor_of_its_argument(one, other, same):
    assert Field().same(parse(one), parse(other)) == same


def test_a_mirrored_law_has_values_where_it_is_called_odd():
    """W(-v) = -W(v) says nothing where W(-v) has no value."""
    law = "F_1*v/v_1*(1 + log(v/v_1) - log(v/v_1))"
    text = mass(law, "p_mass > 0").replace("[elements]", "[initial]\np_mass = 1.0\n[elements]")
    assert ("odd", "damper") not in {
        (row.id, row.element)
        for row in decide(derive(load_text(text))).rows
        if row.verdict is Verdict.PROVED
    }


def test_a_law_that_is_active_in_a_hidden_corner_is_not_confirmed():
    text = mass("a_1*v if a > -1e6*a_1 else -a_1*v")
    assert "does not follow" in refused(text, forged(text))["passive", "damper"]
