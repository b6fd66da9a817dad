"""Laws decided as a whole: what is proved is true, and its certificate says why."""

import json
import random
import re
from fractions import Fraction
from itertools import islice
from math import tanh

import pytest

from piezo_sym import derive
from piezo_sym.errors import SpecError
from piezo_sym.expressions.parse import parse_condition, parse_law
from piezo_sym.expressions.tree import Cmp, Sym, names
from piezo_sym.proofs import Verdict, decide
from piezo_sym.proofs.obligations import SignOf
from piezo_sym.proofs.sign_analysis import whole_sign
from piezo_sym.proofs.signs.cases import cases
from piezo_sym.proofs.solvers import solver
from piezo_sym.spec.load import parse as load_text
from tests.proofs import law_oracle as oracle
from tests.proofs.certificates import check, holds, value
from tests.proofs.user_laws import ACTIVE, DOMAIN, ORDER, PASSIVE, decided, points, split


@pytest.fixture(autouse=True)
def _flint():
    pytest.importorskip("flint")


def shown(outcome):
    """Return a certificate as it comes out of a file."""
    return json.loads(json.dumps([case.as_data() for case in outcome.certificate]))


def confirm(law, domain, outcome, at):
    """Check a verdict by the law's text: its certificate, its sign at points, or its witness."""
    if outcome.verdict is Verdict.PROVED:
        check(shown(outcome), law, "v", at)
        assert all((value(law, p) or 0) * oracle.Digits.constant(p["v"]) >= -1e-25 for p in at)
    if outcome.verdict is Verdict.REFUTED:
        numbers = outcome.numbers
        assert value(law, numbers) * oracle.Digits.constant(numbers["v"]) < 0
        assert all(holds(c, numbers) for c in domain if words(c) <= {*numbers})


def sampled(text):
    """Return laws, every other one for the long tier."""
    marks = ((), (pytest.mark.long,))
    return [pytest.param(law, marks=marks[n % 2]) for n, law in enumerate(split(text))]


def words(text):
    return {*oracle.names_of(oracle.tree_of(text))}


@pytest.mark.some(16)
@pytest.mark.parametrize("law", sampled(PASSIVE))
def test_a_passive_law_is_proved_and_its_certificate_is_true(law):
    outcome = decided(law)
    assert outcome.verdict is Verdict.PROVED
    confirm(law, DOMAIN, outcome, list(points(random.Random(law), 3)))


#: Laws that are active where parameters have values that are not tried.
UNTOLD = (
    "a*(exp(v/v_1) - 1) + b*(exp(v/v_2) - 1)",
    "F_1*(exp(v/b) - 1) if b > -1 else d*v",
    "(a*exp(-v**2/v_1**2) + 1)*F_1*tanh(v/v_1)",
)


@pytest.mark.some(4)
@pytest.mark.parametrize("law", sampled(ACTIVE))
def test_an_active_law_is_refuted(law):
    outcome = decided(law)
    assert outcome.verdict is (Verdict.OPEN if law in UNTOLD else Verdict.REFUTED)
    confirm(law, DOMAIN, outcome, [])


BRANCHES = (
    "F_1*v/v_1*(exp(v/v_1) - 2.7*v/v_1) if a > 0 "
    "else F_1*v/v_1*(exp(v/v_1 - 0.37) - 2.72*(v/v_1 - 0.37))",
    "F_1*(v/v_1 + 4*sin(v/v_1)) if a > 0 else a*(v/v_1 + 4*sin(v/v_1))",
    "(a*tanh(v/v_1)*(2 + sin(v/v_1)) if b > 0 else F_1*tanh(v/v_1)) if a > -2 else F_1*v",
    "F_1*(v/b + 4*sin(v/b)) if b > 0 else F_1*(v + 4*b*sin(v/b))/b",
)


@pytest.mark.parametrize("law", BRANCHES)
def test_what_one_branch_assumes_is_not_used_on_another(law):
    assert decided(law).verdict is not Verdict.PROVED


@pytest.mark.parametrize("width", ["b", "-F_c", "a*F_1"])
def test_no_width_is_taken_to_be_positive(width):
    outcome = decided(f"F_1*tanh(saturate(v, {width})/v_1)")
    assert outcome.verdict is Verdict.REFUTED


