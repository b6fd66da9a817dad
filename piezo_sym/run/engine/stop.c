/*
 * A path functional: what an element with an inner state z does while its coordinate C, whose rates
 * at the stages are its drive, follows a polynomial. Comes after coordinate.c.
 *
 * Stage i is given the means int_0^1 (l_i/b_i) ... dtau of the effort F, of the slip's rate
 * dC/dt - dz/dt and of the heat. So h sum_i b_i F_i C'_i is the work int F dC, and z ends where its
 * path ends, wherever it begins or ceases to yield.
 *
 * Stops on one coordinate have one polynomial: they are computed side by side, without branches.
 */

/* What happens before this fraction of a step counts as at its beginning. */
#define BEGUN 1e-6
/* An inner state this close to its limit, relative to it, was put there by the step before. */
#define PUT_THERE 1e-14
/* Accuracy of a place, as a fraction of the step: the error of work done there goes with its square. */
#define FOUND 1e-8

/* Stops on one coordinate, side by side: the most at a time, and lanes searched at a time. */
enum { SOME = 64, SEEN = 16 };

/*
 * What they have: inner state, stiffness, limit. What they give: for the stages the means of effort,
 * rate of the slip and heat; the share, and the fraction of the step in which z follows C. On the way:
 * where z is, whether it yields, and since when it follows C; the heat, and where in a piece of the step
 * it comes to its limit.
 *
 * The share is for Newton's method: how the mean effort responds to a constant change of dC/dt, relative
 * to that of a z that follows C all the way. It is a*a if z follows C in one stretch, a fraction a of the
 * step: a change of C that grows from there on acts for a fraction a, and is a/2 on the mean.
 */
typedef struct {
    long count;
    double z[SOME], k[SOME], r[SOME];
    double mean[SHARE][STAGES][SOME], share[SOME], follows[SOME];
    double now[SOME], yields[SOME], since[SOME], heat[SOME], room[SOME], meets[SOME], until[SOME];
    double lead[STAGES][SOME], moved[STAGES][SOME];
} MODEL(stops);

/* A piece of a step, in which C is monotonic: its ends, C there, and the side to which it goes. */
typedef struct {
    double low, high, from, more, side;
} MODEL(piece);

/*
 * The piece's part up to which z follows C: to the end, or to where C has moved by the distance
 * to the limit. By Newton's method and bisection, in all lanes as long as one of them moves.
 */
static void MODEL(find_limits)(const MODEL(coordinate) *w, const MODEL(piece) *piece, MODEL(stops) *s)
{
    double low[SOME], high[SOME], moving = 0.0;
    for (long j = 0; j < s->count; ++j) {
        const double left = piece->side * s->r[j] - s->now[j];
        const double room = fabs(left) <= PUT_THERE * s->r[j] ? 0.0 : left;
        const double meets = fabs(piece->more) > fabs(room) ? 1.0 : 0.0;
        const double part = meets > 0.0 ? room / piece->more : 1.0;
        s->room[j] = room, s->meets[j] = meets;
        low[j] = piece->low, high[j] = piece->high;
        s->until[j] = piece->low + part * (piece->high - piece->low);
        moving += part > 0.0 && part < 1.0 ? 1.0 : 0.0;
    }
    for (int again = 0; STAGES > 1 && again < 100 && moving > 0.0; ++again) {
        moving = 0.0;
#pragma omp simd reduction(+ : moving)
        for (long j = 0; j < s->count; ++j) {
            const double at = s->until[j];
            double sum = w->gone[STAGES], slope = 0.0;
            for (long n = STAGES; n-- > 0;) {
                slope = sum + at * slope;
                sum = w->gone[n] + at * sum;
            }
            const double over = piece->side * (sum - piece->from - s->room[j]);
            const double below = over < 0.0 ? at : low[j], above = over < 0.0 ? high[j] : at;
            const double next = at - piece->side * over / slope, half = 0.5 * (below + above);
            const double inside = next > below && next < above ? next : half;
            const double search = s->meets[j] > 0.0 && s->room[j] != 0.0 ? 1.0 : 0.0;
            low[j] = below, high[j] = above;
            s->until[j] = search > 0.0 ? inside : at;
            moving += search > 0.0 && fabs(inside - at) > FOUND ? 1.0 : 0.0;
        }
    }
}

/*
 * Add the means of the effort in a piece's part in which z follows C: F = k (now + C - C(low)).
 * Integrals of the stages' weights over that part, and of these times the rate of C, are in `lead`
 * and `moved`. Exact: all integrands are of degree < 2s.
 */
static void MODEL(add_following)(const MODEL(coordinate) *w, const MODEL(piece) *piece, MODEL(stops) *s)
{
    memset(s->lead, 0, sizeof s->lead);
    memset(s->moved, 0, sizeof s->moved);
    for (long q = 0; q < STAGES; ++q)
#pragma omp simd
        for (long j = 0; j < s->count; ++j) {
            const double length = s->until[j] - piece->low, at = piece->low + length * stage_at[q];
            const double gone = MODEL(polynomial)(w->gone, STAGES, at) - piece->from;
            const double effort = s->k[j] * (s->now[j] + gone);
            const double rate = MODEL(polynomial)(w->speed, STAGES - 1, at) / w->h;
            for (long i = 0; i < STAGES; ++i) {
                double part = length * stage_weight[q] * (stage_lead[i] / stage_weight[i]);
                for (long n = 0; n < STAGES; ++n)
                    part *= n == i ? 1.0 : at - stage_at[n];
                s->lead[i][j] += part;
                s->moved[i][j] += part * rate;
                s->mean[EFFORT][i][j] += part * effort;
            }
        }
}

