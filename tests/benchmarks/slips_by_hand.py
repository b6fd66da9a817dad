"""A mass on stops under a triangle force, without this package: events, and regularised slips.

Input: a `Mass`, by its numbers.  Output: its exact state at a time, and LSODA's on rates compiled
by numba.  Between two events the mass is on a linear spring under a ramp: sine, cosine and line; an
event is a stop that comes to its limit, a return of the mass, or a turn of the force.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import cos, floor, hypot, inf, pi, sin, sqrt
from typing import TYPE_CHECKING, Any, final

import numpy as np
from scipy.integrate import solve_ivp

if TYPE_CHECKING:
    from piezo_sym.run.checks import FloatArray

#: Parts of a step and of a period that count as none.
NEAR = 1e-13


@final
@dataclass(frozen=True)
class Mass:
    """A mass m, stops of one stiffness and limits (n,), a triangle force from 0 up. SI units."""

    m: float
    stiffness: float
    limits: FloatArray
    amplitude: float
    period: float

    def force(self, t: float) -> float:
        """Return the force at a time."""
        turns = t / self.period + 0.25
        return self.amplitude * (1.0 - 4.0 * abs(turns - floor(turns) - 0.5))

    def ramp(self, quarter: int) -> tuple[float, float, float]:
        """Return the force and its rate where a ramp begins, and where it ends, as a time."""
        rate = 4.0 * self.amplitude / self.period * (1 if quarter % 2 == 0 else -1)
        begin = 0.0 if quarter == 0 else -self.amplitude if rate > 0.0 else self.amplitude
        return begin, rate, (0.25 + 0.5 * quarter) * self.period


def exact(mass: Mass, duration: float) -> FloatArray:
    """Return momentum and the stops' states (1 + n,) at a time, event by event."""
    reach = mass.limits / mass.stiffness
    z, v, t, quarter = np.zeros_like(reach), 0.0, 0.0, 0
    while t < duration:
        force, rate, end = mass.ramp(quarter)
        begun = 0.0 if quarter == 0 else end - 0.5 * mass.period
        force += rate * (t - begun)
        until = min(end, duration)
        net = force - mass.stiffness * float(z.sum())
        side = 1.0 if (v or net or rate) > 0.0 else -1.0
        free = side * z < reach * (1.0 - NEAR)
        stiff = mass.stiffness * int(free.sum())
        room = float(np.min((reach - side * z)[free])) if free.any() else inf
        way = _Way(v, net, rate, stiff, mass.m, side)
        took = way.time(room, until - t)
        gone = side * way.gone(took)
        z = np.where(free, np.clip(z + gone, -reach, reach), z)
        z = np.where(free & (side * z >= reach * (1.0 - NEAR)), side * reach, z)
        v = side * way.speed(took)
        v = 0.0 if way.returns else v
        t = until if took >= until - t else t + took
        quarter += t >= end
    return np.array([mass.m * v, *z])


class _Way:
    """The way of a mass in one direction between two events: m w'' = f + rate t - stiff w."""

    def __init__(
        self, v: float, f: float, rate: float, stiff: float, m: float, side: float
    ) -> None:
        self.v, self.f, self.rate, self.stiff, self.m = side * v, side * f, side * rate, stiff, m
        self.omega = sqrt(stiff / m)
        self.returns = False

    def gone(self, t: float) -> float:
        """Return the way after a time."""
        if self.stiff == 0.0:
            return t * (self.v + t * (self.f / 2.0 + t * self.rate / 6.0) / self.m)
        o, line = self.omega, self.rate / self.stiff
        return (
            self.f / self.stiff * 2.0 * sin(0.5 * o * t) ** 2
            + line * t
            + (self.v - line) * sin(o * t) / o
        )

    def speed(self, t: float) -> float:
        """Return the speed after a time."""
        if self.stiff == 0.0:
            return self.v + t * (self.f + t * self.rate / 2.0) / self.m
        o, line = self.omega, self.rate / self.stiff
        return line + (self.v - line) * cos(o * t) + self.f / self.stiff * o * sin(o * t)

    def back(self) -> float:
        """Return when the mass first stands, after it has gone; or infinity."""
        if self.stiff == 0.0:
            a, b, c = self.rate / 2.0, self.f, self.v * self.m
            found = [r.real for r in np.roots([a, b, c]) if abs(r.imag) == 0.0 and r.real > 0.0]
            return min((r for r in found if a * 2.0 * r + b < 0.0), default=inf)
        o, line = self.omega, self.rate / self.stiff
        one, two = self.v - line, self.f / self.stiff * o
        size = hypot(one, two)
        if size <= abs(line):
            return inf
        at = np.arctan2(two, one)  # speed: line + size cos(o t - at), falling through zero
        turn = np.arccos(-line / size)
        first = (at + turn) / o
        wave = 2.0 * pi / o
        first -= wave * floor(first / wave)
        return first if first > NEAR * wave else first + wave

    def time(self, room: float, longest: float) -> float:
        """Return the time to the first event: the way is `room`, the mass returns, or `longest`."""
        back = self.back()
        self.returns = back <= longest
        end = min(back, longest)
        if self.gone(end) < room:
            return end
        self.returns = False
        low, high = 0.0, end
        for _ in range(200):
            middle = 0.5 * (low + high)
            if not low < middle < high:
                break
            low, high = (middle, high) if self.gone(middle) < room else (low, middle)
        return high


def regularised(mass: Mass, duration: float) -> Callable[[float, float], FloatArray]:
    """Return LSODA with compiled rates and their derivative, as a function of two tolerances.

    A stop whose force exceeds its limit slips at the rate of that excess over a viscosity, which is
    `smooth` times its limit per 1 m/s; the other is the solver's.
    """
    rates, slopes = _compiled()
    n = mass.limits.size
    numbers = mass.m, mass.stiffness, mass.limits, mass.amplitude, mass.period

    def solve(smooth: float, rtol: float) -> FloatArray:
        given = (*numbers, smooth)
        scale = np.array([1.0, *(mass.limits / mass.stiffness)])
        found = solve_ivp(
            lambda t, x: rates(t, x, *given),
            (0.0, duration),
            np.zeros(n + 1),
            "LSODA",
            t_eval=(duration,),
            jac=lambda _, x: slopes(x, *numbers[:3], smooth),
            rtol=rtol,
            atol=rtol * scale,
        )
        if not found.success:
            raise RuntimeError(found.message)
        state: FloatArray = found.y[:, -1]
        return state

    return solve


def _compiled() -> tuple[Any, Any]:
    """Return the rates of (p, z...), and their derivative, compiled."""
    from numba import njit

    @njit
    def rates(t, x, m, k, limits, amplitude, period, smooth):  # type: ignore[no-untyped-def]
        out = np.empty_like(x)
        turns = t / period + 0.25
        v, total = x[0] / m, 0.0
        for j in range(limits.size):
            f = k * x[j + 1]
            over = max(f - limits[j], 0.0) + min(f + limits[j], 0.0)
            out[j + 1] = v - over / (smooth * limits[j])
            total += f
        out[0] = amplitude * (1.0 - 4.0 * abs(turns - np.floor(turns) - 0.5)) - total
        return out

    @njit
    def slopes(x, m, k, limits, smooth):  # type: ignore[no-untyped-def]
        out = np.zeros((x.size, x.size))
        for j in range(limits.size):
            out[0, j + 1] = -k
            out[j + 1, 0] = 1.0 / m
            if abs(k * x[j + 1]) > limits[j]:
                out[j + 1, j + 1] = -k / (smooth * limits[j])
        return out

    return rates, slopes
