/* SPDX-License-Identifier: GPL-3.0-or-later */
/* FLIP in tiles has the bits of FLIP of whole planes, which is written here as simply as possible; the percentile is
   that of all values sorted. */
#include "made.h"
#include "sanitized.h"

#include "regression/flip.h"

#include <math.h>

typedef struct Plane {
    int width, height;
    float *values;
} Plane;

static Plane plane_create(const Image *image) {
    Plane plane = {image->width, image->height, calloc((size_t)image->width * (size_t)image->height, sizeof(float))};
    assert_non_null(plane.values);
    return plane;
}

static int inside(int i, int count) { return i < 0 ? 0 : i >= count ? count - 1 : i; }

static float *at(const Plane *plane, int x, int y) {
    return &plane->values[inside(y, plane->height) * plane->width + inside(x, plane->width)];
}

static void filter(const Plane *from, const FlipKernel *along, const FlipKernel *down, const Plane *scratch,
                   const Plane *to) {
    for (int y = 0; y < from->height; y++)
        for (int x = 0; x < from->width; x++) {
            float sum = 0;
            for (int k = -along->radius; k <= along->radius; k++)
                sum += along->weights[k + along->radius] * *at(from, x + k, y);
            *at(scratch, x, y) = sum;
        }
    for (int y = 0; y < from->height; y++)
        for (int x = 0; x < from->width; x++) {
            float sum = 0;
            for (int k = -down->radius; k <= down->radius; k++)
                sum += down->weights[k + down->radius] * *at(scratch, x, y + k);
            *at(to, x, y) = sum;
        }
}

enum { EDGE_X = FLIP_CHANNELS, EDGE_Y, POINT_X, POINT_Y, SCRATCH, SECOND, PLANES = SECOND + 1 + FLIP_CHANNELS };

static void find_planes(const Image *image, FlipBackground background, double pixels_per_degree, Plane planes[PLANES]) {
    float linear_of[256];
    FlipFeatures features;
    flip_make_linear(linear_of);
    for (int i = 0; i < PLANES; i++) planes[i] = plane_create(image);
    Plane *channels = planes + SECOND + 1, *light = channels, *scratch = &planes[SCRATCH], *second = &planes[SECOND];
    size_t all = (size_t)image->width * (size_t)image->height;
    flip_load_row(image->pixels, (int)all, background, linear_of, channels[0].values, channels[1].values,
                  channels[2].values);
    for (int c = 0; c < FLIP_CHANNELS; c++) {
        FlipBlur blur;
        flip_make_blur(&blur, (FlipChannel)c, pixels_per_degree);
        filter(&channels[c], &blur.kernels[0], &blur.kernels[0], scratch, &planes[c]);
        if (blur.count == 1) continue;
        filter(&channels[c], &blur.kernels[1], &blur.kernels[1], scratch, second);
        for (size_t i = 0; i < all; i++)
            planes[c].values[i] = blur.share[0] * planes[c].values[i] + blur.share[1] * second->values[i];
    }
    for (size_t i = 0; i < all; i++) light->values[i] = (light->values[i] + 16) / 116;
    flip_make_features(&features, pixels_per_degree);
    filter(light, &features.edge, &features.across, scratch, &planes[EDGE_X]);
    filter(light, &features.across, &features.edge, scratch, &planes[EDGE_Y]);
    filter(light, &features.point, &features.across, scratch, &planes[POINT_X]);
    filter(light, &features.across, &features.point, scratch, &planes[POINT_Y]);
}

static float strength(const Plane *planes, int x, size_t i) {
    const float *a = planes[x].values, *b = planes[x + 1].values;
    return sqrtf(a[i] * a[i] + b[i] * b[i]);
}

static float pixel_flip(Plane planes[2][PLANES], size_t i) {
    FlipColor opponent[2];
    for (int p = 0; p < 2; p++)
        opponent[p] = (FlipColor){planes[p][0].values[i], planes[p][1].values[i], planes[p][2].values[i]};
    if (opponent[0].x == opponent[1].x && opponent[0].y == opponent[1].y && opponent[0].z == opponent[1].z) return 0;
    float color = flip_color_error(flip_hunt_lab(opponent[0]), flip_hunt_lab(opponent[1]), flip_largest_error());
    float edges = fabsf(strength(planes[0], EDGE_X, i) - strength(planes[1], EDGE_X, i));
    float points = fabsf(strength(planes[0], POINT_X, i) - strength(planes[1], POINT_X, i));
    return flip_amplify(color, fmaxf(edges, points));
}

