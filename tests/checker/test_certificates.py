"""Laws that intervals decide: handmade certificates, whole and with one thing wrong."""

import copy
import json

import pytest
from stated import forged, mass, refused

from tests.proofs.user_laws import DOMAIN, ORDER, PASSIVE, decided, split

#: Names of those laws that the spec has not, whatever their units.
WORDS = [name for name in ORDER if name not in ("a", "F_1", "v_1", "k", "T_0", "p", "v", "T")]

BOTH = [
    {"centre": "0", "side": 1, "windows": [["0", "1/16", 8], ["1/16", "8", 2], ["8", "inf", 2]]},
    {"centre": "0", "side": -1, "windows": [["0", "1", 8], ["1", "inf", 2]]},
]


def term(law, prefactor, f, sign=1, scale=None):
    scale = {"v_1": 1} if scale is None else scale
    parts = {"law": law, "prefactor": prefactor, "sign": sign, "scale": scale, "f": f}
    return {**parts, "rays": copy.deepcopy(BOTH)}


NEAR_ZERO = "F_1*v/v_1*(exp(v/v_1) - 2.7*v/v_1)"
SOFTPLUS = "F_1*log(1 + exp(v/v_1)) - F_1*log(2)"
GUARDED = f"{NEAR_ZERO} if a > 0 else -a*v*(2 + cos(v/v_1))"
WHOLE = [
    {"centre": "0", "side": 1, "windows": [["0", "inf", 0]]},
    {"centre": "0", "side": -1, "windows": [["0", "inf", 0]]},
]


def whole(law, prefactor, f, scale=None):
    """Return a certificate of one term, of a function with a sign on both sides of zero."""
    return [{"guards": [], "terms": [{**term(law, prefactor, f, scale=scale), "rays": WHOLE}]}]


ROOT = "F_1*sqrt(abs(v)/v_1)*sign(v)"
PER_ROOT = "F_1*v/sqrt(v_1**2 + v**2)"
SATURATED = "F_1*saturate(2*v, v_1)/v_1"
DEAD = "F_1*deadzone(tanh(v/v_1), 1/2)"
SWITCHED = "F_1*(exp(v/v_1) - 1) if v < 10*v_1 else F_1*(exp(10)*(v/v_1 - 9) - 1)"
TOUCHING = "F_1*v/v_1*(3*v/v_1 - 1)**2"
CUBIC = "a_1*v**3/v_1**2"
MENDED = {
    ROOT: whole(ROOT, "F_1*v_1**(-0.5)", "abs(s)**0.5*sign(s)", {}),
    PER_ROOT: whole(PER_ROOT, "F_1", "s/(1 + s**2)**0.5"),
    SATURATED: whole(SATURATED, "F_1", "saturate(2*s, 1)"),
    DEAD: whole(DEAD, "F_1", "deadzone(tanh(s), 1/2)"),
    SWITCHED: whole(SWITCHED, "F_1", "exp(s) - 1 if s < 10 else exp(10)*(s - 9) - 1"),
    TOUCHING: whole(TOUCHING, "F_1", "s*(3*s - 1)**2"),
    CUBIC: whole(CUBIC, f"({CUBIC})*v", None, {}),
}
HOLDS = {
    NEAR_ZERO: [{"guards": [], "terms": [term(NEAR_ZERO, "F_1", "s*(exp(s) - 2.7*s)")]}],
    SOFTPLUS: [{"guards": [], "terms": [term(SOFTPLUS, "F_1", "log(1 + exp(s)) - log(2)")]}],
    GUARDED: [
        {"guards": ["a > 0"], "terms": [term(NEAR_ZERO, "F_1", "s*(exp(s) - 2.7*s)")]},
        {
            "guards": ["a <= 0"],
            "terms": [term("-a*v*(2 + cos(v/v_1))", "a*v_1", "-s*(2 + cos(s))", sign=-1)],
        },
    ],
}


def checked(law, certificate):
    """Return why the row is not confirmed, or nothing."""
    text = mass(law)
    proofs = forged(text)
    for row in proofs["obligations"]:
        if (row["id"], row["element"]) == ("passive", "damper"):
            row["certificate"] = certificate
    return refused(text, proofs).get(("passive", "damper"), "")


@pytest.mark.some(2)
@pytest.mark.parametrize("law", HOLDS | MENDED)
def test_a_certificate_confirms_its_law(law):
    """Roots and saturations of s, windows that end at a choice, a term without f among them."""
    assert checked(law, (HOLDS | MENDED)[law]) == ""


def test_a_case_that_holds_nowhere_needs_no_terms():
    never = {"guards": ["F_1 < 0"], "terms": [term("-F_1", "1", "s")]}
    always = {"guards": ["F_1 >= 0"], "terms": HOLDS[NEAR_ZERO][0]["terms"]}
    assert checked(NEAR_ZERO, [never, always]) == ""


