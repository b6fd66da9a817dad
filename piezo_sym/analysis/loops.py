"""Measures of a hysteresis loop: area, width, slope of its chord, phase, closure.

Input: samples (n,) of one period, in order, with both ends: of the drive x, such as a voltage, and
of the response y, such as a displacement or a charge.  Output: numbers in the units of x and y.

    area = closed integral of x dy      > 0 where y lags behind x

The area of voltage over the charge drawn is the energy put in per cycle; in periodic steady state
it is the heat of the cycle, if no other port puts energy in.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, final

import numpy as np
from numpy.typing import ArrayLike

from piezo_sym.errors import UsageError, nearest
from piezo_sym.run.checks import FloatArray, positive

if TYPE_CHECKING:
    import xarray

FEWEST = 8  # samples; fewer make no loop


@final
@dataclass(frozen=True)
class Loop:
    """The measures of one loop of the response y over the drive x."""

    area: float  # unit of x times unit of y
    width: float  # unit of y
    slope: float  # unit of y over unit of x
    phase: float  # rad
    closure: float  # unit of y


def measure(x: ArrayLike, y: ArrayLike) -> Loop:
    """Return all measures of a loop, its width where x is 0.

    Raises
    ------
    UsageError : the arrays are not two equally long ones of finite numbers, or x never crosses 0.
    """
    return Loop(area(x, y), width(x, y), slope(x, y), phase(x, y), closure(x, y))


def area(x: ArrayLike, y: ArrayLike) -> float:
    """Return the closed integral of x dy; the ends are joined by a straight line.

    The error is of order two in the distance of samples: with 400 per period, 4e-5 of a smooth
    loop's area.
    """
    a, b = _loop(x, y)
    a, b = a - a[0], b - b[0]
    return float(np.sum(a * np.roll(b, -1) - np.roll(a, -1) * b) / 2)


def width(x: ArrayLike, y: ArrayLike, at: float = 0.0) -> float:
    """Return the greatest distance in y between two crossings of x through the value `at`.

    Raises
    ------
    UsageError : x never crosses `at`.
    """
    a, b = _loop(x, y)
    after = np.roll(a, -1), np.roll(b, -1)  # the end is joined to the beginning
    k = np.flatnonzero((a >= at) != (after[0] >= at))
    if k.size < 2:
        least, most = float(a.min()), float(a.max())
        what = f"x crosses {at:g} less than twice; it goes from {least:g} to {most:g}"
        raise UsageError(what, "loops.width", "one whole period", "give another value for 'at'")
    crossings = b[k] + (at - a[k]) / (after[0][k] - a[k]) * (after[1][k] - b[k])
    return float(np.ptp(crossings))


def slope(x: ArrayLike, y: ArrayLike) -> float:
    """Return the slope of the chord from the least x to the greatest.

    Raises
    ------
    UsageError : x does not vary.
    """
    a, b = _loop(x, y)
    low, high = int(np.argmin(a)), int(np.argmax(a))
    if a[high] == a[low]:
        raise UsageError("x does not vary", "loops.slope", "a loop")
    return float((b[high] - b[low]) / (a[high] - a[low]))


def phase(x: ArrayLike, y: ArrayLike) -> float:
    """Return the phase lag of the fundamental of y behind that of x [rad], in (-pi, pi].

    The samples are taken to be evenly spaced in time over one period.
    """
    a, b = _loop(x, y)
    turn = np.exp(-2j * np.pi * np.arange(a.size - 1) / (a.size - 1))
    return float(np.angle(np.sum(a[:-1] * turn) * np.conj(np.sum(b[:-1] * turn))))


def closure(x: ArrayLike, y: ArrayLike) -> float:
    """Return the difference of y between the end and the beginning: 0 for a closed loop."""
    _, b = _loop(x, y)
    return float(b[-1] - b[0])


def last_period(run: xarray.Dataset, frequency: float) -> xarray.Dataset:
    """Return the samples of a run's last period, both ends included.

    Parameters
    ----------
    run : with evenly spaced times, a whole number of samples a period.
    frequency : in Hz.

    Raises
    ------
    UsageError : the run is shorter than a period, or a period is no whole number of samples.
    """
    period = 1 / positive(frequency, "loops.last_period.frequency")
    times = run.time.values
    first = int(np.searchsorted(times, times[-1] - period * (1 + 1e-9)))
    if abs(times[-1] - times[first] - period) > 1e-6 * period or times.size - first <= FEWEST:
        what = f"no {FEWEST} or more samples span one period of {period:g} s at the end of the run"
        remedy = "simulate with times=periods*400 + 1 over a whole number of periods"
        raise UsageError(what, "loops.last_period", "even samples", remedy)
    return run.isel(time=slice(first, None))


def drawn(run: xarray.Dataset, port: str) -> xarray.DataArray:
    """Return the integral of a port's output y since the first sample: a charge, a displacement.

    A cubic spline through the samples is integrated.

    Parameters
    ----------
    port : the name of the source, such as ``"supply"`` in ``piezo_stack``.

    Raises
    ------
    UsageError : the run has no such port.
    """
    import xarray
    from scipy.interpolate import CubicSpline

    ports = [str(name)[2:] for name in run.data_vars if str(name).startswith("y_")]
    if port not in ports:
        raise UsageError(f"unknown port '{port}'", "loops.drawn", remedy=nearest(port, ports))
    flow = run[f"y_{port}"]
    integral = CubicSpline(run.time.values, flow.values).antiderivative()(run.time.values)
    unit = f"{flow.attrs.get('units', '')}*s"
    attrs = {"units": {"A*s": "C", "m/s*s": "m"}.get(unit, unit), "long_name": f"drawn by {port}"}
    return xarray.DataArray(integral, {"time": run.time}, ("time",), f"drawn_{port}", attrs)


def _loop(x: ArrayLike, y: ArrayLike) -> tuple[FloatArray, FloatArray]:
    a, b = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    if a.ndim != 1 or a.shape != b.shape or a.size < FEWEST:
        what = f"x has shape {a.shape} and y {b.shape}"
        raise UsageError(what, "loops", f"two lists of equal length, {FEWEST} samples or more")
    if not (np.all(np.isfinite(a)) and np.all(np.isfinite(b))):
        raise UsageError("x or y is not finite", "loops", "finite numbers")
    return a, b
