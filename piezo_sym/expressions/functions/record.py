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
    """One function of laws."""

    name: str  # in laws and SymPy, of the method of FLINT's balls, and in C unless `c` is given
    #: Its derivatives with respect to its arguments; at a kink, those of one of its sides.
    slopes: tuple[str, ...]
    #: ``pure``: neither argument nor value has a unit; ``equal``: arguments and value have the same
    #: (of a table, all x, and all y and the value); ``none``: any argument, a value without unit;
    #: ``power``: those of the power `power`.
    units: Literal["pure", "equal", "none", "power"] = "pure"
    choices: str = ""  # its branches, if it has kinks; with a `width`, for w >= 0
    formula: str = ""  # the same by functions with fewer kinks, for every w
    #: Whether its arguments are one number and the knots (x_k, y_k) of a piecewise linear function,
    #: whose pieces `calculus` makes; the x_k have to increase.
    knots: bool = False
    jumps: bool = False  # whether it is discontinuous
    width: bool = False  # whether its second argument is a width, taken to be >= 0
    #: Homogeneity: f(c*x, c*w) = c**degree * f(x, w) for all c > 0, if there is such a number.
    degree: int | None = None
    power: Fraction | None = None  # the exponent, if it is a power of its argument
    #: Symmetry: f(-x, w) = -f(x, w) is ``odd``, f(-x, w) = f(x, w) ``even``.
    parity: Literal["", "odd", "even"] = ""
    rises: int = 0  # 1 if a smooth function increases strictly (an even one: for x >= 0), else 0
    #: Where it has a value; "" is everywhere.  A smooth function of two needs w > 0, too.
    domain: Literal["", "x > 0", "x >= 0"] = ""
    #: The sign of its values: > 0, or >= 0 and zero only at zero.
    sign: Literal["", ">", ">="] = ""
    #: A rational argument with a rational value, and that value.
    known: tuple[int, int] | None = None
    bounds: tuple[float | Fraction, float | Fraction] = (-INF, INF)  # rational bounds of its values
    largest: float = INF  # the argument beyond which the value exceeds every double
    integral: str = ""  # an antiderivative with respect to x, if one is needed
    #: Known to solvers besides monotonicity; a comment at each says why it holds.
    facts: tuple[str, ...] = ()
    #: Its name in NumPy, or a template with places x and w, whose outermost operator is `binds`.
    numpy: str = ""
    binds: Literal["atom", "sum"] = "atom"
    #: The import and the definition that `numpy` needs.
    numpy_helper: tuple[()] | tuple[str, str] = ()
    c: str = ""  # its name in C, if that differs
    c_helper: tuple[str, str] | None = None  # parameters and value in C, if <math.h> lacks it
    written: bool = True  # whether a spec may write it; the others only result from lowering
    #: about, example: one line on it, and a law with it, for users.
    about: str = ""
    example: str = ""

    @property
    def smooth(self) -> bool:
        """Whether it has no kinks."""
        return not (self.choices or self.knots)

    def branches(self, arguments: int) -> int:
        """Return the number of its branches for this many arguments."""
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
