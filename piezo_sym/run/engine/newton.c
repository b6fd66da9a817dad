/* Newton's method for the rates at the stages of a step. Comes after gauss.c. */

/*
 * The rates at a single point, with its own co-states in place of means. Path functionals may jump
 * within a step, which knows only their means: at an end of it (`weight`), their rates are
 * extrapolated from those of its stages.
 */
static void MODEL(at_point)(const MODEL(block) *m, const real *x, const real *branch, const real *u,
                            const double *weight, real *rate, real *rows, real *side, real *margin)
{
    (void)weight;
    MODEL(integrands)(x, &m->p, m->node);
#if defined(PATHS)
    MODEL(standing)(m, x, branch, u, weight);
#endif /* PATHS */
    MODEL(stage)(x, m->node, branch, u, &m->p, rate, rows, side, margin);
}

/* Most iterations of a step, and after how many it is given up if changes stagnate. */
enum { MOST_ITERATIONS = 12, SOON = 1 };
/*
 * The same for a fixed step, which may start far from its root: on the steep side of an exponential
 * law an iteration moves by one width of it, however short the step. After NOISY iterations,
 * changes that stagnate may be as large as MOST_NOISE.
 */
enum { MOST_OF_FIXED = 1000, LATE = 900, NOISY = 300 };
/* Slopes are computed anew where a change is more than this part of the one before. */
#define SLOW 0.1
/* Below this change, in units of noise, the next one is expected to shrink by the same factor. */
#define NEAR 1e8
/* Largest residual of a root, relative to the state: round-off of a stiff state leaves as much. */
#define LEFT 0.01
#if defined(COSTATES)
/* Changes of lanes that stop early are not expected to shrink by more than this factor. */
#define SHRINKS 1e-2
#endif /* COSTATES */
/* If the second change is more than this, in units of noise, more nodes are considered at once. */
#define FAR 1e9
/* Changes oscillate where at least this part of one comes back with the other sign. */
#define TO_AND_FRO 0.5

#if PAIRS
/* The pair of lane j of a vector; lanes left over have the last one once more. */
#define OF_LANE(j) ((j) < PAIRS ? (j) : PAIRS - 1)

/* The step times the eigenvalues of the pairs from `first` on. */
static inline MODEL(complex) MODEL(gamma)(real h, long first)
{
    MODEL(complex) gamma;
    for (long j = 0; j < TOGETHER; ++j) {
        const double *value = eigenvalue[STAGES % 2 + OF_LANE(first + j)];
        PAIR(gamma.re, j) = h * value[0];
        PAIR(gamma.im, j) = h * value[1];
    }
    return gamma;
}
#endif /* PAIRS */

/* Newton's change of the rates, which replaces the residuals in `gap`. */
static void MODEL(change)(const MODEL(block) *m, real h)
{
    if (STAGES > 1)
        MODEL(transform)(m, BASIS_STAGE);
#if STAGES % 2
    MODEL(solve_real)(m, h * filter, m->slope, m->real_factor, SOLVED, m->gap);
#endif
#if PAIRS
    const long n = m->n, size = MODEL(factor_size_complex)(m);
    for (long first = 0; first < PAIRS; first += TOGETHER) {
        real *const one = m->gap + STAGES % 2 * n;
        FOR_SOLVED (m, begin, end)
            for (long k = begin; k < end; ++k)
                for (long j = 0; j < TOGETHER; ++j) {
                    const real *const pair = one + 2 * OF_LANE(first + j) * n + k;
                    PAIR(m->right[k].re, j) = pair[0];
                    PAIR(m->right[k].im, j) = -pair[n];
                }
        MODEL(solve_complex)(m, MODEL(gamma)(h, first), m->slope, m->factor + first * size, SOLVED, m->right);
        FOR_SOLVED (m, begin, end)
            for (long k = begin; k < end; ++k)
                for (long j = 0; j < TOGETHER && first + j < PAIRS; ++j) {
                    real *const pair = one + 2 * (first + j) * n + k;
                    pair[0] = PAIR(m->right[k].re, j);
                    pair[n] = -PAIR(m->right[k].im, j);
                }
    }
#endif /* PAIRS */
    if (STAGES > 1)
        MODEL(transform)(m, STAGE_BASIS);
}

/*
 * Slopes in the middle of the step, on the branches of its middle stage, and their factorisations;
 * lanes that are not in `where` keep their slopes.
 */
static void MODEL(prepare)(const MODEL(block) *m, real h, mask where)
{
    const long middle = STAGES / 2;
    MODEL(reach_of)(m, h, stage_reach[middle], m->reached);
    MODEL(slopes)(m->reached, m->mean + middle * m->given, m->branch + middle * m->branches,
                  m->u + middle * m->inputs, &m->p, m->fresh);
#if defined(BENDS)
    if (!LOSSY)
        MODEL(slopes_split)(m, h, middle);
#endif /* BENDS */
    for (long k = 0; m->fresh != m->slope && k < m->slopes; ++k)
        m->slope[k] = chosen(where, m->fresh[k], m->slope[k]);
    MODEL(factorise_real)(m, h * filter, m->slope, m->real_factor);
#if PAIRS
    const long size = MODEL(factor_size_complex)(m);
    for (long first = 0; first < PAIRS; first += TOGETHER)
        MODEL(factorise_complex)(m, MODEL(gamma)(h, first), m->slope, m->factor + first * size);
#endif /* PAIRS */
}

