/*
 * Batches of runs: a lane that has finished one run takes the next.  Comes after dispatch.c.
 *
 * A survey by rough midpoint steps first finds the largest magnitude of each state, by which errors
 * are measured.
 */

/* The request of Python to a batch; fields as in MODEL(batch). */
typedef struct {
    MODEL(run) *runs;
    const double *times;
    long count, samples, over_kinks, either;
    long extra; /* rows of ledgers behind the model's own: a dissipative step books two */
    double stop, tolerance, first, longest, fixed;
} MODEL(task);

enum { ROUGH_ITERATIONS = 8 };
/* Accuracy of rates that only serve to locate a switch, as a fraction of the tolerance. */
#define SKETCH 0.01
/* Accuracy of rates whose residuals become heat, as a fraction of the tolerance. */
#define RESIDUAL 3e-2
/* With at least this many switches it may be better to step over kinks. */
enum { MANY = 8 };
/* Accuracy of a survey's steps, and the shortest of them, as a fraction of the longest. */
#define ROUGH 1e-3
#define SHORTEST 1e-6
/* The most steps of a survey; later magnitudes count when the run itself reaches them. */
enum { MOST_SURVEYED = 10000 };

/* Sizes and places of a model's arrays, see the model's own function. */
void MODEL(sizes_of)(const MODEL(parameters) *p, long *out);
void MODEL(sizes_of)(const MODEL(parameters) *p, long *out)
{
    MODEL(reals) reals;
    MODEL(place_reals)(&reals, p, NULL);
    MODEL(sizes)(&reals, out);
}

/* Place a batch's arrays in memory, which may be NULL; returns their size in bytes. */
static size_t MODEL(places)(MODEL(batch) *b, const MODEL(task) *task, real *memory)
{
    MODEL(block) *m = &b->m;
    long at = MODEL(make)(m, task->runs->p, task->extra, b->sizes, memory);
#define PLACE(array, size) (b->array = memory ? memory + at : NULL, at += (size))
    PLACE(rate, m->n);
    PLACE(side, m->branches);
    PLACE(after, m->branches);
    PLACE(slack, m->branches);
    PLACE(interval, 2 * m->branches);
    PLACE(successor, 2 * m->branches);
    MODEL(repeats) *const r = &b->repeats;
    r->steps = m->branches && m->n <= MOST_STATES_KEPT && task->fixed == 0.0 ? MOST_KEPT : 0;
    const long row = r->steps ? m->n : 0;
    PLACE(repeats.number, 2 * m->branches);
    PLACE(repeats.since, r->steps);
    PLACE(repeats.lasted, r->steps);
    PLACE(repeats.rates, r->steps * STAGES * row);
    PLACE(repeats.change, r->steps * STAGES * row);
    PLACE(repeats.guess, STAGES * row);
    PLACE(repeats.more, row);
    PLACE(repeats.by_step, row);
    PLACE(widest, m->branches);
    PLACE(sums, m->booked);
    PLACE(lost, m->booked);
    PLACE(known, STAGES * m->n);
    PLACE(kept, m->n);
    PLACE(kept_branch, STAGES * m->branches);
    PLACE(kept_sums, m->booked);
    PLACE(kept_lost, m->booked);
    PLACE(end_rate, m->n);
    PLACE(end_side, m->branches);
    PLACE(end_branch, m->branches);
    PLACE(part, m->booked);
    PLACE(some_rate, m->n);
    PLACE(some_left, m->n);
    PLACE(some_side, m->branches);
    PLACE(some_rows, m->booked);
    PLACE(some_margin, MODEL(limits));
    PLACE(some_inputs, m->inputs);
    const long waves = m->inputs * (long)(sizeof(MODEL(wave)) / sizeof(real));
    b->waves = memory ? (MODEL(wave) *)(memory + at) : NULL, at += waves;
#undef PLACE
    return (size_t)at * sizeof(real);
}

/* Whether the model has dissipative steps. */
extern const long MODEL(lossy);
const long MODEL(lossy) = MODEL(heated) >= 0;

/* Whether a law of the model jumps. */
extern const long MODEL(jumping);
const long MODEL(jumping) = MODEL(jumps);

/* Alignment of vectors, in bytes. */
enum { ALIGNED = 64 };

/* The size of a batch, in bytes. */
long MODEL(batch_size)(const MODEL(task) *task);
long MODEL(batch_size)(const MODEL(task) *task)
{
    MODEL(batch) b;
    return (long)(sizeof b + ALIGNED + MODEL(places)(&b, task, NULL));
}

