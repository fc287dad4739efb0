/* Upper bounds on the k-th least distance: see bounds.h. */
#include "bounds.h"

#include <math.h>

#include "check.h"
#include "labels.h"

/* Sums of the same path in another order differ by rounding: the bounds are raised by this much. */
#define RC_BOUND_SLACK 1.001f
/* Of every so many rows and columns, one pixel's list is looked through for links. */
#define RC_LINK_STRIDE 2
/* The cells grow in one band of rows after another, so that what is at work fits the cache; a band has so many pixels,
 * and so many times the rows that lie between neighboring seeds, lest much be done again where bands meet. */
#ifndef RC_BAND_PIXELS
#define RC_BAND_PIXELS (1 << 19)
#define RC_BAND_CELLS 6
#endif

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

/* Propagate within every band in turn what waits in it, downwards and upwards, until nothing waits anywhere. */
static int32_t march_bands(const rc_steps *s, rc_queue *queue, int32_t bands, int32_t band_size, rc_trail *waiting,
                           float *current, uint8_t *flags, int32_t *owner, const rc_control *control)
{
    const rc_control quiet = {control->cancel, NULL};
    rc_trail beyond = {NULL, 0, 0}; /* there are no pixels above the first band and below the last */
    int32_t code = RC_OK;
    for (int down = 1, more = 1; more; down = !down) {
        more = 0;
        for (int32_t n = 0; n < bands && code == RC_OK; n++) {
            const int32_t b = down ? n : bands - 1 - n;
            rc_trail *const here = waiting + b;
            const rc_band band = {b * band_size, band_size, b ? here - 1 : &beyond, b < bands - 1 ? here + 1 : &beyond};
            more |= here->used > 0;
            for (int64_t i = 0; i < here->used; i++) {
                rc_push(queue, current[here->pixel[i]], here->pixel[i], 1);
            }
            here->used = 0;
            code = s->wrap ? rc_march(s, queue, current, flags, NULL, owner, &band, 1, &quiet)
                           : rc_march(s, queue, current, flags, NULL, owner, &band, 0, &quiet);
        }
    }
    return code;
}

/* Distance and index of the nearest seed of every pixel, and the nodes of the net. */
static int32_t find_cells(rc_net *net, const rc_steps *steps, const rc_graph *graph, rc_queue *queue, int64_t count,
                          const int64_t *pixels, float *distance, uint8_t *flags, int32_t *owner,
                          const rc_control *control)
{
    const double apart = sqrt((double)graph->height * (double)graph->width / (double)count);
    int64_t rows = RC_BAND_PIXELS / steps->stride;
    rows = rows < RC_BAND_CELLS * apart ? (int64_t)(RC_BAND_CELLS * apart) : rows;
    rows = rows < 1 ? 1 : rows;
    rows = rows < graph->height + 2 ? rows : graph->height + 2;
    const int32_t bands = (int32_t)((graph->height + 2 + rows - 1) / rows);
    const int32_t band_size = (int32_t)rows * steps->stride;
    rc_trail *waiting = calloc((size_t)bands, sizeof *waiting);
    int32_t code = waiting ? RC_OK : RC_MEMORY;
    for (int64_t j = 0; j < count && code == RC_OK; j++) {
        const int32_t p = rc_plane_position(graph, pixels[j]);
        if (distance[p] > 0.0f) {
            rc_trail *const t = waiting + p / band_size;
            owner[p] = (int32_t)j;
            rc_set(steps, distance, p, 0.0f);
            flags[p] |= RC_WAITING;
            if (t->used == t->room && !rc_trail_grow(t)) {
                code = RC_MEMORY;
                break;
            }
            t->pixel[t->used++] = p;
        }
        net->node[j] = owner[p];
        net->weight[owner[p]]++;
    }
    if (code == RC_OK) {
        code = march_bands(steps, queue, bands, band_size, waiting, distance, flags, owner, control);
    }
    for (int32_t b = 0; waiting && b < bands; b++) {
        free(waiting[b].pixel);
    }
    free(waiting);
    return code;
}

int32_t rc_bounds_from_cells(rc_net *net, const rc_steps *steps, const rc_graph *graph, rc_queue *queue, int64_t count,
                             const int64_t *pixels, int32_t k, float *bound, uint8_t *flags, const rc_control *control)
{
    const int64_t size = rc_plane_size(graph->height, graph->width);
    int32_t *const owner = malloc((size_t)size * sizeof *owner);
    net->count = count;
    net->node = malloc((size_t)count * sizeof *net->node);
    net->weight = calloc((size_t)count, sizeof *net->weight);
    net->reach = malloc((size_t)count * sizeof *net->reach);
    int32_t code = owner && net->node && net->weight && net->reach ? RC_OK : RC_MEMORY;
    if (code == RC_OK && !rc_fill(bound, size, INFINITY, control)) {
        code = RC_CANCELLED;
    }
    if (code == RC_OK) {
        code = find_cells(net, steps, graph, queue, count, pixels, bound, flags, owner, control);
    }
    if (code == RC_OK) {
        code = find_links(steps, graph, bound, owner, &net->links, control);
    }
    if (code == RC_OK) {
        code = rc_links_search(count, k, &net->links, net->weight, net->reach, control);
    }
    for (int32_t r = 1; code == RC_OK && r <= graph->height; r++) {
        code = rc_cancelled(control) ? RC_CANCELLED : RC_OK;
        for (int32_t p = r * steps->stride + 1; p <= r * steps->stride + steps->width; p++) {
            if (bound[p] < INFINITY) {
                rc_set(steps, bound, p, raised(bound[p] + net->reach[owner[p]]));
            }
        }
    }
    free(owner);
    return code;
}

int32_t rc_bounds_from_lists(rc_net *net, const rc_steps *steps, const rc_graph *graph, int32_t few, const void *lists,
                             int32_t k, float *bound, const rc_control *control)
{
    void *const labels = (void *)lists; /* they are only read */
    for (int32_t r = 1; r <= graph->height; r += RC_LINK_STRIDE) {
        if (rc_cancelled(control)) {
            return RC_CANCELLED;
        }
        for (int32_t c = 1; c <= graph->width; c += RC_LINK_STRIDE) {
            const float *const d = rc_distances(labels, few, r * steps->stride + c);
            const int32_t *const id = rc_seeds(labels, few, r * steps->stride + c);
            const int32_t listed = isnan(steps->y[r * steps->stride + c]) ? 0 : few;
            for (int32_t i = 0; i < listed && id[i] >= 0; i++) {
                if (id[i] >= net->count) {
                    return RC_BAD_SEED;
                }
                for (int32_t j = 0; j < i; j++) {
                    const int32_t a = net->node[id[i]], b = net->node[id[j]];
                    if (a != b && !rc_links_add(&net->links, a, b, d[i] + d[j])) {
                        return RC_MEMORY;
                    }
                }
            }
        }
    }
    int32_t code = rc_links_search(net->count, k, &net->links, net->weight, net->reach, control);
    for (int32_t r = 1; code == RC_OK && r <= graph->height; r++) {
        code = rc_cancelled(control) ? RC_CANCELLED : RC_OK;
        for (int32_t p = r * steps->stride + 1; p <= r * steps->stride + steps->width; p++) {
            if (isnan(steps->y[p])) {
                continue;
            }
            const float *const d = rc_distances(labels, few, p);
            const int32_t *const id = rc_seeds(labels, few, p);
            float least = INFINITY;
            for (int32_t i = 0; i < few && id[i] >= 0; i++) {
                if (id[i] >= net->count) {
                    return RC_BAD_SEED;
                }
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
