/*
 * Vectors of numbers, one of each of WIDTH states that are computed side by side, and the functions
 * that a step calls on them.  For compilers with vector extensions (gcc, clang).
 */
#include <math.h>
#include <string.h>

#if defined(PAIR) /* one member alone: two lanes, for its tracks */
enum { WIDTH = 2 };
#elif defined(__AVX512F__)
enum { WIDTH = 8 };
#elif defined(__AVX__)
enum { WIDTH = 4 };
#else
enum { WIDTH = 2 };
#endif
typedef double real __attribute__((vector_size(8 * WIDTH), may_alias));
#if defined(__SIZEOF_LONG__) && __SIZEOF_LONG__ == 8
typedef long bits; /* what a comparison of doubles gives */
#else
typedef long long bits;
#endif
typedef bits mask __attribute__((vector_size(8 * WIDTH), may_alias)); /* 0, or -1: all bits */
typedef unsigned long long pattern __attribute__((vector_size(8 * WIDTH), may_alias));
typedef signed char few __attribute__((vector_size(WIDTH))); /* a mask in one number */

static const real zero = {0.0};
static const mask nowhere = {0};
#define everywhere (nowhere - 1)

/* A number or a vector as a vector, unchanged: x - 0 is x, also for -0. */
#define wide(value) ((value) - zero)

static inline real chosen(mask where, real a, real b)
{
    return (real)((where & (mask)a) | (~where & (mask)b));
}

static inline mask lane_of(int k)
{
    mask where = nowhere;
    where[k] = -1;
    return where;
}

/*
 * Number i of each lane's row.  As one expression: what is written lane by lane and read as a vector
 * at once has to wait until it has come to the cache.
 */
static inline real gathered(const double *const *row, long i)
{
#if defined(PAIR) || !defined(__AVX__)
    return (real){row[0][i], row[1][i]};
#elif defined(__AVX512F__)
    return (real){row[0][i], row[1][i], row[2][i], row[3][i],
                  row[4][i], row[5][i], row[6][i], row[7][i]};
#else
    return (real){row[0][i], row[1][i], row[2][i], row[3][i]};
#endif
}

static inline int any(mask where)
{
    const few small = __builtin_convertvector(where, few);
    unsigned long long found = 0;
    memcpy(&found, &small, WIDTH);
    return found != 0;
}

static inline real size_of(real a)
{
    const mask sign = (mask)wide(-0.0);
    return (real)((mask)a & ~sign);
}

static inline real with_sign(real a, real b)
{
    const mask sign = (mask)wide(-0.0);
    return (real)(((mask)a & ~sign) | ((mask)b & sign));
}

/*
 * 1/a for a from 1e-300 to 1e300, within a nineteenth: the bits of a number are nearly its logarithm,
 * and the constant is nearly twice those of 1.  If a is infinite, it is negative.
 */
static inline real about_per(real a)
{
    return (real)(0x7fde623822fc16e6ull - (pattern)a);
}

/* 2^k for whole k from -1022 to 1023, given as k + 0x1.8p52. */
static inline real power_of_two(real k)
{
    const mask exponent = (mask)k - (mask)wide(0x1.8p52) + 1023;
    return (real)(exponent << 52);
}

/* exp(r) - 1 for |r| <= log(2)/2, by its series; in pairs of terms, so that few wait for others. */
static inline real small_expm1(real r)
{
    const real r2 = r * r, r4 = r2 * r2, r8 = r4 * r4;
    const real from_3 = (1.0 / 6.0 + r * (1.0 / 24.0)) + r2 * (1.0 / 120.0 + r * (1.0 / 720.0));
    const real from_7 = (1.0 / 5040.0 + r * (1.0 / 40320.0))
        + r2 * (1.0 / 362880.0 + r * (1.0 / 3628800.0));
    const real from_11 = (1.0 / 39916800.0 + r * (1.0 / 479001600.0)) + r2 * (1.0 / 6227020800.0);
    return r + r2 * (0.5 + r * (from_3 + r4 * from_7 + r8 * from_11));
}

