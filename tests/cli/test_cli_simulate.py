"""``piezo-sym simulate``: inputs and parameters from words, results to files, refusals."""

import csv
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import xarray

import piezo_sym
from piezo_sym import sine
from piezo_sym.cli.simulate import simulate as simulate_command
from piezo_sym.cli.words import spelled
from piezo_sym.run.signals import SIGNALS

ROOT = Path(__file__).parents[2]
MODELS = ROOT / "piezo_sym" / "models"

SHORT = ("simulate", "piezo_stack", "--duration", "1e-3", "--times", "11")
DRIVEN = (*SHORT, "--input", "V_in=sine(100, 100)", "--set", "L=5e-4")


@pytest.fixture
def expected():
    """What the same run gives in Python."""
    return piezo_sym.simulate(
        "piezo_stack",
        duration=1e-3,
        times=11,
        inputs={"V_in": sine(100, 100)},
        parameters={"L": 5e-4},
    )


def test_the_last_values_are_printed(call, expected):
    answer = call(*DRIVEN)
    assert (answer.code, answer.err) == (0, "")
    assert "piezo_stack at t = 0.001 s" in answer.out
    rows = [line.split() for line in answer.out.splitlines()]
    assert ["q", f"{expected.q.values[-1]:.6g}", "m"] in [row[:3] for row in rows]


def test_a_csv_file_has_a_column_a_quantity_and_a_lane(call, expected, tmp_path):
    path = tmp_path / "new folder" / "run.csv"
    assert call(*DRIVEN, "--out", path).code == 0
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 11
    assert next(iter(rows[0])) == "time [s]"
    assert float(rows[-1]["q [m]"]) == expected.q.values[-1]
    assert [float(row["phi_2 [Wb]"]) for row in rows] == expected.phi.values[:, 1].tolist()


def test_a_csv_file_drives_another_run(call, expected, tmp_path):
    first, second = tmp_path / "first.csv", tmp_path / "second.nc"
    assert call(*DRIVEN, "--out", first).code == 0
    answer = call(*SHORT, "-i", f"V_in=@{first}", "--out", second)
    assert answer.code == 0
    assert "names no units" not in answer.out
    assert last(second).V_in.values == pytest.approx(expected.V_in.values, rel=1e-15)


def test_a_netcdf_file_holds_the_result(call, expected, tmp_path):
    path = tmp_path / "run.nc"
    answer = call(*DRIVEN, "--out", path)
    assert answer.out.splitlines()[-1] == str(path)
    with xarray.open_dataset(path, engine="scipy") as result:
        xarray.testing.assert_allclose(result.load(), expected, rtol=0, atol=0)
        assert result.q.attrs["units"] == "m"
        assert result.attrs["parameter_L"] == 5e-4


@pytest.mark.parametrize("name", ["run.csv", "run.nc"])
def test_a_file_is_replaced(call, tmp_path, name):
    path = tmp_path / name
    path.write_text("old")
    assert call(*SHORT, "--out", path).code == 0
    assert path.read_bytes() != b"old"


def test_a_store_is_not_replaced(call, tmp_path):
    path = tmp_path / "run.zarr"
    path.mkdir()
    answer = call(*SHORT, "--out", path)
    assert answer.code == 2
    assert "run.zarr': exists already; choose another path, or delete it" in answer.err


def test_a_result_leaves_no_other_file(call, tmp_path):
    (tmp_path / "run.csv").mkdir()
    assert call(*SHORT, "--out", tmp_path / "run.csv").code == 2
    assert [path.name for path in tmp_path.iterdir()] == ["run.csv"]


@pytest.mark.parametrize(
    ("words", "name", "value"),
    [
        (("-i", "V_in=5"), "V_in", 5.0),
        (("-i", "V_in=-5e0"), "V_in", -5.0),
        (("-i", "V_in=step(5e-4, 1, 2)"), "V_in", 2.0),
        (("-i", "V_in=ramp(0,1e-3,0,8)"), "V_in", 8.0),
        (("-i", "F_ext=triangle(3,250)"), "F_ext", 3.0),
        (("-i", "F_ext=chirp(3,250,250,1)"), "F_ext", 3.0),
        (("-i", "V_in=1", "-i", "T_e=300"), "T_e", 300.0),
    ],
)
def test_inputs_are_numbers_and_signals(call, tmp_path, words, name, value):
    call(*SHORT, *words, "--out", tmp_path / "run.nc")
    with xarray.open_dataset(tmp_path / "run.nc", engine="scipy") as result:
        assert float(result[name][-1]) == pytest.approx(value, rel=1e-9)


