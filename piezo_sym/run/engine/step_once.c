/* Some steps at a call, for closed loops: plants, each a batch of one run.  Comes after batch.c. */

/* The data of one plant that a call needs; the caller sets the inputs. */
typedef struct {
    MODEL(batch) *batch;
    MODEL(run) *run;
    MODEL(signal) *signals; /* of the run, which are constant in a step */
    const double *u;
    double *y;
    /* functions of <model>.c, whose numbers are those of one run */
    void (*outputs)(const double *, const double *, const MODEL(parameters) *, double *);
    void (*margins)(const double *, const double *, const MODEL(parameters) *, double *);
    double *kept; /* n, n, 2 booked: state, largest magnitudes and ledger before a call */
    double *margin;                  /* of each condition of the domain */
    const long *conditions, *strict; /* those on inputs alone, and whether equality is outside */
    long limits;
    long steps, plants; /* steps per call; plants in the array from this one on */
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

static void MODEL(keep_state)(const MODEL(stepper) *t)
{
    const size_t n = (size_t)t->batch->m.n, booked = 2 * (size_t)t->batch->m.booked;
    memcpy(t->kept, t->run->x, n * sizeof(double));
    memcpy(t->kept + n, t->run->largest, n * sizeof(double));
    memcpy(t->kept + 2 * n, t->run->ledger, booked * sizeof(double));
}

static void MODEL(restore_state)(MODEL(stepper) *t)
{
    const size_t n = (size_t)t->batch->m.n, booked = 2 * (size_t)t->batch->m.booked;
    memcpy(t->run->x, t->kept, n * sizeof(double));
    memcpy(t->run->largest, t->kept + n, n * sizeof(double));
    memcpy(t->run->ledger, t->kept + 2 * n, booked * sizeof(double));
    MODEL(forget)(t);
}

/* Take the steps of one call with the inputs u, and write the outputs; returns whether all succeeded. */
static int MODEL(steps_on)(MODEL(stepper) *t)
{
    MODEL(batch) *b = t->batch;
    MODEL(lane) *l = b->lane;
    for (long k = 0; k < b->m.inputs; ++k)
        t->signals[k].offset = t->u[k];
    MODEL(enter)(b->waves, l->segment, b->m.inputs, 0);
    for (long step = 0; step < t->steps; ++step) {
        if (l->phase == IDLE) { /* the last step succeeded: its rates predict this one */
            l->phase = STEP;
            l->t = t->run->t = 0.0;
        }
        while (MODEL(go)(b, 1))
            ;
        if (t->run->failed)
            return 0;
    }
    t->outputs(t->run->x, t->u, t->run->p, t->y);
    return 1;
}

/* Step all plants; returns 0, or the number from 1 of a plant whose step failed, and restores all plants. */
long MODEL(step_once)(MODEL(stepper) *all);
long MODEL(step_once)(MODEL(stepper) *all)
{
    for (long k = 0; k < all->plants; ++k)
        if (!MODEL(inputs_inside)(all + k))
            return k + 1;
    for (long k = 0; k < all->plants; ++k)
        MODEL(keep_state)(all + k);
    for (long k = 0; k < all->plants; ++k)
        if (!MODEL(steps_on)(all + k)) {
            for (long back = 0; back <= k; ++back)
                MODEL(restore_state)(all + back);
            return k + 1;
        }
    return 0;
}