static Plane flip_whole(const Image *expected, const Image *actual, double pixels_per_degree) {
    Plane planes[2][PLANES], map = plane_create(expected);
    for (FlipBackground background = FLIP_WHITE; background <= FLIP_BLACK; background++) {
        find_planes(expected, background, pixels_per_degree, planes[0]);
        find_planes(actual, background, pixels_per_degree, planes[1]);
        for (size_t i = 0; i < (size_t)map.width * (size_t)map.height; i++)
            map.values[i] = fmaxf(map.values[i], pixel_flip(planes, i));
        for (int i = 0; i < 2 * PLANES; i++) free(planes[i / PLANES][i % PLANES].values);
    }
    return map;
}

/* `wanted` points to the values of the next row. */
static bool check_row(void *wanted, const float *values, int width, Error *error) {
    const float **next = wanted;
    (void)error;
    assert_memory_equal(values, *next, (size_t)width * sizeof *values);
    *next += width;
    return true;
}

static int by_value(const void *a, const void *b) {
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static void check_pair(const Image *expected, const Image *actual, double pixels_per_degree) {
    Error error = {0};
    FlipSummary result;
    Plane wanted = flip_whole(expected, actual, pixels_per_degree);
    const float *next = wanted.values;
    const FlipSink sink = {check_row, &next};
    assert_ok(flip_compare(expected, actual, pixels_per_degree, &sink, &result, &error), error);
    double sum = 0;
    size_t all = (size_t)wanted.width * (size_t)wanted.height;
    assert_true(next == wanted.values + all);
    for (size_t i = 0; i < all; i++) sum += (double)wanted.values[i];
    assert_true(result.mean == sum / (double)all);
    qsort(wanted.values, all, sizeof(float), by_value);
    assert_true(result.p99 == (double)wanted.values[(99 * all + 99) / 100 - 1]);
    free(wanted.values);
}

static uint32_t draw(uint32_t *state) {
    *state = *state * 1664525 + 1013904223;
    return *state >> 8;
}

/* One pixel in 997 is not opaque. */
static Image *noise(int width, int height, uint32_t seed) {
    Image *image = image_sized(width, height);
    for (int i = 0; i < width * height * 4; i++)
        image->pixels[i] = (uint8_t)(i % 4 == 3 && i / 4 % 997 != 0 ? 255 : draw(&seed));
    return image;
}

/* Sides of one pixel, and around those of a tile (128 x 64); radii of 3, 10 and 28 pixels. */
static const int sizes[][2] = {{1, 1}, {150, 1}, {1, 150}, {127, 65}, {128, 64}, {129, 63}, {300, 140}};
enum { SIZES = sizeof sizes / sizeof sizes[0] };
static const double distances[] = {20, FLIP_PIXELS_PER_DEGREE, 200};

TEST(noise_has_the_same_bits) {
    for (int i = 0; i < 2 * SIZES; i++) {
        const int *size = sizes[i / 2];
        Image *a = noise(size[0], size[1], 1), *b = noise(size[0], size[1], 2);
        check_pair(a, b, distances[i % 3]);
        image_destroy(a);
        image_destroy(b);
    }
}

/* Few pixels differ: most tiles are computed in part or not at all. Sampled: each distance once. */
TEST(few_differences_have_the_same_bits) {
    uint32_t seed = 3;
    for (int count = 0; count < 12; count += sampled(5)) {
        Image *a = noise(300, 200, 5), *b = noise(300, 200, 5);
        for (int i = 0; i < count; i++) b->pixels[draw(&seed) % (300 * 200) * 4 + draw(&seed) % 3] ^= 255;
        for (int y = 63; y < 65; y++) b->pixels[4 * (y * 300 + 127 + count % 2)] ^= 128;
        check_pair(a, b, distances[count % 3]);
        image_destroy(a);
        image_destroy(b);
    }
}

/* Many equal values, ascending, descending and in no order: the least of the largest is that of a sort. */
TEST(the_largest_are_those_of_a_sort) {
    enum { COUNT = 5000 };
    static float values[COUNT];
    for (int order = 0; order < 4; order++)
        for (size_t keep = 1; keep < 2 * COUNT; keep = keep * 3 + 1) {
            Largest largest;
            uint32_t seed = 7;
            assert_ok(largest_create(&largest, keep, &error), error);
            for (int i = 0; i < COUNT; i++) {
                values[i] = order == 0   ? (float)i / COUNT
                            : order == 1 ? 1 - (float)i / COUNT
                            : order == 2 ? (float)(draw(&seed) % 5) / 4
                                         : (float)draw(&seed) / (1 << 24);
                largest_add(&largest, values[i]);
            }
            qsort(values, COUNT, sizeof values[0], by_value);
            assert_true(largest_least(&largest) == (keep <= COUNT ? values[COUNT - keep] : 0));
            largest_free(&largest);
        }
}

RUN_TESTS(NULL, NULL)