@pytest.mark.parametrize(
    ("text", "end"),
    [
        ("t,V_in\n0,1\n1,3\n", 1.002),
        ("time;volts\n0;1\n1;3\n", 1.002),
        ("t\tF_ext\tV_in\n0\t7\t1\n1\t8\t3\n", 1.002),
    ],
    ids=["comma", "another name", "one of two"],
)
def test_inputs_come_from_files(call, tmp_path, text, end):
    (tmp_path / "my drive.csv").write_text(text, encoding="utf-8")
    words = ("-i", f"V_in=@{tmp_path / 'my drive.csv'}", "--out", tmp_path / "run.nc")
    assert call(*SHORT, *words).code == 0
    assert last(tmp_path / "run.nc").V_in.values[-1] == pytest.approx(end)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("t,a,b\n0,1,2\n1,3,4\n", "has no column 'V_in' beside its times; columns: t, a, b"),
        ("t,V_in\n0,1\n1,x\n", "drive.csv, line 3: 'x' is not a number"),
        ("t,V_in\n0,1\n1e-6,2\n", "samples span 0 s to 1e-06 s; expected samples that cover"),
        ("t,V_in\n", "0 rows of a time and a value; expected at least two rows"),
        ("", "drive.csv: is empty; expected a header line"),
        (None, "drive.csv: cannot be read: No such file"),
    ],
    ids=["columns", "number", "span", "header", "empty", "missing"],
)
def test_a_wrong_file_is_one_line(refused, tmp_path, text, message):
    path = tmp_path / "drive.csv"
    if text is not None:
        path.write_text(text, encoding="utf-8")
    assert message in refused(*SHORT, "-i", f"V_in=@{path}")


def test_initial_values_are_those_given(call, tmp_path):
    words = ("--initial", "q=1e-4", "--initial", "phi=1e-4,2e-4", "--out", tmp_path / "run.nc")
    assert call(*SHORT, *words).code == 0
    run = last(tmp_path / "run.nc")
    assert run.q.values[0] == 1e-4
    assert run.phi.values[0].tolist() == [1e-4, 2e-4]


def test_a_parameter_of_a_bank_takes_a_number_a_lane(call, tmp_path):
    words = ("-p", "L=1e-3,2e-3", "-i", "V_in=1")
    call(*SHORT, *words, "--out", tmp_path / "run.nc")
    with xarray.open_dataset(tmp_path / "run.nc", engine="scipy") as result:
        assert result.parameter_L.tolist() == [1e-3, 2e-3]


def test_a_bank_takes_another_size(call, tmp_path):
    call(*SHORT, "-p", "hysteron_count=5", "--out", tmp_path / "run.nc")
    with xarray.open_dataset(tmp_path / "run.nc", engine="scipy") as result:
        assert result.sizes["hysteron"] == 5


def test_a_signal_takes_its_numbers_by_name(call):
    """A sine about 50 V; its end is its start."""
    words = ("V_in=sine(100, 100, 50)", "V_in=sine(100, 100, offset=50)")
    run = ("simulate", "piezo_stack", "--duration", "0.01", "-i")
    shown = [call(*run, word).out for word in words]
    assert shown[0] == shown[1]
    assert re.search(r"V_in +50 ", shown[0])


def test_the_help_spells_every_signal_as_it_is_written():
    said = " ".join(simulate_command.__doc__.split())
    assert all(spelled(name) in said for name in SIGNALS)


def test_numbers_are_in_si_or_in_a_unit_of_their_own(call, spec_file):
    """The spec says L = 1 mH and V_in in kV; 1.2 is in H then, and the command says so."""
    spec = spec_file('L    = { value = 1e-3,   unit = "H"', 'L = { value = 1.0, unit = "mH"')
    spec.write_text(spec.read_text().replace('V_in  = { unit = "V"', 'V_in = { unit = "kV"'))
    words = ("simulate", spec, "--duration", "1e-4", "--times", "3")
    plain = call(*words, "--set", "L=1.2e-3", "--input", "V_in=1e2")
    *table, one, other = plain.out.splitlines()
    assert one == "V_in: read in V, though the spec has kV; a number may say its unit: V_in=1.2kV"
    assert other == "L = 1.2e-3 H (spec: 1.0 mH); a number may say its unit: L=1.2mH"
    for L, volts in [("1.2mH", "0.1kV"), ("1200 uH", "100V"), ("1.2mH,1.2e3uH", "1e-1kV")]:
        said = call(*words, "--set", f"L={L}", "--input", f"V_in={volts}")
        assert (said.code, said.out.splitlines()) == (0, table)
    assert "spec" not in call(*words, "--set", "C=5uF").out


