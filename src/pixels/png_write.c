/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes PNG files: pictures with libpng, whose pixels are compressed by libpng or by png_idat.c; and files of few
   colours. */
#include "base/base.h"
#include "base/file.h"
#include "pixels/pixels_internal.h"
#include "pixels/png.h"

#include <png.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { IDAT_PART = 1 << 15 }; /* bytes */

/* Everything that encoding modifies is in this struct, as longjmp would clobber locals. */
struct PngEncoder {
    int width, height;
    Idat *idat; /* NULL: libpng compresses */
    png_structp png;
    png_infop info;
    uint8_t *data;
    size_t size, capacity;
    bool memory_short; /* also of libpng (png_memory_take) */
    char problem[256];
};

PngEncoder *png_encoder_create(int width, int height, PngEffort effort, Error *error) {
    PngEncoder *encoder = calloc(1, sizeof *encoder);
    if (encoder == NULL) return error_memory(error, "image"), NULL;
    *encoder = (PngEncoder){.width = width, .height = height};
    if (effort == PNG_SMALL || (encoder->idat = idat_create(width, height, error)) != NULL) return encoder;
    png_encoder_destroy(encoder);
    return NULL;
}

void png_encoder_destroy(PngEncoder *encoder) {
    if (encoder == NULL) return;
    idat_destroy(encoder->idat);
    free(encoder->data);
    free(encoder);
}

static void png_write_append(png_structp png, png_bytep data, size_t size) {
    PngEncoder *encoder = png_get_io_ptr(png);
    encoder->memory_short = !array_reserve((void **)&encoder->data, &encoder->capacity, encoder->size + size, 1);
    if (encoder->memory_short) png_error(png, "out of memory");
    memcpy(encoder->data + encoder->size, data, size);
    encoder->size += size;
}

static void flush_png_write(png_structp png) { (void)png; }

static PNG_FUNCTION(void, fail, (png_structp png, png_const_charp message), PNG_NORETURN) {
    PngEncoder *encoder = png_get_error_ptr(png);
    snprintf(encoder->problem, sizeof encoder->problem, "%s", message);
    png_longjmp(png, 1);
}

static void ignore_warning(png_structp png, png_const_charp message) { (void)png, (void)message; }

static void set_texts(PngEncoder *encoder, const ImageText *texts, int count) {
    for (int i = 0; i < count; i++) {
        png_text text = {.compression = PNG_ITXT_COMPRESSION_NONE,
                         .key = (png_charp)texts[i].key,
                         .text = (png_charp)texts[i].value};
        png_set_text(encoder->png, encoder->info, &text, 1);
    }
}

static void write_rows(png_structp png, const Image *image) {
    png_set_filler(png, 0, PNG_FILLER_AFTER);
    for (int y = 0; y < image->height; y++) png_write_row(png, image->pixels + (size_t)y * (size_t)image->width * 4);
    png_write_end(png, NULL);
}

/* Split, as decoders refuse an IDAT chunk larger than the picture, which noise would produce. */
static void write_chunks(png_structp png, const uint8_t *pixels, size_t size) {
    for (size_t at = 0; at < size; at += IDAT_PART)
        png_write_chunk(png, (png_const_bytep) "IDAT", pixels + at, size - at < IDAT_PART ? size - at : IDAT_PART);
    png_write_chunk(png, (png_const_bytep) "IEND", NULL, 0);
}

/* pixels NULL: libpng compresses the image. */
static bool write_file(PngEncoder *encoder, const Image *image, const ImageText *texts, int count,
                       const uint8_t *pixels, size_t pixels_size) {
    if (setjmp(png_jmpbuf(encoder->png)) != 0) return false;
    png_structp png = encoder->png;
    png_set_write_fn(png, encoder, png_write_append, flush_png_write);
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_compression_level(png, 9);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_ALL_FILTERS);
    png_set_IHDR(png, encoder->info, (png_uint_32)image->width, (png_uint_32)image->height, 8, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    set_texts(encoder, texts, count);
    png_write_info(png, encoder->info);
    if (pixels == NULL)
        write_rows(png, image);
    else
        write_chunks(png, pixels, pixels_size);
    return true;
}

bool png_encode(PngEncoder *encoder, const Image *image, const bool *changed, const ImageText *texts, int count,
                const uint8_t **data, size_t *size, Error *error) {
    const uint8_t *pixels = NULL;
    size_t pixels_size = 0;
    if (encoder->idat != NULL && !idat_encode(encoder->idat, image, changed, &pixels, &pixels_size, error))
        return false;
    encoder->size = 0;
    encoder->memory_short = false;
    encoder->png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, encoder, fail, ignore_warning,
                                             &encoder->memory_short, png_memory_take, png_memory_release);
    encoder->info = encoder->png == NULL ? NULL : png_create_info_struct(encoder->png);
    bool ok = encoder->info != NULL || error_memory(error, "image");
    if (ok && !write_file(encoder, image, texts, count, pixels, pixels_size))
        ok =
            encoder->memory_short ? error_memory(error, "image") : error_system(error, "image", "%s", encoder->problem);
    png_destroy_write_struct(&encoder->png, &encoder->info);
    *data = encoder->data;
    *size = encoder->size;
    return ok;
}

