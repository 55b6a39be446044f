/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From filtered rows to pixels: one file, or two that are mostly equal. */
#include "base/base.h"
#include "pixels/internal.h"
#include "pixels/png.h"

#include <stdlib.h>
#include <string.h>

typedef uint8_t Bytes __attribute__((vector_size(16)));

/* The row filters of PNG (specification, section 9). */

enum { NONE, SUB, UP, AVERAGE, PAETH };

static void add_up(const uint8_t *restrict from, const uint8_t *restrict above, size_t bytes, uint8_t *restrict row) {
    for (size_t i = 0; i < bytes; i++) row[i] = (uint8_t)(from[i] + above[i]);
}

/* The functions below are compiled once for each step, as a constant. */
static inline void add_left(const uint8_t *restrict from, size_t bytes, size_t step, uint8_t *restrict row) {
    uint8_t left[4] = {0};
    for (size_t i = 0; i + step <= bytes; i += step)
        for (size_t c = 0; c < step; c++) row[i + c] = left[c] = (uint8_t)(from[i + c] + left[c]);
}

typedef uint32_t Pixels __attribute__((vector_size(16)));

/* Four pixels of four bytes at once: sums of neighbours, then of pairs, then with all before. */
static void add_left_rgba(const uint8_t *restrict from, size_t bytes, uint8_t *restrict row) {
    static const Pixels not_first = {0, UINT32_MAX, UINT32_MAX, UINT32_MAX}, last_two = {0, 0, UINT32_MAX, UINT32_MAX};
    Pixels before = {0};
    size_t i = 0;
    for (; i + sizeof before <= bytes; i += sizeof before) {
        Pixels pixels;
        memcpy(&pixels, from + i, sizeof pixels);
        pixels = (Pixels)((Bytes)pixels + (Bytes)(__builtin_shufflevector(pixels, pixels, 0, 0, 1, 2) & not_first));
        pixels = (Pixels)((Bytes)pixels + (Bytes)(__builtin_shufflevector(pixels, pixels, 0, 0, 0, 1) & last_two));
        pixels = (Pixels)((Bytes)pixels + (Bytes)before);
        memcpy(row + i, &pixels, sizeof pixels);
        before = __builtin_shufflevector(pixels, pixels, 3, 3, 3, 3);
    }
    for (; i < bytes; i++) row[i] = (uint8_t)(from[i] + (i < 4 ? 0 : row[i - 4]));
}

static inline void add_average(const uint8_t *restrict from, const uint8_t *restrict above, size_t bytes, size_t step,
                               uint8_t *restrict row) {
    uint8_t left[4] = {0};
    for (size_t i = 0; i + step <= bytes; i += step)
        for (size_t c = 0; c < step; c++) row[i + c] = left[c] = (uint8_t)(from[i + c] + (left[c] + above[i + c]) / 2);
}

/* The neighbour nearest to left + up - corner; the first of these where they tie. */
static inline int predict(int left, int up, int corner) {
    int to_left = abs(up - corner), to_up = abs(left - corner), to_corner = abs(left + up - 2 * corner);
    int nearest = to_up <= to_corner ? up : corner, distance = to_up <= to_corner ? to_up : to_corner;
    return to_left <= distance ? left : nearest;
}

static inline void add_paeth(const uint8_t *restrict from, const uint8_t *restrict above, size_t bytes, size_t step,
                             uint8_t *restrict row) {
    int left[4] = {0}, corner[4] = {0};
    for (size_t i = 0; i + step <= bytes; i += step)
        for (size_t c = 0; c < step; c++) {
            int up = above[i + c];
            row[i + c] = (uint8_t)(from[i + c] + predict(left[c], up, corner[c]));
            left[c] = row[i + c], corner[c] = up;
        }
}

/* Filters that refer to the left. */
static inline bool unfilter_step(int filter, const uint8_t *from, const uint8_t *above, size_t bytes, size_t step,
                                 uint8_t *row) {
    if (filter == SUB)
        add_left(from, bytes, step, row);
    else if (filter == AVERAGE)
        add_average(from, above, bytes, step, row);
    else if (filter == PAETH)
        add_paeth(from, above, bytes, step, row);
    else
        return false;
    return true;
}

/* row[bytes] = the row that `filtered`, a filter's number and `bytes` bytes, stands for. above[bytes]: the row above,
   zeros for the first. step: 1 to 4, bytes per pixel. No two of the arrays overlap. False for an unknown filter. */
static bool unfilter_row(const uint8_t *filtered, const uint8_t *above, size_t bytes, int step, uint8_t *row) {
    int filter = filtered[0];
    const uint8_t *from = filtered + 1;
    if (filter == NONE)
        memcpy(row, from, bytes);
    else if (filter == UP)
        add_up(from, above, bytes, row);
    else if (filter == SUB && step == 4)
        add_left_rgba(from, bytes, row);
    else
        return step == 4   ? unfilter_step(filter, from, above, bytes, 4, row)
               : step == 3 ? unfilter_step(filter, from, above, bytes, 3, row)
               : step == 2 ? unfilter_step(filter, from, above, bytes, 2, row)
                           : unfilter_step(filter, from, above, bytes, 1, row);
    return true;
}

/* Rows as RGBA. */

enum { OPAQUE = 255 };

