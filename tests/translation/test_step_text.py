"""The row `program` on a printed step: each wrong stage is refuted, or not proved at least."""

import re
from itertools import pairwise

import pytest

from piezo_sym import derive, load
from piezo_sym.report import Verdict
from piezo_sym.spec.load import parse
from piezo_sym.translation.program import Reference, different
from tests.mutants.specs import spec_of
from tests.translation.printed import printed, rows
from tests.translation.test_program import iphs_of

#: N is hysteron_count here; i_h and V_h are i_hysteron and V_hysteron.
SHORT = {"N": "hysteron_count", "i_h": "i_hysteron", "V_h": "V_hysteron"}
STATE = "const real S = x[3 + N];\n    const real c_0 = p_->c_0;\n    "
MEAN = "const real T_minus_T_0 = g[0];"
T = "const real T = T_0 + T_minus_T_0;"
SWITCHES = "s[j] = switch_1;\n        s[N + j] = switch_2;"
OTHERS = "s[j] = switch_2;\n        s[N + j] = switch_1;"
RIGHT = "const real V_h = rho[j]/T_minus_T_0*chosen_V_h;"
WRONG = {
    "the state for a mean": (MEAN, f"{STATE}const real T_minus_T_0 = T_0*expm1_of(S/c_0);"),
    "the state for the temperature": (T, f"{STATE}const real T = T_0*exp_of(S/c_0);"),
    "the state for a law's temperature": (
        RIGHT,
        "const real V_h = rho[j]/(T_0*expm1_of(x[3 + N]/p_->c_0))*chosen_V_h;",
    ),
    "the state in the ledger": ("lam*(T_e - T);", "lam*(T_e - T_0*exp_of(x[3 + N]/p_->c_0));"),
    "another function's mean": ("out[0] = T_0*expm1_of", "out[0] = T_0*exp_of"),
    "another scale's mean": ("T_0*expm1_of(S/c_0)", "T_0*expm1_of(S/(2.0*c_0))"),
    "another state's mean": ("real S = x[3 + N];\n    out", "real S = x[2];\n    out"),
    "a mean with a part of the state": ("expm1_of(S/c_0);", "expm1_of(S/c_0) + S;"),
    "switches exchanged": (SWITCHES, OTHERS),
    "a switch of another sign": ("switch_2 = i_h - i_0[j]", "switch_2 = i_0[j] - i_h"),
    "a switch at another place": ("switch_2 = i_h - i_0[j]", "switch_2 = i_h - 2.0*i_0[j]"),
    "a switch of zero at a kink": ("switch_1 = -i_0[j] - i_h", "switch_1 = -i_h"),
    "branches exchanged": ("branch_2 = b + N", "branch_2 = b + 0"),
    "a choice the other way": (
        "chosen(is_above(branch_1[j], 0.0), i_h + i_0[j], wide(0.0))",
        "chosen(is_above(branch_1[j], 0.0), wide(0.0), i_h + i_0[j])",
    ),
    "a sign": (
        "alpha_transducer*V_capacitor - F_spring",
        "alpha_transducer*V_capacitor + F_spring",
    ),
    "an operand": ("rows[1] = sum_i_h*V_in", "rows[1] = sum_i_h*V_capacitor"),
    "an input": ("T_e = u[2]", "T_e = u[1]"),
    "an input times its number of lanes": ("out[3 + j] = V_in", "out[3 + j] = N*V_in"),
    "a weight of a ledger row": ("rows[2] = lam", "rows[2] = 2.0*lam"),
    "a heat for a production": ("= V_h*i_h/T;", "= V_h*i_h;"),
    "productions at T_0": (
        "rows[4 + N + N] = F_damper*v_mass/T",
        "rows[4 + N + N] = F_damper*v_mass/T_0",
    ),
    "an exchange that is not booked": (
        "rows[5 + N + N] = lam*(T_e/T - 1.0)",
        "rows[5 + N + N] = zero",
    ),
    "rows exchanged": (
        "rows[0] = v_mass*F_ext;\n    rows[1]",
        "rows[1] = v_mass*F_ext;\n    rows[0]",
    ),
    "a margin of the state": ("m[0] = T_minus_T_0", "m[0] = T_0*expm1_of(x[3 + N]/p_->c_0)"),
    "a margin that may be zero": ("_strict[] = {\n    1,", "_strict[] = {\n    0,"),
    "a margin of a constant": ("m[0] = T_minus_T_0", "m[0] = wide(1.0)"),
}
NOT_READ = {
    "a margin that is always inside": (
        "m[0] = T_minus_T_0",
        "m[0] = sqrt_of(power_2_of(T_minus_T_0))",
    ),
    "a margin that no state outside has": (
        "m[0] = T_minus_T_0",
        "m[0] = power_2_of(sqrt_of(T_minus_T_0))",
    ),
    "a mean that needs the domain": (
        "out[0] = T_0*expm1_of",
        "out[0] = power_2_of(sqrt_of(T_0))*expm1_of",
    ),
    "a choice by the domain of states": (
        RIGHT,
        RIGHT.replace("rho[j]/", "chosen(is_above(x[3 + N], 0.0), rho[j], zero)/"),
    ),
    "a choice by the law's own comparison": ("is_above(branch_2[j], 0.0)", "is_above(i_h, i_0[j])"),
    "a branch as a number": (RIGHT, RIGHT.replace("rho[j]", "branch_1[j]*rho[j]")),
    "a word for a comparison that means another": (
        "#define is_above(a, b) ((a) > (b))",
        "#define is_above(a, b) ((b) > (a))",
    ),
    "a comparison that is true at zero": (
        "is_above(branch_1[j], 0.0)",
        "is_at_least(branch_1[j], 0.0)",
    ),
    "a choice by an operator": (
        T,
        "const real T = chosen(q > 0.0, T_0 + T_minus_T_0, T_0 + T_minus_T_0);",
    ),
    "a branch at one": ("is_above(branch_2[j], 0.0)", "is_above(branch_2[j], 1.0)"),
    "another choice": (T, "const real T = q > 0.0 ? T_0 + T_minus_T_0 : T_0 + T_minus_T_0;"),
    "a margin that is not written": ("m[0] = T_minus_T_0;", ""),
    "no limits": ("_limits = 1", "_limits = 0"),
    "another macro": ("((condition) ? (then) : (other))", "((condition) ? (other) : (then))"),
    "a word of its own": ("#define sqrt_of sqrt", "#define sqrt_of exp"),
    "one more macro": ("#endif\n", "#endif\n#define lam T_0\n"),
    "another order of parameters": ("    real M;\n    real k;", "    real k;\n    real M;"),
    "fewer means": ("out[1] = 1; /* means */", "out[1] = 0; /* means */"),
    "fewer branches": ("out[2] = N + N;", "out[2] = N;"),
    "fewer rows": ("out[3] = 6 + N", "out[3] = 5 + N"),
    "branches that overlap": ("s[N + j] = switch_2", "s[1 + N + j] = switch_2"),
    "a switch of its own branch": (
        "switch_2 = i_h - i_0[j]",
        "switch_2 = i_h - chosen(is_above(branch_2[j], 0.0), i_0[j], i_0[j])",
    ),
    "a rate that is not written": ("    out[0] = v_mass;\n", ""),
    "a rate written twice": ("out[0] = v_mass;", "out[0] = v_mass;\n    out[0] = v_mass;"),
    "a slope in the ledger": ("rows[0] = v_mass*F_ext", "rows[0] = v_mass*F_ext*q/q"),
    "a sum that leaves out a lane": (
        "j = 0; j < N; ++j) {\n        const",
        "j = 1; j < N; ++j) {\n        const",
    ),
    "what slopes call": (
        "out[0] = 1.0/M;",
        "out[0] = piezo_stack_stage(x, x, b, u, p_, out, out, out, out);",
    ),
    "a name in slopes that nothing declares": ("out[0] = 1.0/M;", "out[0] = 1.0/other;"),
    "a table that is not static": ("static const int piezo_stack_read[]", "const int more[]"),
    "a table twice": ("int piezo_stack_state[]", "int piezo_stack_place[]"),
    "what slopes write": ("out[0] = 1.0/M;", "out[0] = 1.0/M;\n    x[0] = zero;"),
    "one more function": (
        "enum {\n    piezo_stack_limits",
        "static void piezo_stack_more(const real *restrict x)\n{\n}\n"
        "enum {\n    piezo_stack_limits",
    ),
    "a parameter given to another": ("OF(to->M, lane) = from->M;", "OF(to->M, lane) = from->k;"),
    "a parameter not given": ("OF(to->M, lane) = from->M;", ""),
    "one lane of a bank given": ("from->rho[j];", "from->rho[0];"),
    "lanes at one place": ("at += from->hysteron_count;", ""),
    "lanes of one in another's room": ("to->rho = at;", "to->i_0 = at;"),
    "what a lane is": ("#define OF(value, lane) (value)", "#define OF(value, lane) (1*value)"),
    "a power that is none": ("return z*z;", "return z;"),
    "no text": ("", None),
}


