/* The weighted mean of equation 1 with the weights of equation 2, w = r^-alpha, relative to the least distance. */
#include <float.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "check.h"
#include "control.h"
#include "lanes.h"
#include "power.h"

typedef struct {
    float *nearest, *weight;
    float *mean[RC_MAX_CHANNELS];
    int32_t *index;
} add_to;

/* Four pixels' sums, in place. What lies farther than the nearest seed, this one or the sums so far, is scaled down by
 * `relative`, or to nothing where that is infinitely far. */
static inline void add_four(add_to to, const float *field, const float *relative, int32_t seed, int32_t channels,
                            const float *values)
{
    const lanes r = lanes_load(field), least = lanes_load(to.nearest), one = lanes_all(1.0f);
    const lanes most = lanes_choose(least, r, r, least);
    const lanes far = lanes_choose(most, lanes_all(FLT_MAX), lanes_load(relative), lanes_all(0.0f));
    const lanes kept = lanes_choose(least, r, one, far), own = lanes_choose(least, r, far, one);
    lanes_store(to.weight, lanes_add(lanes_mul(lanes_load(to.weight), kept), own));
    for (int32_t c = 0; c < channels; c++) {
        const lanes added = lanes_mul(own, lanes_all(values[c]));
        lanes_store(to.mean[c], lanes_add(lanes_mul(lanes_load(to.mean[c]), kept), added));
    }
    lanes_store_int(to.index, lanes_choose(least, r, lanes_load_int(to.index), lanes_all_int(seed)));
    lanes_store(to.nearest, lanes_choose(least, r, least, r));
}

static add_to moved_by(add_to to, int64_t pixels)
{
    to.nearest += pixels;
    to.weight += pixels;
    to.index += pixels;
    for (int c = 0; c < RC_MAX_CHANNELS; c++) {
        to.mean[c] += to.mean[c] ? pixels : 0;
    }
    return to;
}

static inline void add_run(add_to to, const float *field, const float *relative, int32_t count, int32_t seed,
                           int32_t channels, const float *values)
{
    int32_t i = 0;
    for (; i + 4 <= count; i += 4) {
        add_four(moved_by(to, i), field + i, relative + i, seed, channels, values);
    }
    if (i < count) {
        const size_t rest = (size_t)(count - i) * sizeof(float);
        float part[4][4] = {{0.0f}}, mean[RC_MAX_CHANNELS][4] = {{0.0f}};
        int32_t index[4] = {0};
        const add_to all = moved_by(to, i);
        add_to copy = {part[0], part[1], {NULL}, index};
        memcpy(part[0], all.nearest, rest);
        memcpy(part[1], all.weight, rest);
        memcpy(part[2], field + i, rest);
        memcpy(part[3], relative + i, rest);
        memcpy(index, all.index, rest);
        for (int32_t c = 0; c < channels; c++) {
            copy.mean[c] = mean[c];
            memcpy(mean[c], all.mean[c], rest);
        }
        add_four(copy, part[2], part[3], seed, channels, values);
        memcpy(all.nearest, part[0], rest);
        memcpy(all.weight, part[1], rest);
        memcpy(all.index, index, rest);
        for (int32_t c = 0; c < channels; c++) {
            memcpy(all.mean[c], mean[c], rest);
        }
    }
}

int32_t rc_blend_add(int64_t height, int64_t width, const float *field, int64_t field_stride, float alpha,
                     int32_t seed, int32_t channels, const float *values, float *nearest, int32_t *index,
                     float *weight, float *means, int64_t channel_stride, const rc_control *control)
{
    if (!field || !values || !nearest || !index || !weight || !means) {
        return RC_BAD_POINTER;
    }
    if (rc_plane_size(height, width) < 0 || field_stride < width || channels < 1 || channels > RC_MAX_CHANNELS ||
        channel_stride < height * width) {
        return RC_BAD_SIZE;
    }
    if (!(alpha >= 0.0f) || !isfinite(alpha) || seed < 0) {
        return RC_BAD_VALUE;
    }
    add_to all = {nearest, weight, {NULL}, index};
    for (int32_t c = 0; c < channels; c++) {
        if (!isfinite(values[c])) {
            return RC_BAD_VALUE;
        }
        all.mean[c] = means + c * channel_stride;
    }
    const rc_power power = rc_power_of(alpha);
    for (int64_t row = 0; row < height; row++) {
        if (control && rc_cancelled(control)) {
            return RC_CANCELLED;
        }
        const float *const f = field + row * field_stride;
        for (int64_t c = 0; c < width; c += RC_RUN) {
            const int32_t m = width - c < RC_RUN ? (int32_t)(width - c) : RC_RUN;
            const add_to to = moved_by(all, row * width + c);
            float relative[RC_RUN];
            for (int32_t i = 0; i < m; i++) {
                const float low = f[c + i] < to.nearest[i] ? f[c + i] : to.nearest[i];
                const float high = f[c + i] < to.nearest[i] ? to.nearest[i] : f[c + i];
                /* Two seeds at distance 0 share the pixel; an infinite `high` leaves the other one alone. */
                relative[i] = low == high ? 1.0f : low / high;
            }
            rc_power_apply(power, relative, m);
            /* Two are chrominance, three a whole color: the compiler is told, for speed. */
            switch (channels) {
            case 2:
                add_run(to, f + c, relative, m, seed, 2, values);
                break;
            case 3:
                add_run(to, f + c, relative, m, seed, 3, values);
                break;
            default:
                add_run(to, f + c, relative, m, seed, channels, values);
            }
        }
    }
    return RC_OK;
}

int32_t rc_blend_finish(int64_t count, const float *weight, int32_t channels, float *means, int64_t channel_stride)
{
    if (!weight || !means) {
        return RC_BAD_POINTER;
    }
    if (count < 1 || channels < 1 || channels > RC_MAX_CHANNELS || channel_stride < count) {
        return RC_BAD_SIZE;
    }
    for (int32_t c = 0; c < channels; c++) {
        float *const mean = means + c * channel_stride;
        for (int64_t i = 0; i < count; i++) {
            mean[i] /= weight[i] > 0.0f ? weight[i] : 1.0f;
        }
    }
    return RC_OK;
}
