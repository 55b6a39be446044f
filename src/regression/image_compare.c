/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Counts what differs between two pictures, and finds its regions: connected components in one pass from top to
   bottom. Of the rows above, only the last differing pixel of each column matters: an earlier one within reach is in
   the same region. Regions are joined by union-find; those that no column reaches any more are complete, and their
   nodes are used again. */
#include "regression/image_compare.h"

#include "base/base.h"
#include "base/numbers.h"
#include "pixels/png.h"
#include "regression/antialias.h"

#include <stdlib.h>
#include <string.h>

static bool is_deep(const Image *a, const Image *b) { return a->pixels16 != NULL || b->pixels16 != NULL; }

int image_pixel_difference(const Image *a, const Image *b, size_t pixel) {
    int largest = 0;
    for (size_t i = 4 * pixel; i < 4 * pixel + 4; i++) {
        int difference = abs(a->pixels[i] - b->pixels[i]);
        if (is_deep(a, b)) {
            const int of_a = a->pixels16 != NULL ? a->pixels16[i] : a->pixels[i] * 257;
            const int of_b = b->pixels16 != NULL ? b->pixels16[i] : b->pixels[i] * 257;
            difference = (abs(of_a - of_b) + 256) / 257;
        }
        largest = int_max(largest, difference);
    }
    return largest;
}

int64_t image_find_levels(const Image *a, const Image *b, const uint8_t *masked, size_t first, size_t count,
                          uint8_t *levels) {
    int64_t moved = 0;
    if (is_deep(a, b))
        for (size_t i = 0; i < count; i++) levels[i] = (uint8_t)image_pixel_difference(a, b, first + i);
    else
        image_levels(a->pixels + 4 * first, b->pixels + 4 * first, count, levels);
    for (size_t i = 0; masked != NULL && i < count; i++) {
        if (masked[first + i] == IGNORED_NOT) continue;
        moved += levels[i] > 0 && masked[first + i] != IGNORED_MASK;
        levels[i] = 0;
    }
    return moved;
}

/* Whether rows of pictures of equal size may differ; certain where both have 8 bits. */
static bool row_differs(const Image *a, const Image *b, int y) {
    const size_t bytes = 4 * (size_t)a->width, first = (size_t)y * bytes;
    return a != b && (is_deep(a, b) || memcmp(a->pixels + first, b->pixels + first, bytes) != 0);
}

enum { FEW = 240 }; /* pixels whose counts fit into a byte, so that a loop over them is vectorised */

/* Adds pixels of row y, from column `left` on, to the difference; rows are added from the top. */
static void count_levels(ImageDifference *difference, int left, int y, const uint8_t *levels, int count,
                         int tolerance) {
    for (int at = 0; at < count; at += FEW) {
        const uint8_t *const few = levels + at;
        const int x = left + at, end = int_min(count - at, FEW);
        uint8_t differing = 0, beyond = 0, largest = 0;
        for (int i = 0; i < end; i++) {
            differing = (uint8_t)(differing + (few[i] > 0));
            beyond = (uint8_t)(beyond + (few[i] > tolerance));
            largest = few[i] > largest ? few[i] : largest;
        }
        if (differing == 0) continue;
        int first = 0, last = end - 1;
        while (few[first] == 0) first++;
        while (few[last] == 0) last--;
        if (difference->pixels == 0) {
            difference->first_x = difference->left = x + first;
            difference->first_y = difference->top = y;
        }
        difference->pixels += differing;
        difference->beyond += beyond;
        difference->largest = int_max(difference->largest, largest);
        difference->left = int_min(difference->left, x + first);
        difference->right = int_max(difference->right, x + last + 1);
        difference->bottom = y + 1;
    }
}

