/* SPDX-License-Identifier: GPL-3.0-or-later */
/* FLIP: colours, filters, tiles around differences, and their mean and percentile. */
#include "regression/flip.h"

#include "base/base.h"
#include "base/numbers.h"
#include "pixels/png.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Half-open. */
typedef struct FlipArea {
    int left, top, right, bottom;
} FlipArea;

/* What depends only on the viewing distance. */
typedef struct FlipModel {
    FlipBlur blurs[FLIP_CHANNELS];
    FlipFeatures features;
    int reach;     /* largest radius of a filter */
    float largest; /* flip_largest_error() */
    float linear_of[256];
} FlipModel;

enum { FLIP_TILE_WIDTH = 128, FLIP_TILE_HEIGHT = 64 };

/* Room for the filters of one tile. */
typedef struct FlipTile FlipTile;

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

#define PI 3.14159265358979323846

static int radius_of(double radius) { return radius < FLIP_RADIUS_MAX ? (int)radius : FLIP_RADIUS_MAX; }

/* The constants of equation 3: weights and widths of up to two Gaussians. */
static const struct {
    double weight[2], width[2];
} sensitivity[] = {{{1, 0}, {0.0047, 0}}, {{1, 0}, {0.0053, 0}}, {{34.1, 13.5}, {0.04, 0.025}}};

void flip_make_blur(FlipBlur *blur, FlipChannel channel, double pixels_per_degree) {
    double volume[2] = {0, 0};
    /* One radius for all channels: three standard deviations of the widest Gaussian. */
    int radius = radius_of(ceil(3 * sqrt(0.04 / (2 * PI * PI)) * pixels_per_degree));
    blur->count = sensitivity[channel].weight[1] > 0 ? 2 : 1;
    for (int i = 0; i < blur->count; i++) {
        FlipKernel *kernel = &blur->kernels[i];
        double sum = 0, width = sensitivity[channel].width[i];
        kernel->radius = radius;
        for (int k = -radius; k <= radius; k++) sum += exp(-PI * PI / width * pow(k / pixels_per_degree, 2));
        for (int k = -radius; k <= radius; k++)
            kernel->weights[k + radius] = (float)(exp(-PI * PI / width * pow(k / pixels_per_degree, 2)) / sum);
        volume[i] = sensitivity[channel].weight[i] * sqrt(PI / width) * sum * sum;
    }
    for (int i = 0; i < blur->count; i++) blur->share[i] = (float)(volume[i] / (volume[0] + volume[1]));
}

/* Scales the positive weights to a sum of 1, the negative ones to -1. */
static void flip_normalise(FlipKernel *kernel, const double *weights) {
    double above = 0, below = 0;
    int count = 2 * kernel->radius + 1;
    for (int i = 0; i < count; i++) *(weights[i] > 0 ? &above : &below) += weights[i];
    for (int i = 0; i < count; i++) kernel->weights[i] = (float)(weights[i] / (weights[i] > 0 ? above : -below));
}

void flip_make_features(FlipFeatures *features, double pixels_per_degree) {
    enum { LARGEST = 2 * FLIP_RADIUS_MAX + 1 };
    double deviation = 0.5 * 0.082 * pixels_per_degree; /* 0.082 degrees: the feature width at the eye's peak
                                                           contrast sensitivity */
    int radius = radius_of(ceil(3 * deviation));
    double across[LARGEST] = {0}, edge[LARGEST] = {0}, point[LARGEST] = {0};
    for (int k = -radius; k <= radius; k++) {
        double gaussian = exp(-k * k / (2 * deviation * deviation));
        across[k + radius] = gaussian;
        edge[k + radius] = -k * gaussian;
        point[k + radius] = (k * k / (deviation * deviation) - 1) * gaussian;
    }
    features->across.radius = features->edge.radius = features->point.radius = radius;
    flip_normalise(&features->across, across);
    flip_normalise(&features->edge, edge);
    flip_normalise(&features->point, point);
}

void flip_filter(const float *from, const FlipKernel *kernel, size_t step, size_t stride, int width, int height,
                 float *to) {
#ifdef TWINBOX_AVX
    if (__builtin_cpu_supports("avx2")) {
        flip_filter_avx2(from, kernel, step, stride, width, height, to);
        return;
    }
#endif
    flip_filter_baseline(from, kernel, step, stride, width, height, to);
}

/* What is compared, of each picture. */
enum { BLURRED = FLIP_CHANNELS, EDGE_X = BLURRED, EDGE_Y, POINT_X, POINT_Y, PLANES };

