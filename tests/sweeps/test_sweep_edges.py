"""Near the edge of the domain a sweep gives states, as a single run does."""

from pathlib import Path

import numpy as np

from piezo_sym import sine, sweep
from piezo_sym.modules import module_of
from piezo_sym.run.adaptive import adaptive
from piezo_sym.run.engine.engine import engine_of
from piezo_sym.run.inputs import read_inputs
from piezo_sym.run.parameters import read_initial, read_parameters
from piezo_sym.run.system import System
from piezo_sym.sweeps.quantities import of_runs

SPECS = Path(__file__).parents[1] / "networks" / "specs"
TIMES = np.linspace(0, 1e-3, 4)


def test_where_extrapolation_crosses_the_edge_the_finest_run_is_given():
    module = module_of("piezo_stack")
    engine = engine_of(module)
    system = System(module, read_parameters(module, None), read_inputs(module, None, TIMES[-1]))
    u = system.inputs.segments[0].at(0.0)
    x = np.tile(read_initial(module, system.parameters, u, None), (3, 1))
    runs = adaptive([system] * 3, engine, x, TIMES, 1e-5)
    states = runs.batch.states.copy()
    runs.batch.states[1, 2, -1] = -1e-9  # S < 0 is T < T_0
    runs.batch.states[2, 1, 0] = np.nan
    inputs = np.tile(u[:, None], TIMES.size)
    found = of_runs(runs, engine, inputs, slice(None))
    assert found["S"][1, 2] == runs.batch.fine[1, 2, -1]
    assert found["T_body"][1, 2] > 296.15
    assert found["q"][2, 1] == runs.batch.fine[2, 1, 0]
    assert np.array_equal(found["S"][0], states[0, :, -1])


def test_members_that_wait_at_different_intervals_are_cut_each_at_its_own():
    """Who came through an interval that is cut for its many steps waits there no more."""
    options = {"inputs": {"w": sine(1e5, 300.0)}, "duration": 2e-2, "rtol": 1e-8, "times": 7}
    stiff = [1.750439111200299e-07, 6.033109374234601e-05, 6.151464810203631e-07, 2.8e-4, 2.2e-4]
    found = sweep(SPECS / "a10_maxwell_slip.toml", over={"b": stiff}, threads=1, **options)
    assert found.error.values.tolist() == [""] * 5
    alone = sweep(SPECS / "a10_maxwell_slip.toml", over={"b": stiff[1:2]}, threads=1, **options)
    np.testing.assert_allclose(found.T_body[1], alone.T_body[0], rtol=1e-9)
