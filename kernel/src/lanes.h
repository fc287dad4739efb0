/* Four floats at once. SSE2 and NEON are part of the base instruction sets of x86-64 and arm64; all three
 * versions round every operation alike. */
#ifndef RC_LANES_H
#define RC_LANES_H

#include <math.h>
#include <stdint.h>
#include <string.h>

#if defined(__SSE2__) && !defined(RC_SCALAR)
#include <emmintrin.h>
typedef __m128 lanes;
static inline lanes lanes_load(const float *p) { return _mm_loadu_ps(p); }
static inline void lanes_store(float *p, lanes a) { _mm_storeu_ps(p, a); }
static inline lanes lanes_all(float a) { return _mm_set1_ps(a); }
static inline lanes lanes_add(lanes a, lanes b) { return _mm_add_ps(a, b); }
static inline lanes lanes_sub(lanes a, lanes b) { return _mm_sub_ps(a, b); }
static inline lanes lanes_mul(lanes a, lanes b) { return _mm_mul_ps(a, b); }
static inline lanes lanes_abs(lanes a) { return _mm_andnot_ps(_mm_set1_ps(-0.0f), a); }
/* One bit per lane: a < b, false where either is NaN. */
static inline unsigned lanes_less(lanes a, lanes b) { return (unsigned)_mm_movemask_ps(_mm_cmplt_ps(a, b)); }
static inline lanes lanes_load_int(const int32_t *p) { return _mm_castsi128_ps(_mm_loadu_si128((const __m128i *)p)); }
static inline void lanes_store_int(int32_t *p, lanes a) { _mm_storeu_si128((__m128i *)p, _mm_castps_si128(a)); }
static inline lanes lanes_all_int(int32_t a) { return _mm_castsi128_ps(_mm_set1_epi32(a)); }
/* x where a <= b, else y. */
static inline lanes lanes_choose(lanes a, lanes b, lanes x, lanes y)
{
    const lanes m = _mm_cmple_ps(a, b);
    return _mm_or_ps(_mm_and_ps(m, x), _mm_andnot_ps(m, y));
}

#elif defined(__ARM_NEON) && !defined(RC_SCALAR)
#include <arm_neon.h>
typedef float32x4_t lanes;
static inline lanes lanes_load(const float *p) { return vld1q_f32(p); }
static inline void lanes_store(float *p, lanes a) { vst1q_f32(p, a); }
static inline lanes lanes_all(float a) { return vdupq_n_f32(a); }
static inline lanes lanes_add(lanes a, lanes b) { return vaddq_f32(a, b); }
static inline lanes lanes_sub(lanes a, lanes b) { return vsubq_f32(a, b); }
static inline lanes lanes_mul(lanes a, lanes b) { return vmulq_f32(a, b); }
static inline lanes lanes_abs(lanes a) { return vabsq_f32(a); }
static inline unsigned lanes_less(lanes a, lanes b)
{
    static const uint32_t bits[4] = {1, 2, 4, 8};
    return vaddvq_u32(vandq_u32(vcltq_f32(a, b), vld1q_u32(bits)));
}
static inline lanes lanes_load_int(const int32_t *p) { return vreinterpretq_f32_s32(vld1q_s32(p)); }
static inline void lanes_store_int(int32_t *p, lanes a) { vst1q_s32(p, vreinterpretq_s32_f32(a)); }
static inline lanes lanes_all_int(int32_t a) { return vreinterpretq_f32_s32(vdupq_n_s32(a)); }
static inline lanes lanes_choose(lanes a, lanes b, lanes x, lanes y) { return vbslq_f32(vcleq_f32(a, b), x, y); }

#else
typedef struct {
    float v[4];
} lanes;
#define RC_EACH_LANE for (int i = 0; i < 4; i++)
static inline lanes lanes_load(const float *p) { lanes a; memcpy(&a, p, sizeof a); return a; }
static inline void lanes_store(float *p, lanes a) { memcpy(p, &a, sizeof a); }
static inline lanes lanes_all(float a) { return (lanes){{a, a, a, a}}; }
static inline lanes lanes_add(lanes a, lanes b) { RC_EACH_LANE a.v[i] += b.v[i]; return a; }
static inline lanes lanes_sub(lanes a, lanes b) { RC_EACH_LANE a.v[i] -= b.v[i]; return a; }
static inline lanes lanes_mul(lanes a, lanes b) { RC_EACH_LANE a.v[i] *= b.v[i]; return a; }
static inline lanes lanes_abs(lanes a) { RC_EACH_LANE a.v[i] = fabsf(a.v[i]); return a; }
static inline unsigned lanes_less(lanes a, lanes b)
{
    unsigned m = 0;
    RC_EACH_LANE m |= (unsigned)(a.v[i] < b.v[i]) << i;
    return m;
}
static inline lanes lanes_load_int(const int32_t *p) { lanes a; memcpy(&a, p, sizeof a); return a; }
static inline void lanes_store_int(int32_t *p, lanes a) { memcpy(p, &a, sizeof a); }
static inline lanes lanes_all_int(int32_t a) { const int32_t v[4] = {a, a, a, a}; return lanes_load_int(v); }
static inline lanes lanes_choose(lanes a, lanes b, lanes x, lanes y)
{
    RC_EACH_LANE memcpy(&y.v[i], a.v[i] <= b.v[i] ? &x.v[i] : &y.v[i], sizeof(float));
    return y;
}
#endif

#endif
