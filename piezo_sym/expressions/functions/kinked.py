"""The functions of laws that have kinks.

Input: nothing.  Output: `KINKED`, a record each; see `record` for what it says, and in which words.
"""

from bisect import bisect
from itertools import pairwise

from piezo_sym.expressions.functions.record import LawFunction

_NAN = "not a number stays so"


def _saturate(z: float, w: float) -> float:
    return min(max(z, -w), w)


def _deadzone(z: float, w: float) -> float:
    return max(z - w, 0.0) + min(z + w, 0.0)


def _sign(z: float) -> float:
    return float((z > 0) - (z < 0))


def _table(z: float, *knots: float) -> float:
    x, y = knots[::2], knots[1::2]
    if any(a >= b for a, b in pairwise(x)):
        msg = "the knots do not increase"
        raise ArithmeticError(msg)
    k = min(bisect(x, z, 1), len(x) - 1)
    return y[k - 1] + (y[k] - y[k - 1]) / (x[k] - x[k - 1]) * (z - x[k - 1])


KINKED = (
    LawFunction(
        "abs",
        abs,
        ("sign(x)",),
        units="equal",
        choices="x if x >= 0 else -x",
        formula="max(x, -x)",
        degree=1,
        parity="even",
        sign=">=",
        integral="x*y/2",
        numpy="np.abs",
        c="fabs",
        about="the magnitude of x",
        example="d*v*abs(v)",
    ),
    LawFunction(
        "sign",
        _sign,
        ("0",),
        units="none",
        choices="1 if x > 0 else (-1 if x < 0 else 0)",
        jumps=True,
        degree=0,
        parity="odd",
        integral="abs(x)",
        numpy="np.sign",
        c_helper=("double z", "z > 0.0 ? 1.0 : z < 0.0 ? -1.0 : z"),
        about="the sign of x; a law that jumps says `discontinuous = true`",
        example="F_c*sign(v)",
    ),
    LawFunction(
        "min",
        min,
        ("1 if x <= w else 0", "0 if x <= w else 1"),
        units="equal",
        choices="x if x <= w else w",
        degree=1,
        integral="y**2/2 + w*max(x, w)",
        numpy="np.minimum",
        c_helper=("double a, double b", f"a < b || a != a ? a : b; /* {_NAN} */"),
        about="the smaller of two",
        example="min(d_1*v, d_2*v)",
    ),
    LawFunction(
        "max",
        max,
        ("1 if x >= w else 0", "0 if x >= w else 1"),
        units="equal",
        choices="x if x >= w else w",
        degree=1,
        integral="y**2/2 + w*min(x, w)",
        numpy="np.maximum",
        c_helper=("double a, double b", f"a > b || a != a ? a : b; /* {_NAN} */"),
        about="the larger of two",
        example="max(d_1*v, d_2*v)",
    ),
    LawFunction(
        "saturate",
        _saturate,
        ("0 if abs(x) > w else 1", "sign(x) if abs(x) > w else 0"),
        units="equal",
        choices="w if x > w else (-w if x < -w else x)",
        formula="min(max(x, -w), w)",
        width=True,
        degree=1,
        parity="odd",
        integral="x*y - y**2/2",
        numpy="np.clip({x}, -{w:atom}, {w})",
        c_helper=("double z, double w", "z > w ? w : z < -w ? -w : z"),
        about="x between -w and w, the half width w >= 0",
        example="saturate(d*v, F_c)",
    ),
    LawFunction(
        "deadzone",
        _deadzone,
        ("1 if abs(x) > w else 0", "-sign(x) if abs(x) > w else 0"),
        units="equal",
        choices="x - w if x > w else (x + w if x < -w else 0)",
        formula="max(x - w, 0) + min(x + w, 0)",
        width=True,
        degree=1,
        parity="odd",
        integral="y**2/2",
        numpy="{x:sum} - np.clip({x}, -{w:atom}, {w})",
        binds="sum",
        c_helper=("double z, double w", "z > w ? z - w : z < -w ? z + w : z - z"),
        about="what x is beyond -w or w, the half width w >= 0",
        example="R*deadzone(i, i_0)",
    ),
    LawFunction(
        "table",
        _table,
        (),
        units="equal",
        knots=True,
        about="straight lines through 2 to 64 knots x_1, y_1, ..., and on beyond",
        example="table(v, v_1, F_1, v_2, F_2, v_3, F_3)",
    ),
)
