/* Sizes, checks, and the planes that the propagation reads. */
#include <math.h>
#include <stddef.h>

#include "check.h"
#include "control.h"

int32_t rc_abi_version(void) { return RC_ABI_VERSION; }

int64_t rc_plane_size(int64_t height, int64_t width)
{
    /* Positions in a plane, and a row beyond either end, must fit 32 bits. */
    const int64_t most = INT32_MAX;
    if (height < 1 || width < 1 || height > most || width > most || height + 4 > (most - RC_SLACK) / (width + 2)) {
        return RC_BAD_SIZE;
    }
    return (height + 2) * (width + 2) + RC_SLACK;
}

int32_t rc_check_graph(const rc_graph *g)
{
    if (!g || !g->y || !g->d) {
        return RC_BAD_POINTER;
    }
    if (rc_plane_size(g->height, g->width) < 0) {
        return RC_BAD_SIZE;
    }
    if ((g->neighbors != 4 && g->neighbors != 8) || !(g->beta >= 0.0f) || !isfinite(g->beta) ||
        !(g->step_cost >= 0.0f) || !isfinite(g->step_cost)) {
        return RC_BAD_VALUE;
    }
    return RC_OK;
}

int32_t rc_check_pixels(const rc_graph *g, int64_t count, const int64_t *pixels)
{
    if (!pixels) {
        return RC_BAD_POINTER;
    }
    if (count < 1 || count > INT32_MAX) {
        return RC_BAD_SIZE;
    }
    for (int64_t i = 0; i < count; i++) {
        if (pixels[i] < 0 || pixels[i] >= g->height * g->width || isnan(g->y[rc_plane_position(g, pixels[i])])) {
            return RC_BAD_SEED;
        }
    }
    return RC_OK;
}

int32_t rc_graph_fill(int64_t height, int64_t width, int32_t wrap, const float *luminance, int64_t luminance_stride,
                      const float *range, int64_t range_stride, const uint8_t *valid, int64_t valid_stride, float *y,
                      float *d, const rc_control *control)
{
    const int64_t size = rc_plane_size(height, width);
    if (!luminance || !range || !valid || !y || !d) {
        return RC_BAD_POINTER;
    }
    if (size < 0 || luminance_stride < width || range_stride < width || valid_stride < width) {
        return RC_BAD_SIZE;
    }
    for (int64_t i = 0; i < width + 2; i++) {
        y[i] = NAN;
        d[i] = 0.0f;
    }
    for (int64_t r = 0; r < height; r++) {
        if (control && rc_cancelled(control)) {
            return RC_CANCELLED;
        }
        float *const yr = y + (r + 1) * (width + 2) + 1, *const dr = d + (r + 1) * (width + 2) + 1;
        for (int64_t c = 0; c < width; c++) {
            yr[c] = NAN;
            dr[c] = 0.0f;
            if (valid[r * valid_stride + c]) {
                yr[c] = luminance[r * luminance_stride + c];
                dr[c] = range[r * range_stride + c];
                if (!isfinite(yr[c]) || !isfinite(dr[c])) {
                    return RC_BAD_VALUE;
                }
            }
        }
        yr[-1] = wrap ? yr[width - 1] : NAN;
        dr[-1] = wrap ? dr[width - 1] : 0.0f;
        yr[width] = wrap ? yr[0] : NAN;
        dr[width] = wrap ? dr[0] : 0.0f;
    }
    for (int64_t i = (height + 1) * (width + 2); i < size; i++) {
        y[i] = NAN;
        d[i] = 0.0f;
    }
    return RC_OK;
}
