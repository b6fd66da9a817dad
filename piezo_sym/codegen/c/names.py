"""Names in C: those of the spec, unless they are keywords, macros of headers or called functions.

Input: the names of a program.  Output: the C name of each: the name itself, or with an underscore.
The header may be included beside others, and in C++: their macros and keywords are avoided, too.
"""

import re
from collections.abc import Iterable, Mapping

from piezo_sym.codegen.program import Names, Program
from piezo_sym.expressions.functions import RECORDS
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
