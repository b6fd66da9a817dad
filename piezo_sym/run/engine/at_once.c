/*
 * The stages of one run's step, or nodes of its means, in the lanes of vectors. A translation unit
 * of its own, after waves.c and a generated <model>_step.c: `real` is a vector here, but a number in
 * the engine.
 */

/* Parameters, the same in all lanes. */
typedef struct {
    MODEL(reals) p;
    real values[];
} MODEL(shared_reals);

size_t MODEL(shared_size)(const MODEL(parameters) *p)
{
    MODEL(reals) none;
    return sizeof(MODEL(shared_reals)) + (size_t)MODEL(place_reals)(&none, p, NULL) * sizeof(real);
}

void MODEL(share)(void *space, const MODEL(parameters) *p)
{
    MODEL(shared_reals) *const to = space;
    MODEL(place_reals)(&to->p, p, to->values);
    for (int lane = 0; lane < REAL_WIDTH; ++lane)
        MODEL(give)(&to->p, p, lane);
}

void MODEL(stages_at_once)(const void *space, const double *x, const double *mean,
                           const double *branch, const double *u, double *rate, double *rows,
                           double *side, double *margin)
{
    const MODEL(shared_reals) *const from = space;
    MODEL(stage)((const real *)x, (const real *)mean, (const real *)branch, (const real *)u, &from->p,
                 (real *)rate, (real *)rows, (real *)side, (real *)margin);
}

#if defined(COSTATES)
void MODEL(costates_at_once)(const void *space, const double *x, const double *mean, double *costate)
{
    const MODEL(shared_reals) *const from = space;
    MODEL(costates)((const real *)x, (const real *)mean, &from->p, (real *)costate);
}
#endif

void MODEL(nodes_at_once)(const void *space, const double *x, double *value)
{
    const MODEL(shared_reals) *const from = space;
    MODEL(integrands)((const real *)x, &from->p, (real *)value);
}

void MODEL(sines_at_once)(const double *wave, const double *t, double *value)
{
    const MODEL(wave) in_all = {
        wide(wave[0]), wide(wave[1]), wide(wave[2]), wide(wave[3]), wide(wave[4]), zero,
    };
    *(real *)value = MODEL(sines)(&in_all, *(const real *)t);
}