/* The lanes in which all conditions of the domain hold. */
static mask MODEL(within)(const real *margin)
{
    mask good = none_of(nowhere);
    for (long k = 0; k < MODEL(limits); ++k) {
        const mask inside = margin[k] > 0.0, edge = margin[k] == 0.0;
        good &= MODEL(strict)[k] ? inside : (mask)(inside | edge);
    }
    return good;
}

/* The lanes whose stages all lie in the domain, and in which no process consumes entropy. */
static mask MODEL(accepted)(const MODEL(block) *m)
{
    const long processes = m->processes, ports = MODEL(output_count);
    mask good = none_of(nowhere);
    for (long i = 0; i < STAGES; ++i) {
        const real *rows = m->rows + i * m->booked + ports + processes;
        real total = zero, lowest = zero;
        good &= MODEL(within)(m->margin + i * MODEL(limits));
#pragma omp simd reduction(+ : total) reduction(min : lowest)
        for (long k = 0; k < processes; ++k) {
            total += size_of(rows[k]);
            lowest = chosen(rows[k] < lowest, rows[k], lowest);
        }
#if LOSSY
        lowest = fmin(lowest, m->rows[m->booked - 1]);
        good &= m->rows[m->booked - 1] == m->rows[m->booked - 1];
#endif
        good &= lowest >= -1e-14 * total;
    }
    return good;
}

/*
 * The part of a change to take where changes oscillate. Slopes are those at one point of a step,
 * and differ along a long one, so that changes overshoot. The component of the new change along the
 * last one says by how much.
 */
static real MODEL(damping)(const MODEL(block) *m)
{
    const long n = m->n;
    const real *const largest = m->largest, *const x = m->x, *const before = m->prior, *const gap = m->gap;
    real both = zero, prior = NO_SIZE + zero;
    FOR_SOLVED (m, begin, end) {
#pragma omp simd reduction(+ : both, prior)
        for (long k = begin; k < end; ++k) {
            const real per = 1.0 / (largest[k] + size_of(x[k]) + NO_SIZE);
            for (long j = 0; j < STAGES; ++j) {
                const real last = before[j * n + k] * per;
                both += last * (gap[j * n + k] * per);
                prior += last * last;
            }
        }
    }
    const real left = both / prior;
    const mask fro = left < -TO_AND_FRO;
    return chosen(fro, 1.0 / (1.0 - left), wide(1.0));
}

/*
 * The lanes whose rates solve the equations, and their largest residual as a change of a state, in units of
 * noise. A small change does not show that: changes are small, too, where slopes are far too large.
 */
static mask MODEL(solves)(const MODEL(block) *m, real h, real *residual)
{
    const long n = m->n;
    const real *const largest = m->largest, *const x = m->x, *const rates = m->rates, *const gap = m->gap;
    real most = zero, unsolved = zero; /* how many states are */
    FOR_SOLVED (m, begin, end) {
#pragma omp simd reduction(max : most) reduction(+ : unsolved)
        for (long k = begin; k < end; ++k) {
            real moved = zero, sum = zero;
            for (long j = 0; j < STAGES; ++j) {
                moved = largest_of(moved, size_of(rates[j * n + k]));
                sum += size_of(gap[j * n + k]);
            }
            const real size = largest[k] + size_of(x[k]) + h * moved + NO_SIZE;
            const real noises = h * sum / (NOISE * size + m->noise[k]);
            most = chosen(noises > most, noises, most);
            unsolved += chosen(h * sum <= LEFT * size, zero, wide(1.0));
        }
    }
    *residual = most;
    return unsolved == 0.0;
}

/* The lanes whose means need more nodes, by the rates at hand; see nodes.c. */
static mask MODEL(coarse_by_now)(MODEL(block) *m, real h);

/*
 * The lanes in which a stage lies beyond a switch, by the rates at hand. Their steps will be cut
 * there, and to locate that place rates need not be exact to round-off.
 */
static mask MODEL(strayed)(const MODEL(block) *m)
{
    mask found = nowhere;
    for (long k = 0; k < STAGES * m->branches; ++k) {
        const mask above = m->side[k] > 0.0, on = m->branch[k] > 0.0;
        found |= (above & none_of(on)) | (on & none_of(above));
    }
    return found;
}

