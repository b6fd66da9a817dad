"""How NumPy spells the parts of an expression.

Input: a tree.  Output: one line of NumPy.  A dead zone prints as ``z - clip(z, -w, w)``, one pass
over an array instead of five.
"""

from __future__ import annotations

from fractions import Fraction

from piezo_sym.spec.expressions import Expr
from piezo_sym.spec.text import ATOM, POWER, PRODUCT, SUM, Piece, Style, decimal, enclose, write

CALLS = {
    "exp": "np.exp",
    "expm1": "np.expm1",
    "log": "np.log",
    "sqrt": "np.sqrt",
    "sin": "np.sin",
    "cos": "np.cos",
    "tanh": "np.tanh",
    "abs": "np.abs",
    "sign": "np.sign",
    "min": "np.minimum",
    "max": "np.maximum",
}


def _number(value: Fraction) -> Piece:
    if value < 0:
        return f"-{enclose(_number(-value), PRODUCT)}", SUM
    text = decimal(value)
    if text and len(text) <= 20:
        return text, ATOM
    if value.denominator == 1 or text:
        return repr(float(value)), ATOM
    return f"{value.numerator}/{value.denominator}", PRODUCT


def _power(base: Piece, exponent: Fraction) -> Piece:
    if exponent == Fraction(1, 2):
        return f"np.sqrt({base[0]})", ATOM
    if exponent.denominator == 1 and exponent > 0:
        return f"{enclose(base, ATOM)}**{exponent.numerator}", POWER
    return f"{enclose(base, ATOM)}**({enclose(_number(exponent), SUM)})", POWER


def _call(function: str, args: tuple[Piece, ...]) -> Piece:
    texts = [text for text, _ in args]
    if function in CALLS:
        return f"{CALLS[function]}({', '.join(texts)})", ATOM
    clipped = f"np.clip({texts[0]}, -{enclose(args[1], ATOM)}, {texts[1]})"
    if function == "saturate":
        return clipped, ATOM
    return f"{enclose(args[0], SUM)} - {clipped}", SUM  # deadzone


NUMPY = Style(
    number=_number,
    name=lambda name: (name, ATOM),
    power=_power,
    call=_call,
    choose=lambda then, test, other: (f"np.where({test}, {then[0]}, {other[0]})", ATOM),
    lane_sum=lambda arg, _: (f"np.sum({arg[0]}, axis=0)", ATOM),
)


def numpy_text(node: Expr) -> str:
    """Return an expression as NumPy; names are locals of the generated function."""
    return write(node, NUMPY)
