/* The propagation of distances that both rc_field and rc_nearest are made of. */
#ifndef RC_MARCH_H
#define RC_MARCH_H

#include "control.h"
#include "lanes.h"
#include "queue.h"
#include "reflcolor_kernel.h"

typedef struct {
    const float *y, *d;
    int32_t stride; /* of a plane: width + 2 */
    int32_t width;
    float beta;
    unsigned allowed; /* bit 4 * row + column of the 3 x 3 neighborhood */
    int wrap;
    float cost[12]; /* constant part of the step to each neighbor, rows of four */
    int32_t offset[12];
} rc_steps;

static inline void rc_steps_init(rc_steps *s, const rc_graph *g)
{
    const float diagonal = g->step_cost * 1.41421356237309504880f;
    s->y = g->y;
    s->d = g->d;
    s->width = (int32_t)g->width;
    s->stride = (int32_t)g->width + 2;
    s->beta = g->beta;
    s->wrap = g->wrap != 0;
    s->allowed = g->neighbors == 8 ? 0x757u : 0x252u;
    for (int i = 0; i < 12; i++) {
        const int row = i / 4 - 1, column = i % 4 - 1;
        s->offset[i] = row * s->stride + column;
        s->cost[i] = row && column ? diagonal : g->step_cost;
    }
}

/* Costs of going from pixel p, which lies `here` away, to the three (four) pixels from plane position q on. */
static inline lanes rc_reach(const rc_steps *s, int64_t q, lanes here, lanes y, lanes d, lanes beta, const float *cost)
{
    const lanes dd = lanes_sub(lanes_load(s->d + q), d);
    const lanes dy = lanes_abs(lanes_sub(lanes_load(s->y + q), y));
    const lanes per_unit = lanes_add(lanes_mul(beta, lanes_mul(dd, dd)), lanes_all(1.0f));
    return lanes_add(here, lanes_add(lanes_mul(per_unit, dy), lanes_load(cost)));
}

/* A wrapped image has copies of its edge columns in the rim: the pixel itself for a rim position. */
static inline int32_t rc_unwrap(const rc_steps *s, int32_t q)
{
    const int32_t column = q % s->stride;
    return column == 0 ? q + s->width : column == s->width + 1 ? q - s->width : q;
}

/* Give pixel q and its copies in the rim a value. */
static inline void rc_set(const rc_steps *s, float *current, int32_t q, float value)
{
    current[q] = value;
    if (s->wrap) {
        const int32_t column = q % s->stride;
        if (column == 1) {
            current[q + s->width] = value;
        }
        if (column == s->width) {
            current[q - s->width] = value;
        }
    }
}

/* Pixels settled, each once, in the order of their first settling. */
typedef struct {
    int32_t *pixel;
    int64_t used, room;
} rc_trail;

static inline int rc_trail_grow(rc_trail *t)
{
    const int64_t room = t->room ? 2 * t->room : 4096;
    int32_t *pixel = realloc(t->pixel, (size_t)room * sizeof *pixel);
    if (!pixel) {
        return 0;
    }
    t->pixel = pixel;
    t->room = room;
    return 1;
}

/* Rows that a propagation keeps to, as plane positions from `first` on; what it reaches above and below them waits in
 * the two lists, to be pushed when the turn of their rows comes. */
typedef struct {
    int32_t first, size;
    rc_trail *above, *below;
} rc_band;

/* Let a pixel wait beyond the band; returns 0 if memory is out. */
static inline int rc_band_wait(const rc_band *band, int32_t q)
{
    rc_trail *const t = q < band->first ? band->above : band->below;
    if (t->used == t->room && !rc_trail_grow(t)) {
        return 0;
    }
    t->pixel[t->used++] = q;
    return 1;
}

/* A pixel the propagation starts from. */
static inline void rc_start(const rc_steps *s, rc_queue *queue, float *current, uint8_t *flags, int32_t p, float at)
{
    rc_set(s, current, p, at);
    flags[p] |= RC_WAITING;
    rc_push(queue, at, p, 1);
}

