/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Masks: rectangles, colours and pictures that hide pixels from a comparison. */
#include "regression/mask.h"

#include "base/base.h"
#include "base/numbers.h"
#include "pixels/png.h"
#include "regression/antialias.h"

#include <stdlib.h>
#include <string.h>

/* The part of a rectangle that is in a picture of this size. */
typedef struct Covered {
    size_t left, top, right, bottom;
} Covered;

static Covered covered(const MaskPart *part, int width, int height) {
    return (Covered){(size_t)int_max(0, int_min(part->x, width)), (size_t)int_max(0, int_min(part->y, height)),
                     (size_t)int_max(0, int_min(part->x + part->width, width)),
                     (size_t)int_max(0, int_min(part->y + part->height, height))};
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
    size_t count;  /* pixels */
    uint8_t *bits; /* one for each pixel; NULL: not decoded */
    Error fault;   /* of decoding; then it is not tried again */
} MaskPicture;

static void destroy(MaskPicture *picture) {
    if (picture == NULL) return;
    free(picture->path);
    free(picture->file);
    free(picture->bits);
    free(picture);
}

static void decode(MaskPicture *picture) {
    Image *image = image_decode_png(picture->file, picture->size, picture->path, IMAGE_MAX_PIXELS, &picture->fault);
    if (image == NULL) return;
    picture->bits = calloc(picture->count / 8 + 1, 1);
    if (picture->bits == NULL) error_memory(&picture->fault, picture->path);
    for (size_t i = 0; picture->bits != NULL && i < picture->count; i++) {
        const uint8_t *p = image->pixels + 4 * i;
        if (p[3] > 0 && (p[0] | p[1] | p[2]) != 0) picture->bits[i / 8] |= (uint8_t)(1U << i % 8);
    }
    image_destroy(image);
    free(picture->file);
    picture->file = NULL;
}

static bool add(Mask *mask, MaskPart part, Error *error) {
    if (mask->count == MASK_PARTS) return error_input(error, "--mask", "at most %d masks", MASK_PARTS);
    mask->parts[mask->count++] = part;
    return true;
}

bool mask_add_rectangle(Mask *mask, int x, int y, int width, int height, Error *error) {
    return add(mask, (MaskPart){.kind = MASK_RECTANGLE, .x = x, .y = y, .width = width, .height = height}, error);
}

/* Checks the file without decompressing it. */
bool mask_add_picture(Mask *mask, const char *path, Error *error) {
    MaskPicture *picture = calloc(1, sizeof *picture);
    if (picture == NULL || (picture->path = strdup(path)) == NULL)
        error_memory(error, path);
    else if ((picture->file = image_load_png(path, &picture->size, error)) != NULL &&
             png_check(picture->file, picture->size, path, &picture->width, &picture->height, error) &&
             png_check_pixels(picture->width, picture->height, IMAGE_MAX_PIXELS, path, error) &&
             (picture->count = (size_t)picture->width * (size_t)picture->height) > 0 &&
             add(mask, (MaskPart){.kind = MASK_PICTURE, .picture = picture}, error))
        return true;
    destroy(picture);
    return false;
}

bool mask_add_color(Mask *mask, const uint8_t color[3], Error *error) {
    return add(mask, (MaskPart){.kind = MASK_COLOR, .color = {color[0], color[1], color[2]}}, error);
}

void mask_free(Mask *mask) {
    for (int i = 0; i < mask->count; i++) destroy(mask->parts[i].picture);
    mask->count = 0;
}

/* Threads may share a picture. */
static bool draw_picture(MaskPicture *picture, const Image *expected, const char *path, uint8_t *masked, Error *error) {
    if (picture->width != expected->width || picture->height != expected->height)
        return error_input(error, picture->path, "the mask has %d x %d pixels, but %s has %d x %d", picture->width,
                           picture->height, path, expected->width, expected->height);
#pragma omp critical(mask_picture)
    if (picture->bits == NULL && picture->fault.kind == ERROR_NONE) decode(picture);
    if (picture->bits == NULL) return *error = picture->fault, false;
    for (size_t i = 0; i < picture->count; i++)
        if (picture->bits[i / 8] >> i % 8 & 1) masked[i] = IGNORED_MASK;
    return true;
}

bool mask_draw(const Mask *mask, const Image *expected, const char *path, uint8_t *masked, Error *error) {
    const size_t width = (size_t)expected->width, count = width * (size_t)expected->height;
    for (int i = 0; i < mask->count; i++) {
        const MaskPart *part = &mask->parts[i];
        const Covered in = covered(part, expected->width, expected->height);
        switch (part->kind) {
        case MASK_RECTANGLE:
            for (size_t y = in.top; y < in.bottom; y++)
                memset(masked + y * width + in.left, IGNORED_MASK, in.right - in.left);
            break;
        case MASK_COLOR:
            for (size_t k = 0; k < count; k++) {
                const uint8_t *p = expected->pixels + 4 * k;
                if (memcmp(p, part->color, 3) == 0 && p[3] == 255) masked[k] = IGNORED_MASK;
            }
            break;
        case MASK_PICTURE:
            if (!draw_picture(part->picture, expected, path, masked, error)) return false;
        }
    }
    return true;
}
