"""The dashboard of a run: a panel for every unit and the ledger, for any model."""

import numpy as np
import pytest
import xarray
from matplotlib.collections import LineCollection

from piezo_sym import plot, simulate, sine, sweep
from piezo_sym.errors import UsageError
from piezo_sym.sweeps import SweepWarning

SPECS = "tests/networks/specs"
COLUMNS = """
[model]
name = "massless_of_heat"
[parameters]
L = { value = 1.0, unit = "H" }
C = { value = 1.0, unit = "F" }
[initial]
Q = 1.0
[elements]
coil = { kind = "inductor", between = ["a", "gnd"], inductance = "L", state = "phi" }
cap  = { kind = "capacitor", between = ["a", "gnd"], capacitance = "C", state = "Q" }
"""


def labels(figure):
    return [axes.get_ylabel() for axes in figure.axes]


def actuator(**changed):
    options = {"duration": 0.02, "rtol": 1e-5, "method": "discrete_gradient", **changed}
    return simulate("piezo_stack", inputs={"V_in": sine(100, 100)}, **options)


def panel(figure, start):
    return next(axes for axes in figure.axes if axes.get_ylabel().startswith(start))


def names(axes):
    return [text.get_text() for text in axes.get_legend().get_texts()]


def test_every_quantity_has_its_panel():
    run = actuator()
    figure = plot(run)
    assert labels(figure) == [
        "q [m]",
        "p [kg*m/s]",
        "Q_C [C]",
        "phi [Wb]",
        "S [J/K]",
        "V_in [V]",
        "T_e, T_body [K]",
        "y_load [m/s]",
        "y_supply [A]",
        "energy [J]",
        "heat released [J]",
        "entropy produced [J/K]",
        "energy put in [J]",
        "energy put in [J]",
        "energy residual [J]",
    ]
    assert [names(axes) for axes in figure.axes[-3:-1]] == [["supply"], ["ambient"]]


def test_energy_and_entropy_are_drawn_and_the_entropy_of_one_body_once():
    figure = plot(simulate("heat_exchanger", duration=1.0, times=11))
    assert {"S_hot, S_cold, entropy\n[J/K]", "energy [J]"} <= {*labels(figure)}
    assert names(panel(figure, "S_hot")) == ["S_hot", "S_cold", "entropy"]
    assert "S [J/K]" in labels(plot(actuator(times=11)))


def test_heat_between_bodies_is_not_released_and_not_stacked():
    run = simulate("heat_exchanger", duration=1.0, initial={"T_hot": 250.0}, times=11)
    assert float(run.heat_contact[-1]) < 0
    assert run.heat_contact.attrs["long_name"] == (
        "heat conducted by 'contact' from its first body to its second since t = 0"
    )
    figure = plot(run)
    assert "heat released [J]" not in labels(figure)
    (line,) = panel(figure, "heat conducted").lines
    assert line.get_ydata()[-1] == run.heat_contact[-1]


@pytest.mark.long
def test_time_is_named_once_and_its_numbers_stand_under_every_column():
    figure = plot(actuator())
    assert figure.get_supxlabel() == "time [s]"
    assert {axes.get_xlabel() for axes in figure.axes} == {""}
    figure.draw_without_rendering()
    numbered = [any(t.get_visible() for t in axes.get_xticklabels()) for axes in figure.axes]
    assert numbered == [False] * 12 + [True] * 3


def test_quantities_of_very_different_sizes_have_panels_of_their_own():
    figure = plot(actuator(times=11, outputs=["spring", "body"]))
    assert {"energy, body.energy [J]", "spring.energy [J]"} <= {*labels(figure)}
    run = actuator(times=11)
    figure = plot(run.assign(q_1=run.q / 99, q_2=run.q / 101))
    assert {"q, q_1 [m]", "q_2 [m]"} <= {*labels(figure)}
    figure = plot(actuator(times=11, outputs=["spring", "body"]))
    assert "T_e, T_body, body.effort\n[K]" in labels(figure)


def test_what_is_zero_all_the_time_has_no_panel():
    run = actuator(times=11)
    assert "F_ext [N]" not in labels(plot(run))
    assert "F_ext [N]" in labels(plot(run.assign(F_ext=run.F_ext + 1e-9)))


def test_times_of_events_are_marked_in_every_panel_and_named_once():
    figure = plot(actuator(times=11, events={"up": "q - 1e-4", "hot": "T_body - 298.2"}))
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["up", "hot"]
    for axes in figure.axes:
        up, hot = (lines for lines in axes.collections if isinstance(lines, LineCollection))
        assert (len(up.get_segments()), len(hot.get_segments())) == (4, 1)
    for watched in ({}, {"events": {"never": "q - 1"}}):
        assert not plot(actuator(times=11, **watched)).legends


def test_curves_are_the_run():
    run = actuator()
    figure = plot(run)
    (line,) = panel(figure, "q").lines
    assert np.array_equal(line.get_ydata(), run.q.values)
    assert len(panel(figure, "phi").lines) == 2
    (residual,) = panel(figure, "energy residual").lines
    assert np.array_equal(residual.get_ydata(), run.energy_residual.values)


