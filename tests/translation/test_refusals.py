"""Text outside the grammar is not proved, and nothing in it is executed."""

import pytest

from piezo_sym import derive, load
from piezo_sym.report import Verdict
from piezo_sym.spec.load import parse
from piezo_sym.translation.program import Reference, different
from tests.mutants.specs import spec_of
from tests.translation.printed import printed, rows
from tests.translation.test_program import SPECS

NUMPY = {
    "a power of a choice of integers that wraps round": (
        "out[0] = v_mass\n",
        "out[0] = v_mass + M - M*(np.where(M > 0, 3000000, 3000000)**3/27e18)\n",
    ),
    "lanes that are a choice of integers": (
        "out[0] = v_mass\n",
        "out[0] = v_mass*np.where(i_0 > 0, 1, 1)\n",
    ),
    "a name that the readers know": ("import numpy as np", "import numpy as np\nnp.exp = np.sin"),
    "another module": ("import numpy as np", "import numpy as np, os"),
    "a default that is computed": ("x, u, p_, out, /):", "x, u, p_, out=print(), /):"),
    "an annotation": ("def energy(x, p_, /):", "def energy(x: print(), p_, /):"),
    "a decorator": ("def energy(", "@print\ndef energy("),
    "a warning that stops": ("def energy(", '@np.errstate(invalid="raise")\ndef energy('),
    "a decorator that calls": (
        "def energy(",
        '@np.errstate(divide="ignore", invalid="ignore")(print)\ndef energy(',
    ),
    "a table that is computed": ('Record("q", "m",', 'Record("q", open("x").read(),'),
    "another order of states": ('Record("q", "m",', 'Record("p", "m",'),
    "another parameter": ("k: float = 500000.0", "k: float = 500001.0"),
    "a function twice": ("def energy(", "def entropy(x, p_, /):\n    return x[0]\n\n\ndef energy("),
    "a helper that does more": ("    return x\n", "    x[0] = 0\n    return x\n"),
    "states that are not checked": ("    x = _states(x, p_)\n", ""),
    "a branch that is not reached": (
        "out[0] = v_mass\n",
        "out[0] = np.where(1 > 2, quit(), v_mass)\n",
    ),
    "a name twice": ("F_damper = d*v_mass\n", "F_damper = d*v_mass\n    v_mass = F_damper/d\n"),
    "a result written over": ("out[0] = v_mass\n", "out[0] = v_mass\n    out[0] = v_mass\n"),
    "a sum of what has no lanes": ("np.sum(i_hysteron, axis=0)", "np.sum(1/L, axis=0)"),
    "a long number": ("out[0] = v_mass\n", "out[0] = v_mass*1e999\n"),
    "a large power": ("out[0] = v_mass\n", "out[0] = (v_mass + q)**100000\n"),
    "nested parentheses": ("out[0] = v_mass\n", f"out[0] = {'(' * 5000}v_mass{')' * 5000}\n"),
    "integers that wrap round": (
        "out[0] = v_mass\n",
        "out[0] = v_mass*np.abs(3)**41/36472996377170786403\n",
    ),
    "another coding": ('"""Piezo', '# -*- coding: raw_unicode_escape -*-\n"""Piezo'),
    "a choice by truth": ("out[0] = v_mass\n", "out[0] = v_mass if M > 0 else 0.0\n"),
    "a root of what is negative": (
        "out[0] = v_mass\n",
        "out[0] = v_mass*np.sqrt(-M)/np.sqrt(-M)\n",
    ),
    "a slope where nothing is": ("out[0, 1] = 1/M\n", "out[0, 1] = p/(p*M)\n"),
    "a slope at an edge that is everywhere": (
        "out[0, 1] = 1/M\n",
        "out[0, 1] = np.where(np.sin(p)**2 + np.cos(p)**2 == 1, 7, 1/M)\n",
    ),
    "a slope at the edge of a letter": (
        "out[0, 1] = 1/M\n",
        "zz = p + S + M + k + d + C + a\n"
        "    out[0, 1] = np.where(zz == p + S + M + k + d + C + a, 7, 1/M)\n",
    ),
    "a margin that is nan outside": ("out[7] = M\n", "out[7] = np.sqrt(M)**2\n"),
    "no text": ("", None),
    "NUL": ("out[0]", "out\0[0]"),
}
EXP = "static double exp(double z)\n{\n    return z;\n}"
ZEROS = "    for (long j = 0; j < n*n; ++j) {\n        out[j] = 0.0;\n    }"
C = {
    "a margin that is nan outside": ("out[7] = M;", "out[7] = sqrt(M)*sqrt(M);"),
    "a macro": ("#include <math.h>\n", "#include <math.h>\n#define p q\n"),
    "another header": ("#include <math.h>\n", '#include <math.h>\n#include "m.h"\n'),
    "a function of the library": ("static double pick", f"{EXP}\n\nstatic double pick"),
    "integers divided": ("a*T/T_0", "1/2*a*T/T_0"),
    "a float": ("const double v_mass", "const float v_mass"),
    "a double for an index": ("const long n = ", "const double n = "),
    "a sum read in its loop": ("+= i_hysteron;", "+= i_hysteron + 0.0*sum_i_hysteron;"),
    "a sum that a directive leaves out": ("(+:sum_i_hysteron, heat", "(+:heat"),
    "a loop that starts late": ("long j = 0; j < hysteron_count", "long j = 1; j < hysteron_count"),
    "a loop by twos": ("++j) {\n        const", "j += 2) {\n        const"),
    "zeros that come too late": ("    out[1] = 1.0/M;", f"{ZEROS}\n    out[1] = 1.0/M;"),
    "a line joined": ("out[0] = v_mass;", "out[0] = v_mass; \\\n"),
    "a comment to the end": ("out[0] = v_mass;", "out[0] = v_mass; // \\\n"),
    "a comment behind a slash": ("out[0] = v_mass;", "out[0] = v_mass //**/ 2.0\n;"),
    "an enumeration in a block": (
        "out[0] = v_mass;", "double o2; { enum { o2 = 1 }; } out[0] = v_mass*o2;"
    ),
    "a name that the header makes empty": (
        "static double pick",
        "static double power_8(double PIEZO_SYM_piezo_stack_H)\n{\n"
        "    return 0.0 - PIEZO_SYM_piezo_stack_H - 0.0;\n}\n\nstatic double pick",
    ),
    "a condition": ("out[0] = v_mass;", "if (q > 0.0) out[0] = v_mass;"),
    "an octal number": ("power_2(p)/(2.0*M)", "power_2(p)/(010/4*M)"),
    "another function's name": ("void piezo_stack_rhs(", "void rhs("),
    "nested parentheses": ("out[0] = v_mass;", f"out[0] = {'(' * 5000}v_mass{')' * 5000};"),
    "a comment that C ends earlier": (
        "out[0] = v_mass;", "/* *\\\n/ return; /* */ out[0] = v_mass;"
    ),
    "an expression that nothing reads": (
        "out[0] = v_mass;",
        "out[0] = v_mass; double *restrict o2 = (piezo_stack_temperatures(x, p_, out), out);",
    ),
    "a name of other letters": (
        "out[0] = v_mass;", "const double w\u00aa = v_mass; out[0] = w\u00aa;"
    ),
    "integers divided in a choice": (
        "out[0] = v_mass;",
        "out[0] = v_mass + M - 2.0*((M > 0.0 ? 1 : 1)/2)*M;",
    ),
    "a sum of integers that is too large": (
        "out[0] = v_mass;",
        "out[0] = v_mass*(999999999 + 999999999 + 999999999)/2999999997.0;",
    ),
    "a header in a comment": ("#include <math.h>\n", "/* *#include <math.h>\n/ */\n"),
    "a decrement": ("T_0*c_0*exp(S/c_0)", "T_0*c_0*exp(--S/c_0)"),
    "a name before its declaration": (
        "out[0] = v_mass;", "const double w = late; const double late = v_mass; out[0] = w;"
    ),
    "a variable without a value": ("out[0] = v_mass;", "double w; out[0] = w; w = v_mass;"),
    "a variable that is set twice": (
        "out[0] = v_mass;", "double w; w = q; w = v_mass; out[0] = w;"
    ),
    "a name of a block behind it": (
        "out[0] = v_mass;", "{ const double w = v_mass; } out[0] = w;"
    ),
    "a name of a loop behind it": ("out[0] = v_mass;", "out[0] = v_mass + 0.0*i_hysteron;"),
    "a sum that is changed behind what reads it": (
        "out[2] = sum_i_hysteron",
        "const double w = sum_i_hysteron;\n"
        "for (long j = 0; j < hysteron_count; ++j) { sum_i_hysteron += phi[j]; }\n"
        "out[2] = w",
    ),
    "an increment": ("out[0] = v_mass;", "out[0] = ++v_mass;"),
    "no text": ("", None),
}  # fmt: skip


