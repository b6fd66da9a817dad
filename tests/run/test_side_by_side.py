"""Members in lanes of vectors run as they do one by one, whatever the network."""

import os
import shutil
from pathlib import Path

import numpy as np
import pytest

from piezo_sym import load, sine, sweep
from piezo_sym.modules import module_of
from piezo_sym.run.collocation import FixedStep, collocate
from piezo_sym.run.engine.engine import engine_of
from piezo_sym.run.engine.library import Sources, library, read_source
from piezo_sym.run.inputs import read_inputs
from piezo_sym.run.parameters import read_initial, read_parameters
from piezo_sym.run.system import DrivenModule
from piezo_sym.spec.load import parse
from tests.conftest import write_script

SPECS = sorted((Path(__file__).parents[1] / "networks" / "specs").glob("*.toml"))


class Members:
    """Members of one model that differ in one parameter, more than the lanes of any vector."""

    def __init__(self, model, size=11, duration=1e-3, inputs=None, times=5):
        self.module = module_of(model)
        self.engine = engine_of(self.module)
        fields = self.module.PARAMETERS
        self.inputs = read_inputs(self.module, inputs, duration)
        self.times = np.linspace(0, duration, times)
        factors = np.linspace(0.9, 1.1, size)
        name = next(
            (f.name for f in fields if f.name in {"L", "L_1", "m", "M", "k", "c", "C"}), None
        )
        usual = read_parameters(self.module, None)
        self.systems = []
        for factor in factors if name else ():
            value = np.asarray(getattr(usual, name)) * factor
            changed = {name: value.tolist() if value.ndim else float(value)}
            parameters = read_parameters(self.module, changed)
            self.systems.append(DrivenModule(self.module, parameters, self.inputs))
        self.systems = self.systems or [DrivenModule(self.module, usual, self.inputs)] * size
        u = self.inputs.segments[0].at(0.0)
        self.x = np.array([read_initial(self.module, s.parameters, u, None) for s in self.systems])

    def run(self, *, together=True, rtol=None, stages=None, **step):
        accuracy = rtol or FixedStep(**step)
        given = self.systems, self.engine, self.x, self.times, accuracy
        return collocate(*given, stages=stages, side_by_side=together)


@pytest.mark.some(2)
@pytest.mark.parametrize("path", SPECS, ids=lambda path: path.stem)
@pytest.mark.parametrize("how", [{"rtol": 1e-6}, {"length": 1e-5}], ids=["rtol", "step"])
def test_lanes_compute_what_members_alone_do(path, how):
    members = Members(load(path))
    alone, together = (members.run(together=on, **how) for on in (False, True))
    assert alone.errors == together.errors == (None,) * len(members.systems)
    for name in ("states", "sums"):
        assert np.array_equal(getattr(alone, name), getattr(together, name))
    assert together.work[:, 1].min() > 0


def test_both_balances_of_every_member_close():
    members = Members("piezo_stack", 37, 0.05, {"V_in": sine(100, 100)})
    runs = members.run(rtol=1e-5)
    module = members.module
    for k, system in enumerate(members.systems):
        states, sums = runs.states[k].T, runs.sums[k]
        energy, supplied = module.energy(states, system.parameters), sums[:, :3].sum(axis=1)
        assert np.max(np.abs(energy - energy[0] - supplied)) <= 4 * np.spacing(energy.max()) + 1e-12
        entropy = module.entropy(states, system.parameters)
        assert np.allclose(entropy - entropy[0], sums[:, 6:].sum(axis=1), rtol=0, atol=1e-15)
        assert np.all(np.diff(sums[:, 6:9], axis=0) >= 0)


def test_production_of_members_never_falls_between_close_samples():
    members = Members("piezo_stack", 9, 0.02, {"V_in": sine(100, 100)}, times=10_001)
    alone, together = (members.run(together=on, rtol=1e-3) for on in (False, True))
    assert np.array_equal(alone.states, together.states)
    assert np.array_equal(alone.sums, together.sums)
    assert np.all(np.diff(together.sums[:, :, 3:9], axis=1) >= 0)


