/* The inputs of runs, in all lanes at once. Comes after waves.c, and before trajectory.c. */

/*
 * An input between its breaks: a sine whose frequency may change linearly; Chebyshev series of `terms`
 * terms on the pieces between `edges`; or a function to call.
 */
typedef struct {
    double amplitude, frequency, rate, phase, offset;
    const double *edges, *coefficients;
    long pieces, terms;
    double (*called)(double);
} MODEL(signal);

/* The inputs of a run until the time `stop`. */
typedef struct {
    double stop;
    const MODEL(signal) *signals;
} MODEL(segment);

/* Set the waves of all inputs in a lane that has reached a segment. */
static void MODEL(enter)(MODEL(wave) *waves, const MODEL(segment) *segment, long inputs, int lane)
{
    for (long k = 0; k < inputs; ++k) {
        const MODEL(signal) *s = segment->signals + k;
        LANE(&waves[k].amplitude, 0, lane) = s->amplitude;
        LANE(&waves[k].frequency, 0, lane) = s->frequency;
        LANE(&waves[k].rate, 0, lane) = s->rate;
        LANE(&waves[k].phase, 0, lane) = s->phase;
        LANE(&waves[k].offset, 0, lane) = s->offset;
        LANE(&waves[k].others, 0, lane) = s->called || s->pieces;
    }
}

/* The value of a signal given by Chebyshev series, by Clenshaw's recurrence. */
static double MODEL(piece_at)(const MODEL(signal) *s, double t)
{
    long low = 0, high = s->pieces;
    double last = 0.0, before = 0.0;
    while (high - low > 1) {
        const long middle = (low + high) / 2;
        if (t < s->edges[middle])
            high = middle;
        else
            low = middle;
    }
    const double begin = s->edges[low], end = s->edges[low + 1];
    const double z = fmin(fmax((2.0 * t - begin - end) / (end - begin), -1.0), 1.0);
    const double *const term = s->coefficients + low * s->terms;
    for (long k = s->terms - 1; k > 0; --k) {
        const double now = term[k] + 2.0 * z * last - before;
        before = last, last = now;
    }
    return term[0] + z * last - before;
}

/* The value of a signal that is no sine. */
static double MODEL(other_at)(const MODEL(signal) *s, double t)
{
    return s->called ? s->called(t) : MODEL(piece_at)(s, t);
}
