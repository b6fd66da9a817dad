"""Text to a tree: the characters, tokens and grammar of laws.

Input: untrusted text.  Output: a tree, or a `RefusedError`.  Length, characters and nesting are
checked first; then Python's own parser reads the text, and only the nodes of the law language pass.
Numbers are taken from the source text as exact rationals.  Nothing is evaluated by Python.
"""

import ast
import re
from collections.abc import Container
from fractions import Fraction
from functools import cache

from piezo_sym.errors import nearest, quote
from piezo_sym.expressions.functions import FUNCTIONS, RECORDS
from piezo_sym.expressions.incomplete import incomplete, one_by_one, with_a_point
from piezo_sym.expressions.tree import Add, Call, Cmp, Div, Expr, If, Mul, Neg, Num, Pow, Sym, names

LANGUAGE = "numbers, names, + - * / **, (), 'a if x < y else b', or a function as in exp(x)"
#: What to write instead of characters of other languages.
REMEDIES = {
    "^": "write ** for a power",
    "=": "write >= or <= in a condition",
    ".": "write a function by its name alone, as in tanh(v)",
    "|": "write abs(v)",
    "'": "leave it out: there is no transpose, and a rate is a letter or a state, such as v",
}
#: Elementwise operators of other languages.
DOTTED = {".*": "*", "./": "/", ".^": "**"}
MAX_DEPTH = 40
MAX_DIGITS = 40
MAX_LENGTH = 1000
MAX_LENGTH_OF_A_TABLE = 4000
MAX_MAGNITUDE = 300
MAX_PREFIXES = 8
TOKEN = re.compile(
    r"(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)"
    r"|(?P<name>[A-Za-z_][A-Za-z0-9_]*)"
    r"|(?P<operator>\*\*|<=|>=|[-+*/(),<>])"
    r"|(?P<space> +)"
)


class RefusedError(Exception):
    """The reason why a text is no law; the caller, which knows its place, raises a `SpecError`."""

    def __init__(self, what: str, expected: str = "", remedy: str = "") -> None:
        super().__init__(what)
        self.what, self.expected, self.remedy = what, expected, remedy


def check_characters(text: str) -> None:
    """Refuse a text that is too long, empty, or not plain ASCII on one line."""
    most = MAX_LENGTH_OF_A_TABLE if re.search(r"\btable *\(", text) else MAX_LENGTH
    if len(text) > most:
        what = f"is {len(text)} characters long"
        raise RefusedError(what, f"at most {most}", "split the law into parameters")
    if not text.strip():
        raise RefusedError("is empty", "a law, such as 'd*v'")
    odd = next((c for c in text if not " " <= c <= "~"), None)
    if odd is not None:
        what = f"has the character U+{ord(odd):04X}"
        raise RefusedError(what, "plain ASCII on one line", "type the name in Latin letters")


def check_tokens(text: str) -> None:
    """Refuse characters that form no token of the law language, and deep nesting."""
    position = depth = prefixes = 0
    while position < len(text):
        match = TOKEN.match(text, position)
        if match is None:
            what = f"has {quote(text[position])} at column {position + 1}"
            raise RefusedError(what, LANGUAGE, _remedy(text[position : position + 2]))
        token = match.group()
        depth += (token == "(") - (token == ")")
        if match.lastgroup != "space":  # operators in a row
            prefixes = prefixes + 1 if token in {"+", "-", "*", "/", "**"} else 0
        if depth > MAX_DEPTH or prefixes > MAX_PREFIXES:
            raise RefusedError("is nested too deeply", f"at most {MAX_DEPTH} levels")
        if match.lastgroup == "number":
            _check_number(token, text[match.end() : match.end() + 1])
        position = match.end()


def _remedy(odd: str) -> str:
    """Return what to write instead of an unknown operator; `odd` is its first two characters."""
    if odd in DOTTED:
        return f"write {DOTTED[odd]} for {odd}"
    return REMEDIES.get(odd[0], "")


def _check_number(token: str, following: str) -> None:
    if following.isalnum() or following == "_":
        what = f"has a number that runs into {quote(following)}"
        raise RefusedError(what, "a plain decimal number without unit, such as 0.5 or 1e-3")
    mantissa, _, exponent = token.lower().partition("e")
    digits = sum(c.isdigit() for c in mantissa)
    if digits > MAX_DIGITS or abs(int(exponent[:9] or "0")) > MAX_MAGNITUDE:
        what = f"has the number {quote(token)}"
        raise RefusedError(what, f"at most {MAX_DIGITS} digits and 1e+-{MAX_MAGNITUDE}")


