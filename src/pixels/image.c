/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Selection by radix: bits of floats from 0 sort as the floats do. Linear in time, whatever the values. */
#include "base/base.h"
#include "base/hash.h"
#include "pixels/png.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

bool largest_create(Largest *largest, size_t keep, Error *error) {
    *largest = (Largest){.keep = keep};
    largest->values = malloc(2 * keep * sizeof *largest->values);
    return largest->values != NULL || error_memory(error, "percentile");
}

void largest_free(Largest *largest) { free(largest->values); }

static uint32_t bits_of(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* The value that `rank` - 1 values exceed or equal; rank is at most count. */
static float select_rank(const float *values, size_t count, size_t rank) {
    enum { DIGIT = 11, DIGITS = 1 << DIGIT };
    uint32_t prefix = 0, known = 0; /* bits of the result, and a mask of those known */
    for (int shift = 32 - DIGIT; known != UINT32_MAX; shift = shift > DIGIT ? shift - DIGIT : 0) {
        size_t counts[DIGITS] = {0};
        for (size_t i = 0; i < count; i++) {
            uint32_t bits = bits_of(values[i]);
            if ((bits & known) == prefix) counts[bits >> shift & (DIGITS - 1)]++;
        }
        uint32_t digit = DIGITS - 1;
        for (; counts[digit] < rank; digit--) rank -= counts[digit];
        prefix |= digit << shift;
        known |= (uint32_t)(DIGITS - 1) << shift;
    }
    float value;
    memcpy(&value, &prefix, sizeof value);
    return value;
}

/* Keeps the largest values. Of those equal to the least, all but enough are dropped. */
static void shrink(Largest *largest) {
    float least = select_rank(largest->values, largest->count, largest->keep);
    size_t count = 0;
    for (size_t i = 0; i < largest->count; i++)
        if (largest->values[i] > least) largest->values[count++] = largest->values[i];
    while (count < largest->keep) largest->values[count++] = least;
    largest->count = count;
    largest->least = least;
}

void largest_add(Largest *largest, float value) {
    if (value <= largest->least) return;
    largest->values[largest->count++] = value;
    if (largest->count == 2 * largest->keep) shrink(largest);
}

float largest_least(Largest *largest) {
    if (largest->count < largest->keep) return 0;
    shrink(largest);
    return largest->least;
}

/* Allocation and hash of pictures. */

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

Image *image_create_unset(int width, int height, size_t further, Error *error) {
    return wrap(width, height, malloc((size_t)width * (size_t)height * 4 + further), error);
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
