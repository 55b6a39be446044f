/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "image/mask.h"

#include "image/mask_picture.h"

#include <stdlib.h>
#include <string.h>

static bool add(Mask *mask, MaskPart part, Error *error) {
    if (mask->count == MASK_PARTS) return error_input(error, "--mask", "at most %d masks", MASK_PARTS);
    mask->parts[mask->count++] = part;
    return true;
}

bool mask_add_rectangle(Mask *mask, int x, int y, int width, int height, Error *error) {
    return add(mask, (MaskPart){.kind = MASK_RECTANGLE, .x = x, .y = y, .width = width, .height = height}, error);
}

bool mask_add_picture(Mask *mask, const char *path, Error *error) {
    MaskPicture *picture = mask_picture_read(path, error);
    if (picture == NULL) return false;
    if (add(mask, (MaskPart){.kind = MASK_PICTURE, .picture = picture}, error)) return true;
    mask_picture_destroy(picture);
    return false;
}

bool mask_add_color(Mask *mask, const uint8_t color[3], Error *error) {
    return add(mask, (MaskPart){.kind = MASK_COLOR, .color = {color[0], color[1], color[2]}}, error);
}

void mask_free(Mask *mask) {
    for (int i = 0; i < mask->count; i++) mask_picture_destroy(mask->parts[i].picture);
    mask->count = 0;
}

static size_t pixel_count(const Image *image) { return (size_t)image->width * (size_t)image->height; }

static void draw_color(const uint8_t color[3], const Image *expected, uint8_t *masked) {
    for (size_t i = 0; i < pixel_count(expected); i++) {
        const uint8_t *p = expected->pixels + 4 * i;
        if (p[0] == color[0] && p[1] == color[1] && p[2] == color[2] && p[3] == 255) masked[i] = IGNORED_MASK;
    }
}

static int64_t clamp(int64_t value, int64_t largest) { return value < 0 ? 0 : value > largest ? largest : value; }

static void draw_rectangle(const MaskPart *part, int width, int height, uint8_t *masked) {
    size_t left = (size_t)clamp(part->x, width), right = (size_t)clamp((int64_t)part->x + part->width, width);
    size_t top = (size_t)clamp(part->y, height), bottom = (size_t)clamp((int64_t)part->y + part->height, height);
    for (size_t y = top; y < bottom; y++) memset(masked + y * (size_t)width + left, IGNORED_MASK, right - left);
}

bool mask_draw(const Mask *mask, const Image *expected, const char *path, uint8_t *masked, Error *error) {
    int width = expected->width, height = expected->height;
    for (int i = 0; i < mask->count; i++) {
        const MaskPart *part = &mask->parts[i];
        switch (part->kind) {
        case MASK_RECTANGLE: draw_rectangle(part, width, height, masked); break;
        case MASK_COLOR: draw_color(part->color, expected, masked); break;
        case MASK_PICTURE:
            if (!mask_picture_draw(part->picture, expected, path, masked, error)) return false;
        }
    }
    return true;
}

void image_copy_masked(const Image *expected, Image *actual, const uint8_t *masked) {
    for (size_t i = 0; masked != NULL && i < pixel_count(expected); i++)
        if (masked[i] != IGNORED_NOT) memcpy(actual->pixels + 4 * i, expected->pixels + 4 * i, 4);
}
