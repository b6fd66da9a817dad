"""Smooth functions of intervals, by FLINT's ball arithmetic.

Input: a function's name and an interval of mpmath's.  Output: an interval that holds every value of
the function there.  Every smooth function of laws is a method of a ball, by its name.
"""

from __future__ import annotations

from typing import Any

from mpmath import mp
from mpmath.libmp import from_man_exp

from piezo_sym.expressions.functions import RECORDS


def smooth(function: str, value: Any, context: Any) -> Any:
    """Return a function of an interval of a context of mpmath's, at its precision and some more.

    Raises
    ------
    OverflowError
        Where the values are beyond what balls hold.
    """
    from flint import arb, ctx

    before, ctx.prec = ctx.prec, context.prec + 20
    try:
        low, high = (_ball(end, arb) for end in value._mpi_)
        if not RECORDS[function].monotone:
            low = high = low.union(high)
        ends = getattr(low, function)(), getattr(high, function)()
        if not all(end.is_finite() for end in ends):
            raise OverflowError(function)
        return context.mpf([_number(ends[0].lower()), _number(ends[1].upper())])
    finally:
        ctx.prec = before


def _ball(end: Any, arb: Any) -> Any:
    """Return an end of an interval, (sign, mantissa, exponent, bits), exactly."""
    sign, mantissa, exponent, _ = end
    return arb((-int(mantissa) if sign else int(mantissa), int(exponent)))


def _number(end: Any) -> Any:
    """Return an exact ball as a number of mpmath's, exactly."""
    mantissa, exponent = end.man_exp()
    return mp.make_mpf(from_man_exp(int(mantissa), int(exponent)))
