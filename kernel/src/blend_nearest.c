/* Equation 1 over the nearest seeds, and what those left out could change. */
#include <math.h>
#include <stddef.h>

#include "check.h"
#include "power.h"

/* Of the tables of the seeds' values. */
#define RC_BINS 256
/* Against rounding in their sums. */
#define RC_RAISED 1.0001f
/* Chords drawn to find how far a mean can move, and what needs no finer answer, in units of the values. */
#define RC_CHORDS 3
#define RC_FINE 0.25f

/* One channel of all seeds' values. At the edges of its bins a table holds the sum, over all seeds, of how far each lies
 * above, and one of how far it lies below; between edges the chord does not understate it, for such a sum is convex. */
typedef struct {
    float low, high, bins_per_unit;
    float above[RC_BINS + 1], below[RC_BINS + 1];
} rc_spread;

static int32_t spread_of(int64_t count, const float *values, int32_t channels, rc_spread *s)
{
    s->low = INFINITY;
    s->high = -INFINITY;
    for (int64_t j = 0; j < count; j++) {
        const float value = values[channels * j];
        if (!isfinite(value)) {
            return RC_BAD_VALUE;
        }
        s->low = value < s->low ? value : s->low;
        s->high = value > s->high ? value : s->high;
    }
    double number[RC_BINS] = {0}, sum[RC_BINS] = {0};
    const double width = ((double)s->high - (double)s->low) / RC_BINS;
    s->bins_per_unit = width > 0.0 ? (float)(1.0 / width) : 0.0f;
    for (int64_t j = 0; j < count; j++) {
        const double from_low = (double)values[channels * j] - (double)s->low;
        const int32_t bin = width > 0.0 ? (int32_t)(from_low / width) : 0;
        number[bin < RC_BINS ? bin : RC_BINS - 1]++;
        sum[bin < RC_BINS ? bin : RC_BINS - 1] += from_low;
    }
    double n = 0.0, total = 0.0;
    s->above[RC_BINS] = 0.0f;
    for (int32_t b = RC_BINS - 1; b >= 0; b--) {
        n += number[b];
        total += sum[b];
        s->above[b] = (float)(total - n * width * b) * RC_RAISED;
    }
    n = total = 0.0;
    s->below[0] = 0.0f;
    for (int32_t b = 1; b <= RC_BINS; b++) {
        n += number[b - 1];
        total += sum[b - 1];
        s->below[b] = (float)(n * width * b - total) * RC_RAISED;
    }
    return RC_OK;
}

static float chord(const float *table, float x)
{
    x = x < 0.0f ? 0.0f : x > RC_BINS ? RC_BINS : x;
    const int32_t bin = x < RC_BINS ? (int32_t)x : RC_BINS - 1;
    return table[bin] + (x - (float)bin) * (table[bin + 1] - table[bin]);
}

/* How far a mean of weight w can move to one side when every seed left out gets a weight from 0 to `each`.
 *
 * All seeds beyond a place t off push together with each * q(t), where q(t) is how far they lie beyond it; the mean
 * stops where w * t outweighs that. q is convex, is `beyond` at 0, and 0 at `span`: where the chord between two known
 * places meets w * t / each is no nearer than where q does. */
typedef struct {
    const rc_spread *spread;
    float mean, beyond, span, most; /* most: what the first chord tells */
    int above;
} rc_side;

static rc_side side_of(const rc_spread *s, float mean, int above, float beyond, float each, float w)
{
    rc_side side = {s, mean, beyond, above ? s->high - mean : mean - s->low, 0.0f, above};
    if (beyond > 0.0f && side.span > 0.0f) {
        side.most = each * beyond * side.span / (w * side.span + each * beyond);
    }
    return side;
}

static float listed(const rc_side *side, float t)
{
    const rc_spread *const s = side->spread;
    const float x = ((side->above ? side->mean + t : side->mean - t) - s->low) * s->bins_per_unit;
    const float q = chord(side->above ? s->above : s->below, x);
    return q < side->beyond ? q : side->beyond;
}

static float refined(const rc_side *side, float each, float w)
{
    float t0 = 0.0f, q0 = side->beyond, t = side->most;
    for (int n = 0; n < RC_CHORDS && t > RC_FINE; n++) {
        float q = listed(side, t);
        q = each * q < w * t ? q : w * t / each;
        const float middle = 0.5f * (t0 + t), q_middle = listed(side, middle);
        if (each * q_middle > w * middle) {
            t0 = middle;
            q0 = q_middle;
        } else {
            t = middle;
            q = q_middle;
        }
        const float slope = (q0 - q) / (t - t0), met = each * (q0 + slope * t0) / (w + each * slope);
        t = met < t ? met : t;
    }
    return t;
}