def test_times_starts_and_numbers_of_signals_may_have_units(call, spec_file):
    spec = spec_file('V_in  = { unit = "V"', 'V_in = { unit = "kV"')
    words = ("simulate", spec, "--times", "3")
    start, drive = ("--initial", "q=1e-6"), "V_in=sine(100, 50, phase=0.5, offset=20)"
    plain = call(*words, "--duration", "1e-4", "--step", "1e-5", *start, "-i", drive)
    *table, line = plain.out.splitlines()
    assert line.startswith("V_in: read in V, though the spec has kV; ")
    start = ("--initial", "q=1um", "-i", "V_in=sine(0.1kV, 0.05kHz, phase=0.5rad, offset=20 V)")
    said = call(*words, "--duration", "100us", "--step", "10 us", *start)
    assert (said.code, said.out.splitlines()) == (0, table)


REFUSED = [
    (("-p", "L=1.2mF"), "--set L: 'mF' is no unit of 'L'; expected one such as H"),
    (("-p", "L=1e-3,2mH"), "--set L: '1e-3' has no unit; expected a unit for each number, or none"),
    (("-p", "L=1.2mHenry"), "--set L: unknown unit 'mHenry'; did you mean 'mH'?"),
    (("-p", "T_0=20degC"), "--set T_0: unit 'degC' has an offset"),
    (
        ("-i", "T_e=20degC"),
        "--input T_e: unit 'degC' has an offset; expected a plain unit; give it in K: 293.15; the "
        "header of a .csv may say degC",
    ),
    (("-p", "hysteron_count=2m"), "--set hysteron_count: 'm' is no unit of 'hysteron_count'; exp"),
    (("-p", "zz=2mH"), "--set: unknown name 'zz'; known: M, k"),
    (("--initial", "q=1mV"), "--initial q: 'mV' is no unit of 'q'; expected one such as m"),
    (("--initial", "T_body=20degC"), "--initial T_body: unit 'degC' has an offset; expected"),
    (("--step", "10uV"), "--step: 'uV' is no unit of 'step'; expected one such as s"),
    (("--t0", "soon"), "--t0: 'soon' is no number; expected such as 0.5 or 1e-3, in SI"),
    (("-i", "V_in=sine(2N,5)"), "--input V_in: 'N' is no unit of 'amplitude'; expected one such"),
    (("-i", "V_in=sine(2,5rpm)"), "--input V_in: 'rpm' is no unit of 'frequency'; expected one"),
    (("-i", "V_in=1kN"), "--input V_in: 'kN' is no unit of 'V_in'; expected one such as V"),
    (("-i", "V_in=ramp"), "--input V_in: 'ramp' has no numbers; expected ramp(start [s], stop [s]"),
    (
        ("--stop", "q < 5mm"),
        "--stop: 'q < 5mm' has a number that runs into 'm'; expected a ",
    ),
    (("-i", "V_in"), "--input: 'V_in' has no '='; expected NAME=VALUE"),
    (("-i", "V_in=high"), "--input V_in: 'high' is no number; expected such as 0.5 or 1e-3"),
    (("-i", "V_in="), "--input V_in: '' is no number"),
    (
        ("-i", "V_in=3,5"),
        "--input V_in: '3,5' is no number; expected such as 0.5 or 1e-3, in SI; wri",
    ),
    (
        ("-i", "V_in=3,5V"),
        "--input V_in: '3,5V' is no number; expected such as 0.5 or 1e-3, in SI; wri",
    ),
    (("-i", "V_in=ok.csv"), "--input V_in: 'ok.csv' is a file; expected @ok.csv"),
    (("-i", "V_in=sin(1,2)"), "--input V_in: 'sin' is no signal; did you mean 'sine'?"),
    (("-i", "V_in=exit(1)"), "--input V_in: 'exit' is no signal; known: chirp, ramp"),
    (("-i", "V_in=__import__('os')"), "--input V_in: '__import__('os')' is no number"),
    (
        ("-i", "V_in=sine(100)"),
        "--input V_in: sine.frequency: is missing; expected sine(amplitude, frequency [Hz], off",
    ),
    (("-i", "V_in=ramp(0,1)"), "--input V_in: ramp.before: is missing; expected ramp(start [s], "),
    (("-i", "V_in=sine(1,2,3,4,5)"), "--input V_in: sine: too many positional arguments; expect"),
    (("-i", "V_in=sine(1,2,3,bias=4)"), "--input V_in: sine: unknown name 'bias'; known: ampl"),
    (("-p", "L=[1e-3,2e-3]"), "--set L: '[1e-3,2e-3]' has brackets; write 1e-3,2e-3 without"),
    (("-p", "L=[1mH,2mH]"), "--set L: '[1mH,2mH]' has brackets; write 1mH,2mH without them"),
    (("-i", "V_in=sine(1,2,offset=x)"), "--input V_in: 'x' is no number"),
    (("-i", "V_in=sine(1,x)"), "--input V_in: 'x' is no number"),
    (("-i", "V_in=sine(1,-2)"), "--input V_in: sine.frequency: -2.0 is not positive"),
    (("-i", "V_in=sine(1,2"), "--input V_in: 'sine(1,2' has no ')' at its end; expected sine("),
    (("-i", "V_in=nan"), "--input V_in: nan is not a finite number"),
    (("-i", "Vin=1"), "--input: unknown name 'Vin'; did you mean 'V_in'?"),
    (("-i", "T_e=290"), "model 'piezo_stack': start is outside the domain at t = 0 s"),
    (("-p", "mass=1"), "--set: unknown name 'mass'; known: M, k"),
    (("-i", "V_in=@"), "--input V_in: '@' names no file; expected @FILE.csv"),
    (("--initial", "q"), "--initial: 'q' has no '='"),
    (("--initial", "q=far"), "--initial q: 'far' is no number"),
    (("--initial", "Q=1"), "--initial: unknown name 'Q'; did you mean 'q'?"),
    (("--initial", "L=1"), "--initial: unknown name 'L'; give it with --set"),
    (("-p", "phi=1"), "--set: unknown name 'phi'; give it with --initial"),
    (("-p", "V_in=1"), "--set: unknown name 'V_in'; give it with --input"),
    (("-i", "S=1"), "--input: unknown name 'S'; give it with --initial"),
    (("-p", "M"), "--set: 'M' has no '='"),
    (("-p", "M=heavy"), "--set M: 'heavy' is no number"),
    (("-p", "d=1,2"), "--set d: '[1, 2]' is a list"),
    (("-p", "d=-1"), "model 'piezo_stack': start is outside the domain"),
    (("-p", "L=1,2,3"), "--set L: 3 values for 2 lanes"),
    (("-p", "hysteron_count=0"), "--set hysteron_count: 0 is not allowed"),
    (("-p", "hysteron_count=2.5"), "--set hysteron_count: 2.5 is not allowed"),
    (("--rtol", "1"), "--rtol: 1 is out of range"),
    (("--method", "Euler"), "--method: unknown method 'Euler'"),
    (("--times", "1"), "--times: 1 is not allowed"),
    (("--duration", "0"), "--duration: 0.0 is not positive"),
    (("--duration", "1e300"), "--duration: 1e+300 is too long; expected at most 1e+18 s"),
    (("--duration", "nan"), "--duration: nan is not a finite number"),
    (("--out", "run.txt"), "--out: 'run.txt' has no known ending; expected .nc, .csv"),
    (("--out", "run"), "--out: 'run' has no known ending"),
]


