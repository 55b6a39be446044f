/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "image/flip.h"

#include "image/flip_tile.h"
#include "image/largest.h"

#include <stdlib.h>
#include <string.h>

typedef struct Flip {
    const Image *pictures[2];
    int width, height;
    FlipModel model;
    FlipTile *tile;
    int band;      /* rows that are computed together */
    float *values; /* [band, width] */
    Largest largest;
    double sum;
} Flip;

static bool flip_create(Flip *flip, const Image *expected, const Image *actual, double pixels_per_degree,
                        Error *error) {
    static const int most = 1 << 22; /* values of a band, unless one row has more */
    *flip = (Flip){.pictures = {expected, actual}, .width = expected->width, .height = expected->height};
    flip_make_model(&flip->model, pixels_per_degree);
    flip->band = most / flip->width < 1 ? 1 : most / flip->width;
    if (flip->band > FLIP_TILE_HEIGHT) flip->band = FLIP_TILE_HEIGHT;
    size_t pixels = (size_t)flip->width * (size_t)flip->height;
    flip->values = malloc((size_t)flip->width * (size_t)flip->band * sizeof *flip->values);
    if (flip->values == NULL) return error_memory(error, "FLIP");
    flip->tile = flip_tile_create(&flip->model, error);
    return flip->tile != NULL && largest_create(&flip->largest, pixels / 100 + 1, error);
}

static void flip_free(Flip *flip) {
    largest_free(&flip->largest);
    flip_tile_destroy(flip->tile);
    free(flip->values);
}

/* Widens `found` to the differences in a row, from `left` to `right`. */
static void find_in_row(const Flip *flip, int y, int left, int right, FlipArea *found) {
    const uint8_t *a = flip->pictures[0]->pixels + (size_t)y * (size_t)flip->width * 4;
    const uint8_t *b = flip->pictures[1]->pixels + (size_t)y * (size_t)flip->width * 4;
    if (memcmp(a + 4 * (size_t)left, b + 4 * (size_t)left, 4 * (size_t)(right - left)) == 0) return;
    while (memcmp(a + 4 * (size_t)left, b + 4 * (size_t)left, 4) == 0) left++;
    while (memcmp(a + 4 * (size_t)(right - 1), b + 4 * (size_t)(right - 1), 4) == 0) right--;
    if (found->bottom == 0) *found = (FlipArea){left, y, right, y + 1};
    if (left < found->left) found->left = left;
    if (right > found->right) found->right = right;
    found->bottom = y + 1;
}

static int at_least(int value, int least) { return value < least ? least : value; }
static int at_most(int value, int most) { return value > most ? most : value; }

/* The part of an area that differences can reach through the filters; empty (bottom 0) if there are none. Beyond it,
   both pictures are filtered from equal pixels. */
static FlipArea find_reached(const Flip *flip, FlipArea area) {
    int reach = flip->model.reach;
    FlipArea found = {0, 0, 0, 0};
    int left = at_least(area.left - reach, 0), right = at_most(area.right + reach, flip->width);
    for (int y = at_least(area.top - reach, 0); y < at_most(area.bottom + reach, flip->height); y++)
        find_in_row(flip, y, left, right, &found);
    if (found.bottom == 0) return found;
    return (FlipArea){at_least(found.left - reach, area.left), at_least(found.top - reach, area.top),
                      at_most(found.right + reach, area.right), at_most(found.bottom + reach, area.bottom)};
}

/* The values of rows top .. bottom - 1. */
static void fill_band(const Flip *flip, int top, int bottom) {
    size_t width = (size_t)flip->width;
    memset(flip->values, 0, width * (size_t)(bottom - top) * sizeof *flip->values);
    for (int left = 0; left < flip->width; left += FLIP_TILE_WIDTH) {
        FlipArea area = find_reached(flip, (FlipArea){left, top, at_most(left + FLIP_TILE_WIDTH, flip->width), bottom});
        if (area.bottom > 0)
            flip_tile_compute(flip->tile, flip->pictures, area, flip->values + (size_t)(area.top - top) * width, width);
    }
}

/* Row by row, so that the sum does not depend on tiles. */
static bool take_row(Flip *flip, const float *values, const FlipSink *sink, Error *error) {
    for (int x = 0; x < flip->width; x++) {
        if (values[x] == 0) continue;
        flip->sum += (double)values[x];
        largest_add(&flip->largest, values[x]);
    }
    return sink == NULL || sink->row(sink->context, values, flip->width, error);
}

bool flip_compare(const Image *expected, const Image *actual, double pixels_per_degree, const FlipSink *sink,
                  FlipSummary *result, Error *error) {
    Flip flip;
    bool ok = flip_create(&flip, expected, actual, pixels_per_degree, error);
    for (int top = 0; ok && top < flip.height; top += flip.band) {
        int bottom = at_most(top + flip.band, flip.height);
        fill_band(&flip, top, bottom);
        for (int y = top; ok && y < bottom; y++)
            ok = take_row(&flip, flip.values + (size_t)(y - top) * (size_t)flip.width, sink, error);
    }
    if (ok) {
        result->mean = flip.sum / ((double)flip.width * (double)flip.height);
        result->p99 = (double)largest_least(&flip.largest);
    }
    flip_free(&flip);
    return ok;
}
