/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "image/image_compare.h"

#include "image/mask.h"

#include <stdlib.h>
#include <string.h>

static int deep_difference(const Image *a, const Image *b, size_t i) {
    int deep_a = a->pixels16 != NULL ? a->pixels16[i] : a->pixels[i] * 257;
    int deep_b = b->pixels16 != NULL ? b->pixels16[i] : b->pixels[i] * 257;
    return (abs(deep_a - deep_b) + 256) / 257;
}

int image_pixel_difference(const Image *a, const Image *b, size_t pixel) {
    bool deep = a->pixels16 != NULL || b->pixels16 != NULL;
    int largest = 0;
    for (size_t i = 4 * pixel; i < 4 * pixel + 4; i++) {
        int difference = deep ? deep_difference(a, b, i) : abs(a->pixels[i] - b->pixels[i]);
        if (difference > largest) largest = difference;
    }
    return largest;
}

static void count_pixel(ImageDifference *difference, int x, int y, int here, int tolerance) {
    if (difference->pixels++ == 0) {
        difference->first_x = difference->left = x, difference->right = x + 1;
        difference->first_y = difference->top = y;
    }
    if (here > difference->largest) difference->largest = here;
    difference->beyond += here > tolerance;
    if (x < difference->left) difference->left = x;
    if (x >= difference->right) difference->right = x + 1;
    difference->bottom = y + 1;
}

static bool equal_row(const Image *a, const Image *b, size_t first) {
    if (a == b) return true;
    return a->pixels16 == NULL && b->pixels16 == NULL &&
           memcmp(a->pixels + 4 * first, b->pixels + 4 * first, 4 * (size_t)a->width) == 0;
}

size_t image_next_difference(const Image *a, const Image *b, size_t first, size_t x) {
    enum { PART = 16 };
    const uint8_t *p = a->pixels + 4 * first, *q = b->pixels + 4 * first;
    size_t width = (size_t)a->width;
    if (a->pixels16 != NULL || b->pixels16 != NULL || x >= width || memcmp(p + 4 * x, q + 4 * x, 4) != 0) return x;
    while (x + PART <= width && memcmp(p + 4 * x, q + 4 * x, (size_t)4 * PART) == 0) x += PART;
    while (x < width && memcmp(p + 4 * x, q + 4 * x, 4) == 0) x++;
    return x;
}

static int64_t count_masked(const uint8_t *masked, size_t pixels) {
    int64_t count = 0;
    for (size_t i = 0; masked != NULL && i < pixels; i++) count += masked[i] == IGNORED_MASK;
    return count;
}

void image_compare_masked(const Image *a, const Image *b, const uint8_t *masked, int tolerance,
                          ImageDifference *difference) {
    bool same_size = a->width == b->width && a->height == b->height;
    *difference = (ImageDifference){.same_size = same_size, .first_x = -1, .first_y = -1};
    if (!same_size) return;
    size_t width = (size_t)a->width, all = width * (size_t)a->height;
    difference->counted = (int64_t)all - count_masked(masked, all);
    for (int y = 0; y < a->height; y++) {
        size_t first = (size_t)y * width;
        if (equal_row(a, b, first)) continue;
        for (size_t x = image_next_difference(a, b, first, 0); x < width;
             x = image_next_difference(a, b, first, x + 1)) {
            int here = image_pixel_difference(a, b, first + x);
            Ignored ignored = masked == NULL ? IGNORED_NOT : (Ignored)masked[first + x];
            if (here > 0 && ignored == IGNORED_NOT) count_pixel(difference, (int)x, y, here, tolerance);
            difference->moved += here > 0 && ignored == IGNORED_EDGE;
        }
    }
    difference->equal = difference->pixels == 0;
}

void image_compare(const Image *a, const Image *b, ImageDifference *difference) {
    image_compare_masked(a, b, NULL, 0, difference);
}

static int smaller(int a, int b) { return a < b ? a : b; }

/* Rows are copied in place: the first byte of a row never lies after its new place. */
static void cut(Image *image, int width, int height) {
    size_t from = 4 * (size_t)image->width, to = 4 * (size_t)width;
    for (int y = 0; y < height && width < image->width; y++) {
        memmove(image->pixels + (size_t)y * to, image->pixels + (size_t)y * from, to);
        if (image->pixels16 == NULL) continue;
        memmove(image->pixels16 + (size_t)y * to, image->pixels16 + (size_t)y * from, to * sizeof *image->pixels16);
    }
    image->width = width;
    image->height = height;
}

void image_cut_to_overlap(Image *a, Image *b) {
    int width = smaller(a->width, b->width), height = smaller(a->height, b->height);
    cut(a, width, height);
    cut(b, width, height);
}
