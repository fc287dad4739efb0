/* A monotone bucket queue of pixels over the bits of their distances, which sort like the distances themselves.
 *
 * Buckets are a sixty-fourth of an octave wide. One whose turn comes is emptied as it stands, in no order, while it is
 * small; one that is large, or causes much rework, is dealt out to 32 finer ones first, up to twice more. Unordered
 * buckets cost some pixels a second visit and save the dealing; results do not depend on it, because the least fixed
 * point of d(q) = min_p fl(d(p) + e(p, q)) is unique: rounded addition is monotone.
 */
#ifndef RC_QUEUE_H
#define RC_QUEUE_H

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Pixels taken from a bucket at once. */
#define RC_BATCH 16
#define RC_CHUNK 116
#define RC_CHUNKS_PER_BLOCK 128
/* Bits of a distance below those that choose its bucket, per level; a level starts at a multiple of 64 buckets. */
#define RC_LEVELS 4
#define RC_SHIFT(level) (17 - 5 * (level))
#define RC_COARSE 16384
#define RC_BASE(level) ((level) ? RC_COARSE + 64 * ((level) - 1) : 0)
#define RC_BUCKETS RC_BASE(RC_LEVELS)
/* More chunks than this and a bucket is dealt out when its turn comes. */
#define RC_DEAL_CHUNKS 8
/* Pixels settled from one undealt bucket before it is dealt out after all. */
#define RC_DEAL_SETTLED 4096

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
    int depth;                  /* levels below the first that hold buckets dealt out */
    uint32_t dealt[RC_LEVELS];  /* per level, the upper bits of the distances that were dealt out */
    int first_word;             /* no word of `occupied` before it has a bit of the first level */
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

static inline rc_queue *rc_queue_new(void) { return calloc(1, sizeof(rc_queue)); }

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
    int level = 0;
    while (level < q->depth && key >> RC_SHIFT(level) == q->dealt[level]) {
        level++;
    }
    const int32_t i = level ? RC_BASE(level) + (int32_t)(key >> RC_SHIFT(level) & 31)
                            : (int32_t)(key >> RC_SHIFT(0));
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

static inline int rc_level(int32_t bucket) { return bucket < RC_COARSE ? 0 : 1 + (bucket - RC_COARSE) / 64; }

/* Deal a bucket out to the level below, without the pixels that were settled meanwhile. */
static inline void rc_deal(rc_queue *q, int32_t i, const float *current, const uint8_t *flags)
{
    rc_bucket *b = &q->bucket[i];
    const int level = rc_level(i);
    rc_chunk *c = b->head;
    b->head = NULL;
    b->chunks = 0;
    rc_mark_empty(q, i);
    q->dealt[level] = level ? q->dealt[level - 1] << 5 | (uint32_t)(i - RC_BASE(level)) : (uint32_t)i;
    q->depth = level + 1;
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

/* First bucket of the first level, or -1. */
static inline int32_t rc_first(rc_queue *q)
{
    for (; q->first_word < RC_COARSE / 64; q->first_word++) {
        if (q->occupied[q->first_word]) {
            return q->first_word * 64 + __builtin_ctzll(q->occupied[q->first_word]);
        }
    }
    q->first_word = 0;
    return -1;
}

/* The bucket whose turn it is, or -1 when the queue is empty. */
static inline int32_t rc_next(rc_queue *q, const float *current, const uint8_t *flags)
{
    for (;;) {
        int32_t i;
        if (q->depth) {
            const int32_t base = RC_BASE(q->depth);
            if (!q->occupied[base / 64]) {
                q->depth--;
                continue;
            }
            i = base + __builtin_ctzll(q->occupied[base / 64]);
        } else {
            i = rc_first(q);
            if (i < 0) {
                return -1;
            }
        }
        if (q->bucket[i].chunks <= RC_DEAL_CHUNKS || rc_level(i) == RC_LEVELS - 1) {
            return i;
        }
        rc_deal(q, i, current, flags);
    }
}

#endif
