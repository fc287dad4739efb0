/* Random images of odd sizes and strides, half of them with something wrong, through every entry point.
 *
 *     fuzz SEED ROUNDS
 *
 * Right input must give the distances of a plain relaxation, to the bit; wrong input must be refused. Every array is
 * allocated to its exact size, so that an address sanitizer sees a step beyond it. Prints a hash of all results, which
 * must be the same for every compiler, instruction set and optimization. Exits with 1 at the first wrong result.
 */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../src/reflcolor_kernel.h"

static uint64_t state, hash = UINT64_C(14695981039346656037);

static uint32_t below(uint32_t n)
{
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (uint32_t)((state >> 11) % n);
}

static void note(const void *bytes, size_t size)
{
    const unsigned char *b = bytes;
    for (size_t i = 0; i < size; i++) {
        hash = (hash ^ b[i]) * UINT64_C(1099511628211);
    }
}

static void expect(int truth, const char *what)
{
    if (!truth) {
        printf("wrong: %s\n", what);
        exit(1);
    }
}

static void *room(size_t size)
{
    void *p = malloc(size);
    expect(p != NULL, "out of memory");
    return p;
}

/* Relax every edge until nothing changes. */
static void plain_field(const rc_graph *g, int64_t source, float *distance)
{
    const int64_t h = g->height, w = g->width;
    for (int64_t i = 0; i < h * w; i++) {
        distance[i] = INFINITY;
    }
    distance[source] = 0.0f;
    for (int changed = 1; changed;) {
        changed = 0;
        for (int64_t i = 0; i < 9 * h * w; i++) {
            const int64_t r = i / 9 / w, c = i / 9 % w, dr = i % 9 / 3 - 1, dc = i % 3 - 1, rq = r + dr;
            int64_t cq = c + dc;
            if (g->wrap) {
                cq = (cq + w) % w;
            }
            if (rq < 0 || rq >= h || cq < 0 || cq >= w || (g->neighbors == 4 && dr && dc)) {
                continue;
            }
            const int64_t p = (r + 1) * (w + 2) + c + 1, q = (rq + 1) * (w + 2) + cq + 1;
            const float dd = g->d[q] - g->d[p], cost = dr && dc ? g->step_cost * 1.41421356237309504880f : g->step_cost;
            const float e = (g->beta * (dd * dd) + 1.0f) * fabsf(g->y[q] - g->y[p]) + cost;
            const float to = distance[r * w + c] + e;
            if (to < distance[rq * w + cq]) {
                distance[rq * w + cq] = to;
                changed = 1;
            }
        }
    }
}

/* The lists of the k nearest seeds, found in so many parts. */
static float *search_parts(const rc_graph *g, const float *bound, int64_t count, const int64_t *pixels, int32_t k,
                           int32_t parts)
{
    const int64_t size = rc_plane_size(g->height, g->width), middle = below((uint32_t)g->height + 1);
    void *labels[4];
    uint8_t *listed[4];
    int64_t *own = room((size_t)count * sizeof *own);
    int32_t *seeds = room((size_t)count * sizeof *seeds);
    for (int32_t n = 0; n < parts; n++) {
        int64_t have = 0;
        labels[n] = calloc((size_t)(size * 2 * k), sizeof(float));
        listed[n] = calloc((size_t)size, 1);
        expect(labels[n] && listed[n], "out of memory");
        for (int64_t j = 0; j < count; j++) {
            if (pixels[j] % parts == n) {
                seeds[have] = (int32_t)j;
                own[have++] = pixels[j];
            }
        }
        if (have) {
            expect(rc_nearest_part(g, bound, have, own, seeds, k, labels[n], listed[n], NULL) == RC_OK,
                   "rc_nearest_part refuses a right call");
        }
    }
    for (int half = 0; half < 2; half++) {
        const int64_t row0 = half ? middle : 0, row1 = half ? g->height : middle;
        expect(rc_nearest_merge(g, row0, row1, bound, k, parts, labels, (const uint8_t *const *)listed, NULL) == RC_OK,
               "rc_nearest_merge refuses a right call");
    }
    for (int32_t n = 0; n < parts; n++) {
        free(listed[n]);
        free(n ? labels[n] : NULL);
    }
    free(own);
    free(seeds);
    return labels[0];
}

