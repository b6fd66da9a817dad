/*
 * Steps that can be repeated to the bit: their results depend only on the state and time at which they
 * begin, their length and the branches of their stages, not on what was solved before.  A tape keeps
 * these data for each step of one run.  Comes after crossings.c.
 */
#if REAL_WIDTH == 1

/* Solve the step that begins at m.x, on the branches of the block; returns whether it has rates. */
static int MODEL(solve_again)(MODEL(batch) *b, double t, double h)
{
    MODEL(block) *m = &b->m;
    const MODEL(block) before = *m;
    m->most = MOST_OF_FIXED, m->late = LATE, m->stays = 0.7, m->over = m->sketch = nowhere;
    m->largest = b->tape->scale;
    MODEL(inputs_at)(b, 1, t, b->some_inputs);
    MODEL(point)(b, m->x, m->branch, NULL, b->some_rate, b->some_side);
    for (long i = 0; i < STAGES; ++i) {
        MODEL(inputs_at)(b, 1, t + stage_at[i] * h, m->u + i * m->inputs);
        memcpy(m->rates + i * m->n, b->some_rate, (size_t)m->n * sizeof(real));
    }
    const int found = MODEL(solve)(m, h, 1) && MODEL(accepted)(m);
    m->most = before.most, m->late = before.late, m->stays = before.stays, m->over = before.over;
    m->largest = before.largest;
    MODEL(reach_of)(m, h, stage_weight, m->end);
    return found;
}

/* Solve the step that a lane is to book as replay() will, and put it on the tape; 0 if it has no rates. */
static int MODEL(keep_on_tape)(MODEL(batch) *b)
{
    MODEL(block) *m = &b->m;
    const MODEL(lane) *l = b->lane;
    MODEL(tape) *to = b->tape;
    const size_t n = (size_t)m->n, branches = STAGES * (size_t)m->branches;
    if (!MODEL(solve_again)(b, l->t, l->step))
        return 0;
    memcpy(to->x + to->count * m->n, m->x, n * sizeof(real));
    memcpy(to->branch + to->count * STAGES * m->branches, m->branch, branches * sizeof(real));
    to->t[to->count] = l->t, to->h[to->count] = l->step;
    ++to->count;
    memcpy(b->known, m->rates, STAGES * n * sizeof(real));
    MODEL(increments)(b, l->step, b->part);
    return 1;
}

/* Record the steps of the run on a tape from now on. */
void MODEL(keep)(MODEL(batch) *b, MODEL(tape) *tape);
void MODEL(keep)(MODEL(batch) *b, MODEL(tape) *tape)
{
    b->tape = tape;
}

/* Repeat a step of a tape in a batch whose run has begun; returns whether it has rates. */
int MODEL(replay)(MODEL(batch) *b, double t, double h, const double *x, const double *branch,
                  double *rates, double *u, double *end);
int MODEL(replay)(MODEL(batch) *b, double t, double h, const double *x, const double *branch,
                  double *rates, double *u, double *end)
{
    MODEL(block) *m = &b->m;
    const size_t n = (size_t)m->n, inputs = (size_t)m->inputs;
    const MODEL(segment) *segment = b->tape->segments;
    while (t >= segment->stop)
        ++segment;
    b->lane->segment = segment;
    MODEL(enter)(b->waves, segment, m->inputs, 0);
    memcpy(m->x, x, n * sizeof(real));
    memcpy(m->branch, branch, STAGES * (size_t)m->branches * sizeof(real));
    const int found = MODEL(solve_again)(b, t, h);
    memcpy(rates, m->rates, STAGES * n * sizeof(real));
    memcpy(u, m->u, STAGES * inputs * sizeof(real));
    MODEL(inputs_at)(b, 1, t + h, u + STAGES * inputs);
    memcpy(end, m->end, n * sizeof(real));
    return found;
}
#endif