@pytest.mark.parametrize(("words", "message"), REFUSED)
def test_a_wrong_run_is_one_line_and_exit_code_2(refused, words, message):
    assert refused(*SHORT, *words).startswith(message)


@pytest.mark.long
def test_a_fault_of_the_spec_has_its_name_and_one_of_an_option_has_not(refused, spec_file):
    """`verify` names the same file for the same fault."""
    path = spec_file('"d >= 0", ', "")
    said = refused("simulate", path, "--duration", "1e-3", code=1)
    assert said.startswith("mine.toml: mine.damper: passive is REFUTED")
    assert "`piezo-sym generate --allow-unproved` writes it all the same, for a run" in said
    assert "for a run, which needs --method LSODA where entropy is consumed" in said
    assert "more REFUTED" not in said
    both = spec_file('"d >= 0", "rho >= 0", "i_0 >= 0", ', '"i_0 >= 0", ')
    said = refused("simulate", both, "--duration", "1e-3", code=1)
    assert "; 1 more REFUTED: see `piezo-sym verify SPEC`; or `piezo-sym generate" in said
    path = spec_file('between = ["in", "gnd"]', 'between = ["elsewhere", "gnd"]')
    said = refused("simulate", path, "--duration", "1e-3")
    assert said.startswith("mine.toml: ")
    assert said == refused("verify", path)
    assert refused(*SHORT, "--initial", "M=1").startswith("--initial: ")