MAX_KNOTS = 64
MAX_POWER = 16
#: Names of functions in other languages.
ELSEWHERE = {"ln": "log", "arctan": "atan", "sgn": "sign", "fabs": "abs"}
LARGEST = Fraction(10) ** MAX_MAGNITUDE
SMALLEST = 1 / LARGEST

COMPARE: dict[type[ast.cmpop], str] = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">="}


def read_law(text: str) -> Expr:
    """Return the tree of a law."""
    body = _parsed(text)
    if isinstance(body, ast.Compare):
        raise RefusedError("is a comparison", "a law", "write 'a if x < y else b'")
    return _expression(body, text)


def read_condition(text: str) -> Cmp:
    """Return the tree of one comparison."""
    try:
        if isinstance(body := _parsed(text), ast.Compare):
            return _comparison(body, text)
    except RefusedError:
        if len(text) > MAX_LENGTH or not (remedy := one_by_one(text)):
            raise
        raise RefusedError("is not one comparison", remedy=remedy) from None
    joined = "write 'max(a, b) > 0' for 'a > 0 or b > 0'" if isinstance(body, ast.BoolOp) else ""
    remedy = one_by_one(text) or joined
    raise RefusedError("is not a comparison", "one of < <= > >=, as in 'T > T_0'", remedy)


@cache
def parse_rule(text: str) -> Expr:
    """Return the tree of a trusted text, such as a rule in a function's record, of any size."""
    return read_law(text)


@cache
def parse_clause(text: str) -> tuple[Cmp, ...]:
    """Return the comparisons of a fact in a function's record, at least one of which holds."""
    return tuple(read_condition(part.strip()) for part in text.split("|"))


def _parsed(text: str) -> ast.expr:
    """Return Python's syntax tree of a text, after checks of its characters and tokens."""
    check_characters(text)
    check_tokens(text)
    try:
        body = ast.parse(text.strip(), mode="eval").body
    except (SyntaxError, ValueError, MemoryError, RecursionError):
        what, remedy = incomplete(text)
        raise RefusedError(what, "" if remedy else LANGUAGE, remedy) from None
    if remedy := with_a_point(text) * any(isinstance(n, ast.Tuple) for n in ast.walk(body)):
        raise RefusedError("has a decimal comma", remedy=remedy)
    return body


def _expression(node: ast.expr, text: str, depth: int = 0) -> Expr:
    """Return the tree of a node of Python's syntax; refuse what laws do not have."""
    if depth > MAX_DEPTH:
        raise RefusedError("is nested too deeply", f"at most {MAX_DEPTH} levels")
    match node:
        case ast.Constant():
            return Num(_number(ast.get_source_segment(text.strip(), node) or ""))
        case ast.Name(name):
            return Sym(name)
        case ast.UnaryOp(ast.USub(), operand):
            return Neg(_expression(operand, text, depth + 1))
        case ast.UnaryOp(ast.UAdd(), operand):
            return _expression(operand, text, depth + 1)
        case ast.BinOp(left, operator, right):
            return _binary(left, operator, right, text, depth + 1)
        case ast.IfExp(ast.Compare() as test, then, other):
            parts = _expression(then, text, depth + 1), _expression(other, text, depth + 1)
            return If(parts[0], _comparison(test, text, depth + 1), parts[1])
        case ast.IfExp():
            raise RefusedError("chooses by no comparison", "'a if x < y else b'")
        case ast.Call(ast.Name(function), args, []):
            return _call(function, args, text, depth + 1)
        case ast.Compare():
            raise RefusedError("uses a comparison as a number", "'a if x < y else b'")
    raise RefusedError("is not of the law language", LANGUAGE)


def _number(source: str) -> Fraction:
    match = TOKEN.fullmatch(source)
    if match is None or match.lastgroup != "number":
        raise RefusedError(f"has {quote(source)} where a number should be", "0.5 or 1e-3")
    value = Fraction(source)
    if value and not SMALLEST <= value <= LARGEST:
        raise RefusedError(f"has the number {quote(source)}", f"1e+-{MAX_MAGNITUDE} at most")
    return value


