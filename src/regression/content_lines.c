/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The shift of whole rows or columns: of a page into which something was inserted, or of a whole picture. */
#include "base/base.h"
#include "base/hash.h"
#include "pixels/png.h"
#include "regression/content.h"

#include <stdlib.h>
#include <string.h>

typedef struct Line {
    uint64_t hash; /* 0: of one colour, which looks the same anywhere */
    int number;
} Line;

static void hash_rows(const Image *image, Line *lines) {
    const size_t row = 4 * (size_t)image->width;
    for (int y = 0; y < image->height; y++) {
        const uint8_t *pixels = image->pixels + (size_t)y * row;
        const bool even = memcmp(pixels, pixels + 4, row - 4) == 0;
        lines[y] = (Line){even ? 0 : hash_xxh3(pixels, row) | 1, y};
    }
}

/* All columns at once, from row to row (FNV-1a, of pixels). */
static void hash_columns(const Image *image, Line *lines) {
    const uint32_t *pixels = (const uint32_t *)image->pixels;
    const int width = image->width;
    for (int x = 0; x < width; x++) lines[x] = (Line){0, x};
    for (int y = 0; y < image->height; y++, pixels += width)
        for (int x = 0; x < width; x++) lines[x].hash = (lines[x].hash ^ pixels[x]) * 0x100000001b3u;
    pixels = (const uint32_t *)image->pixels;
    for (int x = 0; x < width; x++) {
        bool even = true;
        for (int y = 1; y < image->height && even; y++)
            even = pixels[(size_t)y * (size_t)width + (size_t)x] == pixels[x];
        lines[x].hash = even ? 0 : lines[x].hash | 1;
    }
}

static int by_hash(const void *a, const void *b) {
    const Line *x = a, *y = b;
    if (x->hash != y->hash) return x->hash < y->hash ? -1 : 1;
    return (x->number > y->number) - (x->number < y->number);
}

/* Votes of the lines that differ and are alone in having their colours, for the distance that they moved; 0: they do not agree. */
static int agreed_shift(Line *expected, const Line *actual, int count, int *votes) {
    enum { FEWEST = 12 };
    int best = 0, differing = 0;
    memset(votes, 0, (2 * (size_t)count + 1) * sizeof *votes);
    for (int i = 0; i < count; i++) differing += actual[i].hash != 0 && actual[i].hash != expected[i].hash;
    const Line *moved = expected + count; /* the expected lines as they are numbered */
    memcpy(expected + count, expected, (size_t)count * sizeof *expected);
    qsort(expected, (size_t)count, sizeof *expected, by_hash);
    for (int i = 0; i < count; i++) {
        if (actual[i].hash == 0 || actual[i].hash == moved[i].hash) continue;
        int low = 0, high = count;
        while (low < high) {
            const int middle = (low + high) / 2;
            if (expected[middle].hash < actual[i].hash)
                low = middle + 1;
            else
                high = middle;
        }
        if (low == count || expected[low].hash != actual[i].hash) continue;
        if (low + 1 < count && expected[low + 1].hash == actual[i].hash) continue;
        votes[i - expected[low].number + count]++;
    }
    for (int k = 0; k <= 2 * count; k++)
        if (votes[k] > votes[best]) best = k;
    return votes[best] >= FEWEST && 2 * votes[best] >= differing ? best - count : 0;
}

bool content_lines_shift(const Image *expected, const Image *actual, Motion *shift, Error *error) {
    const size_t most = (size_t)(expected->width > expected->height ? expected->width : expected->height);
    Line *lines = calloc(3 * most, sizeof *lines);
    int *votes = malloc((2 * most + 1) * sizeof *votes);
    const bool ok = (lines != NULL && votes != NULL) || error_memory(error, "regions");
    *shift = (Motion){0, 0, 0};
    if (ok) {
        hash_rows(expected, lines);
        hash_rows(actual, lines + 2 * most);
        shift->down = agreed_shift(lines, lines + 2 * most, expected->height, votes);
    }
    if (ok && shift->down == 0) {
        hash_columns(expected, lines);
        hash_columns(actual, lines + 2 * most);
        shift->right = agreed_shift(lines, lines + 2 * most, expected->width, votes);
    }
    free(lines);
    free(votes);
    return ok;
}
