/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Content that moved by whole pixels, as regression_internal.h defines it for shift_mark(). */
#include "base/numbers.h"
#include "pixels/png.h"
#include "regression/compare.h"
#include "regression/regression_internal.h"

#include <stdlib.h>
#include <string.h>

enum { SIDES_OF_BOX = 4, IGNORED_TRIED = 255 };

static const size_t NO_PIXEL = SIZE_MAX;

/* The box around content; it may reach beyond the picture. */
typedef struct Island {
    const Image *pictures[2]; /* expected, actual */
    int reach, tolerance;
    int left, top, right, bottom;
    size_t ground; /* a pixel of the expected picture */
    int64_t work;  /* pixels that may still be looked at, in all islands */
} Island;

static bool look_equal(const Image *a, size_t i, const Image *b, size_t j, int tolerance) {
    const bool deep = a->pixels16 != NULL || b->pixels16 != NULL;
    if (!deep && memcmp(a->pixels + 4 * i, b->pixels + 4 * j, 4) == 0) return true;
    for (size_t c = 0; c < 4; c++)
        if (image_channel_difference(a, 4 * i + c, b, 4 * j + c) > tolerance) return false;
    return true;
}

static bool is_inside(const Image *image, int x, int y) {
    return x >= 0 && y >= 0 && x < image->width && y < image->height;
}

/* Whether both pictures have one colour in this rectangle, as far as it is in them. *ground: a pixel of it; or
   NO_PIXEL. */
static bool is_plain(Island *island, int left, int top, int right, int bottom, size_t *ground) {
    const Image *expected = island->pictures[0], *actual = island->pictures[1];
    *ground = NO_PIXEL;
    for (int y = int_max(top, 0); y < int_min(bottom, expected->height); y++)
        for (int x = int_max(left, 0); x < int_min(right, expected->width); x++) {
            const size_t i = (size_t)y * (size_t)expected->width + (size_t)x;
            if (*ground == NO_PIXEL) *ground = i;
            island->work--;
            if (!look_equal(expected, *ground, expected, i, island->tolerance) ||
                !look_equal(expected, *ground, actual, i, island->tolerance))
                return false;
        }
    return true;
}

/* One step: moves the sides beyond which there is content. *done: the band all around has one colour. */
static void shift_grow(Island *island, bool *done) {
    const int n = island->reach;
    const int l = island->left, t = island->top, r = island->right, b = island->bottom;
    const int bands[SIDES_OF_BOX][4] = {
        {l - n, t - n, l, b + n}, {l - n, t - n, r + n, t}, {r, t - n, r + n, b + n}, {l - n, b, r + n, b + n}};
    int *const sides[SIDES_OF_BOX] = {&island->left, &island->top, &island->right, &island->bottom};
    bool plain[SIDES_OF_BOX], all_plain = true, same = true;
    island->ground = NO_PIXEL;
    for (int i = 0; i < SIDES_OF_BOX; i++) {
        size_t ground;
        plain[i] = is_plain(island, bands[i][0], bands[i][1], bands[i][2], bands[i][3], &ground);
        if (island->ground == NO_PIXEL) island->ground = ground;
        all_plain = all_plain && plain[i];
        same = same && (ground == NO_PIXEL || look_equal(island->pictures[0], island->ground, island->pictures[0],
                                                         ground, island->tolerance));
    }
    *done = all_plain && same;
    for (int i = 0; i < SIDES_OF_BOX && !*done; i++)
        if (all_plain || !plain[i]) *sides[i] += i < 2 ? -1 : 1;
}

/* False: there is no plain ground around the content. */
static bool find_island(Island *island, int x, int y) {
    const Image *image = island->pictures[0];
    const int n = island->reach;
    island->left = x - n, island->top = y - n, island->right = x + n + 1, island->bottom = y + n + 1;
    for (bool done = false; !done;) {
        if (island->work < 0 || (island->left < -n && island->top < -n && island->right > image->width + n &&
                                 island->bottom > image->height + n))
            return false;
        shift_grow(island, &done);
    }
    return island->ground != NO_PIXEL;
}

/* A pixel of a picture, or the ground where it is outside the box or the picture. */
static const Image *pixel_at(const Island *island, int side, int x, int y, size_t *at) {
    const Image *image = island->pictures[side];
    *at = (size_t)y * (size_t)image->width + (size_t)x;
    if (x >= island->left && x < island->right && y >= island->top && y < island->bottom && is_inside(image, x, y))
        return image;
    *at = island->ground;
    return island->pictures[0];
}

static bool moved_by(Island *island, int dx, int dy) {
    const int n = island->reach;
    for (int y = island->top - n; y < island->bottom + n; y++)
        for (int x = island->left - n; x < island->right + n; x++) {
            size_t i, j;
            const Image *from = pixel_at(island, 0, x - dx, y - dy, &i), *to = pixel_at(island, 1, x, y, &j);
            island->work--;
            if (!look_equal(from, i, to, j, island->tolerance)) return false;
        }
    return true;
}

static bool has_moved(Island *island) {
    const int n = island->reach;
    for (int dy = -n; dy <= n && island->work >= 0; dy++)
        for (int dx = -n; dx <= n; dx++)
            if ((dx != 0 || dy != 0) && moved_by(island, dx, dy)) return true;
    return false;
}

/* Pixels of the box that differ become `what`. */
static void mark_shift(Island *island, Ignored what, uint8_t *masked) {
    const Image *a = island->pictures[0], *b = island->pictures[1];
    for (int y = int_max(island->top, 0); y < int_min(island->bottom, a->height); y++)
        for (int x = int_max(island->left, 0); x < int_min(island->right, a->width); x++) {
            const size_t i = (size_t)y * (size_t)a->width + (size_t)x;
            island->work--;
            const bool open = masked[i] == IGNORED_NOT || masked[i] == IGNORED_TRIED;
            if (open && image_pixel_difference(a, b, i) > 0) masked[i] = (uint8_t)what;
        }
}

void shift_mark(const Image *expected, const Image *actual, int reach, int tolerance, uint8_t *masked) {
    const int64_t LOOKS = 8; /* at each pixel of a band, on average: hostile pictures must end, too */
    const size_t width = (size_t)expected->width, count = width * (size_t)expected->height;
    Island island = {.pictures = {expected, actual}, .reach = reach, .tolerance = tolerance};
    island.work = LOOKS * (reach + 1) * (int64_t)count;
    for (size_t i = 0; i < count; i++) {
        if (i % width == 0 && !image_row_differs(expected, actual, (int)(i / width))) {
            i += width - 1;
            continue;
        }
        if (masked[i] != IGNORED_NOT || image_pixel_difference(expected, actual, i) <= tolerance) continue;
        const bool found = find_island(&island, (int)(i % width), (int)(i / width)) && has_moved(&island);
        mark_shift(&island, found ? IGNORED_RULE : (Ignored)IGNORED_TRIED, masked);
    }
    for (size_t i = 0; i < count; i++)
        if (masked[i] == IGNORED_TRIED) masked[i] = IGNORED_NOT;
}

void level_mark(const Image *expected, const Image *actual, int tolerance, uint8_t *masked) {
    const size_t count = (size_t)expected->width * (size_t)expected->height;
    for (size_t i = 0; i < count; i++) {
        if (masked[i] != IGNORED_NOT) continue;
        const int difference = image_pixel_difference(expected, actual, i);
        if (difference > 0 && difference <= tolerance) masked[i] = IGNORED_RULE;
    }
}
