"""What a beginner writes in another language's way is told how it is written here."""

import pytest

from piezo_sym import (
    Stepper,
    derive,
    linearize,
    load,
    operating_point,
    periodic_steady_state,
    plot,
    simulate,
    sweep,
)
from piezo_sym.cli import run
from piezo_sym.errors import InputWarning, PiezoError
from piezo_sym.expressions.parse import parse_condition, parse_law
from piezo_sym.expressions.units import parse_unit
from piezo_sym.spec.load import parse
from piezo_sym.sweeps import SweepWarning

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
        (parse_law, "d.*v", "write * for .*"),
        (parse_law, "d.^2", "write ** for .^"),
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


def test_a_letter_written_as_a_word():
    with pytest.raises(PiezoError, match=r"did you mean 'v'\? else declare it in \[parameters\]"):
        parse(SPEC.replace("LAW", "m*vel"))


@pytest.mark.parametrize("written", ["60,0", "60.0"])
def test_a_number_in_quotes(written):
    with pytest.raises(PiezoError) as error:
        parse(SPEC.replace("value = 1.0", f'value = "{written}"'))
    assert error.value.remedy == "write 60.0, with a point and without quotes"


def test_the_sign_of_a_logarithm():
    with pytest.raises(PiezoError, match=r"values of its parameters, and the sign inside log$"):
        parse(SPEC.replace("LAW", "m*v") + '[initial]\nS_body = "log(-T_0/T_0)"\n')


def test_a_derived_system_knows_its_model():
    with pytest.raises(PiezoError, match=r"is no model; .*; give iphs\.model$"):
        simulate(derive(load("oscillator")), duration=1)


def test_a_temperature_in_celsius(capsys):
    said = "T_e = 20 K is -253.15 degC; 20 degC is 293.15"
    with pytest.warns(InputWarning, match=f"^{said}$") as warned, pytest.raises(PiezoError):
        simulate("piezo_stack", duration=1e-3, inputs={"T_e": 20})
    assert [warning.filename for warning in warned] == [__file__]
    assert run(["simulate", "piezo_stack", "--duration", "1ms", "-i", "T_e=20"]) == 2
    assert capsys.readouterr().err.splitlines()[0] == f"piezo-sym: {said}"
    with pytest.warns(InputWarning, match=said), pytest.warns(SweepWarning):
        sweep("piezo_stack", over={"d": [1.0]}, duration=1e-3, inputs={"T_e": 20})


def test_a_length_with_a_unit(capsys):
    assert run(["simulate", "oscillator", "--duration", "0.1m"]) == 2
    assert "'m' is no unit of 'duration'; expected one such as s" in capsys.readouterr().err


def test_a_stepper_says_what_it_is():
    stepper = Stepper("oscillator", step=1e-3)
    stepper.step([0.0])
    assert repr(stepper) == "<Stepper of oscillator: step 0.001 s, time 0.001 s>"


def test_a_sweep_is_made_in_python(capsys):
    assert run(["sweep", "oscillator"]) == 2
    assert "help(piezo_sym.sweep)" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("unit", "advice"),
    [("Nm", "'N*m'"), ("Ns/m", "'N*s/m'"), ("%/K", "'percent/K'"), ("N m", "'N*m'")],
)
def test_a_unit_as_others_write_it(unit, advice):
    with pytest.raises(PiezoError) as error:
        parse_unit(unit)
    assert error.value.remedy == f"write {advice}"


@pytest.mark.parametrize(
    ("old", "new", "advice"),
    [
        ('"LAW"', '"sin(t)"', "time enters through an input"),
        ('"LAW"', "0.5", 'force = "a", where [parameters] has a = { value = 0.5, unit = '),
        ("[elements]", "[domain]\nassume = 'm > 1'\n[elements]", 'such as ["m > 1"]'),
        ("m = {", 'lam = { value = 1, unit = "1" }\nlambda = {', "call it 'lambda_0'"),
    ],
)
def test_a_spec_in_another_language(old, new, advice):
    with pytest.raises(PiezoError) as error:
        parse(SPEC.replace(old, new).replace("LAW", "m*v"))
    assert advice in str(error.value)


SHORT = ["simulate", "oscillator", "--duration", "1"]


