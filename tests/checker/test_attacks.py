"""Forged proofs: each claims something false, or leaves out what makes it true."""

import re
from functools import cache

import pytest
from stated import PIEZO_STACK, forged, mass, refused, stated
from test_certificates import HOLDS, NEAR_ZERO, SOFTPLUS, checked, term
from test_not_confirmed import TWO_BANKS

from piezo_sym import derive
from piezo_sym.checker import read_spec
from piezo_sym.checker.field import Field
from piezo_sym.checker.laws import parse
from piezo_sym.checker.network import is_linear
from piezo_sym.checker.system import Finding
from piezo_sym.proofs import Verdict, decide
from piezo_sym.spec.load import parse as load_text

shipped = cache(lambda: read_spec(PIEZO_STACK))
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
    "(exp(1) + exp(2) - exp(1 - (N - 1)*(N - 3)) - exp(2 + (N - 1)*(N - 3)))",
    "(exp(N/2 - 1/2) + exp(N/2 + 1/2) + exp(3 - N) - exp(N - 1) - exp(3/2 - N/2) - exp(5/2 - N/2))",
    "((1 if N - N + 1 > 0 else 0) + (1 if N - N + 2 > 0 else 0)"
    " - (1 if 1 - (N - 1)*(N - 3) > 0 else 0) - (1 if 2 + (N - 1)*(N - 3) > 0 else 0))",
)


@pytest.mark.some(10)
@pytest.mark.parametrize("zero", FEW_LANES)
def test_what_vanishes_for_few_lanes_is_seen(zero):
    system = stated(PIEZO_STACK)["system"]
    system["names"]["N"] = COUNT
    assert not Finding(shipped(), system).reasons
    system["rates"]["p"] += f" + F_ext*{zero}"
    assert "system" in Finding(shipped(), system).reasons


def test_two_banks_need_not_have_as_many_lanes():
    text = TWO_BANKS.replace('"R*i*(1 - (i/i_1)**2)"', '"R*i"\ncount = 3')
    proofs = stated(text)
    assert refused(text, proofs) == {}
    proofs["system"]["rates"]["phi_2"] += " + V*(sum(h, 1) - sum(h_j, 1))"
    assert ("system", "") in refused(text, proofs)


@pytest.mark.parametrize("root", ["sqrt(q*q)", "exp(log(q*q)/2)"])
def test_an_energy_with_a_step_is_seen(root):
    """Its derivative is right wherever it has one."""
    proofs = stated(PIEZO_STACK)
    proofs["system"]["energy"] += f" + k*{root}/q"
    assert {("skew", ""), ("energy", "")} <= set(refused(PIEZO_STACK, proofs))


@pytest.mark.parametrize(
    "zero", ["max({0} - 3, 0)", "(q if {0} > 3 else 0)", "({0} - 1)*({0} - 2)"]
)
def test_an_energy_of_many_lanes_is_seen(zero):
    system = stated(PIEZO_STACK)["system"]
    system["energy"] += f" + k*q*q_l*{zero.format('sum(hysteron, 1)')}"
    assert Finding(shipped(), system).reasons


def _more_energy(system, text):
    system["energy"] += f" + {text}"


FORGERIES = {
    "no rate": lambda system: system["rates"].pop("q"),
    "one rate too many": lambda system: system["rates"].update(r="0"),
    "a rate of zero": lambda system: system["rates"].update(S="0"),
    "an entropy that only falls": lambda system: system["rates"].update(S="-F_damper*v_mass/T"),
    "a choice in a rate": lambda system: system["rates"].update(
        q="v_mass if T > 2*T_0 else -v_mass"
    ),
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
    "an energy of a lane alone": lambda system: _more_energy(system, "phi - phi"),
    "an energy of sums in sums": lambda system: _more_energy(
        system, "(sum(hysteron, phi*sum(hysteron, phi)) - sum(hysteron, phi)**2)/L"
    ),
    "a choice's factor": lambda system: system["rates"].update(
        p=system["rates"]["p"] + " + F_ext*((1 if T > T_0 else 0) - (1 if d*T > d*T_0 else 0))"
    ),
    "the other lanes' voltages": lambda system: system["rates"].update(
        phi=system["rates"]["phi"] + " + sum(hysteron, V_hysteron) - V_hysteron"
    ),
    "another store's co-state under a new name": lambda system: (
        system["names"].update(
            x={"element": "mass", "role": "temperature", "bank": None, "law": "p/M + 1"}
        ),
        system["rates"].update(q="x"),
    ),
    "the co-state of another store": lambda system: system["names"]["v_mass"].update(law="p/L"),
}


