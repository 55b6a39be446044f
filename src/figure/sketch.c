/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "figure/sketch.h"

#include "figure/gnuplot.h"
#include "render/style.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>

Point view_place(const View *view, Vec2 position) {
    return (Point){(view->low.x + view->high.x) / 2 + view->scale * ((double)position.x - view->center.x),
                   (view->low.y + view->high.y) / 2 + view->scale * ((double)position.y - view->center.y)};
}

bool sketch_begin(Sketch *sketch, double width, double height, Error *error) {
    *sketch = (Sketch){.width = width, .height = height};
    sketch->script = open_memstream(&sketch->script_text, &sketch->script_size);
    sketch->plot = open_memstream(&sketch->plot_text, &sketch->plot_size);
    if (sketch->script == NULL || sketch->plot == NULL) {
        sketch_free(sketch);
        return error_memory(error, "figure");
    }
    fprintf(sketch->script, "set termoption noenhanced\nset key off\nunset border\nunset tics\nset multiplot\n"
                            "set lmargin at screen 0\nset rmargin at screen 1\n"
                            "set bmargin at screen 0\nset tmargin at screen 1\n");
    fprintf(sketch->script, "set xrange [0:%g]\nset yrange [0:%g]\n", width, height);
    fprintf(sketch->plot, "plot NaN");
    return true;
}

static bool close_streams(Sketch *sketch) {
    bool whole = true;
    if (sketch->script != NULL) whole = !ferror(sketch->script) && fclose(sketch->script) == 0;
    if (sketch->plot != NULL) whole = !ferror(sketch->plot) && fclose(sketch->plot) == 0 && whole;
    sketch->script = sketch->plot = NULL;
    return whole;
}

void sketch_free(Sketch *sketch) {
    close_streams(sketch);
    free(sketch->script_text);
    free(sketch->plot_text);
    *sketch = (Sketch){0};
}

bool sketch_draw(Sketch *sketch, const char *stem, Error *error) {
    fflush(sketch->plot);
    fwrite(sketch->plot_text, 1, sketch->plot_size, sketch->script);
    fprintf(sketch->script, "\nunset multiplot\n");
    if (!close_streams(sketch)) return error_memory(error, stem);
    const GnuplotDrawing drawing = {.width = sketch->width,
                                    .height = sketch->height,
                                    .script = sketch->script_text,
                                    .script_size = sketch->script_size,
                                    .without_pdf = true};
    return gnuplot_draw(&drawing, stem, error);
}

/* gnuplot places the middles of pixels. */
void sketch_image(Sketch *sketch, const Image *image, Point low, double width) {
    double pixel = width / image->width;
    fprintf(sketch->script,
            "plot '-' binary array=(%d,%d) flipy dx=%.9g dy=%.9g origin=(%.9g,%.9g) format='%%uchar' with rgbimage\n",
            image->width, image->height, pixel, pixel, low.x + pixel / 2, low.y + pixel / 2);
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++)
        fwrite(image->pixels + 4 * i, 1, 3, sketch->script);
    fprintf(sketch->script, "\n");
}

static void put_path(Sketch *sketch, const Point *points, int count, bool closed, const Pen *pen) {
    int block = sketch->blocks++;
    fprintf(sketch->script, "$d%d << END\n", block);
    for (int i = 0; i < count; i++) fprintf(sketch->script, "%.4f %.4f\n", points[i].x, points[i].y);
    if (closed) fprintf(sketch->script, "%.4f %.4f\n", points[0].x, points[0].y);
    fprintf(sketch->script, "END\n");
    if (closed && pen->fill != NO_COLOUR)
        fprintf(sketch->plot, ", $d%d with filledcurves closed fs transparent solid %g noborder fc rgb '#%06X'", block,
                pen->opacity, pen->fill);
    if (pen->line != NO_COLOUR)
        fprintf(sketch->plot, ", $d%d with lines lw %g dt %s lc rgb '#%06X'", block, pen->width,
                pen->dashes != NULL ? pen->dashes : "solid", pen->line);
}

void sketch_path(Sketch *sketch, const Point *points, int count, const Pen *pen) {
    if (count > 1) put_path(sketch, points, count, false, pen);
}

void sketch_shape(Sketch *sketch, const Point *points, int count, const Pen *pen) {
    if (count > 2) put_path(sketch, points, count, true, pen);
}

