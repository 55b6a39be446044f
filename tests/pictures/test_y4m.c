/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pictures as y4m against BT.709 in closed form. */
#include "made.h"
#include "files.h"

#include "pictures/render.h"

#include <fcntl.h>

enum { HEADER_MOST = 128, LARGEST = 1 << 18 };

/* Writes the opaque pixels[width * height], 0xRRGGBB, as a video of one picture; returns the malloc'ed stream. */
static char *stream_of(const uint32_t *pixels, int width, int height, double rate, size_t *size) {
    Error error = {0};
    Image *image = image_sized(width, height);
    for (int i = 0; i < width * height; i++)
        for (int c = 0; c < 4; c++) image->pixels[4 * i + c] = (uint8_t)(c < 3 ? pixels[i] >> (16 - 8 * c) : 255);
    const char *png = temporary_path("frame_000000.png"), *path = temporary_path("video.y4m");
    assert_ok(image_write_png(image, png, NULL, 0, &error), error);
    image_destroy(image);
    const VideoOptions options = {.directory = temporary_folder, .frame_rate = rate, .path = path};
    const int file = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    assert_true(file >= 0);
    assert_ok(video_write_y4m(&options, file, NULL, &error), error);
    close(file);
    return read_whole(path, size);
}

/* The planes of such a picture: Y[count], Cb[count], Cr[count]. */
static void convert(const uint32_t *pixels, int count, uint8_t *planes) {
    size_t size;
    FREED char *stream = stream_of(pixels, count, 1, 60, &size);
    const char *frame = strchr(stream, '\n') + 1;
    assert_memory_equal(frame, "FRAME\n", 6);
    assert_int_equal(size, (size_t)(frame - stream) + 6 + 3 * (size_t)count);
    memcpy(planes, frame + 6, 3 * (size_t)count);
}

/* ITU-R BT.709-6, item 3.2 to 3.5. */
TEST(every_value_is_the_nearest) {
    enum { COUNT = 16 * 52 };
    uint32_t pixels[COUNT];
    uint8_t planes[3 * COUNT];
    for (int r = 0; r < 256; r += 15) {
        for (int i = 0; i < COUNT; i++) pixels[i] = (uint32_t)(r << 16 | i / 52 * 17 << 8 | i % 52 * 5);
        convert(pixels, COUNT, planes);
        for (int i = 0; i < COUNT; i++) {
            const int g = i / 52 * 17, b = i % 52 * 5;
            const double light = (0.2126 * r + 0.7152 * g + 0.0722 * b) / 255;
            assert_near(planes[i], 16 + 219 * light, 0.5 + 1e-9);
            assert_near(planes[COUNT + i], 128 + 224 * (b / 255.0 - light) / 1.8556, 0.5 + 1e-9);
            assert_near(planes[2 * COUNT + i], 128 + 224 * (r / 255.0 - light) / 1.5748, 0.5 + 1e-9);
        }
    }
}

TEST(grey_has_no_colour_and_white_is_235) {
    uint32_t greys[256];
    uint8_t planes[3 * 256];
    for (uint32_t i = 0; i < 256; i++) greys[i] = i * 0x010101;
    convert(greys, 256, planes);
    for (int grey = 0; grey < 256; grey++) {
        assert_true(planes[256 + grey] == 128 && planes[512 + grey] == 128);
        assert_true(planes[grey] >= planes[grey > 0 ? grey - 1 : 0]);
        assert_true((planes[grey] == 16) == (grey == 0) && (planes[grey] == 235) == (grey == 255));
    }
}

/* Red, green and blue, known from test charts. */
TEST(primaries_are_those_of_bt709) {
    uint8_t planes[9];
    convert((const uint32_t[]){0xFF0000, 0x00FF00, 0x0000FF}, 3, planes);
    assert_memory_equal(planes, ((const uint8_t[]){63, 173, 32, 102, 42, 240, 240, 26, 118}), 9);
}

/* A picture of 2 x 3 pixels, blue at (1, 1). */
TEST(planes_follow_each_other_in_rows) {
    size_t size;
    FREED char *stream = stream_of((const uint32_t[]){0, 0, 0, 0x0000FF, 0, 0}, 2, 3, 60, &size);
    assert_memory_equal(
        stream + size - 18,
        ((const uint8_t[]){16, 16, 16, 32, 16, 16, 128, 128, 128, 240, 128, 128, 128, 128, 128, 118, 128, 128}), 18);
}

TEST(the_header_has_the_rate_as_a_fraction) {
    static const struct {
        double rate;
        const char *text;
    } cases[] = {{1 / (double)(1.0F / 60), "60:1"}, {59.94, "2997:50"}, {0.5, "1:2"}};
    for (int i = 0; i < 3; i++) {
        char expected[HEADER_MOST];
        size_t size;
        FREED char *stream = stream_of((const uint32_t[]){0, 0}, 2, 1, cases[i].rate, &size);
        snprintf(expected, sizeof expected, "YUV4MPEG2 W2 H1 F%s Ip A1:1 C444 XCOLORRANGE=LIMITED\nFRAME\n",
                 cases[i].text);
        assert_memory_equal(stream, expected, strlen(expected));
    }
}

RUN_TESTS(NULL, NULL)
