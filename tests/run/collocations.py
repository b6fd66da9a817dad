"""Collocation steps of a model for tests: a run that stands at a state, and one through a time.

Input: a model's path or name.  Output: systems, `Steps` that stand at a state, trajectories.
"""

from functools import cache

import numpy as np

from piezo_sym import load
from piezo_sym.modules import module_of
from piezo_sym.run.collocation import collocate
from piezo_sym.run.engine.batch import Batch, Stepping
from piezo_sym.run.engine.engine import engine_of
from piezo_sym.run.inputs import read_inputs
from piezo_sym.run.parameters import read_initial, read_parameters
from piezo_sym.run.system import DrivenModule


@cache
def module(spec):
    return module_of(load(str(spec)))


def prepared(spec, duration=1.0, *, parameters=None, inputs=None, initial=None):
    """Return a system, and its state at t = 0."""
    found = module(spec)
    values = read_parameters(found, parameters)
    known = read_inputs(found, inputs, duration)
    x = read_initial(found, values, known.segments[0].at(0.0), initial)
    return DrivenModule(found, values, known), x


class Steps:
    """A run that stands at a state, and takes equal steps over kinks."""

    def __init__(self, system, x, stages, h):
        self.stepping = stepping = Stepping(stages, 1.0, h, h, fixed=h)
        times = np.empty(0)
        args = engine_of(system.module), [system.parameters], x[None], system.inputs, times
        self.batch = Batch(*args, stepping, "one")

    def take(self, count):
        """Take some steps and end there; return whether they are done."""
        self.batch.go_on(self.stepping, self.t + count * self.stepping.fixed)
        return self.finish() and bool(self.batch.records[0]["steps"] == count)

    def finish(self):
        """Step to the end; return whether there is a way."""
        while self.batch.go(1000):
            pass
        return not self.batch.records[0]["failed"]

    @property
    def t(self):
        return float(self.batch.records[0]["t"])

    @property
    def x(self):
        return self.batch.x[0]

    @property
    def iterations(self):
        return int(self.batch.records[0]["iterations"])


def through(spec, duration, times=2, *, rtol=1e-6, stages=3, **options):
    """Return a system, and its run."""
    system, x = prepared(spec, duration, **options)
    at = np.linspace(0.0, duration, times)
    runs = collocate([system], engine_of(system.module), x[None], at, rtol, stages=stages)
    return system, runs.trajectory(0)


def residuals(system, found):
    """Return what is left over of both balances at each sample, and the entropy produced."""
    p, m = system.parameters, system.module
    ports = len(m.OUTPUTS)
    processes = (len(found.integrals) - ports - len(exchanged(m))) // 2
    supplied = found.integrals[:ports].sum(axis=0)
    produced = found.integrals[ports + processes : ports + 2 * processes]
    brought = found.integrals[ports + 2 * processes :].sum(axis=0)
    energy, entropy = m.energy(found.states, p), m.entropy(found.states, p)
    start = m.energy(found.start, p), m.entropy(found.start, p)
    return (
        energy - start[0] - supplied,
        entropy - start[1] - produced.sum(axis=0) - brought,
        produced,
    )


def exchanged(m):
    return [record for record in m.OUTPUTS if record.unit == "K"]