def test_an_edited_spec_runs_and_its_old_module_is_named(
    spec_file, tmp_path, monkeypatch, call, refused
):
    monkeypatch.chdir(tmp_path)
    assert call("generate", spec_file()).code == 0
    path = spec_file("3.5e-3", "4e-3")
    answer = call("simulate", path, "--duration", "1e-3")
    assert answer.code == 0
    assert f"is not used; replace it by `piezo-sym generate {path}`" in answer.err
    assert len(answer.err.splitlines()) == 1
    wrong = refused("simulate", path, "--duration", "1e-3", "--set", "zz=1")
    assert wrong.startswith("--set: unknown name 'zz'")  # one line, the error


def last(path):
    with xarray.open_dataset(path, engine="scipy") as result:
        return result.load()


@pytest.mark.parametrize(
    ("words", "method", "more"),
    [
        ((), "discrete_gradient", {"rtol": 1e-5}),
        (("--rtol", "1e-7"), "discrete_gradient", {"rtol": 1e-7}),
        (("--step", "1e-5"), "discrete_gradient", {"step": 1e-5}),
        (("--method", "discrete_gradient"), "discrete_gradient", {"rtol": 1e-5}),
        (("--method", "Radau", "--rtol", "1e-7"), "Radau", {"rtol": 1e-7}),
    ],
)
def test_method_tolerance_and_step_are_those_given(call, tmp_path, words, method, more):
    answer = call(*DRIVEN, *words, "--out", tmp_path / "run.nc")
    assert (answer.code, answer.err) == (0, "")
    attrs = last(tmp_path / "run.nc").attrs
    assert attrs["method"] == method
    assert {name: attrs[name] for name in ("rtol", "step") if name in attrs} == more


def test_help_names_methods_tolerance_and_step(call):
    said = " ".join(call("simulate", "--help").out.split())
    for words in ("discrete_gradient (compiled)", "LSODA", "--rtol", "--step", "1e-5 if left out"):
        assert words in said


@pytest.mark.usefixtures("no_compiler")
def test_no_compiler_is_one_line_and_a_good_run(call, tmp_path):
    answer = call(*DRIVEN, "--out", tmp_path / "run.nc")
    assert answer.code == 0
    assert answer.err == (
        "piezo-sym: model 'piezo_stack' runs by LSODA in NumPy, not compiled by "
        "discrete_gradient: engine: no C compiler is found; install gcc or clang, set CC, or "
        "`pip install piezo_sym[zig]`\n"
    )
    assert last(tmp_path / "run.nc").attrs["method"] == "LSODA"


@pytest.mark.usefixtures("no_compiler")
def test_drawing_without_a_compiler_is_refused_before_anything_is_written(refused, tmp_path):
    said = refused("reproduce", "--out", tmp_path / "figures")
    assert said.startswith("engine: no C compiler is found; install gcc")
    assert not (tmp_path / "figures").exists()


@pytest.mark.usefixtures("no_compiler")
@pytest.mark.parametrize("words", [("--step", "1e-5"), ("--method", "discrete_gradient")])
def test_what_was_asked_for_without_a_compiler_is_one_line_and_exit_code_2(refused, words):
    assert refused(*DRIVEN, *words).startswith("engine: no C compiler is found; install gcc")


def compiled(folder):
    """Return whether the module is compiled, so that its run begins."""
    return any(".build-" not in str(path) for path in folder.rglob("piezo_stack.*"))


LONG = ("--duration", "1e5", "-i", "V_in=sine(100,100)")


@pytest.mark.some(1)
@pytest.mark.parametrize("words", [("--step", "1e-5"), ()], ids=["step", "tolerance"])
def test_a_long_run_stops_within_a_second_of_ctrl_c(words, tmp_path):
    command = [sys.executable, "-m", "piezo_sym", "simulate", "piezo_stack", *LONG, *words]
    environment = {
        **os.environ,
        "PYTHONPATH": str(ROOT),
        "XDG_CACHE_HOME": str(tmp_path),
        "HOME": str(tmp_path),
    }
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    with subprocess.Popen(command, env=environment, **pipes) as process:
        while not compiled(tmp_path):
            assert process.poll() is None
            time.sleep(0.05)
        time.sleep(1.0)
        process.send_signal(signal.SIGINT)
        begun = time.monotonic()
        out, err = process.communicate(timeout=60)
    assert time.monotonic() - begun < 60.0  # the run takes minutes
    assert (process.returncode, out) == (130, "")
    said = r"the run is at t = [\d.e+-]+ s; --out would keep it until here\npiezo-sym: stopped"
    assert re.fullmatch(said, err.strip("\n"))


