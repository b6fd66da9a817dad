"""False laws of slips: none is PROVED passive, or rate-independent, where numbers say it is not.

The oracle runs each law as Python, whose functions are typed here; nothing of the package.
"""

import math
from pathlib import Path

import numpy as np
import pytest

from piezo_sym import derive
from piezo_sym.proofs import obligations, prove
from piezo_sym.proofs.solvers import opinions
from piezo_sym.spec.load import parse

TEXT = (Path(__file__).parents[1] / "networks" / "specs" / "slips.toml").read_text(encoding="utf-8")
OLD = "(beta*abs(v)*sign(f) + gam*v)*abs(f/f_0)**n"
WEN = "(beta*abs(v)*sign(f) + gam*v)*abs(f)**n"

#: Of each domain, laws that take no power in somewhere.
ACTIVE = {
    "beta >= 0": (
        WEN,
        "beta*abs(v)*sign(f) + gam*v",
        "beta*abs(v)*(f - 0.001)",
        "beta*abs(v)*deadzone(f, 1) - 0.001*abs(v)*f",
        "abs(v)*f**2",
        "abs(v)*sign(f - 1)",
        "abs(v)*tanh(f + 0.01)",
        "abs(v)*(tanh(f) - 0.9*f)",
        "abs(v)*(f - 0.3*f**3)",
        "abs(v)*sin(f)",
        "v*f",
        "max(v, 0)*f + 0.1*min(v, 0)*f",
        "max(v, -0.1)*f",
        "(abs(v) - 0.001)*f",
        "(v + abs(v)*0.999)*f",
        "abs(v)*(f + 0.5*sign(v))",
        "abs(v)*f + 0.001*v",
        "abs(v)*f if abs(f) < 1 else v",
        "v if v*f > -0.001 else 0",
        "saturate(f, beta)*v",
        "saturate(f, 1)*abs(v) - 0.002*abs(v)*sign(f)",
        "beta*abs(v)*f/(1 + abs(f)) - beta*v*0.01",
        "abs(v)*f*(1 - abs(f))",
        "abs(v)*f*exp(-abs(f)) - 0.0001*abs(v)*f",
        "(T/T_0 - 1)*abs(v)*f",
        "abs(v)*abs(f)**n",
        "abs(v)*sign(f)*(abs(f)**n - abs(f)**(2*n))",
        "abs(v)*sign(f)*(abs(f)**n - abs(f)**(n/2))",
        "abs(v)*sign(f)*(2 - abs(f)**n)",
        "abs(v)*sign(f)*log(0.5 + abs(f)**n)",
        "abs(v)*sign(f)*sign(n - 1)*abs(f)**n",
        "(abs(beta)**n*abs(v)*sign(f) + abs(gam)**n*v)*abs(f)",
    ),
    "beta >= gam": (WEN,),
    "beta >= abs(gam)**n": (WEN,),
    "abs(beta)**n >= abs(gam)**n": (WEN,),
    "beta >= -gam": (WEN,),
    "beta**2 >= gam**2": (WEN,),
    "beta + 0.001 >= abs(gam)": (WEN,),
    "1.1*beta >= abs(gam)": (WEN,),
    "abs(beta) >= abs(gam)": (WEN,),
    "beta >= abs(gam)": (
        "(beta*abs(v)*sign(f) + gam*v)*f",
        "(beta*abs(v) + gam*v)*abs(f)",
        "beta*abs(v)*f + gam*v*abs(f)**2",
        "beta*abs(v)*f**3 + gam*v*abs(f)",
    ),
}
#: Laws that do not go with the rate alone.
DEPENDENT = (
    "v*abs(v)*f + abs(v)*f",
    "v**2*f",
    "f",
    "abs(v)*f + 1e-6*f",
    "abs(v)*f + 1e-6*f*v**2",
    "sqrt(v**2 + 1e-6)*f",
    "sqrt(v**2 + f**2)*f",
    "tanh(abs(v))*f",
    "v*tanh(v)*f",
    "v*tanh(1000*v)*f",
    "abs(v)*tanh(f*abs(v))",
    "min(abs(v), 100)*f",
    "max(abs(v), 0.001)*f",
    "deadzone(v, 0.001)*sign(v)*f",
    "saturate(abs(v), 1000)*f",
    "abs(v)*f*exp(-abs(v)/1000)",
    "abs(v)*f*(1 + 0.001*sin(v))",
    "abs(v)*f*log(3 + abs(v))",
    "v**2/(abs(v) + 0.0001)*f",
    "sqrt(abs(v))*f",
    "abs(v)*abs(v)/sqrt(v**2 + 1e-8)*f",
    "abs(v)*f if abs(v) < 1000 else f",
    "abs(v)*f if v < 1000 else 2*abs(v)*f",
    "abs(v)*f if abs(v) > 1e-3 else 0",
    "atan(abs(v))*f",
    "abs(v)*f/(1 + 1e-6*abs(v))",
    "abs(v)*f*(1 + 1e-6*v)**2",
    "max(v, -0.1)*f",
    "(abs(v) - 0.001)*f",
    "v if v*f > -0.001 else 0",
    "abs(v)**n*f",
    "abs(v*f)**n*sign(f)",
    "abs(v)*f*abs(f + v)**n",
    "abs(v)*f*(1 + 0.001*abs(v)**n)",
    "max(abs(v), abs(v)**n)*f",
    "abs(v)*sign(f)*(abs(f)**n if abs(v) < 10 else abs(f)**(2*n))",
)
#: Bases and exponents, and what the domain says of n: the power has no value somewhere.
VALUELESS = (
    *(("abs(f)", "n", domain) for domain in ("n >= 0", "n > -1", "n**2 > 0", "n < 2", "n > gam")),
    *(("abs(f)", n, "n > 0") for n in ("n - 1", "1 - n", "n*gam", "n - n", "n - gam", "sin(n)")),
    *(("abs(f)", n, "n > 0") for n in ("log(n)", "exp(n) - 2", "min(n, gam)", "deadzone(n, 1)")),
    *(("abs(f)", n, "n > 0") for n in ("n if gam > 0 else 0", "n if n > 1 else n - 1", "-n")),
    *((x, "n", "n > 0") for x in ("f", "gam*abs(f)", "abs(f)*f", "sign(f)", "max(f, -1)")),
    *((x, "n", "n > 0") for x in ("min(f, 1)", "max(f, gam)", "deadzone(f, 1)", "abs(f) - 1")),
    *((x, "n", "n > 0") for x in ("f if f > -1 else 0", "saturate(f, 1)", "abs(f)**n - 1")),
    *((x, "n", "n > 0") for x in ("abs(f)/gam", "abs(f)/f", "(abs(f)/abs(f))", "2*f*abs(gam)")),
)
FUNCTIONS = {
    "abs": abs,
    "max": max,
    "min": min,
    "sign": lambda x: math.copysign(1, x) if x else 0.0,
    "deadzone": lambda z, w: max(z - w, 0) + min(z + w, 0),
    "saturate": lambda z, w: min(max(z, -w), w),
    **{name: getattr(math, name) for name in ("exp", "log", "sqrt", "sin", "tanh", "atan")},
}
CASES = [
    *((law, domain, "passive") for domain, laws in ACTIVE.items() for law in laws),
    *((law, "beta >= 0", "rate-independent") for law in DEPENDENT),
]


