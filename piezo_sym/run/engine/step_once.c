/* One step at a time, for closed loops: a batch of one run.  Comes after batch.c. */

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

/* Reload the run, so that the next step begins at the state that Python has set. */
void MODEL(forget)(MODEL(stepper) *t);
void MODEL(forget)(MODEL(stepper) *t)
{
    t->run->t = 0.0, t->run->failed = 0;
    t->batch->next = 1;
    MODEL(load)(t->batch, 0, t->run);
}

/* Take a step with the inputs u and write the outputs; returns 0, and restores all, if there is none. */
int MODEL(step_once)(MODEL(stepper) *t);
int MODEL(step_once)(MODEL(stepper) *t)
{
    MODEL(batch) *b = t->batch;
    MODEL(lane) *l = b->lane;
    MODEL(run) *run = t->run;
    const size_t n = (size_t)b->m.n, booked = 2 * (size_t)b->m.booked;
    if (!MODEL(inputs_inside)(t))
        return 0;
    if (l->phase == IDLE) { /* the last step succeeded: its rates predict this one */
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