def test_a_condition_of_the_domain_that_holds_in_one_branch_is_no_help_in_another():
    domain = ("F_1 > 0", "v_1 > 0", "(a if b > 0 else 1) > 0")
    law = "a*(v/v_1 + 4*sin(v/v_1))"
    assert decided(law, domain).verdict is Verdict.REFUTED
    assert decided(f"{law} if b > 0 else 0", domain).verdict is Verdict.PROVED


def test_a_letter_that_a_state_gives_is_refuted_only_where_the_state_can_be():
    """F is active for v < 0 alone; where v = p**2 that is never so, where v = p it is."""
    law, where = parse_law("F_1*abs(tanh(v/v_1))", "test"), (parse_condition("v_1 > 0", "test"),)
    where = (*where, parse_condition("F_1 > 0", "test"))
    for state, verdict in (("p**2", Verdict.OPEN), ("p", Verdict.REFUTED)):
        tie = Cmp("=", Sym("v"), parse_law(state, "test"))
        outcome = whole_sign(SignOf(law, "v", (*where, tie)), ORDER, solver("z3"))
        assert outcome.verdict is verdict
    assert outcome.numbers["p"] == outcome.numbers["v"] < 0


def guards(law):
    found = cases(parse_law(law, "test"), "v", lambda part: names(part) == ("T_0",))
    return None if found is None else [len(case[0]) for case in found]


def test_a_condition_comes_after_those_that_lead_to_it():
    found = cases(parse_law("(v if a/b > 1 else 0) if b > 0 else -v", "test"), "v", lambda _: False)
    first = [case[0][0] for case in found]
    assert [guard.op for guard in first] == [">", ">", "<="]
    assert {names(guard) for guard in first} == {("b",)}


def test_a_condition_below_a_choice_of_the_letter_is_decided_only_if_it_has_a_value():
    assert guards("(v if a/b > 1 else 0) if v > 0 else -v") == [0]
    assert guards("(v if a/T_0 > 1 else 0) if v > 0 else -v") == [1, 1]
    assert guards("(v if sqrt(a) > 1 else 0) if v > a else -v") == [0]
    assert guards("(v if (1 if a > 0 else 2) > b else 0)") == [2, 2, 2, 2]


def test_too_many_cases_are_not_looked_at():
    law = " + ".join(f"tanh(v*(2 if a > {n} else 1))" for n in range(6))
    assert decided(law, ()) is None