@pytest.mark.some(10)
@pytest.mark.parametrize("name", FORGERIES)
def test_a_forged_system_is_not_that_of_the_network(name):
    proofs = stated(PIEZO_STACK)
    FORGERIES[name](proofs["system"])
    assert proofs["system"] != stated(PIEZO_STACK)["system"]
    assert not {("system", ""), ("energy", "")}.isdisjoint(refused(PIEZO_STACK, proofs))


@pytest.mark.parametrize("condition", ["d >= 0", "T > T_0", "rho >= 0", "T_e > T_0"])
def test_a_condition_that_the_proofs_alone_have_is_none(condition):
    """All of the proofs is of the spec with the condition; the spec is without."""
    text = PIEZO_STACK.replace(f'"{condition}", ', "")
    assert text != PIEZO_STACK
    assert refused(text, stated(PIEZO_STACK))


@pytest.mark.some(3)
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
    assert "make up the law" in checked(law, certificate)


HIDDEN = {
    "a choice": ("-a_1*v/2 if a > 0 else a_1*v/(0 if a > 0 else 1)", "1 if a > 0 else 0"),
    "a choice squared": ("-a_1*v/2 if a > 0 else a_1*v*(1 - {0})/(1 - {0}**2)", SIDES[0]),
}


@pytest.mark.parametrize("name", HIDDEN)
def test_a_branch_that_divides_by_zero_where_it_is_not_taken_hides_nothing(name):
    law, side = HIDDEN[name]
    law = law.format(side)
    stated_law = f"a_1*v*(1 - ({side})/2)"
    terms = [term(stated_law, f"a_1*v_1*(1 - ({side})/2)", "s")]
    assert "make up the law" in checked(law, [{"guards": [], "terms": terms}])


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("x if y > 0 else z/(0 if y > 0 else 1)", "z + (x if y > 0 else 0)"),
        ("0 if y > 0 else z/(0 if y > 0 else 1)", "z"),
        ("0 if y > 0 else z*(0 if y > 0 else 1)**(-1)", "z"),
        ("x if y > 0 else z/(sqrt(4*x) - 2*sqrt(x))*(sqrt(4*x) - 2*sqrt(x))", "x if y > 0 else z"),
        ("x/max(y, 0)*max(y, 0)", "x"),
    ],
)
def test_what_is_zero_on_one_side_is_not_cancelled(one, other):
    assert Field().same(parse(one), parse(one))
    assert not Field().same(parse(one), parse(other))


def test_a_law_that_ends_is_not_linear():
    law = parse("0*v if v > w else v/(0 if v > w else 1)")
    assert not is_linear(law, "v")


def test_a_law_without_f_needs_its_sign():
    terms = [term("a*v", "a*v*v", None, scale={})]
    assert "sign of a prefactor" in checked("a*v", [{"guards": [], "terms": terms}])
    terms = [term("a*v", "-a*v*v", None, sign=-1, scale={})]
    assert checked("a*v", [{"guards": [], "terms": terms}])


@pytest.mark.some(2)
@pytest.mark.parametrize("guards", [[], ["a > 0", "a <= 0"], ["a > 1 - a"]])
def test_other_guards_show_nothing(guards):
    law = f"{NEAR_ZERO} if a > 0 else -{SOFTPLUS}"
    certificate = [{**HOLDS[NEAR_ZERO][0], "guards": guards}]
    assert checked(law, certificate)


@pytest.mark.some(1)
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


def test_a_gap_below_rounding_is_a_gap():
    end = "1/3 + 1/10**16/10**14"
    f, law = (f"{x}*({x} - 1/3)*({x} - ({end}))" for x in ("s", "(v/v_1)"))
    other = f"{10**30 + 3}/{3 * 10**30}"
    rays = [
        {"centre": "0", "side": 1.0, "windows": [["0", "1/3", 0], [other, "inf", 0]]},
        {"centre": "0", "side": -1, "windows": [["0", "inf", 0]]},
    ]
    law = f"F_1*{law}"
    terms = [{**term(law, "F_1", f), "rays": rays}]
    assert "cover the line" in checked(law, [{"guards": [], "terms": terms}])


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
        ("sqrt(x/y)**2", "x/y", True),
        ("sqrt(x*y)", "sqrt(x)*sqrt(y)", False),
        ("sqrt(x**2)", "x", False),
        ("x**(1/2)*x**(1/3)", "x**(1/6)", False),
        ("(1 if x > 0 else 0)**2", "1 if x >= 0 else 0", False),
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
