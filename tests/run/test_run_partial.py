"""What a run that stops has reached is not lost: `error.partial`, and the command's file."""

import signal

import numpy as np
import pytest

from piezo_sym import load, simulate, sine
from piezo_sym.errors import RunError
from piezo_sym.run import events
from piezo_sym.run.events import values_of
from piezo_sym.spec.source import find

DRIVE = {"V_in": sine(100, 100)}


@pytest.fixture(scope="module")
def short_of_300_kelvin(tmp_path_factory):
    """The actuator with a domain that its own heat leaves after 0.0306 s."""
    text = find("piezo_stack").read_text().replace('name   = "piezo_stack"', 'name = "warm"')
    text = text.replace("[inputs]", 'T_m = { value = 300.0, unit = "K" }\n[inputs]', 1)
    path = tmp_path_factory.mktemp("warm") / "warm.toml"
    path.write_text(text.replace("assume = [", 'assume = ["T < T_m", ', 1))
    return path


@pytest.mark.some(1)
@pytest.mark.parametrize("method", [None, "LSODA"])
def test_the_error_of_a_run_carries_the_dataset_so_far(short_of_300_kelvin, method):
    model = load(short_of_300_kelvin)
    with pytest.raises(RunError, match=r"leaves the domain at t = 0\.03059") as stopped:
        simulate(model, inputs=DRIVE, duration=0.2, method=method, times=1001)
    partial = stopped.value.partial
    assert partial.time.values[-2] == pytest.approx(0.0304, rel=1e-12)  # the last sample before
    assert 0.0304 < partial.time.values[-1] <= 0.0306  # the end of the last step
    assert np.all(partial.T_body < 300)
    assert partial.attrs["stopped"] == str(stopped.value)
    until = partial.time.values
    whole = simulate(model, inputs=DRIVE, duration=until[-1], method=method, times=until)
    for name in [name for name in partial.data_vars if "residual" not in str(name)]:
        values = partial[name]
        size = float(np.abs(whole[name]).max()) + 1e-12
        assert np.abs(values - whole[name]).max() < 1e-4 * size, name
    if method is None:
        assert np.abs(partial.energy_residual).max() < 1e-12 * float(partial.energy[0])


def test_a_run_that_fails_at_its_start_has_none():
    with pytest.raises(RunError, match="start is outside") as stopped:
        simulate("piezo_stack", inputs={"T_e": 200.0}, duration=0.1)
    assert stopped.value.partial is None


def test_an_interrupt_in_a_function_of_time_is_not_lost():
    """What is raised in a function that C calls goes nowhere, and the input is 0 there."""
    calls, delayed = [], []

    def drive(t):
        if np.ndim(t) == 0:
            calls.append(t)
            if len(calls) == 8000:  # more than there are before the run
                signal.raise_signal(signal.SIGINT)
                delayed.append(t)  # it is raised behind the call of C
        return np.sin(2e3 * t) + np.sin(3e5 * t)  # too many pieces for C, which calls it

    given = {"duration": 1, "times": np.linspace(0, 1, 101), "rtol": 1e-6}
    with pytest.raises(KeyboardInterrupt) as stopped:
        simulate("oscillator", inputs={"F": drive}, **given)
    assert delayed
    assert stopped.value.partial.time[-1] > 0


@pytest.mark.some(1)
@pytest.mark.parametrize("method", [None, "LSODA"])
def test_a_run_that_is_interrupted_keeps_what_it_has(method):
    def interrupt(t):
        if t > 0.05:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt) as stopped:
        simulate("piezo_stack", inputs=DRIVE, duration=10, progress=interrupt, method=method)
    partial = stopped.value.partial
    assert 0.05 <= partial.time[-1] < 9
    assert partial.attrs["stopped"] == "stopped by the user"


@pytest.mark.some(2)
@pytest.mark.parametrize("calls", [1, 2, 4, 8])
def test_an_interrupted_run_ends_before_it_stops(calls):
    """Wherever it is interrupted: before the time is known, or while it is located."""
    told = []

    def interrupt(t):
        told.append(t)
        if len(told) == calls:
            raise KeyboardInterrupt

    times, stop = np.linspace(0, 2, 401), "T_body > 300"  # at t = 0.0306 s
    run = {"inputs": DRIVE, "duration": 2, "times": times, "progress": interrupt}
    with pytest.raises(KeyboardInterrupt) as stopped:
        simulate("piezo_stack", stop=stop, **run)
    partial = stopped.value.partial
    assert np.all(partial.T_body <= 300)
    assert 0.01 < partial.time[-1] < 0.0306
    assert np.isin(partial.time[:-1], times).all()
    assert partial.attrs["stopped"] == "stopped by the user"


