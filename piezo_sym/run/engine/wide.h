/*
 * Vectors of numbers, one of each of WIDTH states that are computed side by side, and the functions
 * that a step calls on them.  For compilers with vector extensions (gcc, clang).
 */
#include <math.h>
#include <string.h>

#if defined(PAIR) /* one member alone: two lanes, for its tracks */
enum { WIDTH = 2 };
#define LANES(of) of(0), of(1)
#elif defined(__AVX512F__)
enum { WIDTH = 8 };
#define LANES(of) of(0), of(1), of(2), of(3), of(4), of(5), of(6), of(7)
#elif defined(__AVX__)
enum { WIDTH = 4 };
#define LANES(of) of(0), of(1), of(2), of(3)
#else
enum { WIDTH = 2 };
#define LANES(of) of(0), of(1)
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
#define NUMBER(lane) row[lane][i]
    return (real){LANES(NUMBER)};
#undef NUMBER
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
