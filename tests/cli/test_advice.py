"""What a beginner writes in another language's way is told how it is written here."""

import pytest

from piezo_sym import Stepper
from piezo_sym.cli import run
from piezo_sym.errors import PiezoError
from piezo_sym.expressions.parse import parse_condition, parse_law
from piezo_sym.spec.load import parse

SPEC = """
[model]
name = "advised"
[parameters]
m = { value = 1.0, unit = "kg" }
T_0 = { value = 300.0, unit = "K" }
[elements]
mass = { kind = "mass", at = "tip", mass = "m" }
dry = { kind = "damper", between = ["tip", "wall"], force = "LAW", heats = "body" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S)" }
"""


@pytest.mark.parametrize(
    ("read", "text", "advice"),
    [
        (parse_law, "d v", "write * between factors"),
        (parse_law, "2*d (v)", ""),
        (parse_law, "np.tanh(v)", "by its name alone, as in tanh(v)"),
        (parse_law, "d*|v|", "write abs(v)"),
        (parse_law, "d*v^2", "write ** for a power"),
        (parse_condition, "d => 0", "write >= or <="),
        (parse_condition, "d > 0 and k > 0", "each condition as one of its own"),
        (parse_condition, "d > 0 & k > 0", "each condition as one of its own"),
    ],
)
def test_a_law_in_another_language(read, text, advice):
    with pytest.raises(PiezoError) as error:
        read(text, "somewhere")
    assert advice in error.value.remedy


def test_a_name_that_is_not_declared():
    with pytest.raises(PiezoError, match=r"unknown name 'F_0'; declare it in \[parameters\]"):
        parse(SPEC.replace("LAW", "F_0*v"))


def test_a_name_that_is_nearly_one():
    with pytest.raises(PiezoError, match="did you mean 'T_0'"):
        parse(SPEC.replace("LAW", "t_0*v"))


def test_a_length_with_a_unit(capsys):
    assert run(["simulate", "oscillator", "--duration", "0.1s"]) == 2
    assert "a valid number, such as 0.1" in capsys.readouterr().err


def test_a_stepper_says_what_it_is():
    stepper = Stepper("oscillator", step=1e-3)
    stepper.step([0.0])
    assert repr(stepper) == "<Stepper of oscillator: step 0.001 s, time 0.001 s>"


def test_a_sweep_is_made_in_python(capsys):
    assert run(["sweep", "oscillator"]) == 2
    assert "help(piezo_sym.sweep)" in capsys.readouterr().err
