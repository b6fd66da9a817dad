"""Periodic steady states of a driven model: states that repeat after one period of the inputs.

Input: a generated module with one body, periodic inputs, their frequency.  Output: one or all
`SteadyState`s: one period as a Dataset, the body's temperature, the heat of a period, the error of
repetition, and stability.

    P(x; f) = x        P: the state to that one period later; stable: |eigenvalues of dP/dx| <= 1

The search has two stages: zeros of the drift over a range of temperatures (`balance`), then
Newton's method for all states, with the steps per period doubled until it converges.  There can be
several steady states: ``piezo_stack`` at 50 Hz has one at 354 K, one at 4750 K, and an unstable one
between them, from which the temperature goes to one of the others.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, final

import numpy as np

from piezo_sym.analysis.balance import (
    Settled,
    SteadyWarning,
    between,
    fixed_point,
    grid,
    jacobian,
    scan,
    temperature_range,
    unsettled,
    warn_of_drift,
    zeros,
)
from piezo_sym.analysis.stroboscope import Stroboscope, over_period, stroboscope
from piezo_sym.errors import RunError, UsageError
from piezo_sym.run.checks import FloatArray, calling, number, positive
from piezo_sym.run.inputs import InputValue
from piezo_sym.run.module import GeneratedModule
from piezo_sym.run.parameters import LaneValue

if TYPE_CHECKING:
    import xarray

RTOL = 1e-6
STEPS, MOST_STEPS = 256, 1 << 16  # per period
SAMPLES = 400  # of the orbit returned
ORBIT_RTOL = 1e-8
#: The largest residual of a steady state, over its accuracy and in absolute terms.
RESIDUAL, MOST_RESIDUAL = 100.0, 0.1
MARGIN = 1e-6  # the error of a multiplier, by its difference quotient


@final
@dataclass(frozen=True, eq=False)
class SteadyState:
    """A periodic steady state of a model with one body; temperatures in K.

    Attributes
    ----------
    frequency : of the inputs [Hz].
    temperature, coldest, hottest : mean, least and greatest of the body in a period.
    loss : heat released by all processes in a period [J].
    residual : largest change of a state over `orbit`, over its size; not of states that drift.
    multiplier : the greatest magnitude of the eigenvalues of dP/dx.
    stable : whether the multiplier is at most 1: motions that neither grow nor decay are allowed.
    initial : the state at t = 0, as for `simulate(initial=...)`.
    orbit : one period, 401 samples, as `simulate` returns it.
    """

    frequency: float
    temperature: float
    coldest: float
    hottest: float
    loss: float
    residual: float
    multiplier: float
    stable: bool
    initial: Mapping[str, LaneValue]
    orbit: xarray.Dataset

    def __repr__(self) -> str:
        """Return temperature, frequency and stability, without the orbit."""
        kind = "stable" if self.stable else "unstable"
        return f"SteadyState({self.temperature:.6g} K at {self.frequency:g} Hz, {kind})"


@calling("periodic_steady_state")
def periodic_steady_state(
    module: GeneratedModule,
    *,
    inputs: Mapping[str, InputValue],
    frequency: float,
    parameters: Mapping[str, LaneValue] | None = None,
    initial: Mapping[str, LaneValue] | None = None,
    temperatures: tuple[float, float] | None = None,
    rtol: float = RTOL,
) -> SteadyState:
    """Return the periodic steady state that a run from its initial state approaches.

    That is the first zero of the drift in its direction at the start, once all other states have
    settled. Where the temperature is not the slowest motion, compare with a run, and so with stops
    or other hysteresis, which leave many periodic states: the past decides between them. A state
    that drifts, and on which no rate depends, such as a free position, keeps its initial value; a
    `SteadyWarning` says how far it drifts in a period.

    >>> from piezo_sym import periodic_steady_state, sine
    >>> periodic_steady_state("piezo_stack", inputs={"V_in": sine(100, 50)}, frequency=50)
    SteadyState(354.085 K at 50 Hz, stable)

    Parameters
    ----------
    model : the name of a shipped spec, the path of a spec file, or a `Model`; here, of
        `piezo_sym.analysis`, a generated module.
    inputs : as for `simulate`; they repeat with the period 1/frequency.
    frequency : of the inputs [Hz]; of several, the greatest that they have in common. If no input
        varies, a state of rest is searched for; `operating_point` does that directly.
    parameters, initial : as for `simulate`.
    temperatures : range to search [K]: least and greatest, of the body at t = 0; when left out,
        from the module's own start (lower if the body cools there) to 20 times that.
    rtol : accuracy of the states at t = 0, over their sizes, 1e-9 to 0.01.

    Raises
    ------
    UsageError : an argument is wrong, an input does not repeat or varies too fast for the period,
        or the model has not exactly one body.
    RunError : no steady state lies in the range; the message has the direction of the drift.
    EngineError : there is no C compiler.
    """
    strobe, accuracy = _read(module, inputs, frequency, parameters, initial, rtol)
    strobe, known = _settled_states(strobe, temperatures)
    return _steady_state(strobe, _first_zero(strobe, known), accuracy)


@calling("periodic_steady_states")
def periodic_steady_states(
    module: GeneratedModule,
    *,
    inputs: Mapping[str, InputValue],
    frequency: float,
    parameters: Mapping[str, LaneValue] | None = None,
    initial: Mapping[str, LaneValue] | None = None,
    temperatures: tuple[float, float] | None = None,
    rtol: float = RTOL,
) -> tuple[SteadyState, ...]:
    """Return all periodic steady states in a range of temperatures, stable or not, coldest first.

    States that differ by less than a hundredth of their temperature may be missed, and those whose
    period is a multiple of the inputs' are not found. Parameters and errors are as for
    `periodic_steady_state`, but the result may be empty.
    """
    strobe, accuracy = _read(module, inputs, frequency, parameters, initial, rtol)
    strobe, known = _settled_states(strobe, temperatures)
    return tuple(_steady_state(strobe, zero, accuracy) for zero in zeros(strobe, known))


def _read(
    module: GeneratedModule,
    inputs: Mapping[str, InputValue],
    frequency: float,
    parameters: Mapping[str, LaneValue] | None,
    initial: Mapping[str, LaneValue] | None,
    rtol: object,
) -> tuple[Stroboscope, float]:
    """Return the stroboscope and the accuracy of a search."""
    f = positive(frequency, "periodic_steady_state.frequency")
    strobe = stroboscope(module, lambda _: inputs, f, parameters, initial, STEPS)
    accuracy = number(rtol, "periodic_steady_state.rtol")
    if not 1e-9 <= accuracy <= 0.01:
        what = f"{accuracy:g} is out of range"
        raise UsageError(what, "periodic_steady_state.rtol", "1e-9 to 0.01")
    return strobe, accuracy


def _settled_states(
    strobe: Stroboscope, given: tuple[float, float] | None
) -> tuple[Stroboscope, list[Settled]]:
    """Return settled states over the range; without a given range, also below if the body cools.

    If nothing settles, states on which no rate depends need not repeat in the returned stroboscope.
    """
    low, high = temperature_range(strobe, given)
    temperatures = grid(low, high)
    known = [state for state in scan(strobe, temperatures, strobe.start) if state]
    if not known and strobe.moving_nothing.any():
        strobe = replace(strobe, free=True)
        known = [state for state in scan(strobe, temperatures, strobe.start) if state]
    if len(known) < len(temperatures):
        lost = sorted(set(temperatures) - {state.temperature for state in known})
        text = f"nothing settles at {len(lost)} of {len(temperatures)} temperatures"
        text += f", first {lost[0]:.6g} K; steady states there may be missed"
        warnings.warn(text, SteadyWarning, stacklevel=3)
    if given is None and known and known[0].temperature == low and known[0].drift < 0:
        below = [2 * low - T for T in grid(low, 1.99 * low)[1:]]
        for state in scan(strobe, below, known[0].x):
            if state is None:
                break
            known.insert(0, state)
            if state.drift >= 0:
                break
    return strobe, known


def _first_zero(strobe: Stroboscope, known: list[Settled]) -> Settled:
    """Return the first zero from the start in the direction of the drift there."""
    T = strobe.temperature(strobe.start)
    if not known:
        what = f"nothing settles at {T:.6g} K or anywhere in the range: {unsettled(strobe)}"
        remedy = "take the mean out of the input that drives it, hold it by a spring, or simulate"
        raise RunError(what, strobe.where, remedy=remedy)
    at = min(known, key=lambda state: abs(state.temperature - T))
    if at.drift == 0:
        return at
    heats = at.drift > 0
    found = zeros(strobe, known)
    side = [zero for zero in found if (zero.temperature > at.temperature) == heats]
    if not side:
        last = known[-1 if heats else 0]
        where = between(at, last) if found else between(known[0], known[-1])
        change = "heats" if heats else "cools"
        what = f"no periodic steady state: the body {change} {where} at t = 0"
        remedy = "let an ambient cool the body, or " if heats else ""
        remedy += "give a wider range as 'temperatures'"
        raise RunError(what, f"{strobe.where} at {strobe.frequency:g} Hz", remedy=remedy)
    return side[0] if heats else side[-1]


def _steady_state(strobe: Stroboscope, zero: Settled, rtol: float) -> SteadyState:
    """Return the steady state at a zero of the drift, to the accuracy `rtol`."""
    slope = jacobian(strobe, zero.x, zero.period.size)
    x, error = zero.x, np.inf
    while error > rtol:
        before = x
        strobe = replace(strobe, steps=2 * strobe.steps)
        if strobe.steps > MOST_STEPS:
            what = f"rtol {rtol:g} asks for more than {MOST_STEPS} steps a period"
            raise RunError(what, strobe.where, remedy="give a larger rtol")
        x = fixed_point(strobe, x, slope)
        # half the step at order 2: the error is a third of the change
        error = float(np.max(np.abs(x - before) / strobe.look(x).size)) / 3
    warn_of_drift(strobe, x)
    state = _described(strobe, x, slope)
    _refuse_residual(strobe, state, rtol)
    return state


def _refuse_residual(strobe: Stroboscope, state: SteadyState, rtol: float) -> None:
    """Raise `RunError` if a period with adaptive steps does not repeat: the fixed were too long."""
    allowed = min(MOST_RESIDUAL, RESIDUAL * max(rtol, ORBIT_RTOL))
    if state.residual > allowed * max(1.0, state.multiplier):
        what = f"the state found at {state.temperature:.6g} K does not repeat: it is off by "
        what += f"{state.residual:.1g} of its size after a period"
        where = f"{strobe.where} at {state.frequency:g} Hz"
        raise RunError(what, where, remedy="simulate until it settles")


def _described(strobe: Stroboscope, x: FloatArray, slope: FloatArray) -> SteadyState:
    """Return the record of the state x (n,), with a period by adaptive steps."""
    orbit = strobe.run(x, times=SAMPLES + 1, rtol=ORBIT_RTOL)
    values = [orbit[record.name].values.T for record in strobe.module.STATES]
    states = np.concatenate([np.atleast_2d(value) for value in values])
    T = np.asarray(orbit[f"T_{strobe.module.BODIES[0].name}"].values, dtype=float)
    mean, coldest, hottest = over_period(T)
    size = strobe.look(x).size
    heats = [orbit[f"heat_{name}"] for name in {r.name: None for r in strobe.module.PROCESSES}]
    fixed = strobe.conserved * size
    free = np.linalg.svd(fixed)[2][len(fixed) :] if len(fixed) else np.eye(len(slope))
    multiplier = float(np.max(np.abs(np.linalg.eigvals(free @ slope @ free.T)), initial=0.0))
    return SteadyState(
        frequency=strobe.frequency,
        temperature=mean,
        coldest=coldest,
        hottest=hottest,
        loss=float(sum(heat.isel(time=-1).sum() for heat in heats)),
        residual=float(np.max((np.abs(states[:, -1] - states[:, 0]) / size)[strobe.repeating])),
        multiplier=multiplier,
        stable=multiplier <= 1 + MARGIN,
        initial=strobe.named(x),
        orbit=orbit,
    )
