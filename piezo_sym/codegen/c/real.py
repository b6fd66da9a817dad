"""What the text of a step says of its numbers: ``real``, where nobody has defined it, and powers.

Input: the text.  Output: what stands before it.
"""

from collections.abc import Iterator

from piezo_sym.codegen.c.style import MOST_FACTORS
from piezo_sym.expressions.functions import RECORDS

#: What a text needs of `real` where nobody has defined it: one number.
_REAL = """\
#if !defined(REAL_WIDTH) /* numbers of one run; run/engine has vectors of many */
#define REAL_WIDTH 1
#define ALONE
#if !defined(REAL)
#define REAL double /* or float */
#endif
typedef REAL real;
#define zero 0.0
#define wide(value) (value)
#define chosen(condition, then, other) ((condition) ? (then) : (other))
{functions}
#define pow_of pow
#define is_above(a, b) ((a) > (b))
#define is_at_least(a, b) ((a) >= (b))
#define least(a, b) ((a) < (b) || (a) != (a) ? (a) : (b))
#define OF(value, lane) (value)
#endif"""
REAL = _REAL.replace(
    "{functions}", "\n".join(f"#define {r.in_c}_of {r.in_c}" for r in RECORDS.values() if r.smooth)
)
_POWER = "static inline real power_{n}_of(real z)\n{{\n    return {product};\n}}"


def powers_of(text: str) -> Iterator[str]:
    """Yield the definition of each whole power that a text calls."""
    for n in range(2, MOST_FACTORS + 1):
        if f"power_{n}_of(" in text:
            yield _POWER.format(n=n, product="*".join("z" * n))