/* Add the means of the piece's rest, in which z stays at its limit: all but the part before. */
static void MODEL(add_yielding)(const MODEL(coordinate) *w, const MODEL(piece) *piece, MODEL(stops) *s)
{
    const double length = piece->high - piece->low;
    for (long i = 0; i < STAGES; ++i) {
        double lead = 0.0, moved = 0.0;
        for (long q = 0; q < STAGES; ++q) {
            const double at = piece->low + length * stage_at[q];
            double part = length * stage_weight[q] * (stage_lead[i] / stage_weight[i]);
            for (long n = 0; n < STAGES; ++n)
                part *= n == i ? 1.0 : at - stage_at[n];
            lead += part;
            moved += part * (MODEL(polynomial)(w->speed, STAGES - 1, at) / w->h);
        }
#pragma omp simd
        for (long j = 0; j < s->count; ++j) {
            const double effort = s->k[j] * (piece->side * s->r[j]);
            const double slip = s->meets[j] > 0.0 ? moved - s->moved[i][j] : 0.0;
            s->mean[EFFORT][i][j] += s->meets[j] > 0.0 ? effort * (lead - s->lead[i][j]) : 0.0;
            s->mean[SLIP][i][j] += slip;
            s->mean[HEAT][i][j] += effort * slip;
        }
    }
}

/* Take stops to the end of a piece, and note where they begin, or cease, to yield. */
static void MODEL(pass)(MODEL(coordinate) *w, const MODEL(piece) *piece, MODEL(stops) *s)
{
    double first = w->yields, times = 0.0;
#pragma omp simd reduction(+ : times) reduction(min : first)
    for (long j = 0; j < s->count; ++j) {
        const double until = s->until[j], limit = piece->side * s->r[j];
        const double begins = s->meets[j] > 0.0 ? until : 1.0;
        const double place = s->yields[j] > 0.0 && until > piece->low ? piece->low : begins;
        const double inside = place > BEGUN && place < 1.0 ? place : 1.0;
        const double beyond = s->k[j] * s->r[j] * (fabs(piece->more) - fabs(s->room[j]));
        times += inside < 1.0 ? 1.0 : 0.0;
        first = inside < first ? inside : first;
        s->heat[j] += s->meets[j] > 0.0 ? beyond : 0.0;
        s->now[j] = s->meets[j] > 0.0 ? limit : s->now[j] + piece->more;
        const double since = s->yields[j] > 0.0 ? piece->low : s->since[j];
        s->follows[j] += until - piece->low;
        s->share[j] += (until - piece->low) * (until + piece->low - 2.0 * since);
        s->since[j] = since;
        s->yields[j] = s->meets[j];
    }
    w->yields = first;
    w->times += times;
}

/*
 * Let the means add up to all of the slip and all of the heat. A stage's mean of the heat may be
 * negative: it becomes 0, the others are scaled to the total.
 */
static void MODEL(settle)(const MODEL(coordinate) *w, MODEL(stops) *s)
{
    const double gone = MODEL(polynomial)(w->gone, STAGES, 1.0);
#pragma omp simd
    for (long j = 0; j < s->count; ++j) {
        double yielded = 0.0, slipped = 0.0;
        for (long i = 0; i < STAGES; ++i) {
            const double heat = s->mean[HEAT][i][j] > 0.0 ? s->mean[HEAT][i][j] : 0.0;
            s->mean[HEAT][i][j] = heat;
            yielded += stage_weight[i] * heat;
            slipped += stage_weight[i] * s->mean[SLIP][i][j];
        }
        const double rest = (gone - (s->now[j] - s->z[j])) / w->h - slipped;
        const double heat = s->heat[j] / w->h, part = yielded > 0.0 ? heat / yielded : 0.0;
        for (long i = 0; i < STAGES; ++i) {
            s->mean[HEAT][i][j] = yielded > 0.0 ? part * s->mean[HEAT][i][j] : heat;
            s->mean[SLIP][i][j] += rest;
#if LOSSY
            s->mean[EFFORT][i][j] = s->k[j] * s->now[j]; /* as all co-states of a dissipative step, at its end */
#endif
        }
    }
}

/* Stop elements: F = k z; z follows C, but stays at -r or r while C goes further. */
static void MODEL(stop)(MODEL(coordinate) *w, MODEL(stops) *s)
{
    memset(s->mean, 0, sizeof s->mean);
    for (long j = 0; j < s->count; ++j) {
        const double z = s->z[j], r = s->r[j];
        const double begin = z > r ? r : z < -r ? -r : z; /* r may have become less */
        s->now[j] = begin;
        s->heat[j] = 0.5 * s->k[j] * (z - begin) * (z + begin);
        s->share[j] = s->follows[j] = s->yields[j] = s->since[j] = 0.0;
    }
    if (!w->pieces)
        MODEL(find_turns)(w);
    for (long n = 0; n < w->pieces; ++n) {
        MODEL(piece) piece = {.low = w->turn[n], .high = w->turn[n + 1]};
        piece.from = MODEL(polynomial)(w->gone, STAGES, piece.low);
        piece.more = MODEL(polynomial)(w->gone, STAGES, piece.high) - piece.from;
        piece.side = piece.more > 0.0 ? 1.0 : -1.0;
        MODEL(find_limits)(w, &piece, s);
        MODEL(add_following)(w, &piece, s);
        MODEL(add_yielding)(w, &piece, s);
        MODEL(pass)(w, &piece, s);
    }
    MODEL(settle)(w, s);
}