/* The same with bounds by shorter lists or without; the number of parts changes no bit. */
static float *find_nearest(const rc_graph *g, int64_t count, const int64_t *pixels, int32_t k)
{
    const int64_t size = rc_plane_size(g->height, g->width);
    const int32_t few = k > 1 && below(2) ? 1 + (int32_t)below((uint32_t)k - 1) : 0;
    float *shorter = few ? find_nearest(g, count, pixels, few) : NULL, *bound = room((size_t)size * sizeof *bound);
    expect(rc_nearest_bounds(g, count, pixels, k, few, shorter, bound, NULL) == RC_OK, "rc_nearest_bounds refuses");
    float *lists = search_parts(g, bound, count, pixels, k, 1);
    float *same = search_parts(g, bound, count, pixels, k, 2 + (int32_t)below(3));
    for (int64_t p = 0; p < size; p++) {
        expect(isnan(g->y[p]) || !memcmp(lists + p * 2 * k, same + p * 2 * k, (size_t)k * 2 * sizeof *lists),
               "the number of parts changes a list");
    }
    free(bound);
    free(shorter);
    free(same);
    return lists;
}

static void check_nearest(const rc_graph *g, int64_t count, const int64_t *pixels, const float *fields)
{
    const int64_t h = g->height, w = g->width;
    const int32_t k = 1 + (int32_t)below(below(4) ? 12 : 40);
    float *labels = find_nearest(g, count, pixels, k);
    for (int64_t i = 0; i < h * w; i++) {
        const int64_t p = (i / w + 1) * (w + 2) + i % w + 1;
        const float *list = labels + p * 2 * k;
        if (isnan(g->y[p])) {
            continue;
        }
        int32_t seeds[64];
        memcpy(seeds, list + k, (size_t)k * sizeof *seeds);
        for (int32_t n = 0; n < k; n++) {
            int64_t nearer = 0, as_near = 0;
            for (int64_t j = 0; j < count; j++) {
                nearer += fields[j * h * w + i] < list[n];
                as_near += fields[j * h * w + i] <= list[n] && fields[j * h * w + i] < INFINITY;
            }
            expect(n == 0 || list[n - 1] <= list[n], "a list is not in order");
            if (seeds[n] < 0) {
                expect(seeds[n] == -1 && list[n] == INFINITY && as_near <= n, "a place is empty for no reason");
                continue;
            }
            expect(fields[seeds[n] * h * w + i] == list[n], "a listed distance is not the seed's");
            expect(nearer <= n && n < as_near, "a nearer seed is missing");
            for (int32_t m = 0; m < n; m++) {
                expect(seeds[m] != seeds[n], "a seed is listed twice");
            }
            expect(n == 0 || list[n - 1] < list[n] || seeds[n - 1] < seeds[n], "equals are not in the order of seeds");
        }
        note(list, (size_t)k * 2 * sizeof *list);
    }
    const int32_t channels = 1 + (int32_t)below(RC_MAX_CHANNELS);
    const size_t planes = 3 + (size_t)channels;
    float *sums = room((size_t)(h * w) * planes * sizeof *sums);
    float *values = room((size_t)(count * channels) * sizeof *values);
    for (int64_t j = 0; j < channels * count; j++) {
        values[j] = (float)below(256);
    }
    float alpha = (float)below(16);
    alpha /= below(2) ? 1.0f : 3.0f;
    int32_t *index = room((size_t)(h * w) * sizeof *index);
    expect(rc_blend_nearest(g, 0, h, k, labels, count, channels, values, alpha, sums, index, sums + h * w,
                            sums + 3 * h * w, sums + 2 * h * w) == RC_OK, "rc_blend_nearest refuses a right call");
    for (int64_t i = 0; i < h * w; i++) {
        expect(sums[2 * h * w + i] >= 0.0f && sums[2 * h * w + i] < 257.0f, "a bound lies beyond the values");
    }
    note(sums, (size_t)(h * w) * planes * sizeof *sums);
    note(index, (size_t)(h * w) * sizeof *index);
    free(sums);
    free(index);
    free(values);
    free(labels);
}