void sketch_line(Sketch *sketch, Point from, Point to, const Pen *pen) {
    sketch_path(sketch, (const Point[]){from, to}, 2, pen);
}

void sketch_rectangle(Sketch *sketch, Point low, Point high, const Pen *pen) {
    sketch_shape(sketch, (const Point[]){low, {high.x, low.y}, high, {low.x, high.y}}, 4, pen);
}

void sketch_dot(Sketch *sketch, Point at, double radius, const Pen *pen) {
    enum { CORNERS = 36 };
    Point points[CORNERS];
    for (int i = 0; i < CORNERS; i++) {
        double angle = 2 * 3.14159265358979 * i / CORNERS;
        points[i] = (Point){at.x + radius * cos(angle), at.y + radius * sin(angle)};
    }
    sketch_shape(sketch, points, CORNERS, pen);
}

void sketch_arrow(Sketch *sketch, Point from, Point to, ArrowHeads heads, uint32_t colour, double width) {
    fprintf(sketch->script,
            "set arrow from %.4f,%.4f to %.4f,%.4f front size first 2.2,18 %s filled lw %g lc rgb '#%06X'\n", from.x,
            from.y, to.x, to.y, heads == HEADS_AT_BOTH ? "heads" : "head", width, colour);
}

/* Keeps what lies where sign * coordinate <= limit (Sutherland and Hodgman 1974). Room for one corner more. */
static int clip_half(Point *out, const Point *in, int count, bool along_y, double sign, double limit) {
    int kept = 0;
    for (int i = 0; i < count; i++) {
        Point p = in[i], q = in[(i + 1) % count];
        double over_p = sign * (along_y ? p.y : p.x) - limit, over_q = sign * (along_y ? q.y : q.x) - limit;
        if (over_p <= 0) out[kept++] = p;
        if ((over_p <= 0) == (over_q <= 0)) continue;
        double t = over_p / (over_p - over_q);
        out[kept++] = (Point){p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)};
    }
    return kept;
}

void sketch_box(Sketch *sketch, const View *view, const Box *box, const Pen *pen) {
    static const float signs[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    Point corners[8], cut[8];
    for (int i = 0; i < 4; i++) {
        Vec2 corner = vec2(signs[i][0] * box->half.x, signs[i][1] * box->half.y);
        corners[i] = view_place(view, vec2_add(box->position, mat22_multiply(box->rotation, corner)));
    }
    int count = clip_half(cut, corners, 4, false, 1, view->high.x);
    count = clip_half(corners, cut, count, false, -1, -view->low.x);
    count = clip_half(cut, corners, count, true, 1, view->high.y);
    count = clip_half(corners, cut, count, true, -1, -view->low.y);
    sketch_shape(sketch, corners, count, pen);
}

/* In single quotes gnuplot takes everything as it is but a quote, which is written twice. */
static void put_quoted(FILE *script, const char *text) {
    fputc('\'', script);
    for (; *text != '\0'; text++) {
        if (*text == '\'') fputc('\'', script);
        fputc(*text, script);
    }
    fputc('\'', script);
}

void sketch_text(Sketch *sketch, Point at, const TextStyle *style, const char *format, ...) {
    static const char *const aligns[] = {"left", "center", "right"};
    char text[SKETCH_TEXT_SIZE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    fprintf(sketch->script, "set label ");
    put_quoted(sketch->script, text);
    fprintf(sketch->script, " at %.4f,%.4f %s front font ',%g' rotate by %g tc rgb '#%06X'\n", at.x, at.y,
            aligns[style->align], style->points, style->degrees, style->colour);
}

void sketch_scale_bar(Sketch *sketch, Point left, double metres, const View *view) {
    Point right = {left.x + metres * view->scale, left.y};
    const Pen pen = pen_line(INK, 1.6, NULL);
    sketch_line(sketch, left, right, &pen);
    sketch_line(sketch, (Point){left.x, left.y - 0.8}, (Point){left.x, left.y + 0.8}, &pen);
    sketch_line(sketch, (Point){right.x, right.y - 0.8}, (Point){right.x, right.y + 0.8}, &pen);
    sketch_text(sketch, (Point){right.x + 1.5, left.y}, &(TextStyle){7.5, TEXT_LEFT, INK, 0}, "%g m", metres);
}