/* Make a batch in memory of its size, which is aligned as vectors are, and zero. */
void MODEL(open)(MODEL(batch) *b, const MODEL(task) *task);
void MODEL(open)(MODEL(batch) *b, const MODEL(task) *task)
{
    const uintptr_t place = (uintptr_t)(b + 1);
    MODEL(places)(b, task, (real *)((place + ALIGNED - 1) / ALIGNED * ALIGNED));
    b->runs = task->runs, b->times = task->times;
    b->count = task->count, b->samples = task->samples;
    b->stop = task->stop, b->tolerance = task->tolerance;
    const double beyond = BEYOND * task->tolerance;
    b->beyond = fmax(AT_END, MODEL(jumps) ? beyond : fmin(sqrt(beyond), BEYOND));
    b->first = task->first, b->longest = task->longest, b->fixed = task->fixed;
    b->either = task->either && b->m.branches >= MANY;
    b->m.most = task->fixed > 0.0 ? MOST_OF_FIXED : MOST_ITERATIONS;
    b->m.late = task->fixed > 0.0 ? LATE : SOON;
    b->m.stays = task->fixed > 0.0 ? 0.7 : 0.3;
    b->m.sketch = b->m.sketched = nowhere;
    b->m.enough = SKETCH * task->tolerance / NOISE;
#if defined(COSTATES)
    b->m.loose = b->m.early = nowhere;
    b->m.allowed = RESIDUAL * task->tolerance / NOISE;
#endif /* COSTATES */
    b->over_kinks = task->over_kinks && !b->either;
    b->m.over = nowhere;
}

/* Let a lane take a run: its parameters, its state, and its ledger. */
static void MODEL(load)(MODEL(batch) *b, int lane, MODEL(run) *run)
{
    MODEL(block) *m = &b->m;
    MODEL(give)(&m->p, run->p, lane);
    m->own = run->p;
#if defined(LANES)
    MODEL(share)(m->shared, run->p);
#endif
    for (long k = 0; k < m->n; ++k) {
        LANE(m->x, k, lane) = run->x[k];
        LANE(m->largest, k, lane) = run->largest[k];
        LANE(m->noise, k, lane) = run->noise[k];
    }
    for (long k = 0; k < m->booked; ++k) {
        LANE(b->sums, k, lane) = run->ledger[k];
        LANE(b->lost, k, lane) = run->ledger[m->booked + k];
    }
    for (long k = 0; k < STAGES * m->branches; ++k)
        LANE(m->branch, k, lane) = 0.0;
    LANE(&m->iterations, 0, lane) = (double)run->iterations;
    b->lane[lane] = (MODEL(lane)){.run = run, .segment = run->segments, .t = run->t, .phase = BEGIN};
    MODEL(enter)(b->waves, run->segments, m->inputs, lane);
    b->lane[lane].h = b->fixed > 0.0 ? b->fixed : b->first;
    b->lane[lane].steady = b->lane[lane].ahead = b->lane[lane].hard = HUGE_VAL;
    b->lane[lane].kept = -HUGE_VAL;
    b->lane[lane].growth = 1.0;
    b->lane[lane].which = b->lane[lane].turned = b->lane[lane].goal = -1;
    b->lane[lane].passing = b->lane[lane].recalled = -1;
    for (long k = 0; k < 2 * m->branches; ++k)
        LANE(b->interval, k, lane) = 0.0, LANE(b->repeats.number, k, lane) = -1.0;
    for (long k = 0; k < m->branches; ++k)
        LANE(b->after, k, lane) = LANE(b->slack, k, lane) = LANE(b->widest, k, lane) = 0.0;
    b->lane[lane].since = run->t;
    SET(b->m.over, lane, b->over_kinks);
    MODEL(sample_here)(b, lane);
}

/* Midpoint steps of length h by Newton's method, midpoints in m->reached; returns the lanes that succeed. */
static mask MODEL(midpoint)(MODEL(batch) *b, real h, mask where)
{
    MODEL(block) *m = &b->m;
    mask going = where;
    memcpy(m->reached, m->x, (size_t)m->n * sizeof(real));
#if defined(PATHS)
    m->surveyed = h;
#endif
    for (int iteration = 0; iteration < ROUGH_ITERATIONS && any(going); ++iteration) {
        real worst = zero;
        m->iterations += chosen(going, wide(1.0), zero);
        for (int again = 0; again < 3; ++again) {
            MODEL(point)(b, m->reached, m->branch, NULL, b->some_rate, b->some_side);
            if (!any(MODEL(choose)(m->branches, b->some_side, m->branch, going)))
                break;
        }
        MODEL(slopes)(m->reached, m->node, m->branch, b->some_inputs, &m->p, m->slope);
        MODEL(factorise_real)(m, 0.5 * h, m->slope, m->real_factor);
        for (long k = 0; k < m->n; ++k)
            b->some_rate[k] = m->x[k] + 0.5 * h * b->some_rate[k] - m->reached[k];
        MODEL(solve_real)(m, 0.5 * h, m->slope, m->real_factor, b->some_rate);
        for (long k = 0; k < m->n; ++k) {
            const real change = chosen(going, b->some_rate[k], zero);
            m->reached[k] += change;
            worst = largest_of(size_of(change) / (m->largest[k] + size_of(m->reached[k]) + 1e-300), worst);
        }
        const mask far = worst > ROUGH, lost = worst != worst;
        where &= none_of(lost & going);
        going &= far;
    }
#if defined(PATHS)
    m->surveyed = zero;
#endif
    return where & MODEL(within)(b->some_margin) & none_of(going);
}

