"""Fixed steps are of the order that is asked for; kinks cost only what is known.

References are SciPy's Radau at 1e-13, and for case P the state that three solvers agree on.
"""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from piezo_sym import load, simulate, sine
from piezo_sym.modules import module_of
from piezo_sym.run import simulate as run
from piezo_sym.run.collocation import ORDERS

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
#: Error of case P by its step, which goes over kinks: two runs of order two, extrapolated.
TABLE = {8e-5: 3.9e-5, 4e-5: 4.1e-6, 1e-5: 1.7e-7, 2.5e-6: 1.7e-8}


def at_the_end(module, found):
    return np.hstack([found[record.name].values[-1] for record in module.STATES])


def orders(errors):
    """Return the slopes of errors whose steps are halved each time."""
    return -np.diff(np.log2(errors))


@pytest.mark.parametrize(
    ("spec", "duration", "longest", "options"),
    [
        pytest.param(*row, id=Path(row[0]).stem, marks=[pytest.mark.long] if n else [])
        for n, row in enumerate(SMOOTH)
    ],
)
def test_orders_of_smooth_systems(spec, duration, longest, options):
    model, module = load(spec), module_of(load(spec))
    options = {"duration": duration, "times": 2, **options}
    wanted = at_the_end(module, simulate(model, method="Radau", rtol=1e-13, **options))
    size = np.abs(wanted)
    for order, most, off in ((2, 4, 0.03), (4, 3, 0.2), (6, 2, 0.4)):
        found = (
            at_the_end(module, simulate(model, step=h, order=order, **options))
            for h in longest / 2.0 ** np.arange(most)
        )
        errors = [np.linalg.norm((x - wanted) / size) for x in found]
        assert np.all(np.abs(orders(errors) - order) <= off)


def test_each_order_is_nearer_than_the_one_before():
    spec, duration, _, _ = SMOOTH[1]
    model, module = load(spec), module_of(load(spec))
    options = {"duration": duration, "times": 2}
    wanted = at_the_end(module, simulate(model, rtol=1e-13, **options))
    found = (simulate(model, step=duration / 4, order=order, **options) for order in ORDERS)
    errors = [np.linalg.norm(at_the_end(module, x) - wanted) for x in found]
    assert all(more > 5 * less for more, less in pairwise(errors))


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
    assert error_of_pair(module_of("piezo_stack"), finer) <= 1.5 * TABLE[finer]
