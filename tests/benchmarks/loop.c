/*
 * Many calls of a right-hand side, generated or written by hand, without Python between them.
 *
 * Both structures of parameters have the same fields in the same order.  A call goes through a
 * volatile pointer, so that no compiler computes it once and for all.
 */
#include "piezo_stack.c"

#include "hand_written.c"

typedef void rates(const double *, const double *, const piezo_stack_parameters *, double *);
typedef void rates_by_hand(const double *, const double *, const stack *, double *);

void loop_generated(const double *x, const double *u, const piezo_stack_parameters *p, double *out,
                    long calls);
void loop_by_hand(const double *x, const double *u, const stack *p, double *out, long calls);

void loop_generated(const double *x, const double *u, const piezo_stack_parameters *p, double *out,
                    long calls)
{
    rates *volatile call = piezo_stack_rhs;
    for (long n = 0; n < calls; ++n) {
        call(x, u, p, out);
    }
}

void loop_by_hand(const double *x, const double *u, const stack *p, double *out, long calls)
{
    rates_by_hand *volatile call = by_hand;
    for (long n = 0; n < calls; ++n) {
        call(x, u, p, out);
    }
}