/* The most that the seeds left out, with weights up to `each`, can move any channel of a pixel. */
static inline float bound_of(const rc_spread *spread, const float *mean, int32_t k, const int32_t *id,
                             int32_t channels, const float *values, float each, float w)
{
    rc_side side[2 * RC_MAX_CHANNELS];
    int first = 0;
    for (int i = 0; i < channels; i++) {
        const float x = (mean[i] - spread[i].low) * spread[i].bins_per_unit;
        float above = chord(spread[i].above, x), below = chord(spread[i].below, x);
        for (int32_t n = 0; n < k; n++) {
            const float off = values[channels * id[n] + i] - mean[i];
            above -= off > 0.0f ? off : 0.0f;
            below += off < 0.0f ? off : 0.0f;
        }
        side[2 * i] = side_of(spread + i, mean[i], 1, above, each, w);
        side[2 * i + 1] = side_of(spread + i, mean[i], 0, below, each, w);
    }
    for (int i = 1; i < 2 * channels; i++) {
        first = side[i].most > side[first].most ? i : first;
    }
    /* Mostly the side that the first chords favor stays ahead of what they tell of the others. */
    float bound = refined(side + first, each, w);
    for (int i = 0; i < 2 * channels; i++) {
        if (i != first && side[i].most > bound) {
            const float other = refined(side + i, each, w);
            bound = other > bound ? other : bound;
        }
    }
    return bound;
}

/* The weights of a pixel's n labels, added up, and the mean that they give of the seeds' values. */
static inline float mean_of(int32_t n, const int32_t *id, const float *relative, int32_t channels,
                            const float *values, float *mean)
{
    float w = 0.0f;
    for (int32_t c = 0; c < channels; c++) {
        mean[c] = 0.0f;
    }
    for (int32_t i = 0; i < n; i++) {
        w += relative[i];
        for (int32_t c = 0; c < channels; c++) {
            mean[c] += relative[i] * values[channels * id[i] + c];
        }
    }
    for (int32_t c = 0; c < channels; c++) {
        mean[c] = n ? mean[c] / w : 0.0f;
    }
    return w;
}

typedef struct {
    float *nearest, *weight, *means, *bound;
    int64_t channel_stride;
    int32_t *index;
} nearest_out;

static inline int32_t blend_rows(const rc_graph *graph, int64_t row0, int64_t row1, int32_t k, const void *labels,
                                 int64_t count, int32_t channels, const float *values, const rc_spread *spread,
                                 float alpha, nearest_out to)
{
    const rc_power power = rc_power_of(alpha);
    const int64_t width = graph->width;
    for (int64_t row = row0; row < row1; row++) {
        for (int64_t c = 0; c < width; c++) {
            const int64_t p = (row + 1) * (width + 2) + c + 1, out = row * width + c;
            const float *const r = (const float *)labels + p * 2 * k;
            const int32_t *const id = (const int32_t *)labels + p * 2 * k + k;
            float relative[RC_MAX_NEAREST], mean[RC_MAX_CHANNELS];
            int32_t n = 0;
            const int32_t places = isnan(graph->y[p]) ? 0 : k;
            for (; n < places && id[n] >= 0; n++) {
                if (id[n] >= count) {
                    return RC_BAD_SEED;
                }
                relative[n] = r[n] == r[0] ? 1.0f : r[0] / r[n];
            }
            rc_power_apply(power, relative, n);
            const float w = mean_of(n, id, relative, channels, values, mean);
            to.nearest[out] = n ? r[0] : INFINITY;
            to.index[out] = n ? id[0] : -1;
            to.weight[out] = w;
            for (int32_t i = 0; i < channels; i++) {
                to.means[i * to.channel_stride + out] = mean[i];
            }
            if (to.bound) {
                to.bound[out] = 0.0f;
                if (n == k && count > k && relative[k - 1] > 0.0f) {
                    /* Each seed left out lies at least as far as the last one kept. */
                    to.bound[out] = bound_of(spread, mean, k, id, channels, values, relative[k - 1], w);
                }
            }
        }
    }
    return RC_OK;
}

int32_t rc_blend_nearest(const rc_graph *graph, int64_t row0, int64_t row1, int32_t k, const void *labels,
                         int64_t count, int32_t channels, const float *values, float alpha, float *nearest,
                         int32_t *index, float *weight, float *means, float *bound)
{
    int32_t code = rc_check_graph(graph);
    if (code != RC_OK) {
        return code;
    }
    if (!labels || !values || !nearest || !index || !weight || !means) {
        return RC_BAD_POINTER;
    }
    if (row0 < 0 || row1 < row0 || row1 > graph->height || count < 1 || count > INT32_MAX || channels < 1 ||
        channels > RC_MAX_CHANNELS) {
        return RC_BAD_SIZE;
    }
    if (!(alpha >= 0.0f) || !isfinite(alpha) || k < 1 || k > RC_MAX_NEAREST) {
        return RC_BAD_VALUE;
    }
    rc_spread spread[RC_MAX_CHANNELS];
    for (int32_t c = 0; c < channels; c++) {
        code = spread_of(count, values + c, channels, spread + c);
        if (code != RC_OK) {
            return code;
        }
    }
    const nearest_out to = {nearest, weight, means, bound, graph->height * graph->width, index};
    /* Two are chrominance, three a whole color: the compiler is told, for speed. */
    switch (channels) {
    case 2:
        return blend_rows(graph, row0, row1, k, labels, count, 2, values, spread, alpha, to);
    case 3:
        return blend_rows(graph, row0, row1, k, labels, count, 3, values, spread, alpha, to);
    default:
        return blend_rows(graph, row0, row1, k, labels, count, channels, values, spread, alpha, to);
    }
}
