/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The shift of most of a picture: of a page into which something was inserted, or of the whole. What windows show
   decides which are chosen, so both pictures choose the same ones, wherever they are. Windows that show what no other
   does vote for a shift. */
#include "base/base.h"
#include "base/numbers.h"
#include "pixels/png.h"
#include "regression/compare.h"
#include "regression/content.h"
#include "regression/regression_internal.h"

#include <stdlib.h>
#include <string.h>

enum { WINDOW = 16, ROWS = 4, VOTERS = 1 << 11, VOTES_LEAST = 12, ANCHORS_MAX = 1 << 18 };

static const uint64_t BASE = 0x9E3779B97F4A7C15u;

typedef struct Anchor {
    uint64_t hash; /* of a window that is not of one colour, which looks the same anywhere */
    int x, y;
} Anchor;

typedef struct Anchors {
    Anchor *list;
    size_t count, capacity;
    uint64_t every; /* one of so many windows, a power of two */
} Anchors;

static uint64_t power(uint64_t base, int exponent) {
    uint64_t product = 1;
    for (int i = 0; i < exponent; i++) product *= base;
    return product;
}

/* The windows whose first row is y and in which the pictures differ, by a hash that rolls along them. False if out of
   memory. */
static bool add_row(Anchors *anchors, const Image *image, const Image *other, int y) {
    const size_t width = (size_t)image->width, first = (size_t)y * width;
    const uint32_t *pixels = (const uint32_t *)image->pixels + first, *others = (const uint32_t *)other->pixels + first;
    const uint64_t leaves = power(BASE, WINDOW);
    uint64_t columns[WINDOW] = {0}, hash = 0;
    if (memcmp(pixels, others, 4 * width * ROWS) == 0) return true;
    for (int x = 0, alike = 0, since = WINDOW; x < image->width; x++) {
        uint64_t column = 0;
        bool differs = false;
        for (size_t i = (size_t)x; i < ROWS * width; i += width)
            column = (column ^ pixels[i]) * 0x100000001b3u, differs |= pixels[i] != others[i];
        alike = column == columns[(x + WINDOW - 1) % WINDOW] ? alike + 1 : 1;
        since = differs ? 0 : since + 1;
        hash = hash * BASE + column - leaves * columns[x % WINDOW];
        columns[x % WINDOW] = column;
        const uint64_t mixed = (hash ^ hash >> 31) * BASE;
        if (x + 1 < WINDOW || alike >= WINDOW || since >= WINDOW || (mixed >> 40 & (anchors->every - 1)) != 0) continue;
        if (anchors->count == ANCHORS_MAX) return true; /* a pattern that repeats the same windows */
        if (!array_reserve((void **)&anchors->list, &anchors->capacity, anchors->count + 1, sizeof *anchors->list))
            return false;
        anchors->list[anchors->count++] = (Anchor){mixed, x, y};
    }
    return true;
}

static bool find_anchors(Anchors *anchors, const Image *image, const Image *other) {
    bool ok = true;
    for (int y = 0; ok && y + ROWS <= image->height; y++) ok = add_row(anchors, image, other, y);
    return ok;
}

static int by_hash(const void *a, const void *b) {
    const Anchor *p = a, *q = b;
    if (p->hash != q->hash) return p->hash < q->hash ? -1 : 1;
    return p->y != q->y ? p->y - q->y : p->x - q->x;
}

/* The only window with this hash, or NULL. */
static const Anchor *find_single(const Anchors *anchors, uint64_t hash) {
    size_t low = 0, high = anchors->count;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (anchors->list[middle].hash < hash)
            low = middle + 1;
        else
            high = middle;
    }
    const Anchor *found = anchors->list + low;
    if (low == anchors->count || found->hash != hash) return NULL;
    return low + 1 < anchors->count && found[1].hash == hash ? NULL : found;
}

/* Replaces the windows of the actual picture by their shifts, and finds the one of at least half of them. */
static void count_votes(const Anchors *expected, Anchors *actual, Motion *shift) {
    size_t votes = 0, most = 0, run = 0;
    Anchor *list = actual->list;
    for (size_t i = 0; i < actual->count; i++) {
        const Anchor *from = find_single(expected, list[i].hash);
        if (from != NULL) list[votes++] = (Anchor){0, list[i].x - from->x, list[i].y - from->y};
    }
    if (votes > 0) qsort(list, votes, sizeof *list, by_hash);
    for (size_t i = 0; i < votes; i++) {
        run = i > 0 && list[i].x == list[i - 1].x && list[i].y == list[i - 1].y ? run + 1 : 1;
        if (run <= most) continue;
        most = run;
        *shift = (Motion){list[i].x, list[i].y, 0};
    }
    if (most < VOTES_LEAST || 2 * most < votes) *shift = (Motion){0, 0, 0};
}

bool content_shift(const Image *expected, const Image *actual, int64_t pixels, Motion *shift, Error *error) {
    Anchors from = {.every = 1}, to = {.every = 1};
    *shift = (Motion){0, 0, 0};
    while ((int64_t)from.every * VOTERS < pixels) from.every = to.every = 2 * from.every;
    const bool ok = (find_anchors(&from, expected, actual) && find_anchors(&to, actual, expected)) ||
                    error_memory(error, "regions");
    if (ok && from.count > 0) qsort(from.list, from.count, sizeof *from.list, by_hash);
    if (ok) count_votes(&from, &to, shift);
    free(from.list);
    free(to.list);
    return ok;
}

static bool is_masked(const uint8_t *masked, size_t pixel) { return masked != NULL && masked[pixel] != IGNORED_NOT; }

bool content_is_shifted(const Image *expected, const Image *actual, const uint8_t *masked, const Motion *shift) {
    const int right = (int)shift->right, down = (int)shift->down, width = expected->width, height = expected->height;
    if (right == 0 && down == 0) return false;
    for (int y = int_max(down, 0); y < int_min(height + down, height); y++)
        for (int x = int_max(right, 0); x < int_min(width + right, width); x++) {
            const size_t to = (size_t)y * (size_t)width + (size_t)x,
                         from = (size_t)(y - down) * (size_t)width + (size_t)(x - right);
            if (is_masked(masked, from) || is_masked(masked, to)) continue;
            for (size_t c = 0; c < 4; c++)
                if (image_channel_difference(expected, 4 * from + c, actual, 4 * to + c) > 0) return false;
        }
    return true;
}
