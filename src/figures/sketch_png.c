/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sketch as PNG: polygons, letters and pictures. */
#include "base/base.h"
#include "base/file.h"
#include "figures/sketch.h"
#include "figures/sketch_writers.h"
#include "pixels/gl.h"
#include "pixels/png.h"
#include "pixels/raster.h"
#include "pixels/type.h"

#include <math.h>
#include <png.h>
#include <stdlib.h>
#include <string.h>

void pixel_over(uint8_t *pixel, const uint8_t colour[3], int alpha) {
    int below = pixel[3] * (255 - alpha), whole = alpha * 255 + below;
    if (whole == 0) return;
    for (int i = 0; i < 3; i++) pixel[i] = (uint8_t)((colour[i] * alpha * 255 + pixel[i] * below + whole / 2) / whole);
    pixel[3] = (uint8_t)((whole + 127) / 255);
}

/* PNG with alpha and resolution, which frames do not need. */

/* libpng returns here by longjmp if it fails. */
static bool write_png(FILE *file, const Image *image, double dpi, bool drawn) {
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png != NULL ? png_create_info_struct(png) : NULL;
    bool alpha = false;
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++) alpha |= image->pixels[4 * i + 3] != 255;
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
    if (!alpha) png_set_filler(png, 0, PNG_FILLER_AFTER);
    for (int y = 0; y < image->height; y++) png_write_row(png, image->pixels + (size_t)y * (size_t)image->width * 4);
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

/* A sketch as pixels. Lines become polygons: a bar per segment, and a wedge on the outer side of each corner. */

typedef struct Painter {
    const Sketch *sketch;
    double scale; /* pixels per mm */
    Image *page;
    Raster raster;
    uint32_t colour; /* of the polygons in work */
    double opacity;
} Painter;

static Point on_page(const Painter *painter, Point p) {
    return (Point){painter->scale * p.x, painter->scale * (painter->sketch->height - p.y)};
}

static void blend_row(void *context, int left, int y, const double *shares, int count) {
    const Painter *painter = context;
    const uint32_t colour = painter->colour;
    const uint8_t channels[3] = {(uint8_t)(colour >> 16), (uint8_t)(colour >> 8), (uint8_t)colour};
    uint8_t *pixels = painter->page->pixels + 4 * ((size_t)y * (size_t)painter->page->width + (size_t)left);
    for (int x = 0; x < count; x++) {
        const int alpha = (int)(shares[x] * painter->opacity * 255 + 0.5);
        if (alpha > 0) pixel_over(pixels + 4 * (size_t)x, channels, alpha);
    }
}

/* Fills the polygons with a colour, 0xRRGGBB. */
static void fill(Painter *painter, uint32_t colour, double opacity) {
    painter->colour = colour, painter->opacity = opacity;
    raster_fill(&painter->raster, &(Rect){0, 0, painter->page->width, painter->page->height}, blend_row, painter);
}

static void add_polygon(Painter *painter, const Point *corners, size_t count) {
    for (size_t i = 0; i < count; i++) raster_add(&painter->raster, corners[i], corners[(i + 1) % count]);
}

/* A line, all in pixels, segment by segment. */
typedef struct Stroke {
    double half, parts[4], travelled; /* half the thickness; dashes and gaps (pixels/gl.h), all 0: solid */
    bool joined;                      /* the segment before ended where this one begins, with this side: */
    Point side;                       /* from a point of it to its edge */
} Stroke;

/* Rounds the outer side of a corner at p, between the sides a and b of the segments before and after it. All polygons
   of a line have the same direction, so that overlaps stay filled. */
static void add_wedge(Painter *painter, Point p, Point a, Point b) {
    const double cross = a.x * b.y - a.y * b.x, turn = atan2(fabs(cross), a.x * b.x + a.y * b.y);
    const Point first = cross > 0 ? a : (Point){-b.x, -b.y};
    const int parts = (int)ceil(turn / (M_PI / 8));
    Point before = {p.x + first.x, p.y + first.y};
    for (int i = 1; i <= parts; i++) {
        const double c = cos(turn * i / parts), s = sin(turn * i / parts);
        const Point next = {p.x + c * first.x - s * first.y, p.y + c * first.y + s * first.x};
        add_polygon(painter, (const Point[]){p, before, next}, 3);
        before = next;
    }
}