static void check_blend(int64_t h, int64_t w, int64_t count, const float *fields)
{
    const size_t n = (size_t)(h * w);
    const int32_t channels = 1 + (int32_t)below(RC_MAX_CHANNELS);
    const size_t planes = 2 + (size_t)channels;
    float *sums = room(n * planes * sizeof *sums);
    int32_t *index = room(n * sizeof *index);
    for (size_t i = 0; i < planes * n; i++) {
        sums[i] = i < n ? INFINITY : 0.0f;
        index[i % n] = -1;
    }
    const float alpha = (float)below(40) / 4.0f;
    for (int64_t j = 0; j < count; j++) {
        float values[RC_MAX_CHANNELS];
        for (int32_t c = 0; c < channels; c++) {
            values[c] = (float)below(256);
        }
        expect(rc_blend_add(h, w, fields + j * h * w, w, alpha, (int32_t)j, channels, values, sums, index, sums + n,
                            sums + 2 * n, h * w, NULL) == RC_OK, "rc_blend_add refuses a right call");
    }
    expect(rc_blend_finish(h * w, sums + n, channels, sums + 2 * n, h * w) == RC_OK, "rc_blend_finish refuses");
    for (size_t i = 0; i < n; i++) {
        expect(index[i] < 0 ? isinf(sums[i]) : sums[i] == fields[(size_t)index[i] * n + i], "not the nearest seed");
        expect(sums[2 * n + i] >= 0.0f && sums[2 * n + i] < 256.0f, "a mean lies beyond the values");
    }
    note(sums, n * planes * sizeof *sums);
    note(index, n * sizeof *index);
    free(sums);
    free(index);
}

static void check_kriging(void)
{
    const int64_t pixels = 1 + below(200), count = 1 + below(20);
    const int32_t channels = 1 + (int32_t)below(RC_MAX_CHANNELS);
    const size_t of_pixels = (size_t)pixels * RC_FEATURES, of_seeds = (size_t)count * RC_FEATURES;
    float *features = room(of_pixels * sizeof *features), *seeds = room(of_seeds * sizeof *seeds);
    float *weights = room((size_t)(count * channels) * sizeof *weights);
    float *sums = room((size_t)(pixels * channels) * sizeof *sums);
    const float scale = below(8) ? 1000.0f : below(2) ? 1.0f : 1e-30f;
    for (size_t i = 0; i < of_pixels; i++) {
        features[i] = (float)below(2000) / scale;
    }
    for (size_t i = 0; i < of_seeds; i++) {
        seeds[i] = below(3) ? (float)below(2000) / scale : features[i % of_pixels];
    }
    for (int64_t i = 0; i < count * channels; i++) {
        weights[i] = (float)below(200) - 100.0f;
    }
    expect(rc_kriging(pixels, features, count, seeds, channels, weights, sums, NULL) == RC_OK, "rc_kriging refuses");
    for (int64_t i = 0; i < pixels * channels; i++) {
        double sum = 0.0, all = 0.0;
        for (int64_t j = 0; j < count; j++) {
            double squared = 0.0;
            for (int n = 0; n < RC_FEATURES; n++) {
                const double off = (double)features[i / channels * RC_FEATURES + n] - seeds[j * RC_FEATURES + n];
                squared += off * off;
            }
            const double share = exp(-sqrt(squared)), weight = weights[j * channels + i % channels];
            sum += weight * share;
            all += fabs(weight) * share;
        }
        expect(fabs((double)sums[i] - sum) <= 1e-5 * all + 1e-30, "a sum of kriging differs");
    }
    note(sums, (size_t)(pixels * channels) * sizeof *sums);
    free(features);
    free(seeds);
    free(weights);
    free(sums);
}

