/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Constants and equation numbers are the paper's. */
#include "image/flip.h"

#include "image/flip_filter.h"
#include "image/image_compare.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct Color {
    float x, y, z; /* in any colour space */
} Color;

/* Linear sRGB to XYZ (IEC 61966-2-1), and the white point. */
static const float to_xyz[3][3] = {{0.41238656f, 0.35759149f, 0.18045049f},
                                   {0.21263682f, 0.71518298f, 0.07218020f},
                                   {0.01933062f, 0.11919716f, 0.95037259f}};
static const Color white = {0.95042854f, 1, 1.08890037f};

/* The inverse of to_xyz. */
static const float to_rgb[3][3] = {{3.24100326f, -1.53739899f, -0.49861587f},
                                   {-0.96922426f, 1.87592999f, 0.04155422f},
                                   {0.05563942f, -0.20401120f, 1.05714897f}};

static Color multiply(const float m[3][3], Color c) {
    return (Color){m[0][0] * c.x + m[0][1] * c.y + m[0][2] * c.z, m[1][0] * c.x + m[1][1] * c.y + m[1][2] * c.z,
                   m[2][0] * c.x + m[2][1] * c.y + m[2][2] * c.z};
}

static float linear(int byte) {
    float value = (float)byte / 255;
    return value <= 0.04045f ? value / 12.92f : powf((value + 0.055f) / 1.055f, 2.4f);
}

/* A linear opponent space, in which lightness and the two chroma channels are blurred separately (section 4.1.1). */
static Color rgb_to_opponent(Color rgb) {
    Color c = multiply(to_xyz, rgb);
    c = (Color){c.x / white.x, c.y / white.y, c.z / white.z};
    return (Color){116 * c.y - 16, 500 * (c.x - c.y), 200 * (c.y - c.z)};
}

static Color opponent_to_rgb(Color c) {
    float y = (c.x + 16) / 116;
    return multiply(to_rgb, (Color){(c.y / 500 + y) * white.x, y * white.y, (y - c.z / 200) * white.z});
}

static float lab_curve(float t) {
    const float d = 6.0f / 29;
    return t > d * d * d ? cbrtf(t) : t / (3 * d * d) + 4.0f / 29;
}

static float clamp(float value) { return value < 0 ? 0 : value > 1 ? 1 : value; }

/* CIELab with the Hunt effect: less chroma at low lightness (section 4.1.2). */
static Color rgb_to_hunt_lab(Color rgb) {
    Color c = multiply(to_xyz, (Color){clamp(rgb.x), clamp(rgb.y), clamp(rgb.z)});
    float x = lab_curve(c.x / white.x), y = lab_curve(c.y / white.y), z = lab_curve(c.z / white.z);
    float lightness = 116 * y - 16;
    return (Color){lightness, 0.01f * lightness * 500 * (x - y), 0.01f * lightness * 200 * (y - z)};
}

static float hyab(Color a, Color b) {
    return fabsf(a.x - b.x) + sqrtf((a.y - b.y) * (a.y - b.y) + (a.z - b.z) * (a.z - b.z));
}

static const float COLOR_POWER = 0.7f, COLOR_KNEE = 0.4f, COLOR_KNEE_VALUE = 0.95f, FEATURE_POWER = 0.5f;

/* Section 4.1.3: errors above the knee are compressed. */
static float color_error(float distance, float largest) {
    float error = powf(distance, COLOR_POWER), knee = COLOR_KNEE * largest;
    if (error < knee) return COLOR_KNEE_VALUE / knee * error;
    return COLOR_KNEE_VALUE + (error - knee) / (largest - knee) * (1 - COLOR_KNEE_VALUE);
}

/* The region of both pictures that is compared, as planes. */
enum { CHANNELS = 3, FEATURES = 4, PLANES = CHANNELS + FEATURES, SCRATCH = 2 };
typedef struct Region {
    int left, top, width, height;
    FlipPlane planes[2][PLANES]; /* blurred lightness, red-green, blue-yellow; edges, points in x and y */
    FlipPlane scratch[SCRATCH], channels[CHANNELS];
    FlipPlane largest; /* of all backgrounds */
    float *padded;     /* one row */
    float *memory;
} Region;

