"""A store: what is in memory is in it, and a sweep goes on where it was stopped."""

import sys

import numpy as np
import pytest
import xarray

from piezo_sym import samples, simulate, sine, step, sweep
from piezo_sym.errors import FileError, UsageError
from piezo_sym.sweeps import SweepWarning
from piezo_sym.sweeps import store as stores
from piezo_sym.sweeps.store import parts
from tests.conftest import full_disk

OVER = {"L": np.linspace(1e-3, 2e-3, 140), "V_in": {50.0: sine(100, 50), 100.0: sine(100, 100)}}
BASE = {"over": OVER, "duration": 1e-3, "times": 3, "threads": 1}
BOXES = 4  # 140 runs that go together are cut in two, for each of two inputs


@pytest.fixture(autouse=True)
def small_boxes(monkeypatch):
    """Cut sweeps into boxes of no more runs than it takes to make four here."""
    monkeypatch.setattr("piezo_sym.sweeps.plan.MOST_TOGETHER", 128)


def assert_same(found, wanted):
    """Check that sweeps agree: cut into other boxes, their last bits may differ."""
    xarray.testing.assert_allclose(found, wanted, rtol=1e-9, atol=1e-11)


class Interrupted(Exception):
    pass


def stop_at(runs):
    def told(done, _):
        if done >= runs:
            raise Interrupted

    return told


def plain(dataset):
    return dataset.load().drop_attrs()


def thirds(run):
    return run[["q", "phi"]].isel(time=slice(1, None))


REDUCTIONS = [None, "last", "mean", thirds]


@pytest.mark.some(1)
@pytest.mark.parametrize("reduce", REDUCTIONS)
def test_a_store_holds_what_memory_would(tmp_path, reduce):
    found = sweep("piezo_stack", **BASE, reduce=reduce, store=tmp_path / "runs.zarr")
    memory = sweep("piezo_stack", **BASE, reduce=reduce)
    assert_same(plain(found), plain(memory))
    for name in memory.variables:
        assert {k: found[name].attrs[k] for k in memory[name].attrs} == memory[name].attrs, name
    assert memory.attrs.items() <= found.attrs.items()


@pytest.mark.some(1)
@pytest.mark.parametrize("reduce", [None, "last", thirds])
def test_a_sweep_goes_on_where_it_was_stopped(tmp_path, reduce, monkeypatch):
    options = {**BASE, "reduce": reduce, "store": tmp_path / "runs.zarr"}
    with pytest.raises(Interrupted):
        sweep("piezo_stack", **options, progress=stop_at(140))
    with xarray.open_zarr(options["store"], chunks=None, consolidated=False) as half:
        assert (half.error.values == "").sum() == 140
        assert (half.error.values == "not run").sum() == 140
    ran = count_boxes(monkeypatch)
    found = sweep("piezo_stack", **options)
    assert sorted(ran) == [2, 3]
    assert_same(plain(found), plain(sweep("piezo_stack", **BASE, reduce=reduce)))
    ran.clear()
    sweep("piezo_stack", **options)
    assert ran == []


def count_boxes(monkeypatch):
    from piezo_sym.sweeps.plan import Plan

    ran, part = [], Plan.part

    def counted(plan, region):
        ran.append(list(plan.regions()).index(region))
        return part(plan, region)

    monkeypatch.setattr(Plan, "part", counted)
    return ran


def test_a_box_half_written_is_run_again(tmp_path, monkeypatch):
    path = tmp_path / "runs.zarr"
    sweep("piezo_stack", **BASE, store=path)
    chunks = sorted(file for file in (path / "error" / "c").rglob("*") if file.is_file())
    assert len(chunks) == BOXES
    chunks[0].write_bytes(chunks[0].read_bytes()[:7])
    chunks[-1].unlink()
    ran = count_boxes(monkeypatch)
    found = sweep("piezo_stack", **BASE, store=path)
    assert sorted(ran) == [0, 3]
    assert (found.error.values == "").all()


def test_what_is_done_does_not_depend_on_who_does_it(tmp_path, monkeypatch):
    path = tmp_path / "runs.zarr"
    with pytest.raises(Interrupted):
        sweep("piezo_stack", **BASE, store=path, progress=stop_at(35))
    ran = count_boxes(monkeypatch)  # the boxes of the store, not those of three threads
    found = sweep("piezo_stack", **{**BASE, "threads": 3}, store=path)
    assert sorted(ran) == [1, 2, 3]
    alone = sweep("piezo_stack", **BASE)  # in other boxes, whose last bits differ
    xarray.testing.assert_allclose(plain(found), plain(alone), rtol=1e-9, atol=1e-11)


