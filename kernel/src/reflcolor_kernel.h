/* Geodesic fields, nearest seeds and the blending of equation 1 on a grid of pixels; sums of kriging; lines of numbers.
 *
 * Every function is re-entrant: it keeps no state between calls, and several threads may call it at once on the
 * same graph as long as they write to different memory. All arithmetic is IEEE single or double precision without
 * contraction or reordering, so that every platform gives the same bits.
 *
 * A "plane" is a float image with a rim of one pixel: (height + 2) rows of (width + 2) values, pixel (r, c) at
 * (r + 1) * (width + 2) + c + 1, and RC_SLACK further values that are read and never used. The rim spares the inner
 * loop every test for the image's border; rc_plane_size says how many floats a plane takes.
 */
#ifndef REFLCOLOR_KERNEL_H
#define REFLCOLOR_KERNEL_H

#include <stdint.h>

#if defined(_WIN32)
#define RC_API __declspec(dllexport)
#else
#define RC_API __attribute__((visibility("default")))
#endif

#define RC_ABI_VERSION 6
#define RC_SLACK 8
#define RC_MAX_NEAREST 1024
#define RC_MAX_PARTS 64
#define RC_FEATURES 8
#define RC_MAX_CHANNELS 4

enum {
    RC_OK = 0,
    RC_CANCELLED = 1,
    RC_MEMORY = 2,
    RC_SHORT = 3,        /* of rc_nearest_merge: a bound was too low */
    RC_BAD_POINTER = -1, /* a pointer that must not be null is null */
    RC_BAD_SIZE = -2,    /* a size is not positive, or too large for 32-bit pixel indices */
    RC_BAD_VALUE = -3,   /* a value is negative, not a number, infinite or out of its range */
    RC_BAD_SEED = -4     /* a seed lies outside the image or on a pixel that is no node of the graph */
};

/* The graph of a scan. `y` and `d` are planes filled by rc_graph_fill; y is NaN where a pixel is no node. */
typedef struct {
    int64_t height;
    int64_t width;
    int32_t neighbors; /* 4 or 8 */
    int32_t wrap;      /* the left and the right edge are neighbors */
    float beta;        /* weight of the squared range difference, equation 6 */
    float step_cost;   /* constant cost of a straight step; a diagonal one pays sqrt(2) times as much */
    const float *y;
    const float *d;
} rc_graph;

/* Both members may be null. `cancel` is polled; any value but 0 makes the call return RC_CANCELLED soon.
 * `progress` is added to, atomically: pixels by rc_field, seeds by rc_nearest_part. */
typedef struct {
    const volatile int32_t *cancel;
    int64_t *progress;
} rc_control;

RC_API int32_t rc_abi_version(void);

/* Floats in one plane, or RC_BAD_SIZE. */
RC_API int64_t rc_plane_size(int64_t height, int64_t width);

/* Fill the planes y and d from images with row strides in elements. Finite values are required where valid != 0. */
RC_API int32_t rc_graph_fill(int64_t height, int64_t width, int32_t wrap, const float *luminance,
                             int64_t luminance_stride, const float *range, int64_t range_stride,
                             const uint8_t *valid, int64_t valid_stride, float *y, float *d,
                             const rc_control *control);

/* Distance of every pixel to the nearest of `count` source pixels (row * width + column), each starting at
 * start[i] (null: all at 0). `plane` receives the distances, infinite where nothing arrives; its rim is undefined. */
RC_API int32_t rc_field(const rc_graph *graph, int64_t count, const int64_t *pixels, const float *start, float *plane,
                        const rc_control *control);

/* The k nearest of `count` seeds of every pixel take three steps; between them seeds can be parted among threads.
 *
 * First, `bound` (a plane) receives numbers that the distance of the k-th nearest seed lies below, infinite where fewer
 * arrive. `lists` (may be null) holds the `few` nearest of every pixel, fewer than k, as rc_nearest_merge leaves them;
 * with them the bounds are tighter. */
RC_API int32_t rc_nearest_bounds(const rc_graph *graph, int64_t count, const int64_t *pixels, int32_t k, int32_t few,
                                 const void *lists, float *bound, const rc_control *control);

