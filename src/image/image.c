/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Allocation, hash and comparison of pictures. */
#include "image/image.h"

#include "common/hash.h"

#include <stdlib.h>
#include <string.h>

Image *image_create(int width, int height, Error *error) {
    Image *image = malloc(sizeof *image);
    uint8_t *pixels = calloc((size_t)width * (size_t)height, 4);
    if (image == NULL || pixels == NULL) {
        free(image);
        free(pixels);
        error_memory(error, "image");
        return NULL;
    }
    *image = (Image){width, height, pixels, NULL};
    return image;
}

void image_destroy(Image *image) {
    if (image == NULL) return;
    free(image->pixels);
    free(image->pixels16);
    free(image);
}

/* Continues a hash with a number in little-endian bytes. */
static uint64_t add_number(uint64_t hash, uint64_t value, int count) {
    uint8_t bytes[8];
    for (int i = 0; i < count; i++) bytes[i] = (uint8_t)(value >> (8 * i));
    return hash_fnv1a64(hash, bytes, (size_t)count);
}

static uint64_t hash_shape(const Image *image) {
    return add_number(add_number(FNV1A64_START, (uint64_t)image->width, 4), (uint64_t)image->height, 4);
}

static uint64_t hash_row(const Image *image, int y) {
    size_t size = (size_t)image->width * 4;
    return hash_xxh3(image->pixels + (size_t)y * size, size);
}

uint64_t image_hash(const Image *image) {
    uint64_t hash = hash_shape(image);
    for (int y = 0; y < image->height; y++) hash = add_number(hash, hash_row(image, y), 8);
    return hash;
}

uint64_t image_hash_next(const Image *image, const bool *changed, uint64_t *rows) {
    uint64_t hash = hash_shape(image);
    for (int y = 0; y < image->height; y++) {
        if (changed == NULL || changed[y]) rows[y] = hash_row(image, y);
        hash = add_number(hash, rows[y], 8);
    }
    return hash;
}

static int channel_difference(const Image *a, const Image *b, size_t i) {
    if (a->pixels16 == NULL && b->pixels16 == NULL) return abs(a->pixels[i] - b->pixels[i]);
    int deep_a = a->pixels16 != NULL ? a->pixels16[i] : a->pixels[i] * 257;
    int deep_b = b->pixels16 != NULL ? b->pixels16[i] : b->pixels[i] * 257;
    return (abs(deep_a - deep_b) + 256) / 257;
}

int image_pixel_difference(const Image *a, const Image *b, size_t pixel) {
    int largest = 0;
    for (size_t i = 4 * pixel; i < 4 * pixel + 4; i++) {
        int difference = channel_difference(a, b, i);
        if (difference > largest) largest = difference;
    }
    return largest;
}

static void count_pixel(ImageDifference *difference, int x, int y, int here) {
    if (difference->pixels++ == 0) {
        difference->first_x = difference->left = x, difference->right = x + 1;
        difference->first_y = difference->top = y;
    }
    if (here > difference->largest) difference->largest = here;
    if (x < difference->left) difference->left = x;
    if (x >= difference->right) difference->right = x + 1;
    difference->bottom = y + 1;
}

static bool equal_row(const Image *a, const Image *b, size_t first) {
    return a->pixels16 == NULL && b->pixels16 == NULL &&
           memcmp(a->pixels + 4 * first, b->pixels + 4 * first, 4 * (size_t)a->width) == 0;
}

static int64_t count_masked(const uint8_t *masked, size_t pixels) {
    int64_t count = 0;
    for (size_t i = 0; masked != NULL && i < pixels; i++) count += masked[i] != 0;
    return count;
}

void image_compare_masked(const Image *a, const Image *b, const uint8_t *masked, ImageDifference *difference) {
    bool same_size = a->width == b->width && a->height == b->height;
    *difference = (ImageDifference){.same_size = same_size, .first_x = -1, .first_y = -1};
    if (!same_size) return;
    size_t width = (size_t)a->width, all = width * (size_t)a->height;
    difference->counted = (int64_t)all - count_masked(masked, all);
    for (int y = 0; y < a->height; y++) {
        size_t first = (size_t)y * width;
        if (equal_row(a, b, first)) continue;
        for (size_t x = 0; x < width; x++) {
            int here = image_pixel_difference(a, b, first + x);
            if (here > 0 && (masked == NULL || masked[first + x] == 0)) count_pixel(difference, (int)x, y, here);
        }
    }
    difference->equal = difference->pixels == 0;
}

void image_compare(const Image *a, const Image *b, ImageDifference *difference) {
    image_compare_masked(a, b, NULL, difference);
}
