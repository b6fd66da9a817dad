"""Trees to text: one walk for the spec's own spelling and for every printed language.

Input: a tree.  Output: text with no more parentheses than it needs.  A language is a `Style`: how
it writes numbers, powers, calls, choices, comparisons and names.  `SPEC` writes the law language
itself, so that parsing what it writes gives the tree back.
"""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import final

from piezo_sym.expressions.tree import (
    Add,
    Call,
    Cmp,
    Div,
    Expr,
    If,
    LaneSum,
    Mul,
    Neg,
    Num,
    Pow,
    Sym,
)

# Binding strengths of the outermost operator of a text, weakest first.
CHOICE, SUM, PRODUCT, UNARY, POWER, ATOM = range(6)

MAX_PLAIN = 24  # longer numbers are written with an exponent
MAX_DECIMAL_PLACES, MAX_PLACES = 20, 341

Piece = tuple[str, int]  # text, and how strongly its outermost operator binds


def compared(left: Piece, op: str, right: Piece) -> str:
    """Return a comparison as most languages write it."""
    return f"{enclose(left, SUM)} {op} {enclose(right, SUM)}"


@final
@dataclass(frozen=True)
class Style:
    """How one language writes the parts of a tree.

    Each function takes the `Piece`s of its operands.
    """

    number: Callable[[Fraction], Piece]
    name: Callable[[str], Piece]
    power: Callable[[Piece, Fraction], Piece]
    call: Callable[[str, tuple[Piece, ...]], Piece]
    choose: Callable[[Piece, str, Piece], Piece]
    lane_sum: Callable[[Piece, str], Piece]
    compare: Callable[[Piece, str, Piece], str] = compared


def enclose(piece: Piece, strength: int) -> str:
    """Return the piece's text, in parentheses if it binds more weakly than `strength`."""
    text, binding = piece
    return text if binding >= strength else f"({text})"


def write(node: Expr, style: Style) -> str:
    """Return `node` as text in the language of `style`."""
    return piece(node, style)[0]


def write_comparison(condition: Cmp, style: Style) -> str:
    """Return a comparison as text in the language of `style`."""
    return style.compare(piece(condition.left, style), condition.op, piece(condition.right, style))


def piece(node: Expr, style: Style) -> Piece:
    """Return `node` as text, with the precedence of its outermost operator."""
    match node:
        case Num(value):
            return style.number(value)
        case Sym(name):
            return style.name(name)
        case Neg(arg):
            return f"-{enclose(piece(arg, style), PRODUCT)}", SUM
        case Add(terms):
            return _sum(terms, style), SUM
        case Mul(left, right):
            pieces = piece(left, style), piece(right, style)
            return f"{enclose(pieces[0], PRODUCT)}*{enclose(pieces[1], UNARY)}", PRODUCT
        case Div(left, right):
            pieces = piece(left, style), piece(right, style)
            return f"{enclose(pieces[0], PRODUCT)}/{enclose(pieces[1], UNARY)}", PRODUCT
        case Pow(base, exponent):
            return style.power(piece(base, style), exponent)
        case Call(function, args):
            return style.call(function, tuple(piece(arg, style) for arg in args))
        case If(then, condition, other):
            test = write_comparison(condition, style)
            return style.choose(piece(then, style), test, piece(other, style))
        case LaneSum(arg, bank):
            return style.lane_sum(piece(arg, style), bank)


def _sum(terms: tuple[Expr, ...], style: Style) -> str:
    first, *rest = terms
    text = enclose(piece(first, style), SUM)
    for term in rest:
        sign, size = signed(term)
        text += f" {sign} {enclose(piece(size, style), PRODUCT)}"
    return text


def signed(term: Expr) -> tuple[str, Expr]:
    """Return the sign and the magnitude of a term of a sum."""
    match term:
        case Neg(arg):
            return "-", arg
        case Num(value) if value < 0:
            return "-", Num(-value)
    return "+", term


def decimal(value: Fraction) -> str | None:
    """Return an exact decimal spelling of a non-negative rational, or None if there is none."""
    places = _places(value, MAX_DECIMAL_PLACES)
    if places is None:
        return None
    digits = str(value.numerator * 10**places // value.denominator).rjust(places + 1, "0")
    return f"{digits[:-places]}.{digits[-places:]}" if places else digits


def scientific(value: Fraction) -> str | None:
    """Return an exact spelling such as ``1.5e-30`` of a positive rational, or None."""
    places = _places(value, MAX_PLACES)
    if places is None:
        return None
    digits = str(value.numerator * 10**places // value.denominator)
    first, rest = digits[0], digits[1:].rstrip("0")
    return f"{first}{'.' if rest else ''}{rest}e{len(digits) - 1 - places}"


def _places(value: Fraction, most: int) -> int | None:
    """Return the number of decimal places of a rational, or None if there are more than `most`."""
    return next((n for n in range(most + 1) if 10**n % value.denominator == 0), None)


def _spec_number(value: Fraction) -> Piece:
    if value < 0:
        return f"-{_spec_number(-value)[0]}", SUM
    text = decimal(value)
    if text is None or len(text) > MAX_PLAIN:
        text = scientific(value)
    return (text, ATOM) if text else (f"{value.numerator}/{value.denominator}", PRODUCT)


def _spec_power(base: Piece, exponent: Fraction) -> Piece:
    text, strength = _spec_number(exponent)
    power = text if strength == ATOM else f"({text})"
    return f"{enclose(base, ATOM)}**{power}", POWER


def _spec_call(function: str, args: tuple[Piece, ...]) -> Piece:
    if function == "pow":
        return f"{enclose(args[0], ATOM)}**{enclose(args[1], ATOM)}", POWER
    return f"{function}({', '.join(text for text, _ in args)})", ATOM


def _spec_choice(then: Piece, test: str, other: Piece) -> Piece:
    return f"{enclose(then, SUM)} if {test} else {enclose(other, SUM)}", CHOICE


SPEC = Style(
    number=_spec_number,
    name=lambda name: (name, ATOM),
    power=_spec_power,
    call=_spec_call,
    choose=_spec_choice,
    lane_sum=lambda arg, bank: (f"sum({arg[0]} over {bank})", ATOM),
)


def spell(node: Expr) -> str:
    """Return `node` in the law language of the spec."""
    return write(node, SPEC)
