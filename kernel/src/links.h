/* Lengths of paths between seeds, and the search along them. */
#ifndef RC_LINKS_H
#define RC_LINKS_H

#include "reflcolor_kernel.h"

typedef struct {
    int64_t pair; /* low node << 32 | high node; -1: free */
    float length;
} rc_link;

/* A hash table; all zero is an empty one, and `link` is to be freed. */
typedef struct {
    rc_link *link;
    int64_t used, room; /* room: a power of two */
} rc_links;

/* Note a path between two nodes; the shortest one counts. Returns 0 if memory is out. */
int rc_links_add(rc_links *links, int32_t a, int32_t b, float length);

/* For every node the length within which a search from it meets k seeds, infinite if it never does. `weight` says how
 * many seeds a node stands for; one without seeds is passed over. */
int32_t rc_links_search(int64_t nodes, int32_t k, const rc_links *links, const int32_t *weight, float *reach,
                        const rc_control *control);

#endif
