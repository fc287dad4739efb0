/* The k nearest seeds of every pixel.
 *
 * One propagation per seed, confined to the pixels where the seed can be among the k nearest. What confines it is, per
 * pixel, the k-th least distance found so far, or before k were found a bound on it from bounds.c. `current` in
 * rc_march holds exactly that number, so that confining costs the inner loop nothing. If seed j is among the k nearest
 * of a pixel, it is so for every pixel on its path, so that the confined distances are the true ones.
 *
 * Seeds may be parted among several calls, one for each thread, whose lists are merged: every list holds the nearest of
 * its part, by distance and then by index, and so do the merged ones of all.
 */
#include <math.h>
#include <string.h>

#include "bounds.h"
#include "check.h"
#include "labels.h"
#include "march.h"

/* Entries ahead of the one at work whose lists are called into the cache, past the levels that the
 * propagation lives in. */
#define RC_AHEAD 32

/* Insert (d, j) into a list of k ascending places, behind its equals; the last place is lost. Within four places
 * nothing branches, because where to insert cannot be foreseen; fours of nearer seeds are not touched. */
static inline void insert(float *list, int32_t *ids, int32_t k, float d, int32_t j)
{
    const int32_t whole = k & ~3;
    const lanes new_d = lanes_all(d), new_j = lanes_all_int(j);
    const int first = list[0] <= d;
    const float first_d = list[0];
    const int32_t first_j = ids[0];
    for (int32_t i = k - 1; i >= whole && i > 0; i--) {
        const int shift = !(list[i - 1] <= d), here = !(list[i] <= d);
        ids[i] = here ? (shift ? ids[i - 1] : j) : ids[i];
        list[i] = here ? (shift ? list[i - 1] : d) : list[i];
    }
    for (int32_t i = whole - 4; i >= 0; i -= 4) {
        /* The first place has none before it; what is read there instead is replaced below. */
        const lanes at = lanes_load(list + i), before = lanes_load(list + i - 1);
        if (!lanes_less(new_d, at)) {
            return;
        }
        const lanes at_j = lanes_load_int(ids + i), before_j = lanes_load_int(ids + i - 1);
        lanes_store_int(ids + i, lanes_choose(at, new_d, at_j, lanes_choose(before, new_d, new_j, before_j)));
        lanes_store(list + i, lanes_choose(at, new_d, at, lanes_choose(before, new_d, new_d, before)));
    }
    list[0] = first ? first_d : d;
    ids[0] = first ? first_j : j;
}

/* A pixel's list has been started: a bit of `flags` beside those of queue.h. */
#define RC_LISTED 4

/* Insert seed j into the lists of all pixels it settled, and make `current` each list's last distance again. A list
 * starts as k places that hold the pixel's bound and no seed; where no seed comes, its memory is never touched. */
static int32_t insert_trail(const rc_steps *steps, const rc_trail *trail, const float *bound, uint8_t *flags, int32_t k,
                            int32_t j, void *labels, float *current, const rc_control *control)
{
    for (int64_t n = 0; n < trail->used; n++) {
        if (n % RC_POLL == 0 && rc_cancelled(control)) {
            return RC_CANCELLED;
        }
        if (n + RC_AHEAD < trail->used) {
            const float *const ahead = rc_distances(labels, k, trail->pixel[n + RC_AHEAD]);
            for (int32_t i = 0; i < 2 * k; i += 16) {
                __builtin_prefetch(ahead + i, 0, 0);
            }
        }
        const int32_t p = trail->pixel[n];
        float *const list = rc_distances(labels, k, p);
        int32_t *const ids = rc_seeds(labels, k, p);
        if (!(flags[p] & RC_LISTED)) {
            for (int32_t i = 0; i < k; i++) {
                list[i] = bound[p];
                ids[i] = -1;
            }
        }
        insert(list, ids, k, current[p], j);
        rc_set(steps, current, p, list[k - 1]);
        flags[p] = RC_LISTED;
    }
    return RC_OK;
}

static int32_t check_search(const rc_graph *graph, int64_t count, const int64_t *pixels, int32_t k)
{
    int32_t code = rc_check_graph(graph);
    if (code == RC_OK) {
        code = rc_check_pixels(graph, count, pixels);
    }
    return code != RC_OK ? code : k < 1 || k > RC_MAX_NEAREST ? RC_BAD_VALUE : RC_OK;
}

int32_t rc_nearest_bounds(const rc_graph *graph, int64_t count, const int64_t *pixels, int32_t k, int32_t few,
                          const void *lists, float *bound, const rc_control *control)
{
    static const rc_control none = {NULL, NULL};
    int32_t code = check_search(graph, count, pixels, k);
    if (code != RC_OK) {
        return code;
    }
    if (!bound) {
        return RC_BAD_POINTER;
    }
    if (lists && (few < 1 || few >= k)) {
        return RC_BAD_VALUE;
    }
    control = control ? control : &none;
    rc_steps steps;
    rc_steps_init(&steps, graph);
    rc_net net = {0, {NULL, 0, 0}, NULL, NULL, NULL};
    rc_queue *queue = rc_queue_new();
    uint8_t *flags = calloc((size_t)rc_plane_size(graph->height, graph->width), 1);
    code = queue && flags ? RC_OK : RC_MEMORY;
    if (code == RC_OK) {
        code = rc_bounds_from_cells(&net, &steps, graph, queue, count, pixels, k, bound, flags, control);
    }
    if (code == RC_OK && lists) {
        code = rc_bounds_from_lists(&net, &steps, graph, few, lists, k, bound, control);
    }
    rc_net_free(&net);
    free(flags);
    rc_queue_free(queue);
    return code;
}

