/*
 * The number of nodes that means over a step need, and a step solved with as many. Comes after
 * newton.c.
 */

/*
 * States are moved by ASIDE of their scales to estimate the round-off of their co-states, and by steps of
 * NEAREST to FARTHEST; what exceeds it by the factor MUCH_NOISE is no round-off.
 */
#define ASIDE 1e-3
#define NEAREST (sizeof(real) < sizeof(double) ? 1e-5 : 1e-9)
#define FARTHEST (sizeof(real) < sizeof(double) ? 1e-4 : 1e-8)
#define FARTHER 1.6
#define ROUND_OFF_IN_IT 8.0 /* how often a fourth difference has that of a single value */
#define MUCH_NOISE 100.0
/* A relative bound, but not below the round-off of sums over nodes. */
#define ABOVE_NOISE(part) ((part) > MUCH_NOISE * NOISE ? (part) : MUCH_NOISE * NOISE)

/* A quadrature rule, and how it tells that an integrand needs more nodes. */
typedef struct {
    long nodes;
    const double *last, *other; /* weights for the last two Legendre coefficients */
    double part;                /* how large these may be, relative to the integrand */
} MODEL(rule);

static const MODEL(rule) MODEL(few) = {NODES, node_last[0], node_last[1], ABOVE_NOISE(COARSE)};
static const MODEL(rule) MODEL(many) = {FINE, fine_last[0], fine_last[1], ABOVE_NOISE(TOO_COARSE)};

/*
 * The lanes in which an integrand needs more nodes: the last two coefficients of its Legendre
 * series are not small. Two of them, for every other one of an even or odd function is zero.
 * Coefficients within `noise` of an integrand do not count.
 */
static mask MODEL(rough)(const MODEL(block) *m, const MODEL(rule) *rule, const real *noise)
{
    mask found = nowhere;
    for (long k = 0; k < m->means; ++k) {
        real last = zero, other = zero, size = NO_SIZE + zero;
        for (long q = 0; q < rule->nodes; ++q) {
            const real value = m->node[q * m->means + k];
            last += rule->last[q] * value;
            other += rule->other[q] * value;
            size = largest_of(size_of(value), size);
        }
        const real left = largest_of(size_of(last), size_of(other));
        mask bad = left > rule->part * size;
        if (noise)
            bad &= left > MUCH_NOISE * noise[k];
        found |= bad;
    }
    return found;
}

/* The lanes where means are rough in a step, or in a piece of a step that is split. */
static mask MODEL(rough_parts)(const MODEL(block) *m, real h, const MODEL(rule) *rule, const real *noise)
{
    MODEL(integrate)(m, h, rule->nodes == FINE ? FINE_REACH : NODE_REACH, rule->nodes);
    mask found = MODEL(rough)(m, rule, noise);
#if defined(BENDS)
    const mask split = m->cut[0] < 1.0;
    real low = any(split) ? zero : (real)wide(1.0);
    found &= none_of(split);
    for (long j = 0; any(low < 1.0); low = m->cut[j++]) {
        const real length = m->cut[j] - low;
        const double *const at = rule->nodes == FINE ? fine_at : node_at;
        MODEL(integrate_piece)(m, h, low, length, at, rule->nodes);
        found |= split & (length > 0.0) & MODEL(rough)(m, rule, noise);
    }
#endif /* BENDS */
    return found;
}

static mask MODEL(coarse_by_now)(MODEL(block) *m, real h)
{
    return m->means ? MODEL(rough_parts)(m, h, &MODEL(few), NULL) : nowhere;
}

/* The lanes that need more than NODES nodes for balances exact to round-off. */
static mask MODEL(coarse)(const MODEL(block) *m, real h)
{
    mask other = m->fine; /* lanes where `node` is not at the NODES of a whole step */
#if defined(BENDS)
    other |= m->cut[0] < 1.0;
#endif /* BENDS */
    if (m->means && any(other))
        return MODEL(rough_parts)(m, h, &MODEL(few), NULL);
    return MODEL(rough)(m, &MODEL(few), NULL);
}

/* The integrands of the means, with each state moved away from zero by a fraction of its scale. */
static void MODEL(integrands_aside)(const MODEL(block) *m, double fraction, real *value)
{
    for (long k = 0; k < m->n; ++k) {
        const real by = fraction * (m->largest[k] + size_of(m->x[k]));
        m->reached[k] = m->x[k] + chosen(m->x[k] < 0.0, -by, by);
    }
    MODEL(integrands)(m->reached, &m->p, value);
}

/*
 * The round-off of integrands. One that tends to zero as a difference of larger terms, such as a length
 * and a rest length, ends as their round-off. How large these are shows when the states are moved; or,
 * where they have nothing to do with the states' scales, as in (1 + q/g)**n - 1 for q far below g, in the
 * fourth difference of five points so near to each other that it is nothing else, even in a steep law.
 */
