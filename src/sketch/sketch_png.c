/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sketch as pixels. Lines become polygons: a bar per segment and a disc per corner. */
#include "sketch/raster.h"
#include "sketch/sketch_formats.h"
#include "type/type.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

/* Follows a glyph's outline, to fill it or to stroke its halo. */
typedef struct Tracer {
    Painter *painter;
    Point origin;          /* of the glyph, pixels */
    double x_x, x_y, halo; /* the font's x unit vector, pixels; half the halo's width, or 0 */
    Point start, at;
} Tracer;

static Point glyph_point(const Tracer *tracer, const OutlineStep *step) {
    return (Point){tracer->origin.x + step->x * tracer->x_x + step->y * tracer->x_y,
                   tracer->origin.y + step->x * tracer->x_y - step->y * tracer->x_x};
}

static void trace_line(Tracer *tracer, Point to) {
    if (tracer->halo > 0) {
        add_bar(tracer->painter, tracer->at, to, tracer->halo);
        add_disc(tracer->painter, to, tracer->halo);
    } else
        add_edge(tracer->painter, tracer->at, to);
    tracer->at = to;
}

static void trace_curve(Tracer *tracer, Point b, Point c, Point d) {
    enum { PARTS = 8 };
    const Point a = tracer->at;
    for (int i = 1; i <= PARTS; i++) {
        double t = (double)i / PARTS, s = 1 - t;
        trace_line(tracer, (Point){s * s * s * a.x + 3 * s * s * t * b.x + 3 * s * t * t * c.x + t * t * t * d.x,
                                   s * s * s * a.y + 3 * s * s * t * b.y + 3 * s * t * t * c.y + t * t * t * d.y});
    }
}

static void trace_glyph(Tracer *tracer, const Glyph *glyph) {
    for (int i = glyph->first; i < glyph->first + glyph->steps; i++) {
        const OutlineStep *step = &type_regular.steps[i];
        if (step->kind == OUTLINE_MOVE) {
            if (i > glyph->first) trace_line(tracer, tracer->start);
            tracer->start = tracer->at = glyph_point(tracer, step);
        } else if (step->kind == OUTLINE_LINE)
            trace_line(tracer, glyph_point(tracer, step));
        else {
            trace_curve(tracer, glyph_point(tracer, step), glyph_point(tracer, step + 1),
                        glyph_point(tracer, step + 2));
            i += 2;
        }
    }
    if (glyph->steps > 0) trace_line(tracer, tracer->start);
}

static void draw_glyphs(Painter *painter, const SketchMark *mark, double halo, uint32_t colour) {
    const TextPlace place = text_place(painter->sketch, mark);
    const double unit = place.em * painter->scale / type_units;
    Tracer tracer = {painter, on_page(painter, place.from), unit * place.cosine, -unit * place.sine, halo, {0, 0},
                     {0, 0}};
    for (const char *text = painter->sketch->texts + mark->text; *text != '\0';) {
        const Glyph *glyph = type_next(&text);
        trace_glyph(&tracer, glyph);
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
    case MARK_LINK: break;
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
