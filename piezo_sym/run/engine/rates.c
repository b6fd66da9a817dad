/*
 * Functions of a state for arrays as NumPy has them: row i of x lies at x + i*columns.  Tiles of
 * columns are taken to vectors, computed, and put back, so that a module's text sees one state.
 */

enum { SIDE = 16 }; /* vectors of a tile at most; so long are pieces of rows: 1 KB, or less */

typedef void MODEL(vectors)(const real *, const real *, const MODEL(parameters) *, real *);

/* Pieces of `count` rows, from first on: to vectors, those of one state side by side. */
static inline void MODEL(gather)(real *to, const double *from, long count, long columns, long side)
{
    for (long i = 0; i < count; ++i)
        for (long k = 0; k < side; ++k) {
            const double *piece = from + i*columns + k*WIDTH;
            memcpy(to + k*count + i, piece, sizeof *to);
            __builtin_prefetch(piece + side*WIDTH); /* the next tile's, while this is computed */
        }
}

static inline void MODEL(scatter)(double *to, const real *from, long count, long columns, long side)
{
    for (long i = 0; i < count; ++i)
        for (long k = 0; k < side; ++k)
            memcpy(to + i*columns + k*WIDTH, from + k*count + i, sizeof *from);
}

extern const long MODEL(tile);
const long MODEL(tile) = SIDE*WIDTH;

/*
 * Rows of a function for each column, of which there are WIDTH or more.  u has a row of columns an
 * input if `own`, else one number an input.  `space` has tile*(n + inputs + rows) numbers.
 */
static __attribute__((noinline)) void MODEL(tiles)(
    MODEL(vectors) *function, const double *x, const double *u, const MODEL(parameters) *p,
    double *out, long columns, const long *sizes, int own, real *space)
{
    const long n = sizes[0], inputs = sizes[1], rows = sizes[2];
    const long fit = columns/WIDTH, side = fit < SIDE ? fit : SIDE, step = side*WIDTH;
    real *from = space, *given = from + side*n, *to = given + side*inputs;
    for (long k = 0; k < side && !own; ++k)
        for (long i = 0; i < inputs; ++i)
            given[k*inputs + i] = wide(u[i]);
    for (long next = 0; next < columns; next += step) {
        /* the last tile ends where the columns do, and computes some of them again */
        const long first = next + step > columns ? columns - step : next;
        MODEL(gather)(from, x + first, n, columns, side);
        if (own)
            MODEL(gather)(given, u + first, inputs, columns, side);
        for (long k = 0; k < side; ++k)
            function(from + k*n, given + k*inputs, p, to + k*rows);
        MODEL(scatter)(out + first, to, rows, columns, side);
    }
}
