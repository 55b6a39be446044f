/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sketch/raster.h"

#include "common/array.h"

#include <math.h>
#include <stdlib.h>

enum { LINES = 16 }; /* scan lines per pixel; coverage along a scan line is exact */

void raster_free(Raster *raster) {
    free(raster->edges);
    *raster = (Raster){0};
}

void raster_edge(Raster *raster, double x0, double y0, double x1, double y1) {
    if (y0 == y1) return;
    if (!array_reserve((void **)&raster->edges, &raster->capacity, raster->count + 1, sizeof *raster->edges)) {
        raster->failed = true;
        return;
    }
    raster->edges[raster->count++] = y0 < y1 ? (RasterEdge){x0, y0, x1, y1, 1} : (RasterEdge){x1, y1, x0, y0, -1};
}

void pixel_over(uint8_t *pixel, const uint8_t colour[3], int alpha) {
    int below = pixel[3] * (255 - alpha), whole = alpha * 255 + below;
    if (whole == 0) return;
    for (int i = 0; i < 3; i++) pixel[i] = (uint8_t)((colour[i] * alpha * 255 + pixel[i] * below + whole / 2) / whole);
    pixel[3] = (uint8_t)((whole + 127) / 255);
}

static int by_top(const void *a, const void *b) {
    const RasterEdge *p = a, *q = b;
    return (p->y0 > q->y0) - (p->y0 < q->y0);
}

/* The intersection of an edge and a scan line. */
typedef struct Crossing {
    double x;
    int winding;
} Crossing;

/* Insertion sort: there are few crossings, almost in order. */
static void sort_crossings(Crossing *crossings, size_t count) {
    for (size_t i = 1; i < count; i++) {
        Crossing moved = crossings[i];
        size_t k = i;
        for (; k > 0 && crossings[k - 1].x > moved.x; k--) crossings[k] = crossings[k - 1];
        crossings[k] = moved;
    }
}

/* Coverage of each pixel of a row, in scan lines; 0 outside [low, high). */
typedef struct CoverRow {
    double *cover; /* [width + 1] */
    int width, low, high;
} CoverRow;

static void add_span(CoverRow *row, double from, double to) {
    from = fmin(fmax(from, 0), row->width), to = fmin(fmax(to, 0), row->width);
    if (!(from < to)) return;
    const int first = (int)from, last = (int)to;
    if (first < row->low) row->low = first;
    if (last >= row->high) row->high = last + 1;
    if (first == last) {
        row->cover[first] += to - from;
        return;
    }
    row->cover[first] += first + 1 - from;
    for (int x = first + 1; x < last; x++) row->cover[x] += 1;
    row->cover[last] += to - last;
}

/* Edges sorted by their upper end; those before `next` have started. */
typedef struct Scan {
    const RasterEdge *edges;
    size_t count, next, open_count, *open;
    Crossing *crossings;
} Scan;

static void scan_line(Scan *scan, double y, CoverRow *row) {
    const RasterEdge *edges = scan->edges;
    while (scan->next < scan->count && edges[scan->next].y0 <= y) scan->open[scan->open_count++] = scan->next++;
    size_t kept = 0;
    for (size_t i = 0; i < scan->open_count; i++) {
        const RasterEdge *edge = &edges[scan->open[i]];
        if (edge->y1 <= y) continue;
        scan->open[kept] = scan->open[i];
        double x = edge->x0 + (edge->x1 - edge->x0) * ((y - edge->y0) / (edge->y1 - edge->y0));
        scan->crossings[kept++] = (Crossing){x, edge->winding};
    }
    scan->open_count = kept;
    sort_crossings(scan->crossings, kept);
    int winding = 0;
    for (size_t i = 0; i < kept; i++) {
        if (winding != 0) add_span(row, scan->crossings[i - 1].x, scan->crossings[i].x);
        winding += scan->crossings[i].winding;
    }
}

/* Blends a row of pixels and clears its coverage. */
static void blend_row(CoverRow *row, uint32_t colour, double opacity, uint8_t *pixels) {
    const uint8_t channels[3] = {(uint8_t)(colour >> 16), (uint8_t)(colour >> 8), (uint8_t)colour};
    for (int x = row->low; x < row->high; x++) {
        int alpha = (int)(fmin(row->cover[x] / LINES, 1) * opacity * 255 + 0.5);
        if (alpha > 0 && x < row->width) pixel_over(pixels + 4 * (size_t)x, channels, alpha);
        row->cover[x] = 0;
    }
    row->low = row->width, row->high = 0;
}

void raster_fill(Raster *raster, uint32_t colour, double opacity, Image *page) {
    const size_t count = raster->count;
    raster->count = 0;
    if (count == 0) return;
    qsort(raster->edges, count, sizeof *raster->edges, by_top);
    double low = 0;
    for (size_t i = 0; i < count; i++) low = fmax(low, raster->edges[i].y1);
    const int first = (int)fmin(fmax(raster->edges[0].y0, 0), page->height), last = (int)fmin(low + 1, page->height);
    Scan scan = {raster->edges, count, 0, 0, malloc(count * sizeof *scan.open), malloc(count * sizeof *scan.crossings)};
    CoverRow row = {calloc((size_t)page->width + 1, sizeof *row.cover), page->width, page->width, 0};
    raster->failed |= scan.open == NULL || scan.crossings == NULL || row.cover == NULL;
    for (int y = first; !raster->failed && y < last; y++) {
        for (int i = 0; i < LINES; i++) scan_line(&scan, y + (i + 0.5) / LINES, &row);
        blend_row(&row, colour, opacity, page->pixels + (size_t)y * (size_t)page->width * 4);
    }
    free(scan.open);
    free(scan.crossings);
    free(row.cover);
}