@pytest.fixture(scope="module")
def made():
    iphs = derive(load("piezo_stack"))
    return printed(iphs), Reference(iphs)


def row(made, language, old, new):
    """Return the row on a text in which something is replaced, if it is not proved."""
    texts, known = made
    assert old in texts[language]
    text = "" if new is None else texts[language].replace(old, new, 1)
    return next(iter(different(language, text, known)), None)


CASES = [*(("NumPy", case) for case in NUMPY), *(("C", case) for case in C)]


@pytest.mark.some(26)
@pytest.mark.parametrize(("language", "case"), CASES)
def test_text_outside_the_grammar_is_open(made, language, case):
    old, new = {"NumPy": NUMPY, "C": C}[language][case]
    assert row(made, language, old, new).verdict is Verdict.OPEN


@pytest.mark.parametrize("factor", ["q/q", "(q - 1)/(q - 1)", "np.sqrt(q)**2/q", "np.log(q)*0 + 1"])
def test_what_only_the_print_divides_by_is_open(made, factor):
    found = row(made, "NumPy", "out[0] = v_mass\n", f"out[0] = v_mass*({factor})\n")
    assert found.verdict is Verdict.OPEN
    assert "needs" in found.reason


def test_a_quotient_is_needed_only_where_it_is_chosen(made):
    chosen = "out[0] = np.where(S > 0, np.where(S > 0, v_mass*(S/S), S/S), v_mass)\n"
    assert row(made, "NumPy", "out[0] = v_mass\n", chosen) is None


