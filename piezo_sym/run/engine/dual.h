/*
 * Dual numbers, a value and its slope in a direction: a step computed with them gives its derivatives,
 * exact to round-off.  They are complex; the imaginary part is the slope, times a factor whose square
 * vanishes beside 1.  OF has two lanes, value and slope.  Where a root or a power has no slope, at
 * zero, the slope is infinite or NaN in every direction.
 */
#include <math.h>
#include <stddef.h>

#define REAL_WIDTH 2
typedef double _Complex real;
#define OF(number, lane) (((double *)&(number))[lane])
#define zero ((real)0.0)
#define wide(value) ((real)(value))
#define chosen(condition, then, other) ((condition) ? (real)(then) : (real)(other))

static inline double value_of(real a)
{
    return OF(a, 0);
}

#define is_above(a, b) (value_of(a) > value_of(b))
#define is_at_least(a, b) (value_of(a) >= value_of(b))
#define least(a, b) chosen(is_above(b, a), a, b)

/* A function of x with the value y and a slope. */
static inline real dual_of(real x, double y, double slope)
{
    real found = y;
    OF(found, 1) = slope * OF(x, 1);
    return found;
}

/* c_sources.py adds a line per function, with its slope in x and its value y, from its record. */
#define FUNCTION(function, slope)                                                                  \
    static inline real function##_of(real a)                                                       \
    {                                                                                              \
        const double x = OF(a, 0), y = function(x);                                                \
        (void)x;                                                                                   \
        return dual_of(a, y, slope);                                                               \
    }

static inline real pow_of(real a, real b)
{
    const double x = OF(a, 0), n = OF(b, 0);
    real found = dual_of(a, pow(x, n), n * pow(x, n - 1.0));
    OF(found, 1) += x > 0.0 ? OF(found, 0) * log(x) * OF(b, 1) : 0.0;
    return found;
}
