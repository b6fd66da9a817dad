"""The spelling of names and expressions in C.

Input: the names of a program; a tree and the C names of its symbols.  Output: the C name of each:
the name itself, or with an underscore if it is a keyword, a macro of a header or a called function
(the header may be included beside others, and in C++: their macros and keywords are avoided, too);
one line of C99.  Small whole powers are products, choices are calls of ``pick``, and a quotient of
numbers stays a quotient: it is rounded once, as in NumPy.  `helpers` defines the functions that a
text calls and <math.h> lacks.
"""

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction

from piezo_sym.codegen.program import Names, Program
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
from piezo_sym.spec.names import fresh

_CPLUSPLUS = """alignas alignof and and_eq asm bitand bitor catch char8_t char16_t char32_t class
co_await co_return co_yield compl concept const_cast consteval constexpr constinit decltype delete
dynamic_cast explicit export friend module mutable namespace new noexcept not not_eq nullptr
operator or or_eq private protected public reinterpret_cast requires static_assert static_cast
template this thread_local throw try typeid typename typeof typeof_unqual using virtual wchar_t xor
xor_eq"""
_MACROS = """assert complex errno imaginary I linux unix i386 far near small hyper interface min max
stdin stdout stderr offsetof va_list signbit NULL EOF BUFSIZ ERROR TRUE FALSE IN OUT INFINITY NAN
HUGE HUGE_VAL HUGE_VALF HUGE_VALL DOMAIN SING OVERFLOW UNDERFLOW PLOSS TLOSS MAXFLOAT EDOM ERANGE
EILSEQ MATH_ERRNO MATH_ERREXCEPT math_errhandling FP_NAN FP_INFINITE FP_ZERO FP_NORMAL FP_SUBNORMAL
FP_FAST_FMA FP_FAST_FMAF FP_FAST_FMAL FP_ILOGB0 FP_ILOGBNAN M_E M_LOG2E M_LOG10E M_LN2 M_LN10 M_PI
M_PI_2 M_PI_4 M_1_PI M_2_PI M_2_SQRTPI M_SQRT2 M_SQRT1_2 L_tmpnam FILENAME_MAX FOPEN_MAX TMP_MAX
SEEK_SET SEEK_CUR SEEK_END RAND_MAX EXIT_SUCCESS EXIT_FAILURE MB_CUR_MAX CHAR_BIT CHAR_MIN CHAR_MAX
SCHAR_MIN SCHAR_MAX UCHAR_MAX SHRT_MIN SHRT_MAX USHRT_MAX INT_MIN INT_MAX UINT_MAX LONG_MIN LONG_MAX
ULONG_MAX LLONG_MIN LLONG_MAX ULLONG_MAX SIZE_MAX FLT_RADIX DECIMAL_DIG SIGABRT SIGFPE SIGILL SIGINT
SIGSEGV SIGTERM SIG_DFL SIG_ERR SIG_IGN CLOCKS_PER_SEC"""
_FLOATS = "DIG EPSILON MANT_DIG MAX MAX_10_EXP MAX_EXP MIN MIN_10_EXP MIN_EXP"
#: The functions that generated code calls, besides those of laws.
_CALLED = "copysign expm1 fabs pow " + " ".join(f"power_{n}" for n in range(2, 9))
#: The names that a step's text and the engine's text behind it define.
_REALS = (
    "PLAIN MODEL REAL_WIDTH WIDEST WIDTH VECTORS LANE OF SET LANES NUMBER FUNCTION RADICAND "
    "NOT_PROVED COSTATES BENDS PATHS ALONE REAL real mask pattern few four zero "
    "nowhere wide chosen any none_of size_of with_sign power_of_two small_expm1 reduced is_above "
    "roots_of ROUNDING_AS_SET turned_sin turned_or MOST_TURNED is_at_least pow_of whole_power "
    "least largest_of bits_of real_of pick deadzone saturate sign"
)
_ENDS = (
    *("parameters", "states", "processes", "jacobian", "margins"),
    *("input_count", "output_count", "body_count", "condition_count"),
)

#: The end of the name of a function that computes a part of another.
PART = re.compile(r"_part_\d+$")
KEPT = (
    frozenset(f"{_CPLUSPLUS} {_MACROS} {_CALLED} {_REALS}".split())
    | {f"{kind}_{word}" for kind in ("FLT", "DBL", "LDBL") for word in _FLOATS.split()}
    | {f"{record.in_c}_of" for record in RECORDS.values() if record.smooth}
    | {f"{word}{end}" for word in ("M_PI", "M_E", "M_SQRT2", "M_LN2") for end in ("l", "f")}
)

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


def c_names(program: Program) -> dict[str, str]:
    """Return the C name of each name of a program; no two are the same."""
    functions = (function.name for function in program.functions)
    reserved = KEPT | {f"{program.name}_{end}" for end in (*functions, *_ENDS)}
    taken = {*program.taken, *reserved}
    names: dict[str, str] = {}
    words = [field.name for field in (*program.parameters, *program.inputs, *program.states)]
    words += [f"{bank}_count" for bank in program.counts]
    words += [quantity.name for quantity in program.quantities]
    for word in dict.fromkeys(words):
        part = word.startswith(f"{program.name}_") and PART.search(word)
        names[word] = fresh(word, taken) if part or word in reserved else word
        taken.add(names[word])
    return names


def fresh_names(words: Iterable[str], program: Program, names: Mapping[str, str]) -> dict[str, str]:
    """Return unused names for the printer's own variables."""
    new = Names((*program.taken, *names.values(), *KEPT))
    return {word: new(word) for word in words}


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
