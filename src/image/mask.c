/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "image/mask.h"

#include <stdlib.h>
#include <string.h>

static bool add(Mask *mask, MaskPart part, Error *error) {
    if (mask->count == MASK_PARTS) return error_input(error, "--mask", "at most %d masks", MASK_PARTS);
    mask->parts[mask->count++] = part;
    return true;
}

bool mask_add_rectangle(Mask *mask, int x, int y, int width, int height, Error *error) {
    return add(mask, (MaskPart){x, y, width, height, NULL, NULL}, error);
}

bool mask_add_picture(Mask *mask, const char *path, Error *error) {
    Image *picture = image_read_png(path, error);
    if (picture == NULL) return false;
    if (add(mask, (MaskPart){.picture = picture, .path = path}, error)) return true;
    image_destroy(picture);
    return false;
}

void mask_free(Mask *mask) {
    for (int i = 0; i < mask->count; i++) image_destroy(mask->parts[i].picture);
    mask->count = 0;
}

static void mark_picture(const Image *picture, uint8_t *masked) {
    size_t pixels = (size_t)picture->width * (size_t)picture->height;
    for (size_t i = 0; i < pixels; i++) {
        const uint8_t *p = picture->pixels + 4 * i;
        if (p[3] > 0 && (p[0] | p[1] | p[2]) != 0) masked[i] = 1;
    }
}

static int64_t clamp(int64_t value, int64_t largest) { return value < 0 ? 0 : value > largest ? largest : value; }

static void mark_rectangle(const MaskPart *part, int width, int height, uint8_t *masked) {
    size_t left = (size_t)clamp(part->x, width), right = (size_t)clamp((int64_t)part->x + part->width, width);
    size_t top = (size_t)clamp(part->y, height), bottom = (size_t)clamp((int64_t)part->y + part->height, height);
    for (size_t y = top; y < bottom; y++) memset(masked + y * (size_t)width + left, 1, right - left);
}

uint8_t *mask_make(const Mask *mask, int width, int height, const char *path, Error *error) {
    uint8_t *masked = calloc((size_t)width * (size_t)height, 1);
    if (masked == NULL) error_memory(error, path);
    for (int i = 0; masked != NULL && i < mask->count; i++) {
        const MaskPart *part = &mask->parts[i];
        if (part->picture == NULL)
            mark_rectangle(part, width, height, masked);
        else if (part->picture->width == width && part->picture->height == height)
            mark_picture(part->picture, masked);
        else {
            error_input(error, part->path, "the mask has %d x %d pixels, but %s has %d x %d", part->picture->width,
                        part->picture->height, path, width, height);
            free(masked);
            return NULL;
        }
    }
    return masked;
}

void image_copy_masked(const Image *expected, Image *actual, const uint8_t *masked) {
    size_t pixels = (size_t)expected->width * (size_t)expected->height;
    for (size_t i = 0; masked != NULL && i < pixels; i++)
        if (masked[i] != 0) memcpy(actual->pixels + 4 * i, expected->pixels + 4 * i, 4);
}
