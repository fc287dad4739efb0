/* Bounds on the k-th least distance from the seeds' Voronoi cells.
 *
 * One propagation from all seeds gives every pixel its nearest seed. Where two cells touch, a path leads from seed to
 * seed; a search on the graph of these paths gives each seed a number u that the distance of its k-th nearest seed (it
 * is its own first) cannot exceed. By the triangle inequality min over seeds s of u(s) + r(p, s) bounds pixel p, and
 * that is one more propagation from all seeds, each starting at its u.
 */
#include <math.h>

#include "bounds.h"
#include "check.h"

/* Sums of the same path in another order differ by rounding: the bounds are raised by this much. */
#define RC_BOUND_SLACK 1.001f

typedef struct {
    int64_t pair; /* low node << 32 | high node; -1: free */
    float length;
} rc_link;

typedef struct {
    rc_link *link;
    int64_t used, room; /* room: a power of two */
} rc_links;

typedef struct {
    float length;
    int32_t node;
} rc_arc;

static int64_t slot_of(const rc_links *t, int64_t pair)
{
    uint64_t h = (uint64_t)pair * UINT64_C(0x9E3779B97F4A7C15);
    int64_t i = (int64_t)((h ^ (h >> 29)) & (uint64_t)(t->room - 1));
    while (t->link[i].pair >= 0 && t->link[i].pair != pair) {
        i = (i + 1) & (t->room - 1);
    }
    return i;
}

static int links_grow(rc_links *t)
{
    rc_links larger = {NULL, t->used, t->room ? 2 * t->room : 1024};
    larger.link = malloc((size_t)larger.room * sizeof *larger.link);
    if (!larger.link) {
        return 0;
    }
    for (int64_t i = 0; i < larger.room; i++) {
        larger.link[i].pair = -1;
    }
    for (int64_t i = 0; i < t->room; i++) {
        if (t->link[i].pair >= 0) {
            larger.link[slot_of(&larger, t->link[i].pair)] = t->link[i];
        }
    }
    free(t->link);
    *t = larger;
    return 1;
}

static int links_add(rc_links *t, int32_t a, int32_t b, float length)
{
    if (2 * (t->used + 1) > t->room && !links_grow(t)) {
        return 0;
    }
    const int64_t pair = a < b ? (int64_t)a << 32 | b : (int64_t)b << 32 | a;
    const int64_t i = slot_of(t, pair);
    if (t->link[i].pair < 0) {
        t->link[i].pair = pair;
        t->link[i].length = length;
        t->used++;
    } else if (length < t->link[i].length) {
        t->link[i].length = length;
    }
    return 1;
}

/* Where cells touch: the shortest path between their seeds that crosses there. */
static int32_t find_links(const rc_steps *s, const rc_graph *g, const float *distance, const int32_t *owner,
                          rc_links *links, const rc_control *control)
{
    static const int forward[4] = {6, 8, 9, 10};
    const lanes beta = lanes_all(s->beta);
    for (int32_t r = 1; r <= g->height; r++) {
        if (control->cancel && *control->cancel) {
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
                if (!links_add(links, owner[p], owner[q], found[i] + distance[q])) {
                    return RC_MEMORY;
                }
            }
        }
    }
    return RC_OK;
}

/* A binary heap of arcs by length. */
static void heap_push(rc_arc *heap, int64_t *used, rc_arc a)
{
    int64_t i = (*used)++;
    for (; i > 0 && a.length < heap[(i - 1) / 2].length; i = (i - 1) / 2) {
        heap[i] = heap[(i - 1) / 2];
    }
    heap[i] = a;
}

static rc_arc heap_pop(rc_arc *heap, int64_t *used)
{
    const rc_arc first = heap[0], a = heap[--*used];
    int64_t i = 0;
    for (int64_t c; (c = 2 * i + 1) < *used; i = c) {
        c += c + 1 < *used && heap[c + 1].length < heap[c].length;
        if (!(heap[c].length < a.length)) {
            break;
        }
        heap[i] = heap[c];
    }
    heap[i] = a;
    return first;
}

/* For every node the length within which the search meets k seeds. `weight` says how many seeds a node stands for;
 * `first` and `arc` list each node's neighbors; `seen` holds -1 everywhere; `heap` has room for every arc and one. */
