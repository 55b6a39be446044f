/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Masks: rectangles, colours and pictures that hide pixels from a comparison. */
#include "base/base.h"
#include "pixels/png.h"
#include "regression/compare.h"
#include "regression/regression_internal.h"

#include <stdlib.h>
#include <string.h>

static int64_t clamp(int64_t value, int64_t largest) { return value < 0 ? 0 : value > largest ? largest : value; }

/* The part of a rectangle that is in a picture of this size. */
typedef struct Covered {
    size_t left, top, right, bottom;
} Covered;

static Covered covered(const MaskPart *part, int width, int height) {
    return (Covered){(size_t)clamp(part->x, width), (size_t)clamp(part->y, height),
                     (size_t)clamp((int64_t)part->x + part->width, width),
                     (size_t)clamp((int64_t)part->y + part->height, height)};
}

double mask_most_hidden(const Mask *mask, int width, int height) {
    double area = 0;
    for (int i = 0; i < mask->count; i++) {
        const Covered all = {0, 0, (size_t)width, (size_t)height};
        const Covered part = mask->parts[i].kind == MASK_RECTANGLE ? covered(&mask->parts[i], width, height) : all;
        area += (double)(part.right - part.left) * (double)(part.bottom - part.top);
    }
    return area;
}

/* A picture that masks where it is neither black nor transparent. It is decompressed when it is first drawn on a
   picture of its size: a small file of any size costs nothing where it does not fit. */
typedef struct MaskPicture {
    char *path;
    uint8_t *file; /* [size], until it is decoded */
    size_t size;
    int width, height;
    uint8_t *bits; /* one for each pixel; NULL: not decoded */
    Error fault;   /* of decoding; then it is not tried again */
} MaskPicture;

static size_t bits_of(const MaskPicture *picture) { return (size_t)picture->width * (size_t)picture->height; }

static void mask_destroy(MaskPicture *picture) {
    if (picture == NULL) return;
    free(picture->path);
    free(picture->file);
    free(picture->bits);
    free(picture);
}

/* Checks the file without decompressing it. NULL with error set. */
static MaskPicture *read_picture(const char *path, Error *error) {
    MaskPicture *picture = calloc(1, sizeof *picture);
    if (picture == NULL || (picture->path = strdup(path)) == NULL)
        error_memory(error, path);
    else if ((picture->file = image_load_png(path, &picture->size, error)) != NULL &&
             png_check(picture->file, picture->size, path, &picture->width, &picture->height, error) &&
             png_check_pixels(picture->width, picture->height, IMAGE_MAX_PIXELS, path, error))
        return picture;
    mask_destroy(picture);
    return NULL;
}

static void set_bits(const Image *image, size_t count, uint8_t *bits) {
    for (size_t i = 0; i < count; i++) {
        const uint8_t *p = image->pixels + 4 * i;
        if (p[3] > 0 && (p[0] | p[1] | p[2]) != 0) bits[i / 8] |= (uint8_t)(1U << i % 8);
    }
}

static void mask_decode(MaskPicture *picture) {
    Image *image = image_decode_png(picture->file, picture->size, picture->path, IMAGE_MAX_PIXELS, &picture->fault);
    if (image == NULL) return;
    picture->bits = calloc(bits_of(picture) / 8 + 1, 1);
    if (picture->bits != NULL)
        set_bits(image, bits_of(picture), picture->bits);
    else
        error_memory(&picture->fault, picture->path);
    image_destroy(image);
    free(picture->file);
    picture->file = NULL;
}

/* Sets the masked bytes to IGNORED_MASK. ERROR_INPUT if `expected`, whose file is `path`, has another size, or if the
   pixels are damaged. Threads may share a picture. */
static bool draw_picture(MaskPicture *picture, const Image *expected, const char *path, uint8_t *masked, Error *error) {
    if (picture->width != expected->width || picture->height != expected->height)
        return error_input(error, picture->path, "the mask has %d x %d pixels, but %s has %d x %d", picture->width,
                           picture->height, path, expected->width, expected->height);
#pragma omp critical(mask_picture)
    if (picture->bits == NULL && picture->fault.kind == ERROR_NONE) mask_decode(picture);
    if (picture->bits == NULL) return *error = picture->fault, false;
    for (size_t i = 0; i < bits_of(picture); i++)
        if (picture->bits[i / 8] >> i % 8 & 1) masked[i] = IGNORED_MASK;
    return true;
}

static bool mask_add(Mask *mask, MaskPart part, Error *error) {
    if (mask->count == MASK_PARTS) return error_input(error, "--mask", "at most %d masks", MASK_PARTS);
    mask->parts[mask->count++] = part;
    return true;
}

bool mask_add_rectangle(Mask *mask, int x, int y, int width, int height, Error *error) {
    return mask_add(mask, (MaskPart){.kind = MASK_RECTANGLE, .x = x, .y = y, .width = width, .height = height}, error);
}

bool mask_add_picture(Mask *mask, const char *path, Error *error) {
    MaskPicture *picture = read_picture(path, error);
    if (picture == NULL) return false;
    if (mask_add(mask, (MaskPart){.kind = MASK_PICTURE, .picture = picture}, error)) return true;
    mask_destroy(picture);
    return false;
}

bool mask_add_color(Mask *mask, const uint8_t color[3], Error *error) {
    return mask_add(mask, (MaskPart){.kind = MASK_COLOR, .color = {color[0], color[1], color[2]}}, error);
}

void mask_free(Mask *mask) {
    for (int i = 0; i < mask->count; i++) mask_destroy(mask->parts[i].picture);
    mask->count = 0;
}

static size_t pixel_count(const Image *image) { return (size_t)image->width * (size_t)image->height; }

static void draw_color(const uint8_t color[3], const Image *expected, uint8_t *masked) {
    for (size_t i = 0; i < pixel_count(expected); i++) {
        const uint8_t *p = expected->pixels + 4 * i;
        if (p[0] == color[0] && p[1] == color[1] && p[2] == color[2] && p[3] == 255) masked[i] = IGNORED_MASK;
    }
}

static void draw_rectangle(const MaskPart *part, int width, int height, uint8_t *masked) {
    const Covered in = covered(part, width, height);
    for (size_t y = in.top; y < in.bottom; y++)
        memset(masked + y * (size_t)width + in.left, IGNORED_MASK, in.right - in.left);
}

bool mask_draw(const Mask *mask, const Image *expected, const char *path, uint8_t *masked, Error *error) {
    int width = expected->width, height = expected->height;
    for (int i = 0; i < mask->count; i++) {
        const MaskPart *part = &mask->parts[i];
        switch (part->kind) {
        case MASK_RECTANGLE: draw_rectangle(part, width, height, masked); break;
        case MASK_COLOR: draw_color(part->color, expected, masked); break;
        case MASK_PICTURE:
            if (!draw_picture(part->picture, expected, path, masked, error)) return false;
        }
    }
    return true;
}

void image_copy_masked(const Image *expected, Image *actual, const uint8_t *masked) {
    for (size_t i = 0; masked != NULL && i < pixel_count(expected); i++)
        if (masked[i] != IGNORED_NOT) memcpy(actual->pixels + 4 * i, expected->pixels + 4 * i, 4);
}