static void MODEL(find_noise)(const MODEL(block) *m, real *noise)
{
    real *const first = m->node, *const second = first + m->means;
    MODEL(integrands)(m->x, &m->p, first);
    MODEL(integrands_aside)(m, ASIDE, second);
    for (long k = 0; k < m->means; ++k) {
        const real change = size_of(second[k] - first[k]);
        noise[k] = chosen(change < 1e300, (NOISE / ASIDE) * change, zero);
    }
    static const double binomial[] = {1.0, -4.0, 6.0, -4.0, 1.0};
    for (double apart = NEAREST; apart < FARTHEST; apart *= FARTHER) {
        real *const sum = second + m->means;
        for (long k = 0; k < m->means; ++k)
            sum[k] = first[k];
        for (int point = 1; point < 5; ++point) {
            MODEL(integrands_aside)(m, point * apart, second);
            for (long k = 0; k < m->means; ++k)
                sum[k] += binomial[point] * second[k];
        }
        for (long k = 0; k < m->means; ++k) {
            const real left = size_of(sum[k]) / ROUND_OFF_IN_IT;
            noise[k] = largest_of(noise[k], chosen(left < 1e300, left, zero));
        }
    }
}

/* The lanes in which FINE nodes are too few: the step is too long. */
static mask MODEL(too_coarse)(const MODEL(block) *m, real h)
{
    const mask bad = m->fine & MODEL(rough_parts)(m, h, &MODEL(many), NULL);
    if (!any(bad))
        return bad;
    real *const noise = m->gap; /* no longer needed by Newton's method */
    MODEL(find_noise)(m, noise);
    return bad & MODEL(rough_parts)(m, h, &MODEL(many), noise);
}

#if defined(COSTATES)
/* How far states are moved to learn how large the terms of rates are, relative to their scale. */
#define APART 1e-6
/* Changes may be this many times the round-off of a rate, which there is in each stage. */
#define ROUND_OFFS 100.0

/* The rates where states were moved to, in `gap`. */
static void MODEL(rates_aside)(const MODEL(block) *m)
{
    MODEL(at_point)(m, m->reached, m->branch, m->u, NULL, m->gap, m->rows, m->side, m->margin);
}

/*
 * The round-off of rates by the size of their terms, which shows when states are moved to either side. As all
 * at once would leave a balance as it is, state k goes the way that a binary digit of k says: any two go
 * opposite ways for one digit at least. (A single state has one digit, too.)
 */
static void MODEL(noise_of_terms)(const MODEL(block) *m)
{
    const long n = m->n;
    real *const slope = m->costate;
    memset(m->rate_noise, 0, (size_t)n * sizeof(real));
    for (long digit = 1; digit < 2 * n; digit *= 2) {
        memset(slope, 0, (size_t)n * sizeof(real));
        for (double side = -1.0; side < 2.0; side += 2.0) {
            for (long k = 0; k < n; ++k) {
                const double by = k & digit ? side * APART : -side * APART;
                m->reached[k] = m->x[k] + by * largest_of(m->largest[k], size_of(m->x[k]));
            }
            MODEL(rates_aside)(m);
            for (long k = 0; k < n; ++k)
                slope[k] += (side / (2.0 * APART)) * m->gap[k];
        }
        for (long k = 0; k < n; ++k) {
            const real noise = NOISE * size_of(slope[k]);
            m->rate_noise[k] = chosen(noise < 1e300, largest_of(noise, m->rate_noise[k]), m->rate_noise[k]);
        }
    }
}

/* The lanes whose last changes are as small as the round-off of rates. */
static mask MODEL(below_noise)(const MODEL(block) *m, real h, mask where)
{
    real worst = zero;
    FOR_SOLVED (m, begin, end)
        for (long k = begin; k < end; ++k) {
            real sum = zero;
            for (long j = 0; j < STAGES; ++j)
                sum += size_of(m->prior[j * m->n + k]);
            const real size = m->noise[k] + NOISE * (m->largest[k] + size_of(m->x[k])) + h * m->rate_noise[k];
            worst = largest_of(h * sum / (size + NO_SIZE), worst);
        }
    return where & (worst <= ROUND_OFFS);
}

/*
 * The lanes whose last changes are no more than the round-off of rates. These may be the small difference of
 * large terms, as the force at rest is. Residuals, branches and rows of the step are put aside meanwhile.
 */
static mask MODEL(is_round_off)(MODEL(block) *m, real h, mask where)
{
    memcpy(m->kept, m->gap, m->kept_size);
    MODEL(noise_of_terms)(m);
    const mask found = MODEL(below_noise)(m, h, where);
    memcpy(m->gap, m->kept, m->kept_size);
#if defined(PATHS)
    MODEL(path_parameters)(m->x, &m->p, m->path);
#endif /* PATHS */
    return found;
}
#endif /* COSTATES */

#if !defined(COSTATES) /* else see residual.c */
static mask MODEL(iterate_enough)(MODEL(block) *m, real h, mask where)
{
    return MODEL(iterate)(m, h, where);
}
#endif

/*
 * Solve for the rates in some lanes, with as many nodes as they need; returns the lanes that
 * succeed.
 */
static mask MODEL(solve)(MODEL(block) *m, real h, mask where)
{
    m->fine &= none_of(where);
    m->sketched = nowhere;
    mask found = MODEL(iterate_enough)(m, h, where);
    if (LOSSY) /* a dissipative step has no means */
        return found;
    const mask more = MODEL(coarse)(m, h) & found & none_of(m->sketched | m->fine);
    if (any(more)) {
        m->fine |= more;
        found &= none_of(more) | MODEL(iterate_enough)(m, h, more);
    }
    const mask fine = m->fine & found & none_of(m->sketched);
    if (any(fine))
        found &= none_of(fine & MODEL(too_coarse)(m, h));
    return found;
}
