/* x^alpha for x in [0, 1], the same bits everywhere: libraries' powf differ from each other in the last place. */
#ifndef RC_POWER_H
#define RC_POWER_H

#include <stdint.h>
#include <string.h>

#define RC_RUN 64
#define RC_MAX_WHOLE 64

typedef struct {
    float alpha;
    int32_t whole; /* alpha as an integer, or -1 */
} rc_power;

static inline rc_power rc_power_of(float alpha)
{
    const rc_power p = {alpha, alpha <= RC_MAX_WHOLE && alpha == (float)(int32_t)alpha ? (int32_t)alpha : -1};
    return p;
}

/* Natural logarithm of a positive normal double, by log((1 + z) / (1 - z)) = 2 (z + z^3 / 3 + ...), |z| < 0.172. */
static inline double rc_log(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    int32_t exponent = (int32_t)(bits >> 52) - 1023;
    bits = (bits & UINT64_C(0x000FFFFFFFFFFFFF)) | UINT64_C(0x3FF0000000000000);
    double m;
    memcpy(&m, &bits, sizeof m);
    if (m > 1.4142135623730951) {
        m *= 0.5;
        exponent++;
    }
    const double z = (m - 1.0) / (m + 1.0), z2 = z * z;
    double sum = 1.0 / 15.0;
    sum = sum * z2 + 1.0 / 13.0;
    sum = sum * z2 + 1.0 / 11.0;
    sum = sum * z2 + 1.0 / 9.0;
    sum = sum * z2 + 1.0 / 7.0;
    sum = sum * z2 + 1.0 / 5.0;
    sum = sum * z2 + 1.0 / 3.0;
    sum = sum * z2 + 1.0;
    return 2.0 * z * sum + (double)exponent * 0.6931471805599453;
}

/* e^x for -700 < x <= 0. */
static inline double rc_exp(double x)
{
    const double n = (double)(int32_t)(x * 1.4426950408889634 - 0.5);
    const double f = (x - n * 0.693147180369123816490) - n * 1.90821492927058770002e-10;
    double sum = 1.0 / 39916800.0;
    sum = sum * f + 1.0 / 3628800.0;
    sum = sum * f + 1.0 / 362880.0;
    sum = sum * f + 1.0 / 40320.0;
    sum = sum * f + 1.0 / 5040.0;
    sum = sum * f + 1.0 / 720.0;
    sum = sum * f + 1.0 / 120.0;
    sum = sum * f + 1.0 / 24.0;
    sum = sum * f + 1.0 / 6.0;
    sum = sum * f + 0.5;
    sum = sum * f + 1.0;
    sum = sum * f + 1.0;
    uint64_t bits = (uint64_t)((int64_t)n + 1023) << 52;
    double scale;
    memcpy(&scale, &bits, sizeof scale);
    return sum * scale;
}

static inline float rc_power_one(float alpha, float x)
{
    if (x == 1.0f) {
        return 1.0f;
    }
    if (x < 1e-37f) {
        return 0.0f;
    }
    const double y = rc_log((double)x) * (double)alpha;
    return y > -200.0 ? (float)rc_exp(y) : 0.0f;
}

/* Raise each of n values, in place. What is too small to count becomes 0, so that no denormal number, which a process
 * may have told its processor to flush, ever enters a sum. */
static inline void rc_power_apply(rc_power p, float *x, int32_t n)
{
    if (p.whole == 0) {
        for (int32_t i = 0; i < n; i++) {
            x[i] = x[i] > 0.0f ? 1.0f : 0.0f; /* a seed at distance 0 has the pixel for itself even here */
        }
    } else if (p.whole == 6) {
        for (int32_t i = 0; i < n; i++) {
            const float square = x[i] * x[i];
            x[i] = square * square * square;
        }
    } else if (p.whole >= 0) {
        /* Bit after bit of the exponent for a run of values, not value after value: the compiler vectorizes that. */
        for (int32_t from = 0; from < n; from += RC_RUN) {
            const int32_t m = n - from < RC_RUN ? n - from : RC_RUN;
            float *const base = x + from, result[RC_RUN];
            for (int32_t i = 0; i < m; i++) {
                result[i] = 1.0f;
            }
            for (int32_t e = p.whole; e; e >>= 1) {
                for (int32_t i = 0; i < m; i++) {
                    result[i] = e & 1 ? result[i] * base[i] : result[i];
                    base[i] *= base[i];
                }
            }
            memcpy(base, result, (size_t)m * sizeof *result);
        }
    } else {
        for (int32_t i = 0; i < n; i++) {
            x[i] = rc_power_one(p.alpha, x[i]);
        }
    }
    for (int32_t i = 0; i < n; i++) {
        x[i] = x[i] < 1e-30f ? 0.0f : x[i];
    }
}

#endif