/*
 * Prepare a lane for the next step of its survey; returns whether there is one. After a failed step, a shorter
 * one begins at the midpoint of the step before: there fast modes do not ring. At the ends of steps too long for
 * them they do, with an amplitude that short steps would take for a motion.
 */
static int MODEL(go_on_surveying)(MODEL(batch) *b, int lane, double longest, int good)
{
    MODEL(lane) *l = b->lane + lane;
    const double stop = MODEL(until)(b, l);
    if (!good) {
        l->t -= 0.5 * l->known;
        l->known = 0.0;
        l->h *= 0.25;
        return l->h > longest * SHORTEST;
    }
    l->known = l->h;
    l->t = l->t + l->h < stop - 1e-9 * l->h ? l->t + l->h : stop;
    l->h = MODEL(lesser)(2.0 * l->h, longest);
    if (l->t >= stop && l->t < b->stop) {
        MODEL(enter)(b->waves, ++l->segment, b->m.inputs, lane);
        l->known = 0.0;
    }
    return l->t < b->stop;
}

/* Survey as many runs as there are lanes, from `first` on, by steps of at most this length. */
static void MODEL(survey_some)(MODEL(batch) *b, long first, double longest)
{
    MODEL(block) *m = &b->m;
    mask going = nowhere;
    for (int lane = 0; lane < REAL_WIDTH && first + lane < b->count; ++lane) {
        MODEL(load)(b, lane, b->runs + first + lane);
        b->lane[lane].h = longest;
        SET(going, lane, 1);
    }
    for (long step = 0; step < MOST_SURVEYED && any(going); ++step) {
        real h = zero;
        for (int lane = 0; lane < REAL_WIDTH; ++lane) {
            MODEL(lane) *l = b->lane + lane;
            if (!IN(going, lane))
                continue;
            l->h = MODEL(lesser)(l->h, MODEL(until)(b, l) - l->t);
            LANE(&h, 0, lane) = l->h;
        }
        MODEL(inputs_at)(b, going, MODEL(now)(b) + 0.5 * h, b->some_inputs);
        const mask good = MODEL(midpoint)(b, h, going);
        mask back = nowhere;
        for (int lane = 0; lane < REAL_WIDTH; ++lane)
            SET(back, lane, IN(going, lane) && !IN(good, lane) && b->lane[lane].known > 0.0);
        for (long k = 0; k < m->n; ++k) {
            const real middle = m->reached[k];
            m->largest[k] = chosen(good, largest_of(size_of(middle), m->largest[k]), m->largest[k]);
            m->x[k] = chosen(good, 2.0 * middle - m->x[k], chosen(back, b->kept[k], m->x[k]));
            b->kept[k] = chosen(good, middle, b->kept[k]);
        }
        for (int lane = 0; lane < REAL_WIDTH; ++lane)
            if (IN(going, lane))
                SET(going, lane, MODEL(go_on_surveying)(b, lane, longest, IN(good, lane) != 0));
    }
    for (int lane = 0; lane < REAL_WIDTH && first + lane < b->count; ++lane) {
        for (long k = 0; k < m->n; ++k)
            b->runs[first + lane].largest[k] = LANE(m->largest, k, lane);
        b->lane[lane].phase = IDLE;
    }
}

/* Find how large the states of all runs become, by steps of at most this length. */
void MODEL(survey)(MODEL(batch) *b, double longest);
void MODEL(survey)(MODEL(batch) *b, double longest)
{
    for (long first = 0; first < b->count; first += REAL_WIDTH)
        MODEL(survey_some)(b, first, longest);
}

/* Take at most `steps` steps in each lane; returns whether there is more to do. */
int MODEL(go)(MODEL(batch) *b, long steps);
int MODEL(go)(MODEL(batch) *b, long steps)
{
    for (; steps > 0; --steps) {
        mask begins = nowhere;
        int busy = 0;
        for (int lane = 0; lane < REAL_WIDTH; ++lane) {
            while (b->lane[lane].phase == IDLE && b->next < b->count) {
                MODEL(run) *run = b->runs + b->next++;
                if (!run->failed && run->t < b->stop)
                    MODEL(load)(b, lane, run);
            }
            busy |= b->lane[lane].phase != IDLE;
            SET(begins, lane, b->lane[lane].phase == BEGIN);
        }
        if (!busy)
            return 0;
        if (any(begins)) {
            MODEL(rates_here)(b, begins, begins);
            for (int lane = 0; lane < REAL_WIDTH; ++lane)
                if (IN(begins, lane)) {
                    b->lane[lane].phase = STEP;
                    b->lane[lane].known = 0.0;
                }
        }
        MODEL(step_lanes)(b);
    }
    return 1;
}
