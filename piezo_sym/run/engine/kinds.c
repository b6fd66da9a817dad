/*
 * The two kinds of step that a model has: the ordinary one, and a dissipative one for starts after
 * a jump of the inputs.  STARTS is 1 if the model has the second, else 0: then `start` is never set.
 */

extern const long MODEL(starts);
const long MODEL(starts) = STARTS;

/* How many numbers Newton's method needs, for a step of either kind. */
static long MODEL(change_size)(const MODEL(parameters) *p)
{
    const long size = MODEL(newton_size)(p);
#if STARTS
    const long start = MODEL(newton_size_start)(p);
    return start > size ? start : size;
#else
    return size;
#endif
}

/* The change that Newton's method takes from y; 0 if the step is too long. */
static int MODEL(change)(const MODEL(parameters) *p, long start, const double *x, const double *y,
                         const double *u, double h, double *change)
{
#if STARTS
    if (start)
        return MODEL(newton_start)(x, y, u, h, p, change);
#endif
    (void)start;
    return MODEL(newton)(x, y, u, h, p, change);
}

/* The means of a step, and of a dissipative one then heat and entropy production of its loss. */
static void MODEL(rates)(const MODEL(parameters) *p, long start, const double *x, const double *y,
                         const double *u, double h, double *means)
{
#if STARTS
    if (start) {
        MODEL(means_start)(x, y, u, h, p, means);
        return;
    }
#endif
    (void)start, (void)h;
    MODEL(means)(x, y, u, p, means);
}