@pytest.mark.parametrize(
    "one", ["np.where(S > 0, 1, 1)", "np.where(S > 0, 1/S*S, np.where(S < 1, 1, 1))"]
)
def test_a_choice_of_equal_integers_is_read_where_the_rest_is_real(made, one):
    assert row(made, "NumPy", "out[0] = v_mass\n", f"out[0] = v_mass*{one}\n") is None


@pytest.mark.parametrize(
    "chosen",
    [
        "q == S, 0, v_mass*(q - S)/(q - S)",
        "q == 1, 0, v_mass*(q - 1)/(q - 1)",
        "q**2 == S, 0, v_mass*(q**2 - S)/(q**2 - S)",
        "q == np.exp(S), 0, v_mass*(q - np.exp(S))/(q - np.exp(S))",
        "S == 1, np.where(q == S, 0, v_mass), v_mass*(S - 1)/(S - 1)",
    ],
)
def test_what_is_zero_by_zero_on_an_edge_is_not_what_it_is_beside_it(made, chosen):
    """A module with 0 there was proved: the difference is a multiple of q - S, over q - S."""
    found = row(made, "NumPy", "out[0] = v_mass\n", f"out[0] = np.where({chosen})\n")
    assert found.verdict is Verdict.OPEN


@pytest.mark.parametrize(
    ("language", "old", "new"),
    [
        ("NumPy", "out[0] = T_minus_T_0\n", "out[0] = np.abs(T_minus_T_0)\n"),
        ("NumPy", "out[2] = d\n", "out[2] = np.where(d > 0, d, 1)\n"),
        ("NumPy", "out[3] = np.min(rho,", "out[3] = np.min(np.abs(rho),"),
        ("C", "out[7] = M;", "out[7] = fabs(M);"),
        ("C", "min(out[4], i_0[j])", "min(out[4], pick(i_0[j] > 0.0, i_0[j], 0.0))"),
    ],
)
def test_margins_are_compared_outside_the_domain_too(made, language, old, new):
    """A margin that is right inside the domain alone would hide that a state has left it."""
    assert "margins" in row(made, language, old, new).reason


def test_all_is_proved_without_a_change(made):
    texts, known = made
    assert rows(known.system.iphs, texts)[0].verdict is Verdict.PROVED


def test_roots_in_the_domain_are_read_back():
    """SymPy splits sqrt(a/d) where it knows that d > 0; a margin knows nothing."""
    iphs = derive(parse(spec_of("d*v | d > 0; sqrt(a/d) >= 0 | a=1.0")))
    (found,) = rows(iphs, printed(iphs))
    assert found.verdict is Verdict.PROVED


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("from math import erf\n", ""),
        ("_erf = np.vectorize(erf, otypes=[float])\n", ""),
        ("from math import erf\n", "from math import erfc as erf\n"),
        ("otypes=[float])\n", "otypes=[int])\n"),
        ("otypes=[float])\n", "otypes=[float])\n_erf = np.tanh\n"),
    ],
)
def test_a_module_that_computes_erf_in_another_way_is_not_proved(old, new):
    iphs = derive(load(str(SPECS / "smooth_functions.toml")))
    text = printed(iphs)["NumPy"]
    assert old in text
    (row, *_) = different("NumPy", text.replace(old, new), Reference(iphs))
    assert row.verdict is Verdict.OPEN


LOGARITHM = """
[model]
name = "walled"
[parameters]
M = { value = 2.0, unit = "kg" }
r = { value = 0.3, unit = "m" }
F = { value = 0.3, unit = "N" }
[domain]
assume = ["M > 0", "r > 0", "q < r"]
[elements]
spring = { kind = "spring", between = ["a", "wall"], force = "-F*log(1 - q/r)", state = "q" }
mass = { kind = "mass", at = "a", mass = "M", state = "p" }
"""


def test_a_margin_of_a_step_has_no_right_to_what_a_mean_needs():
    iphs = derive(parse(LOGARITHM))
    texts, known = printed(iphs), Reference(iphs)
    assert rows(iphs, texts)[0].verdict is Verdict.PROVED
    for wrong in ("r*exp_of(log_of(1.0 - q/r))", "(r - q)*M/M", "(r - q)*(M*M + r*r)/(M*M + r*r)"):
        text = texts["step"].replace("m[0] = r - q;", f"m[0] = {wrong};")
        assert text != texts["step"]
        assert different("step", text, known)
