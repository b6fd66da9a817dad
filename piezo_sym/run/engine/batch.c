/* Batches of runs: a lane that has finished one run takes the next.  Comes after dispatch.c. */

/* The request of Python to a batch; fields as in MODEL(batch). */
typedef struct {
    MODEL(run) *runs;
    const double *times;
    long count, samples, over_kinks, either;
    long extra; /* rows of ledgers behind the model's own: a dissipative step books two */
    double stop, tolerance, first, longest, fixed;
} MODEL(task);

/* Accuracy of rates that only serve to locate a switch, as a fraction of the tolerance. */
#define SKETCH 0.01
/*
 * Accuracy of rates whose residuals become heat, as a fraction of the tolerance. Where that is a large residual, heats
 * would often be scaled by more than MOST_SCALED, so that a step is solved once more; and where states are mere
 * round-off, as at rest, residuals would move them. There the smaller fraction holds.
 */
#define RESIDUAL 0.1
#define SMALL_RESIDUAL 0.03
#define LARGE_RESIDUAL 3e-6
/* With at least this many switches it may be better to step over kinks. */
enum { MANY = 8 };

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
    PLACE(rings, m->n);
    PLACE(side, m->branches);
    PLACE(after, m->branches);
    PLACE(slack, m->branches);
    PLACE(interval, 2 * m->branches);
    PLACE(successor, 2 * m->branches);
    MODEL(history) *const past = &b->past;
    const int recorded = m->branches && m->n <= MOST_STATES_RECORDED && task->fixed == 0.0;
    past->steps = recorded ? MOST_RECORDED : 0;
    PLACE(past.first, 2 * m->branches);
    PLACE(past.begin, past->steps);
    PLACE(past.length, past->steps);
    PLACE(past.rates, past->steps * STAGES * m->n);
    PLACE(past.change, past->steps * STAGES * m->n);
    PLACE(past.aligned, recorded * STAGES * m->n);
    PLACE(past.last_change, recorded * m->n);
    PLACE(past.by_step, recorded * m->n);
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
    PLACE(end_inputs, m->inputs);
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
#if defined(COSTATES)
    const double small = SMALL_RESIDUAL * b->tolerance;
    double residual = MODEL(lesser)(RESIDUAL * b->tolerance, MODEL(greater)(LARGE_RESIDUAL, small));
    for (long k = 0; k < m->n; ++k)
        residual = run->noise[k] > 0.0 ? small : residual;
    LANE(&m->allowed, 0, lane) = residual / NOISE;
#endif /* COSTATES */
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
    SET(b->ringing, lane, 0);
    b->lane[lane].drift = 1.0;
    b->lane[lane].which = b->lane[lane].turned = b->lane[lane].goal = -1;
    b->lane[lane].passing = b->lane[lane].recalled = -1;
    for (long k = 0; k < 2 * m->branches; ++k)
        LANE(b->interval, k, lane) = 0.0, LANE(b->past.first, k, lane) = -1.0;
    for (long k = 0; k < m->branches; ++k)
        LANE(b->after, k, lane) = LANE(b->slack, k, lane) = LANE(b->widest, k, lane) = 0.0;
    b->lane[lane].since = run->t;
    SET(b->m.over, lane, b->over_kinks);
    MODEL(sample_here)(b, lane);
}

/* End runs where they are: they have been interrupted. */
void MODEL(halt)(MODEL(batch) *b);
void MODEL(halt)(MODEL(batch) *b)
{
    for (int lane = 0; lane < REAL_WIDTH; ++lane)
        if (b->lane[lane].phase != IDLE)
            MODEL(end_run)(b, lane, 0);
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