def proved_laws():
    """Return laws as users write them, every twelfth for the fast tier."""
    marks = [[] if n % 12 == 0 else [pytest.mark.long] for n in range(len(split(PASSIVE)))]
    return [pytest.param(law, marks=m) for law, m in zip(split(PASSIVE), marks, strict=True)]


@pytest.mark.some(2)
@pytest.mark.parametrize("law", proved_laws())
def test_what_intervals_prove_of_users_laws_is_confirmed(law):
    """Each with the certificate that intervals alone give, though a solver may do without."""
    names = "\n".join(f'{name} = {{ value = 1, unit = "1" }}' for name in WORDS)
    text = mass("a_1*v").replace("[parameters]", f"[parameters]\n{names}")
    text = text.replace('"a_1*v"', f'"{law}"')
    given = ", ".join(f'"{condition}"' for condition in DOMAIN)
    text = text.replace("assume = [", f"assume = [{given}, ")
    shown = [case.as_data() for case in decided(law).certificate]
    rows = [
        {"id": name, "element": "damper", "verdict": "PROVED"} for name in ("welldef", "passive")
    ]
    proofs = {"obligations": [rows[0], {**rows[1], "certificate": json.loads(json.dumps(shown))}]}
    found = refused(text, proofs)
    assert ("passive", "damper") not in found


FLAWS = {
    "another law": (lambda t: t.update(law="F_1*v/v_1"), "make up the law"),
    "another function": (lambda t: t.update(f="s*(exp(s) - 2.6*s)"), "prefactor*f(s)"),
    "another prefactor": (lambda t: t.update(prefactor="2*F_1"), "prefactor*f(s)"),
    "another scale": (lambda t: t.update(scale={"v_1": 2}), "prefactor*f(s)"),
    "a scale that may be negative": (lambda t: t.update(scale={"a": 1}), "prefactor*f(s)"),
    "the other sign": (lambda t: t.update(sign=-1), "sign of a prefactor"),
    "one side alone": (lambda t: t["rays"].pop(), "cover the line"),
    "no windows": (lambda t: t["rays"].clear(), "cover the line"),
    "a gap": (lambda t: t["rays"][0]["windows"].pop(1), "cover the line"),
    "no infinity": (lambda t: t["rays"][0]["windows"].pop(2), "cover the line"),
    "windows that turn": (
        lambda t: t.update(
            rays=[{"centre": c, "side": 1, "windows": [["0", "inf", 0]]} for c in "21"]
        ),
        "cover the line",
    ),
    "no side": (lambda t: t["rays"][0].update(side=0), "not shown to have its sign"),
    "a side of two": (lambda t: t["rays"][0].update(side=2), "not shown to have its sign"),
    "a number without end": (
        lambda t: t["rays"][0].update(windows=[["0", "1e999999999", 0]]),
        "too many digits",
    ),
    "a number by zero": (lambda t: t["rays"][0].update(centre="1/0"), "cannot be read"),
    "a root of the scale": (lambda t: t.update(scale={"v_1": "1/2"}), "prefactor*f(s)"),
    "no number": (lambda t: t["rays"][0].update(centre="here"), "no finite number"),
    "nothing": (lambda t: t.clear(), "cannot be read"),
}


@pytest.mark.some(4)
@pytest.mark.parametrize("name", FLAWS)
def test_a_flawed_certificate_confirms_nothing(name):
    change, why = FLAWS[name]
    certificate = copy.deepcopy(HOLDS[NEAR_ZERO])
    change(certificate[0]["terms"][0])
    assert why in checked(NEAR_ZERO, certificate)


def test_cases_have_to_cover_the_domain():
    assert "cover the domain" in checked(GUARDED, HOLDS[GUARDED][:1])
    assert "cover the domain" in checked(NEAR_ZERO, [{"guards": ["v > 0"], "terms": []}])
    assert "make up the law" in checked(
        GUARDED, [{**case, "guards": []} for case in HOLDS[GUARDED]]
    )


@pytest.mark.some(1)
@pytest.mark.parametrize("power", ["2.72", "2.75"])
def test_a_function_that_gives_power_has_no_certificate(power):
    law = f"F_1*v/v_1*(exp(v/v_1) - {power}*v/v_1)"
    certificate = [{"guards": [], "terms": [term(law, "F_1", f"s*(exp(s) - {power}*s)")]}]
    assert "not shown to have its sign" in checked(law, certificate)


def test_a_prefactor_without_a_value_is_refused():
    law, front = "F_1*v/v_1", "F_1*(a/a)"
    certificate = [{"guards": [], "terms": [term(law, front, "s")]}]
    assert "sign of a prefactor" in checked(law, certificate)