/* exp(d) = 2^k (1 + e); returns e, and 2^k in scale; d from -708 to 709. */
static inline real reduced(real d, real *scale)
{
    const real shifted = d * 0x1.71547652b82fep0 + 0x1.8p52;
    const real k = shifted - 0x1.8p52;
    const real r = (d - k * 0x1.62e42fefa3800p-1) - k * 0x1.ef35793c76730p-45;
    *scale = power_of_two(shifted);
    return small_expm1(r);
}

static inline real exp_of(real d)
{
    real scale;
    const real inner = chosen(d > 709.0, wide(709.0), chosen(d < -708.0, wide(-708.0), d));
    const real e = reduced(inner, &scale);
    return chosen(d > 709.0, wide(HUGE_VAL), chosen(d < -708.0, zero, scale + scale * e));
}

static inline real expm1_of(real d)
{
    real scale;
    const real inner = chosen(d > 709.0, wide(709.0), chosen(d < -40.0, wide(-40.0), d));
    const real e = reduced(inner, &scale);
    return chosen(d > 709.0, wide(HUGE_VAL), scale * e + (scale - 1.0));
}

#define LANE_BY_LANE(name, function)                                                               \
    static inline real name(real a)                                                                \
    {                                                                                              \
        real found;                                                                                \
        for (int lane = 0; lane < WIDTH; ++lane)                                                   \
            found[lane] = function(a[lane]);                                                       \
        return found;                                                                              \
    }
LANE_BY_LANE(sqrt_of, sqrt)
LANE_BY_LANE(log_of, log)
LANE_BY_LANE(sin_of, sin)
LANE_BY_LANE(cos_of, cos)
LANE_BY_LANE(log1p_of, log1p)
LANE_BY_LANE(atanh_of, atanh)

static inline real tanh_of(real z)
{
    const real e = expm1_of(-2.0 * size_of(z));
    return with_sign(-e / (e + 2.0), z);
}

static inline real pow_of(real a, real b)
{
    real found;
    for (int lane = 0; lane < WIDTH; ++lane)
        found[lane] = pow(a[lane], b[lane]);
    return found;
}

static inline real whole_power(real z, int n)
{
    real product = z;
    for (int k = 1; k < n; ++k)
        product *= z;
    return product;
}

static inline real least(real a, real b)
{
    return chosen((a < b) | (a != a), a, b);
}

static inline real largest(real a, real b)
{
    return chosen((a > b) | (a != a), a, b);
}

static inline real sign_of(real z)
{
    return chosen(z > 0.0, wide(1.0), chosen(z < 0.0, wide(-1.0), z));
}

static inline real deadzone_of(real z, real w)
{
    return chosen(z > w, z - w, chosen(z < -w, z + w, z - z));
}

static inline real saturate_of(real z, real w)
{
    return chosen(z > w, w, chosen(z < -w, -w, z));
}

/* (exp(d) - 1 - d - d^2/2)/d^3 */
static inline real phi3_of(real d)
{
    const real size = size_of(d);
    const real near = 1.0 / 6.0
        + d * (1.0 / 24.0 + d * (1.0 / 120.0 + d * (1.0 / 720.0 + d * (1.0 / 5040.0))));
    if (!any(size >= 0x1p-10))
        return near;
    real sum = zero;
    for (int k = 19; k > 2; --k)
        sum = (1.0 + sum) * d / (double)(k + 1);
    sum = (1.0 + sum) / 6.0;
    const real far = (((exp_of(d) - 1.0) / d - 1.0) / d - 0.5) / d;
    return chosen(size < 0x1p-10, near, chosen(size >= 1.0, far, sum));
}