def _binary(left: ast.expr, op: ast.operator, right: ast.expr, text: str, depth: int) -> Expr:
    match op:
        case ast.Add() | ast.Sub():
            return _sum(left, op, right, text, depth)
        case ast.Mult():
            return Mul(_expression(left, text, depth), _expression(right, text, depth))
        case ast.Div():
            return Div(_expression(left, text, depth), _expression(right, text, depth))
        case ast.Pow():
            return _power(_expression(left, text, depth), _expression(right, text, depth))
    raise RefusedError("uses an operator that laws do not have", LANGUAGE)


def _sum(left: ast.expr, op: ast.operator, right: ast.expr, text: str, depth: int) -> Expr:
    """Return ``a + b - c ...`` as one sum, without recursion: a long sum is not deep."""
    backwards: list[Expr] = []
    while True:
        term = _expression(right, text, depth)
        backwards.append(Neg(term) if isinstance(op, ast.Sub) else term)
        if not (isinstance(left, ast.BinOp) and isinstance(left.op, (ast.Add, ast.Sub))):
            break
        op, right, left = left.op, left.right, left.left
    backwards.append(_expression(left, text, depth))
    return Add(tuple(reversed(backwards)))


#: Letters of variables; exponents may have parameters only.
LETTERS = frozenset({"i", "v", "f", "T"})


def _power(base: Expr, exponent: Expr) -> Expr:
    if LETTERS & {*names(exponent)}:
        exponential = "write exp(x) for e**x" * (base == Sym("e"))
        what = "has a power that is not a number"
        raise RefusedError(what, "a small number, as in v**2", exponential)
    if names(exponent) and not isinstance(exponent, Neg) and may_vanish(base):
        return Call("pow", (base, exponent))
    if names(exponent):  # the base is positive; log refuses one that has a unit
        return Call("exp", (Mul(exponent, Call("log", (base,))),))
    value = _rational(exponent)
    if value is None or max(abs(value.numerator), value.denominator) > MAX_POWER:
        raise RefusedError("has too large a power", f"whole numbers or p/q up to {MAX_POWER}")
    return Pow(base, value)


def may_vanish(base: Expr, kinked: Container[str] = ()) -> bool:
    """Return whether a factor has kinks, as abs(f/f_0), so that the base of a power may be 0.

    `kinked` are names whose values have.
    """
    match base:
        case Mul(left, right):
            return may_vanish(left, kinked) or may_vanish(right, kinked)
        case Div(left, _):
            return may_vanish(left, kinked)
        case Sym(name):
            return name in kinked
    chooses = isinstance(base, Call) and not RECORDS[base.function].smooth
    return chooses or isinstance(base, If) or (isinstance(base, Call) and base.function == "pow")


def _rational(node: Expr) -> Fraction | None:
    """Return the value of an exponent that is a number, minus one, or a quotient; else None."""
    match node:
        case Num(value):
            return value
        case Neg(arg):
            inner = _rational(arg)
            return None if inner is None else -inner
        case Div(left, right):
            top, bottom = _rational(left), _rational(right)
            return top / bottom if top is not None and bottom else None
    return None


def _comparison(node: ast.Compare, text: str, depth: int = 0) -> Cmp:
    if len(node.ops) != 1:
        raise RefusedError("chains comparisons", "one comparison at a time")
    op = COMPARE.get(type(node.ops[0]))
    if op is None:
        raise RefusedError("compares in a way that laws do not have", "one of < <= > >=")
    left = _expression(node.left, text, depth + 1)
    return Cmp(op, left, _expression(node.comparators[0], text, depth + 1))


def _call(function: str, args: list[ast.expr], text: str, depth: int) -> Expr:
    if function not in FUNCTIONS:
        known = nearest(ELSEWHERE.get(function, function), FUNCTIONS)
        raise RefusedError(f"calls {quote(function)}, which laws do not have", remedy=known)
    count, what = len(FUNCTIONS[function].slopes), f"gives {function} {len(args)} arguments"
    if FUNCTIONS[function].knots:
        if len(args) % 2 == 0 or not 2 <= len(args) // 2 <= MAX_KNOTS:
            expected = f"{function}(x, x_1, y_1, x_2, y_2, ...) with 2 to {MAX_KNOTS} knots"
            raise RefusedError(what, expected, "give each x_k its y_k")
    elif len(args) != count:
        raise RefusedError(what, f"{count}", with_a_point(text))
    return Call(function, tuple(_expression(arg, text, depth) for arg in args))
