/* Laws of elements, and their means over a step, of vectors.  Behind wide.h. */

static inline real deadzone_of(real z, real w)
{
    return chosen(z > w, z - w, chosen(z < -w, z + w, z - z));
}

static inline real saturate_of(real z, real w)
{
    return chosen(z > w, w, chosen(z < -w, -w, z));
}

/* (exp(d) - 1 - d - d^2/2)/d^3 */
static inline real phi3_of(real d)
{
    const real size = size_of(d);
    const real near = 1.0 / 6.0
        + d * (1.0 / 24.0 + d * (1.0 / 120.0 + d * (1.0 / 720.0 + d * (1.0 / 5040.0))));
    if (!any(size >= 0x1p-10))
        return near;
    real sum = zero;
    for (int k = 19; k > 2; --k)
        sum = (1.0 + sum) * d / (double)(k + 1);
    sum = (1.0 + sum) / 6.0;
    const real far = (((exp_of(d) - 1.0) / d - 1.0) / d - 0.5) / d;
    return chosen(size < 0x1p-10, near, chosen(size >= 1.0, far, sum));
}

/* How much of the way from low to top lies above zero, if top does. */
static inline real share_above(real low, real top)
{
    return chosen(top <= 0.0, zero, chosen(low >= 0.0, wide(1.0), top / (top - low)));
}

/* Mean of max(s, 0) for s from a to b, and its derivative by b. */
static inline real ramp_of(real a, real b)
{
    const real top = chosen(a > b, a, b), low = chosen(a > b, b, a);
    return chosen(low >= 0.0, 0.5 * (a + b), 0.5 * top * share_above(low, top));
}

static inline real ramp_by_new_of(real a, real b)
{
    const real top = chosen(a > b, a, b), low = chosen(a > b, b, a);
    const real share = share_above(low, top), half = 0.5 * share * share;
    return chosen(low >= 0.0, wide(0.5), chosen(b > a, share - half, half));
}

/* How far z lies beyond a zone from -w to w. */
static inline real beyond_of(real z, real w)
{
    const real low = chosen(z < -w, -w, z);
    return z - chosen(low > w, w, low);
}

/* How far b is from a, or 1 if that is next to nothing. */
static inline real way_of(real a, real b)
{
    return chosen(size_of(b - a) > 0x1p-1000, b - a, wide(1.0));
}

/* Mean of deadzone(s, w) for s from a to b, w >= 0, and its derivatives by b and by w. */
static inline real mean_deadzone_of(real a, real b, real w)
{
    const real from = beyond_of(a, w), to = beyond_of(b, w);
    const real per_way = 1.0 / way_of(a, b);
    const real share = chosen(from * to > 0.0, wide(1.0), (to - from) * per_way);
    return 0.5 * (from + to) * share;
}

static inline real mean_deadzone_by_new_of(real a, real b, real w)
{
    const real from = beyond_of(a, w), to = beyond_of(b, w);
    const real per_way = 1.0 / way_of(a, b);
    return chosen(from * to > 0.0, wide(0.5), (to - mean_deadzone_of(a, b, w)) * per_way);
}

static inline real mean_deadzone_by_width_of(real a, real b, real w)
{
    const real top = chosen(a > b, a, b), low = chosen(a > b, b, a);
    return share_above(-top - w, -low - w) - share_above(low - w, top - w);
}

static inline real mean_sign_of(real a, real b)
{
    const real same = chosen(a != 0.0, sign_of(a), sign_of(b));
    return chosen(a * b >= 0.0, same, (size_of(b) - size_of(a)) / (b - a));
}

static inline real mean_sign_by_new_of(real a, real b)
{
    return chosen(a * b >= 0.0, zero, 2.0 * size_of(a) / ((b - a) * (b - a)));
}

/* log(cosh(s)) - |s| + log(2) */
static inline real bend_of(real s)
{
    return log1p_of(exp_of(-2.0 * size_of(s)));
}

/* Mean of tanh(s) for s from a to b, and its derivative by b. */
static inline real mean_tanh_of(real a, real b)
{
    const real half = 0.5 * (b - a), middle = 0.5 * (a + b), t = tanh_of(middle);
    const mask close = (size_of(half) <= 2.0) | (size_of(middle) <= 2.0);
    const mask one = size_of(half) < 0x1p-27;
    const real near = atanh_of(chosen(close, t * tanh_of(half), zero)) / half;
    if (!any(~close))
        return chosen(one, t, near);
    const real far = (size_of(b) - size_of(a) + bend_of(b) - bend_of(a)) / (b - a);
    return chosen(one, t, chosen(close, near, far));
}

static inline real mean_tanh_by_new_of(real a, real b)
{
    const real half = 0.5 * (b - a), t = tanh_of(0.5 * (a + b)), slope = 1.0 - t * t;
    const real near = slope * (0.5 - half * (t / 3.0 + half * (1.0 - 3.0 * t * t) / 6.0));
    return chosen(size_of(half) < 0x1p-10, near, (tanh_of(b) - mean_tanh_of(a, b)) / (b - a));
}