@pytest.fixture(scope="module")
def made():
    iphs = iphs_of("piezo_stack")
    return printed(iphs)["step"], Reference(iphs)


def spelled(text):
    """Return a text with what is short here as it is printed."""
    return re.sub(r"\bN\b|i_h\b|V_h\b", lambda word: SHORT[word[0]], text)


def row(made, old, new):
    """Return the row on a step in which something is replaced, if it is not proved."""
    text, known = made
    assert spelled(old) in text
    text = "" if new is None else text.replace(spelled(old), spelled(new), 1)
    return next(iter(different("step", text, known)), None)


@pytest.mark.some(13)
@pytest.mark.parametrize("case", WRONG)
def test_a_wrong_stage_is_refuted(made, case):
    found = row(made, *WRONG[case])
    assert (found.verdict, bool(found.witness)) == (Verdict.REFUTED, True), found.reason


@pytest.mark.parametrize("case", NOT_READ)
def test_a_step_outside_the_grammar_is_open(made, case):
    assert row(made, *NOT_READ[case]).verdict is Verdict.OPEN


def part(text, name):
    """Return a part of a step that begins with a line of this name, up to a line without indent."""
    return re.search(rf"(?m)^[^\n]*{name}[^\n]*\n(?:[ #{{][^\n]*\n|\);?\n)*}};?\n", text)[0]