/* Colours repeat, along edges as well: a table of those converted, by a hash of their bits, saves nine in ten roots. */
enum { CONVERTED_BITS = 12, CONVERTED = 1 << CONVERTED_BITS };

typedef struct Converted {
    FlipColor from, to;
} Converted;

/* All planes have rows of `stride` values. Channels begin `reach` pixels left of the area and above it. */
struct FlipTile {
    const FlipModel *model;
    size_t stride;
    float *channels[FLIP_CHANNELS];
    float *along;  /* filtered along rows: the area's columns, but the rows of the channels */
    float *second; /* the second Gaussian of a blur */
    float *planes[2][PLANES];
    uint8_t *row;        /* RGBA */
    unsigned char clear; /* not 0 if a loaded pixel is not opaque */
    Converted converted[CONVERTED];
    float memory[]; /* of all the arrays */
};

static void make_model(FlipModel *model, double pixels_per_degree) {
    for (int c = 0; c < FLIP_CHANNELS; c++) flip_make_blur(&model->blurs[c], (FlipChannel)c, pixels_per_degree);
    flip_make_features(&model->features, pixels_per_degree);
    model->reach = model->blurs[0].kernels[0].radius;
    if (model->features.across.radius > model->reach) model->reach = model->features.across.radius;
    model->largest = flip_largest_error();
    flip_make_linear(model->linear_of);
}

static FlipTile *tile_create(const FlipModel *model, Error *error) {
    size_t stride = FLIP_TILE_WIDTH + 2 * (size_t)model->reach, tall = FLIP_TILE_HEIGHT + 2 * (size_t)model->reach;
    size_t large = stride * tall, small = stride * FLIP_TILE_HEIGHT;
    enum { LARGE = FLIP_CHANNELS + 1, SMALL = 1 + 2 * PLANES };
    FlipTile *tile = malloc(sizeof *tile + (LARGE * large + SMALL * small) * sizeof *tile->memory + 4 * stride);
    if (tile == NULL) return error_memory(error, "FLIP"), NULL;
    float *next = tile->memory;
    tile->model = model, tile->stride = stride, tile->clear = 0;
    for (int i = 0; i < CONVERTED; i++) tile->converted[i].from.x = NAN; /* equals no colour */
    for (int c = 0; c < FLIP_CHANNELS; c++, next += large) tile->channels[c] = next;
    tile->along = next, next += large;
    tile->second = next, next += small;
    for (int i = 0; i < 2 * PLANES; i++, next += small) tile->planes[i / PLANES][i % PLANES] = next;
    tile->row = (uint8_t *)next;
    return tile;
}

/* The area in blocks of the filters, and around it what they reach. */
typedef struct Frame {
    int left, top, width, height;
} Frame;

static int flip_inside(int i, int count) { return i < 0 ? 0 : i >= count ? count - 1 : i; }

static void load_channels(FlipTile *tile, const Image *picture, FlipBackground background, const Frame *frame) {
    int reach = tile->model->reach, count = frame->width + 2 * reach;
    for (int y = 0; y < frame->height + 2 * reach; y++) {
        size_t row = (size_t)flip_inside(frame->top - reach + y, picture->height), at = (size_t)y * tile->stride;
        const uint8_t *pixels = picture->pixels + row * (size_t)picture->width * 4;
        for (int x = 0; x < count; x++)
            memcpy(tile->row + 4 * x, pixels + 4 * (size_t)flip_inside(frame->left - reach + x, picture->width), 4);
        for (int x = 0; x < count; x++) tile->clear |= 255 - tile->row[4 * x + 3];
        flip_load_row(tile->row, count, background, tile->model->linear_of, tile->channels[FLIP_LIGHTNESS] + at,
                      tile->channels[FLIP_RED_GREEN] + at, tile->channels[FLIP_BLUE_YELLOW] + at);
    }
}

/* Filters a channel along rows, for filter_columns(). */
static void filter_rows(FlipTile *tile, FlipChannel channel, const Frame *frame, const FlipKernel *kernel) {
    int reach = tile->model->reach;
    flip_filter(tile->channels[channel] + (reach - kernel->radius), kernel, 1, tile->stride, frame->width,
                frame->height + 2 * reach, tile->along);
}

static void filter_columns(FlipTile *tile, const Frame *frame, const FlipKernel *kernel, float *to) {
    size_t first = (size_t)(tile->model->reach - kernel->radius);
    flip_filter(tile->along + first * tile->stride, kernel, tile->stride, tile->stride, frame->width, frame->height,
                to);
}

