/*
 * Rates and states at a fraction of a step, and means over a step whose integrands have kinks. Comes
 * after gauss.c.
 *
 * Gauss quadrature is exact to round-off only where integrands are smooth. A bend function is one
 * whose sign decides on which side of an energy's kink a state is. Where one changes its sign on
 * X(tau), the step is split, and each piece has nodes of its own. Each lane is searched by itself
 * and has its own pieces, so that its numbers do not depend on other lanes.
 */

/* Weights of the stages' rates for the rate at a fraction of the step. */
static inline void MODEL(rate_weights)(real at, real *weight)
{
    for (long j = 0; j < STAGES; ++j) {
        weight[j] = wide(stage_lead[j]);
        for (long k = 0; k < STAGES; ++k)
            if (k != j)
                weight[j] *= at - stage_at[k];
    }
}

/* Weights for the change of the state since the beginning of the step, per length of the step. */
static inline void MODEL(state_weights)(real at, real *weight)
{
    for (long j = 0; j < STAGES; ++j) {
        weight[j] = zero;
        for (long n = STAGES; n-- > 0;)
            weight[j] = (weight[j] + along[j][n]) * at;
    }
}

/* All states at a fraction of the step, by the rates at its stages. */
static void MODEL(reach_part)(const MODEL(block) *m, real h, const real *rates, real at)
{
    real weight[STAGES];
    MODEL(state_weights)(at, weight);
    for (long k = 0; k < m->n; ++k) {
        real sum = zero;
        for (long j = 0; j < STAGES; ++j)
            sum += weight[j] * rates[j * m->n + k];
        m->reached[k] = m->x[k] + h * sum;
    }
}

#if defined(BENDS)
/* Most iterations of a search; a mean is off by the square of a place's error. */
enum { MOST_TRIES = 60, DIPS = 6 };

/* Bend function k of one lane at the fraction `at` of the step. */
static double MODEL(bend_at)(const MODEL(block) *m, real h, long k, int lane, double at)
{
    MODEL(reach_part)(m, h, m->rates, wide(at));
    MODEL(bends)(m->reached, &m->p, m->bend);
    return LANE(m->bend, k, lane);
}

/*
 * A bend function has one sign at three points, and is nearest to zero in the middle: search
 * between them for the other sign, at the vertices of parabolas. The middle point becomes the
 * nearest to zero that is found.
 */
static void MODEL(dip)(const MODEL(block) *m, real h, long k, int lane, double *place, double *value)
{
    const double turn = value[1] > 0.0 ? 1.0 : -1.0;
    double a = place[0], b = place[1], c = place[2];
    double at_a = turn * value[0], at_b = turn * value[1], at_c = turn * value[2];
    for (int again = 0; again < DIPS && at_b < at_a - at_b + (at_c - at_b); ++again) {
        const double p = (b - a) * (at_b - at_c), q = (c - b) * (at_b - at_a);
        const double vertex = b - 0.5 * (((b - a) * p - (c - b) * q) / (p + q));
        if (!(vertex > a && vertex < c) || vertex == b)
            break;
        const double there = MODEL(bend_at)(m, h, k, lane, vertex);
        const double size = turn * there;
        if (size < at_b) {
            if (vertex < b)
                c = b, at_c = at_b;
            else
                a = b, at_a = at_b;
            b = place[1] = vertex, at_b = size;
            value[1] = there;
        } else if (vertex < b)
            a = vertex, at_a = size;
        else
            c = vertex, at_c = size;
        if ((there > 0.0) != (turn > 0.0))
            break;
    }
}

/* Where a bend function of a lane changes its sign between two points. */
static double MODEL(turning)(const MODEL(block) *m, real h, long k, int lane, const double *place,
                             const double *value)
{
    double low = place[0], high = place[1], at_low = value[0], at_high = value[1], part = high;
    const int on = at_low > 0.0;
    for (int again = 0, before = 0; again < MOST_TRIES; ++again) {
        const double last = part;
        part = low + (high - low) * (at_low / (at_low - at_high));
        const double there = MODEL(bend_at)(m, h, k, lane, part);
        if (there == 0.0 || fabs(part - last) <= 1e-14)
            break;
        if ((there > 0.0) == on) { /* Illinois method: halve the value at an end that stays twice */
            low = part, at_low = there;
            at_high *= before < 0 ? 0.5 : 1.0;
            before = -1;
        } else {
            high = part, at_high = there;
            at_low *= before > 0 ? 0.5 : 1.0;
            before = 1;
        }
    }
    return part;
}

/*
 * Insert a place where a lane's step is split, in order. Equal ones count once; 1 is behind the
 * last.
 */
static void MODEL(keep_place)(const MODEL(block) *m, int lane, double at)
{
    long j = 0;
    if (!(at > 0.0 && at < 1.0)) /* outside of the step, where bend functions are sampled, too */
        return;
    while (LANE(m->cut, j, lane) < at)
        ++j;
    for (double next = LANE(m->cut, j, lane); at < next; ++j) {
        LANE(m->cut, j, lane) = at;
        at = next;
        next = next < 1.0 ? LANE(m->cut, j + 1, lane) : 1.0;
    }
}

/* Sampled parts of the step, one beyond each end: for functions that turn back near there. */
static double MODEL(look_at)(long i)
{
    return (double)(i - 1) / (BEND_LOOKS - 3);
}

