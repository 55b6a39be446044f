/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Connected components in one pass from top to bottom. Of the rows above, only the last differing pixel of each column
   matters: an earlier one within reach is in the same region. Regions are joined by union-find; those that no column
   reaches any more are complete, and their nodes are used again. */
#include "base/base.h"
#include "base/numbers.h"
#include "pixels/png.h"
#include "regression/compare.h"
#include "regression/flip.h"
#include "regression/regression_internal.h"

#include <stdlib.h>
#include <string.h>

typedef struct Node {
    int parent; /* itself: a root */
    ImageRegion region;
} Node;

struct RegionScan {
    int width, gap;
    int node_count, capacity;
    Node *nodes;      /* [capacity] */
    Node *kept;       /* [capacity], scratch of compact() */
    int *moved;       /* [capacity], scratch of compact() */
    int *column_node; /* [width] of the last differing pixel of a column */
    int *column_row;  /* [width] its row; far above the picture: none */
    ImageRegions *regions;
};
typedef struct RegionScan Scan;

int image_regions_gap(int width, int height) {
    int gap = (width < height ? width : height) / 120;
    return gap < 4 ? 4 : gap > 12 ? 12 : gap;
}

static bool is_before(const ImageRegion *a, const ImageRegion *b) {
    if (a->pixels != b->pixels) return a->pixels > b->pixels;
    return a->top != b->top ? a->top < b->top : a->left < b->left;
}

static void keep_largest(ImageRegions *regions, const ImageRegion *region) {
    int at = regions->kept;
    regions->count++;
    while (at > 0 && is_before(region, &regions->list[at - 1])) at--;
    if (at == IMAGE_REGIONS_MAX) return;
    int last = regions->kept < IMAGE_REGIONS_MAX ? regions->kept++ : IMAGE_REGIONS_MAX - 1;
    memmove(&regions->list[at + 1], &regions->list[at], (size_t)(last - at) * sizeof *region);
    regions->list[at] = *region;
}

static int root_of(Node *nodes, int node) {
    while (nodes[node].parent != node) {
        nodes[node].parent = nodes[nodes[node].parent].parent;
        node = nodes[node].parent;
    }
    return node;
}

static int difference_join(Scan *scan, int a, int b) {
    int root = root_of(scan->nodes, a), other = root_of(scan->nodes, b);
    if (root == other) return root;
    ImageRegion *to = &scan->nodes[root].region;
    const ImageRegion *from = &scan->nodes[other].region;
    *to = (ImageRegion){to->pixels + from->pixels, int_min(to->left, from->left), int_min(to->top, from->top),
                        int_max(to->right, from->right), int_max(to->bottom, from->bottom)};
    scan->nodes[other].parent = root;
    return root;
}

/* Completes the regions that no differing pixel from row `row` on can reach, and renumbers the others. */
static void compact(Scan *scan, int row) {
    int count = 0;
    for (int i = 0; i < scan->node_count; i++) scan->moved[i] = -1;
    for (int x = 0; x < scan->width; x++) {
        if (scan->column_row[x] < row - scan->gap) continue;
        int root = root_of(scan->nodes, scan->column_node[x]);
        if (scan->moved[root] < 0) {
            scan->kept[count] = (Node){count, scan->nodes[root].region};
            scan->moved[root] = count++;
        }
        scan->column_node[x] = scan->moved[root];
    }
    for (int i = 0; i < scan->node_count; i++)
        if (scan->nodes[i].parent == i && scan->moved[i] < 0) keep_largest(scan->regions, &scan->nodes[i].region);
    memcpy(scan->nodes, scan->kept, (size_t)count * sizeof *scan->nodes);
    scan->node_count = count;
}

/* The run of differing pixels from `left` to `right`, whose gaps are no larger than the gap. */
static void add_run(Scan *scan, const uint8_t *levels, int left, int right, int64_t pixels, int row) {
    int node = scan->node_count++, known = -1;
    scan->nodes[node] = (Node){node, {pixels, left, row, right + 1, row + 1}};
    const int first = int_max(left - scan->gap, 0), last = int_min(right + scan->gap, scan->width - 1),
              reach = row - scan->gap;
    int *nodes = scan->column_node, *rows = scan->column_row;
    for (int x = first; x <= last; x++) {
        if (rows[x] < reach || nodes[x] == known) continue;
        known = nodes[x];
        node = difference_join(scan, node, known);
    }
    for (int x = left; x <= right; x++) {
        nodes[x] = levels[x] > 0 ? node : nodes[x];
        rows[x] = levels[x] > 0 ? row : rows[x];
    }
}