/* Settle everything in the queue. `current` holds, per plane position, the distance below which a path is of
 * interest, and afterwards the distance itself where one was found. `flags` is a plane of bytes, 0 at the start, and
 * again at the end but for RC_SETTLED on the trail's pixels and RC_WAITING beyond the band. `trail`, `owner` and `band`
 * may be null: what was settled, a value handed on from each pixel to those reached through it, and the rows to keep to.
 *
 * Pixels are settled in batches: first all costs, which takes no branch, then the writes. A wrongly predicted branch
 * among the writes is then found out at once, and not after the dozen dependent operations of a cost. */
static inline int32_t rc_march(const rc_steps *s, rc_queue *queue, float *current, uint8_t *flags, rc_trail *trail,
                               int32_t *owner, const rc_band *band, const int wrap, const rc_control *control)
{
    const lanes beta = lanes_all(s->beta);
    int64_t until_poll = RC_POLL;
    int32_t bucket;
    while ((bucket = rc_next(queue, current, flags)) >= 0) {
        int64_t settled = 0;
        int taken;
        int32_t batch[RC_BATCH];
        while ((taken = rc_pop(queue, bucket, batch))) {
            float found[RC_BATCH][12];
            unsigned hits[RC_BATCH];
            int live = 0;
            for (int n = 0; n < taken; n++) {
                const int32_t p = batch[n];
                batch[live] = p;
                live += flags[p] & RC_WAITING;
                flags[p] &= (uint8_t)~RC_WAITING;
            }
            for (int n = 0; n < live; n++) {
                const int32_t p = batch[n];
                const lanes here = lanes_all(current[p]), y = lanes_all(s->y[p]), d = lanes_all(s->d[p]);
                unsigned less = 0;
                for (int row = 0; row < 3; row++) {
                    const int64_t q = (int64_t)p + s->offset[4 * row];
                    const lanes to = rc_reach(s, q, here, y, d, beta, s->cost + 4 * row);
                    lanes_store(found[n] + 4 * row, to);
                    less |= lanes_less(to, lanes_load(current + q)) << (4 * row);
                }
                hits[n] = less & s->allowed;
            }
            for (int n = 0; n < live; n++) {
                for (unsigned h = hits[n]; h; h &= h - 1) {
                    const int i = __builtin_ctz(h);
                    const float to = found[n][i];
                    int32_t q = batch[n] + s->offset[i];
                    q = wrap ? rc_unwrap(s, q) : q;
                    const float before = current[q];
                    if (!(to < before)) {
                        continue; /* another pixel of the batch was quicker */
                    }
                    if (wrap) {
                        rc_set(s, current, q, to);
                    } else {
                        current[q] = to;
                    }
                    if (owner) {
                        owner[q] = owner[batch[n]];
                    }
                    if (band && (uint32_t)(q - band->first) >= (uint32_t)band->size) {
                        if (!(flags[q] & RC_WAITING) && !rc_band_wait(band, q)) {
                            return RC_MEMORY;
                        }
                        flags[q] |= RC_WAITING;
                        continue;
                    }
                    /* A pixel that waits in the right bucket already is not put there twice. */
                    const uint32_t moved = (rc_bits(before) ^ rc_bits(to)) >> RC_SHIFT(queue->depth);
                    rc_push(queue, to, q, !(flags[q] & RC_WAITING) | (moved != 0));
                    flags[q] |= RC_WAITING;
                }
            }
            if (trail) {
                if (trail->room - trail->used < RC_BATCH && !rc_trail_grow(trail)) {
                    return RC_MEMORY;
                }
                for (int n = 0; n < live; n++) {
                    trail->pixel[trail->used] = batch[n];
                    trail->used += !(flags[batch[n]] & RC_SETTLED);
                    flags[batch[n]] |= RC_SETTLED;
                }
            }
            settled += live;
            until_poll -= taken;
            if (until_poll <= 0) {
                until_poll += RC_POLL;
                rc_progress(control, RC_POLL);
                if (rc_cancelled(control)) {
                    return RC_CANCELLED;
                }
            }
            if (settled >= RC_DEAL_SETTLED && rc_level(bucket) < RC_LEVELS - 1) {
                rc_deal(queue, bucket, current, flags);
                break;
            }
        }
        if (queue->failed) {
            return RC_MEMORY;
        }
    }
    return RC_OK;
}

#endif
