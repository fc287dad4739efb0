/* The memory of lists of nearest seeds: for every plane position k distances, then k seeds, side by side so that one visit
 * to a pixel touches as little memory as can be. */
#ifndef RC_LABELS_H
#define RC_LABELS_H

#include <stdint.h>

static inline float *rc_distances(void *labels, int32_t k, int64_t p) { return (float *)labels + p * 2 * k; }

static inline int32_t *rc_seeds(void *labels, int32_t k, int64_t p) { return (int32_t *)labels + p * 2 * k + k; }

#endif