void image_compare_masked(const Image *a, const Image *b, const uint8_t *masked, int tolerance,
                          ImageDifference *difference) {
    const size_t width = (size_t)a->width, all = width * (size_t)a->height;
    uint8_t levels[FEW];
    *difference =
        (ImageDifference){.same_size = a->width == b->width && a->height == b->height, .first_x = -1, .first_y = -1};
    if (!difference->same_size) return;
    difference->counted = (int64_t)all;
    for (size_t i = 0; masked != NULL && i < all; i++) difference->counted -= masked[i] == IGNORED_MASK;
    for (int y = 0; y < a->height; y++) {
        if (!row_differs(a, b, y)) continue;
        for (int x = 0; x < a->width; x += FEW) {
            const int count = int_min(a->width - x, FEW);
            difference->moved += image_find_levels(a, b, masked, (size_t)y * width + (size_t)x, (size_t)count, levels);
            count_levels(difference, x, y, levels, count, tolerance);
        }
    }
    difference->equal = difference->pixels == 0;
}

void image_cut_to_overlap(Image *a, Image *b) {
    Image *const images[] = {a, b};
    const int width = int_min(a->width, b->width), height = int_min(a->height, b->height);
    const size_t to = 4 * (size_t)width;
    for (int i = 0; i < 2; i++) {
        Image *image = images[i];
        const size_t from = 4 * (size_t)image->width;
        /* In place: the first byte of a row never lies after its new place. */
        for (size_t y = 0; y < (size_t)height && to < from; y++) {
            memmove(image->pixels + y * to, image->pixels + y * from, to);
            if (image->pixels16 != NULL)
                memmove(image->pixels16 + y * to, image->pixels16 + y * from, to * sizeof *image->pixels16);
        }
        image->width = width;
        image->height = height;
    }
}

typedef struct Node {
    int parent; /* itself: a root */
    ImageRegion region;
} Node;

struct RegionScan {
    int width, gap;
    int node_count, capacity;
    Node *nodes;           /* [capacity] */
    Node *kept;            /* [capacity], scratch of compact() */
    int *moved;            /* [capacity], scratch of compact() */
    int *column_node;      /* [width] of the last differing pixel of a column */
    int *column_row;       /* [width] its row; far above the picture: none */
    uint8_t *marked;       /* [width], scratch: pixels along edges */
    int64_t looked, edges; /* pixels of which it is known whether they are along edges, and those that are */
    bool gives_up;         /* edges are not looked for any more */
    ImageRegions *regions;
};

static void free_scan(RegionScan *scan) {
    if (scan == NULL) return;
    free(scan->nodes);
    free(scan->kept);
    free(scan->moved);
    free(scan->column_node);
    free(scan->column_row);
    free(scan->marked);
    free(scan);
}

/* NULL with error set if out of memory. The regions are complete, and must last, until end_scan(). */
static RegionScan *create_scan(int width, int height, ImageRegions *regions, Error *error) {
    const size_t columns = (size_t)width, capacity = 3 * columns;
    const int gap = int_min(width, height) / 120;
    RegionScan *scan = calloc(1, sizeof *scan);
    if (scan == NULL) return error_memory(error, "regions"), NULL;
    *scan = (RegionScan){.width = width,
                         .gap = int_min(int_max(gap, REGION_GAP), 3 * REGION_GAP),
                         .capacity = (int)capacity,
                         .regions = regions};
    *regions = (ImageRegions){.count = 0};
    scan->nodes = calloc(capacity, sizeof *scan->nodes);
    scan->kept = malloc(capacity * sizeof *scan->kept);
    scan->moved = calloc(capacity, sizeof *scan->moved);
    scan->column_node = calloc(columns, sizeof *scan->column_node);
    scan->column_row = calloc(columns, sizeof *scan->column_row);
    scan->marked = malloc(columns);
    if (scan->nodes == NULL || scan->kept == NULL || scan->moved == NULL || scan->column_node == NULL ||
        scan->column_row == NULL || scan->marked == NULL) {
        error_memory(error, "regions");
        return free_scan(scan), NULL;
    }
    for (size_t x = 0; x < columns; x++) scan->column_row[x] = INT32_MIN / 2;
    return scan;
}

static int root_of(Node *nodes, int node) {
    while (nodes[node].parent != node) {
        nodes[node].parent = nodes[nodes[node].parent].parent;
        node = nodes[node].parent;
    }
    return node;
}

