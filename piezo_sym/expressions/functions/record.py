"""The record of a law function.

Input: nothing.  Output: the type `LawFunction`.  Rules are texts of the law language, in which x
and w are the arguments and y the value; `calculus` parses them.  A fact is a clause: comparisons
joined by ``|``, at least one of which holds, for all real numbers.  If a fact is about the domain
of the function alone, its first comparison says that the argument is outside.
"""

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal, final

INF = math.inf


@final
@dataclass(frozen=True)
class LawFunction:
    """One function of laws.

    Attributes
    ----------
    name : in laws and SymPy, of the method of FLINT's balls, and in C unless `c` is given.
    slopes : its derivatives by its arguments; at a kink, those of one of its sides.
    units : ``pure``: neither argument nor value has a unit; ``equal``: arguments and value have the
        same (of a table, all x, and all y and the value); ``none``: any argument, a value without
        unit; ``power``: those of the power `power`.
    choices : its branches, if it has kinks; with a `width`, for w >= 0.
    formula : the same by functions with fewer kinks, for every w.
    knots : whether its arguments are one number and the knots (x_k, y_k) of a piecewise linear
        function, whose pieces `calculus` makes; the x_k have to increase.
    jumps : whether it is discontinuous.
    width : whether its second argument is a width, taken to be >= 0.
    degree : f(c*x, c*w) = c**degree * f(x, w) for all c > 0, if there is such a number.
    power : the exponent, if it is a power of its argument.
    parity : f(-x, w) = -f(x, w) is ``odd``, f(-x, w) = f(x, w) ``even``.
    rises : 1 if a smooth function increases strictly (an even one: for x >= 0), else 0.
    domain : where it has a value; "" is everywhere.  A smooth function of two needs w > 0, too.
    sign : y > 0, or y >= 0 and zero at zero alone, wherever it has a value.
    known : a rational argument with a rational value, and that value.
    bounds : rational bounds of its values.
    largest : the argument beyond which the value exceeds every double.
    integral : an antiderivative by x, where it is of use.
    facts : known to solvers besides monotony; a comment at each says why it holds.
    numpy, c : its names there; `numpy` may be a template with places x and w, whose outermost
        operator is `binds`.
    numpy_helper : the import and the definition that `numpy` needs.
    c_helper : parameters and value in C, if <math.h> lacks it.
    written : whether a spec may write it; the others are made by lowering.
    about, example : one line on it, and a law with it, for users.
    """

    name: str
    slopes: tuple[str, ...]
    units: Literal["pure", "equal", "none", "power"] = "pure"
    choices: str = ""
    formula: str = ""
    knots: bool = False
    jumps: bool = False
    width: bool = False
    degree: int | None = None
    power: Fraction | None = None
    parity: Literal["", "odd", "even"] = ""
    rises: int = 0
    domain: Literal["", "x > 0", "x >= 0"] = ""
    sign: Literal["", ">", ">="] = ""
    known: tuple[int, int] | None = None
    bounds: tuple[float | Fraction, float | Fraction] = (-INF, INF)
    largest: float = INF
    integral: str = ""
    facts: tuple[str, ...] = ()
    numpy: str = ""
    binds: Literal["atom", "sum"] = "atom"
    numpy_helper: tuple[()] | tuple[str, str] = ()
    c: str = ""
    c_helper: tuple[str, str] | None = None
    written: bool = True
    about: str = ""
    example: str = ""

    @property
    def smooth(self) -> bool:
        """Whether it has no kinks."""
        return not (self.choices or self.knots)

    def branches(self, arguments: int) -> int:
        """Return how many branches it has, of so many arguments."""
        return arguments // 2 - 1 if self.knots else 1 + self.choices.count(" if ")

    @property
    def transcendental(self) -> bool:
        """Whether it is smooth and no power: solvers know it by its facts."""
        return self.smooth and self.power is None

    @property
    def monotone(self) -> bool:
        """Whether it increases strictly wherever it has a value."""
        return self.rises > 0 and self.parity != "even"

    @property
    def in_c(self) -> str:
        """The name in C."""
        return self.c or self.name
