/*
 * What else a step of the discrete gradient calls, of vectors of numbers.  Behind real.h; for
 * compilers with vector extensions (gcc, clang).
 */
enum { WIDTH = REAL_WIDTH };
#if REAL_WIDTH == 8
#define LANES(of) of(0), of(1), of(2), of(3), of(4), of(5), of(6), of(7)
#elif REAL_WIDTH == 4
#define LANES(of) of(0), of(1), of(2), of(3)
#else
#define LANES(of) of(0), of(1)
#endif

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

LANE_BY_LANE(log1p_of, log1p)
LANE_BY_LANE(atanh_of, atanh)

static inline real whole_power(real z, int n)
{
    real product = z;
    for (int k = 1; k < n; ++k)
        product *= z;
    return product;
}

static inline real largest(real a, real b)
{
    return chosen((a > b) | (a != a), a, b);
}

static inline real sign_of(real z)
{
    return chosen(z > 0.0, wide(1.0), chosen(z < 0.0, wide(-1.0), z));
}
