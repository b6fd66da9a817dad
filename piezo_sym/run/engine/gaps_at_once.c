/*
 * As gaps.c, with the stages of one run, or nodes, in the lanes of vectors; at_once.c computes in them.
 * Comes after gauss.c. Sums have the same order as in gaps.c, so that a run has the same numbers in
 * either layout.
 *
 * LANES lanes hold all stages, in VECTORS vectors of WIDTH lanes: as many as the processor's have. In
 * arrays the rows of one vector lie together, those of the next behind them.
 */

/*
 * Tables: weights for the states at nodes; into the basis in which the stages decouple, and back.
 */
#define NODE_REACH node_lanes
#define FINE_REACH fine_lanes
#define BASIS_STAGE basis_inverse_lanes
#define STAGE_BASIS stage_basis_lanes

typedef double lanes __attribute__((vector_size(8 * WIDTH), aligned(8), may_alias));

static inline lanes lanes_of(const double *values)
{
    return *(const lanes *)values;
}

/* Where vector v begins in an array of `size` rows; and the place of stage i in row k. */
static inline real *MODEL(part_of)(real *array, long size, long v)
{
    return array + v * size * WIDTH;
}

static inline real *MODEL(place_in)(real *array, long size, long i, long k)
{
    return MODEL(part_of)(array, size, i / WIDTH) + k * WIDTH + i % WIDTH;
}

/* State i at the points of a vector, each with its own weights of the stages' rates. */
static inline lanes MODEL(reached_lanes)(const MODEL(block) *m, real h, const double weight[][LANES],
                                         long first, long i)
{
    lanes sum = {0.0};
    for (long j = 0; j < STAGES; ++j)
        sum += lanes_of(weight[j] + first) * m->rates[j * m->n + i];
    return m->x[i] + h * sum;
}

/* The integrands of the means, at nodes of a step. */
static void MODEL(integrate)(const MODEL(block) *m, real h, const double weight[][LANES], long nodes)
{
    for (long q = 0; q < nodes; q += WIDTH) {
        for (long r = 0; r < MODEL(reads); ++r) {
            const long record = MODEL(read)[r];
            const long end = record + 1 < MODEL(records) ? m->first[record + 1] : m->n;
            for (long i = m->first[record]; i < end; ++i)
                ((lanes *)m->reached_lanes)[i] =
                    MODEL(reached_lanes)(m, h, weight + q / LANES * STAGES, q % LANES, i);
        }
        MODEL(nodes_at_once)(m->shared, m->reached_lanes, m->mean_lanes);
        for (long lane = 0; lane < WIDTH && q + lane < nodes; ++lane)
            for (long k = 0; k < m->means; ++k)
                m->node[(q + lane) * m->means + k] = m->mean_lanes[k * WIDTH + lane];
    }
}

/* Means over the step, with as many nodes as the run needs. */
static void MODEL(average)(const MODEL(block) *m, real h)
{
    const long nodes = m->fine ? FINE : NODES;
    const double (*mean)[LANES] = m->fine ? fine_mean_lanes : node_mean_lanes;
    MODEL(integrate)(m, h, m->fine ? fine_lanes : node_lanes, nodes);
    for (long v = 0; v < VECTORS; ++v)
        for (long k = 0; k < m->means; ++k) {
            lanes sum = {0.0};
            for (long q = 0; q < nodes; ++q)
                sum += lanes_of(mean[q] + v * WIDTH) * m->node[q * m->means + k];
            ((lanes *)MODEL(part_of)(m->mean_lanes, m->given, v))[k] = sum;
        }
}

/* Copy arrays of the stages, which lie one after another, into lanes. */
static inline void MODEL(into_lanes)(const real *from, long size, real *to)
{
    for (long k = 0; k < size; ++k)
        for (long i = 0; i < STAGES; ++i)
            *MODEL(place_in)(to, size, i, k) = from[i * size + k];
}

#if defined(BENDS) || defined(PATHS)
/* Copy some of the values given to stages into lanes. */
static void MODEL(means_into_lanes)(const MODEL(block) *m, long first, long end)
{
    for (long k = first; k < end; ++k)
        for (long i = 0; i < STAGES; ++i)
            *MODEL(place_in)(m->mean_lanes, m->given, i, k) = m->mean[i * m->given + k];
}
#endif