def verdict(law, domain, row):
    """Return the verdict on a row of a slip, as the prover alone has it."""
    return verdicts(law, domain)[row]


def verdicts(law, domain, exponent="n > 0"):
    """Return the verdict on each row of a slip."""
    text = TEXT.replace(f'"{OLD}"\nheats ', f'"{law}"\ndiscontinuous = true\nheats ')
    text = text.replace('"n > 0"', f'"{exponent}"').replace(
        "n    = { value = 2.0", "n = { value = 0.5"
    )
    iphs = derive(
        parse(text.replace("beta >= abs(gam)", domain).replace('slip        = "beta*', 'slip = "'))
    )
    rows, asked = [], opinions()
    for obligation in obligations(iphs):
        if obligation.id == "temperature" or obligation.element == "wen":
            rows.append(prove(obligation, iphs, rows, asked))
    return {found.id: found.verdict.value for found in rows if found.element == "wen"}


def points(domain, count=4000):
    """Yield points of a domain: large and small, near each other, of either sign."""
    rng = np.random.default_rng(1)
    for _ in range(count):
        beta, gam, v, f = rng.choice([-1, 1], 4) * 10.0 ** rng.uniform(-4, 4, 4)
        gam = beta * rng.uniform(-1.2, 1.2) if rng.random() < 0.5 else gam
        f = rng.uniform(-3, 3) if rng.random() < 0.5 else f
        n = 10.0 ** rng.uniform(-1, 1)
        at = {
            "n": n,
            "beta": beta,
            "gam": gam,
            "v": v,
            "f": f,
            "T": rng.uniform(30, 3000),
            "T_0": 300.0,
        }
        if eval(domain, FUNCTIONS, at):
            yield at, 10.0 ** rng.uniform(-3, 3)


