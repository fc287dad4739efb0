/* An upper bound on the k-th least distance, before any is known. */
#ifndef RC_BOUNDS_H
#define RC_BOUNDS_H

#include "march.h"

/* Fill `bound` (a plane) with a number that is larger than the distance of the k-th nearest seed; infinite where
 * fewer than k seeds arrive. `owner` is scratch of a plane's size, `flags` as for
 * rc_march. */
int32_t rc_bounds(const rc_steps *steps, const rc_graph *graph, rc_queue *queue, int64_t count, const int64_t *pixels,
                  int32_t k, float *bound, uint8_t *flags, int32_t *owner, const rc_control *control);

#endif
