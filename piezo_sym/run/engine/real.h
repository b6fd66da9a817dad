/*
 * The number type `real`: a double for one run, or a vector of REAL_WIDTH doubles with one lane for
 * each of as many runs; and the functions that a step calls on it. The files included after this
 * one compile for every width, and give a run the same numbers to the bit, whichever runs share its
 * vectors.
 */
#include <math.h>
#include <stdint.h>
#include <string.h>

/* The lanes of the processor's vectors. */
#if defined(__AVX512F__)
#define WIDEST 8
#elif defined(__AVX__)
#define WIDEST 4
#else
#define WIDEST 2
#endif
/* LANES lanes for the stages of one run are in vectors of this many: see gaps_at_once.c. */
#define WIDTH (LANES < WIDEST ? LANES : WIDEST)
#define VECTORS (LANES / WIDTH)

#if !defined(REAL_WIDTH)
#define REAL_WIDTH WIDEST
#endif

#if REAL_WIDTH == 1
typedef double real;
typedef int mask; /* 0 or 1 */
typedef uint64_t pattern;
#define zero 0.0
#define nowhere 0
#define wide(value) (value)
#define chosen(where, then, other) ((where) ? (then) : (other))
#define any(where) (where)

static inline real size_of(real a)
{
    return fabs(a);
}

static inline pattern bits_of(real a)
{
    pattern found;
    memcpy(&found, &a, sizeof a);
    return found;
}

static inline real real_of(pattern a)
{
    real found;
    memcpy(&found, &a, sizeof a);
    return found;
}
#else
typedef double real __attribute__((vector_size(8 * REAL_WIDTH), may_alias));
typedef int64_t mask __attribute__((vector_size(8 * REAL_WIDTH), may_alias)); /* 0, or all bits */
typedef uint64_t pattern __attribute__((vector_size(8 * REAL_WIDTH), may_alias));
typedef signed char few __attribute__((vector_size(REAL_WIDTH)));

static const real zero = {0.0};
static const mask nowhere = {0};

/* A scalar or a vector as a vector. Subtracting zero changes nothing, not even -0. */
#define wide(value) ((real)((value) - zero))

/* GCC finds no single instruction for these by itself. */
#if REAL_WIDTH == 4 && defined(__AVX__) && !defined(__clang__)
static inline real chosen(mask where, real then, real other)
{
    return (real)__builtin_ia32_blendvpd256(other, then, (real)where);
}

static inline int any(mask where)
{
    typedef long long four __attribute__((vector_size(32)));
    return !__builtin_ia32_ptestz256((four)where, (four)where);
}
#else
static inline real chosen(mask where, real then, real other)
{
    return (real)((where & (mask)then) | (~where & (mask)other));
}

static inline int any(mask where)
{
    const few small = __builtin_convertvector(where, few);
    uint64_t found = 0;
    memcpy(&found, &small, REAL_WIDTH);
    return found != 0;
}
#endif

static inline real size_of(real a)
{
    return (real)((mask)a & ~(mask)wide(-0.0));
}

#define bits_of(a) ((pattern)(a))
#define real_of(a) ((real)(a))
#endif

#define is_above(a, b) ((a) > (b))
#define is_at_least(a, b) ((a) >= (b))
#define none_of(where) ((mask)((where) == nowhere))

/* One lane of a vector, of an array of vectors, and of a mask. */
#define OF(value, lane) (((double *)&(value))[lane])
#define LANE(array, i, lane) (((double *)(array))[(i) * REAL_WIDTH + (lane)])
#if REAL_WIDTH == 1
#define SET(where, lane, value) ((where) = (value))
#define IN(where, lane) (where)
#else
#define SET(where, lane, value) ((where)[lane] = -(int64_t)(value))
#define IN(where, lane) ((where)[lane] != 0)
#endif

/* 2^k for an integer k from -1022 to 1023, given as k + 0x1.8p52: its low bits are those of k. */
static inline real power_of_two(real k)
{
    const pattern exponent = bits_of(k) - bits_of(wide(0x1.8p52)) + 1023;
    return real_of(exponent << 52);
}