@pytest.mark.parametrize(("start", "prefix"), [("heat", "heat_"), ("entropy p", "produced_")])
def test_the_ledger_is_stacked_by_process(start, prefix):
    run = actuator()
    areas = panel(plot(run), start).collections
    tops = [area.get_paths()[0].vertices[:, 1].max() for area in areas]
    bank, damper = run[f"{prefix}hysteron"].sum("hysteron"), run[f"{prefix}damper"]
    assert tops == pytest.approx([float(bank.max()), float((bank + damper).max())])


@pytest.mark.long
def test_many_lanes_are_drawn_as_the_range_they_fill():
    run = actuator(parameters={"hysteron_count": 64, "i_0": [0.02 * n for n in range(64)]})
    axes = panel(plot(run), "phi")
    assert len(axes.lines) == 1
    assert np.allclose(axes.lines[0].get_ydata(), run.phi.mean("hysteron"))
    (filled,) = axes.collections
    assert filled.get_paths()[0].vertices[:, 1].max() == pytest.approx(float(run.phi.max()))


@pytest.mark.parametrize(("lanes", "lines", "bands"), [(8, 8, 0), (9, 1, 1)])
def test_a_bank_of_more_than_eight_lanes_is_a_band(lanes, lines, bands):
    axes = panel(plot(actuator(parameters={"hysteron_count": lanes}, times=11)), "phi")
    assert (len(axes.lines), len(axes.collections)) == (lines, bands)
    band = ["phi: mean and range"]
    assert names(axes) == (band if bands else [f"phi_{n + 1}" for n in range(lanes)])


def test_every_curve_has_a_name_and_a_look_of_its_own():
    run = actuator(times=11)
    bodies = {f"T_{n}": run.T_body + n for n in range(20)}
    heats = {f"heat_{n}": run.heat_damper for n in range(20)}
    figure = plot(run.assign({**bodies, **heats}))
    axes = panel(figure, "T_e, T_body")
    assert names(axes) == ["T_e", "T_body", *bodies]
    assert len({(line.get_color(), str(line._dash_pattern)) for line in axes.lines}) == 22
    axes = panel(figure, "heat")
    assert len(names(axes)) == 22
    areas = {(str(area.get_facecolor()), area.get_hatch()) for area in axes.collections}
    assert len(areas) == 22


@pytest.mark.long
@pytest.mark.parametrize("lanes", [2, 8])
def test_a_legend_covers_no_curve(lanes):
    figure = plot(actuator(parameters={"hysteron_count": lanes}, times=11))
    figure.draw_without_rendering()
    found = [axes for axes in figure.axes if axes.get_legend()]
    assert len(found) == 6
    for axes in found:
        legend, own = axes.get_legend().get_window_extent(), axes.get_window_extent()
        assert legend.y0 >= own.y1
        assert legend.x1 <= own.x1 + 1
        assert not any(
            legend.overlaps(other.get_tightbbox()) for other in figure.axes if other is not axes
        )


@pytest.mark.parametrize("length", [3, 6, 18, 42])
def test_a_legend_stands_beside_or_above_the_power_of_ten(length):
    run = actuator(times=11)
    run = run.drop_vars(set(run.data_vars) - {"q", "energy_residual"})
    figure = plot(run.assign({f"{(length - 1) * 'm'}{n}": run.q for n in "abcd"}))
    figure.draw_without_rendering()
    axes = panel(figure, "q")
    power = axes.yaxis.get_offset_text()
    assert power.get_text()
    assert not axes.get_legend().get_window_extent().overlaps(power.get_window_extent())


@pytest.mark.parametrize(("noise", "constant"), [(1e-13, True), (1e-8, True), (1e-7, False)])
def test_what_varies_by_round_off_is_drawn_as_constant(noise, constant):
    run = actuator(times=11)
    drive = 60 + noise * np.cos(np.arange(11))
    axes = panel(plot(run.assign(V_in=("time", drive, run.V_in.attrs))), "V_in")
    low, high = axes.get_ylim()
    assert (low < 58 < 62 < high) == constant
    assert low < drive.min() < drive.max() < high


@pytest.mark.long
def test_the_name_of_an_axis_is_no_longer_than_its_panel():
    figure = plot(actuator(times=11, outputs="all"))
    assert "V_in, ... [V]" in labels(figure)
    assert "y_load, spring.flow, ...\n[m/s]" in labels(figure)
    figure.draw_without_rendering()
    for axes in figure.axes:
        named = axes.yaxis.label.get_window_extent()
        assert named.height <= 1.25 * axes.get_window_extent().height


def test_the_only_curve_of_a_panel_is_named_once():
    figure = plot(actuator(times=11))
    assert panel(figure, "q").get_legend() is None
    assert panel(figure, "energy residual").get_legend() is None
    alone = plot(actuator(times=11).drop_vars("heat_hysteron"))
    assert names(panel(alone, "heat released")) == ["damper"]


