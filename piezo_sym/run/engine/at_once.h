/*
 * Functions for all stages of a run at once, or for as many nodes: the values of all lanes lie together.
 */
#include <stddef.h>
#if defined(__GNUC__) && !defined(_WIN32)
#pragma GCC visibility push(hidden)
#endif
size_t MODEL(shared_size)(const MODEL(parameters) *p);
void MODEL(share)(void *space, const MODEL(parameters) *p);
void MODEL(stages_at_once)(const void *space, const double *x, const double *mean,
                           const double *branch, const double *u, double *rate, double *rows,
                           double *side, double *margin);
void MODEL(costates_at_once)(const void *space, const double *x, const double *mean, double *costate);
void MODEL(nodes_at_once)(const void *space, const double *x, double *value);
/* The values of a sine at the times t, by the numbers of its MODEL(wave) in one lane. */
void MODEL(sines_at_once)(const double *wave, const double *t, double *value);
#if defined(__GNUC__) && !defined(_WIN32)
#pragma GCC visibility pop
#endif
