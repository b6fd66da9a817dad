"""Functions in C that a step calls: means of exponentials and across kinks, and elimination.

Input: a text of C.  Output: the definitions of those it calls.
"""

from __future__ import annotations

from collections.abc import Iterator

HELPERS = {
    "phi2": """\
/* (exp(d) - 1 - d)/d^2, by its series where that would cancel. */
static double phi2(double d)
{
    double sum = 0.0;
    if (fabs(d) < 0.03125)
        return 0.5 + d*(1.0/6.0 + d*(1.0/24.0 + d*(1.0/120.0 + d*(1.0/720.0 + d*(1.0/5040.0
            + d*(1.0/40320.0 + d*(1.0/362880.0 + d/3628800.0)))))));
    if (fabs(d) >= 1.0)
        return ((exp(d) - 1.0)/d - 1.0)/d;
    for (int k = 19; k > 1; --k)
        sum = (1.0 + sum)*d/(k + 1);
    return 0.5*(1.0 + sum);
}""",
    "phi1": """\
/* (exp(d) - 1)/d */
static double phi1(double d)
{
    return fabs(d) < 0.03125 ? 1.0 + d*phi2(d) : expm1(d)/d;
}""",
    "phi3": """\
/* (phi2(d) - 1/2)/d */
static double phi3(double d)
{
    double sum = 0.0;
    if (fabs(d) < 0.03125)
        return 1.0/6.0 + d*(1.0/24.0 + d*(1.0/120.0 + d*(1.0/720.0 + d*(1.0/5040.0
            + d*(1.0/40320.0 + d*(1.0/362880.0 + d/3628800.0))))));
    if (fabs(d) >= 1.0)
        return (phi2(d) - 0.5)/d;
    for (int k = 19; k > 2; --k)
        sum = (1.0 + sum)*d/(k + 1);
    return (1.0 + sum)/6.0;
}""",
    "ramp": """\
/* Mean of max(s, 0) for s from a to b. */
static double ramp(double a, double b)
{
    const double top = a > b ? a : b, low = a > b ? b : a;
    return low >= 0.0 ? 0.5 * (a + b) : top <= 0.0 ? 0.0 : 0.5 * top * top / (top - low);
}""",
    "ramp_by_new": """\
/* Derivative of ramp by b. */
static double ramp_by_new(double a, double b)
{
    const double top = a > b ? a : b, low = a > b ? b : a;
    const double share = top <= 0.0 ? 0.0 : top / (top - low);
    return low >= 0.0 ? 0.5 : b > a ? share - 0.5 * share * share : 0.5 * share * share;
}""",
    "mean_sign": """\
/* Mean of the sign of s for s from a to b. */
static double mean_sign(double a, double b)
{
    const double same = a > 0.0 ? 1.0 : a < 0.0 ? -1.0 : b > 0.0 ? 1.0 : b < 0.0 ? -1.0 : 0.0;
    return a * b >= 0.0 ? same : (fabs(b) - fabs(a)) / (b - a);
}""",
    "mean_sign_by_new": """\
/* Derivative of mean_sign by b. */
static double mean_sign_by_new(double a, double b)
{
    return a * b >= 0.0 ? 0.0 : 2.0 * fabs(a) / ((b - a) * (b - a));
}""",
}
SOLVE = """\
/* Solve a*y = b for y, in place of b, by elimination with pivots; 0 if a is singular. */
static int {name}(double *restrict a, double *restrict b)
{{
    enum {{ size = {size} }};
    for (int k = 0; k < size; ++k) {{
        int best = k;
        for (int i = k + 1; i < size; ++i)
            best = fabs(a[i * size + k]) > fabs(a[best * size + k]) ? i : best;
        const double pivot = a[best * size + k];
        if (!(fabs(pivot) > 0.0))
            return 0;
        if (best != k) {{
            for (int j = k; j < size; ++j) {{
                const double kept = a[k * size + j];
                a[k * size + j] = a[best * size + j];
                a[best * size + j] = kept;
            }}
            const double kept = b[k];
            b[k] = b[best];
            b[best] = kept;
        }}
        for (int i = k + 1; i < size; ++i) {{
            const double share = a[i * size + k] / pivot;
            for (int j = k + 1; j < size; ++j)
                a[i * size + j] -= share * a[k * size + j];
            b[i] -= share * b[k];
        }}
    }}
    for (int k = size - 1; k >= 0; --k) {{
        for (int j = k + 1; j < size; ++j)
            b[k] -= a[k * size + j] * b[j];
        b[k] /= a[k * size + k];
    }}
    return 1;
}}"""


def step_helpers(text: str) -> Iterator[str]:
    """Yield the definitions of the functions that a text calls, each before it is needed."""
    used = {name for name in HELPERS if f"{name}(" in text}
    used |= {"phi2"} if used & {"phi1", "phi3"} else set()
    yield from (definition for name, definition in HELPERS.items() if name in used)
