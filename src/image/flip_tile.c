/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "image/flip_tile.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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
    float *memory;
    Converted converted[CONVERTED];
};

void flip_make_model(FlipModel *model, double pixels_per_degree) {
    for (int c = 0; c < FLIP_CHANNELS; c++) flip_make_blur(&model->blurs[c], (FlipChannel)c, pixels_per_degree);
    flip_make_features(&model->features, pixels_per_degree);
    model->reach = model->blurs[0].kernels[0].radius;
    if (model->features.across.radius > model->reach) model->reach = model->features.across.radius;
    model->largest = flip_largest_error();
    flip_make_linear(model->linear_of);
}

FlipTile *flip_tile_create(const FlipModel *model, Error *error) {
    FlipTile *tile = calloc(1, sizeof *tile);
    size_t stride = FLIP_TILE_WIDTH + 2 * (size_t)model->reach, tall = FLIP_TILE_HEIGHT + 2 * (size_t)model->reach;
    size_t large = stride * tall, small = stride * FLIP_TILE_HEIGHT;
    enum { LARGE = FLIP_CHANNELS + 1, SMALL = 1 + 2 * PLANES };
    float *next = tile == NULL ? NULL : malloc((LARGE * large + SMALL * small) * sizeof *next + 4 * stride);
    if (next == NULL) {
        free(tile);
        error_memory(error, "FLIP");
        return NULL;
    }
    tile->model = model, tile->stride = stride, tile->memory = next;
    for (int i = 0; i < CONVERTED; i++) tile->converted[i].from.x = NAN; /* equals no colour */
    for (int c = 0; c < FLIP_CHANNELS; c++, next += large) tile->channels[c] = next;
    tile->along = next, next += large;
    tile->second = next, next += small;
    for (int i = 0; i < 2 * PLANES; i++, next += small) tile->planes[i / PLANES][i % PLANES] = next;
    tile->row = (uint8_t *)next;
    return tile;
}

void flip_tile_destroy(FlipTile *tile) {
    if (tile != NULL) free(tile->memory);
    free(tile);
}

/* The area in blocks of the filters, and around it what they reach. */
typedef struct Frame {
    int left, top, width, height;
} Frame;

static int inside(int i, int count) { return i < 0 ? 0 : i >= count ? count - 1 : i; }

static void load_channels(FlipTile *tile, const Image *picture, FlipBackground background, const Frame *frame) {
    int reach = tile->model->reach, count = frame->width + 2 * reach;
    for (int y = 0; y < frame->height + 2 * reach; y++) {
        size_t row = (size_t)inside(frame->top - reach + y, picture->height), at = (size_t)y * tile->stride;
        const uint8_t *pixels = picture->pixels + row * (size_t)picture->width * 4;
        for (int x = 0; x < count; x++)
            memcpy(tile->row + 4 * x, pixels + 4 * (size_t)inside(frame->left - reach + x, picture->width), 4);
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

static float strength(float *const planes[PLANES], int x, int y, size_t i) {
    return sqrtf(planes[x][i] * planes[x][i] + planes[y][i] * planes[y][i]);
}

static float feature_change(const FlipTile *tile, size_t i) {
    float *const *a = tile->planes[0], *const *b = tile->planes[1];
    float edges = fabsf(strength(a, EDGE_X, EDGE_Y, i) - strength(b, EDGE_X, EDGE_Y, i));
    float points = fabsf(strength(a, POINT_X, POINT_Y, i) - strength(b, POINT_X, POINT_Y, i));
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

static FlipColor convert(FlipTile *tile, float *const planes[PLANES], size_t i) {
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
    FlipColor a = convert(tile, tile->planes[0], i), b = convert(tile, tile->planes[1], i);
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

void flip_tile_compute(FlipTile *tile, const Image *const pictures[2], FlipArea area, float *values, size_t stride) {
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