BEGINS, ENDS = "#if !defined(LAWS_APART)", "#endif /* of the functions of laws */\n"
ALONE, TAKEN = "#if !defined(ALONE) /* the step alone", "#endif /* of what run/engine takes */\n"
TOLD = "#endif /* of what tells of co-states */\n"
PLACES = {
    "piezo_stack": [("_stage\\(", TAKEN), ("_costates\\(", ALONE), ("_slopes\\(", "enum {"),
                    ("_sizes\\(", ENDS), ("piezo_stack_strict", TOLD), ("_give\\(", ENDS)],
    "stack_maxwell": [(r"#define PATHS.*\n.*_path\[", ENDS), ("_path_parameters\\(", TOLD)],
    "amplified_stack": [("#define BENDS", ENDS), ("_bends\\(", TAKEN)],
}  # fmt: skip


@pytest.mark.parametrize("name", PLACES)
def test_what_stands_where_not_all_programs_compile_it_is_open(name):
    """Once a table of stops could stand among the laws, where the engine does not see it."""
    iphs = iphs_of(name)
    text, known = printed(iphs)["step"], Reference(iphs)
    assert different("step", text, known) == ()
    for word, place in PLACES[name]:
        moved = "#define BENDS\n" if word == "#define BENDS" else part(text, word)
        assert text.count(moved) == 1
        wrong = text.replace(moved, "").replace(place, f"{moved}{place}", 1)
        assert [row.verdict for row in different("step", wrong, known)] == [Verdict.OPEN], word
    begin, end = re.search(rf"{re.escape(BEGINS)}.*\n", text)[0], ENDS
    for old, new in ((begin, ""), (end, ""), (end, f"{begin}{end}{end}")):
        assert different("step", text.replace(old, new), known)[0].verdict is Verdict.OPEN