@pytest.mark.long
def test_numbers_of_axes_have_no_offset():
    run = actuator(times=11, t0=1000.0)
    figure = plot(run.assign(T_body=298.15 + 1e-6 * run.time))
    figure.draw_without_rendering()
    for axes in figure.axes:
        offsets = axes.xaxis.get_offset_text().get_text(), axes.yaxis.get_offset_text().get_text()
        assert not any("+" in text for text in offsets)
    numbers = [text.get_text() for text in figure.axes[-1].get_xticklabels()]
    assert all(999.9 < float(number) < 1000.1 for number in numbers)


@pytest.mark.long
def test_several_bodies():
    figure = plot(simulate(f"{SPECS}/a1_two_bodies.toml", duration=5))
    assert len(panel(figure, "T_hot, T_cold").lines) == 2
    assert names(panel(figure, "T_hot")) == ["T_hot", "T_cold"]


@pytest.mark.long
def test_a_model_without_heat_has_no_panel_for_it(module):
    from piezo_sym.run import simulate as run_module

    figure = plot(run_module(module(COLUMNS), duration=5.0))
    assert labels(figure) == ["phi [Wb]", "Q [C]", "energy [J]", "energy residual [J]"]


def test_one_sample_is_points():
    figure = plot(actuator(times=[0.01]))
    assert all(line.get_marker() == "." for axes in figure.axes for line in axes.lines)
    assert len(panel(figure, "heat").lines) == 2


@pytest.mark.parametrize(("start", "prefix"), [("heat", "heat_"), ("entropy p", "produced_")])
def test_points_of_the_ledger_are_not_stacked(start, prefix):
    run = actuator(times=11).isel(time=[-1])
    drawn = {line.get_label(): line.get_ydata()[0] for line in panel(plot(run), start).lines}
    assert drawn["damper"] == run[f"{prefix}damper"][0]
    assert drawn["hysteron"] == pytest.approx(float(run[f"{prefix}hysteron"].sum()))


def test_few_samples_are_marked():
    assert {line.get_marker() for line in panel(plot(actuator(times=3)), "q").lines} == {"."}
    assert {line.get_marker() for line in panel(plot(actuator()), "q").lines} == {""}


def test_what_is_zero_all_the_time_is_not_stacked():
    assert "heat released [J]" not in labels(plot(simulate("piezo_stack", duration=1e-3)))


def test_a_run_without_samples_is_refused():
    with pytest.raises(UsageError, match=r"^plot.run: this run has no samples; expected one"):
        plot(actuator(times=3).isel(time=slice(0, 0)))


def test_it_can_be_saved(tmp_path):
    plot(actuator(times=11)).savefig(tmp_path / "run.png")
    assert (tmp_path / "run.png").stat().st_size > 10_000


@pytest.mark.parametrize("thing", [xarray.Dataset(), None, {"q": 1}, np.zeros(3)])
def test_what_is_no_run_is_refused(thing):
    with pytest.raises(UsageError, match=r"is no run; expected a Dataset that simulate\(\)"):
        plot(thing)


@pytest.fixture(scope="module")
def runs():
    """Four runs of a sweep; one fails at its start."""
    over = {"V_in": {100.0: sine(100, 100), 50.0: sine(50, 100)}, "L": [1e-3, -1.0]}
    with pytest.warns(SweepWarning):
        return sweep("piezo_stack", over=over, duration=0.005, times=11)


def test_one_run_of_a_sweep_is_drawn_like_any_other(runs):
    drawn = labels(plot(runs.isel(V_in=0, L=0)))
    alone = labels(plot(actuator(duration=0.005, times=11)))
    renamed = {"V_in [V]": "u_V_in [V]", "T_e, T_body [K]": "T_body, T_e [K]"}
    assert sorted(drawn) == sorted(renamed.get(label, label) for label in alone)


@pytest.mark.parametrize(
    ("chosen", "said"),
    [
        ({}, r"this is a sweep over V_in, L; .* plot\(runs.isel\(V_in=0, L=0\)\)"),
        ({"V_in": 0}, r"this is a sweep over L; .* plot\(runs.isel\(L=0\)\)"),
        ({"V_in": 0, "L": 1}, "this run failed: model 'piezo_stack': start is outside"),
        ({"V_in": 0, "L": 0, "time": 0}, r"has no time; .* plot\(run.isel\(time=\[-1\]\)\)"),
    ],
)
def test_many_runs_a_failed_one_and_one_without_time_are_refused(runs, chosen, said):
    with pytest.raises(UsageError, match=said) as error:
        plot(runs.isel(chosen))
    assert str(error.value).isprintable()


def test_a_reduced_sweep_is_refused():
    found = sweep("piezo_stack", over={"L": [1e-3]}, duration=0.005, reduce="last").isel(L=0)
    with pytest.raises(UsageError, match=r"has no time; .* if 'reduce' is left out"):
        plot(found)