/* Find where a bend function of a lane changes its sign along the step. */
static void MODEL(find)(const MODEL(block) *m, real h, long k, int lane)
{
    double place[BEND_LOOKS], value[BEND_LOOKS];
    for (long i = 0; i < BEND_LOOKS; ++i) {
        place[i] = MODEL(look_at)(i);
        value[i] = LANE(m->look, i * m->bends + k, lane);
    }
    for (long i = 1; i + 1 < BEND_LOOKS; ++i) {
        const int on = value[i] > 0.0, before = value[i - 1] > 0.0, after = value[i + 1] > 0.0;
        const double size = fabs(value[i]);
        if (on == before && on == after && size <= fabs(value[i - 1]) && size <= fabs(value[i + 1]))
            MODEL(dip)(m, h, k, lane, place + i - 1, value + i - 1);
    }
    for (long i = 1; i < BEND_LOOKS; ++i)
        if (place[i] > 0.0 && place[i - 1] < 1.0 && (value[i - 1] > 0.0) != (value[i] > 0.0))
            MODEL(keep_place)(m, lane, MODEL(turning)(m, h, k, lane, place + i - 1, value + i - 1));
}

/* Find where the step of each lane is split; returns the lanes with splits. */
static mask MODEL(split)(const MODEL(block) *m, real h)
{
    for (long i = 0; i < BEND_LOOKS; ++i) {
        MODEL(reach_part)(m, h, m->rates, wide(MODEL(look_at)(i)));
        MODEL(bends)(m->reached, &m->p, m->look + i * m->bends);
    }
    for (long j = 0; j <= (BEND_LOOKS - 1) * m->bends; ++j)
        m->cut[j] = wide(1.0);
    for (long k = 0; k < m->bends; ++k) {
        real low = m->look[k], high = low;
        for (long i = 1; i < BEND_LOOKS; ++i) {
            low = least(m->look[i * m->bends + k], low);
            high = largest_of(m->look[i * m->bends + k], high);
        }
        /* else it is too far from zero */
        const real near = chosen((low <= high - low) & (-high <= high - low), wide(1.0), zero);
        for (int lane = 0; lane < REAL_WIDTH; ++lane)
            if (LANE(&near, 0, lane) > 0.0)
                MODEL(find)(m, h, k, lane);
    }
    return m->cut[0] < 1.0;
}

/* The integrands of the means, at nodes of the piece that begins at `low`. */
static void MODEL(integrate_piece)(const MODEL(block) *m, real h, real low, real length,
                                   const double *at, long nodes)
{
    for (long q = 0; q < nodes; ++q) {
        MODEL(reach_part)(m, h, m->rates, low + length * at[q]);
        MODEL(integrands)(m->reached, &m->p, m->node + q * m->means);
    }
}

/* Means over split steps in some lanes, with `nodes` nodes per piece. */
static void MODEL(average_by)(const MODEL(block) *m, real h, mask where, const double *at,
                              const double *weight, long nodes)
{
    real low = zero;
    for (long k = 0; k < STAGES * m->given; ++k)
        m->mean[k] = chosen(where, zero, m->mean[k]);
    for (long j = 0; any(low < 1.0); low = m->cut[j++]) {
        const real length = m->cut[j] - low;
        const mask there = where & (length > 0.0);
        MODEL(integrate_piece)(m, h, low, length, at, nodes);
        for (long q = 0; q < nodes; ++q) {
            real share[STAGES];
            MODEL(rate_weights)(low + length * at[q], share);
            for (long i = 0; i < STAGES; ++i) {
                const real part = length * (weight[q] / stage_weight[i]) * share[i];
                for (long k = 0; k < m->means; ++k)
                    m->mean[i * m->given + k] +=
                        chosen(there, part * m->node[q * m->means + k], zero);
            }
        }
    }
}

/* Means in the lanes whose integrands have kinks within the step; returns these lanes. */
static mask MODEL(average_split)(const MODEL(block) *m, real h)
{
    if (LOSSY) /* a dissipative step has no means */
        return nowhere;
    const mask where = MODEL(split)(m, h);
    if (any(where & none_of(m->fine)))
        MODEL(average_by)(m, h, where & none_of(m->fine), node_at, node_weight, NODES);
    if (any(where & m->fine))
        MODEL(average_by)(m, h, where & m->fine, fine_at, fine_weight, FINE);
    return where;
}

/*
 * The weight of slopes up to a fraction of the step. With slopes U'' that differ along the step, the
 * derivative of mean i by rate j is h int (l_i/b_i) U'' A_j dtau, A_j = int_0^tau l_j; Newton's
 * method has h a_ij times one slope in its place. So slopes are averaged with the trace of l_i
 * A_j/b_i as weight, and this is its integral. With one stage the derivative is exact.
 */
static real MODEL(until_part)(real at)
{
    real weight[STAGES], sum = zero;
    MODEL(state_weights)(at, weight);
    for (long j = 0; j < STAGES; ++j)
        sum += weight[j] * weight[j] / stage_weight[j];
    return sum;
}

/* Slopes for split steps: those in the middle of each piece, averaged, on a stage's branches. */
static void MODEL(slopes_split)(const MODEL(block) *m, real h, long stage)
{
    const mask where = m->cut[0] < 1.0;
    real low = any(where) ? zero : (real)wide(1.0);
    for (long j = 0; any(low < 1.0); low = m->cut[j++]) {
        const real length = m->cut[j] - low;
        const real part = MODEL(until_part)(m->cut[j]) - MODEL(until_part)(low);
        MODEL(reach_part)(m, h, m->rates, low + 0.5 * length);
        MODEL(slopes)(m->reached, m->mean + stage * m->given, m->branch + stage * m->branches,
                      m->u + stage * m->inputs, &m->p, m->piece_slope);
        for (long k = 0; k < m->slopes; ++k) {
            const real before = j ? m->fresh[k] : zero;
            const real more = chosen(length > 0.0, part * m->piece_slope[k], zero);
            m->fresh[k] = chosen(where, before + more, m->fresh[k]);
        }
    }
}
#endif /* BENDS */