OTHERS = [
    ({"duration": 2e-3}, "duration, times"),
    ({"times": 4}, "times"),
    ({"rtol": 1e-6}, "rtol"),
    ({"step": 1e-5}, "step"),
    ({"parameters": {"d": 401}}, "parameters"),
    ({"initial": {"q": 1e-6}}, "initial"),
    ({"inputs": {"F_ext": step(1e-4, 0, 1)}}, "inputs"),
    ({"inputs": {"F_ext": lambda t: 2 * t}}, "inputs"),
    ({"over": {"L": OVER["L"]}}, "over"),
    ({"over": {**OVER, "L": OVER["L"] + 1e-9}}, "over, parameters"),  # of a bank
    ({"reduce": "last"}, "reduce"),
    ({"reduce": lambda run: run.q[0]}, "reduce"),
    ({"method": "LSODA"}, "method"),
]


@pytest.mark.some(3)
@pytest.mark.parametrize(("change", "told"), OTHERS, ids=[next(iter(one)) for one, _ in OTHERS])
def test_the_store_of_another_sweep_is_refused_in_one_line(tmp_path, change, told):
    path = tmp_path / "runs.zarr"
    with pytest.raises(Interrupted):
        sweep("piezo_stack", **BASE, store=path, progress=stop_at(0))
    with pytest.raises(FileError) as raised:
        sweep("piezo_stack", **{**BASE, **change}, store=path)
    said = str(raised.value)
    rest = "; expected a store of this very sweep; choose another path, or delete it"
    assert said.endswith(f"runs.zarr': holds another sweep, which differs in {told}{rest}")
    assert "\n" not in said


def line(slope):
    return lambda t: slope * t


def test_functions_differ_by_code_and_by_what_they_hold():
    def same(a, b):
        return list(parts(a)) == list(parts(b))

    assert same(line(2), line(2))
    assert not same(line(2), line(3))
    assert not same(lambda t: t + 1, lambda t: t + 2)
    assert not same(lambda t: t.x, lambda t: t.y)
    assert not same(lambda t, a=1: a * t, lambda t, a=2: a * t)
    assert not same(lambda t, *, a=1: a * t, lambda t, *, a=2: a * t)
    assert same(samples([0, 1], [0, 2]), samples([0, 1], [0, 2]))
    assert not same(samples([0, 1], [0, 2]), samples([0, 1], [0, 3]))
    assert not same(1.0, 1)
    assert not same(np.array([1.0, 2.0]), np.array([[1.0, 2.0]]))
    assert not same(("ab", "c"), ("a", "bc"))


def test_what_is_no_store_is_refused_and_left_alone(tmp_path):
    (tmp_path / "file").write_text("mine")
    (tmp_path / "folder").mkdir()
    for name in ("file", "folder"):
        with pytest.raises(FileError, match="is no store of a sweep; choose another path"):
            sweep("piezo_stack", **BASE, store=tmp_path / name)
    assert (tmp_path / "file").read_text() == "mine"
    assert list((tmp_path / "folder").iterdir()) == []
    xarray.Dataset({"a": 1.0}).to_zarr(tmp_path / "other", consolidated=False)
    with pytest.raises(FileError, match="is no store of a sweep; choose another path"):
        sweep("piezo_stack", **BASE, store=tmp_path / "other")


def test_a_store_without_zarr_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "zarr", None)
    with pytest.raises(UsageError, match=r"zarr is not installed; run `pip install 'piezo_sym"):
        sweep("piezo_stack", **BASE, store=tmp_path / "runs.zarr")


def test_failed_runs_are_kept_with_their_reasons(tmp_path):
    path = tmp_path / "runs.zarr"
    over = {"d": [400.0, -1.0], "lam": [1.0, 2.0]}
    for _ in range(2):  # the second time nothing is run, and the warning is the same
        with pytest.warns(SweepWarning, match="2 of 4 runs failed"):
            found = sweep("piezo_stack", over=over, duration=1e-3, times=3, store=path)
        assert found.error.sel(d=-1.0).values[0].startswith("model 'piezo_stack': start is outside")
        assert np.isnan(found.q.sel(d=-1.0)).all()


def test_nothing_is_left_of_a_store_that_could_not_be_made(tmp_path):
    sweep("piezo_stack", **BASE)  # its engine is compiled
    with full_disk(), pytest.raises(FileError, match="cannot be written: File too large"):
        sweep("piezo_stack", **BASE, store=tmp_path / "runs.zarr")
    assert list(tmp_path.iterdir()) == []