def test_a_member_that_stops_leaves_the_others_alone():
    members = Members("piezo_stack", 9, 0.02, {"V_in": sine(100, 100)})
    alone = members.run(rtol=1e-5)
    members.x[4, 2] = np.nan
    runs = members.run(rtol=1e-5)
    assert [error is not None for error in runs.errors] == [k == 4 for k in range(9)]
    others = [k for k in range(9) if k != 4]
    assert np.array_equal(alone.states[others], runs.states[others])


QUADRATIC = """
[model]
name = "quadratic"
title = "A mass on a spring, with a drag that has a kink"
[parameters]
m = { value = 1.0, unit = "kg" }
k = { value = 100.0, unit = "N/m" }
d = { value = 2.0, unit = "N*s**2/m**2" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 10.0, unit = "J/K" }
[inputs]
F = { unit = "N" }
[domain]
assume = ["d >= 0"]
[elements]
mass   = { kind = "mass", at = "tip", mass = "m", state = "p" }
spring = { kind = "spring", between = ["tip", "wall"], stiffness = "k", state = "q" }
drag   = { kind = "damper", between = ["tip", "wall"], force = "d*v*abs(v)", heats = "body" }
body   = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
load   = { kind = "force_source", at = "tip", input = "F" }
"""


BOUC_WEN = Path(__file__).parents[1] / "benchmarks" / "bouc_wen.toml"


def test_members_whose_motions_repeat_run_as_they_do_alone():
    """Steps that are kept from one period to the next are those of the member."""
    members = Members(load(BOUC_WEN), 20, 12.0, {"F": sine(8.0, 0.5)})
    alone, together = (members.run(together=on, rtol=2e-6) for on in (False, True))
    assert np.array_equal(alone.states, together.states)
    assert np.array_equal(alone.work, together.work)
    members.x[:8] = np.nan
    others = members.run(rtol=2e-6)
    assert np.array_equal(others.states[8:], together.states[8:])


@pytest.mark.some(1)
@pytest.mark.parametrize("stages", [None, 3])
def test_members_with_modes_that_ring_run_as_they_do_alone(stages):
    """Which states ring is known lane by lane."""
    model, drive = load(Path(__file__).with_name("pull_in.toml")), sine(40.0, 2e3, offset=30.0)
    members = Members(model, 11, 5e-4, {"V_in": drive})
    alone, together = (members.run(together=on, rtol=1e-5, stages=stages) for on in (False, True))
    assert np.array_equal(alone.states, together.states)
    assert np.array_equal(alone.work, together.work)


def test_members_that_fail_leave_nothing_to_the_next_in_their_lanes():
    """More members than lanes: what a lane tries when its run sticks is not for the next run."""
    members = Members(parse(QUADRATIC), 20, 3.0, {"F": sine(40.0, 1.2)})
    whole = members.run(rtol=1e-5)
    members.x[:8] = np.nan
    runs = members.run(rtol=1e-5)
    assert [error is not None for error in runs.errors] == [k < 8 for k in range(20)]
    assert np.array_equal(whole.states[8:], runs.states[8:])
    assert np.array_equal(whole.work[8:], runs.work[8:])


@pytest.mark.parametrize("how", [{"rtol": 1e-4}, {"length": 1e-4}], ids=["rtol", "step"])
def test_the_number_of_members_changes_nothing(how):
    """Few share a vector for both of their tracks; many have one for each."""
    members = Members("piezo_stack", 19, 0.01, {"V_in": sine(100, 100)})
    whole = members.run(**how)
    systems, x = members.systems, members.x
    for size in (2, 3, 4, 5, 8, 9, 16, 17):
        members.systems, members.x = systems[-size:], x[-size:]
        found = members.run(**how)
        for one, other in ((found.states, whole.states), (found.sums, whole.sums)):
            assert np.array_equal(one, other[-size:])
        assert np.array_equal(found.work[:, :2], whole.work[-size:, :2])


