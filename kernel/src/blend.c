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
    float *nearest, *weight, *color0, *color1;
    int32_t *index;
} add_to;

/* Four pixels' sums, in place. What lies farther than the nearest seed, this one or the sums so far, is scaled down by
 * `relative`, or to nothing where that is infinitely far. */
static inline void add_four(add_to to, const float *field, const float *relative, int32_t seed, float seed_color0,
                            float seed_color1)
{
    const lanes r = lanes_load(field), least = lanes_load(to.nearest), one = lanes_all(1.0f);
    const lanes most = lanes_choose(least, r, r, least);
    const lanes far = lanes_choose(most, lanes_all(FLT_MAX), lanes_load(relative), lanes_all(0.0f));
    const lanes kept = lanes_choose(least, r, one, far), own = lanes_choose(least, r, far, one);
    const lanes own0 = lanes_mul(own, lanes_all(seed_color0)), own1 = lanes_mul(own, lanes_all(seed_color1));
    lanes_store(to.weight, lanes_add(lanes_mul(lanes_load(to.weight), kept), own));
    lanes_store(to.color0, lanes_add(lanes_mul(lanes_load(to.color0), kept), own0));
    lanes_store(to.color1, lanes_add(lanes_mul(lanes_load(to.color1), kept), own1));
    lanes_store_int(to.index, lanes_choose(least, r, lanes_load_int(to.index), lanes_all_int(seed)));
    lanes_store(to.nearest, lanes_choose(least, r, least, r));
}

static inline void add_run(add_to to, const float *field, const float *relative, int32_t count, int32_t seed,
                           float seed_color0, float seed_color1)
{
    int32_t i = 0;
    for (; i + 4 <= count; i += 4) {
        const add_to four = {to.nearest + i, to.weight + i, to.color0 + i, to.color1 + i, to.index + i};
        add_four(four, field + i, relative + i, seed, seed_color0, seed_color1);
    }
    if (i < count) {
        const size_t rest = (size_t)(count - i) * sizeof(float);
        float part[6][4] = {{0.0f}};
        int32_t index[4] = {0};
        const add_to copy = {part[0], part[1], part[2], part[3], index};
        memcpy(part[0], to.nearest + i, rest);
        memcpy(part[1], to.weight + i, rest);
        memcpy(part[2], to.color0 + i, rest);
        memcpy(part[3], to.color1 + i, rest);
        memcpy(part[4], field + i, rest);
        memcpy(part[5], relative + i, rest);
        memcpy(index, to.index + i, rest);
        add_four(copy, part[4], part[5], seed, seed_color0, seed_color1);
        memcpy(to.nearest + i, part[0], rest);
        memcpy(to.weight + i, part[1], rest);
        memcpy(to.color0 + i, part[2], rest);
        memcpy(to.color1 + i, part[3], rest);
        memcpy(to.index + i, index, rest);
    }
}

int32_t rc_blend_add(int64_t height, int64_t width, const float *field, int64_t field_stride, float alpha,
                     int32_t seed, float seed_color0, float seed_color1, float *nearest, int32_t *index,
                     float *weight, float *color0, float *color1, const rc_control *control)
{
    if (!field || !nearest || !index || !weight || !color0 || !color1) {
        return RC_BAD_POINTER;
    }
    if (rc_plane_size(height, width) < 0 || field_stride < width) {
        return RC_BAD_SIZE;
    }
    if (!(alpha >= 0.0f) || !isfinite(alpha) || seed < 0 || !isfinite(seed_color0) || !isfinite(seed_color1)) {
        return RC_BAD_VALUE;
    }
    const rc_power power = rc_power_of(alpha);
    for (int64_t row = 0; row < height; row++) {
        if (control && rc_cancelled(control)) {
            return RC_CANCELLED;
        }
        const int64_t at = row * width;
        const float *const f = field + row * field_stride;
        float *const n = nearest + at, *const w = weight + at, *const c0 = color0 + at, *const c1 = color1 + at;
        int32_t *const id = index + at;
        for (int64_t c = 0; c < width; c += RC_RUN) {
            const int32_t m = width - c < RC_RUN ? (int32_t)(width - c) : RC_RUN;
            float relative[RC_RUN];
            for (int32_t i = 0; i < m; i++) {
                const float low = f[c + i] < n[c + i] ? f[c + i] : n[c + i];
                const float high = f[c + i] < n[c + i] ? n[c + i] : f[c + i];
                /* Two seeds at distance 0 share the pixel; an infinite `high` leaves the other one alone. */
                relative[i] = low == high ? 1.0f : low / high;
            }
            rc_power_apply(power, relative, m);
            const add_to to = {n + c, w + c, c0 + c, c1 + c, id + c};
            add_run(to, f + c, relative, m, seed, seed_color0, seed_color1);
        }
    }
    return RC_OK;
}

int32_t rc_blend_finish(int64_t count, const float *weight, float *color0, float *color1)
{
    if (!weight || !color0 || !color1) {
        return RC_BAD_POINTER;
    }
    if (count < 1) {
        return RC_BAD_SIZE;
    }
    for (int64_t i = 0; i < count; i++) {
        const float w = weight[i] > 0.0f ? weight[i] : 1.0f;
        color0[i] /= w;
        color1[i] /= w;
    }
    return RC_OK;
}
