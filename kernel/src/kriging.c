/* The sums of kriging (reflcolor_addon/color/kriging.py): weights that fall off exponentially with the distance of
 * features. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "control.h"
#include "wide.h"

/* Pixels at once: what is at work on them stays in registers and the nearest cache. */
#define RC_ABREAST 64
/* Beyond this distance a seed counts as if it lay there: e^-80 is nothing beside any sum, and no denormal number. */
#define RC_FARTHEST 80.0f

/* e^-x for each of some x of 0 to RC_FARTHEST, within 3e-7 of its value: 2^n times a polynomial for 2^f, |f| <= 0.5. */
static inline RC_EVERYWHERE void decay(float *x)
{
    for (int i = 0; i < RC_ABREAST; i++) {
        const float t = x[i] * -1.44269504088896341f;
        /* Adding this rounds to a whole number, which the lowest bits of the sum hold. */
        const float shifted = t + 12582912.0f;
        const float f = t - (shifted - 12582912.0f);
        float sum = 1.326472639e-3f;
        sum = sum * f + 9.671512697e-3f;
        sum = sum * f + 5.550733746e-2f;
        sum = sum * f + 2.402224208e-1f;
        sum = sum * f + 6.931469776e-1f;
        sum = sum * f + 1.0f;
        uint32_t bits, whole;
        memcpy(&bits, &sum, sizeof bits);
        memcpy(&whole, &shifted, sizeof whole);
        bits += whole << 23;
        memcpy(x + i, &bits, sizeof bits);
    }
}

/* RC_ABREAST pixels, whose features lie side by side, against all seeds. Every pixel's sums are taken in the order of
 * the seeds, so that it is of no account how many pixels an instruction works on. */
static inline RC_EVERYWHERE void add_seeds(const float *features, int64_t count, const float *seeds, int32_t channels,
                                           const float *weights, float *sums)
{
    for (int64_t j = 0; j < count; j++) {
        const float *const seed = seeds + j * RC_FEATURES;
        float x[RC_ABREAST];
        for (int i = 0; i < RC_ABREAST; i++) {
            float squared = 0.0f;
            for (int n = 0; n < RC_FEATURES; n++) {
                const float off = features[n * RC_ABREAST + i] - seed[n];
                squared += off * off;
            }
            const float distance = sqrtf(squared);
            x[i] = distance < RC_FARTHEST ? distance : RC_FARTHEST;
        }
        decay(x);
        for (int32_t c = 0; c < channels; c++) {
            const float weight = weights[j * channels + c];
            for (int i = 0; i < RC_ABREAST; i++) {
                sums[c * RC_ABREAST + i] += weight * x[i];
            }
        }
    }
}

RC_WIDE_VERSIONS(add_seeds,
                 (const float *features, int64_t count, const float *seeds, int32_t channels, const float *weights,
                  float *sums),
                 (features, count, seeds, channels, weights, sums))

int32_t rc_kriging(int64_t pixels, const float *features, int64_t count, const float *seeds, int32_t channels,
                   const float *weights, float *sums, const rc_control *control)
{
    if (!features || !seeds || !weights || !sums) {
        return RC_BAD_POINTER;
    }
    if (pixels < 1 || count < 1 || channels < 1 || channels > RC_MAX_CHANNELS) {
        return RC_BAD_SIZE;
    }
    void (*const add)(const float *, int64_t, const float *, int32_t, const float *, float *) = rc_wide_add_seeds();
    for (int64_t first = 0; first < pixels; first += RC_ABREAST) {
        if (control && rc_cancelled(control)) {
            return RC_CANCELLED;
        }
        const int64_t left = pixels - first;
        const int32_t here = left < RC_ABREAST ? (int32_t)left : RC_ABREAST;
        float side_by_side[RC_FEATURES * RC_ABREAST] = {0.0f}, sum[RC_MAX_CHANNELS * RC_ABREAST] = {0.0f};
        for (int32_t i = 0; i < here; i++) {
            for (int n = 0; n < RC_FEATURES; n++) {
                side_by_side[n * RC_ABREAST + i] = features[(first + i) * RC_FEATURES + n];
            }
        }
        add(side_by_side, count, seeds, channels, weights, sum);
        for (int32_t i = 0; i < here; i++) {
            for (int32_t c = 0; c < channels; c++) {
                sums[(first + i) * channels + c] = sum[c * RC_ABREAST + i];
            }
        }
        if (control) {
            rc_progress(control, here);
        }
    }
    return RC_OK;
}