static int join(RegionScan *scan, int a, int b) {
    int root = root_of(scan->nodes, a), other = root_of(scan->nodes, b);
    if (root == other) return root;
    ImageRegion *to = &scan->nodes[root].region;
    const ImageRegion *from = &scan->nodes[other].region;
    *to = (ImageRegion){.pixels = to->pixels + from->pixels,
                        .edges = to->edges + from->edges,
                        .left = int_min(to->left, from->left),
                        .top = int_min(to->top, from->top),
                        .right = int_max(to->right, from->right),
                        .bottom = int_max(to->bottom, from->bottom),
                        .largest = int_max(to->largest, from->largest)};
    scan->nodes[other].parent = root;
    return root;
}

/* Of regions that are complete. */
static void keep_largest(ImageRegions *regions, const ImageRegion *region) {
    int at = regions->kept;
    regions->count++;
    regions->edges += region->edges;
    for (; at > 0; at--) {
        const ImageRegion *other = &regions->list[at - 1];
        if (region->pixels != other->pixels ? region->pixels < other->pixels
            : region->top != other->top     ? region->top > other->top
                                            : region->left >= other->left)
            break;
    }
    if (at == IMAGE_REGIONS_MAX) return;
    int last = regions->kept < IMAGE_REGIONS_MAX ? regions->kept++ : IMAGE_REGIONS_MAX - 1;
    memmove(&regions->list[at + 1], &regions->list[at], (size_t)(last - at) * sizeof *region);
    regions->list[at] = *region;
}