/* Add part of the change to the rates; returns the largest change of a state, in units of noise. */
static real MODEL(changed)(const MODEL(block) *m, real h, real part, mask where)
{
    const long n = m->n;
    const real *restrict const gap = m->gap, *restrict const largest = m->largest, *restrict const x = m->x;
    real *restrict const rates = m->rates, *restrict const prior = m->prior;
    real worst = zero, lost = zero; /* nan, where a change is none */
    FOR_SOLVED (m, begin, end) {
#pragma omp simd reduction(max : worst) reduction(+ : lost)
        for (long k = begin; k < end; ++k) {
            real moved = zero, sum = zero;
            for (long j = 0; j < STAGES; ++j) {
                const real all = part * gap[j * n + k], change = chosen(where, all, zero);
                const real rate = rates[j * n + k] + change;
                prior[j * n + k] = change;
                rates[j * n + k] = rate;
                moved = largest_of(moved, size_of(rate));
                sum += size_of(change);
            }
            const real size = NOISE * (largest[k] + size_of(x[k]) + h * moved) + m->noise[k] + NO_SIZE;
            const real noises = h * sum / size;
            worst = chosen(noises > worst, noises, worst);
            lost += 0.0 * noises;
        }
    }
    return worst + lost;
}

#if defined(COSTATES)
/* The lanes whose last changes are the round-off of rates; see nodes.c. */
static mask MODEL(is_round_off)(MODEL(block) *m, real h, mask where);
#endif /* COSTATES */

/*
 * Newton's method for the rates in some lanes, from those at hand; returns the lanes that converge.
 * A lane that has converged does not change while others go on.
 */
static mask MODEL(iterate)(MODEL(block) *m, real h, mask where)
{
    mask going = where, found = nowhere;
    mask renewed = nowhere; /* lanes that got more nodes: earlier changes predict nothing */
    /* with fixed steps the larger of two ratios counts: new slopes may help once, not again */
    real before = zero, left_before = zero;
#if defined(PATHS)
    MODEL(path_parameters)(m->x, &m->p, m->path);
#endif /* PATHS */
#if defined(COSTATES)
    m->early &= none_of(where);
#endif /* COSTATES */
    MODEL(gaps)(m, h, going);
    MODEL(prepare)(m, h, going);
    for (int iteration = 0; iteration < m->most && any(going); ++iteration) {
        m->iterations += chosen(going, wide(1.0), zero);
        MODEL(change)(m, h);
        const real part = iteration && m->late > SOON ? MODEL(damping)(m) : (real)wide(1.0);
        const real worst = MODEL(changed)(m, h, part, going);
        const mask far = going & (worst > FAR) & none_of(m->fine);
        if (iteration == 1 && !LOSSY && any(far))
            m->fine |= renewed = far & MODEL(coarse_by_now)(m, h);
        else if (iteration > 2)
            renewed = nowhere;
        const mask switched = MODEL(gaps)(m, h, going);
        const mask smaller = (worst < before) & none_of(renewed), lost = none_of(worst < 1e300);
        const mask near = smaller & (worst < NEAR);
        const real left = worst / (before + NO_SIZE);
        real residual;
        const mask solved = MODEL(solves)(m, h, &residual);
        mask good = near & (worst * largest_of(left, left_before) <= 4.0);
        good |= (worst <= 4.0) & none_of(renewed);
#if defined(COSTATES)
        const mask to_noise = good;
        if (iteration)
            good |= m->loose & smaller & (worst * largest_of(left, wide(SHRINKS)) <= m->allowed);
        good |= m->loose & (residual <= m->allowed);
#endif /* COSTATES */
        if (iteration > 1) { /* stagnation: round-off, or no root */
            const mask stays = (worst > m->stays * before) & none_of(good | renewed);
            good |= stays & (worst < (m->late == SOON || iteration > NOISY ? MOST_NOISE : 100.0));
#if defined(COSTATES)
            const mask small = going & stays & none_of(good) & (worst <= m->allowed);
            if (m->late == SOON && any(small))
                good |= MODEL(is_round_off)(m, h, small);
#endif /* COSTATES */
            if (iteration > m->late)
                going &= none_of(stays & none_of(good));
        }
        good &= solved & none_of(lost);
        const mask enough = m->sketch & (worst < m->enough) & going & none_of(good | lost);
        if (any(enough)) {
            m->sketched |= enough & MODEL(strayed)(m);
            good |= m->sketched;
        }
#if defined(COSTATES)
        m->early |= going & good & none_of(to_noise | m->sketched);
#endif /* COSTATES */
        found |= going & good;
        going &= none_of(good | lost);
        const mask slow = (worst > SLOW * before) & (before > 0.0);
        if (any((switched | slow) & going))
            MODEL(prepare)(m, h, (switched | slow) & going);
        before = worst;
        left_before = iteration && m->late > SOON ? left : (real)zero;
    }
#if LOSSY /* the ledger books the loss as it is rounded, so the rate has to contain the same */
    m->rates[m->first[MODEL(heated)]] += m->gap[m->first[MODEL(heated)]];
#endif
    return found;
}