/* A number as scanners write it, or with many digits, or an exponent; returns its length. */
static int write_number(char *out, size_t space)
{
    const double whole = (double)below(2) ? (double)below(100) : (double)below(1u << 30) * (double)below(1u << 30);
    const double value = (whole + (double)below(1u << 30) / (double)(1u << 30)) * (below(2) ? 1.0 : -1.0);
    switch (below(6)) {
    case 0:
        return snprintf(out, space, "%d", (int)below(256) - (int)below(2));
    case 1:
        return snprintf(out, space, "%.*e", (int)below(18), value);
    case 2:
        return snprintf(out, space, "%.*f", (int)below(20), value / 1e18);
    case 3:
        return snprintf(out, space, "%s%s", below(2) ? "+." : "-0.", below(2) ? "5" : "0007e-3");
    default:
        return snprintf(out, space, "%.*f", (int)below(12), value);
    }
}

static void check_numbers(void)
{
    const int32_t width = 1 + (int32_t)below(7);
    const int64_t lines = below(12);
    char *text = room((size_t)lines * 800 + 1);
    double *expected = room((size_t)(lines * width + 1) * sizeof *expected);
    int64_t size = 0, rows = 0;
    for (int64_t i = 0; i < lines; i++) {
        const int32_t count = below(4) ? width : 0;
        for (int32_t n = 0; n < count; n++) {
            size += snprintf(text + size, 3, "%s", below(2) ? "\t" : "  ");
            char *const start = text + size;
            size += write_number(start, 100);
            expected[rows * width + n] = strtod(start, NULL);
        }
        rows += count > 0;
        text[size++] = '\n';
    }
    size -= size > 0 && below(2); /* the last line may do without its end */
    char *exact = room((size_t)size + !size);
    memcpy(exact, text, (size_t)size);
    double *values = room((size_t)(lines * width + 1) * sizeof *values);
    rc_numbers_read read;
    int32_t code = rc_numbers(size, exact, lines, width, values, &read);
    expect(code == RC_OK || code == RC_BAD_VALUE, "rc_numbers refuses a right call");
    expect(code == RC_BAD_VALUE || (read.rows == rows && read.bytes == size), "lines are missing");
    expect(!memcmp(values, expected, (size_t)(read.rows * width) * sizeof *values), "a number differs from strtod's");
    note(values, (size_t)(read.rows * width) * sizeof *values);
    for (int64_t i = 0; i < size; i++) {
        exact[i] = below(6) ? exact[i] : (char)below(256);
    }
    code = rc_numbers(size, exact, lines, width, values, &read);
    expect(code == RC_OK || code == RC_BAD_VALUE, "garbage is answered by another code");
    expect(read.lines <= lines && read.rows <= read.lines && read.bytes <= size, "more was read than there is");
    expect(rc_numbers(size, exact, lines, 0, values, &read) == RC_BAD_SIZE, "no numbers a line are taken");
    free(text);
    free(exact);
    free(expected);
    free(values);
}

