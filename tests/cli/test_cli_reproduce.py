"""``piezo-sym reproduce``: the paper's Figure 3, and the data it is drawn from."""

import csv

import numpy as np
import pytest

A_PERIOD = 401  # samples of the last period, both ends


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    from piezo_sym.cli import run

    path = tmp_path_factory.mktemp("paper") / "figures"
    assert run(["reproduce", "--out", str(path)]) == 0
    return path


@pytest.fixture(scope="module")
def loops(folder):
    """Voltage and displacement of the last period, by temperature."""
    with (folder / "figure_3.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    names = dict.fromkeys(row["T_e"] for row in rows)
    columns = {n: [(r["V_in"], r["q"]) for r in rows if r["T_e"] == n] for n in names}
    return {float(n): np.array(c, dtype=float)[-A_PERIOD:].T for n, c in columns.items()}


def test_three_files_are_written(folder):
    assert sorted(path.name for path in folder.iterdir()) == [
        "figure_3.csv",
        "figure_3.png",
        "figure_3.svg",
    ]


def test_the_pictures_are_pictures(folder):
    assert (folder / "figure_3.png").read_bytes().startswith(b"\x89PNG\r\n")
    assert "<svg" in (folder / "figure_3.svg").read_text(encoding="utf-8")


def test_the_runs_are_those_of_the_paper(loops):
    assert list(loops) == [25.0, 30.0, 35.0, 40.0]
    for voltage, _ in loops.values():
        assert max(voltage) == pytest.approx(100)
        assert min(voltage) == pytest.approx(-100)


def test_the_loops_are_steeper_where_it_is_warmer(loops):
    def slope(loop):
        voltage, displacement = loop
        high, low = np.argmax(voltage), np.argmin(voltage)
        return (displacement[high] - displacement[low]) / (voltage[high] - voltage[low])

    slopes = [slope(loop) for loop in loops.values()]
    assert slopes == sorted(slopes)
    assert slopes[0] > 0
    assert slopes[-1] > 1.05 * slopes[0]


def test_the_displacement_lags_behind_the_voltage(loops):
    """The integral of V dq over a period is positive if q lags, zero if it follows at once."""
    areas = [np.sum((voltage[1:] + voltage[:-1]) / 2 * np.diff(q)) for voltage, q in loops.values()]
    assert min(areas) > 0


def test_a_folder_that_cannot_be_written_is_one_line(refused, tmp_path, monkeypatch):
    monkeypatch.setattr("piezo_sym.analysis.figures.DURATION", 0.01)
    (tmp_path / "file").write_text("")
    message = refused("reproduce", "--out", tmp_path / "file")
    assert message.startswith(f"'{tmp_path / 'file' / 'figure_3.png'}': cannot be written")
