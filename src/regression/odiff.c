/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Counts are those of odiff 4 for the same threshold, so its arithmetic is kept: fixed point, and coefficients cut to
   12 bits. */
#include "regression/odiff.h"

#include "base/base.h"
#include "base/numbers.h"
#include "base/file.h"
#include "pixels/png.h"
#include "regression/compare.h"
#include "regression/regression_internal.h"

#include <stdlib.h>
#include <string.h>

enum { BITS = 12, ONE = 1 << BITS, WHITE = 255 };

static const double largest_delta = 35215; /* of any two colours */

#define FIXED(number) ((int64_t)((number)*ONE))

typedef struct Yiq {
    int64_t y, i, q;
} Yiq;

/* Of a pixel on white. */
static Yiq yiq_of(const uint8_t pixel[4]) {
    int64_t c[3];
    for (int k = 0; k < 3; k++) c[k] = (int64_t)WHITE * ONE + (int64_t)(pixel[k] - WHITE) * pixel[3] * ONE / WHITE;
    return (Yiq){(c[0] * FIXED(0.29889531) + c[1] * FIXED(0.58662247) + c[2] * FIXED(0.11448223)) >> BITS,
                 (c[0] * FIXED(0.59597799) + c[1] * FIXED(-0.27417610) + c[2] * FIXED(-0.32180189)) >> BITS,
                 (c[0] * FIXED(0.21147017) + c[1] * FIXED(-0.52261711) + c[2] * FIXED(0.31114694)) >> BITS};
}

static int64_t color_delta(const uint8_t *a, const uint8_t *b) {
    const Yiq p = yiq_of(a), r = yiq_of(b);
    const int64_t y = p.y - r.y, i = p.i - r.i, q = p.q - r.q;
    return (y * y * FIXED(0.5053) + i * i * FIXED(0.299) + q * q * FIXED(0.1957)) >> (2 * BITS);
}

static bool odiff_prepare(OdiffDifference *difference, const Image *base, const Image *compared, const char *name,
                          Error *error) {
    const int width = int_max(base->width, compared->width), height = int_max(base->height, compared->height);
    const size_t all = (size_t)width * (size_t)height;
    *difference = (OdiffDifference){.width = width, .height = height};
    if (all > IMAGE_MAX_PIXELS)
        return error_input(error, name, "%d x %d and %d x %d pixels cannot be compared", base->width, base->height,
                           compared->width, compared->height);
    difference->pixels = calloc(all, 1);
    difference->rows = calloc((size_t)height, sizeof *difference->rows);
    difference->columns = calloc((size_t)width, sizeof *difference->columns);
    return (difference->pixels != NULL && difference->rows != NULL && difference->columns != NULL) ||
           error_memory(error, name);
}

static void odiff_ignore(OdiffDifference *difference, const OdiffRegion *region) {
    const int64_t right = region->x2 < difference->width ? region->x2 + 1 : difference->width;
    for (int64_t y = region->y1; y <= region->y2 && y < difference->height && region->x1 < right; y++)
        memset(difference->pixels + y * difference->width + region->x1, IGNORED_MASK, (size_t)(right - region->x1));
}

static void odiff_mark(OdiffDifference *difference, int x, int y) {
    uint8_t *pixel = &difference->pixels[(size_t)y * (size_t)difference->width + (size_t)x];
    if (*pixel != IGNORED_NOT) return;
    *pixel = ODIFF_DIFFERS;
    difference->count++;
    difference->rows[y] = difference->columns[x] = true;
}

/* A row as a picture: rows of pictures of different widths can be compared. */
static Image row_of(const Image *image, int y, int width) {
    const size_t first = 4 * (size_t)image->width * (size_t)y;
    return (Image){width, 1, image->pixels + first, image->pixels16 != NULL ? image->pixels16 + first : NULL};
}

static void compare_row(OdiffDifference *difference, const Image *base, const Image *compared, int y, int64_t limit) {
    const int width = int_min(base->width, compared->width);
    const Image a = row_of(base, y, width), b = row_of(compared, y, width);
    const bool deep = limit == 0 && (a.pixels16 != NULL || b.pixels16 != NULL);
    for (size_t x = 0; (x = image_next_difference(&a, &b, 0, x)) < (size_t)width; x++)
        if (color_delta(a.pixels + 4 * x, b.pixels + 4 * x) > limit || (deep && image_pixel_difference(&a, &b, x) > 0))
            odiff_mark(difference, (int)x, y);
}