static void one_round(void)
{
    const int64_t h = 1 + below(below(4) ? 6 : 24), w = 1 + below(below(4) ? 6 : 24), size = rc_plane_size(h, w);
    const int64_t sy = w + below(3), sd = w + below(3), sv = w + below(3), count = 1 + below(9);
    const uint32_t levels = 1 + below(below(2) ? 4 : 1000);
    float *lum = room((size_t)((h - 1) * sy + w) * sizeof *lum), *ran = room((size_t)((h - 1) * sd + w) * sizeof *ran);
    uint8_t *valid = room((size_t)((h - 1) * sv + w));
    float *y = room((size_t)size * sizeof *y), *d = room((size_t)size * sizeof *d);
    float *plane = room((size_t)size * sizeof *plane), *fields = room((size_t)(h * w * count) * sizeof *fields);
    int64_t *pixels = room((size_t)count * sizeof *pixels);
    for (int64_t i = 0; i < h * w; i++) {
        lum[i / w * sy + i % w] = (float)below(levels) * 255.0f / (float)levels;
        ran[i / w * sd + i % w] = (float)below(levels) * 255.0f / (float)levels;
        valid[i / w * sv + i % w] = below(5) > 0;
    }
    for (int64_t j = 0; j < count; j++) {
        pixels[j] = below((uint32_t)(h * w));
        valid[pixels[j] / w * sv + pixels[j] % w] = 1;
    }
    rc_graph g = {h, w, 8, 0, 1e6f, 0.0f, y, d};
    g.neighbors = below(2) ? 4 : 8;
    g.wrap = (int32_t)below(2);
    g.beta = below(3) ? (float)below(3) : 1e6f;
    g.step_cost = below(2) ? 0.0f : 0.5f;
    const float unusable[3] = {NAN, INFINITY, -INFINITY};
    for (int64_t i = 0; i < h * w; i++) {
        if (!valid[i / w * sv + i % w] && below(2)) {
            lum[i / w * sy + i % w] = unusable[below(3)]; /* of no account where nothing returned */
        }
    }
    expect(rc_graph_fill(h, w, g.wrap, lum, sy, ran, sd, valid, sv, y, d, NULL) == RC_OK, "rc_graph_fill refuses");
    float *plain = room((size_t)(h * w) * sizeof *plain);
    for (int64_t j = 0; j < count; j++) {
        expect(rc_field(&g, 1, pixels + j, NULL, plane, NULL) == RC_OK, "rc_field refuses a right call");
        plain_field(&g, pixels[j], plain);
        for (int64_t r = 0; r < h; r++) {
            memcpy(fields + j * h * w + r * w, plane + (r + 1) * (w + 2) + 1, (size_t)w * sizeof *plane);
        }
        expect(!memcmp(fields + j * h * w, plain, (size_t)(h * w) * sizeof *plain), "a distance differs");
        note(plain, (size_t)(h * w) * sizeof *plain);
    }
    check_nearest(&g, count, pixels, fields);
    check_blend(h, w, count, fields);
    check_kriging();
    check_numbers();

    const int64_t beyond = below(9), outside = below(2) ? -1 - beyond : h * w + beyond;
    expect(rc_field(&g, 1, &outside, NULL, plane, NULL) == RC_BAD_SEED, "a seed outside is taken");
    expect(rc_nearest_bounds(&g, count, pixels, below(2) ? 0 : 2000, 0, NULL, plane, NULL) == RC_BAD_VALUE,
           "a wrong k is taken");
    expect(rc_field(&g, 0, pixels, NULL, plane, NULL) == RC_BAD_SIZE, "no seeds are taken");
    g.beta = unusable[below(3)];
    expect(rc_field(&g, 1, pixels, NULL, plane, NULL) == RC_BAD_VALUE, "a wrong beta is taken");
    lum[pixels[0] / w * sy + pixels[0] % w] = unusable[below(3)];
    expect(rc_graph_fill(h, w, g.wrap, lum, sy, ran, sd, valid, sv, y, d, NULL) == RC_BAD_VALUE, "NaN is taken");
    expect(rc_graph_fill(h, w, g.wrap, lum, w - 1, ran, sd, valid, sv, y, d, NULL) == RC_BAD_SIZE, "a stride is taken");
    free(lum);
    free(ran);
    free(valid);
    free(y);
    free(d);
    free(plane);
    free(fields);
    free(pixels);
    free(plain);
}

int main(int argc, char **argv)
{
    state = UINT64_C(88172645463325252) + (argc > 1 ? strtoull(argv[1], NULL, 10) : 0);
    const long rounds = argc > 2 ? strtol(argv[2], NULL, 10) : 1000;
    for (long i = 0; i < rounds; i++) {
        one_round();
    }
    printf("%016" PRIx64 "\n", hash);
    return 0;
}
