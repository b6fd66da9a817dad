"""Hysteresis that does not depend on the rate: stops, and a Bouc-Wen spring.

Input: `Settings`.  Output: rows at equal error: a mass on a hundred stops under a triangle force,
its time per period beside LSODA's on regularised slips compiled by numba; a bank of a thousand, its
time per stop and fixed step; and an oscillator with a Bouc-Wen spring beside heyoka, which takes
each sign as an event. Models are of this folder.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from piezo_sym import load
from piezo_sym.bench.contest import Contestant, Pair, compared
from piezo_sym.bench.problem import problem_of
from piezo_sym.modules import module_of
from piezo_sym.run import simulate
from piezo_sym.run.signals import sine, triangle
from tests.benchmarks.machine import installed
from tests.benchmarks.peers import PEERS
from tests.benchmarks.report import Part
from tests.benchmarks.runs import run_rows
from tests.benchmarks.slips_by_hand import Mass, exact, regularised

if TYPE_CHECKING:
    from collections.abc import Callable

    from piezo_sym.bench.problem import Problem
    from piezo_sym.run.checks import FloatArray
    from tests.benchmarks.settings import Settings

FOLDER = Path(__file__).parent
#: The mass: limits of its stops from the least to the largest [N], force [N] and its period [s];
#: periods that this package goes through, and those after which the other one's error is seen.
STOPS, LIMITS, AMPLITUDE, PERIOD = 100, (0.01, 0.4), 12.0, 0.6
PERIODS, OTHERS = 1000, 5
RTOL, TARGET = 1e-6, 1e-6
#: The bank: its stops, each a smaller part of the same whole; step [s], order, periods.
BANK, STEP, ORDER, BANKED = 1000, 1e-3, 2, 10
#: Of LSODA: how smooth slips are, loosest first, and the solver's tolerance as a part of that.
SMOOTH, OWN = (1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 3e-7), 1e-5
#: The oscillator's force, how long it lasts, and the error that runs are tuned to.
BOUC_WEN, LONG, FINE = {"F": sine(8.0, 0.5)}, 60.0, 1e-8
PARTNERS = ("numba", "heyoka")
MEASURE = "at the end, against the exact run from event to event; of a momentum and of limits"


def hysteresis_rows(_: Problem, settings: Settings) -> Part:
    """Return the rows of the group `hysteresis`, whatever the problem at hand."""
    stops = stops_rows(settings)
    bank = bank_rows(settings)
    problem = problem_of(load(FOLDER / "bouc_wen.toml"), BOUC_WEN, LONG)
    peers = tuple(peer for peer in PEERS if peer.package in PARTNERS)
    oscillator = run_rows("Bouc-Wen", problem, FINE, settings, independent=True, peers=peers)
    return Part(stops.rows + bank.rows + oscillator.rows, stops.left_out + oscillator.left_out)


def mass_on_stops(stops: int = STOPS) -> Mass:
    """Return the mass by its numbers: those of ``stops.toml``, and the limits of its stops.

    However many they are, all together they have the same stiffness and limit.
    """
    values, part = module_of(load(FOLDER / "stops.toml")).Parameters(), STOPS / stops
    limits = part * np.linspace(*LIMITS, stops)
    return Mass(values.m, part * float(np.max(values.k)), limits, AMPLITUDE, PERIOD)


def run_of(mass: Mass, periods: float) -> Callable[..., FloatArray]:
    """Return a run of this package: from rtol, or step and order, to its last state (1 + n,)."""
    module: Any = module_of(load(FOLDER / "stops.toml"))
    duration, stops = periods * mass.period, mass.limits.size
    of_stops = {"k": mass.stiffness, "F_c": mass.limits.tolist(), "stop_count": stops}
    inputs = {"F": triangle(mass.amplitude, 1.0 / mass.period)}
    how: dict[str, Any] = {"parameters": of_stops, "duration": duration, "times": [duration]}

    def solve(rtol: float | None = None, **steps: float) -> FloatArray:
        steps = steps if rtol is None else {"rtol": rtol}
        found = simulate(module, inputs=inputs, **how, **steps)
        return np.array([found.p.values[-1], *found.z.values[-1]])

    return solve


def error(mass: Mass, x: FloatArray, known: FloatArray) -> float:
    """Return the largest error, in units of a momentum and of each stop's largest state."""
    speed = mass.amplitude / np.sqrt(mass.stiffness * mass.limits.size * mass.m)
    scale = np.array([mass.m * speed, *(mass.limits / mass.stiffness)])
    return float(np.max(np.abs(x - known) / scale))


def stops_rows(settings: Settings, periods: int = PERIODS, others: int = OTHERS) -> Part:
    """Return the row of the mass on stops; ours goes through `periods`, LSODA through `others`."""
    group, mass = f"{mass_on_stops().limits.size} stops, a period", mass_on_stops()
    solve = run_of(mass, periods)
    off = error(mass, solve(RTOL), exact(mass, periods * mass.period))
    about = f"rtol {RTOL:g}, {periods} periods"
    ours = Contestant("simulate()", partial(solve, RTOL), periods, off, about)
    if not installed("numba"):
        return Part(compared(group, [Pair(None, ours)], 1), (f"{group}, LSODA: no numba",))
    known, lsoda = exact(mass, others * mass.period), regularised(mass, others * mass.period)

    name = "LSODA on regularised slips, compiled by numba"
    tried = ((smooth, error(mass, lsoda(smooth, OWN * smooth), known)) for smooth in SMOOTH)
    best = next((pair for pair in tried if pair[1] <= TARGET), None)
    if best is None:
        reason = f"reaches no error of {TARGET:.0e}"
        return Part(compared(group, [Pair(None, ours)], 1), (f"{group}, {name}: {reason}",))
    smooth, off = best
    note = f"viscosity {smooth:.0e} of a limit, rtol {OWN * smooth:.0e}, {others} periods"
    peer = Contestant(name, partial(lsoda, smooth, OWN * smooth), others, off, note)
    return Part(compared(group, [Pair(peer, ours)], settings.rounds, MEASURE))


def bank_rows(settings: Settings, periods: int = BANKED) -> Part:
    """Return the row of a bank of many stops: a fixed step, divided by their number."""
    mass = mass_on_stops(BANK)
    solve = partial(run_of(mass, periods), step=STEP, order=ORDER)
    off = error(mass, solve(), exact(mass, periods * mass.period))
    steps, about = round(periods * mass.period / STEP), f"step {STEP:g} s, order {ORDER}"
    ours = Contestant("simulate(step=...)", solve, steps * BANK, off, about)
    group = f"{BANK} stops, a step and stop"
    return Part(compared(group, [Pair(None, ours)], settings.rounds, MEASURE))
