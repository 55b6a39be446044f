/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A region against its ground: what appears, vanishes, changes. */
#include "base/base.h"
#include "base/numbers.h"
#include "pixels/png.h"
#include "regression/compare.h"
#include "regression/content.h"
#include "regression/regression_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CHANNELS = 4, MARGIN = CONTENT_MARGIN, NO_GROUND = UINT16_MAX };

/* The pixels of a region and some around it. */
typedef struct Ground {
    const Image *pictures[2];
    const uint8_t *masked;
    int weak;              /* differences up to this count as equal */
    int plain;             /* distances up to this are those of neighbours in the ground */
    ViewRect box;          /* with the margin */
    uint8_t *levels;       /* [its pixels] */
    uint16_t *distance[2]; /* [its pixels] by picture, from the nearest ground */
} Ground;

static size_t pixel_of(const Ground *ground, int x, int y) {
    return (size_t)y * (size_t)ground->pictures[0]->width + (size_t)x;
}

static size_t place_of(const Ground *ground, int x, int y) {
    return (size_t)(y - ground->box.top) * (size_t)(ground->box.right - ground->box.left) +
           (size_t)(x - ground->box.left);
}

/* Between two pixels of a picture. */
static int distance_in(const Image *image, size_t i, size_t j) {
    return pixel_distance(image->pixels + 4 * i, image->pixels + 4 * j);
}

/* Passes a pixel on the way from the ground at *last; SIZE_MAX: none yet. */
static void content_patch_pass(Ground *ground, int x, int y, size_t *last) {
    const size_t pixel = pixel_of(ground, x, y), place = place_of(ground, x, y);
    if (ground->levels[place] <= ground->weak) {
        *last = pixel;
    } else if (*last != SIZE_MAX) {
        for (int i = 0; i < 2; i++) {
            const int distance = distance_in(ground->pictures[i], pixel, *last);
            if (distance < ground->distance[i][place]) ground->distance[i][place] = (uint16_t)distance;
        }
    }
}

static void sweep_row(Ground *ground, int y) {
    size_t last = SIZE_MAX;
    for (int x = ground->box.left; x < ground->box.right; x++) content_patch_pass(ground, x, y, &last);
    last = SIZE_MAX;
    for (int x = ground->box.right; x-- > ground->box.left;) content_patch_pass(ground, x, y, &last);
}

static void sweep_column(Ground *ground, int x) {
    size_t last = SIZE_MAX;
    for (int y = ground->box.top; y < ground->box.bottom; y++) content_patch_pass(ground, x, y, &last);
    last = SIZE_MAX;
    for (int y = ground->box.bottom; y-- > ground->box.top;) content_patch_pass(ground, x, y, &last);
}

static void ground_free(Ground *ground) {
    free(ground->levels);
    for (int i = 0; i < 2; i++) free(ground->distance[i]);
}

/* Steps in the ground that are no edges, on average: 0 on a plain one. */
static int roughness_of(const Ground *ground) {
    enum { STEP_MAX = 60, USUAL = 12, TIMES = 4 };
    int64_t sum = 0, count = 0;
    for (int y = ground->box.top; y < ground->box.bottom; y++)
        for (int x = ground->box.left; x + 1 < ground->box.right; x++) {
            const size_t pixel = pixel_of(ground, x, y), place = place_of(ground, x, y);
            if (ground->levels[place] > 0 || ground->levels[place + 1] > 0) continue;
            sum += int_min(distance_in(ground->pictures[0], pixel, pixel + 1), STEP_MAX);
            count++;
        }
    return USUAL + (int)(count > 0 ? TIMES * sum / count : 0);
}

/* ground_free() frees it, also after an error. */
static bool ground_find(Ground *ground, const ImageRegion *region, Error *error) {
    const Image *a = ground->pictures[0], *b = ground->pictures[1];
    ground->box = (ViewRect){int_max(region->left - MARGIN, 0), int_max(region->top - MARGIN, 0),
                             int_min(region->right + MARGIN, a->width), int_min(region->bottom + MARGIN, a->height)};
    const size_t width = (size_t)(ground->box.right - ground->box.left);
    const size_t count = width * (size_t)(ground->box.bottom - ground->box.top);
    ground->levels = calloc(count, 1);
    for (int i = 0; i < 2; i++) ground->distance[i] = malloc(count * sizeof *ground->distance[i]);
    if (ground->levels == NULL || ground->distance[0] == NULL || ground->distance[1] == NULL)
        return error_memory(error, "regions");
    int most = 0;
    for (int y = ground->box.top; y < ground->box.bottom; y++)
        (void)image_find_levels(a, b, ground->masked, pixel_of(ground, ground->box.left, y), width,
                                ground->levels + place_of(ground, ground->box.left, y));
    for (size_t i = 0; i < count; i++) most = int_max(most, ground->levels[i]);
    ground->weak = most / 8;
    ground->plain = roughness_of(ground);
    for (int i = 0; i < 2; i++) memset(ground->distance[i], 0xff, count * sizeof *ground->distance[i]);
    for (int y = ground->box.top; y < ground->box.bottom; y++) sweep_row(ground, y);
    for (int x = ground->box.left; x < ground->box.right; x++) sweep_column(ground, x);
    return true;
}

