/* The weighted mean of equation 1 with the weights of equation 2, w = r^-alpha, relative to the least distance. */
#include <math.h>
#include <stddef.h>

#include "labels.h"
#include "power.h"
#include "reflcolor_kernel.h"

int32_t rc_blend_add(int64_t height, int64_t width, const float *field, int64_t field_stride, float alpha,
                     int32_t seed, float seed_color0, float seed_color1, float *nearest, int32_t *index,
                     float *weight, float *color0, float *color1)
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
        const float *const f = field + row * field_stride;
        const int64_t at = row * width;
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
            for (int32_t i = 0; i < m; i++) {
                const float r = f[c + i], least = n[c + i];
                const int nearer = r < least;
                const float far = (nearer ? least : r) < INFINITY ? relative[i] : 0.0f;
                const float kept = nearer ? far : 1.0f, own = nearer ? 1.0f : far;
                w[c + i] = w[c + i] * kept + own;
                c0[c + i] = c0[c + i] * kept + own * seed_color0;
                c1[c + i] = c1[c + i] * kept + own * seed_color1;
                id[c + i] = nearer || (r == least && r < INFINITY && seed < id[c + i]) ? seed : id[c + i];
                n[c + i] = nearer ? r : least;
            }
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

/* Distance of the mean from the farther end of the range that the seeds' colors span. */
static float farthest(float mean, float least, float most)
{
    return most - mean > mean - least ? most - mean : mean - least;
}

int32_t rc_blend_nearest(int64_t height, int64_t width, int64_t row0, int64_t row1, int32_t k, void *labels,
                         int64_t count, const float *colors, float alpha, float *weight, float *color0,
                         float *color1, float *bound)
{
    if (!labels || !colors || !weight || !color0 || !color1) {
        return RC_BAD_POINTER;
    }
    if (rc_plane_size(height, width) < 0 || row0 < 0 || row1 < row0 || row1 > height || count < 1 ||
        count > INT32_MAX) {
        return RC_BAD_SIZE;
    }
    if (!(alpha >= 0.0f) || !isfinite(alpha) || k < 1 || k > RC_MAX_NEAREST) {
        return RC_BAD_VALUE;
    }
    float low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int64_t j = 0; j < 2 * count; j++) {
        if (!isfinite(colors[j])) {
            return RC_BAD_VALUE;
        }
        low[j & 1] = colors[j] < low[j & 1] ? colors[j] : low[j & 1];
        high[j & 1] = colors[j] > high[j & 1] ? colors[j] : high[j & 1];
    }
    const rc_power power = rc_power_of(alpha);
    for (int64_t row = row0; row < row1; row++) {
        for (int64_t c = 0; c < width; c++) {
            const int64_t p = (row + 1) * (width + 2) + c + 1, out = row * width + c;
            const float *const r = rc_distances(labels, k, p);
            const int32_t *const id = rc_seeds(labels, k, p);
            float relative[RC_MAX_NEAREST], w = 0.0f, c0 = 0.0f, c1 = 0.0f;
            int32_t n = 0;
            for (; n < k && id[n] >= 0; n++) {
                if (id[n] >= count) {
                    return RC_BAD_SEED;
                }
                relative[n] = r[n] == r[0] ? 1.0f : r[0] / r[n];
            }
            rc_power_apply(power, relative, n);
            for (int32_t i = 0; i < n; i++) {
                w += relative[i];
                c0 += relative[i] * colors[2 * id[i]];
                c1 += relative[i] * colors[2 * id[i] + 1];
            }
            weight[out] = w;
            color0[out] = n ? c0 / w : 0.0f;
            color1[out] = n ? c1 / w : 0.0f;
            if (bound) {
                /* Each seed left out lies at least as far as the last one kept, and pulls at most towards the
                 * far end of the seeds' colors. */
                const float left = n == k ? (float)(count - k) * relative[k - 1] : 0.0f;
                const float pull0 = farthest(color0[out], low[0], high[0]);
                const float pull1 = farthest(color1[out], low[1], high[1]);
                bound[out] = left > 0.0f ? left / (w + left) * (pull0 > pull1 ? pull0 : pull1) : 0.0f;
            }
        }
    }
    return RC_OK;
}