bool image_write_png(const Image *image, const char *path, const ImageText *texts, int count, Error *error) {
    const uint8_t *data;
    size_t size;
    PngEncoder *encoder = png_encoder_create(image->width, image->height, PNG_FAST, error);
    bool ok = encoder != NULL && png_encode(encoder, image, NULL, texts, count, &data, &size, error) &&
              file_write(path, data, size, error);
    png_encoder_destroy(encoder);
    return ok;
}

/* A file of few colours, written row by row with zlib. */

enum { IHDR_SIZE = 13, DEPTH = 8 };

struct IndexedPng {
    int width;
    z_stream stream;
    uint8_t *file;
    size_t size, capacity;
    uint8_t part[IDAT_PART]; /* of the compressed pixels */
    uint8_t row[];           /* [1 + width]: PNG's mark of an unfiltered row, 0, and the pixels */
};

static void put_number(uint8_t *to, uint32_t value) {
    for (int i = 0; i < 4; i++) to[i] = (uint8_t)(value >> (24 - 8 * i));
}

/* Length, type, data, CRC of type and data. */
static bool put_chunk(IndexedPng *png, const char *type, const uint8_t *data, size_t size, Error *error) {
    if (!array_reserve((void **)&png->file, &png->capacity, png->size + size + PNG_CHUNK_FRAME, 1))
        return error_memory(error, "image");
    uint8_t *to = png->file + png->size;
    put_number(to, (uint32_t)size);
    memcpy(to + 4, type, 4);
    if (size > 0) memcpy(to + 8, data, size);
    put_number(to + 8 + size, (uint32_t)crc32_z(0, to + 4, size + 4));
    png->size += size + PNG_CHUNK_FRAME;
    return true;
}

static bool put_start(IndexedPng *png, int height, const Palette *palette, Error *error) {
    uint8_t header[IHDR_SIZE] = {[8] = DEPTH, [9] = PNG_PALETTE};
    put_number(header, (uint32_t)png->width);
    put_number(header + 4, (uint32_t)height);
    if (!array_reserve((void **)&png->file, &png->capacity, PNG_SIGNATURE, 1)) return error_memory(error, "image");
    memcpy(png->file, png_signature, PNG_SIGNATURE);
    png->size = PNG_SIGNATURE;
    return put_chunk(png, "IHDR", header, sizeof header, error) &&
           put_chunk(png, "PLTE", palette->rgb[0], 3 * (size_t)palette->count, error) &&
           (!palette->clear || put_chunk(png, "tRNS", &(uint8_t){0}, 1, error));
}

IndexedPng *indexed_png_create(int width, int height, const Palette *palette, Error *error) {
    enum { LEVEL = 3 }; /* from 4 on, time doubles for a tenth of the bytes */
    IndexedPng *png = calloc(1, sizeof *png + (size_t)width + 1);
    if (png == NULL || deflateInit(&png->stream, LEVEL) != Z_OK) {
        free(png);
        error_memory(error, "image");
        return NULL;
    }
    png->width = width;
    png->stream.next_out = png->part, png->stream.avail_out = IDAT_PART;
    if (put_start(png, height, palette, error)) return png;
    indexed_png_destroy(png);
    return NULL;
}

void indexed_png_destroy(IndexedPng *png) {
    if (png == NULL) return;
    deflateEnd(&png->stream);
    free(png->file);
    free(png);
}

uint8_t *indexed_png_row(IndexedPng *png) { return png->row + 1; }

/* Each full part becomes a chunk: decoders refuse an IDAT chunk that is larger than the picture. */
static bool put_part(IndexedPng *png, Error *error) {
    if (!put_chunk(png, "IDAT", png->part, IDAT_PART - png->stream.avail_out, error)) return false;
    png->stream.next_out = png->part, png->stream.avail_out = IDAT_PART;
    return true;
}

bool indexed_png_add(IndexedPng *png, Error *error) {
    png->stream.next_in = png->row, png->stream.avail_in = (uInt)png->width + 1;
    do {
        deflate(&png->stream, Z_NO_FLUSH);
        if (png->stream.avail_out == 0 && !put_part(png, error)) return false;
    } while (png->stream.avail_in > 0);
    return true;
}

uint8_t *indexed_png_end(IndexedPng *png, size_t *size, Error *error) {
    for (bool ended = false; !ended;) {
        ended = deflate(&png->stream, Z_FINISH) == Z_STREAM_END;
        if (!put_part(png, error)) return NULL;
    }
    if (!put_chunk(png, "IEND", NULL, 0, error)) return NULL;
    uint8_t *file = png->file;
    *size = png->size;
    png->file = NULL;
    return file;
}