static void blur(FlipTile *tile, FlipChannel channel, const Frame *frame, float *to) {
    const FlipBlur *by = &tile->model->blurs[channel];
    filter_rows(tile, channel, frame, &by->kernels[0]);
    filter_columns(tile, frame, &by->kernels[0], to);
    if (by->count == 1) return;
    filter_rows(tile, channel, frame, &by->kernels[1]);
    filter_columns(tile, frame, &by->kernels[1], tile->second);
    for (int y = 0; y < frame->height; y++)
        for (size_t i = (size_t)y * tile->stride, end = i + (size_t)frame->width; i < end; i++)
            to[i] = by->share[0] * to[i] + by->share[1] * tile->second[i];
}

/* Changes the lightness, which is no longer needed, to the scale of the features. */
static void find_features(FlipTile *tile, const Frame *frame, float *const planes[PLANES]) {
    const FlipFeatures *features = &tile->model->features;
    int reach = tile->model->reach;
    for (int y = 0; y < frame->height + 2 * reach; y++) {
        float *light = tile->channels[FLIP_LIGHTNESS] + (size_t)y * tile->stride;
        for (int x = 0; x < frame->width + 2 * reach; x++) light[x] = (light[x] + 16) / 116;
    }
    filter_rows(tile, FLIP_LIGHTNESS, frame, &features->edge);
    filter_columns(tile, frame, &features->across, planes[EDGE_X]);
    filter_rows(tile, FLIP_LIGHTNESS, frame, &features->point);
    filter_columns(tile, frame, &features->across, planes[POINT_X]);
    filter_rows(tile, FLIP_LIGHTNESS, frame, &features->across);
    filter_columns(tile, frame, &features->edge, planes[EDGE_Y]);
    filter_columns(tile, frame, &features->point, planes[POINT_Y]);
}

static float flip_strength(float *const planes[PLANES], int x, int y, size_t i) {
    return sqrtf(planes[x][i] * planes[x][i] + planes[y][i] * planes[y][i]);
}

static float feature_change(const FlipTile *tile, size_t i) {
    float *const *a = tile->planes[0], *const *b = tile->planes[1];
    float edges = fabsf(flip_strength(a, EDGE_X, EDGE_Y, i) - flip_strength(b, EDGE_X, EDGE_Y, i));
    float points = fabsf(flip_strength(a, POINT_X, POINT_Y, i) - flip_strength(b, POINT_X, POINT_Y, i));
    return fmaxf(edges, points);
}

static bool looks_equal(const FlipTile *tile, size_t i) {
    float *const *a = tile->planes[0], *const *b = tile->planes[1];
    return a[0][i] == b[0][i] && a[1][i] == b[1][i] && a[2][i] == b[2][i];
}

static size_t hash_color(FlipColor color) {
    uint32_t bits[3];
    memcpy(bits, &color, sizeof bits);
    /* Odd multipliers spread differences of low bits to the high ones, which are used. */
    return (bits[0] * 2654435761u ^ bits[1] * 2246822519u ^ bits[2] * 3266489917u) >> (32 - CONVERTED_BITS);
}

static FlipColor flip_convert(FlipTile *tile, float *const planes[PLANES], size_t i) {
    FlipColor from = {planes[0][i], planes[1][i], planes[2][i]};
    Converted *entry = &tile->converted[hash_color(from)];
    if (from.x != entry->from.x || from.y != entry->from.y || from.z != entry->from.z)
        *entry = (Converted){from, flip_hunt_lab(from)};
    return entry->to;
}

/* The last pair of colours: neighbours are often equal. */
typedef struct Judged {
    FlipColor a, b;
    float color, feature, value;
} Judged;