/* Second, for each part: the nearest of `count` seeds whose ascending numbers are `seeds`. `labels` holds 2 k words of 32
 * bits per plane entry (rc_plane_size(...) * 2 * k): k float distances, then k int32 seeds; what no seed can be among the
 * nearest of is left untouched. `listed` is a plane of bytes, all 0 at the start, not 0 where `labels` was written. */
RC_API int32_t rc_nearest_part(const rc_graph *graph, const float *bound, int64_t count, const int64_t *pixels,
                               const int32_t *seeds, int32_t k, void *labels, uint8_t *listed,
                               const rc_control *control);

/* Third, for pixels of the rows [row0, row1): the lists of all `parts` are merged into those of the first, distances
 * ascending, the lower seed first among equals; unused places hold infinity and -1. Pixels that are no nodes are left as
 * they were. RC_SHORT: rounding made a bound too low; all is to be done again with bounds that are infinite. */
RC_API int32_t rc_nearest_merge(const rc_graph *graph, int64_t row0, int64_t row1, const float *bound, int32_t k,
                                int32_t parts, void *const *labels, const uint8_t *const *listed,
                                const rc_control *control);

/* Equation 1, one seed at a time, for a seed that lies `field` away (rows of field_stride floats). The sums are kept
 * relative to the nearest seed so far: weight = sum (r / nearest)^-alpha, and of each of 1 to RC_MAX_CHANNELS channels,
 * `channel_stride` floats apart in `means`, the same with the seed's value. Start: nearest = infinity, index = -1, the
 * rest 0. Add seeds in the same order for the same bits; of equally near ones the first gives the index. A cancelled
 * call leaves some pixels with the seed and some without. */
RC_API int32_t rc_blend_add(int64_t height, int64_t width, const float *field, int64_t field_stride, float alpha,
                            int32_t seed, int32_t channels, const float *values, float *nearest, int32_t *index,
                            float *weight, float *means, int64_t channel_stride, const rc_control *control);

/* Turn the sums into means, in place; a pixel without weight is left at 0. */
RC_API int32_t rc_blend_finish(int64_t count, const float *weight, int32_t channels, float *means,
                               int64_t channel_stride);

/* Equation 1 over the k labels of every pixel of one row range [row0, row1) of the merged lists. `values` holds
 * `channels` floats per seed. `bound` (may be null) receives the most that the seeds left out could change any channel
 * by, given that `count` seeds exist. Outputs are height x width, contiguous, `means` one such image for each channel;
 * a pixel without a label gets the distance infinity, the index -1 and otherwise 0. */
RC_API int32_t rc_blend_nearest(const rc_graph *graph, int64_t row0, int64_t row1, int32_t k, const void *labels,
                                int64_t count, int32_t channels, const float *values, float alpha, float *nearest,
                                int32_t *index, float *weight, float *means, float *bound);

/* For each of `pixels` rows of RC_FEATURES features, the sums over `count` seeds of weight * exp(-distance), distance
 * being that of the features: one sum for each of `channels` (1 to RC_MAX_CHANNELS) weights of a seed. `sums` receives
 * `pixels` rows of `channels`. `control->progress` is added pixels to. */
RC_API int32_t rc_kriging(int64_t pixels, const float *features, int64_t count, const float *seeds, int32_t channels,
                          const float *weights, float *sums, const rc_control *control);

/* How far rc_numbers came: all of it is whole lines. */
typedef struct {
    int64_t lines, rows, bytes;
} rc_numbers_read;

/* Read up to `most_lines` lines of a text, each of `width` decimal numbers between blanks and tabs or none at all, into
 * rows of `values`, which has room for `most_lines` of them. Lines end in LF; the last may end where the text does.
 * RC_BAD_VALUE: the line behind those told in `read` is of other make, or has more digits than are taken here. */
RC_API int32_t rc_numbers(int64_t size, const char *text, int64_t most_lines, int32_t width, double *values,
                          rc_numbers_read *read);

#endif
