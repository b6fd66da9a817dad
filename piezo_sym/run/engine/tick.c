/* A step at a time, for closed loops.  Behind stepper.c, which makes it. */

/* All that a call needs, in one place; the caller decides the inputs. */
typedef struct {
    MODEL(model) model;
    MODEL(path) path;
    double *u, *y;
    double h;
    double *margins;                 /* of each condition of the domain */
    const long *conditions, *strict; /* those on inputs alone, and whether equality is outside */
    long limits;
} MODEL(stepper);

/* Whether the inputs lie in the domain; steps look at the conditions on states. */
static int MODEL(inputs_inside)(const MODEL(stepper) *t)
{
    if (t->limits)
        MODEL(margins)(t->path.x, t->u, t->model.p, t->margins);
    for (long k = 0; k < t->limits; ++k) {
        const double margin = t->margins[t->conditions[k]];
        if (!(margin > 0.0 || (margin == 0.0 && !t->strict[k])))
            return 0;
    }
    return 1;
}

/* Takes a step over h with the inputs u, and writes the outputs after it; 0 if there is none. */
int MODEL(tick)(MODEL(stepper) *t);
int MODEL(tick)(MODEL(stepper) *t)
{
    if (!MODEL(inputs_inside)(t) || !MODEL(step)(&t->model, &t->path, t->u, t->h, 0))
        return 0;
    MODEL(outputs)(t->path.x, t->u, t->model.p, t->y);
    return 1;
}