static bool region_create(Region *region, Error *error) {
    size_t size = (size_t)region->width * (size_t)region->height;
    enum { ALL = 2 * PLANES + SCRATCH + CHANNELS + 1 };
    float *next = region->memory = malloc((size * ALL + (size_t)region->width + 2 * FLIP_RADIUS_MAX) * sizeof *next);
    if (next == NULL) return error_memory(error, "FLIP");
    for (int i = 0; i < ALL; i++, next += size) {
        FlipPlane plane = {region->width, region->height, next};
        if (i < 2 * PLANES)
            region->planes[i / PLANES][i % PLANES] = plane;
        else if (i < 2 * PLANES + SCRATCH)
            region->scratch[i - 2 * PLANES] = plane;
        else if (i < ALL - 1)
            region->channels[i - 2 * PLANES - SCRATCH] = plane;
        else
            region->largest = plane;
    }
    memset(region->largest.values, 0, size * sizeof *region->largest.values);
    region->padded = next;
    return true;
}

static const uint8_t *region_row(const Region *region, const Image *image, int y) {
    return image->pixels + ((size_t)(region->top + y) * (size_t)image->width + (size_t)region->left) * 4;
}

static bool is_opaque(const Region *region, const Image *image) {
    for (int y = 0; y < region->height; y++) {
        const uint8_t *p = region_row(region, image, y);
        for (int x = 0; x < region->width; x++)
            if (p[4 * x + 3] != 255) return false;
    }
    return true;
}

typedef enum Background { WHITE, BLACK } Background;

static int shown_on(Background background, int value, int alpha) {
    return background == WHITE ? 255 - (255 - value) * alpha / 255 : value * alpha / 255;
}

static void load_channels(Region *region, const Image *image, Background background, const float linear_of[256]) {
    size_t i = 0;
    for (int y = 0; y < region->height; y++) {
        const uint8_t *p = region_row(region, image, y);
        for (int x = 0; x < region->width; x++, p += 4, i++) {
            float rgb[3];
            for (int c = 0; c < 3; c++) rgb[c] = linear_of[shown_on(background, p[c], p[3])];
            Color color = rgb_to_opponent((Color){rgb[0], rgb[1], rgb[2]});
            region->channels[0].values[i] = color.x;
            region->channels[1].values[i] = color.y;
            region->channels[2].values[i] = color.z;
        }
    }
}

static void blur(Region *region, FlipChannel channel, const FlipBlur *by, FlipPlane *to) {
    size_t size = (size_t)region->width * (size_t)region->height;
    FlipPlane *scratch = region->scratch;
    flip_filter(&region->channels[channel], &by->kernels[0], &by->kernels[0], &scratch[0], region->padded, to);
    if (by->count == 1) return;
    flip_filter(&region->channels[channel], &by->kernels[1], &by->kernels[1], &scratch[0], region->padded, &scratch[1]);
    for (size_t i = 0; i < size; i++)
        to->values[i] = by->share[0] * to->values[i] + by->share[1] * scratch[1].values[i];
}

static void find_features(Region *region, const FlipFeatures *features, FlipPlane *to) {
    size_t size = (size_t)region->width * (size_t)region->height;
    FlipPlane *light = &region->channels[FLIP_LIGHTNESS];
    for (size_t i = 0; i < size; i++) light->values[i] = (light->values[i] + 16) / 116;
    flip_filter(light, &features->edge, &features->across, region->scratch, region->padded, &to[0]);
    flip_filter(light, &features->across, &features->edge, region->scratch, region->padded, &to[1]);
    flip_filter(light, &features->point, &features->across, region->scratch, region->padded, &to[2]);
    flip_filter(light, &features->across, &features->point, region->scratch, region->padded, &to[3]);
}

static Color blurred(const Region *region, int picture, size_t i) {
    const FlipPlane *p = region->planes[picture];
    return rgb_to_hunt_lab(opponent_to_rgb((Color){p[0].values[i], p[1].values[i], p[2].values[i]}));
}