@pytest.mark.parametrize(
    ("words", "advice"),
    [
        (["kinds", "end_stop"], 'write a spring with force = "k_c*max(q - gap, 0)"'),
        (["kinds", "dahl"], "hysteresis is a 'stop', or a 'slip' of a spring or capacitor: piezo"),
        (["kinds", "Bouc-Wen"], "hysteresis is a 'stop', or a 'slip' of a spring or capacitor"),
        (["verify", "mene.toml"], "cannot be read (No such file or directory); did you mean 'mine"),
        (["simulate", "oscillator"], "see `piezo-sym simulate --help`"),
        (["simulate", "mine", "--duration", "1"], "to use the file mine.toml, write its ending"),
        ([*SHORT, "--continue", "nofile.nc"], "there is no such file or store; check the path"),
        ([*SHORT, "-i", "F=@absent_table.csv"], "No such file or directory; check the path"),
        ([*SHORT, "-i", "F=@drve.csv"], "did you mean 'drive.csv'?"),
        ([*SHORT, "-i", "f=@two.csv"], "--input: unknown name 'f'; did you mean 'F'?"),
        ([*SHORT, "--event", "k=q"], "a quantity or a parameter has that name"),
        ([*SHORT, "--event", "hit=q>0.005"], "write 'q - 0.005'"),
        ([*SHORT, "--event", "hit=q - 2.5e1um"], "write numbers in SI: 2.5e-05 for 2.5e1um"),
        ([*SHORT, "--stop", "q > 1um"], "write numbers in SI: 1e-06 for 1um"),
        ([*SHORT, "--stop", "q > 1 and v > 0"], "write 'min(q - 1, v) > 0'"),
        ([*SHORT, "--step", "1e-12"], "--step: 1e-12 s is too short a step"),
        (
            ["simulate", "stack_maxwell", "--duration", "1", "--initial", "z_1=1"],
            "on a command line z=1,2,...",
        ),
    ],
)
def test_a_command_line(refused, spec_file, tmp_path, monkeypatch, words, advice):
    spec_file()
    (tmp_path / "drive.csv").touch()
    (tmp_path / "two.csv").write_text("t,F,v\n0,1,2\n1,1,2\n", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    assert advice in refused(*words)


@pytest.mark.parametrize(
    ("text", "advice"),
    [
        ("t,F,F_kN\n0,1,1\n0,2,1\n1,3,1\n", "the first time, 0 s, stands twice"),
        ("t,F [A]\n0,1\n1,3\n", "in A (drive.csv, column 'F'); expected samples in N"),
        ("t_ms,F\n0,1\n1000,3\n", "write 't [ms]', or another name"),
        ("t in ms,F\n0,1\n1000,3\n", "write 't [ms]', or another name"),
        ("t,F_kN\n0,1\n1,3\n", "write 'F [kN]', or another name"),
        ("t,a,b\n0,1,2\n1,3,4\n", "columns: t, a, b; name one like the input"),
    ],
)
def test_a_table_of_samples(refused, tmp_path, monkeypatch, text, advice):
    (tmp_path / "drive.csv").write_text(text, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    assert advice in refused(*SHORT, "-i", "F=@drive.csv")


def test_an_operating_point_is_a_start():
    point = operating_point(
        "oscillator", inputs={"F": 1.0}, parameters={"k": 8.0}, temperatures={"body": 300.0}
    )
    run = simulate("oscillator", initial=point, inputs={"F": 1.0}, duration=1.0)
    assert (float(run.q[-1]), run.attrs["parameter_k"]) == (pytest.approx(0.125), 8.0)
    assert Stepper("oscillator", step=1e-3, initial=point).x[0] == pytest.approx(0.125)


def test_a_run_of_an_edited_spec(spec_file):
    run = simulate(spec_file(), duration=1e-4)
    with pytest.raises(PiezoError, match="changed values as parameters"):
        simulate(spec_file("value = 3.5e-3", "value = 4e-3"), duration=1e-4, initial=run)


@pytest.mark.parametrize(
    ("call", "place"),
    [
        (lambda: Stepper("oscillator", step=1e-3, parameters={"kk": 1}), "Stepper.parameters"),
        (lambda: Stepper("oscillator", step=1e-3, initial={"kk": 1}), "Stepper.initial"),
        (lambda: linearize("oscillator", inputs={"kk": 1}), "linearize.inputs"),
        (lambda: linearize("oscillator", parameters={"kk": 1}), "linearize.parameters"),
        (lambda: operating_point("oscillator", initial={"kk": 1}), "operating_point.initial"),
    ],
)
def test_a_wrong_argument_is_one_of_what_was_called(call, place):
    with pytest.raises(PiezoError, match=f"^{place}: unknown name 'kk'"):
        call()


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: simulate("oscillator", tend=5),
            "simulate: unknown name 'tend'; known: model, in",
        ),
        (lambda: plot(None, "q"), "plot: too many positional arguments; expected plot(run)"),
        (
            lambda: linearize("oscillator", input={}),
            "linearize: unknown name 'input'; did you mean",
        ),
        (lambda: simulate("oscillator", input={}), "simulate: unknown name 'input'; did you mean"),
        (lambda: Stepper("oscillator", setp=1), "Stepper: unknown name 'setp'; did you mean"),
        (lambda: operating_point("oscillator", T=300), "operating_point: unknown name 'T'"),
        (
            lambda: simulate("oscillator"),
            "simulate.duration: is missing; expected simulate(model, duration=0.1)",
        ),
        (
            lambda: sweep("oscillator", duration=1),
            "sweep.over: is missing; expected sweep(model, over={'d': [300.0, 400.0]}, duration=0.",
        ),
        (
            lambda: sweep("oscillator", over={"d": [1.0]}),
            "sweep.duration: is missing; expected sweep(model, over=",
        ),
        (lambda: Stepper("oscillator"), "Stepper.step: is missing; expected Stepper(model, step="),
        (
            lambda: periodic_steady_state("oscillator", inputs={}),
            "periodic_steady_state.frequency: is missing; expected periodic_steady_state(model, in",
        ),
        (
            lambda: simulate("oscillator", duration="5ms"),
            "simulate.duration: '5ms' is not a finite number; expected a number of seconds, such",
        ),
        (
            lambda: simulate("oscillator", duration=1, parameters={"d": "2"}),
            "simulate.parameters.d: '2' is not a finite number; expected a number in SI, such as",
        ),
    ],
)
def test_an_option_that_is_none(call, message):
    with pytest.raises(PiezoError) as error:
        call()
    assert str(error.value).startswith(message)
