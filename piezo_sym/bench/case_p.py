"""The paper's actuator at 100 V and 100 Hz, from equilibrium: its states are known at two times.

Input: a spec's hash and the inputs given.  Output: `CaseP`, or nothing for any other run.  At
0.1 s three solvers with located kinks agree to 1e-14; at 10 s the digits below are good to 1e-6 of
the scale.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, final

import numpy as np

from piezo_sym.run.signals import Constant, Sine, sine
from piezo_sym.spec.load import load

if TYPE_CHECKING:
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
NAME = "piezo_stack"
#: The parameter that its sweep varies.
SWEPT = "L"


@final
@dataclass(frozen=True)
class CaseP:
    """Case P: its inputs, the scale of each state, and its states at known times."""

    inputs: Mapping[str, InputValue]

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
    if sha256 != load(NAME).sha256:
        return None
    driven: dict[str, InputValue] = {"V_in": sine(100.0, 100.0)}
    return CaseP(driven) if not inputs or _same(inputs) else None


def _same(inputs: Mapping[str, InputValue]) -> bool:
    """Return whether inputs are those of case P; its constants may be given or left out."""
    expected = {"V_in": Sine(100.0, 100.0, 0.0, 0.0), "F_ext": 0.0, "T_e": 298.15}
    plain = {n: s.value if isinstance(s, Constant) else s for n, s in inputs.items()}
    return "V_in" in plain and all(expected.get(n) == value for n, value in plain.items())


def _spread(values: tuple[float, ...], hysterons: int) -> FloatArray:
    """Return values of (q, p, Q_C, phi, S) with phi once a hysteron."""
    return np.array([*values[:3], *[values[3]] * hysterons, values[4]])
