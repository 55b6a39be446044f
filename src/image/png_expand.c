/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of PNG files as RGBA. */
#include "image/png_rows.h"

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
typedef uint8_t Bytes __attribute__((vector_size(16)));

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

bool png_expand(const PngLayout *layout, const uint8_t *row, uint8_t *rgba) {
    if (layout->color == PNG_PALETTE) return expand_palette(layout, row, rgba);
    if (layout->color == PNG_GREY) expand_grey(layout, row, rgba);
    if (layout->color == PNG_GREY_ALPHA) expand_grey_alpha(row, layout->width, rgba);
    if (layout->color == PNG_RGB) expand_rgb(row, layout->width, rgba);
    if (layout->color == PNG_RGB && layout->has_clear) clear_rgb(layout, rgba);
    if (layout->color == PNG_RGB_ALPHA) memcpy(rgba, row, 4 * (size_t)layout->width);
    return true;
}

bool png_same_layout(const PngLayout *a, const PngLayout *b) {
    return a->width == b->width && a->height == b->height && a->color == b->color && a->depth == b->depth &&
           a->colors == b->colors && memcmp(a->palette, b->palette, sizeof a->palette) == 0 &&
           a->has_clear == b->has_clear && memcmp(a->clear, b->clear, sizeof a->clear) == 0;
}
