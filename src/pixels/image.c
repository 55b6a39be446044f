/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Allocation and hash of pictures. */
#include "base/base.h"
#include "base/hash.h"
#include "pixels/png.h"

#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>

static Image *wrap(int width, int height, uint8_t *pixels, Error *error) {
    Image *image = malloc(sizeof *image);
    if (image == NULL || pixels == NULL) {
        free(image);
        free(pixels);
        error_memory(error, "image");
        return NULL;
    }
    *image = (Image){width, height, pixels, NULL};
    return image;
}

Image *image_create(int width, int height, Error *error) {
    return wrap(width, height, calloc((size_t)width * (size_t)height, 4), error);
}

Image *image_create_unset(int width, int height, Error *error) {
    return wrap(width, height, malloc((size_t)width * (size_t)height * 4), error);
}

/* The system provides all pages at once in half the time that it needs for one after another. */
void image_provide(Image *image) {
#ifdef MADV_POPULATE_WRITE
    enum { PAGE = 1 << 12 };
    size_t size = (size_t)image->width * (size_t)image->height * 4, skipped = -(uintptr_t)image->pixels % PAGE;
    if (size > PAGE) (void)madvise(image->pixels + skipped, (size - skipped) / PAGE * PAGE, MADV_POPULATE_WRITE);
#else
    (void)image;
#endif
}

void image_destroy(Image *image) {
    if (image == NULL) return;
    free(image->pixels);
    free(image->pixels16);
    free(image);
}

void image_destroy_pair(Image *images[2]) {
    image_destroy(images[0]);
    if (images[1] != images[0]) image_destroy(images[1]);
}

/* Continues a hash with a number in little-endian bytes. */
static uint64_t add_number(uint64_t hash, uint64_t value, int count) {
    uint8_t bytes[8];
    for (int i = 0; i < count; i++) bytes[i] = (uint8_t)(value >> (8 * i));
    return hash_fnv1a64(hash, bytes, (size_t)count);
}

/* rows NULL: the hashes of the rows are not kept. */
static uint64_t hash_rows(const Image *image, const bool *changed, uint64_t *rows) {
    const size_t size = (size_t)image->width * 4;
    uint64_t hash = add_number(add_number(FNV1A64_START, (uint64_t)image->width, 4), (uint64_t)image->height, 4);
    for (int y = 0; y < image->height; y++) {
        const bool kept = rows != NULL && changed != NULL && !changed[y];
        const uint64_t row = kept ? rows[y] : hash_xxh3(image->pixels + (size_t)y * size, size);
        if (rows != NULL) rows[y] = row;
        hash = add_number(hash, row, 8);
    }
    return hash;
}

uint64_t image_hash(const Image *image) { return hash_rows(image, NULL, NULL); }

uint64_t image_hash_next(const Image *image, const bool *changed, uint64_t *rows) {
    return hash_rows(image, changed, rows);
}
