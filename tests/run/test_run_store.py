"""Runs into a store: the same as in memory, in memory that does not grow, nothing overwritten."""

import signal
import subprocess
import sys
import warnings

import numpy as np
import pytest
import xarray

from piezo_sym import simulate, sine
from piezo_sym.errors import FileError, UsageError
from piezo_sym.interrupts import held_back
from piezo_sym.run import streaming

pytest.importorskip("zarr")
DRIVE = {"V_in": sine(100, 100)}


@pytest.fixture
def short_windows(monkeypatch):
    """Windows of about 100 samples."""
    monkeypatch.setattr(streaming, "WINDOW", 6 * 9 * 100)


def readable(path):
    """Return a store as xarray opens it by default: a warning of its metadata is an error."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return xarray.open_zarr(path, chunks=None)


@pytest.mark.some(1)
@pytest.mark.parametrize("options", [{"rtol": 1e-9}, {"step": 1e-5}])
@pytest.mark.usefixtures("short_windows")
def test_a_run_in_windows_is_the_run(options, tmp_path):
    given = {"inputs": DRIVE, "duration": 0.02, "times": 501, **options}
    whole = simulate("piezo_stack", **given)
    kept = simulate("piezo_stack", store=tmp_path / "run.zarr", **given)
    assert np.array_equal(kept.time, whole.time)
    assert set(kept.data_vars) == set(whole.data_vars)
    for name in whole.data_vars:
        assert kept[name].attrs == whole[name].attrs, name
        if "residual" not in str(name):
            size = float(np.abs(whole[name]).max()) or 1.0
            assert np.abs(kept[name] - whole[name]).max() < 1e-7 * size, name
    supplied = sum(kept[name] for name in kept.data_vars if str(name).startswith("supplied_"))
    energy = kept.energy - kept.energy[0] - supplied
    assert np.abs(energy).max() < 1e-12 * float(kept.energy[0])
    assert np.abs(energy - kept.energy_residual).max() < 1e-12 * float(kept.energy[0])
    assert kept.attrs["accepted_steps"] >= whole.attrs["accepted_steps"]


@pytest.mark.usefixtures("short_windows")
def test_a_store_is_never_overwritten(tmp_path):
    path = tmp_path / "run.zarr"
    simulate("piezo_stack", duration=1e-3, store=path)
    before = {part: part.read_bytes() for part in path.rglob("*") if part.is_file()}
    with pytest.raises(FileError, match="exists already; choose another path, or delete it"):
        simulate("piezo_stack", duration=1e-3, store=path)
    assert before == {part: part.read_bytes() for part in path.rglob("*") if part.is_file()}
    with pytest.raises(UsageError, match="is no Zarr store; name it"):
        simulate("piezo_stack", duration=1e-3, store=tmp_path / "run.nc")
    with pytest.raises(UsageError, match=r"simulate\.store: 3 is no path"):
        simulate("piezo_stack", duration=1e-3, store=3)


@pytest.mark.usefixtures("short_windows")
def test_events_are_kept(tmp_path):
    events = {"hit": "q - 1e-4", "never": "q - 5"}
    given = {"inputs": DRIVE, "duration": 0.02, "times": 501, "rtol": 1e-9, "events": events}
    whole = simulate("piezo_stack", **given)
    kept = simulate("piezo_stack", store=tmp_path / "run.zarr", **given)
    assert set(kept.variables) == set(whole.variables)
    assert kept.sizes == whole.sizes
    assert kept.sizes["hit"] == 4
    assert np.abs(kept.hit - whole.hit.values).max() < 1e-9
    assert np.abs(kept.phi_at_hit.values - whole.phi_at_hit.values).max() < 1e-9
    assert kept.hit.attrs == whole.hit.attrs
    assert kept.attrs["accepted_steps"] >= whole.attrs["accepted_steps"]  # of all windows


@pytest.mark.parametrize(
    ("times", "volts"),
    [([0, 0.01, 0.02], [1, 0, -1]), ([0, 0.01, 0.01, 0.02], [1, 1, -1, -1])],
    ids=["zero", "jump"],
)
@pytest.mark.usefixtures("short_windows")
def test_an_event_where_windows_meet_is_kept_once(times, volts, tmp_path):
    """One begins with t = 0.01 s, at which the voltage is 0, or jumps."""
    given = {"inputs": {"V_in": (times, volts)}, "events": {"zero": "V_in"}}
    kept = simulate("piezo_stack", duration=0.02, times=201, store=tmp_path / "run.zarr", **given)
    assert kept.zero.values == pytest.approx([0.01], rel=1e-12)


@pytest.mark.usefixtures("short_windows")
def test_a_store_ends_where_the_run_stops(tmp_path):
    given = {"inputs": DRIVE, "duration": 100.0, "times": 500_001}
    kept = simulate("piezo_stack", stop="T_body > 299", store=tmp_path / "stop.zarr", **given)
    assert float(kept.T_body[-1]) == pytest.approx(299, rel=1e-13)
    assert readable(tmp_path / "stop.zarr").sizes == kept.sizes
    assert kept.sizes["time"] < 1000

    def interrupt(t):
        if t > 0.05:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt) as stopped:
        simulate("piezo_stack", store=tmp_path / "c.zarr", progress=interrupt, **given)
    kept = readable(tmp_path / "c.zarr")
    assert 0.04 < float(kept.time[-1]) < 0.2
    assert stopped.value.partial.sizes == kept.sizes


@pytest.mark.long
def test_memory_does_not_grow(tmp_path):
    """Twenty variables of 400,000 samples more would take 64 MB."""
    code = """
import resource, sys
from piezo_sym import simulate, sine
simulate("piezo_stack", inputs={"V_in": sine(1, 1)}, duration=1.0, store=sys.argv[1],
         times=int(sys.argv[2]), rtol=1e-3)
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
"""
    peaks = []
    for count in ("100000", "500000"):
        words = [sys.executable, "-c", code, str(tmp_path / f"{count}.zarr"), count]
        done = subprocess.run(words, capture_output=True, text=True, check=True)
        peaks.append(int(done.stdout) / 1e3)
    assert peaks[1] < peaks[0] + 32


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c_waits_for_what_is_being_written(number):
    done = []
    before = signal.signal(number, signal.default_int_handler)

    def write():
        with held_back():
            signal.raise_signal(number)
            done.append("written")

    with pytest.raises(KeyboardInterrupt):
        write()
    assert done == ["written"]
    assert signal.signal(number, before) is signal.default_int_handler
