"""The paper's actuator at 100 V and 100 Hz, from equilibrium: its states are known at two times.

Input: a model and the inputs given.  Output: its `Problem`; `CaseP`, or nothing for any other run.
At 0.1 s three solvers with located kinks agree to 1e-14; at 10 s the digits below are good to 1e-6
of the scale.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, final

import numpy as np

from piezo_sym import load
from piezo_sym.bench import problem as explicit
from piezo_sym.bench.problem import DRIVEN, SHIPPED
from piezo_sym.run.signals import Constant

if TYPE_CHECKING:
    from piezo_sym import Model
    from piezo_sym.bench.problem import Problem
    from piezo_sym.run.checks import FloatArray
    from piezo_sym.run.inputs import InputValue

#: State at a time [s], and how far it is known, in units of the scale: q, p, Q_C, phi, S.
KNOWN: tuple[tuple[float, tuple[float, ...], float], ...] = (
    (
        0.1,
        (
            -9.523507638450e-04,
            3.453828489837e-03,
            -3.900998920056e-05,
            5.224415297332e-03,
            1.341141665114e-01,
        ),
        1e-12,
    ),
    (10.0, (-1.6791582326e-3, -1.645951262e-2, -1.47885318e-4, -0.2161631682, 11.0909671), 1e-6),
)
SCALE = (2e-3, 5e-3, 5e-4, 6e-3, 5e-2)
#: The parameter that its sweep varies.
SWEPT = "L"


@final
@dataclass(frozen=True)
class CaseP:
    """Case P: the scale of each state, and its states at known times."""

    def scale(self, hysterons: int) -> FloatArray:
        """Return by what the error of each state is measured (n,)."""
        return _spread(SCALE, hysterons)

    def known(self, time: float, hysterons: int) -> tuple[FloatArray, float] | None:
        """Return the state at a time and how far it is known, or nothing."""
        if hysterons != 2:
            return None
        found = (row for row in KNOWN if row[0] == time)
        return next(((_spread(x, hysterons), good) for _, x, good in found), None)


def case_p(sha256: str, inputs: Mapping[str, InputValue]) -> CaseP | None:
    """Return case P if this is the shipped actuator with its inputs, or with none given."""
    if sha256 != load(SHIPPED).sha256:
        return None
    return CaseP() if not inputs or _same(inputs) else None


def problem_of(
    model: Model,
    inputs: Mapping[str, InputValue],
    duration: float,
    sizes: Mapping[str, int] | None = None,
) -> Problem:
    """Return a model as a problem, with the scale of case P if it is that, else 1."""
    problem = explicit.problem_of(model, inputs, duration, sizes)
    case = case_p(model.sha256, problem.inputs)
    return replace(problem, scale=case.scale(problem.start.size - 4)) if case else problem


def _same(inputs: Mapping[str, InputValue]) -> bool:
    """Return whether inputs are those of case P; its constants may be given or left out."""
    expected = {**DRIVEN, "F_ext": 0.0, "T_e": 298.15}
    plain = {n: s.value if isinstance(s, Constant) else s for n, s in inputs.items()}
    return "V_in" in plain and all(expected.get(n) == value for n, value in plain.items())


def _spread(values: tuple[float, ...], hysterons: int) -> FloatArray:
    """Return values of (q, p, Q_C, phi, S) with phi once a hysteron."""
    return np.array([*values[:3], *[values[3]] * hysterons, values[4]])
