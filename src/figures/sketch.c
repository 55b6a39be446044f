/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The page of a sketch: shapes, lines, arrows, texts and pictures as a list of marks. */
#include "figures/sketch.h"

#include "base/base.h"
#include "base/file.h"
#include "engine/engine.h"
#include "figures/sketch_writers.h"
#include "pictures/picture.h"
#include "pixels/png.h"
#include "pixels/type.h"

#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *ending;
    char *(*write)(const Sketch *sketch, const SketchOutput *output, size_t *size, Error *error);
} formats[SKETCH_FORMATS] = {{".png", sketch_as_png}, {".svg", sketch_as_svg}, {".pdf", sketch_as_pdf}};

bool sketch_format(const char *path, SketchFormat *format, Error *error) {
    const char *ending = strrchr(path + file_folder_length(path), '.');
    for (int i = 0; ending != NULL && i < SKETCH_FORMATS; i++)
        if (strcmp(ending, formats[i].ending) == 0) {
            *format = (SketchFormat)i;
            return true;
        }
    if (strcmp(path, "-") == 0) {
        *format = SKETCH_SVG;
        return true;
    }
    return error_input(error, path, "the name of a figure must end in .png, .svg or .pdf");
}

bool sketch_check_pixels(double width, double height, double dpi, Error *error) {
    double columns = width / 25.4 * dpi, rows = height / 25.4 * dpi;
    return columns * rows <= SKETCH_MAX_PIXELS ||
           error_input(error, "figure",
                       "%.0f x %.0f mm at %g dots per inch are %.0f x %.0f pixels; at most %d are allowed", width,
                       height, dpi, columns, rows, SKETCH_MAX_PIXELS);
}

bool sketch_check_texts(const Sketch *sketch, const char *where, Error *error) {
    bool ok = type_check(sketch->title, where, error);
    for (size_t i = 0; ok && i < sketch->mark_count; i++)
        ok = sketch->marks[i].kind != MARK_TEXT || type_check(sketch->texts + sketch->marks[i].text, where, error);
    return ok;
}

bool sketch_write(const Sketch *sketch, const char *path, const SketchOutput *output, Error *error) {
    SketchFormat format = SKETCH_PNG;
    size_t size;
    if (!sketch_format(path, &format, error)) return false;
    if (sketch->failed) return error_memory(error, path);
    char *data = formats[format].write(sketch, output, &size, error);
    bool done = data != NULL && file_write(path, data, size, error);
    free(data);
    return done;
}

bool sketch_draw(const Sketch *sketch, const char *stem, SketchFormat last, Error *error) {
    const SketchOutput output = {.dpi = SKETCH_DPI};
    for (int i = SKETCH_PNG; i <= (int)last; i++) {
        char path[PATH_MAX];
        if (!file_path(path, sizeof path, error, "%s%s", stem, formats[i].ending)) return false;
        if (!sketch_write(sketch, path, &output, error)) return false;
    }
    return true;
}

FontFile sketch_font(const Sketch *sketch) {
    bool small = true;
    for (size_t i = 0; i < sketch->mark_count && small; i++)
        small = sketch->marks[i].kind != MARK_TEXT || font_file_suffices(sketch->texts + sketch->marks[i].text);
    return font_file(small);
}

size_t *sketch_order(const Sketch *sketch) {
    size_t *order = malloc((sketch->mark_count + 1) * sizeof *order), count = 0;
    for (int layer = 0; order != NULL && layer < SKETCH_LAYERS; layer++)
        for (size_t i = 0; i < sketch->mark_count; i++)
            if ((int)sketch->marks[i].layer == layer) order[count++] = i;
    return order;
}

int pen_dashes(const Pen *pen, double dashes[DASHES_MAX]) {
    if (pen->dashes == NULL) return 0;
    int count = sscanf(pen->dashes, "(%lf,%lf,%lf,%lf)", &dashes[0], &dashes[1], &dashes[2], &dashes[3]);
    for (int i = 0; i < count; i++) dashes[i] *= LINE_UNIT;
    return count > 0 ? count : 0;
}

TextPlace text_place(const Sketch *sketch, const SketchMark *mark) {
    static const double shares[] = {0, 0.5, 1};
    const double angle = mark->style.degrees * M_PI / 180, em = mark->style.points * MM_PER_POINT;
    const double back = shares[mark->style.align] * type_width(sketch->texts + mark->text, mark->style.points);
    const double down = TYPE_MIDDLE * em, c = cos(angle), s = sin(angle);
    return (TextPlace){{mark->at.x - back * c + down * s, mark->at.y - back * s - down * c}, c, s, em};
}

Point view_place(const View *view, Vec2 position) {
    return (Point){(view->low.x + view->high.x) / 2 + view->scale * ((double)position.x - view->center.x),
                   (view->low.y + view->high.y) / 2 + view->scale * ((double)position.y - view->center.y)};
}

void sketch_begin(Sketch *sketch, double width, double height) { *sketch = (Sketch){.width = width, .height = height}; }