class Amplitude:
    """What a method is bound to."""

    def __init__(self, size):
        self.size = size

    def wave(self, t):
        return self.size * t


FACTOR = 1.0


def scaled(t):
    return FACTOR * t


def test_methods_of_other_objects_are_other_functions(monkeypatch):
    assert list(parts(Amplitude(1.0).wave)) == list(parts(Amplitude(1.0).wave))
    assert list(parts(Amplitude(1.0).wave)) != list(parts(Amplitude(2.0).wave))
    before = list(parts(scaled))
    monkeypatch.setitem(globals(), "FACTOR", 2.0)
    assert list(parts(scaled)) != before


def test_a_function_may_call_itself():
    def rest(t):
        return rest(t - 1) if t > 1 else 0.0

    assert list(parts(rest)) == list(parts(rest))


def test_a_store_opens_without_a_warning_and_after_it_was_taken_up_again(tmp_path):
    options = {**BASE, "store": tmp_path / "runs.zarr"}
    with pytest.raises(Interrupted):
        sweep("piezo_stack", **options, progress=stop_at(70))
    with xarray.open_zarr(options["store"], chunks=None) as half:
        assert "q" in half
    found = sweep("piezo_stack", **options)
    with xarray.open_zarr(options["store"], chunks=None) as whole:
        marks = {stores.MARK, stores.BOX, stores.RESULTS}
        assert {name for name in whole.attrs if name not in found.attrs} == marks
        whole.attrs = dict(found.attrs)
        xarray.testing.assert_identical(whole.load(), found.load())


def test_a_sweep_names_the_engine_of_its_runs(tmp_path):
    over = {"L": [1e-3]}
    for more in ({}, {"store": tmp_path / "runs.zarr"}, {"method": "LSODA"}, {"reduce": "last"}):
        found = sweep("piezo_stack", over=over, duration=1e-4, times=2, **more)
        run = simulate("piezo_stack", duration=1e-4, times=2, method=more.get("method"))
        assert found.attrs["engine"] == run.attrs["engine"]


def wavering(run):
    """Give another name to the runs with a large L."""
    return {"small" if float(run.L) < 1.5e-3 else "large": run.q[-1]}


@pytest.mark.parametrize("stored", [True, False], ids=["store", "memory"])
def test_a_function_that_names_its_results_otherwise_is_refused(tmp_path, stored):
    store = {"store": tmp_path / "runs.zarr"} if stored else {}
    with pytest.raises(UsageError, match="the function gives small for one run, large for anoth"):
        sweep("piezo_stack", **BASE, reduce=wavering, **store)


def test_names_are_compared_with_what_was_stored_before(tmp_path, monkeypatch):
    options = {**BASE, "reduce": named, "store": tmp_path / "runs.zarr"}
    with pytest.raises(Interrupted):
        sweep("piezo_stack", **options, progress=stop_at(35))
    monkeypatch.setattr(sys.modules["piezo_sym.sweeps.store"], "fingerprint", lambda *_: MARK)
    monkeypatch.setitem(NAMES, "name", "other")
    mark(options["store"])
    with pytest.raises(UsageError, match="the function gives first for one run, other for another"):
        sweep("piezo_stack", **options)


MARK, NAMES = "the same", {"name": "first"}


def named(run):
    return {NAMES["name"]: run.q[-1]}


def mark(path):
    """Make a store believe that it is of this very sweep."""
    import zarr

    group = zarr.open_group(path, mode="r+", use_consolidated=False)
    group.attrs["sweep_fingerprint"] = MARK


@pytest.mark.some(1)
@pytest.mark.parametrize("values", [[1e-3, 2e-3], {"a": 1e-3, "b": (1e-3, 2e-3)}])
def test_a_stored_sweep_is_written_to_netcdf_like_one_in_memory(tmp_path, values):
    how = {"over": {"L": values}, "duration": 1e-3, "times": 3}
    stored = sweep("piezo_stack", **how, store=tmp_path / "runs")
    memory = sweep("piezo_stack", **how)
    assert stored.attrs == memory.attrs
    stored.to_netcdf(tmp_path / "stored.nc")
    memory.to_netcdf(tmp_path / "memory.nc")
    xarray.open_zarr(tmp_path / "runs").to_netcdf(tmp_path / "opened.nc")
    files = (xarray.open_dataset(tmp_path / f"{name}.nc") for name in ("stored", "memory"))
    with xarray.open_dataset(tmp_path / "opened.nc") as opened:
        one, other = files
        assert one.identical(other)
        assert opened.equals(other)
