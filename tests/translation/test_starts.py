"""Initial values that are listed lane by lane, as numbers and texts, of a model with two banks.

References are the numbers by hand, and mutants of what is printed, of which none may be proved.
"""

import numpy as np
import pytest

from piezo_sym import PiezoError, derive, simulate
from piezo_sym.modules import module_of
from piezo_sym.report import Verdict
from piezo_sym.run.engine.engine import engine_of
from piezo_sym.spec.load import parse
from piezo_sym.translation.program import Reference
from tests.translation.mutants import mutants
from tests.translation.printed import TEXTS, printed, rows
from tests.translation.test_program import verdict

SPEC = """
[model]
name = "listed"
[parameters]
L   = { value = [1.0, 2.0], unit = "H" }
i_0 = { value = [3.0, 5.0], unit = "A" }
C   = { value = 4.0, unit = "F" }
R   = { value = [2.0, 8.0, 5.0], unit = "ohm" }
M   = { value = 7.0, unit = "H" }
R_t = { value = 1.0, unit = "ohm" }
T_0 = { value = 300.0, unit = "K" }
c   = { value = 3.0, unit = "J/K" }
[inputs]
V = { unit = "V", default = 6.0 }
[domain]
assume = ["R > 0", "R_t >= 0"]
[initial]
phi = ["L*i_0", "L*i_0 if V > R_t*i_0 else 2*L*i_0"]
psi = ["M*V/R", 0.25, "-M*V/R"]
Q   = "C*V"
[elements]
supply = { kind = "voltage_source", between = ["in", "gnd"], input = "V" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
[elements.h]
kind = "hysteron"
between = ["in", "n"]
count = 2
inductance = "L"
voltage = "R_t*i"
heats = "body"
state = "phi"
[elements.g]
kind = "hysteron"
between = ["n", "gnd"]
count = 3
inductance = "M"
voltage = "R*i"
heats = "body"
state = "psi"
[elements.c]
kind = "capacitor"
between = ["n", "gnd"]
capacitance = "C"
state = "Q"
"""
#: phi_1, phi_2, psi_1 ... psi_3, Q, by hand for V = 6 V.
STARTS = [3.0, 10.0, 21.0, 0.25, -42 / 5, 24.0]


@pytest.fixture(scope="module")
def iphs():
    return derive(parse(SPEC))


def test_a_run_begins_with_the_lanes_own_values():
    first = simulate(parse(SPEC), duration=1e-3, rtol=1e-9).isel(time=0)
    found = [*first.phi.values, *first.psi.values, float(first.Q)]
    assert np.allclose(found, STARTS, rtol=1e-15)
    more = simulate(parse(SPEC), duration=1e-3, parameters={"L": 0.5, "R": 3.0}).isel(time=0)
    found = [*more.phi.values, *more.psi.values]
    assert np.allclose(found, [1.5, 2.5, 14.0, 0.25, -14.0], rtol=1e-15)


def test_compiled_starts_are_those_of_numpy_and_read_no_lane_that_is_not_there():
    module = module_of(parse(SPEC))
    engine, p = engine_of(module), module.Parameters()
    assert np.array_equal(engine.initial_state([6.0], p), module.initial_state([6.0], p))
    fewer = module.Parameters(L=1.0, i_0=3.0, h_count=1, g_count=4, R=2.0)
    found = engine.initial_state([6.0], fewer)
    assert np.allclose(found, [0.0, 3.0, 21.0, 0.25, -21.0, np.nan, 24.0], equal_nan=True)


@pytest.mark.parametrize("counts", [{"g_count": 2, "R": 2.0}, {"g_count": 4, "R": 2.0}])
def test_a_list_of_another_length_than_the_bank_is_refused_in_one_line(counts):
    with pytest.raises(PiezoError, match="initial state cannot be computed") as caught:
        simulate(parse(SPEC), duration=1e-3, parameters=counts)
    assert str(caught.value).isprintable()


def test_starts_as_printed_are_proved(iphs):
    (row,) = rows(iphs, printed(iphs))
    assert row.verdict is Verdict.PROVED, row.reason


@pytest.mark.long
@pytest.mark.parametrize("language", TEXTS[:2])
def test_no_mutant_of_the_starts_is_proved(iphs, language):
    text, known = printed(iphs)[language], Reference(iphs)
    head = {"NumPy": "def ", "C": "void listed_"}[language]
    ends = (text.index(f"{head}{name}(") for name in ("initial_state", "rhs"))
    first, last = (text[:end].count("\n") for end in ends)
    made = [(what, new) for what, new in mutants(text) if first < int(what.split()[1]) < last]
    made = [(what, new) for what, new in made if "/np.ones(" not in new]  # divides by 1
    assert len(made) > 80
    assert [what for what, new in made if verdict(known, language, new) is Verdict.PROVED] == []


WRONG = {
    "NumPy": [
        ("L[1]*i_0[1]", "L[0]*i_0[1]"),
        ("(L[0]*i_0[0],", "(L[1]*i_0[1],"),
        ("(L[0]*i_0[0],", "(L*i_0,"),
        (
            "(L[0]*i_0[0],",
            "(L[0]*i_0[0] + np.sum(L[0]*i_0, axis=0) - np.sum(L*i_0, axis=0),",
        ),
        ("(L[0]*i_0[0],", "(L[False]*i_0[0],"),
        ("L[0]*i_0[0]", "L[-2]*i_0[0]"),
        ("= C*V", "= C*V + 0*L[0]"),
        ("*np.ones(h_count)", ""),
        ("*np.ones(h_count)", "*np.ones(g_count)"),
        ("out = np.zeros", "Q = L[0]\n    out = np.zeros"),
    ],
    "C": [
        ("0 < h_count ? L", "1 < h_count ? L"),
        ("0 < h_count ? L[0]*i_0[0] : (double)NAN", "L[0]*i_0[0]"),
        ("0 < h_count ? L", "0 < g_count ? L"),
        ("0 < h_count ? L[0]*i_0[0]", "0 < h_count ? L[1]*i_0[1]"),
        ("0 < h_count ? L[0]*i_0[0]", "0 < h_count ? L[0]*i_0[0] + L[1] - L[1]"),
        (" : (double)NAN,\n", " : 0.0,\n"),
        ("j < 2 ? phi_listed_", "j < 3 ? psi_listed_"),
    ],
}


@pytest.mark.some(5)
@pytest.mark.parametrize(
    ("language", "old", "new"), [(name, *case) for name, cases in WRONG.items() for case in cases]
)
def test_a_list_of_other_lanes_is_not_proved(iphs, language, old, new):
    text = printed(iphs)[language]
    at = text.index(old, text.index("initial_state("))
    changed = f"{text[:at]}{new}{text[at + len(old) :]}"
    assert verdict(Reference(iphs), language, changed) is not Verdict.PROVED
