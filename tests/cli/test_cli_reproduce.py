"""``piezo-sym reproduce``: the paper's Figures 2 to 6, and the data they are drawn from."""

import csv
from dataclasses import replace

import numpy as np
import pytest

from piezo_sym.analysis import figures

A_PERIOD = 401  # samples of the last period, both ends
NAMES = [f"figure_{n}" for n in range(2, 7)]
#: Of Figure 4, by inductance [mH]: the frequency of the fold [Hz], and where long runs at 100 Hz
#: end [K] (ACCEPTANCE, case P).
FOLDS = {0.1: 71.44, 0.5: 69.40, 1.0: 67.29, 5.0: 57.55}
HOT = {1.0: 2722, 5.0: 1066.8}


@pytest.fixture(scope="module", params=["one", pytest.param("all", marks=pytest.mark.long)])
def folder(request, tmp_path_factory):
    """The figures as users get them; in the fast tier with one of the four curves of Figure 4."""
    from piezo_sym.cli import run

    path = tmp_path_factory.mktemp("paper") / "figures"
    with pytest.MonkeyPatch.context() as patch:
        if request.param == "one":
            few = {"figure_4": {"values": (1.0,)}}
            drawn = tuple(replace(one, **few.get(one.name, {})) for one in figures.FIGURES)
            patch.setattr(figures, "FIGURES", drawn)
        assert run(["reproduce", "--out", str(path)]) == 0
    return path


def columns(path, over):
    """Rows of numbers by the value in one column, as a dict of arrays; empty cells are nan."""
    with path.open(newline="") as file:
        head, *body = csv.reader(file)
    names = [name.partition(" [")[0] for name in head]
    rows = [dict(zip(names, line, strict=True)) for line in body]
    found = {}
    for value in dict.fromkeys(row[over] for row in rows):
        own = [row for row in rows if row[over] == value]
        found[float(value)] = {
            name: np.array([float(row[name] or "nan") for row in own]) for name in own[0]
        }
    return found


def loops(path, over):
    """Voltage and displacement of the last period, by the value in one column."""
    tables = columns(path, over).items()
    return {value: (t["V_in"][-A_PERIOD:], t["q"][-A_PERIOD:]) for value, t in tables}


@pytest.fixture(scope="module")
def steady(folder):
    """The steady states of Figure 4, by inductance [mH]."""
    return columns(folder / "figure_4.csv", "L")


def test_fifteen_files_are_written(folder):
    names = {f"{name}.{ending}" for name in NAMES for ending in ("csv", "png", "svg")}
    assert {path.name for path in folder.iterdir()} == names


@pytest.mark.parametrize(
    ("name", "head"),
    [
        ("figure_2", "T [degC],i [A],w_T [V]"),
        ("figure_3", "T_e [degC],time [s],V_in [V],q [m],T_body [K]"),
        (
            "figure_4",
            "L [mH],point,curve,frequency [Hz],temperature [K],coldest [K],hottest [K],"
            "stable,jumps_to [K]",
        ),
        ("figure_5", "T_e [degC],time [s],V_in [V],q [m],T_body [K]"),
        ("figure_6", "frequency [Hz],turn,V_in [V],q [m],T_body [K]"),
    ],
)
def test_a_table_says_in_which_units_it_is(folder, name, head):
    assert (folder / f"{name}.csv").read_text(encoding="utf-8").splitlines()[0] == head


@pytest.mark.parametrize("name", NAMES)
def test_the_pictures_are_pictures(folder, name):
    assert (folder / f"{name}.png").read_bytes().startswith(b"\x89PNG\r\n")
    assert "<svg" in (folder / f"{name}.svg").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("name", "over", "values"),
    [
        ("figure_3", "T_e", [25.0, 30.0, 35.0, 40.0]),
        ("figure_6", "frequency", [10.0, 50.0, 100.0, 200.0]),
    ],
)
def test_the_loops_are_those_of_the_paper(folder, name, over, values):
    found = loops(folder / f"{name}.csv", over)
    assert list(found) == values
    for voltage, displacement in found.values():
        assert max(voltage) == pytest.approx(100)
        assert min(voltage) == pytest.approx(-100)
        assert np.sum((voltage[1:] + voltage[:-1]) / 2 * np.diff(displacement)) > 0  # it lags


def test_the_loops_are_steeper_where_it_is_warmer(folder):
    def slope(loop):
        voltage, displacement = loop
        high, low = np.argmax(voltage), np.argmin(voltage)
        return (displacement[high] - displacement[low]) / (voltage[high] - voltage[low])

    slopes = [slope(loop) for loop in loops(folder / "figure_3.csv", "T_e").values()]
    assert slopes == sorted(slopes)
    assert slopes[0] > 0
    assert slopes[-1] > 1.05 * slopes[0]


def test_the_operator_is_dead_in_the_middle_and_flatter_where_it_is_warmer(folder):
    for celsius, table in columns(folder / "figure_2.csv", "T").items():
        i, w = table["i"], table["w_T"]
        assert np.all(w[np.abs(i) < 0.5] == 0)
        assert w[-1] == pytest.approx(10 / (celsius - 23) * 1.5)


def test_the_step_ends_where_the_temperature_says(folder):
    for celsius, table in columns(folder / "figure_5.csv", "T_e").items():
        static = 100 * 10 * (celsius + 273.15) / (296.15 * 5e5)
        assert table["q"][0] == pytest.approx(static / 2, rel=1e-9)
        assert table["q"][-1] == pytest.approx(static, rel=3e-4)


def test_figure_4_has_four_inductances():
    (values,) = (figure.values for figure in figures.FIGURES if figure.name == "figure_4")
    assert values == tuple(FOLDS)


def test_the_temperature_rises_up_to_a_frequency_that_the_inductance_sets(steady):
    assert list(steady) in ([1.0], list(FOLDS))
    for millihenry, table in steady.items():
        cool = (table["curve"] == 0) & (table["stable"] == 1)
        assert np.all(np.diff(table["temperature"][cool]) > 0)
        assert table["temperature"][cool][0] == pytest.approx(299.85, abs=0.02)
        (fold,) = np.flatnonzero(~np.isnan(table["jumps_to"]))
        assert table["frequency"][fold] == pytest.approx(FOLDS[millihenry], abs=0.02)


def test_the_hot_branch_is_where_long_runs_end(steady):
    for millihenry in steady.keys() & HOT.keys():
        table = steady[millihenry]
        hot = (table["curve"] == 1) & (table["stable"] == 1)
        order = np.argsort(table["frequency"][hot])
        f, T = (np.log(table[name][hot][order]) for name in ("frequency", "temperature"))
        found = np.exp(np.interp(np.log(100), f, T))
        assert found == pytest.approx(HOT[millihenry], rel=3e-3)


def test_a_folder_that_cannot_be_written_is_one_line(refused, tmp_path):
    (tmp_path / "file").write_text("")
    message = refused("reproduce", "--out", tmp_path / "file")
    assert message.startswith(f"'{tmp_path / 'file' / 'figure_2.png'}': cannot be written")


def test_progress_goes_to_a_terminal_alone(capsys):
    from piezo_sym.progress import tracked

    assert list(tracked([1, 2, 3], "curves")) == [1, 2, 3]
    assert capsys.readouterr() == ("", "")
