/* Lengths of paths between seeds, and the search along them. */
#include "links.h"

#include <math.h>
#include <stdlib.h>

#include "control.h"

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

int rc_links_add(rc_links *t, int32_t a, int32_t b, float length)
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
static int32_t search(int64_t nodes, int32_t k, const int64_t *first, const rc_arc *arc, const int32_t *weight,
                      int32_t *seen, rc_arc *heap, float *reach, const rc_control *control)
{
    for (int32_t from = 0; from < nodes; from++) {
        int64_t used = 0, met = 0;
        reach[from] = INFINITY;
        if (rc_cancelled(control)) {
            return RC_CANCELLED;
        }
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
    return RC_OK;
}

int32_t rc_links_search(int64_t nodes, int32_t k, const rc_links *links, const int32_t *weight, float *reach,
                            const rc_control *control)
{
    int64_t *first = calloc((size_t)nodes + 2, sizeof *first);
    rc_arc *arc = malloc((size_t)(2 * links->used + 1) * sizeof *arc);
    rc_arc *heap = malloc((size_t)(2 * links->used + 1) * sizeof *heap);
    int32_t *seen = malloc((size_t)nodes * sizeof *seen);
    int32_t code = first && arc && heap && seen ? RC_OK : RC_MEMORY;
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
        code = search(nodes, k, first, arc, weight, seen, heap, reach, control);
    }
    free(first);
    free(arc);
    free(heap);
    free(seen);
    return code;
}

