/* Upper bounds on the k-th least distance, before any is known.
 *
 * A path from seed to seed of known length is a link; a search along links gives each seed a number u that the distance
 * of its k-th nearest seed (it is its own first) cannot exceed. By the triangle inequality u(s) + r(p, s) bounds
 * the k-th least distance of pixel p, for any seed s.
 */
#ifndef RC_BOUNDS_H
#define RC_BOUNDS_H

#include "links.h"
#include "march.h"

typedef struct {
    int64_t count;
    rc_links links;
    int32_t *node;   /* per seed, the first seed of the same pixel */
    int32_t *weight; /* per seed, how many seeds it is the first of */
    float *reach;    /* per seed, u */
} rc_net;

/* Fill `bound` (a plane) with numbers larger than the distance of the k-th nearest seed, infinite where fewer than k
 * arrive, from the seeds' Voronoi cells. `flags` is as for rc_march. `net` is to be freed whatever comes back. */
int32_t rc_bounds_from_cells(rc_net *net, const rc_steps *steps, const rc_graph *graph, rc_queue *queue, int64_t count,
                             const int64_t *pixels, int32_t k, float *bound, uint8_t *flags,
                             const rc_control *control);

/* The same, tighter, from lists of the few nearest seeds of every pixel. */
int32_t rc_bounds_from_lists(rc_net *net, const rc_steps *steps, const rc_graph *graph, int32_t few, const void *lists,
                             int32_t k, float *bound, const rc_control *control);

void rc_net_free(rc_net *net);

#endif
