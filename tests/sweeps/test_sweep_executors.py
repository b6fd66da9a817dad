"""Who runs a sweep changes nothing: threads, any executor, SciPy without a compiler; Ctrl-C."""

import multiprocessing
import os
import re
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
import xarray

from piezo_sym import load, simulate, sine, sweep
from piezo_sym.errors import RunError, UsageError
from piezo_sym.run.engine import EngineWarning
from piezo_sym.sweeps import SweepWarning
from piezo_sym.sweeps.pool import at_hand, results

ROOT = Path(__file__).parents[2]
SPECS = ROOT / "tests" / "networks" / "specs"
OVER = {"V_in": {50.0: sine(100, 50), 100.0: sine(100, 100)}, "L": np.linspace(1e-3, 2e-3, 9)}
BASE = {"over": OVER, "duration": 2e-3, "times": 5}


def assert_same(found, wanted):
    """Check that sweeps agree: cut into other boxes, their last bits may differ."""
    xarray.testing.assert_allclose(found, wanted, rtol=1e-9, atol=1e-11)


@pytest.fixture(scope="module")
def alone():
    return sweep("piezo_stack", **BASE, threads=1)


@pytest.fixture(scope="module")
def processes():
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(2, mp_context=context) as pool:
        yield pool


def test_any_number_of_threads_gives_the_same(alone):
    for threads in (2, 5):
        assert_same(sweep("piezo_stack", **BASE, threads=threads), alone)


def test_one_thread_is_the_caller_s():
    """So that a debugger stops in a user's function, and nothing has to be safe in threads."""
    where = []

    def last(run):
        where.append(threading.current_thread())
        return run.q[-1]

    sweep("piezo_stack", **BASE, reduce=last, threads=1)
    assert where == [threading.current_thread()] * 18


@pytest.mark.parametrize("at_once", [1, 2, 7, 100])
def test_what_comes_together_is_taken_in_the_order_sent(at_once):
    assert list(results(at_hand, range(50), at_once)) == [(n, n) for n in range(50)]


def test_a_thread_pool_of_ones_own(alone):
    with ThreadPoolExecutor(2) as pool:
        found = sweep("piezo_stack", **BASE, executor=pool)
        assert_same(found, alone)
        assert pool.submit(int).result() == 0  # it is still the user's


def test_processes_give_the_same(alone, processes):
    assert_same(sweep("piezo_stack", **BASE, executor=processes), alone)


def test_a_model_in_a_process_need_not_be_a_file(processes):
    model = load(SPECS / "a2_oscillator.toml")
    options = {"over": {"d": [0.2, 0.4]}, "duration": 1.0, "times": 3}
    found = sweep(model, **options, executor=processes)
    assert_same(found, sweep(model, **options))


def test_functions_go_to_processes_by_value(processes):
    height = 7.0
    options = {
        "over": {"L": [1e-3, 2e-3]},
        "inputs": {"V_in": lambda t: height * t},
        "reduce": lambda run: {"x": run.phi.max() * height},
        "duration": 2e-3,
    }
    found = sweep("piezo_stack", **options, executor=processes)
    assert_same(found, sweep("piezo_stack", **options))


def test_a_process_sees_what_a_thread_sees(processes):
    options = {
        "over": {"V_in": [lambda t: t, lambda t: 2 * t], "hysteron_count": [1, 3], "L": [1e-3] * 5},
        "reduce": lambda run: (
            run[["phi"]].isel(time=-1).assign(one=float(str(run.over_V_in.values)[0]))
        ),  # of "0: <lambda>", "1: <lambda>"
        "duration": 1e-3,
    }
    found = sweep("piezo_stack", **options, executor=processes)
    assert_same(found, sweep("piezo_stack", **options))
    assert found.one.values[:, 0, 0].tolist() == [0.0, 1.0]


def test_what_cannot_be_sent_is_one_line(processes):
    lock = threading.Lock()
    with pytest.raises(UsageError) as raised:
        sweep("piezo_stack", **BASE, executor=processes, reduce=lambda run: (lock, run))
    assert str(raised.value).startswith("sweep.executor: a function or value cannot be sent")
    assert "\n" not in str(raised.value)


def test_without_cloudpickle_a_local_function_is_one_line(processes, monkeypatch):
    monkeypatch.setitem(sys.modules, "cloudpickle", None)
    with pytest.raises(UsageError, match=r"cannot be sent .*pip install cloudpickle"):
        sweep("piezo_stack", **BASE, executor=processes, reduce=lambda run: run.q[-1])


def die(run):
    os.kill(os.getpid(), signal.SIGKILL)
    return run


def test_a_process_that_dies_is_one_line():
    spawn = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(1, spawn) as pool, pytest.raises(RunError) as raised:
        sweep("piezo_stack", **BASE, executor=pool, reduce=die)
    assert str(raised.value).startswith("sweep.executor: a process of the executor died")


def test_an_error_of_a_process_arrives(processes):
    with pytest.raises(UsageError, match=r"^sweep.reduce: the function gives 'text'"):
        sweep("piezo_stack", **BASE, executor=processes, reduce=lambda run: "text")  # noqa: ARG005


def test_both_threads_and_an_executor_are_refused():
    message = "executor and threads are both given"
    with ThreadPoolExecutor(1) as pool, pytest.raises(UsageError, match=message):
        sweep("piezo_stack", **BASE, executor=pool, threads=2)


