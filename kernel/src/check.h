/* What every entry point checks before it touches memory. */
#ifndef RC_CHECK_H
#define RC_CHECK_H

#include "reflcolor_kernel.h"

int32_t rc_check_graph(const rc_graph *graph);
int32_t rc_check_pixels(const rc_graph *graph, int64_t count, const int64_t *pixels);

static inline int32_t rc_plane_position(const rc_graph *g, int64_t pixel)
{
    return (int32_t)((pixel / g->width + 1) * (g->width + 2) + pixel % g->width + 1);
}

#endif
