"""The checker's own table of functions: derivatives, and facts for a solver.

x and y are argument and value of a call, a and b those of another call of the same function.  A
fact holds for all real numbers: "premise: fact", or "premise: premise: fact".
"""

import re
from typing import NamedTuple

#: The definitions of functions with kinks; `laws` writes a table as choices.
KINKS = {
    "abs": "x if x >= 0 else -x",
    "sign": "1 if x > 0 else -1 if x < 0 else 0",
    "min": "x if x <= z else z",
    "max": "x if x >= z else z",
    "deadzone": "max(x - z, 0) + min(x + z, 0)",
    "saturate": "min(max(x, -z), z)",
    "table": "",
}
_RISING = "x < a: y < b; x > a: y > b; x >= a: y >= b; x <= a: y <= b"
_EQUAL = "x <= a: x >= a: y <= b; x <= a: x >= a: y >= b"
#: Facts that relate two calls of a function, by the names in the rows of `_SMOOTH`.
PAIRS = {
    "odd": f"{_RISING}; x + a <= 0: y + b <= 0; x + a >= 0: y + b >= 0",
    "even": f"{_EQUAL}; {_EQUAL.replace('a', '-a')}",
    "exp": f"{_RISING}; x + a <= 0: y*b <= 1; x + a >= 0: y*b >= 1",
    "log": f"x > 0: a > 0: {_RISING.replace('; ', '; x > 0: a > 0: ')}",
    "sin": f"{_EQUAL}; {_EQUAL.replace('a', '-a').replace('b', '-b')}",
}
#: Name, derivative, sign (that of x, or 1), facts on two calls (a name in `PAIRS`), facts on one.
#: atan(1) is pi/4; pow is |x|**z, with the same z > 0 in both calls.
_SMOOTH = """
exp  | y            | 1 | exp  | y > 0; y >= 1 + x; x <= 0: y <= 1; x <= 0: y <= 1 + x + x**2/2;
    x < 1: y*(1 - x) <= 1; x >= 0: y >= 1 + x + x**2/2 + x**3/6;
    x <= 0: y*(1 - x + x**2/2 - x**3/6) <= 1
log  | 1/x          |   | log  | x > 0: y <= x - 1; x > 0: x*y >= x - 1; x > 0: x*y**2 <= (x - 1)**2
pow  | z*y/x        | x | even | x >= 0: y >= 0; x > 0: y > 0; x >= 0: x <= 0: y <= 0
sin  | cos(x)       |   | sin  | y <= 1; y >= -1; x >= 0: y <= x; x <= 0: y >= x;
    x >= 0: y >= x - x**3/6; x <= 0: y <= x - x**3/6
cos  | -sin(x)      |   | even | y <= 1; y >= -1; y >= 1 - x**2/2; y <= 1 - x**2/2 + x**4/24
tanh | 1 - y**2     | x | odd  | y < 1; y > -1; x >= 0: y <= x; x <= 0: y >= x;
    x >= 0: y >= x - x**3/3; x > 0: y > 0; x <= 0: y <= x - x**3/3; x < 0: y < 0;
    x >= 0: (1 - y)*(1 + x + x**2) <= 1; x <= 0: (1 + y)*(1 - x + x**2) <= 1
sinh | cosh(x)      | x | odd  | x >= 0: y >= x + x**3/6; x <= 0: y <= x + x**3/6;
    x >= 0: y*(1 - x**2/6) <= x; x <= 0: y*(1 - x**2/6) >= x
cosh | sinh(x)      | 1 | even | y >= 1 + x**2/2; y*(1 - x**2/2) <= 1
atan | 1/(1 + x**2) | x | odd  | y < 1.5708; y > -1.5708; x >= 0: y <= x; x <= 0: y >= x;
    x >= 0: y*(1 + x) >= x; x <= 0: y*(1 - x) <= x
erf  | exp(-x**2)/sqrt(atan(1)) | x | odd | y < 1; y > -1; x >= 0: y <= 1.1284*x;
    x <= 0: y >= 1.1284*x; x >= 0: y*(1 + x) >= x; x <= 0: y*(1 - x) <= x
"""


class Smooth(NamedTuple):
    """A smooth function: the texts of a row."""

    slope: str
    sign: str
    pairs: str
    facts: str


_ROWS = (map(str.strip, row.split("|")) for row in re.split(r"\n(?=\w)", _SMOOTH.strip()))
SMOOTH = {name: Smooth(d, sign, PAIRS[pairs], facts) for name, d, sign, pairs, facts in _ROWS}