void sketch_free(Sketch *sketch) {
    for (size_t i = 0; i < sketch->mark_count; i++) image_destroy(sketch->marks[i].image);
    free(sketch->marks);
    free(sketch->points);
    free(sketch->texts);
    *sketch = (Sketch){0};
}

/* Near the page. Runs can reach any coordinate, pages cannot. */
static bool is_near_page(Point p) {
    const double farthest = 1e5; /* mm */
    return fabs(p.x) < farthest && fabs(p.y) < farthest;
}

/* False if out of memory. */
static bool add_mark(Sketch *sketch, const SketchMark *mark) {
    if (!array_reserve((void **)&sketch->marks, &sketch->mark_capacity, sketch->mark_count + 1, sizeof *mark)) {
        sketch->failed = true;
        return false;
    }
    sketch->marks[sketch->mark_count++] = *mark;
    return true;
}

void sketch_image(Sketch *sketch, const Image *image, Point low, double width) {
    Image *copy = image_create(image->width, image->height, &(Error){0});
    if (copy == NULL) {
        sketch->failed = true;
        return;
    }
    memcpy(copy->pixels, image->pixels, (size_t)image->width * (size_t)image->height * 4);
    const SketchMark mark = {LAYER_PICTURES, MARK_IMAGE, .at = low, .width = width, .image = copy};
    if (!add_mark(sketch, &mark)) image_destroy(copy);
}

static void add_path(Sketch *sketch, SketchLayer layer, const Point *points, size_t count, bool closed,
                     const Pen *pen) {
    for (size_t i = 0; i < count; i++)
        if (!is_near_page(points[i])) return;
    if (!array_reserve((void **)&sketch->points, &sketch->point_capacity, sketch->point_count + count,
                       sizeof *points)) {
        sketch->failed = true;
        return;
    }
    const SketchMark mark = {layer,         MARK_PATH, .pen = *pen, .closed = closed, .first = sketch->point_count,
                             .count = count};
    memcpy(sketch->points + sketch->point_count, points, count * sizeof *points);
    sketch->point_count += count;
    add_mark(sketch, &mark);
}

void sketch_path(Sketch *sketch, const Point *points, int count, const Pen *pen) {
    if (count > 1) add_path(sketch, LAYER_SHAPES, points, (size_t)count, false, pen);
}