static void add_segment(Painter *painter, Stroke *stroke, Point p, Point q) {
    const double x = q.x - p.x, y = q.y - p.y, length = hypot(x, y);
    if (!(length > 0)) return;
    const Point side = {stroke->half * y / length, -stroke->half * x / length};
    double period = 0;
    for (int i = 0; i < 4; i++) period += stroke->parts[i];
    for (double done = 0, step; done < length; done += step) {
        bool on = true;
        step = length - done;
        if (period > 0) step = fmin(dash_left(stroke->parts, stroke->travelled, &on), step);
        if (on) {
            const double from = done / length, to = (done + step) / length;
            const Point a = {p.x + from * x, p.y + from * y}, b = {p.x + to * x, p.y + to * y};
            if (done == 0 && stroke->joined) add_wedge(painter, p, stroke->side, side);
            add_polygon(painter,
                        (const Point[]){{a.x + side.x, a.y + side.y},
                                        {b.x + side.x, b.y + side.y},
                                        {b.x - side.x, b.y - side.y},
                                        {a.x - side.x, a.y - side.y}},
                        4);
        }
        stroke->joined = on;
        stroke->travelled += step;
    }
    stroke->side = side;
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
        add_polygon(painter, points, mark->count);
        fill(painter, pen->fill, pen->opacity);
    }
    if (pen->line != NO_COLOUR) {
        Stroke stroke = {.half = pen->width * LINE_UNIT * painter->scale / 2};
        double dashes[DASHES_MAX];
        const int count = pen_dashes(pen, dashes);
        for (int i = 0; i < count; i++) stroke.parts[i] = dashes[i] * painter->scale;
        for (size_t i = 1; i < mark->count; i++) add_segment(painter, &stroke, points[i - 1], points[i]);
        if (mark->closed) {
            add_segment(painter, &stroke, points[mark->count - 1], points[0]);
            const double x = points[1].x - points[0].x, y = points[1].y - points[0].y, length = hypot(x, y);
            if (stroke.joined && length > 0) /* the last corner */
                add_wedge(painter, points[0], stroke.side,
                          (Point){stroke.half * y / length, -stroke.half * x / length});
        }
        fill(painter, pen->line, 1);
    }
    free(points);
}

/* A glyph's outline, to fill it or to stroke its halo. */
typedef struct Tracer {
    OutlineTracer outline;
    Painter *painter;
    Point origin;    /* of the glyph, pixels */
    double x_x, x_y; /* the font's x unit vector, pixels */
    Stroke halo;     /* of no thickness: none */
    Point end;       /* of the line before */
} Tracer;

static Point glyph_point(const OutlineTracer *outline, const OutlineStep *step) {
    const Tracer *tracer = (const Tracer *)outline;
    return (Point){tracer->origin.x + step->x * tracer->x_x + step->y * tracer->x_y,
                   tracer->origin.y + step->x * tracer->x_y - step->y * tracer->x_x};
}

static void glyph_line(OutlineTracer *outline, Point from, Point to) {
    Tracer *tracer = (Tracer *)outline;
    if (!(tracer->halo.half > 0)) {
        raster_add(&tracer->painter->raster, from, to);
        return;
    }
    tracer->halo.joined &= from.x == tracer->end.x && from.y == tracer->end.y;
    add_segment(tracer->painter, &tracer->halo, from, to);
    tracer->end = to;
}

static void draw_glyphs(Painter *painter, const SketchMark *mark, double halo, uint32_t colour) {
    const TextPlace place = text_place(painter->sketch, mark);
    const double unit = place.em * painter->scale / type_units;
    enum { PARTS = 8 }; /* of a curve */
    Tracer tracer = {.outline = {glyph_point, glyph_line, PARTS},
                     .painter = painter,
                     .origin = on_page(painter, place.from),
                     .x_x = unit * place.cosine,
                     .x_y = -unit * place.sine,
                     .halo = {.half = halo}};
    for (const char *text = painter->sketch->texts + mark->text; *text != '\0';) {
        const Glyph *glyph = type_next(&text);
        outline_trace(&tracer.outline, &type_regular, glyph);
        tracer.origin.x += glyph->advance * tracer.x_x;
        tracer.origin.y += glyph->advance * tracer.x_y;
    }
    fill(painter, colour, 1);
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

char *sketch_as_png(const Sketch *sketch, const SketchOutput *output, size_t *size, Error *error) {
    if (!sketch_check_pixels(sketch->width, sketch->height, output->dpi, error)) return NULL;
    const double scale = output->dpi / 25.4;
    Painter painter = {.sketch = sketch, .scale = scale};
    bool images = false;
    painter.page = image_create((int)lrint(scale * sketch->width), (int)lrint(scale * sketch->height), error);
    size_t *order = sketch_order(sketch);
    char *data = NULL;
    if (painter.page != NULL && order != NULL) {
        if (!output->transparent)
            memset(painter.page->pixels, 255, (size_t)painter.page->width * (size_t)painter.page->height * 4);
        for (size_t i = 0; i < sketch->mark_count; i++) {
            const SketchMark *mark = &sketch->marks[order[i]];
            const double em = mark->style.points * MM_PER_POINT * scale;
            switch (mark->kind) {
            case MARK_IMAGE: draw_image(&painter, mark); break;
            case MARK_PATH: draw_path(&painter, mark); break;
            case MARK_TEXT:
                if (mark->style.halo) draw_glyphs(&painter, mark, HALO_SHARE * em, 0xFFFFFF);
                draw_glyphs(&painter, mark, 0, mark->style.colour);
                break;
            }
            images |= mark->kind == MARK_IMAGE;
        }
        if (painter.raster.failed)
            error_memory(error, "figure");
        else
            data = picture_as_png(painter.page, output->dpi, !images, size, error);
    } else if (painter.page != NULL)
        error_memory(error, "figure");
    raster_free(&painter.raster);
    image_destroy(painter.page);
    free(order);
    return data;
}
