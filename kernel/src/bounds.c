/* Upper bounds on the k-th least distance: see bounds.h. */
#include "bounds.h"

#include <math.h>

#include "check.h"
#include "labels.h"

/* Sums of the same path in another order differ by rounding: the bounds are raised by this much. */
#define RC_BOUND_SLACK 1.001f
/* Of every so many rows and columns, one pixel's list is looked through for links. */
#define RC_LINK_STRIDE 2

static float raised(float bound) { return bound * RC_BOUND_SLACK + 1e-30f; }

/* Where cells touch: the shortest path between their seeds that crosses there. */
static int32_t find_links(const rc_steps *s, const rc_graph *g, const float *distance, const int32_t *owner,
                          rc_links *links, const rc_control *control)
{
    static const int forward[4] = {6, 8, 9, 10};
    const lanes beta = lanes_all(s->beta);
    for (int32_t r = 1; r <= g->height; r++) {
        if (rc_cancelled(control)) {
            return RC_CANCELLED;
        }
        for (int32_t p = r * s->stride + 1; p <= r * s->stride + s->width; p++) {
            if (!(distance[p] < INFINITY)) {
                continue;
            }
            float found[12];
            int have = 0;
            for (int n = 0; n < 4; n++) {
                const int i = forward[n];
                int32_t q = p + s->offset[i];
                if (!(s->allowed >> i & 1) || isnan(s->y[q])) {
                    continue;
                }
                q = s->wrap ? rc_unwrap(s, q) : q;
                if (owner[p] == owner[q]) {
                    continue;
                }
                if (!have) {
                    const lanes here = lanes_all(distance[p]), y = lanes_all(s->y[p]), d = lanes_all(s->d[p]);
                    lanes_store(found + 4, rc_reach(s, p - 1, here, y, d, beta, s->cost + 4));
                    lanes_store(found + 8, rc_reach(s, p + s->stride - 1, here, y, d, beta, s->cost + 8));
                    have = 1;
                }
                if (!rc_links_add(links, owner[p], owner[q], found[i] + distance[q])) {
                    return RC_MEMORY;
                }
            }
        }
    }
    return RC_OK;
}

int32_t rc_bounds_from_cells(rc_net *net, const rc_steps *steps, const rc_graph *graph, rc_queue *queue, int64_t count,
                             const int64_t *pixels, int32_t k, float *bound, uint8_t *flags, int32_t *owner,
                             const rc_control *control)
{
    const rc_control quiet = {control->cancel, NULL};
    const int64_t size = rc_plane_size(graph->height, graph->width);
    net->count = count;
    net->node = malloc((size_t)count * sizeof *net->node);
    net->weight = calloc((size_t)count, sizeof *net->weight);
    net->reach = malloc((size_t)count * sizeof *net->reach);
    if (!net->node || !net->weight || !net->reach) {
        return RC_MEMORY;
    }
    if (!rc_fill(bound, size, INFINITY, control)) {
        return RC_CANCELLED;
    }
    for (int64_t j = 0; j < count; j++) {
        const int32_t p = rc_plane_position(graph, pixels[j]);
        if (bound[p] > 0.0f) {
            owner[p] = (int32_t)j;
            rc_start(steps, queue, bound, flags, p, 0.0f);
        }
        net->node[j] = owner[p];
        net->weight[owner[p]]++;
    }
    int32_t code = steps->wrap ? rc_march(steps, queue, bound, flags, NULL, owner, 1, &quiet)
                               : rc_march(steps, queue, bound, flags, NULL, owner, 0, &quiet);
    if (code == RC_OK) {
        code = find_links(steps, graph, bound, owner, &net->links, control);
    }
    if (code == RC_OK) {
        code = rc_links_search(count, k, &net->links, net->weight, net->reach, control);
    }
    for (int32_t r = 1; code == RC_OK && r <= graph->height; r++) {
        for (int32_t p = r * steps->stride + 1; p <= r * steps->stride + steps->width; p++) {
            if (bound[p] < INFINITY) {
                rc_set(steps, bound, p, raised(bound[p] + net->reach[owner[p]]));
            }
        }
    }
    return code;
}

int32_t rc_bounds_from_lists(rc_net *net, const rc_steps *steps, const rc_graph *graph, int32_t few, void *labels,
                             int32_t k, float *bound, const rc_control *control)
{
    for (int32_t r = 1; r <= graph->height; r += RC_LINK_STRIDE) {
        if (rc_cancelled(control)) {
            return RC_CANCELLED;
        }
        for (int32_t c = 1; c <= graph->width; c += RC_LINK_STRIDE) {
            const float *const d = rc_distances(labels, few, r * steps->stride + c);
            const int32_t *const id = rc_seeds(labels, few, r * steps->stride + c);
            for (int32_t i = 1; i < few && id[i] >= 0; i++) {
                for (int32_t j = 0; j < i; j++) {
                    const int32_t a = net->node[id[i]], b = net->node[id[j]];
                    if (a != b && !rc_links_add(&net->links, a, b, d[i] + d[j])) {
                        return RC_MEMORY;
                    }
                }
            }
        }
    }
    const int32_t code = rc_links_search(net->count, k, &net->links, net->weight, net->reach, control);
    for (int32_t r = 1; code == RC_OK && r <= graph->height; r++) {
        for (int32_t p = r * steps->stride + 1; p <= r * steps->stride + steps->width; p++) {
            const float *const d = rc_distances(labels, few, p);
            const int32_t *const id = rc_seeds(labels, few, p);
            float least = INFINITY;
            for (int32_t i = 0; i < few && id[i] >= 0; i++) {
                const float u = d[i] + net->reach[net->node[id[i]]];
                least = u < least ? u : least;
            }
            rc_set(steps, bound, p, raised(least));
        }
    }
    return code;
}

void rc_net_free(rc_net *net)
{
    free(net->links.link);
    free(net->node);
    free(net->weight);
    free(net->reach);
}
