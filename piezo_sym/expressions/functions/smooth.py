"""The smooth functions of laws.

Input: nothing.  Output: `SMOOTH`, a record each; see `record` for what it says, and in which words.
"""

import math
from fractions import Fraction

from piezo_sym.expressions.functions.record import INF, LawFunction

_ONE = (Fraction(-1), Fraction(1))


def _raised(x: float, w: float) -> float:
    if x < 0 or w <= 0:
        msg = "a power of a negative number, or one that may divide by zero"
        raise ArithmeticError(msg)
    return math.pow(x, w)


SMOOTH = (
    LawFunction(
        "exp",
        math.exp,
        ("y",),
        rises=1,
        sign=">",
        known=(0, 1),
        bounds=(Fraction(0), INF),
        largest=1e4,
        integral="y",
        facts=(  # convex: above its tangents at 0 and 1; 1/exp(x) = exp(-x) >= 1 - x
            "y > 0",
            "y >= 1 + x",
            "y >= 2.71828*x",  # a little below e: exp(x) >= e*x
            "x < 0 | y >= 1 + x + 0.5*x**2",
            "x >= 1 | y*(1 - x) <= 1",
        ),
        numpy="np.exp",
        about="e to the power of x",
        example="I_s*(exp(v/v_T) - 1)",
    ),
    LawFunction(  # lowering makes it, for exp(x) - 1 without cancellation
        "expm1",
        math.expm1,
        ("exp(x)",),
        rises=1,
        known=(0, 0),
        numpy="np.expm1",
        written=False,
    ),
    LawFunction(
        "log",
        math.log,
        ("1/x",),
        rises=1,
        domain="x > 0",
        known=(1, 0),
        facts=("x <= 0 | y <= x - 1", "x <= 0 | y*x >= x - 1"),  # tangent at 1; log(x) = -log(1/x)
        integral="x*y - x",
        numpy="np.log",
        about="the natural logarithm of x",
        example="T_0*(1 + log(1 + S/c_0))",
    ),
    LawFunction(
        "sqrt",
        math.sqrt,
        ("0.5/y",),
        units="power",
        power=Fraction(1, 2),
        domain="x >= 0",
        sign=">=",
        known=(0, 0),
        numpy="np.sqrt",
        about="the square root of x; also x**(1/2)",
        example="c*sqrt(v**2 + w**2)",
    ),
    LawFunction(  # x**w of an x that may be zero, as abs(f/f_0)**n: `parse` makes it
        "pow",
        _raised,
        ("w*y/(x if x > 0 else 1)", "y*log(x if x > 0 else 1)"),  # the first infinite at 0 if w < 1
        domain="x >= 0",
        sign=">=",
        facts=("x < 0 | y >= 0", "x <= 0 | y > 0", "x < 0 | x > 0 | y <= 0"),  # w > 0: 0**w = 0
        numpy="np.power",
        written=False,
    ),
    LawFunction(
        "sin",
        math.sin,
        ("cos(x)",),
        parity="odd",
        known=(0, 0),
        bounds=_ONE,
        facts=(  # |sin x| <= |x|, its sign up to 3 < pi, x - x**3/6 <= sin x for x >= 0
            "y <= 1",
            "y >= -1",
            "x < 0 | y <= x",
            "x > 0 | y >= x",
            "x < 0 | y >= x - x**3/6",
            "x > 0 | y <= x - x**3/6",
            "x < 0 | x > 3 | y >= 0",
            "x > 0 | x < -3 | y <= 0",
        ),
        integral="-cos(x)",
        numpy="np.sin",
        about="the sine of x [rad]",
        example="k*sin(q/q_0)",
    ),
    LawFunction(
        "cos",
        math.cos,
        ("-sin(x)",),
        parity="even",
        known=(0, 1),
        bounds=_ONE,
        facts=("y <= 1", "y >= -1", "y >= 1 - 0.5*x**2"),
        integral="sin(x)",
        numpy="np.cos",
        about="the cosine of x [rad]",
        example="R*(2 - cos(i/i_0))",
    ),
    LawFunction(
        "tanh",
        math.tanh,
        ("1 - y**2",),
        parity="odd",
        rises=1,
        known=(0, 0),
        bounds=_ONE,
        facts=(  # x/(1 + |x|) lies between 0 and tanh(x), and that below x
            "y < 1",
            "y > -1",
            "x < 0 | y <= x",
            "x < 0 | y*(1 + x) >= x",
            "x > 0 | y >= x",
            "x > 0 | y*(1 - x) <= x",
        ),
        integral="log(cosh(x))",
        numpy="np.tanh",
        about="the hyperbolic tangent of x",
        example="F_c*tanh(v/v_c)",
    ),
    LawFunction(
        "atan",
        math.atan,
        ("1/(1 + x**2)",),
        parity="odd",
        rises=1,
        known=(0, 0),
        bounds=(Fraction(-7854, 5000), Fraction(7854, 5000)),
        facts=(  # pi/2 < 1.5708; for x >= 0 slopes order as 1/(1 + x)**2 <= 1/(1 + x**2) <= 1
            "y < 1.5708",
            "y > -1.5708",
            "x < 0 | y <= x",
            "x < 0 | y*(1 + x) >= x",
            "x > 0 | y >= x",
            "x > 0 | y*(1 - x) <= x",
        ),
        integral="x*y - log(1 + x**2)/2",
        numpy="np.arctan",
        about="the inverse tangent of x [rad]",
        example="F_c*atan(v/v_c)",
    ),
    LawFunction(
        "sinh",
        math.sinh,
        ("cosh(x)",),
        parity="odd",
        rises=1,
        known=(0, 0),
        largest=1e4,
        integral="cosh(x)",
        facts=(  # odd; for x >= 0 all terms of its series are >= 0, and (2k + 1)! >= 6**k
            "x < 0 | y >= x",
            "x > 0 | y <= x",
            "x < 0 | y >= x + x**3/6",
            "x > 0 | y <= x + x**3/6",
            "x < 0 | y*(1 - x**2/6) <= x",
            "x > 0 | y*(1 - x**2/6) >= x",
        ),
        numpy="np.sinh",
        about="the hyperbolic sine of x",
        example="I_0*sinh(v/v_0)",
    ),
    LawFunction(
        "cosh",
        math.cosh,
        ("sinh(x)",),
        parity="even",
        rises=1,
        sign=">",
        known=(0, 1),
        bounds=(Fraction(1), INF),
        largest=1e4,
        integral="sinh(x)",
        facts=(  # all terms of its series are >= 0, and (2k)! >= 2**k
            "y >= 1",
            "y >= 1 + 0.5*x**2",
            "y*(1 - 0.5*x**2) <= 1",
        ),
        numpy="np.cosh",
        about="the hyperbolic cosine of x",
        example="R*cosh(i/i_0)",
    ),
    LawFunction(
        "erf",
        math.erf,
        ("exp(-x**2)/sqrt(atan(1))",),  # atan(1) = pi/4
        parity="odd",
        rises=1,
        known=(0, 0),
        bounds=_ONE,
        facts=(  # 2/sqrt(pi) < 1.1284; where x >= 0 let g = (1 - y)*(1 + x), g(0) = 1: g' < 0, as
            # 1 - y <= exp(-x**2) and y' = 1.128...*exp(-x**2); so g <= 1, which is y*(1 + x) >= x
            "y < 1",
            "y > -1",
            "x < 0 | y <= 1.1284*x",
            "x < 0 | y*(1 + x) >= x",
            "x > 0 | y >= 1.1284*x",
            "x > 0 | y*(1 - x) <= x",
        ),
        numpy="_erf",
        numpy_helper=("from math import erf", "_erf = np.vectorize(erf, otypes=[float])"),
        about="the error function of x",
        example="F_c*erf(v/v_c)",
    ),
)
