"""What runs say to those who use them first: inputs, conditions, measurements, and other runs."""

import re

import numpy as np
import pytest

from piezo_sym import (
    Stepper,
    load,
    periodic_steady_state,
    simulate,
    sine,
    sweep,
)
from piezo_sym.cli import run
from piezo_sym.errors import InputWarning, PiezoError, RunError, UsageError
from piezo_sym.spec.load import parse
from piezo_sym.spec.source import find

TEXT = find("piezo_stack").read_text(encoding="utf-8")
BOUNDED = (
    TEXT.replace('= "piezo_stack"', '= "bounded"')
    .replace('"d >= 0"', '"d >= 0", "abs(V_in) < V_max", "d < abs(d_max)"')
    .replace(
        "[inputs]",
        'V_max = { value = 10.0, unit = "V" }\nd_max = { value = 500.0, unit = "N*s/m" }\n[inputs]',
    )
)
H, DRIVE = 1e-5, {"V_in": 50.0}


@pytest.fixture(scope="module")
def before():
    return simulate("piezo_stack", inputs=DRIVE, duration=100 * H, step=H, parameters={"d": 300.0})


def test_inputs_that_a_run_goes_on_without_are_named(before):
    said = r"'V_in' is not given, so it is 0 V, its default, .*: the run .* had other values"
    with pytest.warns(InputWarning, match=said) as found:
        simulate("piezo_stack", duration=H, step=H, initial=before)
    assert len(found) == 1
    simulate("piezo_stack", duration=H, step=H, initial=before, inputs={"V_in": 0.0})


def test_the_command_says_which_inputs_are_at_their_defaults(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    words = ["simulate", "piezo_stack", "--duration", "1ms"]
    assert run([*words, "-i", "V_in=50", "--out", "one.nc"]) == 0
    assert run([*words, "--continue", "one.nc"]) == 0
    assert "piezo-sym: input 'V_in' is not given, so it is 0 V" in capsys.readouterr().err


def test_a_stepper_goes_on_where_a_run_ended(before):
    state = {name: before[name][-1].values for name in ("q", "p", "Q_C", "phi", "S")}
    given = {"initial": state, "parameters": {"d": 300.0}}
    ends, states = [], Stepper("piezo_stack", step=H, inputs=DRIVE, **given)
    for actuator in (Stepper("piezo_stack", step=H, initial=before, inputs=DRIVE), states):
        for _ in range(50):
            actuator.step([0.0, 50.0, 298.15])
        ends.append(actuator.x)
    assert np.array_equal(*ends)  # to the bit
    goes_on = simulate("piezo_stack", inputs=DRIVE, duration=50 * H, step=H, initial=before)
    assert ends[0][0] == pytest.approx(float(goes_on.q[-1]), rel=1e-13)
    pair = Stepper("piezo_stack", step=H, initial=before, parameters=[{}, {"d": 500.0}])
    assert np.array_equal(pair.x[:, 0], pair.x[:, 1])


@pytest.mark.parametrize(
    "call",
    [
        lambda run: sweep("piezo_stack", over={"L": [1e-3]}, duration=H, initial=run),
        lambda run: periodic_steady_state(
            "piezo_stack", inputs={"V_in": sine(50, 100)}, frequency=100, initial=run
        ),
    ],
)
def test_where_a_run_is_no_state_the_state_to_give_is_said(call, before):
    with pytest.raises(UsageError, match=r"a Dataset is no state; .* give \{name: run\[name\]"):
        call(before)


def test_a_temperature_is_measured_as_an_output():
    with pytest.raises(UsageError, match=r"a state or output: q, .*; temperatures .*: y_ambient"):
        Stepper("piezo_stack", step=H, quantum={"T_body": 1e-3})
    Stepper("piezo_stack", step=H, quantum={"y_ambient": 1e-3})


@pytest.mark.parametrize(
    ("changed", "remedy"),
    [
        ({"d": 600.0}, "change parameter 'd'"),
        ({"T_0": 400.0}, "change parameter 'T_0', input 'T_e'"),
    ],
)
def test_parameters_that_were_set_are_named_first(changed, remedy):
    with pytest.raises(RunError) as error:
        simulate(parse(BOUNDED), duration=H, parameters=changed)
    assert error.value.remedy == remedy


@pytest.mark.parametrize("options", [{}, {"step": H}, {"method": "LSODA"}])
def test_a_bound_on_the_size_of_an_input_is_kept(options):
    with pytest.raises(RunError, match=r"t = 0.000159.*'abs\(V_in\) < V_max' has margin"):
        simulate(parse(BOUNDED), duration=0.01, inputs={"V_in": sine(100, 100)}, **options)


def test_constants_are_numbers_in_events_too():
    with pytest.raises(UsageError, match=r"know no 'pi'; .* write 3\.14159"):
        simulate("piezo_stack", duration=H, events={"turn": "q - pi"})
    simulate("piezo_stack", duration=H, events={"turn": "q - 3.141592653589793"})


@pytest.mark.parametrize(
    ("formula", "signal"),
    [
        ("0.5*sin(2*pi*t)", "sine(0.5, 1)"),
        ("0.5*sin(2*pi*50*t) + 3", "sine(0.5, 50, +3)"),
        ("sin(2*pi*1e2*t)", "sine(1, 1e2)"),
    ],
)
def test_a_formula_is_told_its_signal(formula, signal, capsys):
    words = ["simulate", "piezo_stack", "--duration", "1ms", "-i"]
    assert run([*words, f"V_in={formula}"]) == 2
    message = capsys.readouterr().err
    assert message.count("\n") == 1
    assert run([*words, f"V_in={re.search(r'write (.*)$', message)[1]}"]) == 0
    assert message.endswith(f"write {signal}\n")


def test_other_formulas_are_told_signals_and_tables(capsys):
    assert run(["simulate", "piezo_stack", "--duration", "1ms", "-i", "V_in=5*t"]) == 2
    assert "is a formula; expected sine(amplitude" in capsys.readouterr().err
    with pytest.raises(PiezoError, match=r"a signal, such as sine\(100.0, 50.0\)"):
        simulate(load("piezo_stack"), duration=H, inputs={"V_in": "50*sin(t)"})


def test_a_start_apart_from_states_of_the_same_rate_is_warned_of_once():
    guide = 'kind = "spring"\nbetween = ["tip", "wall"]\nstiffness = "k"\nstate = "x"'
    text = TEXT.replace('= "piezo_stack"', '= "guided"')
    guided = parse(text.replace("[elements.load]", f"[elements.guide]\n{guide}\n[elements.load]"))
    said = "^q, x move at one rate; given only x, they keep x - q as at the start: give q, too"
    calls = {
        simulate: {"duration": H, "initial": {"x": 1e-6}},
        Stepper: {"step": H, "initial": {"x": 1e-6}},
        sweep: {"duration": H, "over": {"initial.x": [1e-6, 2e-6]}},
    }
    for function, given in calls.items():
        with pytest.warns(InputWarning, match=said) as found:
            function(guided, **given)
        assert [warning.filename for warning in found] == [__file__]
    simulate(guided, duration=H, initial={"x": 1e-6, "q": 1e-6})
    simulate(guided, duration=H, initial={"Q_C": 0.0})