def test_an_interrupt_between_two_passes_keeps_what_the_first_has_reached(monkeypatch):
    def interrupted(*given):
        if given[-1].states.shape[1] > 2000:  # of the first pass at last, or of the second
            raise KeyboardInterrupt
        return values_of(*given)

    monkeypatch.setattr(events, "values_of", interrupted)
    with pytest.raises(KeyboardInterrupt) as stopped:
        simulate("piezo_stack", inputs=DRIVE, duration=0.5, times=2001, events={"up": "q - 1e-4"})
    partial = stopped.value.partial
    assert partial.sizes["time"] == 2001
    assert partial.attrs["stopped"] == "stopped by the user"


SPARSE = [
    ("piezo_stack", {}),
    ("piezo_stack", {"step": 2e-5, "dissipative_start": True}),
    ("piezo_stack", {"parameters": {"hysteron_count": 40}}),
    pytest.param("piezo_stack", {"method": "LSODA"}, marks=pytest.mark.long),
    ("stack_maxwell", {}),
]


@pytest.mark.some(2)
@pytest.mark.parametrize(("model", "options"), SPARSE)
def test_of_sparse_samples_an_interrupted_run_keeps_its_last_step_and_goes_on(model, options):
    def interrupt(t):
        if t > 0.05:
            raise KeyboardInterrupt

    run = {"inputs": DRIVE, "times": 3, **options}
    with pytest.raises(KeyboardInterrupt) as stopped:
        simulate(model, duration=100, progress=interrupt, **run)
    partial = stopped.value.partial
    start, end = partial.time.values
    assert start == 0
    assert 0.05 < end < 50
    if "method" not in options:
        assert abs(partial.energy_residual[-1]) < 1e-13 * float(partial.energy[0])
        produced = [partial[n][-1].sum() for n in partial if str(n).startswith("produced_")]
        assert abs(partial.entropy_residual[-1]) < 1e-12 * float(sum(produced))
    rest = simulate(model, initial=partial, duration=0.01, **run)
    whole = simulate(model, duration=end + 0.01, **run)
    for name in ("q", "p", "T_body", "energy", "V_in"):
        size = float(np.abs(rest[name]).max())
        assert np.abs(rest[name][-1] - whole[name][-1]) < 1e-3 * size, name


@pytest.mark.some(1)
@pytest.mark.parametrize("watched", [{}, {"events": {"up": "q - 1e-4"}}])
def test_of_sparse_samples_a_run_that_fails_keeps_its_last_step(short_of_300_kelvin, watched):
    with pytest.raises(RunError, match=r"leaves the domain at t = 0\.03059") as stopped:
        simulate(load(short_of_300_kelvin), inputs=DRIVE, duration=0.2, times=3, **watched)
    partial = stopped.value.partial
    assert partial.time.values == pytest.approx([0, 0.03059], rel=1e-3)
    assert float(partial.T_body[-1]) == pytest.approx(300, abs=0.01)
    assert abs(partial.energy_residual[-1]) < 1e-13 * float(partial.energy[0])


@pytest.mark.some(1)
@pytest.mark.parametrize("times", [1001, 3])
@pytest.mark.parametrize("method", [None, "LSODA"])
def test_a_run_whose_inputs_leave_the_domain_carries_what_was_before(method, times):
    colder = {"T_e": lambda t: 298.15 - 20 * t}  # T_0 after 0.1 s
    with pytest.raises(RunError, match=r"leaves the domain at t = 0\.1 s") as stopped:
        simulate("piezo_stack", inputs=DRIVE | colder, duration=0.25, method=method, times=times)
    partial = stopped.value.partial
    assert partial.time.values[-1] == pytest.approx(0.1, rel=1e-2)
    assert partial.time.size == (2 if times == 3 else 401)
    assert partial.attrs["stopped"] == str(stopped.value)
    if times > 3:
        until = partial.time.values
        whole = simulate("piezo_stack", inputs=DRIVE | colder, duration=until[-1], times=until)
        assert np.abs(partial.q - whole.q).max() < 1e-4 * float(np.abs(whole.q).max())


def test_a_run_that_is_to_stop_before_its_inputs_leave_the_domain_is_a_run():
    colder = {"T_e": lambda t: 298.15 - 20 * t}
    run = simulate("piezo_stack", inputs=DRIVE | colder, duration=0.25, stop="T_e < 297")
    assert run.time.values[-1] == pytest.approx(0.0575)
