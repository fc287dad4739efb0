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
#define RC_BATCH 32
/* Bytes of a chunk, at a multiple of which it begins: whether one is full is seen from where the next pixel goes. */
#define RC_CHUNK_BYTES 512
#define RC_CHUNK ((RC_CHUNK_BYTES - sizeof(void *)) / sizeof(int32_t))
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
    int32_t pixel[RC_CHUNK];
} rc_chunk;

typedef struct rc_block {
    struct rc_block *next;
    /* What is copied behind the last chunk is never used. */
    char room[(RC_CHUNKS_PER_BLOCK + 1) * RC_CHUNK_BYTES + RC_BATCH * sizeof(int32_t)];
} rc_block;

typedef struct {
    int32_t *end[RC_BUCKETS];   /* where the next pixel goes, in the last chunk; null without one */
    int32_t chunks[RC_BUCKETS];
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

static inline int rc_is_full(const int32_t *end) { return !((uintptr_t)end % RC_CHUNK_BYTES); }

/* The chunk that `end` is in, or is the end of. */
static inline rc_chunk *rc_chunk_of(int32_t *end)
{
    return (rc_chunk *)((char *)end - 1 - ((uintptr_t)end - 1) % RC_CHUNK_BYTES);
}

/* Add an empty chunk to a bucket whose last one is full, or that has none; returns 0 if memory is out. */
static inline int rc_chunk_add(rc_queue *q, int32_t i)
{
    if (!q->free_chunks) {
        rc_block *b = malloc(sizeof *b);
        if (!b) {
            q->failed = 1;
            return 0;
        }
        b->next = q->blocks;
        q->blocks = b;
        char *at = b->room + (RC_CHUNK_BYTES - (uintptr_t)b->room % RC_CHUNK_BYTES) % RC_CHUNK_BYTES;
        for (int n = 0; n < RC_CHUNKS_PER_BLOCK; n++, at += RC_CHUNK_BYTES) {
            ((rc_chunk *)at)->next = q->free_chunks;
            q->free_chunks = (rc_chunk *)at;
        }
    }
    rc_chunk *c = q->free_chunks;
    q->free_chunks = c->next;
    c->next = q->end[i] ? rc_chunk_of(q->end[i]) : NULL;
    q->end[i] = c->pixel;
    q->chunks[i]++;
    q->occupied[i >> 6] |= (uint64_t)1 << (i & 63);
    return 1;
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
    if (rc_is_full(q->end[i]) && !rc_chunk_add(q, i)) {
        return;
    }
    *q->end[i] = pixel;
    q->end[i] += wanted;
}

/* Take up to RC_BATCH pixels out of a bucket; returns how many. */
static inline int rc_pop(rc_queue *q, int32_t i, int32_t *out)
{
    if (!q->end[i]) {
        rc_mark_empty(q, i);
        return 0;
    }
    rc_chunk *c = rc_chunk_of(q->end[i]);
    const int64_t used = q->end[i] - c->pixel;
    const int taken = used < RC_BATCH ? (int)used : RC_BATCH;
    q->end[i] -= taken;
    memcpy(out, q->end[i], RC_BATCH * sizeof *out);
    if (taken == used) {
        q->end[i] = c->next ? (int32_t *)((char *)c->next + RC_CHUNK_BYTES) : NULL;
        q->chunks[i]--;
        rc_chunk_release(q, c);
    }
    return taken;
}

static inline int rc_level(int32_t bucket) { return bucket < RC_COARSE ? 0 : 1 + (bucket - RC_COARSE) / 64; }

/* Deal a bucket out to the level below, without the pixels that were settled meanwhile. */
static inline void rc_deal(rc_queue *q, int32_t i, const float *current, const uint8_t *flags)
{
    const int level = rc_level(i);
    int32_t *end = q->end[i];
    q->end[i] = NULL;
    q->chunks[i] = 0;
    rc_mark_empty(q, i);
    q->dealt[level] = level ? q->dealt[level - 1] << 5 | (uint32_t)(i - RC_BASE(level)) : (uint32_t)i;
    q->depth = level + 1;
    while (end) {
        rc_chunk *const c = rc_chunk_of(end);
        for (const int32_t *p = c->pixel; p < end; p++) {
            if (flags[*p] & RC_WAITING) {
                rc_push(q, current[*p], *p, 1);
            }
        }
        end = c->next ? (int32_t *)((char *)c->next + RC_CHUNK_BYTES) : NULL;
        rc_chunk_release(q, c);
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
        if (q->chunks[i] <= RC_DEAL_CHUNKS || rc_level(i) == RC_LEVELS - 1) {
            return i;
        }
        rc_deal(q, i, current, flags);
    }
}

#endif