class Laws:
    """Laws of v by chance: parameters of both signs, choices at any depth."""

    FRONTS = "F_1; d; 1; 2; w; a; b; -a; a*b; (a - b); abs(a); max(a, b); a**2; exp(p); a**3; 1/b"
    SCALES = "v_1; v_2; v_1*v_2; (v_1 + v_2); (v_1 + a**2); (v_1*exp(b)); 1; a; b; -v_1; abs(b)"
    PARTS = """
    Z; tanh(Z); exp(Z) - 1; Z + sin(Z); Z*exp(-Z**2); Z/(1 + abs(Z)); log(1 + exp(Z)) - log(2)
    Z + 4*sin(Z); sqrt(abs(Z))*sign(Z); Z - tanh(Z); deadzone(Z, 1); saturate(Z, w); max(Z, 0)
    deadzone(Z, b); max(a*Z, b); sin(Z); abs(Z); exp(Z); (a*Z**2)**(1/2)*Z; sign(a*Z); Z + a; Z**2
    saturate(a*Z, b); exp(Z + a) - exp(a); 1 - exp(-Z); 1 + exp(-Z)
    """
    OWN = "a > 0; b > 0; a > b; a*b > 0; a <= 1; (a if b > 0 else p) >= 0; 1/b > 1; abs(a) < p"
    LETTER = "v > 0; v < v_1; abs(v) > w; a*v > 0; tanh(v/v_1) > b; v**2 >= a"
    DOMAINS = "a > 0; b > 0; a > b; a < 0; a*b > 0; (a if b > 0 else 1) > 0; max(a, b) > 0; p > a"

    def __init__(self, seed):
        self.random = random.Random(seed)

    def one(self, text):
        """Return one of some texts; the first half of them is taken more often."""
        found = split(text)
        return self.random.choice(found[: len(found) // (1 + (self.random.random() < 0.6))])

    def term(self):
        part = self.one(self.PARTS).replace("Z", f"(v/({self.one(self.SCALES)}))")
        front = self.one(self.FRONTS)
        if self.random.random() < 0.2:
            front = f"({front} if {self.one(self.OWN)} else {self.one(self.FRONTS)})"
        return f"{front}*({part})"

    def law(self, depth=2):
        kind = self.random.random() if depth else 1.0
        if kind > 0.7:
            return self.term()
        first, second = self.law(depth - 1), self.law(depth - 1)
        if kind < 0.3:
            return f"({first} if {self.one(self.OWN)} else {second})"
        if kind < 0.45:
            return f"({first} if {self.one(self.LETTER)} else {second})"
        return f"({first} {self.random.choice('++-')} {second})"

    def domain(self):
        some = [self.one(self.DOMAINS) for _ in range(self.random.randint(0, 2))]
        return (*DOMAIN[:5], "w >= 0", *some)


def attack(seed):
    """Decide a random law and confirm the verdict; return it, or None if the law is no law."""
    found = Laws(seed)
    law, domain = found.law(), found.domain()
    try:
        outcome = decided(law, domain)
    except SpecError:  # a constant part without a value
        return None
    if outcome is not None:
        made = points(random.Random(seed), 40)
        inside = (at for at in made if all(holds(condition, at) for condition in domain))
        confirm(law, domain, outcome, list(islice(inside, 12)))
    return outcome and outcome.verdict


@pytest.mark.long
def test_no_random_law_is_wrongly_decided():
    """Some are proved: a test that decides nothing would pass too."""
    verdicts = [attack(f"law {n}") for n in range(20)]
    assert verdicts.count(Verdict.PROVED) >= 3
    assert verdicts.count(Verdict.REFUTED) >= 8


@pytest.mark.long
@pytest.mark.parametrize("part", range(20))
def test_no_law_of_many_is_wrongly_decided(part):
    for n in range(100):
        attack(f"part {part} law {n}")


FRICTION = """[model]
name = "friction"
[parameters]
m = { value = 1.0, unit = "kg" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 2.0, unit = "J/K" }
F_c = { value = 0.5, unit = "N" }
v_0 = { value = 0.3, unit = "m/s" }
v_s = { value = 0.2, unit = "m/s" }
s = { value = 0.6, unit = "1" }
[domain]
assume = ["F_c >= 0", "s >= 0", "s < 1", "v_0 > 0", "v_s > 0", "LIMIT"]
[elements]
mass = { kind = "mass", at = "tip", mass = "m" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)" }
[elements.damper]
kind = "damper"
between = ["tip", "wall"]
heats = "body"
force = "F_c*(tanh(v/v_0) - s*tanh(v/v_s))"
"""


@pytest.mark.some(1)
@pytest.mark.parametrize(("limit", "refuted"), [("v_s < v_0", True), ("v_s >= v_0", False)])
@pytest.mark.parametrize("small", ["", "0.5", "0.3 0.2"])
def test_numbers_near_those_of_the_spec_refute_a_law_that_is_zero_for_simple_ones(
    limit, refuted, small
):
    """The simplest numbers of the domain have F_c = 0 and s = 0; `small` ones are times 1e-7."""
    text = FRICTION
    for short in small.split():
        text = text.replace(f"value = {short},", f"value = {short}e-7,")
    text = text if refuted else re.sub(r"(v_s = { value = )0\.2", r"\g<1>0.4", text)
    text = text.replace("LIMIT", limit)
    (row,) = (row for row in decide(derive(load_text(text))).rows if row.id == "passive")
    assert (row.verdict is Verdict.REFUTED) == refuted
    at = {name: float(Fraction(value)) for name, value in (row.witness or {}).items()}
    if refuted:
        assert 0 < at["v_s"] < at["v_0"]
        slip = at["s"] * tanh(at["v"] / at["v_s"])
        assert at["F_c"] * (tanh(at["v"] / at["v_0"]) - slip) * at["v"] < 0