static inline void MODEL(from_lanes)(real *from, long size, real *to)
{
    for (long k = 0; k < size; ++k)
        for (long i = 0; i < STAGES; ++i)
            to[i * size + k] = *MODEL(place_in)(from, size, i, k);
}

/* Call the law at all stages, for states and means in lanes. */
static void MODEL(all_stages)(const MODEL(block) *m)
{
    const long inputs = m->inputs, branches = m->branches;
    for (long v = 0; v < VECTORS; ++v)
        MODEL(stages_at_once)(m->shared, MODEL(part_of)(m->reached_lanes, m->n, v),
                              MODEL(part_of)(m->mean_lanes, m->given, v),
                              MODEL(part_of)(m->branch_lanes, branches, v),
                              MODEL(part_of)(m->u_lanes, inputs, v), MODEL(part_of)(m->gap_lanes, m->n, v),
                              MODEL(part_of)(m->rows_lanes, m->booked, v),
                              MODEL(part_of)(m->side_lanes, branches, v),
                              MODEL(part_of)(m->margin_lanes, MODEL(limits), v));
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
    for (long v = 0; v < VECTORS; ++v) {
        lanes *const reached = (lanes *)MODEL(part_of)(m->reached_lanes, m->n, v);
        for (long k = 0; k < m->n; ++k)
            reached[k] = MODEL(reached_lanes)(m, h, stage_lanes, v * WIDTH, k);
    }
    MODEL(into_lanes)(m->u, m->inputs, m->u_lanes);
    for (int again = 0; again < 3; ++again) {
        mask other = nowhere;
        MODEL(into_lanes)(m->branch, m->branches, m->branch_lanes);
        MODEL(all_stages)(m);
        MODEL(from_lanes)(m->side_lanes, m->branches, m->side);
        for (long i = 0; i < STAGES && over; ++i)
            other |= MODEL(choose)(m->branches, m->side + i * m->branches,
                                   m->branch + i * m->branches, over);
        if (!other)
            break;
        changed = other;
    }
    MODEL(from_lanes)(m->gap_lanes, m->n, m->gap);
    for (long i = 0; i < STAGES; ++i)
        FOR_SOLVED (m, begin, end)
            for (long k = begin; k < end; ++k)
                m->gap[i * m->n + k] -= m->rates[i * m->n + k];
    MODEL(from_lanes)(m->rows_lanes, m->booked, m->rows);
    MODEL(from_lanes)(m->margin_lanes, MODEL(limits), m->margin);
    return changed;
}

#if defined(COSTATES)
/* The power of the residuals at each stage, right after gaps(); m->gap holds them. */
static void MODEL(residual_power)(const MODEL(block) *m, real h, real *power)
{
    (void)h;
    for (long i = 0; i < STAGES; ++i)
        power[i] = zero;
    for (long v = 0; v < VECTORS; ++v)
        MODEL(costates_at_once)(m->shared, MODEL(part_of)(m->reached_lanes, m->n, v),
                                MODEL(part_of)(m->mean_lanes, m->given, v),
                                MODEL(part_of)(m->gap_lanes, m->n, v));
    FOR_SOLVED (m, begin, end)
        for (long k = begin; k < end; ++k)
            for (long i = 0; i < STAGES; ++i)
                power[i] += *MODEL(place_in)(m->gap_lanes, m->n, i, k) * m->gap[i * m->n + k];
}
#endif /* COSTATES */

/* Multiply the residuals of each state, a vector over the stages, by a matrix. */
static void MODEL(transform)(const MODEL(block) *m, const double column[][LANES])
{
    FOR_SOLVED (m, begin, end)
        for (long k = begin; k < end; ++k) {
            lanes sum[VECTORS] = {{0.0}};
            for (long j = 0; j < STAGES; ++j)
                for (long v = 0; v < VECTORS; ++v)
                    sum[v] += lanes_of(column[j] + v * WIDTH) * m->gap[j * m->n + k];
            for (long i = 0; i < STAGES; ++i)
                m->gap[i * m->n + k] = sum[i / WIDTH][i % WIDTH];
        }
}

/* Sine number k of the inputs, at the times in t_lanes. */
static void MODEL(sine_at_once)(const MODEL(block) *m, const double *wave, long k)
{
    for (long v = 0; v < VECTORS; ++v)
        MODEL(sines_at_once)(wave, m->t_lanes + v * WIDTH, MODEL(part_of)(m->u_lanes, m->inputs, v) + k * WIDTH);
}
