/* A step at a time, for closed loops.  Behind batch.c, whose batch of one run takes it. */

/* All that a call needs, in one place; the caller decides the inputs. */
typedef struct {
    MODEL(batch) *batch;
    MODEL(run) *run;
    MODEL(signal) *signals; /* of the run, which are constant in a step */
    const double *u;
    double *y;
    /* functions of <model>.c, whose numbers are those of one run */
    void (*outputs)(const double *, const double *, const MODEL(parameters) *, double *);
    void (*margins)(const double *, const double *, const MODEL(parameters) *, double *);
    double *kept; /* n, n, 2 booked: state, largest magnitudes and ledger before a step */
    double *margin;                  /* of each condition of the domain */
    const long *conditions, *strict; /* those on inputs alone, and whether equality is outside */
    long limits;
} MODEL(stepper);

/* Whether the inputs lie in the domain; steps look at the conditions on states. */
static int MODEL(inputs_inside)(const MODEL(stepper) *t)
{
    if (t->limits)
        t->margins(t->run->x, t->u, t->run->p, t->margin);
    for (long k = 0; k < t->limits; ++k) {
        const double margin = t->margin[t->conditions[k]];
        if (!(margin > 0.0 || (margin == 0.0 && !t->strict[k])))
            return 0;
    }
    return 1;
}

/* Forget where the last step has led: the next one begins at the run's own state. */
void MODEL(forget)(MODEL(stepper) *t);
void MODEL(forget)(MODEL(stepper) *t)
{
    t->run->t = 0.0, t->run->failed = 0;
    t->batch->next = 1;
    MODEL(load)(t->batch, 0, t->run);
}

/* Takes a step with the inputs u, and writes the outputs after it; 0, and all as before, if none. */
int MODEL(step_once)(MODEL(stepper) *t);
int MODEL(step_once)(MODEL(stepper) *t)
{
    MODEL(batch) *b = t->batch;
    MODEL(lane) *l = b->lane;
    MODEL(run) *run = t->run;
    const size_t n = (size_t)b->m.n, booked = 2 * (size_t)b->m.booked;
    if (!MODEL(inputs_inside)(t))
        return 0;
    if (l->phase == IDLE) { /* it came through: on from there, and what it knows of its rates holds */
        l->phase = STEP;
        l->t = run->t = 0.0;
    }
    memcpy(t->kept, run->x, n * sizeof(double));
    memcpy(t->kept + n, run->largest, n * sizeof(double));
    memcpy(t->kept + 2 * n, run->ledger, booked * sizeof(double));
    for (long k = 0; k < b->m.inputs; ++k)
        t->signals[k].offset = t->u[k];
    while (MODEL(go)(b, 1))
        ;
    if (run->failed) {
        memcpy(run->x, t->kept, n * sizeof(double));
        memcpy(run->largest, t->kept + n, n * sizeof(double));
        memcpy(run->ledger, t->kept + 2 * n, booked * sizeof(double));
        MODEL(forget)(t);
        return 0;
    }
    t->outputs(run->x, t->u, run->p, t->y);
    return 1;
}
