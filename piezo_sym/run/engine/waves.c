/* Inputs that are sines, in all lanes at once. Comes after real.h. */

/* The sines of an input in all lanes; `others` is 1 in lanes where it is no sine. at_once.c reads the fields in order. */
typedef struct {
    real amplitude, frequency, rate, phase, offset, others;
} MODEL(wave);

/* The values of sines at the times t. Whole turns are left out: angles stay small in long runs, too. */
static inline real MODEL(sines)(const MODEL(wave) *w, real t)
{
    if (!any(w->amplitude != 0.0))
        return w->offset;
    const real turns = (w->frequency + 0.5 * w->rate * t) * t;
    const real part = turns - ((turns + 0x1.8p52) - 0x1.8p52);
    return w->offset + w->amplitude * sin_of(6.283185307179586476925 * part + w->phase);
}
