/*
 * A module's functions for many states at once.  Comes after <model>.c.
 *
 * States, inputs and results are columns, n, m and rows numbers apart; m is 0 where all share inputs.
 */

/* The compiler of this file, for the attributes of a run. */
#if defined(__clang__)
#define COMPILER "clang " __clang_version__
#elif defined(__GNUC__)
#define COMPILER "gcc " __VERSION__
#else
#define COMPILER "a C compiler"
#endif
extern const char MODEL(compiler)[];
const char MODEL(compiler)[] = COMPILER;

typedef void MODEL(loop)(const double *x, const double *u, const MODEL(parameters) *p, double *out,
                         long columns, long n, long m, long rows);

#define COLUMNS(name, call)                                                                        \
    MODEL(loop) MODEL(name##_columns);                                                             \
    void MODEL(name##_columns)(const double *x, const double *u, const MODEL(parameters) *p,       \
                               double *out, long columns, long n, long m, long rows)               \
    {                                                                                              \
        (void)u, (void)m;                                                                          \
        for (long column = 0; column < columns; ++column)                                          \
            call;                                                                                  \
    }
#define OF_INPUTS(name)                                                                            \
    COLUMNS(name, MODEL(name)(x + column * n, u + column * m, p, out + column * rows))
#define OF_STATES(name) COLUMNS(name, MODEL(name)(x + column * n, p, out + column * rows))
#define SCALAR(name) COLUMNS(name, out[column * rows] = MODEL(name)(x + column * n, p))
OF_INPUTS(rhs)
OF_INPUTS(jacobian)
OF_INPUTS(outputs)
OF_INPUTS(supply)
OF_INPUTS(heat)
OF_INPUTS(entropy_production)
OF_INPUTS(margins)
OF_STATES(temperatures)
SCALAR(energy)
SCALAR(entropy)

/* A loop for many runs: each has states and parameters of its own, and all have the same inputs. */
void MODEL(of_runs)(MODEL(loop) *loop, const MODEL(parameters) *const *p, long runs, const double *x,
                    const double *u, double *out, long columns, long n, long m, long rows);
void MODEL(of_runs)(MODEL(loop) *loop, const MODEL(parameters) *const *p, long runs, const double *x,
                    const double *u, double *out, long columns, long n, long m, long rows)
{
    for (long k = 0; k < runs; ++k)
        loop(x + k * columns * n, u, p[k], out + k * columns * rows, columns, n, m, rows);
}

enum { TILE = 16 };
extern const long MODEL(tile);
const long MODEL(tile) = TILE;

static inline void gather(double *to, const double *from, long rows, long columns, long count)
{
    for (long i = 0; i < rows; ++i)
        for (long k = 0; k < count; ++k)
            to[k * rows + i] = from[i * columns + k];
}

/*
 * A loop for arrays of NumPy, whose rows lie `columns` numbers apart (those of u if `own`): TILE
 * columns at a time are copied to `space`, where each lies in one piece, and results are copied back.
 */
void MODEL(of_columns)(MODEL(loop) *loop, const double *x, const double *u,
                       const MODEL(parameters) *p, double *out, long columns, long n, long m,
                       long rows, int own, double *space);
void MODEL(of_columns)(MODEL(loop) *loop, const double *x, const double *u,
                       const MODEL(parameters) *p, double *out, long columns, long n, long m,
                       long rows, int own, double *space)
{
    double *const from = space, *const given = from + TILE * n, *const to = given + TILE * m;
    for (long first = 0; first < columns; first += TILE) {
        const long count = columns - first < TILE ? columns - first : TILE;
        gather(from, x + first, n, columns, count);
        if (own)
            gather(given, u + first, m, columns, count);
        loop(from, own ? given : u, p, to, count, n, own ? m : 0, rows);
        for (long i = 0; i < rows; ++i)
            for (long k = 0; k < count; ++k)
                out[i * columns + first + k] = to[k * rows + i];
    }
}
