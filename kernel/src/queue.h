/* A monotone bucket queue of pixels over the bits of their distances, which sort like the distances themselves.
 *
 * Three levels: half octaves, and twice a thousandth of that. A bucket whose turn comes is emptied as it stands, in no
 * order, while it is small, and dealt out to the next level when it is large or causes much rework. An unordered bucket
 * costs some pixels a second visit and saves the dealing; results do not depend on it, because the least fixed point
 * of d(q) = min_p fl(d(p) + e(p, q)) is unique: rounded addition is monotone.
 */
#ifndef RC_QUEUE_H
#define RC_QUEUE_H

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Pixels taken from a bucket at once. */
#define RC_BATCH 8
#define RC_CHUNK 116
#define RC_CHUNKS_PER_BLOCK 128
/* Buckets: those of the upper bits, then the middle ones, then the last ones. */
#define RC_MIDDLE 4096
#define RC_LAST (RC_MIDDLE + 1024)
#define RC_BUCKETS (RC_LAST + 1024)
#define RC_TOP_SHIFT 19
#define RC_MIDDLE_SHIFT 9
#define RC_LAST_SHIFT 0
/* More chunks than this and a bucket is dealt out when its turn comes. */
#define RC_DEAL_CHUNKS 8
/* Pixels settled from one undealt bucket before it is dealt out after all. */
#define RC_DEAL_SETTLED 8192

/* States of a pixel, bits of `flags`. */
#define RC_WAITING 1 /* in the queue */
#define RC_SETTLED 2 /* on the trail */

typedef struct rc_chunk {
    struct rc_chunk *next;
    int64_t used;
    int32_t pixel[RC_CHUNK + RC_BATCH]; /* the last ones are copied and never used */
} rc_chunk;

typedef struct rc_block {
    struct rc_block *next;
    rc_chunk chunk[RC_CHUNKS_PER_BLOCK];
} rc_block;

typedef struct {
    rc_chunk *head;
    int64_t chunks;
} rc_bucket;

typedef struct {
    rc_bucket bucket[RC_BUCKETS];
    uint64_t occupied[RC_BUCKETS / 64];
    /* The bucket of the first two levels whose turn it is, and whether it has been dealt out to the next level. */
    int32_t at_top, at_middle;
    int dealt_top, dealt_middle;
    int shift; /* distances equal but for this many bits lie in the same bucket */
    rc_chunk *free_chunks;
    rc_block *blocks;
    int failed; /* out of memory: pixels were dropped */
} rc_queue;

static inline uint32_t rc_bits(float f)
{
    uint32_t u;
    memcpy(&u, &f, sizeof u);
    return u;
}

static inline rc_queue *rc_queue_new(void)
{
    rc_queue *q = calloc(1, sizeof *q);
    if (q) {
        q->at_top = q->at_middle = -1;
        q->shift = RC_TOP_SHIFT;
    }
    return q;
}

static inline void rc_queue_free(rc_queue *q)
{
    if (q) {
        for (rc_block *b = q->blocks; b;) {
            rc_block *next = b->next;
            free(b);
            b = next;
        }
        free(q);
    }
}

static inline rc_chunk *rc_chunk_new(rc_queue *q)
{
    if (!q->free_chunks) {
        rc_block *b = malloc(sizeof *b);
        if (!b) {
            q->failed = 1;
            return NULL;
        }
        b->next = q->blocks;
        q->blocks = b;
        for (int i = 0; i < RC_CHUNKS_PER_BLOCK; i++) {
            b->chunk[i].next = q->free_chunks;
            q->free_chunks = &b->chunk[i];
        }
    }
    rc_chunk *c = q->free_chunks;
    q->free_chunks = c->next;
    c->used = 0;
    return c;
}

static inline void rc_chunk_release(rc_queue *q, rc_chunk *c)
{
    c->next = q->free_chunks;
    q->free_chunks = c;
}

static inline void rc_mark_empty(rc_queue *q, int32_t i) { q->occupied[i >> 6] &= ~((uint64_t)1 << (i & 63)); }

