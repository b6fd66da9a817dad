/*
 * As gaps.c, with the stages of one run, or nodes, in the lanes of vectors of LANES numbers;
 * at_once.c computes in them. Comes after gauss.c. Sums have the same order as in gaps.c, so that a
 * run has the same numbers in either layout.
 */

/*
 * Tables: weights for the states at nodes; into the basis in which the stages decouple, and back.
 */
#define NODE_REACH node_lanes
#define FINE_REACH fine_lanes
#define BASIS_STAGE basis_inverse_lanes
#define STAGE_BASIS stage_basis_lanes

typedef double lanes __attribute__((vector_size(8 * LANES), aligned(8), may_alias));

static inline lanes lanes_of(const double *values)
{
    return *(const lanes *)values;
}

/* State i at the points of all lanes, each with its own weights of the stages' rates. */
static inline lanes MODEL(reached_lanes)(const MODEL(block) *m, real h, const double weight[][LANES], long i)
{
    lanes sum = {0.0};
    for (long j = 0; j < STAGES; ++j)
        sum += lanes_of(weight[j]) * m->rates[j * m->n + i];
    return m->x[i] + h * sum;
}

/* The integrands of the means, at nodes of a step. */
static void MODEL(integrate)(const MODEL(block) *m, real h, const double weight[][LANES], long nodes)
{
    for (long q = 0; q < nodes; q += LANES) {
        for (long r = 0; r < MODEL(reads); ++r) {
            const long record = MODEL(read)[r];
            const long end = record + 1 < MODEL(records) ? m->first[record + 1] : m->n;
            for (long i = m->first[record]; i < end; ++i)
                ((lanes *)m->reached_lanes)[i] =
                    MODEL(reached_lanes)(m, h, weight + q / LANES * STAGES, i);
        }
        MODEL(nodes_at_once)(m->shared, m->reached_lanes, m->mean_lanes);
        for (long lane = 0; lane < LANES && q + lane < nodes; ++lane)
            for (long k = 0; k < m->means; ++k)
                m->node[(q + lane) * m->means + k] = m->mean_lanes[k * LANES + lane];
    }
}

/* Means over the step, with as many nodes as the run needs. */
static void MODEL(average)(const MODEL(block) *m, real h)
{
    const long nodes = m->fine ? FINE : NODES;
    const double (*mean)[LANES] = m->fine ? fine_mean_lanes : node_mean_lanes;
    MODEL(integrate)(m, h, m->fine ? fine_lanes : node_lanes, nodes);
    for (long k = 0; k < m->means; ++k) {
        lanes sum = {0.0};
        for (long q = 0; q < nodes; ++q)
            sum += lanes_of(mean[q]) * m->node[q * m->means + k];
        ((lanes *)m->mean_lanes)[k] = sum;
    }
}

/* Copy arrays of the stages, which lie one after another, into lanes. */
static inline void MODEL(into_lanes)(const real *from, long size, real *to)
{
    for (long k = 0; k < size; ++k)
        for (long i = 0; i < STAGES; ++i)
            to[k * LANES + i] = from[i * size + k];
}

#if defined(BENDS) || defined(PATHS)
/* Copy some of the values given to stages into lanes. */
static void MODEL(means_into_lanes)(const MODEL(block) *m, long first, long end)
{
    for (long k = first; k < end; ++k)
        for (long i = 0; i < STAGES; ++i)
            m->mean_lanes[k * LANES + i] = m->mean[i * m->given + k];
}
#endif

static inline void MODEL(from_lanes)(const real *from, long size, real *to)
{
    for (long k = 0; k < size; ++k)
        for (long i = 0; i < STAGES; ++i)
            to[i * size + k] = from[k * LANES + i];
}

/* Residuals: the rates by the laws at the stages less `rates`; returns whether branches change. */
static mask MODEL(gaps)(const MODEL(block) *m, real h, mask going)
{
    const mask over = m->over & going;
    mask changed = nowhere;
    if (m->means)
        MODEL(average)(m, h);
#if defined(BENDS)
    if (MODEL(average_split)(m, h))
        MODEL(means_into_lanes)(m, 0, m->means);
#endif /* BENDS */
#if defined(PATHS)
    MODEL(along_paths)(m, h);
    MODEL(means_into_lanes)(m, m->means, m->given);
#endif /* PATHS */
    for (long k = 0; k < m->n; ++k)
        ((lanes *)m->reached_lanes)[k] = MODEL(reached_lanes)(m, h, stage_lanes, k);
    MODEL(into_lanes)(m->u, m->inputs, m->u_lanes);
    for (int again = 0; again < 3; ++again) {
        mask other = nowhere;
        MODEL(into_lanes)(m->branch, m->branches, m->branch_lanes);
        MODEL(stages_at_once)(m->shared, m->reached_lanes, m->mean_lanes, m->branch_lanes, m->u_lanes,
                              m->gap_lanes, m->rows_lanes, m->side_lanes, m->margin_lanes);
        MODEL(from_lanes)(m->side_lanes, m->branches, m->side);
        for (long i = 0; i < STAGES && over; ++i)
            other |= MODEL(choose)(m->branches, m->side + i * m->branches,
                                   m->branch + i * m->branches, over);
        if (!other)
            break;
        changed = other;
    }
    FOR_SOLVED (m, begin, end)
        for (long i = 0; i < STAGES; ++i)
            for (long k = begin; k < end; ++k)
                m->gap[i * m->n + k] = m->gap_lanes[k * LANES + i] - m->rates[i * m->n + k];
    MODEL(from_lanes)(m->rows_lanes, m->booked, m->rows);
    MODEL(from_lanes)(m->margin_lanes, MODEL(limits), m->margin);
    return changed;
}

#if defined(COSTATES)
/* The power of the residuals at each stage, right after gaps(); m->gap holds them. */
static void MODEL(residual_power)(const MODEL(block) *m, real h, real *power)
{
    lanes sum = {0.0};
    (void)h;
    MODEL(costates_at_once)(m->shared, m->reached_lanes, m->mean_lanes, m->gap_lanes);
    FOR_SOLVED (m, begin, end)
        for (long k = begin; k < end; ++k) {
            lanes gap = {0.0};
            for (long i = 0; i < STAGES; ++i)
                gap[i] = m->gap[i * m->n + k];
            sum += lanes_of(m->gap_lanes + k * LANES) * gap;
        }
    for (long i = 0; i < STAGES; ++i)
        power[i] = sum[i];
}
#endif /* COSTATES */

/* Multiply the residuals of each state, a vector over the stages, by a matrix. */
static void MODEL(transform)(const MODEL(block) *m, const double column[][LANES])
{
    FOR_SOLVED (m, begin, end)
        for (long k = begin; k < end; ++k) {
            lanes sum = {0.0};
            for (long j = 0; j < STAGES; ++j)
                sum += lanes_of(column[j]) * m->gap[j * m->n + k];
            for (long i = 0; i < STAGES; ++i)
                m->gap[i * m->n + k] = sum[i];
        }
}