@pytest.mark.parametrize("method", ["LSODA", "Radau"])
def test_methods_of_scipy_run_one_by_one(method):
    over = {"L": [1e-3, 2e-3], "d": [-1.0, 400.0]}
    with pytest.warns(SweepWarning, match="2 of 4 runs failed"):
        found = sweep("piezo_stack", over=over, duration=1e-3, times=3, method=method)
    run = simulate("piezo_stack", parameters={"L": 2e-3}, duration=1e-3, times=3, method=method)
    for name in run.data_vars:
        member = found[name].sel(L=2e-3, d=400.0) if "L" in found[name].dims else found[name]
        np.testing.assert_array_equal(member, run[name], err_msg=name)
    assert found.attrs["method"] == method
    last = {"reduce": "last", "times": 3, "method": method}
    last = sweep("piezo_stack", over={"L": [2e-3]}, duration=1e-3, **last)
    np.testing.assert_array_equal(last.phi[0], run.phi[-1])


@pytest.mark.usefixtures("no_compiler")
def test_without_a_compiler_runs_go_on_in_numpy():
    over = {"L": [1e-3, 2e-3]}
    with pytest.warns(EngineWarning, match="by LSODA in NumPy") as warned:
        found = sweep("piezo_stack", over=over, duration=1e-3, times=3)
    assert len(warned) == 1
    assert found.attrs["method"] == "LSODA"
    assert np.isfinite(found.q).all()


def test_progress_is_told():
    told = []
    sweep("piezo_stack", **BASE, threads=2, progress=lambda *parts: told.append(parts))
    assert [total for _, total in told] == [18] * len(told)
    assert [done for done, _ in told] == sorted(done for done, _ in told)
    assert told[-1] == (18, 18)


def test_a_bar_is_shown_where_it_is_wanted(capsys, monkeypatch):
    monkeypatch.setattr("piezo_sym.progress.SECOND", 0.0)
    sweep("piezo_stack", **BASE, progress=True)
    shown = capsys.readouterr()
    assert "sweep" in shown.err
    assert shown.out == ""
    sweep("piezo_stack", **BASE)  # no terminal: none
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("options", [{"threads": 1}, {"threads": 2}, {"store": "runs.zarr"}])
def test_an_interrupted_sweep_has_the_runs_that_are_done(options, tmp_path, monkeypatch):
    def interrupt(done, _):
        if done > 3:
            raise KeyboardInterrupt

    monkeypatch.chdir(tmp_path)
    given = {"over": {"L": np.linspace(1e-3, 2e-3, 24)}, "duration": 1e-3, "times": 3}
    given["inputs"] = {"V_in": 100.0}
    with pytest.raises(KeyboardInterrupt, match=r"^\d+ of 24 runs are done: .partial") as stopped:
        sweep("piezo_stack", progress=interrupt, **given, **options)
    partial, whole = stopped.value.partial, sweep("piezo_stack", **given)
    done = partial.error.values == ""
    assert 3 < done.sum() < 24
    assert (partial.error.values[~done] == "not run").all()
    assert np.array_equal(partial.q.values[done], whole.q.values[done])
    assert np.isnan(partial.q.values[~done]).all()


@pytest.mark.long
def test_ctrl_c_of_a_sweep_names_no_file_of_python():
    code = LONG.format(duration=0.03, store=None, method=None, threads=2)
    pipe = subprocess.PIPE
    with subprocess.Popen(
        [sys.executable, "-c", code], cwd=ROOT, stdout=pipe, stderr=pipe, text=True
    ) as process:
        assert process.stdout.readline()
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
    assert re.search(r"\nKeyboardInterrupt: \d+ of 30000 runs are done: .partial", errors)
    assert "concurrent" not in errors
    assert "threading" not in errors


LONG = """
import signal
import numpy as np
signal.signal(signal.SIGINT, signal.default_int_handler)  # a job in the background ignores it
from piezo_sym import sine, sweep
over = {{"L": np.linspace(5e-4, 5e-3, 30_000)}}
sweep("piezo_stack", over=over, inputs={{"V_in": sine(100, 100)}}, duration={duration}, times=11,
      store={store!r}, method={method!r}, threads={threads},
      progress=lambda *done: print(*done, flush=True))
"""


@pytest.mark.some(1)
@pytest.mark.parametrize(
    ("duration", "method", "threads"),
    [
        (0.03, "discrete_gradient", 2),
        (10.0, "discrete_gradient", 2),
        pytest.param(10.0, "discrete_gradient", 1, marks=pytest.mark.long),
        (10.0, "LSODA", 2),
    ],
)
def test_control_c_stops_within_seconds_and_leaves_the_store(tmp_path, duration, method, threads):
    path = tmp_path / "runs.zarr"
    code = LONG.format(duration=duration, store=str(path), method=method, threads=threads)
    pipe = subprocess.PIPE
    with subprocess.Popen(
        [sys.executable, "-c", code], cwd=ROOT, stdout=pipe, stderr=pipe, text=True
    ) as process:
        if duration < 1:
            assert process.stdout.readline()
        else:
            while not path.exists():
                time.sleep(0.05)
            time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        begun = time.monotonic()
        try:
            _, errors = process.communicate(timeout=60)
        finally:
            process.kill()
        took = time.monotonic() - begun
    # zarr may still say that it never awaited what it was interrupted in
    assert any(line.startswith("KeyboardInterrupt") for line in errors.splitlines()), errors
    assert took < 30  # seconds, on any machine; the runs of 10 s alone would take hours
    with xarray.open_zarr(path, chunks=None, consolidated=False) as found:
        done = found.error.values == ""
        assert (found.error.values[~done] == "not run").all()
        assert not done.all()
        if duration < 1:
            assert done.any()
            assert np.isfinite(found.q.values[done]).all()
