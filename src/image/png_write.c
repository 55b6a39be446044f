/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writing PNG files: into memory first, so that the file appears whole. */
#include "common/array.h"
#include "common/file.h"
#include "image/image.h"

#include <png.h>
#include <stdlib.h>
#include <string.h>

/* All that the encoder changes lies here and not in locals, which longjmp would clobber. */
typedef struct Encoder {
    png_structp png;
    png_infop info;
    uint8_t *data;
    size_t size, capacity;
    char problem[256];
} Encoder;

static void append(png_structp png, png_bytep data, size_t size) {
    Encoder *encoder = png_get_io_ptr(png);
    if (!array_reserve((void **)&encoder->data, &encoder->capacity, encoder->size + size, 1))
        png_error(png, "out of memory");
    memcpy(encoder->data + encoder->size, data, size);
    encoder->size += size;
}

static void flush(png_structp png) { (void)png; }

static PNG_FUNCTION(void, fail, (png_structp png, png_const_charp message), PNG_NORETURN) {
    Encoder *encoder = png_get_error_ptr(png);
    snprintf(encoder->problem, sizeof encoder->problem, "%s", message);
    png_longjmp(png, 1);
}

static void ignore_warning(png_structp png, png_const_charp message) { (void)png, (void)message; }

static void set_texts(Encoder *encoder, const ImageText *texts, int count) {
    for (int i = 0; i < count; i++) {
        png_text text = {.compression = PNG_ITXT_COMPRESSION_NONE,
                         .key = (png_charp)texts[i].key,
                         .text = (png_charp)texts[i].value};
        png_set_text(encoder->png, encoder->info, &text, 1);
    }
}

static bool encode(Encoder *encoder, const Image *image, const ImageText *texts, int count) {
    if (setjmp(png_jmpbuf(encoder->png)) != 0) return false;
    png_structp png = encoder->png;
    png_set_write_fn(png, encoder, append, flush);
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    /* On flat pictures no filter and the fastest level lose little size and win most of the time. */
    png_set_compression_level(png, 1);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
    png_set_IHDR(png, encoder->info, (png_uint_32)image->width, (png_uint_32)image->height, 8, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    set_texts(encoder, texts, count);
    png_write_info(png, encoder->info);
    png_set_filler(png, 0, PNG_FILLER_AFTER);
    for (int y = 0; y < image->height; y++) png_write_row(png, image->pixels + (size_t)y * (size_t)image->width * 4);
    png_write_end(png, NULL);
    return true;
}

bool image_write_png(const Image *image, const char *path, const ImageText *texts, int count, Error *error) {
    Encoder encoder = {0};
    encoder.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &encoder, fail, ignore_warning);
    if (encoder.png != NULL) encoder.info = png_create_info_struct(encoder.png);
    bool ok = encoder.info != NULL || error_memory(error, path);
    if (ok && !encode(&encoder, image, texts, count)) ok = error_system(error, path, "%s", encoder.problem);
    png_destroy_write_struct(&encoder.png, &encoder.info);
    ok = ok && file_write(path, encoder.data, encoder.size, error);
    free(encoder.data);
    return ok;
}
