/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rows of two pictures from the first difference to the last, kept while the pictures are read row by row. */
#include "pixels/png.h"
#include "regression/compare.h"
#include "regression/content.h"

#include <stdlib.h>
#include <string.h>

enum { PART = 4, BYTES_MAX = 1 << 24 };

void content_band_begin(ContentBand *band, int width, int height) {
    const int64_t row = 2 * 4 * (int64_t)width, bytes = row * height / PART;
    *band = (ContentBand){.width = width, .capacity = (int)((bytes < BYTES_MAX ? bytes : BYTES_MAX) / row)};
}

static bool make_room(ContentBand *band) {
    const size_t bytes = 4 * (size_t)band->width * (size_t)(band->capacity + CONTENT_MARGIN);
    for (int i = 0; i < 2; i++)
        if (band->rows[i] == NULL && (band->rows[i] = malloc(bytes)) == NULL) return false;
    return true;
}

/* Before a difference, the oldest row makes room. */
static void drop_first(ContentBand *band) {
    const size_t row = 4 * (size_t)band->width;
    for (int i = 0; i < 2; i++) memmove(band->rows[i], band->rows[i] + row, (size_t)(band->count - 1) * row);
    band->first++;
    band->count--;
}

/* Where nearly everything differs, there is no ground to keep. */
static bool is_filled(const ContentBand *band, int64_t pixels) {
    enum { ROWS = 32 };
    return band->count >= ROWS && 4 * pixels > 3 * (int64_t)band->count * band->width;
}

bool content_band_add(ContentBand *band, int y, const uint8_t *a, const uint8_t *b, int64_t pixels) {
    const size_t row = 4 * (size_t)band->width;
    const bool differs = pixels > band->pixels;
    band->pixels = pixels;
    if (band->lost) return true;
    if (band->count > 0 && y != band->first + band->count) {
        band->closed = band->differs;
        if (!band->differs) band->count = 0;
    }
    if (!band->differs && !differs && band->count == CONTENT_MARGIN) drop_first(band);
    const bool full = is_filled(band, pixels) || band->count >= band->capacity;
    const bool ground = !differs && band->below < CONTENT_MARGIN; /* of the last rows that differ */
    if (band->closed || (full && !ground)) {
        band->closed = true;
        band->lost = differs;
        return true;
    }
    if (!make_room(band)) return false;
    if (band->count == 0) band->first = y;
    memcpy(band->rows[0] + (size_t)band->count * row, a, row);
    memcpy(band->rows[1] + (size_t)band->count * row, b, row);
    band->count++;
    band->differs |= differs;
    band->below = differs ? 0 : band->below + 1;
    return true;
}

Image content_band_rows(const ContentBand *band, int picture) {
    return (Image){.width = band->width, .height = band->count, .pixels = band->rows[picture]};
}

void content_band_end(ContentBand *band) {
    for (int i = 0; i < 2; i++) free(band->rows[i]);
}