/* Put a pixel into its bucket if `wanted` is 1; whether it is cannot be foreseen, so that no branch depends on it. */
static inline void rc_push(rc_queue *q, float distance, int32_t pixel, int wanted)
{
    const uint32_t key = rc_bits(distance);
    const int32_t top = (int32_t)(key >> RC_TOP_SHIFT);
    const int32_t middle = RC_MIDDLE + (int32_t)((key >> RC_MIDDLE_SHIFT) & 1023);
    int32_t i = RC_LAST + (int32_t)((key >> RC_LAST_SHIFT) & 1023);
    /* The flags first: they seldom change, so that the processor foresees the branch. */
    if (!q->dealt_top || top != q->at_top) {
        i = top;
    } else if (!q->dealt_middle || middle != q->at_middle) {
        i = middle;
    }
    rc_bucket *b = &q->bucket[i];
    rc_chunk *c = b->head;
    if (!c || c->used == RC_CHUNK) {
        c = rc_chunk_new(q);
        if (!c) {
            return;
        }
        c->next = b->head;
        b->head = c;
        b->chunks++;
        q->occupied[i >> 6] |= (uint64_t)1 << (i & 63);
    }
    c->pixel[c->used] = pixel;
    c->used += wanted;
}

/* Take up to RC_BATCH pixels out of a bucket; returns how many. */
static inline int rc_pop(rc_queue *q, int32_t i, int32_t *out)
{
    rc_bucket *b = &q->bucket[i];
    rc_chunk *c = b->head;
    if (!c) {
        rc_mark_empty(q, i);
        return 0;
    }
    const int taken = c->used < RC_BATCH ? (int)c->used : RC_BATCH;
    c->used -= taken;
    memcpy(out, c->pixel + c->used, RC_BATCH * sizeof *out);
    if (!c->used) {
        b->head = c->next;
        b->chunks--;
        rc_chunk_release(q, c);
    }
    return taken;
}

/* Deal a bucket of the first two levels out to the level below, without the pixels that were settled meanwhile. */
static inline void rc_deal(rc_queue *q, int32_t i, const float *current, const uint8_t *flags)
{
    rc_bucket *b = &q->bucket[i];
    rc_chunk *c = b->head;
    b->head = NULL;
    b->chunks = 0;
    rc_mark_empty(q, i);
    if (i < RC_MIDDLE) {
        q->dealt_top = 1;
        q->at_middle = -1;
        q->shift = RC_MIDDLE_SHIFT;
    } else {
        q->dealt_middle = 1;
        q->shift = RC_LAST_SHIFT;
    }
    while (c) {
        for (int64_t n = 0; n < c->used; n++) {
            if (flags[c->pixel[n]] & RC_WAITING) {
                rc_push(q, current[c->pixel[n]], c->pixel[n], 1);
            }
        }
        rc_chunk *next = c->next;
        rc_chunk_release(q, c);
        c = next;
    }
}

/* First occupied bucket in [from, to), both multiples of 64, or -1. */
static inline int32_t rc_first(const rc_queue *q, int32_t from, int32_t to)
{
    for (int32_t w = from / 64; w < to / 64; w++) {
        if (q->occupied[w]) {
            return w * 64 + __builtin_ctzll(q->occupied[w]);
        }
    }
    return -1;
}

/* The bucket whose turn it is, or -1 when the queue is empty. */
static inline int32_t rc_next(rc_queue *q, const float *current, const uint8_t *flags)
{
    for (;;) {
        int32_t i;
        if (q->dealt_middle) {
            i = rc_first(q, RC_LAST, RC_BUCKETS);
            if (i >= 0) {
                return i;
            }
            q->dealt_middle = 0;
            q->shift = RC_MIDDLE_SHIFT;
        }
        if (q->dealt_top) {
            i = rc_first(q, RC_MIDDLE, RC_LAST);
            if (i >= 0) {
                q->at_middle = i;
            } else {
                q->dealt_top = 0;
                q->shift = RC_TOP_SHIFT;
                continue;
            }
        } else {
            i = rc_first(q, 0, RC_MIDDLE);
            q->at_top = i;
            if (i < 0) {
                return -1;
            }
        }
        if (q->bucket[i].chunks <= RC_DEAL_CHUNKS) {
            return i;
        }
        rc_deal(q, i, current, flags);
    }
}

#endif