/* The next pixel from x on that differs; `width` if there is none. */
static int next_pixel(const uint8_t *levels, int x, int width) {
    uint64_t word;
    while (x + (int)sizeof word <= width) {
        memcpy(&word, levels + x, sizeof word);
        if (word != 0) break;
        x += (int)sizeof word;
    }
    while (x < width && levels[x] == 0) x++;
    return x;
}

void region_scan_row(RegionScan *scan, int y, const uint8_t *levels) {
    if (scan->node_count + scan->width > scan->capacity) compact(scan, y);
    for (int left = next_pixel(levels, 0, scan->width); left < scan->width;) {
        int right = left, x = left + 1;
        int64_t pixels = 1;
        for (; x < scan->width && x - right <= scan->gap; x++)
            if (levels[x] > 0) right = x, pixels++;
        add_run(scan, levels, left, right, pixels, y);
        left = next_pixel(levels, x, scan->width);
    }
}

RegionScan *region_scan_create(int width, int height, ImageRegions *regions, Error *error) {
    const size_t columns = (size_t)width, capacity = 3 * columns;
    Scan *scan = calloc(1, sizeof *scan);
    if (scan == NULL) return error_memory(error, "regions"), NULL;
    *scan =
        (Scan){.width = width, .gap = image_regions_gap(width, height), .capacity = (int)capacity, .regions = regions};
    *regions = (ImageRegions){.count = 0};
    scan->nodes = calloc(capacity, sizeof *scan->nodes);
    scan->kept = malloc(capacity * sizeof *scan->kept);
    scan->moved = calloc(capacity, sizeof *scan->moved);
    scan->column_node = calloc(columns, sizeof *scan->column_node);
    scan->column_row = calloc(columns, sizeof *scan->column_row);
    if (scan->nodes == NULL || scan->kept == NULL || scan->moved == NULL || scan->column_node == NULL ||
        scan->column_row == NULL) {
        error_memory(error, "regions");
        region_scan_destroy(scan);
        return NULL;
    }
    for (size_t x = 0; x < columns; x++) scan->column_row[x] = INT32_MIN / 2;
    return scan;
}

/* Beyond the reach of every row, all regions are complete. */
void region_scan_end(RegionScan *scan, int height) { compact(scan, height + scan->gap); }

void region_scan_destroy(RegionScan *scan) {
    if (scan == NULL) return;
    free(scan->nodes);
    free(scan->kept);
    free(scan->moved);
    free(scan->column_node);
    free(scan->column_row);
    free(scan);
}

bool image_regions_find(const Image *a, const Image *b, const uint8_t *masked, const ImageDifference *difference,
                        ImageRegions *regions, Error *error) {
    const size_t width = (size_t)a->width;
    *regions = (ImageRegions){.count = 0};
    if (difference->pixels == 0) return true;
    uint8_t *levels = malloc(width);
    Scan *scan = levels != NULL ? region_scan_create(a->width, a->height, regions, error) : NULL;
    if (levels == NULL) error_memory(error, "regions");
    for (int y = difference->top; scan != NULL && y < difference->bottom; y++) {
        if (!image_row_differs(a, b, y)) continue;
        (void)image_find_levels(a, b, masked, (size_t)y * width, width, levels);
        region_scan_row(scan, y, levels);
    }
    if (scan != NULL) region_scan_end(scan, a->height);
    const bool ok = scan != NULL;
    region_scan_destroy(scan);
    free(levels);
    return ok;
}

typedef struct Stop {
    double at;
    uint8_t rgb[3];
} Stop;

/* Readable on a pale background, with steps that remain visible in grey. */
static const Stop differences[] = {{0, {255, 176, 0}}, {0.1, {250, 120, 0}}, {0.4, {214, 24, 48}}, {1, {72, 0, 110}}};
static const Stop heat[] = {
    {0, {0, 0, 4}}, {0.25, {87, 16, 110}}, {0.5, {188, 55, 84}}, {0.75, {249, 142, 9}}, {1, {252, 255, 164}}};

/* Adds `count` colours of a gradient, from its start to its end. */
static void add_gradient(Palette *palette, const Stop *stops, int count) {
    for (int i = 0; i < count; i++) {
        double at = (double)i / (count - 1);
        while (at > stops[1].at) stops++;
        double share = (at - stops[0].at) / (stops[1].at - stops[0].at);
        uint8_t *rgb = palette->rgb[palette->count++];
        for (int c = 0; c < 3; c++)
            rgb[c] = (uint8_t)(stops[0].rgb[c] + share * (stops[1].rgb[c] - stops[0].rgb[c]) + 0.5);
    }
}

