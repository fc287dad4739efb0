/* One geodesic field. */
#include <math.h>

#include "check.h"
#include "march.h"

int32_t rc_field(const rc_graph *graph, int64_t count, const int64_t *pixels, const float *start, float *plane,
                 const rc_control *control)
{
    static const rc_control none = {NULL, NULL};
    int32_t code = rc_check_graph(graph);
    if (code == RC_OK) {
        code = rc_check_pixels(graph, count, pixels);
    }
    if (code != RC_OK) {
        return code;
    }
    if (!plane) {
        return RC_BAD_POINTER;
    }
    for (int64_t i = 0; start && i < count; i++) {
        if (!(start[i] >= 0.0f)) {
            return RC_BAD_VALUE;
        }
    }
    const int64_t size = rc_plane_size(graph->height, graph->width);
    rc_queue *queue = rc_queue_new();
    uint8_t *flags = calloc((size_t)size, 1);
    if (!queue || !flags) {
        rc_queue_free(queue);
        free(flags);
        return RC_MEMORY;
    }
    rc_steps steps;
    rc_steps_init(&steps, graph);
    control = control ? control : &none;
    code = rc_fill(plane, size, INFINITY, control) ? RC_OK : RC_CANCELLED;
    for (int64_t i = 0; code == RC_OK && i < count; i++) {
        const int32_t p = rc_plane_position(graph, pixels[i]);
        const float at = start ? start[i] + 0.0f : 0.0f; /* -0 would not sort by its bits */
        if (at < plane[p]) {
            rc_start(&steps, queue, plane, flags, p, at);
        }
    }
    if (code == RC_OK) {
        code = graph->wrap ? rc_march(&steps, queue, plane, flags, NULL, NULL, NULL, 1, control)
                           : rc_march(&steps, queue, plane, flags, NULL, NULL, NULL, 0, control);
    }
    rc_queue_free(queue);
    free(flags);
    return code;
}