/* exp(r) - 1 for |r| <= log(2)/2: Taylor series, in groups that do not wait for one another. */
static inline real small_expm1(real r)
{
    const real r2 = r * r, r4 = r2 * r2, r8 = r4 * r4;
    const real from_3 = (1.0 / 6.0 + r * (1.0 / 24.0)) + r2 * (1.0 / 120.0 + r * (1.0 / 720.0));
    const real from_7 = (1.0 / 5040.0 + r * (1.0 / 40320.0))
        + r2 * (1.0 / 362880.0 + r * (1.0 / 3628800.0));
    const real from_11 = (1.0 / 39916800.0 + r * (1.0 / 479001600.0)) + r2 * (1.0 / 6227020800.0);
    return r + r2 * (0.5 + r * (from_3 + r4 * from_7 + r8 * from_11));
}

/* exp(d) = 2^k (1 + e) for d from -708 to 709; returns e, and 2^k in `scale`. */
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

/*
 * log(a) = k log(2) + log(m) with m from sqrt(1/2) to sqrt(2), by the series of log((1 + s)/(1 - s)),
 * |s| < 0.172. Of numbers that are no usual ones, zero to infinity among them, the library knows it.
 */
static inline real log_of(real a)
{
    const pattern bits = bits_of(a) - 0x3fe6a09e667f3bcd, kept = bits & 0x000fffffffffffff;
    const real k = real_of((bits >> 52) + 0x4338000000000000) - 0x1.8p52;
    const real e = k - chosen(k > 1024.0, wide(4096.0), zero);
    const real m = real_of(kept + 0x3fe6a09e667f3bcd);
    const real s = (m - 1.0) / (m + 1.0), s2 = s * s, s4 = s2 * s2, s8 = s4 * s4;
    const real from_3 = (2.0 / 3.0 + s2 * (2.0 / 5.0)) + s4 * (2.0 / 7.0 + s2 * (2.0 / 9.0));
    const real from_11 = (2.0 / 11.0 + s2 * (2.0 / 13.0)) + s4 * (2.0 / 15.0 + s2 * (2.0 / 17.0));
    const real from_19 = 2.0 / 19.0 + s2 * (2.0 / 21.0);
    const real small = s * s2 * (from_3 + s8 * (from_11 + s8 * from_19)) + e * 0x1.ef35793c76730p-45;
    real found = e * 0x1.62e42fefa3800p-1 + (2.0 * s + small);
    const mask unusual = none_of((a >= 0x1p-1022) & (a < HUGE_VAL));
    for (int lane = 0; lane < REAL_WIDTH && any(unusual); ++lane)
        if (IN(unusual, lane))
            LANE(&found, 0, lane) = log(LANE(&a, 0, lane));
    return found;
}

static inline real tanh_of(real z)
{
    const real e = expm1_of(-2.0 * size_of(z)), found = -e / (e + 2.0);
    return chosen(z < 0.0, -found, chosen(z == 0.0, z, found));
}

/*
 * Sine and cosine of y + q pi/2 with the nearest integer q, by Taylor series of y, |y| <= pi/4. Halves of pi
 * are taken off in three parts, of which the first two have few enough bits that q times them is exact.
 */