/* Greys in the upper fifth of the scale, the hatch, ignored edges, the stripes beyond both pictures, and the
   gradient. */
enum { PALEST = 200, PALE = 56, HATCHED = PALE, EDGE, BEYOND, GRADIENT, STEPS = 256 - GRADIENT };
enum { HATCH_GREY = 120, HATCH = 8 };
static const uint8_t edge_color[3] = {70, 150, 235}, beyond_color[3] = {150, 120, 175};

static void make_difference_palette(Palette *palette) {
    palette->count = 0;
    for (int i = 0; i < PALE; i++) memset(palette->rgb[palette->count++], PALEST + i, 3);
    memset(palette->rgb[palette->count++], HATCH_GREY, 3);
    memcpy(palette->rgb[palette->count++], edge_color, sizeof edge_color);
    memcpy(palette->rgb[palette->count++], beyond_color, sizeof beyond_color);
    add_gradient(palette, differences, STEPS);
}

static uint8_t pale(const uint8_t *from) { return (uint8_t)((from[0] * 3 + from[1] * 6 + from[2]) / 10 * 55 / 255); }

/* From 1 to 255. */
static uint8_t gradient_of(int difference) {
    return (uint8_t)(GRADIENT + ((difference - 1) * (STEPS - 1) + 127) / 254);
}

/* Neighbours are often equal, and most pixels are equal in both pictures. */
static void draw_row(const Image *expected, const Image *actual, int y, const uint8_t *masked, uint8_t *row) {
    size_t first = (size_t)y * (size_t)expected->width;
    const uint8_t *p = expected->pixels + 4 * first, *q = actual->pixels + 4 * first;
    bool deep = expected->pixels16 != NULL || actual->pixels16 != NULL;
    uint8_t grey = 0;
    for (int x = 0; x < expected->width; x++, p += 4, q += 4) {
        size_t i = first + (size_t)x;
        if (x == 0 || memcmp(p, p - 4, 4) != 0) grey = pale(p);
        row[x] = grey;
        Ignored ignored = masked != NULL ? (Ignored)masked[i] : IGNORED_NOT;
        if (ignored == IGNORED_EDGE || ignored == IGNORED_RULE) {
            row[x] = EDGE;
        } else if (ignored == IGNORED_MASK) {
            if ((x + y) % HATCH == 0) row[x] = HATCHED;
        } else if (deep || memcmp(p, q, 4) != 0) {
            int difference = image_pixel_difference(expected, actual, i);
            if (difference > 0) row[x] = gradient_of(difference);
        }
    }
}

static void draw_beyond(int first, int width, int y, uint8_t *row) {
    for (int x = first; x < width; x++) row[x] = (x + y) / (HATCH / 2) % 2 == 0 ? BEYOND : PALE - 1;
}

uint8_t *difference_picture(const Image *expected, const Image *actual, const uint8_t *masked, int width, int height,
                            size_t *size, Error *error) {
    Palette palette = {.count = 0};
    make_difference_palette(&palette);
    IndexedPng *png = indexed_png_create(width, height, &palette, error);
    uint8_t *file = NULL;
    bool ok = png != NULL;
    for (int y = 0; ok && y < height; y++) {
        bool inside = y < expected->height;
        if (inside) draw_row(expected, actual, y, masked, indexed_png_row(png));
        draw_beyond(inside ? expected->width : 0, width, y, indexed_png_row(png));
        ok = indexed_png_add(png, error);
    }
    if (ok) file = indexed_png_end(png, size, error);
    indexed_png_destroy(png);
    return file;
}

/* Steps that are hardly visible make a smaller file. */
enum { HEAT_STEPS = 32 };

IndexedPng *heat_picture(int width, int height, Error *error) {
    Palette palette = {.count = 0};
    add_gradient(&palette, heat, HEAT_STEPS + 1);
    return indexed_png_create(width, height, &palette, error);
}

/* Only 0 gives step 0. */
static uint8_t heat_step(float value) {
    float scaled = value * HEAT_STEPS;
    int step = (int)scaled;
    step += (float)step < scaled;
    return (uint8_t)(step < HEAT_STEPS ? step : HEAT_STEPS);
}

static bool heat_row(void *context, const float *values, int width, Error *error) {
    uint8_t *row = indexed_png_row(context);
    for (int x = 0; x < width; x++) row[x] = heat_step(values[x]);
    return indexed_png_add(context, error);
}

FlipSink heat_picture_sink(IndexedPng *picture) { return (FlipSink){heat_row, picture}; }