static bool same(FlipColor a, FlipColor b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

static float pixel_flip(FlipTile *tile, size_t i, Judged *last) {
    FlipColor a = flip_convert(tile, tile->planes[0], i), b = flip_convert(tile, tile->planes[1], i);
    bool known = same(a, last->a) && same(b, last->b);
    if (!known) *last = (Judged){a, b, flip_color_error(a, b, tile->model->largest), -1, 0};
    float feature = feature_change(tile, i);
    if (feature != last->feature) last->feature = feature, last->value = flip_amplify(last->color, feature);
    return last->value;
}

/* Values become those of the tile where these are larger. */
static void keep_largest(FlipTile *tile, FlipArea area, float *values, size_t stride) {
    Judged last = {{NAN, NAN, NAN}, {NAN, NAN, NAN}, 0, 0, 0};
    for (int y = 0; y < area.bottom - area.top; y++)
        for (int x = 0; x < area.right - area.left; x++) {
            size_t i = (size_t)y * tile->stride + (size_t)x;
            if (looks_equal(tile, i)) continue;
            float *value = &values[(size_t)y * stride + (size_t)(area.left + x)];
            *value = fmaxf(*value, pixel_flip(tile, i, &last));
        }
}

/* values[y - area.top][x] = FLIP of pixel x, y of the area, which has at most the size of a tile, where it is larger
   than the value already there. Rows of `values` are `stride` apart. Beyond the pictures' edges, their outermost
   pixels continue. Where a pixel that counts is not opaque, the larger value on white and on black. */
static void tile_compute(FlipTile *tile, const Image *const pictures[2], FlipArea area, float *values, size_t stride) {
    int blocks = (area.right - area.left + FLIP_BLOCK - 1) / FLIP_BLOCK;
    const Frame frame = {area.left, area.top, blocks * FLIP_BLOCK, area.bottom - area.top};
    tile->clear = 0;
    for (FlipBackground on = FLIP_WHITE; on == FLIP_WHITE || (on == FLIP_BLACK && tile->clear != 0); on++) {
        for (int p = 0; p < 2; p++) {
            load_channels(tile, pictures[p], on, &frame);
            for (int c = 0; c < FLIP_CHANNELS; c++) blur(tile, (FlipChannel)c, &frame, tile->planes[p][c]);
            find_features(tile, &frame, tile->planes[p]);
        }
        keep_largest(tile, area, values, stride);
    }
}

/* Selection by radix: bits of floats from 0 sort as the floats do. Linear in time, whatever the values. */

bool largest_create(Largest *largest, size_t keep, Error *error) {
    *largest = (Largest){.keep = keep};
    largest->values = malloc(2 * keep * sizeof *largest->values);
    return largest->values != NULL || error_memory(error, "percentile");
}

void largest_free(Largest *largest) { free(largest->values); }

static uint32_t bits_of(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* The value that `rank` - 1 values exceed or equal; rank is at most count. */
static float select_rank(const float *values, size_t count, size_t rank) {
    enum { DIGIT = 11, DIGITS = 1 << DIGIT };
    uint32_t prefix = 0, known = 0; /* bits of the result, and a mask of those known */
    for (int shift = 32 - DIGIT; known != UINT32_MAX; shift = shift > DIGIT ? shift - DIGIT : 0) {
        size_t counts[DIGITS] = {0};
        for (size_t i = 0; i < count; i++) {
            uint32_t bits = bits_of(values[i]);
            if ((bits & known) == prefix) counts[bits >> shift & (DIGITS - 1)]++;
        }
        uint32_t digit = DIGITS - 1;
        for (; counts[digit] < rank; digit--) rank -= counts[digit];
        prefix |= digit << shift;
        known |= (uint32_t)(DIGITS - 1) << shift;
    }
    float value;
    memcpy(&value, &prefix, sizeof value);
    return value;
}

/* Keeps the largest values. Of those equal to the least, all but enough are dropped. */
static void flip_shrink(Largest *largest) {
    float least = select_rank(largest->values, largest->count, largest->keep);
    size_t count = 0;
    for (size_t i = 0; i < largest->count; i++)
        if (largest->values[i] > least) largest->values[count++] = largest->values[i];
    while (count < largest->keep) largest->values[count++] = least;
    largest->count = count;
    largest->least = least;
}

void largest_add(Largest *largest, float value) {
    if (value <= largest->least) return;
    largest->values[largest->count++] = value;
    if (largest->count == 2 * largest->keep) flip_shrink(largest);
}

float largest_least(Largest *largest) {
    if (largest->count < largest->keep) return 0;
    flip_shrink(largest);
    return largest->least;
}

typedef struct Flip {
    const Image *pictures[2];
    int width, height;
    FlipModel model;
    FlipTile *tile;
    int band;      /* rows that are computed together */
    float *values; /* [band, width] */
    Largest largest;
    double sum;
} Flip;

static bool flip_create(Flip *flip, const Image *expected, const Image *actual, double pixels_per_degree,
                        Error *error) {
    static const int most = 1 << 22; /* values of a band, unless one row has more */
    *flip = (Flip){.pictures = {expected, actual}, .width = expected->width, .height = expected->height};
    make_model(&flip->model, pixels_per_degree);
    flip->band = most / flip->width < 1 ? 1 : most / flip->width;
    if (flip->band > FLIP_TILE_HEIGHT) flip->band = FLIP_TILE_HEIGHT;
    size_t pixels = (size_t)flip->width * (size_t)flip->height;
    flip->values = malloc((size_t)flip->width * (size_t)flip->band * sizeof *flip->values);
    if (flip->values == NULL) return error_memory(error, "FLIP");
    flip->tile = tile_create(&flip->model, error);
    return flip->tile != NULL && largest_create(&flip->largest, pixels / 100 + 1, error);
}

static void flip_destroy(Flip *flip) {
    largest_free(&flip->largest);
    free(flip->tile);
    free(flip->values);
}

/* Widens `found` to the differences in a row, from `left` to `right`. */
static void find_in_row(const Flip *flip, int y, int left, int right, FlipArea *found) {
    const uint8_t *a = flip->pictures[0]->pixels + (size_t)y * (size_t)flip->width * 4;
    const uint8_t *b = flip->pictures[1]->pixels + (size_t)y * (size_t)flip->width * 4;
    if (memcmp(a + 4 * (size_t)left, b + 4 * (size_t)left, 4 * (size_t)(right - left)) == 0) return;
    while (memcmp(a + 4 * (size_t)left, b + 4 * (size_t)left, 4) == 0) left++;
    while (memcmp(a + 4 * (size_t)(right - 1), b + 4 * (size_t)(right - 1), 4) == 0) right--;
    if (found->bottom == 0) *found = (FlipArea){left, y, right, y + 1};
    if (left < found->left) found->left = left;
    if (right > found->right) found->right = right;
    found->bottom = y + 1;
}

/* The part of an area that differences can reach through the filters; empty (bottom 0) if there are none. Beyond it,
   both pictures are filtered from equal pixels. */
static FlipArea find_reached(const Flip *flip, FlipArea area) {
    int reach = flip->model.reach;
    FlipArea found = {0, 0, 0, 0};
    int left = int_max(area.left - reach, 0), right = int_min(area.right + reach, flip->width);
    for (int y = int_max(area.top - reach, 0); y < int_min(area.bottom + reach, flip->height); y++)
        find_in_row(flip, y, left, right, &found);
    if (found.bottom == 0) return found;
    return (FlipArea){int_max(found.left - reach, area.left), int_max(found.top - reach, area.top),
                      int_min(found.right + reach, area.right), int_min(found.bottom + reach, area.bottom)};
}

/* The values of rows top .. bottom - 1. */
static void fill_band(const Flip *flip, int top, int bottom) {
    size_t width = (size_t)flip->width;
    memset(flip->values, 0, width * (size_t)(bottom - top) * sizeof *flip->values);
    for (int left = 0; left < flip->width; left += FLIP_TILE_WIDTH) {
        FlipArea area = find_reached(flip, (FlipArea){left, top, int_min(left + FLIP_TILE_WIDTH, flip->width), bottom});
        if (area.bottom > 0)
            tile_compute(flip->tile, flip->pictures, area, flip->values + (size_t)(area.top - top) * width, width);
    }
}

/* Row by row, so that the sum does not depend on tiles. */
static bool take_row(Flip *flip, const float *values, const FlipSink *sink, Error *error) {
    for (int x = 0; x < flip->width; x++) {
        if (values[x] == 0) continue;
        flip->sum += (double)values[x];
        largest_add(&flip->largest, values[x]);
    }
    return sink == NULL || sink->row(sink->context, values, flip->width, error);
}

bool flip_compare(const Image *expected, const Image *actual, double pixels_per_degree, const FlipSink *sink,
                  FlipSummary *result, Error *error) {
    Flip flip;
    bool ok = flip_create(&flip, expected, actual, pixels_per_degree, error);
    for (int top = 0; ok && top < flip.height; top += flip.band) {
        int bottom = int_min(top + flip.band, flip.height);
        fill_band(&flip, top, bottom);
        for (int y = top; ok && y < bottom; y++)
            ok = take_row(&flip, flip.values + (size_t)(y - top) * (size_t)flip.width, sink, error);
    }
    if (ok) {
        result->mean = flip.sum / ((double)flip.width * (double)flip.height);
        result->p99 = (double)largest_least(&flip.largest);
    }
    flip_destroy(&flip);
    return ok;
}