def test_ctrl_c_keeps_what_the_run_has(call, monkeypatch, tmp_path):
    def interrupt(t):
        if t > 0.05:
            raise KeyboardInterrupt

    run = piezo_sym.simulate
    monkeypatch.setattr(
        "piezo_sym.api.simulate",
        lambda spec, **options: run(spec, **{**options, "progress": interrupt}),
    )
    out = tmp_path / "part.nc"
    words = ("simulate", "piezo_stack", *LONG[2:], "--duration", "10")
    answer = call(*words, "--out", out)
    with xarray.open_dataset(out) as partial:
        end = float(partial.time[-1])
    assert 0.05 <= end < 9
    assert answer.code == 130
    said = f"'{out}' holds the run until t = {end:.6g} s\npiezo-sym: stopped\n"
    assert answer.err.lstrip("\n") == said

    answer = call(*words, "--times", "3", "--out", out)
    assert answer.code == 130
    with xarray.open_dataset(out) as partial:
        start, end = partial.time.values
    assert start == 0
    assert 0.05 <= end < 9
    monkeypatch.undo()
    answer = call("simulate", "piezo_stack", "--duration", "1e-3", "--continue", out)
    assert f"piezo_stack at t = {end + 1e-3:.6g} s" in answer.out


@pytest.mark.parametrize(
    ("signal", "times", "said"),
    [
        ("sine(100, 3kHz)", "6", "apart alias its period of 0.000333 s; --times 61 show it"),
        ("square(100, 3kHz)", "6", "apart alias its period of 0.000333 s; --times 61 show it"),
        ("sine(100, 3kHz)", "7", ""),
        ("100", "2", ""),
    ],
)
def test_samples_that_alias_an_input_are_named_in_one_line(call, tmp_path, signal, times, said):
    words = ("simulate", "piezo_stack", "--duration", "1ms", "--times", times)
    words += ("-i", f"V_in={signal}")
    answer = call(*words, "--out", tmp_path / "run.nc")
    assert answer.code == 0
    named = [line for line in answer.out.splitlines() if line.startswith("V_in: ")]
    assert len(named) == bool(said)
    assert all(line.endswith(said) for line in named)
    assert "alias" not in call(*words).out


def test_a_dissipative_start_is_asked_for_in_a_word(call):
    given = (*SHORT, "--input", "V_in=100", "--step", "1e-4")
    answer = call(*given, "--dissipative-start")
    assert (answer.code, answer.err) == (0, "")
    assert "heat_numerical" in answer.out
    assert "numerical" not in call(*given).out
    refused = call(*given[:-2], "--dissipative-start", "--method", "BDF")
    assert refused.code == 2
    assert "method BDF has no dissipative start" in refused.err
    assert len(refused.err.splitlines()) == 1


def test_a_run_that_stops_leaves_a_file_and_says_so(call, tmp_path):
    text = (MODELS / "oscillator.toml").read_text(encoding="utf-8").replace("oscillator", "warm")
    text = text.replace("[inputs]", 'T_m = { value = 300.8, unit = "K" }\n[inputs]')
    warm, out = tmp_path / "warm.toml", tmp_path / "warm.nc"
    warm.write_text(text.replace("assume = [", 'assume = ["T < T_m", '), encoding="utf-8")
    options = ("--duration", "10", "-i", "F=sine(1,1)", "--out", out)
    answer = call("simulate", warm, *options, "--event", "on=F")
    assert answer.code == 2
    assert answer.err.endswith(f"'{out}' holds the run until t = 3.97774 s\n")
    assert answer.out == "event on, 7 in all: t = 0.5, 1, 1.5, 2, ...\n"
    with xarray.open_dataset(out) as partial:
        assert partial.time.values[-2:] == pytest.approx([3.97, 3.97774], rel=1e-5)
        assert partial.on.values == pytest.approx(0.5 * np.arange(1, 8))


@pytest.mark.some(1)
@pytest.mark.parametrize(
    ("words", "reader", "written"),
    [
        ("simulate a.toml --duration 1e-3 --out y.csv", "| head -3", ("y.csv",)),
        ("generate b.toml a.toml", "| true", ("generated/b/b.py", "generated/a/a.py")),
        ("generate b.toml a.toml", "> /dev/full", ("generated/b/b.py", "generated/a/a.py")),
        ("verify a.toml --junit a.xml", "| true", ("a.xml",)),
        ("bench a.toml --only rhs --repeat 1 --json a.json", "| true", ("a.json",)),
    ],
    ids=["simulate", "generate", "generate, full", "verify", "bench"],
)
def test_a_closed_pipe_loses_no_result(words, reader, written, tmp_path):
    spec = (ROOT / "tests/networks/specs/a2_oscillator.toml").read_text(encoding="utf-8")
    for name in "ab":
        (tmp_path / f"{name}.toml").write_text(spec.replace('"damped_oscillator"', f'"{name}"'))
    command = f"{sys.executable} -m piezo_sym {words} {reader}"
    done = subprocess.run(command, shell=True, cwd=tmp_path, capture_output=True, text=True)
    said = [line for line in done.stderr.splitlines() if not line.startswith("measuring")]
    full = ["piezo-sym: cannot print: No space left on device; free some space, or print elsewhere"]
    assert said == (full if "full" in reader else [])
    assert [name for name in written if not (tmp_path / name).stat().st_size] == []


