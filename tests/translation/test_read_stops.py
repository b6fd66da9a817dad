"""A step with stops is read back: its drives, limits, table, and where slips and heats go."""

import pytest

from piezo_sym import derive, load
from piezo_sym.codegen import collocation_of, lower, printed
from piezo_sym.translation.program import Reference, different

WRONG = {
    "a drive": ("    out[0] = v_mass;", "    out[0] = -v_mass;"),
    "a limit": ("= k_s[j]*r[j]/k_s[j];", "= k_s[j]*r[j];"),
    "a stiffness": ("        out[j] = k_s[j];", "        out[j] = r[j];"),
    "a slip": ("= v_mass - slip_slips[j];", "= v_mass + slip_slips[j];"),
    "no slip": ("= v_mass - slip_slips[j];", "= v_mass;"),
    "a heat": ("heat_slips += heat_slip_slips[j];", "heat_slips += 2.0*heat_slip_slips[j];"),
    "an effort": ("sum_F_slips += F_slips[j];", "sum_F_slips += heat_slip_slips[j];"),
    "an entropy": ("= heat_slip_slips[j]/T;", "= heat_slip_slips[j];"),
    "the bank of the table": ("    {0, 0, 3, 0},", "    {-1, 0, 3, 0},"),
    "own drives": ("    {0, 0, 3, 0},", "    {0, 1, 3, 0},"),
    "an inner state": ("    {0, 0, 3, 0},", "    {0, 0, 2, 0},"),
    "what drives": ("    {0, 0, 3, 0},", "    {0, 0, 3, 1},"),
    "how many": ("#define PATHS 1", "#define PATHS 2"),
    "a product of means": ("+= heat_slip_slips[j];", "+= F_slips[j]*slip_slips[j];"),
    "an entropy of means": ("= heat_slip_slips[j]/T;", "= F_slips[j]*slip_slips[j]/T;"),
    "a table in a comment": ("#define PATHS 1", "/*\n#define PATHS 1 */"),
    "a table behind a comment's begin": (
        "/* Path functionals:",
        "/*\n/* Path functionals: of old:",
    ),
    "who takes losses": ("stack_maxwell_heated = 4,", "stack_maxwell_heated = 3,"),
    "jumps": ("stack_maxwell_jumps = 0", "stack_maxwell_jumps = 1"),
    "what is read": ("stack_maxwell_reads = 1,", "stack_maxwell_reads = 0,"),
    "a co-state of an inner state": ("] = F_slips[j];", "] = -F_slips[j];"),
    "which states are entropies": ("_body[] = {\n    4,", "_body[] = {\n    3,"),
    "how many are given": ("; /* means */", " + 1; /* means */"),
}


@pytest.fixture(scope="module")
def step():
    iphs = derive(load("stack_maxwell"))
    return printed(lower(iphs, ""), collocation_of(iphs))["_step.c"], Reference(iphs)


def test_the_step_is_the_proved_one(step):
    text, known = step
    assert different("step", text, known) == ()


@pytest.mark.parametrize(("old", "new"), WRONG.values(), ids=WRONG)
def test_what_is_wrong_is_found(step, old, new):
    text, known = step
    assert text.count(old) == 1
    assert different("step", text.replace(old, new), known)