/* Completes the regions that no differing pixel from row `row` on can reach, and renumbers the others. */
static void compact(RegionScan *scan, int row) {
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

/* Adds a row, from the top; those without a difference may be left out. edges: the rows around it, of both pictures,
   unless the scan gives up. */
static void scan_row(RegionScan *scan, int y, const uint8_t *levels, EdgeRows edges[2]) {
    int *const nodes = scan->column_node, *const rows = scan->column_row;
    const int reach = y - scan->gap;
    if (scan->node_count + scan->width > scan->capacity) compact(scan, y);
    memset(scan->marked, IGNORED_NOT, (size_t)scan->width);
    if (!scan->gives_up) edge_rows_mark(&edges[0], &edges[1], y, levels, scan->marked);
    for (int left = next_pixel(levels, 0, scan->width); left < scan->width;) {
        /* A run of differing pixels, whose gaps are no larger than the gap, */
        int right = left, x = left;
        ImageRegion run = {.left = left, .top = y, .bottom = y + 1};
        for (; x < scan->width && x - right <= scan->gap; x++) {
            if (levels[x] == 0) continue;
            right = x, run.pixels++;
            run.edges += scan->marked[x] == IGNORED_EDGE;
            run.largest = int_max(run.largest, levels[x]);
        }
        run.right = right + 1;
        /* is joined with the regions that it reaches. */
        int node = scan->node_count++, known = -1;
        scan->nodes[node] = (Node){node, run};
        const int first = int_max(left - scan->gap, 0), last = int_min(right + scan->gap, scan->width - 1);
        for (int at = first; at <= last; at++) {
            if (rows[at] < reach || nodes[at] == known) continue;
            known = nodes[at];
            node = join(scan, node, known);
        }
        for (int at = left; at <= right; at++) {
            nodes[at] = levels[at] > 0 ? node : nodes[at];
            rows[at] = levels[at] > 0 ? y : rows[at];
        }
        scan->looked += run.pixels;
        scan->edges += run.edges;
        left = next_pixel(levels, x, scan->width);
    }
    scan->gives_up = scan->gives_up || (scan->looked >= EDGES_SAMPLE && 2 * scan->edges < scan->looked);
}

/* Beyond the reach of every row, all regions are complete. Edges of a part of the picture tell nothing. */
static void end_scan(RegionScan *scan, int height) {
    compact(scan, height + scan->gap);
    if (!scan->gives_up) return;
    scan->regions->edges = 0;
    for (int i = 0; i < scan->regions->kept; i++) scan->regions->list[i].edges = 0;
}

bool image_regions_find(const Image *a, const Image *b, const uint8_t *masked, const ImageDifference *difference,
                        ImageRegions *regions, Error *error) {
    const size_t width = (size_t)a->width;
    *regions = (ImageRegions){.count = 0};
    if (difference->pixels == 0) return true;
    EdgeRows sides[2] = {{0}, {0}};
    uint8_t *levels = malloc(width);
    const bool room = levels != NULL && edge_rows_create(&sides[0], a->width, a->height) &&
                      edge_rows_create(&sides[1], a->width, a->height);
    RegionScan *scan = room ? create_scan(a->width, a->height, regions, error) : NULL;
    if (!room) error_memory(error, "regions");
    for (int y = difference->top; scan != NULL && y < difference->bottom; y++) {
        if (!row_differs(a, b, y)) continue;
        (void)image_find_levels(a, b, masked, (size_t)y * width, width, levels);
        if (!scan->gives_up) edge_rows_load(&sides[0], a, y), edge_rows_load(&sides[1], b, y);
        scan_row(scan, y, levels, sides);
    }
    const bool ok = scan != NULL;
    if (ok) end_scan(scan, a->height);
    free_scan(scan);
    free(levels);
    free(sides[0].memory), free(sides[1].memory);
    return ok;
}

bool row_compare_begin(RowCompare *compare, int width, int height, int tolerance, uint8_t *all_levels) {
    *compare = (RowCompare){.width = width, .height = height, .tolerance = tolerance, .all_levels = all_levels};
    compare->difference =
        (ImageDifference){.same_size = true, .counted = (int64_t)width * height, .first_x = -1, .first_y = -1};
    compare->levels = malloc(EDGE_ROWS * (size_t)width);
    return (compare->levels != NULL && edge_rows_create(&compare->sides[0], width, height) &&
            edge_rows_create(&compare->sides[1], width, height)) ||
           error_memory(&compare->error, "image");
}

/* Adds the rows above `end` that wait to the regions. */
static void add_pending(RowCompare *compare, int end) {
    for (int y = int_max(compare->pending, end - EDGE_ROWS); y < end; y++) {
        const int slot = y % EDGE_ROWS;
        if (!compare->differs[slot] || compare->scan == NULL) continue;
        scan_row(compare->scan, y, compare->levels + (size_t)slot * (size_t)compare->width, compare->sides);
        compare->differs[slot] = false;
    }
    compare->pending = int_max(compare->pending, end);
}

void row_compare_row(RowCompare *compare, int y, bool differs) {
    EdgeRows *const a = &compare->sides[0], *const b = &compare->sides[1];
    const size_t width = (size_t)compare->width;
    uint8_t *const first = edge_rows_place(a, y), *const second = edge_rows_place(b, y);
    uint8_t *const levels = compare->levels + width * (size_t)(y % EDGE_ROWS);
    if (compare->error.kind != ERROR_NONE) return;
    if (differs) {
        image_levels(first, second, width, levels);
        count_levels(&compare->difference, 0, y, levels, compare->width, compare->tolerance);
        if (compare->all_levels != NULL) memcpy(compare->all_levels + width * (size_t)y, levels, width);
        if (compare->scan == NULL)
            compare->scan = create_scan(compare->width, compare->height, &compare->regions, &compare->error);
    }
    compare->differs[y % EDGE_ROWS] = differs;
    if (compare->scan == NULL || !compare->scan->gives_up) {
        if (!differs) memcpy(second, first, 4 * width);
        edge_rows_add(a, y);
        edge_rows_add(b, y);
    }
    add_pending(compare, y - EDGE_REACH + 1);
}

bool row_compare_end(RowCompare *compare) {
    add_pending(compare, compare->height);
    if (compare->scan != NULL) end_scan(compare->scan, compare->height);
    compare->difference.equal = compare->difference.pixels == 0;
    return compare->error.kind == ERROR_NONE;
}

void row_compare_free(RowCompare *compare) {
    free_scan(compare->scan);
    free(compare->levels);
    free(compare->sides[0].memory), free(compare->sides[1].memory);
}
