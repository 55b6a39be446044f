/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "image/mask_picture.h"

#include "image/mask.h"
#include "image/png_check.h"

#include <stdlib.h>
#include <string.h>

struct MaskPicture {
    char *path;
    uint8_t *file; /* [size], until it is decoded */
    size_t size;
    int width, height;
    uint8_t *bits; /* one for each pixel; NULL: not decoded */
    Error fault;   /* of decoding; then it is not tried again */
};

static size_t pixel_count(const MaskPicture *picture) { return (size_t)picture->width * (size_t)picture->height; }

MaskPicture *mask_picture_read(const char *path, Error *error) {
    MaskPicture *picture = calloc(1, sizeof *picture);
    if (picture == NULL || (picture->path = strdup(path)) == NULL)
        error_memory(error, path);
    else if ((picture->file = image_load_png(path, &picture->size, error)) != NULL &&
             png_check(picture->file, picture->size, path, &picture->width, &picture->height, error) &&
             png_check_pixels(picture->width, picture->height, IMAGE_MAX_PIXELS, path, error))
        return picture;
    mask_picture_destroy(picture);
    return NULL;
}

void mask_picture_destroy(MaskPicture *picture) {
    if (picture == NULL) return;
    free(picture->path);
    free(picture->file);
    free(picture->bits);
    free(picture);
}

static void set_bits(const Image *image, size_t count, uint8_t *bits) {
    for (size_t i = 0; i < count; i++) {
        const uint8_t *p = image->pixels + 4 * i;
        if (p[3] > 0 && (p[0] | p[1] | p[2]) != 0) bits[i / 8] |= (uint8_t)(1U << i % 8);
    }
}

static void decode(MaskPicture *picture) {
    Image *image = image_decode_png(picture->file, picture->size, picture->path, IMAGE_MAX_PIXELS, &picture->fault);
    if (image == NULL) return;
    picture->bits = calloc(pixel_count(picture) / 8 + 1, 1);
    if (picture->bits != NULL)
        set_bits(image, pixel_count(picture), picture->bits);
    else
        error_memory(&picture->fault, picture->path);
    image_destroy(image);
    free(picture->file);
    picture->file = NULL;
}

bool mask_picture_draw(MaskPicture *picture, const Image *expected, const char *path, uint8_t *masked, Error *error) {
    if (picture->width != expected->width || picture->height != expected->height)
        return error_input(error, picture->path, "the mask has %d x %d pixels, but %s has %d x %d", picture->width,
                           picture->height, path, expected->width, expected->height);
#pragma omp critical(mask_picture)
    if (picture->bits == NULL && picture->fault.kind == ERROR_NONE) decode(picture);
    if (picture->bits == NULL) {
        *error = picture->fault;
        return false;
    }
    for (size_t i = 0; i < pixel_count(picture); i++)
        if (picture->bits[i / 8] >> i % 8 & 1) masked[i] = IGNORED_MASK;
    return true;
}
