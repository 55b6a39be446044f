/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a file says of how its picture is shown, beside the pixels: colours, profile, orientation, resolution. */
#include "regression/png_display.h"

#include "base/base.h"
#include "pixels/png.h"

#include <stdio.h>
#include <stdlib.h>
#include <zlib.h>

enum { CICP, ICCP, SRGB, GAMA, CHRM, EXIF, MDCV, CLLI, SBIT, BKGD, PHYS, KINDS };
static const char *const types[KINDS] = {"cICP", "iCCP", "sRGB", "gAMA", "cHRM", "eXIf",
                                         "mDCV", "cLLI", "sBIT", "bKGD", "pHYs"};

/* The chunks of a file; length 0: none. */
typedef struct Chunks {
    PngChunk kinds[KINDS];
} Chunks;

static Chunks find_chunks(const uint8_t *file, size_t size) {
    Chunks chunks = {.kinds = {{0}}};
    PngChunk chunk;
    for (size_t at = PNG_SIGNATURE; png_chunk_next(file, size, &at, &chunk) && !png_chunk_is(&chunk, "IEND");)
        for (int i = 0; i < KINDS; i++)
            if (png_chunk_is(&chunk, types[i])) chunks.kinds[i] = chunk;
    return chunks;
}

static unsigned tiff_number(const uint8_t *bytes, int count, bool little) {
    unsigned value = 0;
    for (int i = 0; i < count; i++) value |= (unsigned)bytes[i] << 8 * (little ? i : count - 1 - i);
    return value;
}

/* 1 to 8 as in Exif 2.3, section 4.6.4; 1, upright, also for anything else. */
static int orientation(const PngChunk *exif) {
    enum { HEAD = 8, ENTRY = 12, TAG = 0x0112 };
    const uint8_t *data = exif->data;
    if (exif->length < HEAD) return 1;
    bool little = data[0] == 'I';
    size_t at = tiff_number(data + 4, 4, little);
    if (at > exif->length - 2) return 1;
    unsigned count = tiff_number(data + at, 2, little);
    for (at += 2; count > 0 && at + ENTRY <= exif->length; count--, at += ENTRY)
        if (tiff_number(data + at, 2, little) == TAG) {
            int value = (int)tiff_number(data + at + 8, 2, little);
            return value >= 1 && value <= 8 ? value : 1;
        }
    return 1;
}

static bool same_bytes(const uint8_t *a, size_t a_size, const uint8_t *b, size_t b_size) {
    return a_size == b_size && (a_size == 0 || memcmp(a, b, a_size) == 0);
}

enum { PROFILE_MAX = 1 << 22 }; /* bytes; those in use have less than 1 MiB */

/* The uncompressed profile (malloc'ed); NULL if it is damaged or too large, or with error set when memory is short. */
static uint8_t *inflate_profile(const PngChunk *iccp, size_t *size, Error *error) {
    const uint8_t *end = memchr(iccp->data, '\0', iccp->length); /* of the name; then follows the method */
    if (end == NULL || iccp->length - (size_t)(end - iccp->data) < 2) return NULL;
    uint8_t *profile = malloc(PROFILE_MAX);
    uLongf length = PROFILE_MAX;
    uLong compressed = (uLong)(iccp->length - (size_t)(end - iccp->data) - 2);
    const int status = profile != NULL ? uncompress(profile, &length, end + 2, compressed) : Z_MEM_ERROR;
    if (status == Z_MEM_ERROR) error_memory(error, "image");
    if (status == Z_OK) {
        *size = length;
        return profile;
    }
    free(profile);
    return NULL;
}

static bool same_profile(const PngChunk *a, const PngChunk *b, Error *error) {
    if (same_bytes(a->data, a->length, b->data, b->length)) return true;
    if (a->length == 0 || b->length == 0) return false;
    size_t a_size = 0, b_size = 0;
    uint8_t *first = inflate_profile(a, &a_size, error), *second = inflate_profile(b, &b_size, error);
    bool same = first != NULL && second != NULL && same_bytes(first, a_size, second, b_size);
    free(first);
    free(second);
    return same;
}

typedef struct Value {
    char text[24];
} Value;

static Value value_of(int kind, const PngChunk *chunk) {
    Value value = {"none"};
    if (kind == EXIF)
        snprintf(value.text, sizeof value.text, "%d", orientation(chunk));
    else if (kind == GAMA && chunk->length == 4)
        snprintf(value.text, sizeof value.text, "%.6g", png_number(chunk->data) / 100000.0);
    else if (kind == SRGB && chunk->length == 1)
        snprintf(value.text, sizeof value.text, "%d", chunk->data[0]);
    else if (chunk->length > 0)
        strcpy(value.text, "set");
    return value;
}

bool png_display_compare(const uint8_t *a, size_t a_size, const uint8_t *b, size_t b_size, PngDisplay *display,
                         Error *error) {
    Chunks first = find_chunks(a, a_size), second = find_chunks(b, b_size);
    display->text[0] = '\0';
    for (int i = 0; i < KINDS; i++) {
        const PngChunk *x = &first.kinds[i], *y = &second.kinds[i];
        const bool alike = i == ICCP   ? same_profile(x, y, error)
                           : i == EXIF ? orientation(x) == orientation(y)
                                       : same_bytes(x->data, x->length, y->data, y->length);
        if (alike) continue;
        const char *name = i == EXIF ? "orientation" : types[i];
        const Value of_x = value_of(i, x), of_y = value_of(i, y);
        if (strcmp(of_x.text, of_y.text) == 0) /* chunks without a short value */
            text_join(display->text, sizeof display->text, ", ", "%s differs", name);
        else
            text_join(display->text, sizeof display->text, ", ", "%s %s and %s", name, of_x.text, of_y.text);
    }
    return error->kind == ERROR_NONE;
}