int32_t rc_nearest_part(const rc_graph *graph, const float *bound, int64_t count, const int64_t *pixels,
                        const int32_t *seeds, int32_t k, void *labels, uint8_t *listed, const rc_control *control)
{
    static const rc_control none = {NULL, NULL};
    int32_t code = check_search(graph, count, pixels, k);
    if (code != RC_OK) {
        return code;
    }
    if (!bound || !seeds || !labels || !listed) {
        return RC_BAD_POINTER;
    }
    const int64_t size = rc_plane_size(graph->height, graph->width);
    control = control ? control : &none;
    const rc_control quiet = {control->cancel, NULL};
    rc_steps steps;
    rc_steps_init(&steps, graph);
    rc_trail trail = {NULL, 0, 0};
    rc_queue *queue = rc_queue_new();
    float *current = malloc((size_t)size * sizeof *current);
    code = queue && current ? RC_OK : RC_MEMORY;
    for (int64_t i = 0; code == RC_OK && i < size; i += RC_POLL) {
        memcpy(current + i, bound + i, (size_t)(size - i < RC_POLL ? size - i : RC_POLL) * sizeof *current);
        code = rc_cancelled(control) ? RC_CANCELLED : RC_OK;
    }
    for (int64_t n = 0; code == RC_OK && n < count; n++) {
        const int32_t p = rc_plane_position(graph, pixels[n]);
        if (seeds[n] < 0 || (n > 0 && seeds[n] <= seeds[n - 1])) {
            code = RC_BAD_SEED;
            break;
        }
        rc_progress(control, 1);
        if (!(0.0f < current[p])) {
            code = rc_cancelled(control) ? RC_CANCELLED : RC_OK;
            continue;
        }
        trail.used = 0;
        rc_start(&steps, queue, current, listed, p, 0.0f);
        code = steps.wrap ? rc_march(&steps, queue, current, listed, &trail, NULL, NULL, 1, &quiet)
                          : rc_march(&steps, queue, current, listed, &trail, NULL, NULL, 0, &quiet);
        if (code == RC_OK) {
            code = insert_trail(&steps, &trail, bound, listed, k, seeds[n], labels, current, control);
        }
    }
    free(trail.pixel);
    free(current);
    rc_queue_free(queue);
    return code;
}

/* The k least of several lists, by distance and then by seed, into `distances` and `seeds`; returns how many. */
static int32_t merge_lists(int32_t k, int32_t parts, void *const *labels, const uint8_t *const *listed, int64_t p,
                           float *distances, int32_t *seeds)
{
    int32_t at[RC_MAX_PARTS], count = 0;
    for (int32_t n = 0; n < parts; n++) {
        at[n] = listed[n][p] ? 0 : k;
    }
    for (; count < k; count++) {
        int32_t first = -1, seed = -1;
        float least = INFINITY;
        for (int32_t n = 0; n < parts; n++) {
            const int32_t next = at[n] < k ? rc_seeds(labels[n], k, p)[at[n]] : -1;
            if (next < 0) {
                continue;
            }
            const float distance = rc_distances(labels[n], k, p)[at[n]];
            if (first < 0 || distance < least || (distance == least && next < seed)) {
                first = n;
                seed = next;
                least = distance;
            }
        }
        if (first < 0) {
            break;
        }
        distances[count] = least;
        seeds[count] = seed;
        at[first]++;
    }
    return count;
}

int32_t rc_nearest_merge(const rc_graph *graph, int64_t row0, int64_t row1, const float *bound, int32_t k,
                         int32_t parts, void *const *labels, const uint8_t *const *listed, const rc_control *control)
{
    const int32_t code = rc_check_graph(graph);
    if (code != RC_OK) {
        return code;
    }
    if (!bound || !labels || !listed) {
        return RC_BAD_POINTER;
    }
    if (row0 < 0 || row1 < row0 || row1 > graph->height) {
        return RC_BAD_SIZE;
    }
    if (k < 1 || k > RC_MAX_NEAREST || parts < 1 || parts > RC_MAX_PARTS) {
        return RC_BAD_VALUE;
    }
    for (int32_t n = 0; n < parts; n++) {
        if (!labels[n] || !listed[n]) {
            return RC_BAD_POINTER;
        }
    }
    float distances[RC_MAX_NEAREST];
    int32_t seeds[RC_MAX_NEAREST];
    for (int64_t row = row0; row < row1; row++) {
        if (control && rc_cancelled(control)) {
            return RC_CANCELLED;
        }
        for (int64_t c = 0; c < graph->width; c++) {
            const int64_t p = (row + 1) * (graph->width + 2) + c + 1;
            if (isnan(graph->y[p])) {
                continue;
            }
            float *const list = rc_distances(labels[0], k, p);
            int32_t *const ids = rc_seeds(labels[0], k, p);
            if (parts == 1 && listed[0][p] && ids[k - 1] >= 0) {
                continue;
            }
            int32_t n = merge_lists(k, parts, labels, listed, p, distances, seeds);
            if (n < k && bound[p] < INFINITY) {
                return RC_SHORT;
            }
            memcpy(list, distances, (size_t)n * sizeof *list);
            memcpy(ids, seeds, (size_t)n * sizeof *ids);
            for (; n < k; n++) {
                list[n] = INFINITY;
                ids[n] = -1;
            }
        }
    }
    return RC_OK;
}
