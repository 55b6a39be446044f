/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A file that claims more pixels than its bytes can hold is refused before memory is allocated for them. */
#include "testing.h"

#include "pixels/png.h"
#include "pixels/pixels_internal.h"
#include "png_parts.h"

enum { SIDE = 9000 }; /* 81 million pixels: less than IMAGE_MAX_PIXELS */

static void claim(PngParts *file, int color) {
    uint8_t compressed[256];
    const size_t size = compress_zeros(compressed, sizeof compressed, 1000);
    put_header(file, SIDE, SIDE, 8, color);
    put_chunk(file, "IDAT", compressed, size);
    put_chunk(file, "IEND", NULL, 0);
}

TEST(too_few_bytes_are_refused_first) {
    PngParts file;
    for (int color = 0; color <= 6; color += 2) {
        Image *image = NULL;
        claim(&file, color);
        assert_false(png_fast_decode(file.data, file.size, IMAGE_MAX_PIXELS, &image));
        assert_refused(image_decode_png(file.data, file.size, "claim.png", IMAGE_MAX_PIXELS, &error),
                       "claim.png: error: not a PNG file, or damaged: too few bytes for its pixels");
    }
}

RUN_TESTS(NULL, NULL)
