/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "image/flip_color.h"

#include <math.h>
#include <string.h>

/* Linear sRGB to XYZ (IEC 61966-2-1), and the white point. */
static const float to_xyz[3][3] = {{0.41238656f, 0.35759149f, 0.18045049f},
                                   {0.21263682f, 0.71518298f, 0.07218020f},
                                   {0.01933062f, 0.11919716f, 0.95037259f}};
static const FlipColor white = {0.95042854f, 1, 1.08890037f};

/* The inverse of to_xyz. */
static const float to_rgb[3][3] = {{3.24100326f, -1.53739899f, -0.49861587f},
                                   {-0.96922426f, 1.87592999f, 0.04155422f},
                                   {0.05563942f, -0.20401120f, 1.05714897f}};

static FlipColor multiply(const float m[3][3], FlipColor c) {
    return (FlipColor){m[0][0] * c.x + m[0][1] * c.y + m[0][2] * c.z, m[1][0] * c.x + m[1][1] * c.y + m[1][2] * c.z,
                       m[2][0] * c.x + m[2][1] * c.y + m[2][2] * c.z};
}

void flip_make_linear(float linear_of[256]) {
    for (int byte = 0; byte < 256; byte++) {
        float value = (float)byte / 255;
        linear_of[byte] = value <= 0.04045f ? value / 12.92f : powf((value + 0.055f) / 1.055f, 2.4f);
    }
}

static FlipColor rgb_to_opponent(FlipColor rgb) {
    FlipColor c = multiply(to_xyz, rgb);
    c = (FlipColor){c.x / white.x, c.y / white.y, c.z / white.z};
    return (FlipColor){116 * c.y - 16, 500 * (c.x - c.y), 200 * (c.y - c.z)};
}

static FlipColor opponent_to_rgb(FlipColor c) {
    float y = (c.x + 16) / 116;
    return multiply(to_rgb, (FlipColor){(c.y / 500 + y) * white.x, y * white.y, (y - c.z / 200) * white.z});
}

static int shown_on(FlipBackground background, int value, int alpha) {
    return background == FLIP_WHITE ? 255 - (255 - value) * alpha / 255 : value * alpha / 255;
}

static FlipColor load_pixel(const uint8_t *p, FlipBackground background, const float linear_of[256]) {
    float rgb[3];
    for (int c = 0; c < 3; c++) rgb[c] = linear_of[shown_on(background, p[c], p[3])];
    return rgb_to_opponent((FlipColor){rgb[0], rgb[1], rgb[2]});
}

/* Neighbours are often equal. */
void flip_load_row(const uint8_t *pixels, int count, FlipBackground background, const float linear_of[256],
                   float *lightness, float *red_green, float *blue_yellow) {
    FlipColor color = {0, 0, 0};
    for (int x = 0; x < count; x++) {
        const uint8_t *p = pixels + 4 * x;
        if (x == 0 || memcmp(p, p - 4, 4) != 0) color = load_pixel(p, background, linear_of);
        lightness[x] = color.x;
        red_green[x] = color.y;
        blue_yellow[x] = color.z;
    }
}

static float lab_curve(float t) {
    const float d = 6.0f / 29;
    return t > d * d * d ? cbrtf(t) : t / (3 * d * d) + 4.0f / 29;
}

static float clamp(float value) { return value < 0 ? 0 : value > 1 ? 1 : value; }

static FlipColor rgb_to_hunt_lab(FlipColor rgb) {
    FlipColor c = multiply(to_xyz, (FlipColor){clamp(rgb.x), clamp(rgb.y), clamp(rgb.z)});
    float x = lab_curve(c.x / white.x), y = lab_curve(c.y / white.y), z = lab_curve(c.z / white.z);
    float lightness = 116 * y - 16;
    return (FlipColor){lightness, 0.01f * lightness * 500 * (x - y), 0.01f * lightness * 200 * (y - z)};
}

FlipColor flip_hunt_lab(FlipColor opponent) { return rgb_to_hunt_lab(opponent_to_rgb(opponent)); }

static float hyab(FlipColor a, FlipColor b) {
    return fabsf(a.x - b.x) + sqrtf((a.y - b.y) * (a.y - b.y) + (a.z - b.z) * (a.z - b.z));
}

static const float COLOR_POWER = 0.7f, COLOR_KNEE = 0.4f, COLOR_KNEE_VALUE = 0.95f, FEATURE_POWER = 0.5f;

float flip_largest_error(void) {
    return powf(hyab(rgb_to_hunt_lab((FlipColor){0, 1, 0}), rgb_to_hunt_lab((FlipColor){0, 0, 1})), COLOR_POWER);
}

float flip_color_error(FlipColor a, FlipColor b, float largest) {
    float error = powf(hyab(a, b), COLOR_POWER), knee = COLOR_KNEE * largest;
    if (error < knee) return COLOR_KNEE_VALUE / knee * error;
    return COLOR_KNEE_VALUE + (error - knee) / (largest - knee) * (1 - COLOR_KNEE_VALUE);
}

float flip_amplify(float color, float feature) {
    if (color <= 0) return 0; /* 0 to the power of 0 would be 1 */
    return powf(color, 1 - powf(clamp(feature / sqrtf(2)), FEATURE_POWER));
}
