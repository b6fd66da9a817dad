/*
 * How many nodes the means over a step ask for, and a step solved with as many.  Behind newton.c.
 */

/* How far aside of a state its co-states are looked at, in parts; what of their noise is more than that. */
#define ASIDE 1e-3
#define MUCH_NOISE 100.0
/* A part of what is not zero, but no less than its noise: terms are sums over nodes. */
#define ABOVE_NOISE(part) ((part) > MUCH_NOISE * NOISE ? (part) : MUCH_NOISE * NOISE)

/* What is asked of a function whose mean is taken: how many nodes that are, and their tables. */
typedef struct {
    long nodes;
    const double *last, *other; /* what gives the last term of Legendre's, and that before */
    double part;                /* what the last may be, in parts of the function's size */
} MODEL(rule);

static const MODEL(rule) MODEL(few) = {NODES, node_last[0], node_last[1], ABOVE_NOISE(COARSE)};
static const MODEL(rule) MODEL(many) = {FINE, fine_last[0], fine_last[1], ABOVE_NOISE(TOO_COARSE)};

/*
 * The lanes where functions whose means are taken, at the nodes at hand, ask for more nodes: where the
 * last two terms are not small, for of an even or odd function every other is zero. Noise may be.
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

/* The same, of whole steps and of the pieces of those that are split. */
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

/* The lanes whose co-states ask for more nodes than NODES, for balances that are exact to round-off. */
static mask MODEL(coarse)(const MODEL(block) *m, real h)
{
    mask other = m->fine; /* lanes whose last gaps have left other nodes than NODES of the whole */
#if defined(BENDS)
    other |= m->cut[0] < 1.0;
#endif /* BENDS */
    if (m->means && any(other))
        return MODEL(rough_parts)(m, h, &MODEL(few), NULL);
    return MODEL(rough)(m, &MODEL(few), NULL);
}

/*
 * The lanes whose co-states ask for more nodes than FINE: the step is too long. A difference that goes
 * to zero, such as that of a length and a rest, is all noise at last: what rounding leaves of its
 * terms, which its slope along the state itself tells.
 */
static mask MODEL(too_coarse)(const MODEL(block) *m, real h)
{
    real *const noise = m->gap; /* of Newton's method, which is done */
    MODEL(integrands)(m->x, &m->p, noise);
    for (long k = 0; k < m->n; ++k)
        m->reached[k] = m->x[k] * (1.0 + ASIDE);
    MODEL(integrands)(m->reached, &m->p, m->node);
    for (long k = 0; k < m->means; ++k)
        noise[k] = (NOISE / ASIDE) * size_of(m->node[k] - noise[k]);
    return m->fine & MODEL(rough_parts)(m, h, &MODEL(many), noise);
}

/* The rates in some lanes, with means at as many nodes as they ask for; returns who has them. */
static mask MODEL(solve)(MODEL(block) *m, real h, mask where)
{
    m->fine &= none_of(where);
    m->sketched = nowhere;
    mask found = MODEL(iterate)(m, h, where);
    if (LOSSY) /* a dissipative step has no means */
        return found;
    const mask more = MODEL(coarse)(m, h) & found & none_of(m->sketched | m->fine);
    if (any(more)) {
        m->fine |= more;
        found &= none_of(more) | MODEL(iterate)(m, h, more);
    }
    const mask fine = m->fine & found & none_of(m->sketched);
    if (any(fine))
        found &= none_of(fine & MODEL(too_coarse)(m, h));
    return found;
}
