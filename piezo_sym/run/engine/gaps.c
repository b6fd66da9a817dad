/*
 * The residuals (gaps) of a step's equations, stage by stage, and the means in them. Comes after
 * gauss.c.
 */

/* Tables: weights for the states at nodes; matrices into and out of the basis of decoupled stages. */
#define NODE_REACH node_reach
#define FINE_REACH fine_reach
#define BASIS_STAGE basis_inverse
#define STAGE_BASIS stage_basis

/* The states, at a point of the step, that integrands read. */
static void MODEL(reach_read)(const MODEL(block) *m, real h, const double *weight)
{
    for (long r = 0; r < MODEL(reads); ++r) {
        const long record = MODEL(read)[r];
        const long end = record + 1 < MODEL(records) ? m->first[record + 1] : m->n;
        for (long i = m->first[record]; i < end; ++i)
            m->reached[i] = MODEL(reached_row)(m, h, weight, i);
    }
}

/* The integrands of the means, at nodes of a step. */
static void MODEL(integrate)(const MODEL(block) *m, real h, const double reach[][STAGES], long nodes)
{
    for (long q = 0; q < nodes; ++q) {
        MODEL(reach_read)(m, h, reach[q]);
        MODEL(integrands)(m->reached, &m->p, m->node + q * m->means);
    }
}

/* Means over the step, with as many nodes as each lane needs. */
static void MODEL(average)(const MODEL(block) *m, real h)
{
    MODEL(integrate)(m, h, node_reach, NODES);
    for (long i = 0; i < STAGES; ++i)
        for (long k = 0; k < m->means; ++k) {
            real *const mean = m->mean + i * m->given + k;
            *mean = zero;
            for (long q = 0; q < NODES; ++q)
                *mean += node_mean[i][q] * m->node[q * m->means + k];
        }
    if (!any(m->fine))
        return;
    MODEL(integrate)(m, h, fine_reach, FINE);
    for (long i = 0; i < STAGES; ++i)
        for (long k = 0; k < m->means; ++k) {
            real *const mean = m->mean + i * m->given + k, sum = zero;
            for (long q = 0; q < FINE; ++q)
                sum += fine_mean[i][q] * m->node[q * m->means + k];
            *mean = chosen(m->fine, sum, *mean);
        }
}

#if LOSSY /* see loss.c */
static void MODEL(lose)(const MODEL(block) *m, real h, real *rate, real *rows);
#endif

/* Residuals: the rates by the laws at the stages less `rates`; returns where branches change. */
static mask MODEL(gaps)(const MODEL(block) *m, real h, mask going)
{
    const mask over = m->over & going;
    mask changed = nowhere;
    if (m->means)
        MODEL(average)(m, h);
#if defined(BENDS)
    MODEL(average_split)(m, h);
#endif /* BENDS */
#if defined(PATHS)
    MODEL(along_paths)(m, h);
#endif /* PATHS */
    for (long i = 0; i < STAGES; ++i) {
        real *gap = m->gap + i * m->n, *mean = m->mean + i * m->given;
        real *side = m->side + i * m->branches, *branch = m->branch + i * m->branches;
        MODEL(reach_of)(m, h, stage_reach[i], m->reached);
        for (int again = 0; again < 3; ++again) {
            MODEL(stage)(m->reached, mean, branch, m->u + i * m->inputs, &m->p, gap,
                         m->rows + i * m->booked, side, m->margin + i * MODEL(limits));
            if (!any(over))
                break;
            const mask other = MODEL(choose)(m->branches, side, branch, over);
            if (!any(other))
                break;
            changed |= other;
        }
#if LOSSY
        MODEL(lose)(m, h, gap, m->rows);
#endif
        FOR_SOLVED (m, begin, end)
            for (long k = begin; k < end; ++k)
                gap[k] -= m->rates[i * m->n + k];
    }
    return changed;
}

#if defined(COSTATES)
/* The power of the residuals at each stage; m->gap holds them. */
static void MODEL(residual_power)(const MODEL(block) *m, real h, real *power)
{
    for (long i = 0; i < STAGES; ++i) {
        MODEL(reach_of)(m, h, stage_reach[i], m->reached);
        MODEL(costates)(m->reached, m->mean + i * m->given, &m->p, m->costate);
        power[i] = zero;
        FOR_SOLVED (m, begin, end)
            for (long k = begin; k < end; ++k)
                power[i] += m->costate[k] * m->gap[i * m->n + k];
    }
}
#endif /* COSTATES */

/* Multiply the residuals of each state, a vector over the stages, by a matrix. */
static void MODEL(transform)(const MODEL(block) *m, const double matrix[][STAGES])
{
    const long n = m->n;
    real *const gap = m->gap;
    FOR_SOLVED (m, begin, end) {
#pragma omp simd
        for (long k = begin; k < end; ++k) {
            real one[STAGES];
            for (long i = 0; i < STAGES; ++i) {
                one[i] = zero;
                for (long j = 0; j < STAGES; ++j)
                    one[i] += matrix[i][j] * gap[j * n + k];
            }
            for (long i = 0; i < STAGES; ++i)
                gap[i * n + k] = one[i];
        }
    }
}
