"""Sweeps give what single runs give, over the dimensions that were asked for."""

from itertools import product
from pathlib import Path

import numpy as np
import pytest

from piezo_sym import samples, simulate, sine, spec, step, sweep

SPECS = Path(__file__).parents[1] / "networks" / "specs"
TWO_BANKS = str(SPECS / "two_banks_heat_one_body.toml")
BASE = {"duration": 0.01, "times": 21}
DRIVE = {"V_in": sine(100, 100)}


def single(model="piezo_stack", **options):
    return simulate(model, **{"method": "discrete_gradient", **BASE, **options})


def assert_member(found, run):
    """Assert that a member is a single run, to round-off: its energy comes from C, not NumPy."""
    inputs = {"F_ext", "V_in", "T_e", "V"}
    names = set(run.data_vars) - inputs
    assert names == set(found.data_vars) - {"error"} - inputs - {f"u_{name}" for name in inputs}
    for name in names:
        rounding = 1e-14 * max(1.0, float(np.abs(run.energy).max())) if "energy" in name else 1e-15
        np.testing.assert_allclose(
            found[name].values, run[name].values, rtol=1e-13, atol=rounding, err_msg=name
        )
        assert found[name].attrs == run[name].attrs, name
    assert str(found.error.values) == ""


def test_a_product_runs_every_pair():
    over = {"L": [5e-4, 1e-3, 5e-3], "lam": np.array([1.0, 2.0])}
    found = sweep("piezo_stack", over=over, inputs=DRIVE, **BASE)
    assert dict(found.sizes) == {"L": 3, "lam": 2, "time": 21, "hysteron": 2}
    assert found.q.dims == ("L", "lam", "time")
    assert found.phi.dims == ("L", "lam", "time", "hysteron")
    for one, lam in product(*over.values()):
        run = single(inputs=DRIVE, parameters={"L": one, "lam": lam})
        assert_member(found.sel(L=one, lam=lam), run)
        for state in ("q", "p", "Q_C", "phi", "S"):  # in lanes of vectors: the last bits differ
            wanted = run[state].values
            error = np.abs(found[state].sel(L=one, lam=lam).values - wanted)
            assert error.max() <= 1e-12 * np.abs(wanted).max()
    np.testing.assert_array_equal(found.V_in, run.V_in)
    assert found.L.attrs == {"units": "H", "long_name": "inductance of one hysteron"}
    assert "parameter_L" not in found.attrs
    assert found.attrs["parameter_M"] == 0.0035
    assert found.attrs["method"] == "discrete_gradient"


def test_inputs_are_labelled_by_what_the_user_gives():
    drive = {f: sine(100, f) for f in (50.0, 100.0)}
    found = sweep("piezo_stack", over={"L": [1e-3, 2e-3], "V_in": drive}, **BASE)
    assert found.q.dims == ("L", "V_in", "time")
    assert found.V_in.values.tolist() == [50.0, 100.0]
    for f, one in product(drive, (1e-3, 2e-3)):
        member = found.sel(V_in=f, L=one)
        run = single(inputs={"V_in": drive[f]}, parameters={"L": one})
        assert_member(member, run)
        np.testing.assert_array_equal(member.u_V_in, run.V_in)
    assert found.u_V_in.dims == ("V_in", "time")
    assert found.u_V_in.attrs["units"] == "V"


def double(t):
    return 2.0 * t


def test_inputs_without_labels_are_named_by_what_they_are():
    values = [sine(100, 50), 3.0, double, ([0, 0.01], [0, 5]), samples([0, 1, 2], [0, 1, 0])]
    found = sweep("piezo_stack", over={"V_in": values}, **BASE)
    texts = ["sine(100, 50, 0, 0)", "3", "double", "samples(2)", "samples(3)"]
    assert found.V_in.values.tolist() == texts
    for value, text in zip(values, texts, strict=True):
        assert_member(found.sel(V_in=text), single(inputs={"V_in": value}))
    twice = sweep("piezo_stack", over={"V_in": [double, double]}, **BASE)
    assert twice.V_in.values.tolist() == ["0: double", "1: double"]


