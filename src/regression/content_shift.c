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

static const uint64_t BASE = 0x9E3779B97F4A7C15u, PRIME = 0x100000001b3u;

static bool add_anchor(Anchors *anchors, const Anchor *anchor) {
    if (anchors->count == ANCHORS_MAX) return true; /* a pattern that repeats the same windows */
    if (!array_reserve((void **)&anchors->list, &anchors->capacity, anchors->count + 1, sizeof *anchors->list))
        return false;
    anchors->list[anchors->count++] = *anchor;
    return true;
}

static uint64_t power(uint64_t base, int exponent) {
    uint64_t product = 1;
    for (int i = 0; i < exponent; i++) product *= base;
    return product;
}

/* The windows in the middle columns whose first row is y and in which the pictures differ, by a hash that rolls along
   them. False if out of memory. */
static bool add_row(Anchors *anchors, const Image *image, const Image *other, int columns, int y) {
    const int left = (image->width - columns) / 2;
    const size_t width = (size_t)image->width, first = (size_t)y * width;
    const uint32_t *pixels = (const uint32_t *)image->pixels + first, *others = (const uint32_t *)other->pixels + first;
    const uint64_t leaves = power(BASE, WINDOW);
    uint64_t window[WINDOW] = {0}, hash = 0;
    if (memcmp(pixels, others, 4 * width * ROWS) == 0) return true;
    for (int x = left, alike = 0, since = WINDOW; x < left + columns; x++) {
        uint64_t column = 0;
        bool differs = false;
        for (size_t i = (size_t)x; i < ROWS * width; i += width)
            column = (column ^ pixels[i]) * PRIME, differs |= pixels[i] != others[i];
        alike = column == window[(x + WINDOW - 1) % WINDOW] ? alike + 1 : 1;
        since = differs ? 0 : since + 1;
        hash = hash * BASE + column - leaves * window[x % WINDOW];
        window[x % WINDOW] = column;
        const uint64_t mixed = (hash ^ hash >> 31) * BASE;
        if (x + 1 < left + WINDOW || alike >= WINDOW || since >= WINDOW || (mixed >> 40 & (anchors->every - 1)) != 0)
            continue;
        if (!add_anchor(anchors, &(Anchor){mixed, x, y})) return false;
    }
    return true;
}

static bool find_anchors(Anchors *anchors, const Image *image, const Image *other, int columns) {
    bool ok = true;
    for (int y = 0; ok && y + ROWS <= image->height; y++) ok = add_row(anchors, image, other, columns, y);
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

void shift_count(Anchors *expected, Anchors *actual, Motion *shift) {
    if (expected->count > 0) qsort(expected->list, expected->count, sizeof *expected->list, by_hash);
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

bool content_shift(const Image *expected, const Image *actual, int columns, int64_t pixels, Motion *shift,
                   Error *error) {
    Anchors from = {.every = 1}, to = {.every = 1};
    *shift = (Motion){0, 0, 0};
    while ((int64_t)from.every * VOTERS < pixels) from.every = to.every = 2 * from.every;
    const bool ok = (find_anchors(&from, expected, actual, columns) && find_anchors(&to, actual, expected, columns)) ||
                    error_memory(error, "regions");
    if (ok) shift_count(&from, &to, shift);
    free(from.list);
    free(to.list);
    return ok;
}

bool shift_rows_add(Anchors rows[2], int y, const uint8_t *a, const uint8_t *b, int width, Error *error) {
    enum { SAMPLES = 32 }; /* of the middle half: columns at the sides may stay */
    const size_t first = (size_t)width / 4;
    if (memcmp(a, b, 4 * (size_t)width) == 0) return true;
    for (int i = 0; i < 2; i++) {
        const uint32_t *pixels = (const uint32_t *)(i == 0 ? a : b) + first;
        Anchor anchor = {1, 0, y};
        bool even = true;
        for (size_t k = 0; k < SAMPLES; k++) {
            const uint32_t pixel = pixels[k * (size_t)width / (2 * SAMPLES)];
            anchor.hash = (anchor.hash ^ pixel) * PRIME;
            even &= pixel == pixels[0];
        }
        if (!even && !add_anchor(&rows[i], &anchor)) return error_memory(error, "regions");
    }
    return true;
}

static bool is_masked(const uint8_t *masked, size_t pixel) { return masked != NULL && masked[pixel] != IGNORED_NOT; }

static bool is_equal(const Image *a, size_t i, const Image *b, size_t j) {
    for (size_t c = 0; c < 4; c++)
        if (image_channel_difference(a, 4 * i + c, b, 4 * j + c) > 0) return false;
    return true;
}

/* Whether the pixel at (x, y) of one picture is that of the other from which it came, or to which it went. Nothing
   tells of what is masked or outside. */
static bool is_at(const Image *a, int x, int y, const Image *b, int right, int down, const uint8_t *masked) {
    const int u = x + right, v = y + down;
    const size_t here = (size_t)y * (size_t)a->width + (size_t)x, there = (size_t)v * (size_t)a->width + (size_t)u;
    return u < 0 || u >= a->width || v < 0 || v >= a->height || is_masked(masked, there) || is_equal(a, here, b, there);
}

ImageRegion content_mark_shifted(const Image *expected, const Image *actual, const uint8_t *masked, const Motion *shift,
                                 uint8_t *left, int64_t *missed) {
    const int width = expected->width, height = expected->height, right = (int)shift->right, down = (int)shift->down;
    const bool narrow[2] = {abs(right) <= SHIFT_STRIP, abs(down) <= SHIFT_STRIP};
    ImageRegion region = {0, width, height, 0, 0};
    *missed = 0;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const size_t pixel = (size_t)y * (size_t)width + (size_t)x;
            const bool beside = x < right || x >= width + right, beyond = y < down || y >= height + down;
            if (left[pixel] != IGNORED_NOT || is_equal(expected, pixel, actual, pixel)) continue;
            if ((beside && !narrow[0]) || (beyond && !narrow[1])) continue;
            if (!is_at(actual, x, y, expected, -right, -down, masked) ||
                !is_at(expected, x, y, actual, right, down, masked)) {
                ++*missed;
                continue;
            }
            left[pixel] = IGNORED_RULE;
            region.pixels++;
            region.left = int_min(region.left, x), region.right = int_max(region.right, x + 1);
            region.top = int_min(region.top, y), region.bottom = y + 1;
        }
    return region;
}
