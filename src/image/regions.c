/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Connected components in one pass from top to bottom. Of the rows above, only the last differing pixel of each column
   matters: an earlier one within reach is in the same region. Regions are joined by union-find; those that no column
   reaches any more are complete, and their nodes are used again. */
#include "image/regions.h"

#include <stdlib.h>
#include <string.h>

typedef struct Node {
    int parent; /* itself: a root */
    ImageRegion region;
} Node;

typedef struct Scan {
    int width, gap;
    int node_count, capacity;
    Node *nodes;      /* [capacity] */
    Node *kept;       /* [capacity], scratch of compact() */
    int *moved;       /* [capacity], scratch of compact() */
    int *column_node; /* [width] of the last differing pixel of a column */
    int *column_row;  /* [width] its row; far above the picture: none */
    bool *differs;    /* [width] of the current row */
    ImageRegions *regions;
} Scan;

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

static int min(int a, int b) { return a < b ? a : b; }
static int max(int a, int b) { return a > b ? a : b; }

static int join(Scan *scan, int a, int b) {
    int root = root_of(scan->nodes, a), other = root_of(scan->nodes, b);
    if (root == other) return root;
    ImageRegion *to = &scan->nodes[root].region;
    const ImageRegion *from = &scan->nodes[other].region;
    *to = (ImageRegion){to->pixels + from->pixels, min(to->left, from->left), min(to->top, from->top),
                        max(to->right, from->right), max(to->bottom, from->bottom)};
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
static void add_run(Scan *scan, int left, int right, int64_t pixels, int row) {
    int node = scan->node_count++;
    scan->nodes[node] = (Node){node, {pixels, left, row, right + 1, row + 1}};
    int first = max(left - scan->gap, 0), last = min(right + scan->gap, scan->width - 1);
    for (int x = first; x <= last; x++)
        if (scan->column_row[x] >= row - scan->gap) node = join(scan, node, scan->column_node[x]);
    for (int x = left; x <= right; x++)
        if (scan->differs[x]) scan->column_node[x] = node, scan->column_row[x] = row;
}

static void add_row(Scan *scan, int left, int right, int row) {
    int start = -1, last = 0;
    int64_t pixels = 0;
    if (scan->node_count + scan->width > scan->capacity) compact(scan, row);
    for (int x = left; x < right; x++) {
        if (!scan->differs[x]) continue;
        if (start >= 0 && x - last > scan->gap) add_run(scan, start, last, pixels, row), start = -1;
        if (start < 0) start = x, pixels = 0;
        last = x;
        pixels++;
    }
    if (start >= 0) add_run(scan, start, last, pixels, row);
}

static void scan_rows(Scan *scan, const Image *a, const Image *b, const uint8_t *masked, const ImageDifference *box) {
    for (int y = box->top; y < box->bottom; y++) {
        size_t first = (size_t)y * (size_t)scan->width;
        size_t right = (size_t)box->right, x = image_next_difference(a, b, first, (size_t)box->left);
        bool any = false;
        if (x < right) memset(scan->differs, 0, (size_t)scan->width * sizeof *scan->differs);
        for (; x < right; x = image_next_difference(a, b, first, x + 1)) {
            size_t pixel = first + x;
            scan->differs[x] = (masked == NULL || masked[pixel] == 0) && image_pixel_difference(a, b, pixel) > 0;
            any = any || scan->differs[x];
        }
        if (any) add_row(scan, box->left, box->right, y);
    }
    /* Beyond the reach of every row: all regions are complete. */
    compact(scan, box->bottom + scan->gap);
}

bool image_regions_find(const Image *a, const Image *b, const uint8_t *masked, const ImageDifference *difference,
                        ImageRegions *regions, Error *error) {
    Scan scan = {.width = a->width, .gap = image_regions_gap(a->width, a->height), .regions = regions};
    size_t width = (size_t)a->width;
    *regions = (ImageRegions){.count = 0};
    if (difference->pixels == 0) return true;
    scan.capacity = 3 * a->width;
    scan.nodes = calloc((size_t)scan.capacity, sizeof *scan.nodes);
    scan.kept = malloc((size_t)scan.capacity * sizeof *scan.kept);
    scan.moved = calloc((size_t)scan.capacity, sizeof *scan.moved);
    scan.column_node = calloc(width, sizeof *scan.column_node);
    scan.column_row = calloc(width, sizeof *scan.column_row);
    scan.differs = malloc(width * sizeof *scan.differs);
    bool ok = (scan.nodes != NULL && scan.kept != NULL && scan.moved != NULL && scan.column_node != NULL &&
               scan.column_row != NULL && scan.differs != NULL) ||
              error_memory(error, "regions");
    for (size_t x = 0; ok && x < width; x++) scan.column_row[x] = INT32_MIN / 2, scan.column_node[x] = 0;
    if (ok) scan_rows(&scan, a, b, masked, difference);
    free(scan.nodes);
    free(scan.kept);
    free(scan.moved);
    free(scan.column_node);
    free(scan.column_row);
    free(scan.differs);
    return ok;
}