@pytest.mark.some(1)
@pytest.mark.parametrize("words", ["kinds", "simulate piezo_stack --duration 1e-3", "schema"])
def test_a_full_output_is_one_line(words):
    command = f"{sys.executable} -m piezo_sym {words} > /dev/full"
    done = subprocess.run(command, shell=True, capture_output=True, text=True)
    assert done.returncode == 2
    assert done.stderr.startswith("piezo-sym: cannot print: No space left on device")
    assert done.stderr.count("\n") == 1


def test_units_of_a_file_are_read_or_said_to_be_assumed(call, refused, tmp_path):
    words = ("simulate", "piezo_stack", "--duration", "0.01", "-i")
    path = tmp_path / "d.csv"
    path.write_text("t [ms],V_in [kV]\n0,0\n10,0.1\n")
    answer = call(*words, f"V_in=@{path}")
    assert "names no units" not in answer.out
    assert re.search(r"\n  V_in +100 ", answer.out)
    path.write_text("t,V_in\n0,0\n0.01,100\n")
    said = "V_in: its file names no units; read t in s and V_in in the input's SI unit\n"
    assert call(*words, f"V_in=@{path}").out.endswith(said)
    path.write_text("t [ms],V_in [A]\n0,0\n10,0.1\n")
    message = refused(*words, f"V_in=@{path}")
    assert message.endswith("d.csv, column 'V_in'); expected samples in V")


def test_a_run_stops_and_another_goes_on(call, refused, tmp_path):
    first, second = tmp_path / "first.nc", tmp_path / "second.nc"
    drive = ("simulate", "piezo_stack", "-i", "V_in=sine(100,100)")
    found = ("--event", "hit=q - 1e-3", "--stop", "T_body > 298.4")
    answer = call(*drive, "--duration", "0.1", *found, "--out", first)
    assert (answer.code, answer.err) == (0, "")
    with xarray.open_dataset(first) as run:
        end = float(run.time[-1])
        assert float(run.T_body[-1]) == pytest.approx(298.4, rel=1e-14)
        assert run.q_at_hit.values == pytest.approx(1e-3, rel=1e-12)
    answer = call(*drive, "--duration", "0.01", "--continue", first, "--out", second)
    assert (answer.code, answer.err) == (0, "")
    with xarray.open_dataset(second) as run:
        assert (float(run.time[0]), float(run.T_body[0])) == (end, pytest.approx(298.4, rel=1e-14))
    words = (*drive, "--duration", "0.01", "--continue")
    assert "there is no such file" in refused(*words, tmp_path / "none.nc")
    assert "is no run that can go on" in refused(*words, __file__)
    assert "--initial is given too" in refused(*words, first, "--initial", "q=0")


def test_events_are_in_a_table_beside_a_csv(call, tmp_path):
    out = tmp_path / "run.csv"
    found = ("--event", "on=V_in", "--event", "far=q - 5", "-i", "V_in=sine(100,100)")
    answer = call("simulate", "piezo_stack", "--duration", "0.021", *found, "--out", out)
    tables = [tmp_path / f"run_{name}.csv" for name in ("on", "far")]
    assert answer.out.splitlines()[-1] == f"{out}; events: {tables[0]}, {tables[1]}"
    with out.open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 1001
    assert not any("_at_" in name for name in rows[0])
    with tables[0].open() as file:
        rows = list(csv.DictReader(file))
    assert [float(row["on [s]"]) for row in rows] == pytest.approx([0.005, 0.01, 0.015, 0.02])
    assert {"q_at_on [m]", "phi_at_on_1 [Wb]", "phi_at_on_2 [Wb]"} <= rows[0].keys()
    assert len(tables[1].read_text().splitlines()) == 1  # never: the header alone


