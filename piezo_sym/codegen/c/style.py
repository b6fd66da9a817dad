"""The spelling of expressions in C.

Input: a tree and the C names of its symbols.  Output: one line of C99.  Small whole powers are
products, choices are calls of ``pick``, and a quotient of numbers stays a quotient: it is rounded
once, as in NumPy.  `helpers` defines the functions that a text calls and <math.h> lacks.
"""

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from fractions import Fraction

from piezo_sym.expressions.calculus import add, div, mul, neg
from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.text import (
    ATOM,
    PRODUCT,
    SUM,
    UNARY,
    Piece,
    Style,
    decimal,
    enclose,
    piece,
)
from piezo_sym.expressions.tree import ZERO, Call, Cmp, Div, Expr, If, Mul, Neg, Num, Sym, rebuild

#: Functions of ``real``; the head of a step defines them for numbers, real.h for vectors, too.
REALS = {name: f"{record.in_c}_of" for name, record in RECORDS.items() if record.smooth}
#: Macros that compare ``real``, since not every type that it may be has ``>``.
ABOVE = {"": "is_above", "=": "is_at_least"}
_CONSTANT = re.compile(r"-?[\d.]+(?:e[-+]?\d+)?(?:/[\d.]+)?")
#: Powers with larger exponents, which laws of nature do not have, call the library.
MOST_FACTORS = 8
#: Whole numbers up to here are exact as doubles.
EXACT = 2**53
_PICK = ("int condition, double a, double b", "condition ? a : b")
_HELPERS = {"pick": _PICK} | {n: r.c_helper for n, r in RECORDS.items() if r.c_helper}


def c_number(value: Fraction) -> Piece:
    """Return a rational number: an exact decimal, a quotient of whole numbers, or 17 digits."""
    if value < 0:
        return f"-{enclose(c_number(-value), PRODUCT)}", SUM
    text = decimal(value)
    if text is None and max(value.numerator, value.denominator) <= EXACT:
        return f"{value.numerator}.0/{value.denominator}.0", PRODUCT
    if text is None or len(text) > 17:
        text = repr(float(value))
    return (text if re.search(r"[.e]", text) else f"{text}.0"), ATOM


def _power(base: Piece, exponent: Fraction, ending: str = "") -> Piece:
    if exponent == Fraction(1, 2):
        return f"sqrt{ending}({base[0]})", ATOM
    size = abs(exponent)
    if size.denominator != 1 or not 1 <= size <= MOST_FACTORS:
        by = c_number(exponent)
        return f"pow{ending}({base[0]}, {widened(by) if ending else by[0]})", ATOM
    product = f"power_{size}{ending}({base[0]})" if size > 1 else base[0]
    if exponent > 0:
        return product, ATOM if size > 1 else base[1]
    return f"1.0/{enclose((product, ATOM if size > 1 else base[1]), UNARY)}", PRODUCT


def _call(function: str, args: tuple[Piece, ...]) -> Piece:
    name = RECORDS[function].in_c if function in RECORDS else function
    return f"{name}({', '.join(text for text, _ in args)})", ATOM


def _pick(then: Piece, test: str, other: Piece) -> Piece:
    return f"pick({test}, {then[0]}, {other[0]})", ATOM


def _lane_sum(arg: Piece, bank: str) -> Piece:
    raise TypeError(f"the sum of {arg[0]} over {bank} is a loop, not an expression")


def c_style(names: Mapping[str, str], arrays: Mapping[str, str], index: str) -> Style:
    """Return the spelling of expressions; `arrays` have a value per lane, picked by `index`.

    A choice is a call of ``pick``, so that the text also holds where numbers are vectors of many
    states.
    """

    def name(word: str) -> Piece:
        return (f"{names[word]}[{index}]" if word in arrays else names[word]), ATOM

    return Style(c_number, name, _power, _call, _pick, _lane_sum)


def real_style(plain: Style) -> Style:
    """Return a spelling that holds for every width of ``real``: one number, or one per lane."""

    def power(base: Piece, exponent: Fraction) -> Piece:
        return _power(base, exponent, "_of")

    def call(function: str, args: tuple[Piece, ...]) -> Piece:
        return f"{REALS[function]}({', '.join(map(widened, args))})", ATOM

    def choose(then: Piece, test: str, other: Piece) -> Piece:
        return f"chosen({test}, {widened(then)}, {widened(other)})", ATOM

    def compare(left: Piece, op: str, right: Piece) -> str:
        above, below = (left, right) if op.startswith(">") else (right, left)
        return f"{ABOVE[op[1:]]}({above[0]}, {below[0]})"

    return replace(plain, power=power, call=call, choose=choose, compare=compare)


def widened(value: Piece) -> str:
    """Return the text of a value, with numbers as ``real`` of any width."""
    return f"wide({value[0]})" if _CONSTANT.fullmatch(value[0]) else value[0]


def with_branches(node: Expr) -> Expr:
    """Return an expression with dead zones of short arguments as branches.

    ``f*deadzone(z, w)`` is ``0 if abs(z) <= w else f*(z - copysign(w, z))``, for w >= 0: inside the
    zone nothing is divided, and in a loop over lanes a compiler makes masks of such branches. A NaN
    stays a NaN.
    """
    inner = rebuild(node, with_branches)
    match inner:
        case Call("deadzone", (z, w)) if _short(z) and _short(w):
            beyond = add(z, neg(Call("copysign", (w, z))))
            return If(ZERO, Cmp("<=", Call("abs", (z,)), w), beyond)
        case Mul(left, If(then, condition, other)) if then == ZERO and not isinstance(left, If):
            return If(ZERO, condition, mul(left, other))
        case Mul(If(then, condition, other), right) if then == ZERO and not isinstance(right, If):
            return If(ZERO, condition, mul(other, right))
        case Div(If(then, condition, other), right) if then == ZERO and not isinstance(right, If):
            return If(ZERO, condition, div(other, right))
        case Neg(If(then, condition, other)) if then == ZERO:
            return If(ZERO, condition, neg(other))
    return inner


def _short(node: Expr) -> bool:
    return isinstance(node, Sym | Num) or (isinstance(node, Neg) and isinstance(node.arg, Sym))


def c_piece(node: Expr, style: Style) -> Piece:
    """Return an expression as C, with the strength of its outermost operator."""
    return piece(with_branches(node), style)


def calls(text: str) -> set[str]:
    """Return what is called in a text."""
    return set(re.findall(r"\b(\w+)\(", text))


def helpers(text: str) -> Iterator[str]:
    """Yield the definition of each function that `text` calls and <math.h> lacks."""
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)
    called = calls(text)
    for name, (arguments, value) in _HELPERS.items():
        if name in called:
            ending = "" if value.endswith("*/") else ";"
            yield f"static double {name}({arguments})\n{{\n    return {value}{ending}\n}}"
    yield from powers(text, "double")


def powers(text: str, number: str) -> Iterator[str]:
    """Yield the definition of each whole power that `text` calls."""
    kind, end = ("inline real", "_of") if number == "real" else ("double", "")
    called = calls(text)
    for n in range(2, MOST_FACTORS + 1):
        if f"power_{n}{end}" in called:
            product = "*".join("z" * n)
            yield f"static {kind} power_{n}{end}({number} z)\n{{\n    return {product};\n}}"
