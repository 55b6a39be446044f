/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "image/png_fast.h"

#include "image/png_filter.h"
#include "image/png_rows.h"

#include <stdlib.h>
#include <string.h>

typedef struct Side {
    PngRows rows;
    const uint8_t *filtered; /* the last row, [1 + bytes] */
    const uint8_t *row;      /* the same unfiltered; zeros before the first */
    uint8_t *unfiltered[2];  /* [bytes], in turns */
    uint8_t *memory;
    Image *image;
} Side;

static bool side_open(Side *side, const uint8_t *data, size_t size, int64_t max_pixels) {
    *side = (Side){.image = NULL};
    if (!png_rows_open(&side->rows, data, size, max_pixels)) return false;
    size_t bytes = side->rows.bytes + 1;
    side->memory = calloc(2, bytes);
    if (side->memory == NULL) return false;
    side->unfiltered[0] = side->memory;
    side->row = side->unfiltered[1] = side->memory + bytes;
    return true;
}

static void side_close(Side *side) {
    png_rows_close(&side->rows);
    free(side->memory);
}

/* Filtered rows are at the end of the picture's own memory: a row of RGBA, which has at least as many bytes as a filtered
   row but for the filter's number, never reaches the next filtered row. */
static bool start(Side *side) {
    Error ignored = {0};
    const PngLayout *layout = &side->rows.layout;
    size_t size = (size_t)layout->width * layout->height * 4 + layout->height;
    side->image = image_create_unset((int)layout->width, (int)layout->height, layout->height, &ignored);
    return side->image != NULL && png_rows_start(&side->rows, side->image->pixels + size - png_rows_size(&side->rows));
}

static bool next(Side *side) { return (side->filtered = png_rows_next(&side->rows)) != NULL; }

static bool unfilter(Side *side, int y) {
    uint8_t *row = side->unfiltered[y % 2];
    bool ok = png_unfilter(side->filtered, side->row, side->rows.bytes, side->rows.step, row);
    side->row = row;
    return ok;
}

static uint8_t *pixels_of(const Image *image, int y) { return image->pixels + (size_t)y * (size_t)image->width * 4; }

static bool expand(const Side *side, int y) {
    return png_expand(&side->rows.layout, side->row, pixels_of(side->image, y));
}

static bool decode(Side *side) {
    if (!start(side)) return false;
    image_provide(side->image);
    for (int y = 0; y < side->image->height; y++)
        if (!next(side) || !unfilter(side, y) || !expand(side, y)) return false;
    return png_rows_end(&side->rows);
}

bool png_fast_decode(const uint8_t *data, size_t size, int64_t max_pixels, Image **image) {
    Side side;
    bool ok = side_open(&side, data, size, max_pixels) && decode(&side);
    side_close(&side);
    if (!ok) image_destroy(side.image);
    *image = ok ? side.image : NULL;
    return ok;
}

/* Two files, row by row. */
typedef struct Pair {
    Side sides[2];
    bool equal;     /* the last row */
    bool all_equal; /* and all above; then the second image is not filled */
} Pair;

static void copy_rows(const Image *from, Image *to, int y, int count) {
    memcpy(pixels_of(to, y), pixels_of(from, y), (size_t)count * (size_t)from->width * 4);
}

/* The rows above are equal. */
static void begin_second(const Image *first, Image *second, int y) {
    image_provide(second);
    copy_rows(first, second, 0, y);
}

/* Equal bytes below equal rows need no unfiltering. */
static bool decode_rows(Pair *pair, int y) {
    Side *first = &pair->sides[0], *second = &pair->sides[1];
    size_t bytes = first->rows.bytes;
    if (!next(first) || !next(second)) return false;
    bool same = pair->equal && memcmp(first->filtered, second->filtered, bytes + 1) == 0;
    if (!unfilter(first, y) || (!same && !unfilter(second, y)) || !expand(first, y)) return false;
    if (same) second->row = first->row;
    pair->equal = same || memcmp(first->row, second->row, bytes) == 0;
    if (pair->all_equal && !pair->equal) begin_second(first->image, second->image, y);
    pair->all_equal = pair->all_equal && pair->equal;
    if (!pair->equal) return expand(second, y);
    if (!pair->all_equal) copy_rows(first->image, second->image, y, 1);
    return true;
}

static bool decode_both(Pair *pair) {
    Side *first = &pair->sides[0], *second = &pair->sides[1];
    if (!png_same_layout(&first->rows.layout, &second->rows.layout) || !start(first) || !start(second)) return false;
    image_provide(first->image);
    for (int y = 0; y < first->image->height; y++)
        if (!decode_rows(pair, y)) return false;
    return png_rows_end(&first->rows) && png_rows_end(&second->rows);
}

bool png_fast_decode_pair(const uint8_t *const data[2], const size_t sizes[2], int64_t max_pixels, Image *images[2]) {
    Pair pair = {.sides = {{.image = NULL}}, .equal = true, .all_equal = true};
    Side *first = &pair.sides[0], *second = &pair.sides[1];
    bool ok = side_open(first, data[0], sizes[0], max_pixels) && side_open(second, data[1], sizes[1], max_pixels) &&
              decode_both(&pair);
    side_close(first);
    side_close(second);
    if (!ok || pair.all_equal) image_destroy(second->image);
    if (!ok) image_destroy(first->image);
    images[0] = ok ? first->image : NULL;
    images[1] = ok && !pair.all_equal ? second->image : images[0];
    return ok;
}