def test_a_lane_whose_step_is_halved_goes_on_with_the_rest():
    members = Members("piezo_stack", 9, 0.02, {"V_in": sine(100, 100), "T_e": 296.15 + 1e-6})
    alone, together = (members.run(together=on, length=5e-4) for on in (False, True))
    assert together.work[:, 2].sum() > 0
    assert np.array_equal(alone.states, together.states)


@pytest.mark.parametrize("together", [False, True], ids=["one by one", "side by side"])
def test_states_at_rest_are_not_halved_for_their_noise(together):
    path = next(path for path in SPECS if path.stem == "two_banks_heat_one_body")
    runs = Members(load(path), 3, 500.0).run(together=together, length=0.1)
    steps, iterations, halvings = runs.work.T
    assert np.all(halvings == 0)
    assert np.all(iterations < 4 * steps)


@pytest.mark.parametrize("name", ["two_banks_heat_one_body", "a1_two_bodies"])
def test_a_state_that_has_come_to_rest_costs_next_to_nothing(name):
    path = next(path for path in SPECS if path.stem == name)
    short, long = (Members(load(path), 3, d).run(rtol=1e-6) for d in (1e3, 1e4))
    assert np.all(long.work[:, 0] < short.work[:, 0] + 100)
    assert np.all(long.work[:, 2] < long.work[:, 0] / 4)


def test_a_step_of_a_module_at_rest_is_one_iteration():
    runs = Members(load("piezo_stack"), 9, 1e6).run(length=1e3)
    assert np.array_equal(runs.work[:, 1], runs.work[:, 0])


@pytest.mark.parametrize("above", [1e-3, 1e-6, 1e-9])
def test_balances_close_where_newton_overshoots(above):
    inputs = {"V_in": sine(100, 100), "T_e": 296.15 + above}
    over = {"L": np.linspace(9e-4, 1.1e-3, 9)}
    found = sweep("piezo_stack", over=over, inputs=inputs, duration=0.02, times=5, step=1e-3)
    assert np.abs(found.entropy_residual).max() <= 1e-16
    assert np.abs(found.energy_residual).max() <= 4 * np.spacing(found.energy.max().item())


@pytest.mark.some(2)
@pytest.mark.parametrize("layout", ["one", "many", "lanes"])
@pytest.mark.parametrize("stages", [1, 2, 5])
def test_steps_in_vectors_are_compiled(layout, stages, no_compiler):
    """By a compiler that refuses those without vectors; it does not optimize, to be quick."""
    module = module_of(load("piezo_stack"))
    texts = (read_source(module, ending) for ending in (".h", ".c", "_step.c"))
    compiles(no_compiler, '*-DPLAIN*) exit 1;; *) set -- "$@" -O0;;')
    assert library(Sources("piezo_stack", *texts, stages, layout)).is_file()


def compiles(folder, cases):
    """Put a compiler into a folder that takes its words in these cases of the shell."""
    real = shutil.which("cc", path=os.defpath)
    says = f'case "$*" in {cases} esac; exec {real} "$@"'
    write_script(folder / "cc", f"PATH={os.defpath}; export PATH; {says}")


@pytest.mark.some(1)
@pytest.mark.parametrize("stages", [2, 3, 4, 5])
def test_stages_in_vectors_compute_what_stages_one_by_one_do(stages, request):
    members = Members(load("piezo_stack"), size=1, duration=0.02, inputs={"V_in": sine(100, 100)})
    found = members.run(rtol=1e-4, stages=stages)
    compiles(request.getfixturevalue("no_compiler"), "*--version* | *-DPLAIN*) ;; *) exit 1;;")
    wanted = members.run(rtol=1e-4, stages=stages)  # without vectors
    assert np.array_equal(found.states, wanted.states)
    assert np.array_equal(found.sums, wanted.sums)
    assert np.array_equal(found.work, wanted.work)