void sketch_shape(Sketch *sketch, const Point *points, int count, const Pen *pen) {
    if (count > 2) add_path(sketch, LAYER_SHAPES, points, (size_t)count, true, pen);
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

void sketch_arrow(Sketch *sketch, Point from, Point to, uint32_t colour, double width) {
    const double longest_head = 2.2, slimness = 0.325; /* tangent of half the tip's angle, 18 degrees */
    const double length = hypot(to.x - from.x, to.y - from.y), head = fmin(longest_head, 0.6 * length);
    if (!(length > 0)) return;
    const Point along = {(to.x - from.x) / length, (to.y - from.y) / length};
    const Point foot = {to.x - head * along.x, to.y - head * along.y};
    const double half = slimness * head;
    /* The line ends inside the head, so that the tip stays sharp. */
    const Point line[] = {from,
                          {to.x - 0.7 * head * (to.x - from.x) / length, to.y - 0.7 * head * (to.y - from.y) / length}};
    const Point corners[] = {
        to, {foot.x - half * along.y, foot.y + half * along.x}, {foot.x + half * along.y, foot.y - half * along.x}};
    const Pen pen = pen_line(colour, width, NULL);
    add_path(sketch, LAYER_ARROWS, line, 2, false, &pen);
    add_path(sketch, LAYER_ARROWS, corners, 3, true, &(Pen){colour, 1, NO_COLOUR, 0, NULL});
}

/* Keeps the part with sign * coordinate <= limit (Sutherland and Hodgman 1974). Adds at most one corner. */
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

/* Copies a text to the sketch's texts; returns its offset. */
static size_t add_text(Sketch *sketch, const char *text) {
    const size_t size = strlen(text) + 1, at = sketch->text_size;
    if (!array_reserve((void **)&sketch->texts, &sketch->text_capacity, at + size, 1)) {
        sketch->failed = true;
        return 0;
    }
    memcpy(sketch->texts + at, text, size);
    sketch->text_size += size;
    return at;
}

void sketch_text(Sketch *sketch, Point at, const TextStyle *style, const char *format, ...) {
    if (!is_near_page(at)) return;
    char text[SKETCH_TEXT_SIZE];
    PRINT_ARGUMENTS(text, sizeof text, format);
    SketchMark mark = {LAYER_TEXTS, MARK_TEXT, .at = at, .style = *style};
    mark.text = add_text(sketch, text);
    if (!sketch->failed) add_mark(sketch, &mark);
}

static const double exponent_size = 0.75, exponent_rise = 0.4, exponent_gap = 0.05; /* the last two / em */

/* "2·10", or "10" */
static void format_base(char text[32], int digit) { snprintf(text, 32, digit == 1 ? "10" : "%d·10", digit); }

double sketch_power_width(double points, int digit, int power) {
    char base[32];
    format_base(base, digit);
    return type_width(base, points) + exponent_gap * points * MM_PER_POINT +
           type_width(show_decimals(power, 0).text, exponent_size * points);
}

void sketch_power_of_ten(Sketch *sketch, Point at, const TextStyle *style, int digit, int power) {
    static const double shares[] = {[TEXT_LEFT] = 1, [TEXT_CENTER] = 0.5, [TEXT_RIGHT] = 0};
    static const char *const raised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    const double em = style->points * MM_PER_POINT;
    TextStyle base = *style, exponent = *style;
    const ShownDecimals shown = show_decimals(power, 0);
    char reads[64], text[32], digits[16];
    base.align = exponent.align = TEXT_RIGHT;
    exponent.points *= exponent_size;
    at.x += shares[style->align] * sketch_power_width(style->points, digit, power);
    format_base(text, digit);
    /* "2·10⁻³" */
    snprintf(digits, sizeof digits, "%d", abs(power));
    snprintf(reads, sizeof reads, "%s%s", text, power < 0 ? "⁻" : "");
    for (const char *c = digits; *c != '\0'; c++) text_add(reads, sizeof reads, "%s", raised[*c - '0']);
    const size_t before = sketch->mark_count;
    sketch_text(sketch, (Point){at.x - type_width(shown.text, exponent.points) - exponent_gap * em, at.y}, &base, "%s",
                text);
    sketch_text(sketch, (Point){at.x, at.y + exponent_rise * em}, &exponent, "%s", shown.text);
    if (sketch->failed || sketch->mark_count != before + 2) return;
    for (size_t i = before; i < sketch->mark_count; i++) {
        sketch->marks[i].has_reads = true;
        sketch->marks[i].reads = add_text(sketch, i == before ? reads : "");
    }
}

/* Where a line of this width ends: at the text's own end of line if it fits. */
static char *line_end(char *words, double points, double width) {
    char *best[2] = {NULL, NULL}; /* behind a word or an item of a list; behind a sign */
    double used = 0;
    for (char *end = words; *end != '\0' && *end != '\n';) {
        const char *next = end;
        if (*end == ' ' && end > words) best[0] = end;
        used += type_next(&next)->advance * points * MM_PER_POINT / type_units;
        if (used > width && end > words) return best[0] != NULL ? best[0] : best[1] != NULL ? best[1] : end;
        const char sign = *end;
        end += next - end;
        if (strchr(":,", sign) != NULL && *end != ' ') best[0] = end;
        if (strchr("/=-_", sign) != NULL) best[1] = end;
    }
    return words + strcspn(words, "\n");
}

int text_wrap(char *words, size_t size, double points, double width) {
    int lines = 1;
    for (char *end = line_end(words, points, width); *end != '\0'; end = line_end(end + 1, points, width), lines++) {
        const size_t rest = strlen(end) + 1;
        const bool inserts = *end != ' ' && *end != '\n';
        if (inserts && (size_t)(end - words) + rest + 1 > size) return lines;
        if (inserts) memmove(end + 1, end, rest);
        *end = '\n';
    }
    return lines;
}

double line_height(double points) { return 1.35 * points * MM_PER_POINT; }

double text_points(const char *words, double points, double width) {
    return points * width / fmax(type_width(words, points), width);
}

void sketch_lines(Sketch *sketch, Point first, const TextStyle *style, const char *lines) {
    const double angle = style->degrees * M_PI / 180, down = line_height(style->points);
    for (int i = 0; *lines != '\0'; i++) {
        const int length = (int)strcspn(lines, "\n");
        sketch_text(sketch, (Point){first.x + i * down * sin(angle), first.y - i * down * cos(angle)}, style, "%.*s",
                    length, lines);
        lines += length + (lines[length] == '\n');
    }
}

ShownDecimals show_decimals(double value, int decimals) {
    ShownDecimals shown;
    char digits[40];
    snprintf(digits, sizeof digits, "%.*f", decimals, fabs(value));
    bool negative = value < 0 && strspn(digits, "0.") < strlen(digits);
    snprintf(shown.text, sizeof shown.text, "%s%s", negative ? "\xe2\x88\x92" : "", digits);
    return shown;
}

void sketch_scale_bar(Sketch *sketch, Point left, double scale, double amount, const char *unit, double points) {
    const double up = 0.3 * points * MM_PER_POINT;
    const Point right = {left.x + scale * amount, left.y};
    const Pen pen = pen_line(INK, 1.6, NULL);
    sketch_line(sketch, left, right, &pen);
    sketch_line(sketch, (Point){left.x, left.y - up}, (Point){left.x, left.y + up}, &pen);
    sketch_line(sketch, (Point){right.x, right.y - up}, (Point){right.x, right.y + up}, &pen);
    sketch_text(sketch, (Point){right.x + gap_to_text(points), left.y}, &(TextStyle){points, TEXT_LEFT, INK, 0, false},
                "%g %s", amount, unit);
}

double gap_to_text(double points) { return fmax(1.4, 0.55 * points * MM_PER_POINT); }

double sketch_scale_bar_width(double scale, double amount, const char *unit, double points) {
    char words[64];
    snprintf(words, sizeof words, "%g %s", amount, unit);
    return scale * amount + gap_to_text(points) + type_width(words, points);
}