static DotKind kind_of(const Ground *ground, size_t place) {
    const int a = ground->distance[0][place], b = ground->distance[1][place];
    const bool a_plain = a <= ground->plain, b_plain = b <= ground->plain;
    if (a == NO_GROUND) return DOT_CHANGES;
    if (a_plain && (!b_plain || 3 * a < b)) return DOT_APPEARS;
    if (b_plain && (!a_plain || 3 * b < a)) return DOT_VANISHES;
    return a_plain ? DOT_EDGE : DOT_CHANGES;
}

static void extend(ViewRect *box, int x, int y) {
    box->left = int_min(box->left, x), box->top = int_min(box->top, y);
    box->right = int_max(box->right, x + 1), box->bottom = int_max(box->bottom, y + 1);
}

static void add_energy(const Ground *ground, Patch *patch, size_t pixel, DotKind kind) {
    const uint8_t *a = ground->pictures[0]->pixels + 4 * pixel, *b = ground->pictures[1]->pixels + 4 * pixel;
    for (int c = 0; c < CHANNELS; c++) {
        const double difference = b[c] - a[c];
        patch->energy[kind] += difference * difference;
        patch->total += difference * difference;
        *(difference > 0 ? &patch->rise : &patch->fall) += fabs(difference);
    }
}

/* All differing pixels count in the sums, and some become dots: by multiples of the golden ratio, since every n-th
   pixel would lie in few columns of a box. */
static void add_dots(const Ground *ground, Patch *patch) {
    const ImageRegion *region = &patch->region;
    const uint32_t golden = 0x9E3779B9u;
    const uint64_t limit =
        ((uint64_t)DOTS_MAX << 32) / (uint64_t)(region->pixels > DOTS_MAX ? region->pixels : DOTS_MAX);
    uint32_t number = 0;
    for (int y = region->top; y < region->bottom; y++)
        for (int x = region->left; x < region->right; x++) {
            const size_t place = place_of(ground, x, y);
            if (ground->levels[place] <= ground->weak) continue;
            const DotKind kind = kind_of(ground, place);
            if (kind != DOT_APPEARS) extend(&patch->box[0], x, y);
            if (kind != DOT_VANISHES) extend(&patch->box[1], x, y);
            number += golden;
            if (number >= limit || patch->count == DOTS_MAX) continue;
            patch->dots[patch->count++] = (Dot){x, y, kind};
            add_energy(ground, patch, pixel_of(ground, x, y), kind);
        }
}

/* Of a high region, every n-th row. */
static void add_traits(const Ground *ground, ContentTraits *traits) {
    enum { ROWS = 100 };
    const int width = ground->box.right - ground->box.left, height = ground->box.bottom - ground->box.top;
    for (int y = ground->box.top; y < ground->box.bottom; y += height / ROWS + 1) {
        const size_t first = 4 * pixel_of(ground, ground->box.left, y);
        const uint8_t *a = ground->pictures[0]->pixels + first, *b = ground->pictures[1]->pixels + first;
        const uint8_t *levels = ground->levels + place_of(ground, ground->box.left, y);
        traits_add_row(traits, a, b, levels, ground->weak, width);
        for (int x = 0; x < width && y + 1 < ground->box.bottom; x++)
            if (levels[x] > ground->weak || levels[width + x] > ground->weak)
                traits_add_pair(traits, a + 4 * x, b + 4 * x, 4 * (size_t)ground->pictures[0]->width,
                                levels[x] > 0 && levels[width + x] > 0);
    }
}

Patch *patch_create(const Image *const pictures[2], const uint8_t *masked, const ImageRegion *region, Error *error) {
    Ground ground = {.pictures = {pictures[0], pictures[1]}, .masked = masked};
    Patch *patch = calloc(1, sizeof *patch);
    bool ok = (patch != NULL || error_memory(error, "regions")) && ground_find(&ground, region, error);
    if (ok)
        *patch = (Patch){.pictures = {pictures[0], pictures[1]},
                         .region = *region,
                         .box[0] = {region->right, region->bottom, region->left, region->top},
                         .box[1] = {region->right, region->bottom, region->left, region->top}};
    if (ok) {
        add_dots(&ground, patch);
        add_traits(&ground, &patch->traits);
    }
    ground_free(&ground);
    if (ok) return patch;
    free(patch);
    return NULL;
}

double patch_share(const Patch *patch, DotKind kind) { return patch->energy[kind] / fmax(patch->total, 1); }
