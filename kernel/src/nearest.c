/* The k nearest seeds of every pixel.
 *
 * One propagation per seed, confined to the pixels where the seed can be among the k nearest. What confines it is, per
 * pixel, the k-th least distance found so far, or before k were found a bound on it from bounds.c. `current` in
 * rc_march holds exactly that number, so that confining costs the inner loop nothing. If seed j is among the k nearest
 * of a pixel, it is so for every pixel on its path, so that the confined distances are the true ones.
 */
#include <math.h>

#include "bounds.h"
#include "check.h"
#include "labels.h"
#include "march.h"

/* Entries ahead of the one at work whose lists are called into the cache, past the levels that the
 * propagation lives in. */
#define RC_AHEAD 32

/* For so many nearest seeds it pays to find a few first: they tell the distances between seeds, and those the bounds. */
#define RC_MANY 16
#define RC_FEW 4

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

/* Insert seed j into the lists of all pixels it settled, and make `current` each list's last distance again. */
static int32_t insert_trail(const rc_steps *steps, const rc_trail *trail, uint8_t *flags, int32_t k, int32_t j,
                            void *labels, float *current, const rc_control *control)
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
        insert(list, rc_seeds(labels, k, p), k, current[p], j);
        rc_set(steps, current, p, list[k - 1]);
        flags[p] = 0;
    }
    return RC_OK;
}

/* Start all lists: k places that hold the pixel's bound and no seed. Where there is no node, memory that was never
 * touched stays so. */
static int32_t clear_lists(const rc_steps *steps, int64_t size, int32_t k, const float *current, void *labels,
                           const rc_control *control)
{
    for (int64_t p = 0; p < size; p++) {
        if (p % RC_POLL == 0 && rc_cancelled(control)) {
            return RC_CANCELLED;
        }
        if (isnan(steps->y[p])) {
            continue;
        }
        float *const list = rc_distances(labels, k, p);
        int32_t *const ids = rc_seeds(labels, k, p);
        for (int32_t i = 0; i < k; i++) {
            list[i] = current[p];
            ids[i] = -1;
        }
    }
    return RC_OK;
}

/* Whether every list that a finite bound promised to fill is full. */
static int lists_full(const rc_steps *steps, int64_t size, int32_t k, void *labels, const rc_control *control)
{
    for (int64_t p = 0; p < size; p++) {
        if (!isnan(steps->y[p]) && rc_seeds(labels, k, p)[k - 1] < 0 && rc_distances(labels, k, p)[k - 1] < INFINITY) {
            return 0;
        }
        if (p % RC_POLL == 0 && rc_cancelled(control)) {
            return 0;
        }
    }
    return 1;
}

static int32_t march_seeds(const rc_steps *steps, const rc_graph *graph, rc_queue *queue, rc_trail *trail,
                           int64_t count, const int64_t *pixels, int32_t k, float *current, uint8_t *flags,
                           void *labels, const rc_control *control)
{
    const rc_control quiet = {control->cancel, NULL};
    for (int64_t j = 0; j < count; j++) {
        const int32_t p = rc_plane_position(graph, pixels[j]);
        if (rc_cancelled(control)) {
            return RC_CANCELLED;
        }
        rc_progress(control, 1);
        if (!(0.0f < current[p])) {
            continue;
        }
        trail->used = 0;
        rc_start(steps, queue, current, flags, p, 0.0f);
        int32_t code = steps->wrap ? rc_march(steps, queue, current, flags, trail, NULL, NULL, 1, &quiet)
                                   : rc_march(steps, queue, current, flags, trail, NULL, NULL, 0, &quiet);
        if (code == RC_OK) {
            code = insert_trail(steps, trail, flags, k, (int32_t)j, labels, current, control);
        }
        if (code != RC_OK) {
            return code;
        }
    }
    return RC_OK;
}

int32_t rc_nearest(const rc_graph *graph, int64_t count, const int64_t *pixels, int32_t k, void *labels,
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
    if (!labels) {
        return RC_BAD_POINTER;
    }
    if (k < 1 || k > RC_MAX_NEAREST) {
        return RC_BAD_VALUE;
    }
    const int64_t size = rc_plane_size(graph->height, graph->width);
    control = control ? control : &none;
    rc_steps steps;
    rc_steps_init(&steps, graph);
    rc_trail trail = {NULL, 0, 0};
    rc_net net = {0, {NULL, 0, 0}, NULL, NULL, NULL};
    rc_queue *queue = rc_queue_new();
    float *current = malloc((size_t)size * sizeof *current);
    uint8_t *flags = calloc((size_t)size, 1);
    code = queue && current && flags ? RC_OK : RC_MEMORY;
    const int32_t few = k >= RC_MANY ? RC_FEW : k;
    if (code == RC_OK) {
        code = rc_bounds_from_cells(&net, &steps, graph, queue, count, pixels, few, current, flags, control);
    }
    if (code == RC_OK && few < k) {
        const rc_control quiet = {control->cancel, NULL};
        code = clear_lists(&steps, size, few, current, labels, control);
        if (code == RC_OK) {
            code = march_seeds(&steps, graph, queue, &trail, count, pixels, few, current, flags, labels, &quiet);
        }
        if (code == RC_OK) {
            code = rc_bounds_from_lists(&net, &steps, graph, few, labels, k, current, control);
        }
    }
    for (int bounded = 1; code == RC_OK; bounded = 0) {
        if (!bounded && !rc_fill(current, size, INFINITY, control)) {
            code = RC_CANCELLED;
            break;
        }
        code = clear_lists(&steps, size, k, current, labels, control);
        if (code == RC_OK) {
            code = march_seeds(&steps, graph, queue, &trail, count, pixels, k, current, flags, labels, control);
        }
        /* Rounding could in principle make a bound too low; then a list stays short, and all is done without. */
        if (!bounded || lists_full(&steps, size, k, labels, control)) {
            break;
        }
        code = code == RC_OK && rc_cancelled(control) ? RC_CANCELLED : code;
    }
    rc_net_free(&net);
    free(trail.pixel);
    free(current);
    free(flags);
    rc_queue_free(queue);
    return code;
}
