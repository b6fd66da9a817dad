/*
 * Runs of fixed steps, one over each interval of a mesh.  Behind stepper.c, whose steps they take;
 * fleet.c does the same with lanes of vectors.
 */

/* A run among others: its path, and arrays for results at samples, a row each. */
typedef struct {
    MODEL(model) model;
    MODEL(path) path;
    double *out_x, *out_sums;
    long done, steps, failed;
} MODEL(member);

/*
 * Intervals that members go through: of lengths h[k], u the inputs at their middles.  Results after
 * interval k go to row sample[k], if it is not negative.  If inputs jump before interval 0, and
 * starts are asked for, `first` holds those of the quarters of its step.
 */
typedef struct {
    long intervals;
    const double *h, *u;
    const long *sample;
    const double *first;
} MODEL(block);

/* One step over each interval; a member stops for good where there is none. */
void MODEL(march)(MODEL(member) *members, long count, const MODEL(block) *b);
void MODEL(march)(MODEL(member) *members, long count, const MODEL(block) *b)
{
    for (MODEL(member) *s = members; s < members + count; ++s) {
        const MODEL(model) *m = &s->model;
        for (; s->done < b->intervals; ++s->done, ++s->steps) {
            const double *u = b->u + s->done * m->inputs, *first = s->done == 0 ? b->first : NULL;
            const long row = b->sample[s->done];
            if (s->failed || !MODEL(across)(&s->model, &s->path, u, b->h[s->done], first)) {
                s->failed = 1;
                break;
            }
            if (row < 0)
                continue;
            memcpy(s->out_x + row * m->n, s->path.x, (size_t)m->n * sizeof(double));
            memcpy(s->out_sums + row * m->rows, s->path.sums, (size_t)m->rows * sizeof(double));
        }
    }
}