static void search(int64_t nodes, int32_t k, const int64_t *first, const rc_arc *arc, const int32_t *weight,
                   int32_t *seen, rc_arc *heap, float *reach)
{
    for (int32_t from = 0; from < nodes; from++) {
        int64_t used = 0, met = 0;
        reach[from] = INFINITY;
        if (!weight[from]) {
            continue;
        }
        heap_push(heap, &used, (rc_arc){0.0f, from});
        while (used) {
            const rc_arc at = heap_pop(heap, &used);
            if (seen[at.node] == from) {
                continue;
            }
            seen[at.node] = from;
            met += weight[at.node];
            if (met >= k) {
                reach[from] = at.length;
                break;
            }
            for (int64_t i = first[at.node]; i < first[at.node + 1]; i++) {
                if (seen[arc[i].node] != from) {
                    heap_push(heap, &used, (rc_arc){at.length + arc[i].length, arc[i].node});
                }
            }
        }
    }
}

/* The search of all nodes over links; `reach` has room for `nodes`. */
static int32_t search_links(int64_t nodes, int32_t k, const rc_links *links, const int32_t *weight, float *reach)
{
    int64_t *first = calloc((size_t)nodes + 2, sizeof *first);
    rc_arc *arc = malloc((size_t)(2 * links->used + 1) * sizeof *arc);
    rc_arc *heap = malloc((size_t)(2 * links->used + 1) * sizeof *heap);
    int32_t *seen = malloc((size_t)nodes * sizeof *seen);
    const int32_t code = first && arc && heap && seen ? RC_OK : RC_MEMORY;
    if (code == RC_OK) {
        for (int64_t i = 0; i < nodes; i++) {
            seen[i] = -1;
        }
        for (int64_t i = 0; i < links->room; i++) {
            if (links->link[i].pair >= 0) {
                first[(links->link[i].pair >> 32) + 2]++;
                first[(links->link[i].pair & INT32_MAX) + 2]++;
            }
        }
        for (int64_t i = 2; i < nodes + 2; i++) {
            first[i] += first[i - 1];
        }
        for (int64_t i = 0; i < links->room; i++) {
            if (links->link[i].pair >= 0) {
                const int32_t a = (int32_t)(links->link[i].pair >> 32), b = (int32_t)(links->link[i].pair & INT32_MAX);
                arc[first[a + 1]++] = (rc_arc){links->link[i].length, b};
                arc[first[b + 1]++] = (rc_arc){links->link[i].length, a};
            }
        }
        search(nodes, k, first, arc, weight, seen, heap, reach);
    }
    free(first);
    free(arc);
    free(heap);
    free(seen);
    return code;
}

static int32_t march(const rc_steps *steps, rc_queue *queue, float *plane, uint8_t *flags, int32_t *owner,
                     const rc_control *control)
{
    const rc_control quiet = {control->cancel, NULL};
    return steps->wrap ? rc_march(steps, queue, plane, flags, NULL, owner, 1, &quiet)
                       : rc_march(steps, queue, plane, flags, NULL, owner, 0, &quiet);
}

int32_t rc_bounds(const rc_steps *steps, const rc_graph *graph, rc_queue *queue, int64_t count, const int64_t *pixels,
                  int32_t k, float *bound, uint8_t *flags, int32_t *owner, const rc_control *control)
{
    const int64_t size = rc_plane_size(graph->height, graph->width);
    rc_links links = {NULL, 0, 0};
    int32_t *weight = calloc((size_t)count, sizeof *weight); /* seeds per node: a node is the first seed of a pixel */
    float *reach = malloc((size_t)count * sizeof *reach);
    int32_t code = weight && reach ? RC_OK : RC_MEMORY;
    for (int64_t i = 0; i < size; i++) {
        bound[i] = INFINITY;
    }
    for (int64_t j = 0; code == RC_OK && j < count; j++) {
        const int32_t p = rc_plane_position(graph, pixels[j]);
        if (bound[p] > 0.0f) {
            owner[p] = (int32_t)j;
            rc_start(steps, queue, bound, flags, p, 0.0f);
        }
        weight[owner[p]]++;
    }
    if (code == RC_OK) {
        code = march(steps, queue, bound, flags, owner, control);
    }
    if (code == RC_OK) {
        code = find_links(steps, graph, bound, owner, &links, control);
    }
    if (code == RC_OK) {
        code = search_links(count, k, &links, weight, reach);
    }
    for (int64_t i = 0; code == RC_OK && i < size; i++) {
        bound[i] = INFINITY;
    }
    for (int64_t j = 0; code == RC_OK && j < count; j++) {
        const int32_t p = rc_plane_position(graph, pixels[j]);
        if (reach[j] < bound[p]) {
            rc_start(steps, queue, bound, flags, p, reach[j]);
        }
    }
    if (code == RC_OK) {
        code = march(steps, queue, bound, flags, NULL, control);
    }
    for (int64_t i = 0; code == RC_OK && i < size; i++) {
        bound[i] = bound[i] * RC_BOUND_SLACK + 1e-30f;
    }
    free(links.link);
    free(weight);
    free(reach);
    return code;
}