def is_false(law, domain, row):
    """Return whether numbers break a row."""
    for at, c in points(domain):
        slip = eval(law, FUNCTIONS, at)
        if row == "passive" and slip * at["f"] < 0:
            return True
        fast = eval(law, FUNCTIONS, at | {"v": c * at["v"]}) if row != "passive" else 0.0
        if row != "passive" and abs(fast - c * slip) > 1e-8 * (abs(fast) + abs(c * slip)):
            return True
    return False


def test_all_of_these_laws_are_false_and_there_are_enough():
    assert len(CASES) >= 60
    assert [case for case in CASES if not is_false(*case)] == []


@pytest.mark.some(2)
@pytest.mark.parametrize("case", CASES[::8], ids=lambda case: f"{case[2]} of {case[0]}")
def test_a_false_slip_law_is_not_proved(case):
    assert verdict(*case) != "PROVED"


@pytest.mark.long
@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case[2]} of {case[0]}, {case[1]}")
def test_no_false_slip_law_is_proved(case):
    assert verdict(*case) != "PROVED"


def has_no_value(base, exponent, domain):
    """Return whether numbers show a power of what is negative, or of zero with no n > 0."""
    rng = np.random.default_rng(1)
    for _ in range(4000):
        signs = rng.choice([-1, 0, 1], 4, p=[0.4, 0.2, 0.4])
        beta, gam, n, f = (signs * 10.0 ** rng.uniform(-1, 1, 4)).tolist()
        at = {**FUNCTIONS, "beta": beta, "gam": gam, "n": n, "f": f}
        if not (beta >= abs(gam) and eval(domain, at)):
            continue
        try:
            x, power = eval(base, at), eval(exponent, at)
        except ZeroDivisionError:
            return True
        if isinstance(x, complex) or x < 0 or (x == 0 and power <= 0):
            return True
    return False


def test_all_of_these_powers_lack_a_value_somewhere():
    assert [case for case in VALUELESS if not has_no_value(*case)] == []


@pytest.mark.some(1)
@pytest.mark.parametrize("case", VALUELESS, ids=lambda case: f"({case[0]})**({case[1]}), {case[2]}")
def test_no_power_without_a_value_is_proved_to_have_one(case):
    base, exponent, domain = case
    law = f"(beta*abs(v)*sign(f) + gam*v)*({base})**({exponent})"
    assert "PROVED" not in verdicts(law, "beta >= abs(gam)", domain).values()


def test_what_the_laws_are_edits_of_is_proved():
    assert verdict(WEN, "beta >= abs(gam)", "passive") == "PROVED"
    assert verdict(WEN, "beta >= abs(gam)", "rate-independent") == "PROVED"
