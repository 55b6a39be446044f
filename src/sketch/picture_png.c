/* SPDX-License-Identifier: GPL-3.0-or-later */
/* PNG with alpha and resolution, which frames do not need. */
#include "sketch/sketch_formats.h"

#include "common/memory_stream.h"

#include <math.h>
#include <png.h>
#include <stdlib.h>

static void write_rows(png_structp png, const Image *image, bool alpha) {
    if (!alpha) png_set_filler(png, 0, PNG_FILLER_AFTER);
    for (int y = 0; y < image->height; y++) png_write_row(png, image->pixels + (size_t)y * (size_t)image->width * 4);
}

/* libpng returns here by longjmp if it fails. */
static bool write_png(FILE *file, const Image *image, double dpi, bool drawn) {
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png != NULL ? png_create_info_struct(png) : NULL;
    const bool alpha = has_alpha(image);
    if (info == NULL || setjmp(png_jmpbuf(png))) {
        png_destroy_write_struct(&png, &info);
        return false;
    }
    png_init_io(png, file);
    png_set_compression_level(png, 9);
    if (drawn) png_set_filter(png, 0, PNG_FILTER_NONE);
    png_set_IHDR(png, info, (png_uint_32)image->width, (png_uint_32)image->height, 8,
                 alpha ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    const png_uint_32 dots = (png_uint_32)lrint(dpi / 0.0254);
    if (dpi > 0) png_set_pHYs(png, info, dots, dots, PNG_RESOLUTION_METER);
    png_write_info(png, info);
    write_rows(png, image, alpha);
    png_write_end(png, NULL);
    png_destroy_write_struct(&png, &info);
    return true;
}

char *picture_as_png(const Image *image, double dpi, bool drawn, size_t *size, Error *error) {
    char *data = NULL;
    FILE *file = memory_stream(&data, size);
    bool whole = file != NULL && write_png(file, image, dpi, drawn) && !ferror(file);
    if (file != NULL) whole = fclose(file) == 0 && whole;
    if (whole) return data;
    free(data);
    error_memory(error, "figure");
    return NULL;
}
