"""Functions in C that a step calls: means of exponentials and across kinks.

Input: a text of C.  Output: the definitions of those it calls.
"""

from __future__ import annotations

from collections.abc import Iterator

HELPERS = {
    "phi3": """\
/* (exp(d) - 1 - d - d^2/2)/d^3, by its series where that would cancel. */
static double phi3(double d)
{
    const double size = fabs(d);
    double sum = 0.0;
    if (size < 0x1p-10)
        return 1.0/6.0 + d*(1.0/24.0 + d*(1.0/120.0 + d*(1.0/720.0 + d/5040.0)));
    if (size >= 1.0)
        return (((exp(d) - 1.0)/d - 1.0)/d - 0.5)/d;
    for (int k = 19; k > 2; --k)
        sum = (1.0 + sum)*d/(k + 1);
    return (1.0 + sum)/6.0;
}""",
    "ramp": """\
/* Mean of max(s, 0) for s from a to b. */
static double ramp(double a, double b)
{
    const double top = a > b ? a : b, low = a > b ? b : a;
    return low >= 0.0 ? 0.5 * (a + b) : top <= 0.0 ? 0.0 : 0.5 * top * (top / (top - low));
}""",
    "ramp_by_new": """\
/* Derivative of ramp by b. */
static double ramp_by_new(double a, double b)
{
    const double top = a > b ? a : b, low = a > b ? b : a;
    const double share = top <= 0.0 ? 0.0 : top / (top - low);
    return low >= 0.0 ? 0.5 : b > a ? share - 0.5 * share * share : 0.5 * share * share;
}""",
    "mean_deadzone": """\
/* Mean of deadzone(s, w) for s from a to b, w >= 0. */
static double mean_deadzone(double a, double b, double w)
{
    const double from = a > w ? a - w : a < -w ? a + w : 0.0;
    const double to = b > w ? b - w : b < -w ? b + w : 0.0;
    const double way = fabs(b - a) > 0x1p-1000 ? b - a : 1.0;
    return 0.5 * (from + to) * (from * to > 0.0 ? 1.0 : (to - from) / way);
}""",
    "mean_deadzone_by_new": """\
/* Derivative of mean_deadzone by b. */
static double mean_deadzone_by_new(double a, double b, double w)
{
    const double from = a > w ? a - w : a < -w ? a + w : 0.0;
    const double to = b > w ? b - w : b < -w ? b + w : 0.0;
    const double way = fabs(b - a) > 0x1p-1000 ? b - a : 1.0;
    return from * to > 0.0 ? 0.5 : (to - mean_deadzone(a, b, w)) / way;
}""",
    "mean_deadzone_by_width": """\
/* Derivative of mean_deadzone by w: how much of the way lies below the zone, less that above. */
static double mean_deadzone_by_width(double a, double b, double w)
{
    const double low = a < b ? a : b, top = a < b ? b : a;
    const double way = top - low > 0x1p-1000 ? top - low : 1.0;
    const double above = low > w ? 1.0 : top > w ? (top - w) / way : 0.0;
    const double below = top < -w ? 1.0 : low < -w ? (-w - low) / way : 0.0;
    return below - above;
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
    "mean_tanh": """\
/*
 * Mean of tanh(s) for s from a to b.  Its integral is log(cosh(s)), or |s| + log1p(exp(-2|s|)) less
 * log(2); between close ends it grows by 2 atanh(tanh(middle) tanh(half)).
 */
static double mean_tanh(double a, double b)
{
    const double half = 0.5 * (b - a), middle = 0.5 * (a + b);
    if (fabs(half) < 0x1p-27)
        return tanh(middle);
    if (fabs(half) <= 2.0 || fabs(middle) <= 2.0)
        return atanh(tanh(middle) * tanh(half)) / half;
    const double ends = log1p(exp(-2.0 * fabs(b))) - log1p(exp(-2.0 * fabs(a)));
    return (fabs(b) - fabs(a) + ends) / (b - a);
}""",
    "mean_tanh_by_new": """\
/* Derivative of mean_tanh by b; by its series where the difference would cancel. */
static double mean_tanh_by_new(double a, double b)
{
    const double half = 0.5 * (b - a), t = tanh(0.5 * (a + b)), slope = 1.0 - t * t;
    if (fabs(half) < 0x1p-10)
        return slope * (0.5 - half * (t / 3.0 + half * (1.0 - 3.0 * t * t) / 6.0));
    return (tanh(b) - mean_tanh(a, b)) / (b - a);
}""",
}


def step_helpers(text: str) -> Iterator[str]:
    """Yield the definitions of the functions that a text calls."""
    yield from (definition for name, definition in HELPERS.items() if f"{name}(" in text)
