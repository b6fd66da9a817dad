/*
 * Solution of (1 - gamma J) d = r: the states of each bank, lane by lane, are eliminated first,
 * then the shared unknowns in the order of the model's tables. Included twice: NUMBER is `real`, or
 * a complex number of reals, and NAMED(name) tells the two apart.
 */

/* The sum of products over lanes, in parts that do not wait for one another. */
static inline NUMBER NAMED(total)(const NUMBER *restrict a, const real *restrict b, long lanes)
{
    NUMBER sum[4] = {NONE, NONE, NONE, NONE};
    long j = 0;
    for (; j + 4 <= lanes; j += 4)
        for (long part = 0; part < 4; ++part)
            sum[part] = MORE(sum[part], BY(a[j + part], b[j + part]));
    for (; j < lanes; ++j)
        sum[0] = MORE(sum[0], BY(a[j], b[j]));
    return MORE(MORE(sum[0], sum[1]), MORE(sum[2], sum[3]));
}

/* How many numbers a factorisation has. */
static long NAMED(factor_size)(const MODEL(block) *m)
{
    long size = MODEL(slots) + MODEL(unknowns);
    for (long k = 0; k < MODEL(banks); ++k) {
        const long states = MODEL(lane_states_at)[k + 1] - MODEL(lane_states_at)[k];
        const long columns = MODEL(lane_columns_at)[k + 1] - MODEL(lane_columns_at)[k];
        size += states * (states + columns) * m->lanes[k];
    }
    return size;
}

/* Invert the block of each lane in place: its entry (a, b) is m[(a*states + b)*lanes + j]. */
static void NAMED(invert)(NUMBER *restrict m, long states, long lanes)
{
    for (long k = 0; k < states; ++k)
        for (long j = 0; j < lanes; ++j) {
            NUMBER *const pivot = m + (k * states + k) * lanes + j;
            const NUMBER per = PER(*pivot);
            *pivot = ONE;
            for (long b = 0; b < states; ++b)
                m[(k * states + b) * lanes + j] = TIMES(m[(k * states + b) * lanes + j], per);
            for (long a = 0; a < states; ++a) {
                NUMBER *const entry = m + (a * states + k) * lanes + j;
                const NUMBER share = *entry;
                if (a == k)
                    continue;
                *entry = NONE;
                for (long b = 0; b < states; ++b) {
                    NUMBER *const other = m + (a * states + b) * lanes + j;
                    *other = LESS(*other, TIMES(share, m[(k * states + b) * lanes + j]));
                }
            }
        }
}

/* Factorise 1 - gamma J. */
static void NAMED(factorise)(const MODEL(block) *m, NUMBER gamma, const real *slopes,
                             NUMBER *restrict f)
{
    NUMBER *restrict const slot = f;
    const real *lane = slopes + MODEL(entries);
    NUMBER *part = f + MODEL(slots) + MODEL(unknowns);
    const int *update = MODEL(update);
    for (long k = 0; k < MODEL(slots); ++k)
        slot[k] = NONE;
    for (long k = 0; k < MODEL(unknowns); ++k)
        slot[MODEL(pivot)[k]] = ONE;
    for (long k = 0; k < MODEL(entries); ++k)
        slot[MODEL(place)[k]] = LESS(slot[MODEL(place)[k]], BY(gamma, slopes[k]));
    for (long k = 0; k < MODEL(banks); ++k) {
        const long lanes = m->lanes[k];
        const long states = MODEL(lane_states_at)[k + 1] - MODEL(lane_states_at)[k];
        const long columns = MODEL(lane_columns_at)[k + 1] - MODEL(lane_columns_at)[k];
        const long rows = MODEL(lane_rows_at)[k + 1] - MODEL(lane_rows_at)[k];
        const int *const column = MODEL(lane_columns) + MODEL(lane_columns_at)[k];
        const real *const by = lane + states * states * lanes;
        const real *const into = by + states * columns * lanes;
        NUMBER *const reaction = part + states * states * lanes;
        for (long a = 0; a < states; ++a)
            for (long b = 0; b < states; ++b)
                for (long j = 0; j < lanes; ++j) {
                    const long at = (a * states + b) * lanes + j;
                    part[at] = LESS(a == b ? ONE : NONE, BY(gamma, lane[at]));
                }
        NAMED(invert)(part, states, lanes);
        for (long a = 0; a < states; ++a)
            for (long c = 0; c < columns; ++c) {
                const NUMBER factor = column[c] < MODEL(shared) ? gamma : ONE; /* borders: 1 */
                for (long j = 0; j < lanes; ++j) {
                    NUMBER sum = NONE;
                    for (long b = 0; b < states; ++b)
                        sum = MORE(sum, BY(part[(a * states + b) * lanes + j],
                                           by[(b * columns + c) * lanes + j]));
                    reaction[(a * columns + c) * lanes + j] = TIMES(factor, sum);
                }
            }
        for (long r = 0; r < rows; ++r)
            for (long c = 0; c < columns; ++c) {
                NUMBER *const meet = slot + MODEL(meet)[MODEL(first)[k] + r * columns + c];
                NUMBER sum = NONE;
                for (long b = 0; b < states; ++b)
                    sum = MORE(sum, NAMED(total)(reaction + (b * columns + c) * lanes,
                                                 into + (r * states + b) * lanes, lanes));
                *meet = LESS(*meet, TIMES(gamma, sum));
            }
        lane = into + rows * states * lanes;
        part = reaction + states * columns * lanes;
    }
    for (long k = 0; k < MODEL(unknowns); ++k) {
        const NUMBER per = PER(slot[MODEL(pivot)[k]]);
        f[MODEL(slots) + k] = per;
        for (long i = MODEL(below_at)[k]; i < MODEL(below_at)[k + 1]; i += 2) {
            NUMBER *const share = slot + MODEL(below)[i + 1];
            *share = TIMES(*share, per);
            for (long c = MODEL(right_at)[k]; c < MODEL(right_at)[k + 1]; c += 2, ++update)
                slot[*update] = LESS(slot[*update], TIMES(*share, slot[MODEL(right)[c + 1]]));
        }
    }
}