def test_numbers_as_inputs_are_their_own_coordinates():
    found = sweep("piezo_stack", over={"T_e": [298.15, 310.0]}, inputs=DRIVE, **BASE)
    assert found.T_e.attrs["units"] == "K"
    assert_member(found.sel(T_e=310.0), single(inputs={**DRIVE, "T_e": 310.0}))


def test_a_tuple_of_names_is_one_dimension():
    points = [(1e-3, 298.15), (2e-3, 310.0), (3e-3, 305.0)]
    found = sweep("piezo_stack", over={("L", "T_e"): points, "d": [400.0, 500.0]}, **BASE)
    assert found.q.dims == ("L_T_e", "d", "time")
    assert found.L.dims == found.T_e.dims == ("L_T_e",)
    for k, (one, outside) in enumerate(points):
        run = single(inputs={"T_e": outside}, parameters={"L": one, "d": 500.0})
        assert_member(found.isel(L_T_e=k).sel(d=500.0), run)


def test_a_zip_can_be_an_array_or_have_labels():
    array = np.array([[1e-3, 300.0], [2e-3, 500.0]])
    found = sweep("piezo_stack", over={("L", "d"): array}, inputs=DRIVE, **BASE)
    named = {"soft": (1e-3, 300.0), "hard": (2e-3, 500.0)}
    other = sweep("piezo_stack", over={("L", "d"): named}, inputs=DRIVE, **BASE)
    assert other.L_d.values.tolist() == ["soft", "hard"]
    np.testing.assert_array_equal(found.q, other.q)
    run = single(inputs=DRIVE, parameters={"L": 2e-3, "d": 500.0})
    assert_member(other.sel(L_d="hard"), run)


def test_initial_values_are_swept_by_the_states_names():
    over = {"q": [0.0, 1e-4], "initial.phi": [0.0, [1e-4, 2e-4]]}
    found = sweep("piezo_stack", over=over, initial={"p": 1e-3}, **BASE)
    assert found.q.dims == ("initial_q", "initial_phi", "time")
    assert found.initial_phi.values.tolist() == ["0", "[0.0001, 0.0002]"]
    run = single(initial={"q": 1e-4, "phi": [1e-4, 2e-4], "p": 1e-3})
    assert_member(found.isel(initial_q=1, initial_phi=1), run)


def test_temperatures_at_the_start_are_swept_by_their_names():
    runs = sweep("piezo_stack", over={"T_body": [300.0, 320.0]}, inputs=DRIVE, **BASE)
    assert runs.initial_T_body.values.tolist() == [300.0, 320.0]
    assert runs.initial_T_body.attrs["units"] == "K"
    for T in (300.0, 320.0):
        found = runs.sel(initial_T_body=T)
        assert_member(found, single(initial={"T_body": T}, inputs=DRIVE))


def test_lanes_that_are_not_there_are_nan():
    over = {"hysteron_count": [1, 3], "L": [1e-3, 2e-3]}
    found = sweep("piezo_stack", over=over, inputs=DRIVE, **BASE)
    assert found.hysteron.values.tolist() == [1, 2, 3]
    assert np.isnan(found.phi.sel(hysteron_count=1, hysteron=[2, 3])).all()
    for count, one in product(*over.values()):
        member = found.sel(hysteron_count=count, L=one, hysteron=list(range(1, count + 1)))
        run = single(inputs=DRIVE, parameters={"hysteron_count": count, "L": one})
        assert_member(member, run)


def test_several_banks_and_one_value_a_lane():
    over = {("dead_count", "linear_count"): [(1, 4), (2, 2)], "C": [0.1, 0.2]}
    found = sweep(TWO_BANKS, over=over, duration=0.1, times=5)
    for k, (dead, linear) in enumerate(over["dead_count", "linear_count"]):
        sizes = {"dead_count": dead, "linear_count": linear}
        run = single(TWO_BANKS, duration=0.1, times=5, parameters={**sizes, "C": 0.2})
        lanes = {"dead": slice(1, dead), "linear": slice(1, linear)}
        assert_member(found.isel(dead_count_linear_count=k).sel(C=0.2, **lanes), run)


def test_lists_of_one_value_a_lane_go_with_their_size():
    over = {("hysteron_count", "L"): [(1, [1e-3]), (2, [1e-3, 2e-3]), (2, 5e-3)]}
    found = sweep("piezo_stack", over=over, **BASE)
    run = single(parameters={"hysteron_count": 2, "L": [1e-3, 2e-3]})
    assert_member(found.isel(hysteron_count_L=1), run)