/* Compilers make one load of it, and one store of the next. */
static uint32_t load(const uint8_t *p) {
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static void store(uint32_t pixel, uint8_t *rgba) {
    pixel |= (uint32_t)OPAQUE << 24;
    rgba[0] = (uint8_t)pixel, rgba[1] = (uint8_t)(pixel >> 8);
    rgba[2] = (uint8_t)(pixel >> 16), rgba[3] = (uint8_t)(pixel >> 24);
}

#ifdef TWINBOX_AVX
/* Sixteen bytes hold five pixels, of which four are taken. Returns how many pixels are done. */
__attribute__((target("ssse3"))) static size_t expand_rgb_ssse3(const uint8_t *restrict row, size_t width,
                                                                uint8_t *restrict rgba) {
    static const Bytes opaque = {0, 0, 0, OPAQUE, 0, 0, 0, OPAQUE, 0, 0, 0, OPAQUE, 0, 0, 0, OPAQUE};
    size_t x = 0;
    for (; x + 6 <= width; x += 4) {
        Bytes bytes;
        memcpy(&bytes, row + 3 * x, sizeof bytes);
        bytes =
            __builtin_shufflevector(bytes, (Bytes){0}, 0, 1, 2, 16, 3, 4, 5, 16, 6, 7, 8, 16, 9, 10, 11, 16) | opaque;
        memcpy(rgba + 4 * x, &bytes, sizeof bytes);
    }
    return x;
}
#endif

/* Four pixels are three words. */
static void expand_rgb(const uint8_t *restrict row, size_t width, uint8_t *restrict rgba) {
    size_t x = 0;
#ifdef TWINBOX_AVX
    if (__builtin_cpu_supports("ssse3")) x = expand_rgb_ssse3(row, width, rgba);
    row += 3 * x, rgba += 4 * x;
#endif
    for (; x + 4 <= width; x += 4, row += 12, rgba += 16) {
        uint32_t a = load(row), b = load(row + 4), c = load(row + 8);
        store(a, rgba);
        store(a >> 24 | b << 8, rgba + 4);
        store(b >> 16 | c << 16, rgba + 8);
        store(c >> 8, rgba + 12);
    }
    for (; x < width; x++, row += 3, rgba += 4)
        store((uint32_t)row[0] | (uint32_t)row[1] << 8 | (uint32_t)row[2] << 16, rgba);
}

static void clear_rgb(const PngLayout *layout, uint8_t *rgba) {
    for (size_t x = 0; x < layout->width; x++)
        if (memcmp(rgba + 4 * x, layout->clear, 3) == 0) rgba[4 * x + 3] = 0;
}

static void expand_grey_alpha(const uint8_t *restrict row, size_t width, uint8_t *restrict rgba) {
    for (size_t x = 0; x < width; x++) {
        rgba[4 * x] = rgba[4 * x + 1] = rgba[4 * x + 2] = row[2 * x];
        rgba[4 * x + 3] = row[2 * x + 1];
    }
}

/* Sample x of one channel; the first is in the highest bits of a byte. */
static unsigned sample(const uint8_t *row, size_t x, unsigned depth) {
    size_t bit = x * depth;
    return (unsigned)row[bit / 8] >> (8 - depth - bit % 8) & ((1u << depth) - 1);
}

static void expand_grey(const PngLayout *layout, const uint8_t *row, uint8_t *rgba) {
    unsigned depth = (unsigned)layout->depth, scale = 255 / ((1u << depth) - 1);
    for (size_t x = 0; x < layout->width; x++) {
        unsigned value = sample(row, x, depth);
        rgba[4 * x] = rgba[4 * x + 1] = rgba[4 * x + 2] = (uint8_t)(value * scale);
        rgba[4 * x + 3] = layout->has_clear && value == layout->clear[0] ? 0 : OPAQUE;
    }
}

static bool expand_palette(const PngLayout *layout, const uint8_t *row, uint8_t *rgba) {
    unsigned depth = (unsigned)layout->depth, most = 0;
    for (size_t x = 0; x < layout->width; x++) {
        unsigned index = sample(row, x, depth);
        memcpy(rgba + 4 * x, layout->palette[index], 4);
        if (index > most) most = index;
    }
    return most < (unsigned)layout->colors;
}

/* rgba[4 * width] for a row. False if a colour is not in the palette. */
static bool expand_row(const PngLayout *layout, const uint8_t *row, uint8_t *rgba) {
    if (layout->color == PNG_PALETTE) return expand_palette(layout, row, rgba);
    if (layout->color == PNG_GREY) expand_grey(layout, row, rgba);
    if (layout->color == PNG_GREY_ALPHA) expand_grey_alpha(row, layout->width, rgba);
    if (layout->color == PNG_RGB) expand_rgb(row, layout->width, rgba);
    if (layout->color == PNG_RGB && layout->has_clear) clear_rgb(layout, rgba);
    if (layout->color == PNG_RGB_ALPHA) memcpy(rgba, row, 4 * (size_t)layout->width);
    return true;
}

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
    bool ok = unfilter_row(side->filtered, side->row, side->rows.bytes, side->rows.step, row);
    side->row = row;
    return ok;
}

static uint8_t *pixels_of(const Image *image, int y) { return image->pixels + (size_t)y * (size_t)image->width * 4; }

static bool expand(const Side *side, int y) {
    return expand_row(&side->rows.layout, side->row, pixels_of(side->image, y));
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

static bool same_layout(const PngLayout *a, const PngLayout *b) {
    return a->width == b->width && a->height == b->height && a->color == b->color && a->depth == b->depth &&
           a->colors == b->colors && memcmp(a->palette, b->palette, sizeof a->palette) == 0 &&
           a->has_clear == b->has_clear && memcmp(a->clear, b->clear, sizeof a->clear) == 0;
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
    if (!same_layout(&first->rows.layout, &second->rows.layout) || !start(first) || !start(second)) return false;
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