def test_a_mean_may_be_of_a_costate_and_a_constant(made):
    """The mean of T - 2 T_0 tells T as well as that of T - T_0, if the stage adds 2 T_0."""
    text, known = made
    text = text.replace("T_0*expm1_of(S/c_0);\n}", "T_0*exp_of(S/c_0) - 2.0*T_0;\n}")
    text = text.replace("T_minus_T_0 = g[0]", "T_minus_T_0 = T_0 + g[0]")
    assert different("step", text, known) == ()
    text = text.replace("T_minus_T_0 = T_0 + g[0]", "T_minus_T_0 = g[0]", 1)
    assert different("step", text, known)[0].verdict is Verdict.REFUTED


def test_switches_in_another_order_are_proved(made):
    text, known = made
    text = text.replace(spelled(SWITCHES), spelled(OTHERS))
    text = text.replace("branch_1 = b + 0;", "branch_1 = b + 0 + hysteron_count;")
    text = text.replace("branch_2 = b + hysteron_count;", "branch_2 = b + 0;")
    assert different("step", text, known) == ()


#: Comparisons that may hold with equality, jumps, choices in choices, and what only choices divide.
LAWS = {
    "abs": "d*abs(v)*v",
    "sign": "d*sign(v)",
    "min and max": "d*max(min(v, a), -a)",
    "saturate": "d*saturate(v, a)",
    "a choice in a choice": "d*deadzone(v + saturate(v, a), 2*a)",
    "a choice of a choice": "d*v*abs(abs(v) - a)",
    "a function of a choice": "d*v*exp(-abs(v)/a)",
    "roots": "d*v*sqrt(1 + abs(v)/a)",
    "the temperature": "d*v*max(T/a, 1)",
}


@pytest.mark.some(4)
@pytest.mark.parametrize("law", LAWS)
def test_laws_that_choose_are_proved_and_no_switch_can_be_left_out(law):
    words = spec_of(f"{LAWS[law]} | d > 0; a > 0 | a=1.0")
    words = words.replace("heats =", "discontinuous = true, heats =") if law == "sign" else words
    iphs = derive(parse(words))
    texts, known = printed(iphs), Reference(iphs)
    assert different("step", texts["step"], known) == ()
    written = re.findall(r"^    s\[\d+\] = (\w+);$", texts["step"], re.MULTILINE)
    assert written
    for first, other in pairwise(written):
        text = re.sub(rf"= {first};", "= one;", texts["step"])
        text = re.sub(rf"= {other};", f"= {first};", text).replace("= one;", f"= {other};")
        assert different("step", text, known), (first, other)
    for name in written:
        text = re.sub(rf"(s\[\d+\]) = {name};", rf"\1 = -{name};", texts["step"])
        assert different("step", text, known), name


def test_a_margin_of_a_bank_is_that_of_its_least_lane():
    words = load("piezo_stack").to_toml()
    iphs = derive(parse(words.replace('"lam >= 0"', '"lam >= 0", "phi < L*(i_0 + 10)"')))
    texts = printed(iphs)
    assert "least(m[" in texts["step"]
    (found,) = rows(iphs, texts)
    assert found.verdict is Verdict.PROVED, found.reason


@pytest.mark.parametrize(
    ("law", "more"),
    [
        ("d*v", "abs(p) < 100*F_1*a_1/d | a_1=1.0"),
        ("d*v", "max(p, p/2) < M*v_1"),
        ("abs(d)*v*max(T/T_0, 1)", "M > 0"),
    ],
)
def test_kinks_outside_of_laws_are_printed_and_read(law, more):
    """Margins and integrands choose by comparisons: no step keeps their branches."""
    iphs = derive(parse(spec_of(f"{law} | d > 0; {more}")))
    known = Reference(iphs)
    text = printed(iphs)["step"]
    assert different("step", text, known) == ()
    if "m[0] = chosen(" in text:
        changed = re.sub(r"(m\[0\] = chosen\(is_\w+\()p", r"\1-p", text)
        assert changed != text
        assert different("step", changed, known)[0].verdict is Verdict.REFUTED