static inline real turned_sin(real a, uint64_t quarters)
{
    const real shifted = a * 0x1.45f306dc9c883p-1 + 0x1.8p52, q = shifted - 0x1.8p52;
    const real y = ((a - q * 0x1.921fb54400000p+0) - q * 0x1.0b4611a600000p-34) - q * 0x1.3198a2e037073p-69;
    const real y2 = y * y, y4 = y2 * y2, y8 = y4 * y4;
    const real from_3 = (-1.0 / 6.0 + y2 * (1.0 / 120.0)) + y4 * (-1.0 / 5040.0 + y2 * (1.0 / 362880.0));
    const real from_11 = (-1.0 / 39916800.0 + y2 * (1.0 / 6227020800.0))
        + y4 * (-1.0 / 1307674368000.0 + y2 * (1.0 / 355687428096000.0));
    const real from_4 = (1.0 / 24.0 + y2 * (-1.0 / 720.0)) + y4 * (1.0 / 40320.0 + y2 * (-1.0 / 3628800.0));
    const real from_12 = (1.0 / 479001600.0 + y2 * (-1.0 / 87178291200.0)) + y4 * (1.0 / 20922789888000.0);
    const real sine = y + y * y2 * (from_3 + y8 * from_11);
    const real cosine = 1.0 - (0.5 * y2 - y4 * (from_4 + y8 * from_12));
    const pattern q_bits = bits_of(shifted) + quarters;
    const mask odd = (q_bits & 1) == 1, negative = (q_bits & 2) == 2;
    const real size = chosen(odd, cosine, sine);
    return chosen(negative, -size, size);
}

/* Beyond this, the parts of pi have too few bits: the library knows the function there. */
#define MOST_TURNED 1e6

static inline real turned_or(real a, uint64_t quarters, double (*function)(double))
{
    real found = turned_sin(a, quarters);
    for (int lane = 0; lane < REAL_WIDTH && any(size_of(a) > MOST_TURNED); ++lane)
        if (fabs(LANE(&a, 0, lane)) > MOST_TURNED)
            LANE(&found, 0, lane) = function(LANE(&a, 0, lane));
    return found;
}

static inline real sin_of(real a)
{
    return turned_or(a, 0, sin);
}

static inline real cos_of(real a)
{
    return turned_or(a, 1, cos);
}

/* The other functions, lane after lane: c_sources.py adds a line per function, from its record. */
#define FUNCTION(function, slope)                                                                  \
    static inline real function##_of(real a)                                                       \
    {                                                                                              \
        real found = a;                                                                            \
        for (int lane = 0; lane < REAL_WIDTH; ++lane)                                              \
            LANE(&found, 0, lane) = function(LANE(&a, 0, lane));                                   \
        return found;                                                                              \
    }

/*
 * Roots and powers, which go on as odd functions below zero. A model that is proved takes them of no
 * such number in its domain; but a stage beyond a kink does, if it still has the branch before it, as
 * sqrt(-v) for sqrt(abs(v)). With a value there the kink can be located, and the step cut at it.
 */
#if defined(NOT_PROVED)
#define RADICAND(a) (a)
#else
#define RADICAND(a) size_of(a)
#endif
/* Roots of numbers that are not negative; GCC does not join those of lanes by itself. */
static inline real roots_of(real a)
{
#if REAL_WIDTH == 8 && defined(__AVX512F__) && !defined(__clang__)
    enum { ROUNDING_AS_SET = 4 };
    return (real)__builtin_ia32_sqrtpd512_mask(a, a, (unsigned char)-1, ROUNDING_AS_SET);
#elif REAL_WIDTH == 4 && defined(__AVX__) && !defined(__clang__)
    return (real)__builtin_ia32_sqrtpd256(a);
#else
    for (int lane = 0; lane < REAL_WIDTH; ++lane)
        LANE(&a, 0, lane) = sqrt(LANE(&a, 0, lane));
    return a;
#endif
}

static inline real sqrt_of(real a)
{
    const real found = roots_of(RADICAND(a));
    return chosen(a < 0.0, -found, found);
}

static inline real pow_of(real a, real b)
{
    real found = RADICAND(a);
    for (int lane = 0; lane < REAL_WIDTH; ++lane)
        LANE(&found, 0, lane) = pow(LANE(&found, 0, lane), LANE(&b, 0, lane));
    return chosen(a < 0.0, -found, found);
}

/* The smaller and the larger of two numbers; nan if one is nan. */
static inline real least(real a, real b)
{
    const mask first = (a < b) | (a != a);
    return chosen(first, a, b);
}

static inline real largest_of(real a, real b)
{
    const mask first = (a > b) | (a != a);
    return chosen(first, a, b);
}