/* The pixels that the other picture does not have. */
static void mark_rest(OdiffDifference *difference, const Image *image, const Image *other) {
    for (int y = 0; y < image->height; y++)
        for (int x = y < other->height ? other->width : 0; x < image->width; x++)
            if (image->pixels[4 * ((size_t)y * (size_t)image->width + (size_t)x) + 3] != 0)
                odiff_mark(difference, x, y);
}

bool odiff_compare(const Image *base, const Image *compared, const OdiffOptions *options, const char *name,
                   OdiffDifference *difference, Error *error) {
    const double threshold = (double)(float)options->threshold;
    const int64_t limit = (int64_t)(largest_delta * (threshold * threshold) * ONE);
    if (!odiff_prepare(difference, base, compared, name, error)) return false;
    for (int i = 0; i < options->region_count; i++) odiff_ignore(difference, &options->regions[i]);
    if (options->antialias && base->width == compared->width && base->height == compared->height &&
        !antialias_mark(base, compared, difference->pixels, error))
        return false;
    for (int y = 0; y < base->height && y < compared->height; y++) compare_row(difference, base, compared, y, limit);
    mark_rest(difference, base, compared);
    mark_rest(difference, compared, base);
    return true;
}

void odiff_difference_free(OdiffDifference *difference) {
    free(difference->pixels);
    free(difference->rows);
    free(difference->columns);
}

/* Opaque, as the picture is written without transparency. */
static void paint_ground(uint8_t *pixel, const OdiffPicture *picture) {
    for (int c = 0; c < 3; c++) pixel[c] = (uint8_t)(WHITE - (WHITE - pixel[c]) * pixel[3] / WHITE);
    if (picture->ground != ODIFF_ON_PALE) return;
    const double grey = 0.29889531 * pixel[0] + 0.58662247 * pixel[1] + 0.11448223 * pixel[2];
    memset(pixel, (int)(grey + (WHITE - grey) * picture->white), 3);
}

static bool write_painted(Image *base, const OdiffDifference *difference, const OdiffPicture *picture, const char *path,
                          Error *error) {
    for (int y = 0; y < base->height; y++) {
        const uint8_t *marks = difference->pixels + (size_t)y * (size_t)difference->width;
        uint8_t *pixel = base->pixels + 4 * (size_t)y * (size_t)base->width;
        for (int x = 0; x < base->width; x++, pixel += 4)
            if (marks[x] == ODIFF_DIFFERS)
                memcpy(pixel, picture->color, 3);
            else
                paint_ground(pixel, picture);
    }
    return image_write_png(base, path, NULL, 0, error);
}

/* Colour 0 of the palette is transparent. */
static bool write_marks(const Image *base, const OdiffDifference *difference, const OdiffPicture *picture,
                        const char *path, Error *error) {
    Palette palette = {.count = 2, .clear = true};
    memcpy(palette.rgb[1], picture->color, 3);
    IndexedPng *png = indexed_png_create(base->width, base->height, &palette, error);
    bool ok = png != NULL;
    for (int y = 0; ok && y < base->height; y++) {
        const uint8_t *marks = difference->pixels + (size_t)y * (size_t)difference->width;
        uint8_t *row = indexed_png_row(png);
        for (int x = 0; x < base->width; x++) row[x] = marks[x] == ODIFF_DIFFERS;
        ok = indexed_png_add(png, error);
    }
    size_t size;
    uint8_t *file = ok ? indexed_png_end(png, &size, error) : NULL;
    ok = file != NULL && file_write(path, file, size, error);
    free(file);
    indexed_png_destroy(png);
    return ok;
}

bool odiff_picture_write(Image *base, const OdiffDifference *difference, const OdiffPicture *picture, const char *path,
                         Error *error) {
    return picture->ground == ODIFF_ON_NOTHING ? write_marks(base, difference, picture, path, error)
                                               : write_painted(base, difference, picture, path, error);
}
