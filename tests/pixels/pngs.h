/* SPDX-License-Identifier: GPL-3.0-or-later */
/* PNG files of every kind, written by libpng itself. Include testing.h first. */
#pragma once
#include <png.h>

typedef struct PngKind {
    const char *name;
    int color, depth;
    bool transparency; /* a tRNS chunk: sample or palette entry 1 is transparent */
} PngKind;

enum { PNG_SIDE = 13 };

static inline int channels(int color) {
    return color == PNG_COLOR_TYPE_RGB_ALPHA    ? 4
           : color == PNG_COLOR_TYPE_RGB        ? 3
           : color == PNG_COLOR_TYPE_GRAY_ALPHA ? 2
                                                : 1;
}

/* Sample of a channel at a pixel, 0 .. 2^depth - 1. At 16 bits the nearest 8-bit value is sometimes not the upper
   byte. */
static inline unsigned sample(int x, int y, int channel, int depth) {
    unsigned value = (unsigned)(x * 3 + y * 5 + channel * 7 + x * y);
    if (depth < 16) return value % (1u << depth);
    return value % 256 == 0 ? 0 : value % 256 * 257 - 100;
}

static inline png_color palette_color(unsigned i) {
    return (png_color){(png_byte)(i * 3), (png_byte)(255 - i), (png_byte)(i ^ 0x55)};
}

static inline void fill_row(png_bytep row, int y, const PngKind *kind) {
    memset(row, 0, PNG_SIDE * 8);
    int count = channels(kind->color);
    for (int x = 0; x < PNG_SIDE; x++)
        for (int c = 0; c < count; c++) {
            unsigned value = sample(x, y, c, kind->depth);
            int i = x * count + c;
            if (kind->depth == 16)
                row[2 * i] = (png_byte)(value >> 8), row[2 * i + 1] = (png_byte)value;
            else if (kind->depth == 8)
                row[i] = (png_byte)value;
            else
                row[i * kind->depth / 8] |= (png_byte)(value << (8 - kind->depth - i * kind->depth % 8));
        }
}

static inline void set_palette(png_structp png, png_infop info, const PngKind *kind) {
    png_color palette[256];
    png_byte alpha[2] = {255, 0};
    if (kind->color == PNG_COLOR_TYPE_PALETTE) {
        for (unsigned i = 0; i < 1u << kind->depth; i++) palette[i] = palette_color(i);
        png_set_PLTE(png, info, palette, 1 << kind->depth);
    }
    if (kind->transparency) png_set_tRNS(png, info, alpha, 2, &(png_color_16){.gray = 1});
}

static inline void write_kind(const char *path, const PngKind *kind, int interlace) {
    FILE *file = fopen(path, "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_byte rows[PNG_SIDE][PNG_SIDE * 8];
    png_bytep pointers[PNG_SIDE];
    assert_non_null(file);
    png_init_io(png, file);
    png_set_IHDR(png, info, PNG_SIDE, PNG_SIDE, kind->depth, kind->color, interlace, 0, 0);
    set_palette(png, info, kind);
    png_write_info(png, info);
    for (int y = 0; y < PNG_SIDE; y++) fill_row(pointers[y] = rows[y], y, kind);
    png_write_image(png, pointers);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    fclose(file);
}

/* A header with this size, and no pixels. */
static inline void write_claim(const char *path, uint32_t width, uint32_t height) {
    FILE *file = fopen(path, "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    assert_non_null(file);
    png_init_io(png, file);
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_IHDR(png, info, width, height, 8, PNG_COLOR_TYPE_RGB, 0, 0, 0);
    png_write_info(png, info);
    png_write_chunk(png, (png_const_bytep) "IDAT", NULL, 0);
    png_destroy_write_struct(&png, &info);
    fclose(file);
}
