/*
 * Right-hand sides of many states, written by hand: the yardstick for batches.
 *
 * Arrays as NumPy has them, x (4 + r, count): a state's numbers are `count` apart.  Blocks of
 * states keep what loops share in the cache, and loops over a block's states vectorise.
 */
#include "hand_written.c"

#define BLOCK 256

static void block(const double *restrict x, const double *restrict u, const stack *restrict s,
                  double *restrict rate, long count, long width)
{
    double warming[BLOCK], current[BLOCK], loss[BLOCK];
    const long r = s->hysterons;
    const double *restrict p = x + count, *restrict charge = x + 2*count;
    const double *restrict entropy = x + (3 + r)*count;
    for (long n = 0; n < width; ++n) {
        warming[n] = s->reference*expm1(entropy[n]/s->heat_capacity);
        current[n] = 0.0;
        loss[n] = 0.0;
    }
    for (long j = 0; j < r; ++j) {
        const double *restrict flux = x + (3 + j)*count;
        double *restrict rise = rate + (3 + j)*count;
        const double inductance = s->inductance[j], slope = s->slope[j];
        const double threshold = s->threshold[j];
#pragma omp simd
        for (long n = 0; n < width; ++n) {
            const double i = flux[n]/inductance;
            const double beyond = fabs(i) - threshold;
            const double drop = beyond > 0.0 ? slope/warming[n]*copysign(beyond, i) : 0.0;
            current[n] += i;
            loss[n] += drop*i;
            rise[n] = u[1] - charge[n]/s->capacitance - drop;
        }
    }
#pragma omp simd
    for (long n = 0; n < width; ++n) {
        const double temperature = s->reference + warming[n];
        const double alpha = s->ratio*temperature/s->reference;
        const double velocity = p[n]/s->mass, across = charge[n]/s->capacitance;
        rate[n] = velocity;
        rate[count + n] = alpha*across - s->stiffness*(x[n] - s->rest) - s->damping*velocity + u[0];
        rate[2*count + n] = current[n] - alpha*velocity;
        rate[(3 + r)*count + n] = (loss[n] + s->damping*velocity*velocity)/temperature
            + s->conductance*(u[2]/temperature - 1.0);
    }
}

void batch_by_hand(const double *x, const double *u, const stack *s, double *rate, long count);

void batch_by_hand(const double *x, const double *u, const stack *s, double *rate, long count)
{
    for (long first = 0; first < count; first += BLOCK) {
        const long width = count - first < BLOCK ? count - first : BLOCK;
        block(x + first, u, s, rate + first, count, width);
    }
}
