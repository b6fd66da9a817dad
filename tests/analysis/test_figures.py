"""How the figures look: legible, nothing on top of a curve, the same bytes in every run."""

import numpy as np
import pytest

from piezo_sym.analysis import style
from piezo_sym.analysis.figures import FIGURES, data_of, figure_4

QUICK = [figure for figure in FIGURES if figure.name != "figure_4"]


def one_jump(fold=60.0):
    """Steady states as `figure_4.curve` returns them: a fold [Hz], which leads off the axes."""
    import xarray

    columns = {
        "curve": [0, 0, 0, 1, 1],
        "frequency": [10.0, fold, 20, 100, 1000],
        "temperature": [300.0, 500, 3000, 3000, 600],
        "coldest": [300.0, 500, 3000, 3000, 600],
        "hottest": [300.0, 500, 3000, 3000, 600],
        "stable": [1.0, 1, 0, 1, 1],
        "jumps_to": [np.nan, np.inf, np.nan, np.nan, np.nan],
    }
    data = {name: ("point", np.array(values, dtype=float)) for name, values in columns.items()}
    return xarray.Dataset(data, {"point": np.arange(5)})


@pytest.fixture(scope="module", params=FIGURES, ids=lambda figure: figure.name)
def drawn(request, stack):
    figure = request.param
    if figure in QUICK:
        data = data_of(figure, stack)
    else:
        data = figure.joined([one_jump()] * len(figure.values))
    return figure, data, figure.draw(data)


def test_it_fits_a_column_and_can_be_read_there(drawn):
    _, _, picture = drawn
    width, height = picture.get_size_inches()
    assert width == 3.5
    assert 2 < height < 4
    texts = picture.findobj(lambda artist: hasattr(artist, "get_fontsize") and artist.get_text())
    assert min(text.get_fontsize() for text in texts) >= 6


def test_axes_have_names_and_units(drawn):
    _, _, picture = drawn
    (axes,) = picture.axes
    for label in (axes.get_xlabel(), axes.get_ylabel()):
        assert label.endswith("]")
        assert "[" in label


def test_every_curve_is_in_the_legend(drawn):
    figure, _, picture = drawn
    (axes,) = picture.axes
    texts = [text.get_text() for text in axes.get_legend().get_texts()]
    assert len(texts) == len(set(texts)) == len(figure.values)


def test_curves_differ_in_colour_and_without_it_in_dashes_or_marks(drawn):
    figure, _, picture = drawn
    (axes,) = picture.axes
    named = [line for line in axes.lines if not line.get_label().startswith("_")]
    assert len({line.get_color() for line in named}) == len(figure.values)
    if figure in QUICK:
        assert len({str(line._dash_pattern) for line in named}) >= 3
    else:
        assert len({line.get_marker() for line in named}) == len(figure.values)


def test_the_legend_and_texts_cover_no_curve(drawn):
    figure, _, picture = drawn
    (axes,) = picture.axes
    picture.draw_without_rendering()
    boxes = [
        axes.get_legend().get_window_extent(),
        *(t.get_window_extent() for t in axes.texts if t.get_text()),
    ]
    if figure is figure_4.FIGURE_4:  # its curves are made up here
        return
    for line in axes.lines:
        points = line.get_transform().transform(np.array(line.get_xydata(), dtype=float))
        for box in boxes:
            inside = (points > box.min) & (points < box.max)
            assert not np.any(inside.all(axis=1)), line.get_label()


@pytest.mark.some(1)
def test_files_are_the_same_in_every_run(drawn, tmp_path):
    figure, data, _ = drawn
    paths = [style.save(figure.draw(data), data, tmp_path / n, figure.name) for n in ("a", "b")]
    for first, second in zip(*paths, strict=True):
        assert first.read_bytes() == second.read_bytes()
    svg = paths[0][1].read_text(encoding="utf-8")
    assert "<svg" in svg
    assert "<dc:date>" not in svg


def test_figure_4_draws_stable_states_solid_and_jumps(drawn):
    figure, _, picture = drawn
    if figure is not figure_4.FIGURE_4:
        assert not picture.axes[0].texts
        return
    (axes,) = picture.axes
    arrows = [text for text in axes.texts if not text.get_text()]
    assert len(arrows) == len(figure.values)
    solid = axes.lines[0].get_ydata()
    assert np.isfinite(solid).tolist() == [True, True, False]
    dotted = axes.lines[1].get_ydata()
    assert np.isfinite(dotted).tolist() == [False, True, True]


def test_the_folds_of_figure_4_stand_apart():
    figure = figure_4.FIGURE_4
    folds = [71.44, 69.40, 67.29, 57.55]  # Hz; tests/cli/test_cli_reproduce.py finds them
    (axes,) = figure.draw(figure.joined([one_jump(fold) for fold in folds])).axes
    axes.figure.draw_without_rendering()
    apart = []
    for drawn in (axes, *axes.child_axes):
        points = drawn.transData.transform([(fold, 500 - figure_4.T_E) for fold in folds])
        gaps = -np.diff(points[:, 0]) * 72 / axes.figure.dpi
        apart.append(gaps.min() if drawn.bbox.contains(*points[0]) else 0)
    assert max(apart) > 6  # points; a mark is 3 wide