def test_a_run_into_a_store_goes_on_from_it(call, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    run = ("simulate", "piezo_stack", "--duration", "0.01", "-i", "V_in=sine(100,100)")
    first = call(*run, "--out", "one.zarr")
    assert first.code == 0
    assert first.out.rstrip().endswith("one.zarr")
    second = call(*run, "--continue", "one.zarr", "--out", "two.nc")
    assert "at t = 0.02 s" in second.out
    whole = xarray.load_dataset("two.nc", engine="scipy")
    before = xarray.open_dataset("one.zarr", engine="zarr", consolidated=False)
    assert float(whole.q[0]) == float(before.q[-1])
    assert [*before.data_vars] != []
    refused = call(*run, "--out", "one.zarr")
    assert refused.code == 2
    assert "exists already" in refused.err


def test_a_run_begins_at_a_temperature(call, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    run = ("simulate", "piezo_stack", "--duration", "0.01", "--initial", "T_body=320")
    assert call(*run, "--out", "run.nc").code == 0
    found = xarray.load_dataset("run.nc", engine="scipy")
    assert abs(float(found.T_body[0]) - 320.0) < 1e-10
    twice = call(*run, "--initial", "S=0.1")
    assert twice.code == 2
    assert "'S' is given too; expected one of them" in twice.err


@pytest.mark.parametrize(("event", "hits"), [("q - 5", 0), ("q - 1e-9", 1)])
def test_events_are_printed_however_often_they_happen(call, event, hits):
    answer = call(*DRIVEN, "--event", f"hit={event}")
    assert answer.code == 0
    assert f"event hit, {hits} in all" in answer.out
    assert "q_at_hit" not in answer.out  # the file has what there was at these times


def test_a_stop_that_is_never_met_is_said(call):
    assert "stop: q > 5 never holds" in call(*DRIVEN, "--stop", "q > 5").out.splitlines()
    assert "never holds" not in call(*DRIVEN, "--stop", "q > 1e-9").out


def test_a_table_of_events_of_an_earlier_run_is_said(call, tmp_path):
    out = tmp_path / "run.csv"
    (tmp_path / "run_drive.csv").write_text("t [s],F\n0,1\n", encoding="utf-8")
    assert call(*DRIVEN, "--event", "hit=q - 1e-9", "--out", out).err == ""
    earlier = (tmp_path / "run_hit.csv").read_bytes()
    said = f"piezo-sym: '{tmp_path / 'run_hit.csv'}' has events of an earlier run\n"
    assert call(*DRIVEN, "--out", out).err == said
    assert (tmp_path / "run_hit.csv").read_bytes() == earlier
    assert call(*DRIVEN, "--event", "hit=q - 1e-9", "--out", out).err == ""


def test_a_run_does_not_replace_what_it_goes_on_from(call, refused, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert call(*SHORT, "--out", "run.nc").code == 0
    before = Path("run.nc").read_bytes()
    said = refused(*SHORT, "--continue", "run.nc", "--out", tmp_path / "run.nc")
    assert said.endswith(
        "is what --continue goes on from, and would be lost; expected another file"
    )
    assert Path("run.nc").read_bytes() == before


@pytest.mark.parametrize("ending", ["nc", "csv", "zarr"])
def test_a_folder_that_is_made_is_said(call, tmp_path, ending):
    path = tmp_path / "new" / f"run.{ending}"
    said = f"made the folder '{path.parent}'"
    assert call(*SHORT, "--out", path).out.splitlines()[-2:] == [said, str(path)]
    assert path.exists()
    assert "made the folder" not in call(*SHORT, "--out", path.with_stem("again")).out


def test_last_values_have_the_digits_that_show_their_change(call):
    out = call("simulate", "heat_exchanger", "--duration", "1us").out
    shown = next(line.split()[1] for line in out.splitlines() if line.split()[:1] == ["T_hot"])
    run = piezo_sym.simulate("heat_exchanger", duration=1e-6)
    before, last = (f"{float(run.T_hot[n]):.6g}" for n in (0, -1))
    assert before == last
    change = float(run.T_hot[-1] - run.T_hot[0])
    assert float(shown) - float(run.T_hot[0]) == pytest.approx(change, rel=0.01)


@pytest.mark.long
def test_a_start_apart_from_states_of_the_same_rate_is_said(call, spec_file):
    guide = 'between = ["tip", "wall"]\nstiffness = "k"\nstate = "x"'
    spec = spec_file(
        "[elements.load]", f'[elements.guide]\nkind = "spring"\n{guide}\n[elements.load]'
    )
    run = ("simulate", spec, "--duration", "1e-4", "--initial", "x=3um")
    said = "piezo-sym: q, x move at one rate; given only x, they keep x - q as at the start: "
    assert f"{said}give q, too, if all are one quantity" in call(*run).err.splitlines()
    assert "one rate" not in call(*run, "--initial", "q=1um").err
    assert "one rate" not in call(*run[:-1], "Q_C=0").err
