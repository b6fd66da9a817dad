"""Fixed steps are of order two, of four extrapolated; kinks cost only what is known.

References are SciPy's Radau at 1e-13, and for case P the state that three solvers agree on.
"""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from piezo_sym import derive, load, simulate, sine
from piezo_sym.codegen import c_header, c_source, c_step, lower, numpy_module, step_of
from piezo_sym.modules import load_module, module_of
from piezo_sym.run import simulate as run

SPECS = Path(__file__).parents[1] / "networks" / "specs"
CASE_P = {"inputs": {"V_in": sine(100, 100)}, "duration": 0.1}
SCALES = {"q": 2e-3, "p": 5e-3, "Q_C": 5e-4, "phi": 6e-3, "S": 5e-2}
ANSWER = {
    "q": -9.523507638450e-04,
    "p": 3.453828489837e-03,
    "Q_C": -3.900998920056e-05,
    "phi": 5.224415297332e-03,
    "S": 1.341141665114e-01,
}
#: Smooth systems: a closed form's heat flow, an oscillator, a law of 1/T, a transducer, and the
#: actuator without its dead zone.  (spec, duration, longest step, options)
SMOOTH = [
    (SPECS / "a1_two_bodies.toml", 4.0, 0.5, {}),
    (SPECS / "a2_oscillator.toml", 5.0, 0.1, {}),
    (SPECS / "a5_thermistor.toml", 2e-3, 2e-5, {}),
    (SPECS / "transducer_between_moving_nodes.toml", 5.0, 0.1, {}),
    ("piezo_stack", 1e-2, 4e-5, {"parameters": {"i_0": 0.0}, "inputs": {"V_in": sine(100, 100)}}),
]
#: Error of the pair of case P by its shorter step: with the mean law, and with the law of the mean.
TABLE = {8e-5: (1.1e-5, 3.9e-5), 4e-5: (2.2e-7, 4.1e-6), 1e-5: (7.6e-9, 1.7e-7)}
TABLE |= {2.5e-6: (1.0e-10, 1.7e-8)}


def at_the_end(module, found):
    return np.hstack([found[record.name].values[-1] for record in module.STATES])


def orders(errors):
    """Return the slopes of errors whose steps are halved each time."""
    return -np.diff(np.log2(errors))


@pytest.mark.parametrize(
    ("spec", "duration", "longest", "options"), SMOOTH, ids=[Path(row[0]).stem for row in SMOOTH]
)
def test_orders_of_smooth_systems(spec, duration, longest, options):
    model, module = load(spec), module_of(load(spec))
    options = {"duration": duration, "times": 2, **options}
    wanted = at_the_end(module, simulate(model, method="Radau", rtol=1e-13, **options))
    ends = [
        at_the_end(module, simulate(model, method="discrete_gradient", step=h, **options))
        for h in longest / 2.0 ** np.arange(-1, 4)
    ]
    size = np.abs(wanted)
    plain = [np.linalg.norm((x - wanted) / size) for x in ends[1:]]
    pairs = [np.linalg.norm((b + (b - a) / 3 - wanted) / size) for a, b in pairwise(ends)]
    assert np.all(np.abs(orders(plain) - 2) <= 0.03)
    assert np.all(np.abs(orders(pairs) - 4) <= 0.12)


def error_of_pair(module, finer):
    """Return the scaled error of two runs of case P, extrapolated."""
    runs = [
        run(module, method="discrete_gradient", step=n * finer, times=2, **CASE_P) for n in (2, 1)
    ]
    worst = 0.0
    for name, wanted in ANSWER.items():
        coarse, fine = (found[name].values[-1] for found in runs)
        worst = max(worst, np.max(np.abs(fine + (fine - coarse) / 3 - wanted)) / SCALES[name])
    return worst


@pytest.mark.parametrize("finer", TABLE)
def test_kinks_cost_what_is_known(finer):
    assert error_of_pair(module_of("piezo_stack"), finer) <= 1.5 * TABLE[finer][0]


@pytest.fixture(scope="module")
def without_means(tmp_path_factory):
    """The actuator with a step that takes each law at the mean current."""
    folder, iphs = tmp_path_factory.mktemp("without"), derive(load("piezo_stack"))
    program = lower(iphs, "verdict")
    step, declared = c_step(program, step_of(iphs, frozenset()))
    texts = {".py": numpy_module(program), ".h": c_header(program, declared)}
    for ending, text in {**texts, ".c": c_source(program, step)}.items():
        (folder / f"piezo_stack{ending}").write_text(text, encoding="utf-8")
    return load_module(folder / "piezo_stack.py")


@pytest.mark.parametrize("finer", TABLE)
def test_the_mean_law_is_what_makes_kinks_cheap(without_means, finer):
    known, rough = TABLE[finer]
    error = error_of_pair(without_means, finer)
    assert rough / 1.5 <= error <= 1.5 * rough
    assert error >= 2 * known
