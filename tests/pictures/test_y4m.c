/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The conversion against BT.709 in closed form. */
#include "testing.h"

#include "pictures/render_internal.h"

#include <math.h>

static void convert(const uint8_t rgb[3], uint8_t yuv[3]) {
    uint8_t pixels[4] = {rgb[0], rgb[1], rgb[2], 255}, frame[16];
    Image image = {.width = 1, .height = 1, .pixels = pixels};
    y4m_frame(&image, frame);
    assert_memory_equal(frame, "FRAME\n", 6);
    memcpy(yuv, frame + 6, 3);
}

/* ITU-R BT.709-6, item 3.2 to 3.5. */
static void every_value_is_the_nearest(void **state) {
    (void)state;
    for (int r = 0; r < 256; r += 15)
        for (int g = 0; g < 256; g += 17)
            for (int b = 0; b < 256; b += 5) {
                uint8_t rgb[3] = {(uint8_t)r, (uint8_t)g, (uint8_t)b}, yuv[3];
                double light = (0.2126 * r + 0.7152 * g + 0.0722 * b) / 255;
                convert(rgb, yuv);
                assert_near(yuv[0], 16 + 219 * light, 0.5 + 1e-9);
                assert_near(yuv[1], 128 + 224 * (b / 255.0 - light) / 1.8556, 0.5 + 1e-9);
                assert_near(yuv[2], 128 + 224 * (r / 255.0 - light) / 1.5748, 0.5 + 1e-9);
            }
}

static void grey_has_no_colour_and_white_is_235(void **state) {
    (void)state;
    for (int grey = 0, before = 15; grey < 256; grey++) {
        uint8_t yuv[3];
        convert((const uint8_t[]){(uint8_t)grey, (uint8_t)grey, (uint8_t)grey}, yuv);
        assert_true(yuv[1] == 128 && yuv[2] == 128 && yuv[0] >= before);
        assert_true((yuv[0] == 16) == (grey == 0) && (yuv[0] == 235) == (grey == 255));
        before = yuv[0];
    }
}

/* Known from test charts. */
static void primaries_are_those_of_bt709(void **state) {
    (void)state;
    static const uint8_t cases[][2][3] = {
        {{255, 0, 0}, {63, 102, 240}}, {{0, 255, 0}, {173, 42, 26}}, {{0, 0, 255}, {32, 240, 118}}};
    for (int i = 0; i < 3; i++) {
        uint8_t yuv[3];
        convert(cases[i][0], yuv);
        assert_memory_equal(yuv, cases[i][1], 3);
    }
}

static void planes_follow_each_other(void **state) {
    (void)state;
    uint8_t pixels[2 * 3 * 4] = {0}, frame[6 + 18];
    Image image = {.width = 2, .height = 3, .pixels = pixels};
    pixels[4 * 3 + 2] = 255; /* blue at (1, 1) */
    assert_int_equal(y4m_frame_size(2, 3), sizeof frame);
    y4m_frame(&image, frame);
    assert_memory_equal(frame + 6, ((const uint8_t[]){16, 16, 16, 32, 16, 16}), 6);
    assert_memory_equal(frame + 12, ((const uint8_t[]){128, 128, 128, 240, 128, 128}), 6);
    assert_memory_equal(frame + 18, ((const uint8_t[]){128, 128, 128, 118, 128, 128}), 6);
}

static void the_header_has_the_rate_as_a_fraction(void **state) {
    (void)state;
    static const struct {
        double rate;
        const char *text;
    } cases[] = {{1 / (double)(1.0F / 60), "YUV4MPEG2 W192 H108 F60:1 Ip A1:1 C444 XCOLORRANGE=LIMITED\n"},
                 {59.94, "YUV4MPEG2 W192 H108 F2997:50 Ip A1:1 C444 XCOLORRANGE=LIMITED\n"},
                 {0.5, "YUV4MPEG2 W192 H108 F1:2 Ip A1:1 C444 XCOLORRANGE=LIMITED\n"}};
    for (int i = 0; i < 3; i++) {
        char header[Y4M_HEADER_SIZE];
        y4m_header(header, 192, 108, cases[i].rate);
        assert_string_equal(header, cases[i].text);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_value_is_the_nearest),
        cmocka_unit_test(grey_has_no_colour_and_white_is_235),
        cmocka_unit_test(primaries_are_those_of_bt709),
        cmocka_unit_test(planes_follow_each_other),
        cmocka_unit_test(the_header_has_the_rate_as_a_fraction),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
