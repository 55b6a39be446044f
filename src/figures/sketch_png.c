/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sketch as PNG: a rasteriser of polygons, letters and pictures. */
#include "base/base.h"
#include "base/file.h"
#include "figures/figures_internal.h"
#include "figures/sketch.h"
#include "pixels/png.h"
#include "pixels/type.h"

#include <math.h>
#include <png.h>
#include <stdlib.h>
#include <string.h>

/* A polygon rasteriser with antialiasing by scan-line coverage. Pixels, y down. */

typedef struct RasterEdge {
    double x0, y0, x1, y1; /* y0 < y1 */
    int winding;           /* 1 or -1 */
} RasterEdge;

/* Initialise with zeros. */
typedef struct Raster {
    RasterEdge *edges;
    size_t count, capacity;
    bool failed; /* out of memory */
} Raster;

enum { LINES = 16 }; /* scan lines per pixel; coverage along a scan line is exact */

static void raster_free(Raster *raster) {
    free(raster->edges);
    *raster = (Raster){0};
}

/* Adds a side of a polygon. */
static void raster_edge(Raster *raster, double x0, double y0, double x1, double y1) {
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

/* Fills the interior of the edges (nonzero winding) with a colour, 0xRRGGBB, and removes the edges. */
static void raster_fill(Raster *raster, uint32_t colour, double opacity, Image *page) {
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

/* PNG with alpha and resolution, which frames do not need. */

static void write_rows(png_structp png, const Image *image, bool alpha) {
    if (!alpha) png_set_filler(png, 0, PNG_FILLER_AFTER);
    for (int y = 0; y < image->height; y++) png_write_row(png, image->pixels + (size_t)y * (size_t)image->width * 4);
}

/* libpng returns here by longjmp if it fails. */
static bool write_png(FILE *file, const Image *image, double dpi, bool drawn) {
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png != NULL ? png_create_info_struct(png) : NULL;
    const bool alpha = has_alpha(image);
    if (info == NULL || setjmp(png_jmpbuf(png))) {
        png_destroy_write_struct(&png, &info);
        return false;
    }
    png_init_io(png, file);
    png_set_compression_level(png, 9);
    if (drawn) png_set_filter(png, 0, PNG_FILTER_NONE);
    png_set_IHDR(png, info, (png_uint_32)image->width, (png_uint_32)image->height, 8,
                 alpha ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    const png_uint_32 dots = (png_uint_32)lrint(dpi / 0.0254);
    if (dpi > 0) png_set_pHYs(png, info, dots, dots, PNG_RESOLUTION_METER);
    png_write_info(png, info);
    write_rows(png, image, alpha);
    png_write_end(png, NULL);
    png_destroy_write_struct(&png, &info);
    return true;
}

char *picture_as_png(const Image *image, double dpi, bool drawn, size_t *size, Error *error) {
    char *data = NULL;
    FILE *file = memory_stream(&data, size);
    bool whole = file != NULL && write_png(file, image, dpi, drawn) && !ferror(file);
    if (file != NULL) whole = fclose(file) == 0 && whole;
    if (whole) return data;
    free(data);
    return error_memory(error, "figure"), NULL;
}

/* A sketch as pixels. Lines become polygons: a bar per segment and a disc per corner. */

typedef struct Painter {
    const Sketch *sketch;
    double scale; /* pixels per mm */
    Image *page;
    Raster raster;
} Painter;

static Point on_page(const Painter *painter, Point p) {
    return (Point){painter->scale * p.x, painter->scale * (painter->sketch->height - p.y)};
}

static void add_edge(Painter *painter, Point from, Point to) {
    raster_edge(&painter->raster, from.x, from.y, to.x, to.y);
}

/* All bars and discs have the same orientation, so that overlaps stay filled. */
static void add_bar(Painter *painter, Point p, Point q, double half) {
    double length = hypot(q.x - p.x, q.y - p.y);
    if (!(length > 0)) return;
    double x = half * (q.y - p.y) / length, y = -half * (q.x - p.x) / length;
    const Point corners[4] = {{p.x + x, p.y + y}, {q.x + x, q.y + y}, {q.x - x, q.y - y}, {p.x - x, p.y - y}};
    for (int i = 0; i < 4; i++) add_edge(painter, corners[i], corners[(i + 1) % 4]);
}

static void add_disc(Painter *painter, Point at, double radius) {
    enum { CORNERS = 16 };
    Point before = {at.x + radius, at.y};
    for (int i = 1; i <= CORNERS; i++) {
        double angle = 2 * M_PI * i / CORNERS;
        Point next = {at.x + radius * cos(angle), at.y + radius * sin(angle)};
        add_edge(painter, before, next);
        before = next;
    }
}

/* A line, all in pixels, split into dashes. */
static void add_dashed_line(Painter *painter, const Point *points, size_t count, bool closed, double half,
                            const double *dashes, int dash_count) {
    int dash = 0;
    double left = dash_count > 0 ? dashes[0] : HUGE_VAL;
    size_t parts = closed ? count : count - 1;
    for (size_t i = 0; i < parts; i++) {
        Point p = points[i], q = points[(i + 1) % count];
        double length = hypot(q.x - p.x, q.y - p.y), done = 0;
        bool drawn = dash % 2 == 0;
        if (drawn && (i > 0 || closed)) add_disc(painter, p, half);
        while (done < length) {
            double step = fmin(left, length - done), from = done / length, to = (done + step) / length;
            if (dash % 2 == 0)
                add_bar(painter, (Point){p.x + from * (q.x - p.x), p.y + from * (q.y - p.y)},
                        (Point){p.x + to * (q.x - p.x), p.y + to * (q.y - p.y)}, half);
            done += step;
            left -= step;
            if (left > 0) continue;
            dash = (dash + 1) % (dash_count + dash_count % 2);
            left = dashes[dash % dash_count];
        }
    }
}

static void draw_path(Painter *painter, const SketchMark *mark) {
    const Pen *pen = &mark->pen;
    Point *points = calloc(mark->count, sizeof *points);
    if (points == NULL) {
        painter->raster.failed = true;
        return;
    }
    for (size_t i = 0; i < mark->count; i++) points[i] = on_page(painter, painter->sketch->points[mark->first + i]);
    if (mark->closed && pen->fill != NO_COLOUR) {
        for (size_t i = 0; i < mark->count; i++) add_edge(painter, points[i], points[(i + 1) % mark->count]);
        raster_fill(&painter->raster, pen->fill, pen->opacity, painter->page);
    }
    if (pen->line != NO_COLOUR) {
        double dashes[DASHES_MAX];
        int count = pen_dashes(pen, dashes);
        for (int i = 0; i < count; i++) dashes[i] *= painter->scale;
        add_dashed_line(painter, points, mark->count, mark->closed, pen->width * LINE_UNIT * painter->scale / 2, dashes,
                        count);
        raster_fill(&painter->raster, pen->line, 1, painter->page);
    }
    free(points);
}

/* A glyph's outline, to fill it or to stroke its halo. */
typedef struct Tracer {
    OutlineTracer outline;
    Painter *painter;
    Point origin;          /* of the glyph, pixels */
    double x_x, x_y, halo; /* the font's x unit vector, pixels; half the halo's width, or 0 */
} Tracer;

static Point glyph_point(const OutlineTracer *outline, const OutlineStep *step) {
    const Tracer *tracer = (const Tracer *)outline;
    return (Point){tracer->origin.x + step->x * tracer->x_x + step->y * tracer->x_y,
                   tracer->origin.y + step->x * tracer->x_y - step->y * tracer->x_x};
}

static void glyph_line(OutlineTracer *outline, Point from, Point to) {
    const Tracer *tracer = (const Tracer *)outline;
    if (tracer->halo > 0) {
        add_bar(tracer->painter, from, to, tracer->halo);
        add_disc(tracer->painter, to, tracer->halo);
    } else
        add_edge(tracer->painter, from, to);
}

static void draw_glyphs(Painter *painter, const SketchMark *mark, double halo, uint32_t colour) {
    const TextPlace place = text_place(painter->sketch, mark);
    const double unit = place.em * painter->scale / type_units;
    enum { PARTS = 8 }; /* of a curve */
    Tracer tracer = {{glyph_point, glyph_line, PARTS},
                     painter,
                     on_page(painter, place.from),
                     unit * place.cosine,
                     -unit * place.sine,
                     halo};
    for (const char *text = painter->sketch->texts + mark->text; *text != '\0';) {
        const Glyph *glyph = type_next(&text);
        outline_trace(&tracer.outline, &type_regular, glyph);
        tracer.origin.x += glyph->advance * tracer.x_x;
        tracer.origin.y += glyph->advance * tracer.x_y;
    }
    raster_fill(&painter->raster, colour, 1, painter->page);
}

static void draw_text(Painter *painter, const SketchMark *mark) {
    const double em = mark->style.points * MM_PER_POINT * painter->scale;
    if (mark->style.halo) draw_glyphs(painter, mark, HALO_SHARE * em, 0xFFFFFF);
    draw_glyphs(painter, mark, 0, mark->style.colour);
}

/* Snapped to whole pixels, nearest neighbour: a picture at its own size keeps every pixel. */
static void draw_image(Painter *painter, const SketchMark *mark) {
    const Image *image = mark->image;
    Image *page = painter->page;
    const double width = mark->width * painter->scale, height = width * image->height / image->width;
    const int columns = (int)lrint(width), rows = (int)lrint(height);
    const Point low = on_page(painter, mark->at);
    const int left = (int)lrint(low.x), top = (int)lrint(low.y) - rows;
    for (int y = 0; y < rows; y++)
        for (int x = 0; x < columns; x++) {
            if (left + x < 0 || top + y < 0 || left + x >= page->width || top + y >= page->height) continue;
            size_t from_x = (size_t)((x + 0.5) * image->width / columns);
            size_t from_y = (size_t)((y + 0.5) * image->height / rows);
            const uint8_t *pixel = image->pixels + 4 * (from_y * (size_t)image->width + from_x);
            uint8_t *to = page->pixels + 4 * ((size_t)(top + y) * (size_t)page->width + (size_t)(left + x));
            pixel_over(to, pixel, pixel[3]);
        }
}

static void draw_mark(Painter *painter, const SketchMark *mark) {
    switch (mark->kind) {
    case MARK_IMAGE: draw_image(painter, mark); break;
    case MARK_PATH: draw_path(painter, mark); break;
    case MARK_TEXT: draw_text(painter, mark); break;
    }
}

static bool has_images(const Sketch *sketch) {
    for (size_t i = 0; i < sketch->mark_count; i++)
        if (sketch->marks[i].kind == MARK_IMAGE) return true;
    return false;
}

char *sketch_as_png(const Sketch *sketch, const SketchOutput *output, size_t *size, Error *error) {
    if (!sketch_check_pixels(sketch->width, sketch->height, output->dpi, error)) return NULL;
    const double scale = output->dpi / 25.4;
    Painter painter = {sketch, scale, NULL, {0}};
    painter.page = image_create((int)lrint(scale * sketch->width), (int)lrint(scale * sketch->height), error);
    size_t *order = sketch_order(sketch);
    char *data = NULL;
    if (painter.page != NULL && order != NULL) {
        if (!output->transparent)
            memset(painter.page->pixels, 255, (size_t)painter.page->width * (size_t)painter.page->height * 4);
        for (size_t i = 0; i < sketch->mark_count; i++) draw_mark(&painter, &sketch->marks[order[i]]);
        if (painter.raster.failed)
            error_memory(error, "figure");
        else
            data = picture_as_png(painter.page, output->dpi, !has_images(sketch), size, error);
    } else if (painter.page != NULL)
        error_memory(error, "figure");
    raster_free(&painter.raster);
    image_destroy(painter.page);
    free(order);
    return data;
}
