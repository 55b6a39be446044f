/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "figure/sketch.h"

#include "figure/gnuplot.h"
#include "render/style.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

Point view_place(const View *view, Vec2 position) {
    return (Point){(view->low.x + view->high.x) / 2 + view->scale * ((double)position.x - view->center.x),
                   (view->low.y + view->high.y) / 2 + view->scale * ((double)position.y - view->center.y)};
}

bool sketch_begin(Sketch *sketch, double width, double height, Error *error) {
    *sketch = (Sketch){.width = width, .height = height};
    for (int i = 0; i < SKETCH_PARTS; i++) {
        SketchPart *part = &sketch->parts[i];
        part->file = open_memstream(&part->text, &part->size);
        if (part->file != NULL) continue;
        sketch_free(sketch);
        return error_memory(error, "figure");
    }
    fprintf(sketch->parts[PART_PICTURES].file,
            "set termoption noenhanced\nset key off\nunset border\nunset tics\nset multiplot\n"
            "set lmargin at screen 0\nset rmargin at screen 1\nset bmargin at screen 0\nset tmargin at screen 1\n"
            "set xrange [0:%g]\nset yrange [0:%g]\n",
            width, height);
    fprintf(sketch->parts[PART_PLOT].file, "plot NaN");
    return true;
}

static bool close_part(SketchPart *part) {
    if (part->file == NULL) return true;
    bool whole = !ferror(part->file);
    whole = fclose(part->file) == 0 && whole;
    part->file = NULL;
    return whole;
}

void sketch_free(Sketch *sketch) {
    for (int i = 0; i < SKETCH_PARTS; i++) {
        close_part(&sketch->parts[i]);
        free(sketch->parts[i].text);
    }
    *sketch = (Sketch){0};
}

/* The parts behind each other; NULL when memory is short. */
static char *join_parts(Sketch *sketch, size_t *size) {
    bool whole = true;
    *size = 0;
    for (int i = 0; i < SKETCH_PARTS; i++) {
        whole = close_part(&sketch->parts[i]) && whole;
        *size += sketch->parts[i].size;
    }
    char *script = whole ? malloc(*size) : NULL, *end = script;
    for (int i = 0; script != NULL && i < SKETCH_PARTS; end += sketch->parts[i++].size)
        memcpy(end, sketch->parts[i].text, sketch->parts[i].size);
    return script;
}

bool sketch_draw(Sketch *sketch, const char *stem, Error *error) {
    fprintf(sketch->parts[PART_PLOT].file, "\nunset multiplot\n");
    size_t size;
    char *script = join_parts(sketch, &size);
    if (script == NULL) return error_memory(error, stem);
    const GnuplotDrawing drawing = {
        .width = sketch->width, .height = sketch->height, .script = script, .script_size = size, .without_pdf = true};
    bool drawn = gnuplot_draw(&drawing, stem, error);
    free(script);
    return drawn;
}

/* gnuplot places the middles of pixels. */
void sketch_image(Sketch *sketch, const Image *image, Point low, double width) {
    double pixel = width / image->width;
    FILE *script = sketch->parts[PART_PICTURES].file;
    fprintf(script,
            "plot '-' binary array=(%d,%d) flipy dx=%.9g dy=%.9g origin=(%.9g,%.9g) format='%%uchar' with rgbimage\n",
            image->width, image->height, pixel, pixel, low.x + pixel / 2, low.y + pixel / 2);
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++)
        fwrite(image->pixels + 4 * i, 1, 3, script);
    fprintf(script, "\n");
}

static void put_path(Sketch *sketch, const Point *points, int count, bool closed, const Pen *pen) {
    int path = sketch->paths++;
    FILE *script = sketch->parts[PART_POINTS].file, *plot = sketch->parts[PART_PLOT].file;
    fprintf(script, "$d%d << END\n", path);
    for (int i = 0; i < count; i++) fprintf(script, "%.4f %.4f\n", points[i].x, points[i].y);
    if (closed) fprintf(script, "%.4f %.4f\n", points[0].x, points[0].y);
    fprintf(script, "END\n");
    if (closed && pen->fill != NO_COLOUR)
        fprintf(plot, ", $d%d with filledcurves closed fs transparent solid %g noborder fc rgb '#%06X'", path,
                pen->opacity, pen->fill);
    if (pen->line != NO_COLOUR)
        fprintf(plot, ", $d%d with lines lw %g dt %s lc rgb '#%06X'", path, pen->width,
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
    fprintf(sketch->parts[PART_WORDS].file,
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
    fprintf(sketch->parts[PART_WORDS].file, "set label ");
    put_quoted(sketch->parts[PART_WORDS].file, text);
    fprintf(sketch->parts[PART_WORDS].file, " at %.4f,%.4f %s front font ',%g' rotate by %g tc rgb '#%06X'\n", at.x,
            at.y, aligns[style->align], style->points, style->degrees, style->colour);
}

ShownDecimals show_decimals(double value, int decimals) {
    ShownDecimals shown;
    char digits[40];
    snprintf(digits, sizeof digits, "%.*f", decimals, fabs(value));
    bool negative = value < 0 && strspn(digits, "0.") < strlen(digits);
    snprintf(shown.text, sizeof shown.text, "%s%s", negative ? "\xe2\x88\x92" : "", digits);
    return shown;
}

void sketch_bar(Sketch *sketch, Point left, double length, const char *words) {
    const Point right = {left.x + length, left.y};
    const Pen pen = pen_line(INK, 1.6, NULL);
    sketch_line(sketch, left, right, &pen);
    sketch_line(sketch, (Point){left.x, left.y - 0.8}, (Point){left.x, left.y + 0.8}, &pen);
    sketch_line(sketch, (Point){right.x, right.y - 0.8}, (Point){right.x, right.y + 0.8}, &pen);
    sketch_text(sketch, (Point){right.x + 1.5, left.y}, &(TextStyle){7.5, TEXT_LEFT, INK, 0}, "%s", words);
}