/* How much of the way from low to top lies above zero, if top does. */
static inline real share_above(real low, real top)
{
    return chosen(top <= 0.0, zero, chosen(low >= 0.0, wide(1.0), top / (top - low)));
}

/* Mean of max(s, 0) for s from a to b, and its derivative by b. */
static inline real ramp_of(real a, real b)
{
    const real top = chosen(a > b, a, b), low = chosen(a > b, b, a);
    return chosen(low >= 0.0, 0.5 * (a + b), 0.5 * top * share_above(low, top));
}

static inline real ramp_by_new_of(real a, real b)
{
    const real top = chosen(a > b, a, b), low = chosen(a > b, b, a);
    const real share = share_above(low, top), half = 0.5 * share * share;
    return chosen(low >= 0.0, wide(0.5), chosen(b > a, share - half, half));
}

/* How far z lies beyond a zone from -w to w. */
static inline real beyond_of(real z, real w)
{
    const real low = chosen(z < -w, -w, z);
    return z - chosen(low > w, w, low);
}

/* How far b is from a, or 1 if that is next to nothing. */
static inline real way_of(real a, real b)
{
    return chosen(size_of(b - a) > 0x1p-1000, b - a, wide(1.0));
}

/* Mean of deadzone(s, w) for s from a to b, w >= 0, and its derivatives by b and by w. */
static inline real mean_deadzone_of(real a, real b, real w)
{
    const real from = beyond_of(a, w), to = beyond_of(b, w);
    const real per_way = 1.0 / way_of(a, b);
    const real share = chosen(from * to > 0.0, wide(1.0), (to - from) * per_way);
    return 0.5 * (from + to) * share;
}

static inline real mean_deadzone_by_new_of(real a, real b, real w)
{
    const real from = beyond_of(a, w), to = beyond_of(b, w);
    const real per_way = 1.0 / way_of(a, b);
    return chosen(from * to > 0.0, wide(0.5), (to - mean_deadzone_of(a, b, w)) * per_way);
}

static inline real mean_deadzone_by_width_of(real a, real b, real w)
{
    const real top = chosen(a > b, a, b), low = chosen(a > b, b, a);
    return share_above(-top - w, -low - w) - share_above(low - w, top - w);
}

static inline real mean_sign_of(real a, real b)
{
    const real same = chosen(a != 0.0, sign_of(a), sign_of(b));
    return chosen(a * b >= 0.0, same, (size_of(b) - size_of(a)) / (b - a));
}

static inline real mean_sign_by_new_of(real a, real b)
{
    return chosen(a * b >= 0.0, zero, 2.0 * size_of(a) / ((b - a) * (b - a)));
}

/* log(cosh(s)) - |s| + log(2) */
static inline real bend_of(real s)
{
    return log1p_of(exp_of(-2.0 * size_of(s)));
}

/* Mean of tanh(s) for s from a to b, and its derivative by b. */
static inline real mean_tanh_of(real a, real b)
{
    const real half = 0.5 * (b - a), middle = 0.5 * (a + b), t = tanh_of(middle);
    const mask close = (size_of(half) <= 2.0) | (size_of(middle) <= 2.0);
    const mask one = size_of(half) < 0x1p-27;
    const real near = atanh_of(chosen(close, t * tanh_of(half), zero)) / half;
    if (!any(~close))
        return chosen(one, t, near);
    const real far = (size_of(b) - size_of(a) + bend_of(b) - bend_of(a)) / (b - a);
    return chosen(one, t, chosen(close, near, far));
}

static inline real mean_tanh_by_new_of(real a, real b)
{
    const real half = 0.5 * (b - a), t = tanh_of(0.5 * (a + b)), slope = 1.0 - t * t;
    const real near = slope * (0.5 - half * (t / 3.0 + half * (1.0 - 3.0 * t * t) / 6.0));
    return chosen(size_of(half) < 0x1p-10, near, (tanh_of(b) - mean_tanh_of(a, b)) / (b - a));
}
