/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pictures: files of any bytes with valid checksums; pixels of any bytes in valid files. The decoder of twinbox and
   libpng must agree. */
#include "fuzz_png.h"
#include "fuzz.h"

#include "pixels/png.h"
#include "regression/png_display.h"
#include "pixels/pixels_internal.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* Of a picture here: 4 bytes for each in memory, 12 with 16 bits per channel. */
enum { MOST_PIXELS = 1 << 21 };

static void put_number(uint8_t *bytes, uint32_t value) {
    for (int i = 0; i < 4; i++) bytes[i] = (uint8_t)(value >> (24 - 8 * i));
}

void png_repair(uint8_t *file, size_t size) {
    PngChunk chunk;
    for (size_t at = PNG_SIGNATURE; png_chunk_next(file, size, &at, &chunk);)
        put_number(file + at - 4, (uint32_t)crc32(0, chunk.type, (uInt)(chunk.length + 4)));
}

static bool same(const Image *a, const Image *b) {
    const size_t samples = (size_t)a->width * (size_t)a->height * 4;
    return a->width == b->width && a->height == b->height && memcmp(a->pixels, b->pixels, samples) == 0 &&
           (a->pixels16 == NULL) == (b->pixels16 == NULL) &&
           (a->pixels16 == NULL || memcmp(a->pixels16, b->pixels16, 2 * samples) == 0);
}

/* The check without decompression refuses nothing that can be decoded, and knows the size. */
static void check_agreement(const uint8_t *data, size_t size, const Image *image) {
    int width = 0, height = 0;
    Error error = {0};
    const bool checked = FUZZ_READ(png_check(data, size, "picture.png", &width, &height, &error), "picture.png");
    if (image == NULL) return;
    if (!checked) fuzz_fail("the check refuses a picture that is decoded: %s", error.message);
    if (width != image->width || height != image->height) fuzz_fail("the check gives another size");
}

static void decode(const uint8_t *data, size_t size) {
    Image *fast = NULL;
    Error error = {0};
    Image *image = FUZZ_READ(png_libpng_decode(data, size, "picture.png", MOST_PIXELS, &error), "picture.png");
    fuzz_begin();
    const bool decoded = png_fast_decode(data, size, MOST_PIXELS, &fast);
    fuzz_end(true, &(Error){0}, "");
    if (decoded && image == NULL) fuzz_fail("libpng refuses what the fast decoder accepts: %s", error.message);
    if (decoded && !same(image, fast)) fuzz_fail("the decoders differ");
    check_agreement(data, size, image);
    if (decoded) image_destroy(fast);
    image_destroy(image);
}

/* A picture is displayed as itself. */
static void check_display(const uint8_t *data, size_t size) {
    PngDisplay display;
    Error error = {0};
    (void)FUZZ_READ(png_display_compare(data, size, data, size, &display, &error), NULL);
    if (display.text[0] != '\0') fuzz_fail("a picture is displayed as another: %s", display.text);
}

/* A pair of a picture and itself is equal; the texts of a picture are found or not. */
static void read_others(const uint8_t *data, size_t size) {
    const uint8_t *const files[2] = {data, data};
    const char *const paths[2] = {"picture.png", "picture.png"};
    char value[64];
    Image *images[2] = {NULL, NULL};
    Error error = {0};
    const bool ok = FUZZ_READ(image_decode_png_pair(files, (size_t[]){size, size}, paths, MOST_PIXELS, images, &error),
                              "picture.png");
    if (ok && !same(images[0], images[1])) fuzz_fail("a picture differs from itself");
    if (ok) check_display(data, size);
    image_destroy_pair(images);
    error = (Error){0};
    fuzz_begin();
    const bool found = image_find_text(data, size, "Frame", value, sizeof value, &error);
    fuzz_end(true, &error, "");
    if (!found || memchr(value, '\0', sizeof value) == NULL) fuzz_fail("a text without an end");
}

void fuzz_png(const uint8_t *data, size_t size) {
    uint8_t *file = malloc(size + 1);
    if (file == NULL) return;
    if (size > 0) memcpy(file, data, size);
    png_repair(file, size);
    if (png_check_start(file, size, "picture.png", &(Error){0})) {
        decode(file, size);
        read_others(file, size);
    }
    free(file);
}

typedef struct Builder {
    uint8_t *bytes;
    size_t size;
} Builder;

static void put_chunk(Builder *file, const char *type, const uint8_t *data, size_t size) {
    uint8_t *chunk = file->bytes + file->size;
    put_number(chunk, (uint32_t)size);
    memcpy(chunk + 4, type, 4);
    if (size > 0) memcpy(chunk + 8, data, size);
    put_number(chunk + 8 + size, (uint32_t)crc32(0, chunk + 4, (uInt)(size + 4)));
    file->size += size + PNG_CHUNK_FRAME;
}

enum { HEAD = 8, PALETTE = 48, EXTRA = 32, COPIES = 64 };

/* The head: width, height, depth, colour, interlacing, level of compression, which chunks, in how many parts; then
   maybe a palette and transparency; the rest are filtered rows, repeated. */
static size_t build(const uint8_t *data, size_t size, uint8_t *out, size_t room) {
    static uint8_t rows[1 << 18];
    const uint8_t *head = data, *more = data + HEAD;
    Builder file = {out, 0};
    memcpy(out, "\x89PNG\r\n\x1a\n", 8);
    file.size = 8;
    const uint8_t header[13] = {[3] = (uint8_t)(1 + head[0] % 128),
                                [7] = (uint8_t)(1 + head[1] % 128),
                                head[2],
                                head[3],
                                0,
                                0,
                                (uint8_t)(head[4] % 2)};
    put_chunk(&file, "IHDR", header, sizeof header);
    if ((head[6] & 1) != 0 && size >= HEAD + PALETTE) put_chunk(&file, "PLTE", more, 3 * (size_t)(1 + head[7] % 16));
    if ((head[6] & 2) != 0 && size >= HEAD + EXTRA) put_chunk(&file, "tRNS", more, head[7] % EXTRA);
    if ((head[6] & 4) != 0 && size >= HEAD + EXTRA)
        put_chunk(&file, "tEXt",
                  (const uint8_t *)"Frame\0"
                                   "12",
                  8);
    const size_t count = size - HEAD, copies = (head[6] & 8) != 0 ? COPIES : 1;
    size_t used = 0;
    for (size_t i = 0; i < copies && count > 0 && used + count <= sizeof rows; i++, used += count)
        memcpy(rows + used, more, count);
    uint8_t *packed = malloc(compressBound((uLong)used));
    uLongf length = compressBound((uLong)used);
    if (packed == NULL || compress2(packed, &length, rows, (uLong)used, head[5] % 10) != Z_OK ||
        length + file.size + 200 > room)
        length = 0;
    const size_t half = (head[6] & 16) != 0 ? length / 2 : 0;
    if (half > 0) put_chunk(&file, "IDAT", packed, half);
    put_chunk(&file, "IDAT", packed + half, length - half);
    put_chunk(&file, "IEND", NULL, 0);
    free(packed);
    return file.size;
}

void fuzz_pixels(const uint8_t *data, size_t size) {
    static uint8_t out[1 << 19];
    if (size < HEAD) return;
    const size_t length = build(data, size, out, sizeof out);
    uint8_t *file = malloc(length); /* exactly as long: reading behind it is found */
    if (file == NULL) return;
    memcpy(file, out, length);
    decode(file, length);
    read_others(file, length);
    free(file);
}