static float feature_change(const Region *region, int first, size_t i) {
    const FlipPlane *a = region->planes[0] + CHANNELS + first, *b = region->planes[1] + CHANNELS + first;
    float strength_a = sqrtf(a[0].values[i] * a[0].values[i] + a[1].values[i] * a[1].values[i]);
    float strength_b = sqrtf(b[0].values[i] * b[0].values[i] + b[1].values[i] * b[1].values[i]);
    return fabsf(strength_a - strength_b);
}

static bool looks_equal(const Region *region, size_t i) {
    const FlipPlane *a = region->planes[0], *b = region->planes[1];
    return a[0].values[i] == b[0].values[i] && a[1].values[i] == b[1].values[i] && a[2].values[i] == b[2].values[i];
}

/* Equation 6 for one pixel. */
static float pixel_flip(const Region *region, size_t i, float largest) {
    if (looks_equal(region, i)) return 0;
    float color = color_error(hyab(blurred(region, 0, i), blurred(region, 1, i)), largest);
    if (color <= 0) return 0; /* 0 to the power of 0 would be 1 */
    float change = fmaxf(feature_change(region, 0, i), feature_change(region, 2, i));
    float feature = powf(clamp(change / sqrtf(2)), FEATURE_POWER);
    return powf(color, 1 - feature);
}

static float largest_color_error(void) {
    return powf(hyab(rgb_to_hunt_lab((Color){0, 1, 0}), rgb_to_hunt_lab((Color){0, 0, 1})), COLOR_POWER);
}

static void keep_largest(Region *region) {
    size_t size = (size_t)region->width * (size_t)region->height;
    float largest = largest_color_error();
    for (size_t i = 0; i < size; i++)
        region->largest.values[i] = fmaxf(region->largest.values[i], pixel_flip(region, i, largest));
}

static double fill(const Region *region, int width, float *map) {
    double sum = 0;
    size_t i = 0;
    for (int y = 0; y < region->height; y++)
        for (int x = 0; x < region->width; x++, i++) {
            float value = region->largest.values[i];
            sum += (double)value;
            if (map != NULL) map[(size_t)(region->top + y) * (size_t)width + (size_t)(region->left + x)] = value;
        }
    return sum;
}

/* The bounds of the differences, extended by the filter radius, and again by what the filters read there. */
static bool find_region(Region *region, const Image *a, const Image *b, int radius) {
    ImageDifference difference;
    image_compare(a, b, &difference);
    if (difference.equal) return false;
    int left = difference.left - 2 * radius, right = difference.right + 2 * radius;
    int top = difference.top - 2 * radius, bottom = difference.bottom + 2 * radius;
    region->left = left > 0 ? left : 0;
    region->top = top > 0 ? top : 0;
    region->width = (right < a->width ? right : a->width) - region->left;
    region->height = (bottom < a->height ? bottom : a->height) - region->top;
    return true;
}

bool flip_compare(const Image *expected, const Image *actual, double pixels_per_degree, float *map, double *mean,
                  Error *error) {
    size_t all = (size_t)expected->width * (size_t)expected->height;
    FlipBlur blurs[CHANNELS];
    FlipFeatures features;
    float linear_of[256];
    Region region = {0};
    *mean = 0;
    if (map != NULL) memset(map, 0, all * sizeof *map);
    for (int c = 0; c < CHANNELS; c++) flip_make_blur(&blurs[c], (FlipChannel)c, pixels_per_degree);
    flip_make_features(&features, pixels_per_degree);
    int reach = blurs[0].kernels[0].radius;
    if (features.across.radius > reach) reach = features.across.radius;
    if (!find_region(&region, expected, actual, reach)) return true;
    if (!region_create(&region, error)) return false;
    for (int i = 0; i < 256; i++) linear_of[i] = linear(i);
    Background last = is_opaque(&region, expected) && is_opaque(&region, actual) ? WHITE : BLACK;
    for (Background background = WHITE; background <= last; background++) {
        for (int picture = 0; picture < 2; picture++) {
            load_channels(&region, picture == 0 ? expected : actual, background, linear_of);
            for (int c = 0; c < CHANNELS; c++) blur(&region, (FlipChannel)c, &blurs[c], &region.planes[picture][c]);
            find_features(&region, &features, region.planes[picture] + CHANNELS);
        }
        keep_largest(&region);
    }
    *mean = fill(&region, expected->width, map) / (double)all;
    free(region.memory);
    return true;
}