@pytest.mark.parametrize("options", [{"step": 1e-5}, {"rtol": 1e-7}])
def test_a_step_and_a_tolerance_are_those_of_single_runs(options):
    found = sweep("piezo_stack", over={"L": [1e-3, 2e-3]}, inputs=DRIVE, **BASE, **options)
    assert_member(found.sel(L=2e-3), single(inputs=DRIVE, parameters={"L": 2e-3}, **options))
    (name,) = options
    assert found.attrs[name] == options[name]


def test_inputs_with_jumps_and_times_of_ones_own():
    drive = {"V_in": step(0.003, 0, 50)}
    times = [0.0, 0.003, 0.004, 0.01]
    found = sweep("piezo_stack", over={"d": [300, 400]}, inputs=drive, duration=0.01, times=times)
    assert_member(found.sel(d=400), single(inputs=drive, times=times))


def test_more_runs_than_go_together_stay_in_order():
    values = np.linspace(1e-3, 2e-3, 150)
    found = sweep("piezo_stack", over={"L": values}, inputs=DRIVE, duration=1e-3, times=3)
    for k in (0, 63, 64, 149):
        run = single(inputs=DRIVE, parameters={"L": values[k]}, duration=1e-3, times=3)
        assert_member(found.isel(L=k), run)


def test_netcdf_keeps_everything(tmp_path):
    import xarray

    over = {"V_in": [sine(100, 50), 3.0], "hysteron_count": [1, 2]}
    found = sweep("piezo_stack", over=over, **BASE)
    found.to_netcdf(tmp_path / "found.nc", engine="scipy")
    with xarray.open_dataset(tmp_path / "found.nc", engine="scipy") as again:
        xarray.testing.assert_equal(again.load(), found)
        assert again.attrs.keys() == found.attrs.keys()


def test_samples_are_those_of_a_single_run():
    """Also where a fixed step says when they are."""
    for more in ({"step": 1e-6}, {"times": 5}):
        found = sweep("piezo_stack", over={"L": [1e-3]}, duration=1e-4, **more)
        run = simulate("piezo_stack", duration=1e-4, **more)
        assert np.array_equal(found.time, run.time)
        assert np.array_equal(found.S[0], run.S)


STARTER = str(Path(spec.__file__).with_name("starter.toml"))


def test_lists_go_with_their_size_where_the_spec_has_a_list():
    """The starter has two hysterons, and a list of two widths."""
    lists = [(2, [1e-3, 5e-3]), (3, [1e-3, 2e-3, 3e-3]), (4, 2e-3)]
    found = sweep(STARTER, over={("hysteron_count", "i_0"): lists}, **BASE)
    for k, (count, widths) in enumerate(lists):
        run = single(STARTER, parameters={"hysteron_count": count, "i_0": widths})
        member = found.isel(hysteron_count_i_0=k)
        np.testing.assert_array_equal(member.S.values, run.S.values)
        np.testing.assert_array_equal(member.phi.values[:, :count], run.phi.values)


def test_numbers_meet_every_size_where_the_spec_has_a_list():
    over = {"hysteron_count": [2, 3], "i_0": [1e-3, 2e-3]}
    found = sweep(STARTER, over=over, **BASE)
    run = single(STARTER, parameters={"hysteron_count": 3, "i_0": 2e-3})
    np.testing.assert_array_equal(found.S.values[1, 1], run.S.values)


def test_lists_of_another_size_than_the_specs_go_with_a_size_that_is_given():
    how = {"parameters": {"hysteron_count": 3}}
    found = sweep(STARTER, over={"i_0": [[1e-3, 2e-3, 3e-3], 2e-3]}, **how, **BASE)
    run = single(STARTER, parameters={"hysteron_count": 3, "i_0": [1e-3, 2e-3, 3e-3]})
    np.testing.assert_array_equal(found.phi.values[0], run.phi.values)


def test_runs_start_at_a_temperature():
    given = {"initial": {"T_body": 320.0}, "duration": 1e-3, "times": 2}
    found = sweep("piezo_stack", over={"L": [1e-3]}, **given)
    assert found.T_body.values[0, 0] == pytest.approx(320.0)