/*
 * Replace the right-hand side r (n) by the solution; if `which` is SOLVED, in the states of FOR_SOLVED alone:
 * those of the others are taken as zero, and neither read nor written.
 */
static void NAMED(solve)(const MODEL(block) *m, NUMBER gamma, const real *slopes,
                         const NUMBER *restrict f, int which, NUMBER *restrict r)
{
    NUMBER y[MODEL(unknowns) + 1];
    const real *lane = slopes + MODEL(entries);
    const NUMBER *part = f + MODEL(slots) + MODEL(unknowns);
    for (long k = 0; k < MODEL(unknowns); ++k)
        y[k] = k < MODEL(shared) ? r[m->first[MODEL(state)[k]]] : NONE;
    for (long k = 0; k < MODEL(banks); ++k) {
        const long lanes = m->lanes[k];
        const long states = MODEL(lane_states_at)[k + 1] - MODEL(lane_states_at)[k];
        const long columns = MODEL(lane_columns_at)[k + 1] - MODEL(lane_columns_at)[k];
        const long rows = MODEL(lane_rows_at)[k + 1] - MODEL(lane_rows_at)[k];
        const int *const state = MODEL(lane_states) + MODEL(lane_states_at)[k];
        const int *const row = MODEL(lane_rows) + MODEL(lane_rows_at)[k];
        const real *const into = lane + states * (states + columns) * lanes;
        const int takes_part = which == ALL || !MODEL(is_left_out)(k);
        for (long j = 0; takes_part && j < lanes; ++j) {
            NUMBER free[MODEL(most_states)];
            for (long a = 0; a < states; ++a) {
                free[a] = NONE;
                for (long b = 0; b < states; ++b)
                    free[a] = MORE(free[a], TIMES(part[(a * states + b) * lanes + j],
                                                  r[m->first[state[b]] + j]));
            }
            for (long a = 0; a < states; ++a)
                r[m->first[state[a]] + j] = free[a];
        }
        for (long i = 0; takes_part && i < rows; ++i) {
            NUMBER sum = NONE;
            for (long b = 0; b < states; ++b)
                sum = MORE(sum, NAMED(total)(r + m->first[state[b]], into + (i * states + b) * lanes,
                                             lanes));
            y[row[i]] = MORE(y[row[i]], TIMES(gamma, sum));
        }
        lane = into + rows * states * lanes;
        part += states * (states + columns) * lanes;
    }
    for (long k = 0; k < MODEL(unknowns); ++k)
        for (long i = MODEL(below_at)[k]; i < MODEL(below_at)[k + 1]; i += 2)
            y[MODEL(below)[i]] = LESS(y[MODEL(below)[i]],
                                      TIMES(f[MODEL(below)[i + 1]], y[MODEL(order)[k]]));
    for (long k = MODEL(unknowns) - 1; k >= 0; --k) {
        NUMBER sum = y[MODEL(order)[k]];
        for (long c = MODEL(right_at)[k]; c < MODEL(right_at)[k + 1]; c += 2)
            sum = LESS(sum, TIMES(f[MODEL(right)[c + 1]], y[MODEL(right)[c]]));
        y[MODEL(order)[k]] = TIMES(sum, f[MODEL(slots) + k]);
    }
    for (long k = 0; k < MODEL(shared); ++k)
        r[m->first[MODEL(state)[k]]] = y[k];
    part = f + MODEL(slots) + MODEL(unknowns);
    for (long k = 0; k < MODEL(banks); ++k) {
        const long lanes = m->lanes[k];
        const long states = MODEL(lane_states_at)[k + 1] - MODEL(lane_states_at)[k];
        const long columns = MODEL(lane_columns_at)[k + 1] - MODEL(lane_columns_at)[k];
        const int *const state = MODEL(lane_states) + MODEL(lane_states_at)[k];
        const int *const column = MODEL(lane_columns) + MODEL(lane_columns_at)[k];
        const NUMBER *const reaction = part + states * states * lanes;
        const int takes_part = which == ALL || !MODEL(is_left_out)(k);
        for (long a = 0; takes_part && a < states; ++a)
            for (long c = 0; c < columns; ++c)
                for (long j = 0; j < lanes; ++j) {
                    NUMBER *const d = r + m->first[state[a]] + j;
                    *d = MORE(*d, TIMES(reaction[(a * columns + c) * lanes + j], y[column[c]]));
                }
        part += states * (states + columns) * lanes;
    }
}
