/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lines of text, and bitmaps of glyphs that are not in the atlas, from their outlines.

   Exact coverage, by signed areas: each piece of an outline within a pixel adds the area between it and the pixel's
   right side, and its height to all pixels farther right. */
#include "pixels/gl.h"
#include "pixels/pixels_internal.h"
#include "pixels/png.h"
#include "pixels/type.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PARTS = 16 };             /* of a curve: at the largest size a part deviates by less than a hundredth pixel */
enum { LEVELS = 51, LEVEL = 5 }; /* as in the atlas */
static const double OUTLINE_UNIT = 64; /* per pixel, of FontGlyph.advance and of points */

/* An outline in pixels, y down. */
typedef struct Tracer {
    OutlineTracer outline;
    double scale, left, top;
    double x0, y0, x1, y1; /* bounds */
    double *areas;         /* [height][width + 2] */
    int width, height;
} Tracer;

/* Rounded as FreeType does, so that both kinds of glyphs in a word have equally sharp edges. */
static double round_to_grid(double pixels) { return floor(pixels * OUTLINE_UNIT + 0.5) / OUTLINE_UNIT; }

static Point font_place(const OutlineTracer *outline, const OutlineStep *step) {
    const Tracer *tracer = (const Tracer *)outline;
    return (Point){round_to_grid(step->x * tracer->scale) - tracer->left,
                   tracer->top - round_to_grid(step->y * tracer->scale)};
}

static void font_widen(OutlineTracer *outline, Point from, Point to) {
    Tracer *tracer = (Tracer *)outline;
    tracer->x0 = fmin(tracer->x0, fmin(from.x, to.x)), tracer->x1 = fmax(tracer->x1, fmax(from.x, to.x));
    tracer->y0 = fmin(tracer->y0, fmin(from.y, to.y)), tracer->y1 = fmax(tracer->y1, fmax(from.y, to.y));
}

/* The part of a line within a row, from left to right; `rise` has the sign of its direction. */
static void add_in_row(const Tracer *tracer, int row, double x0, double x1, double rise) {
    double *areas = tracer->areas + (size_t)row * (size_t)(tracer->width + 2);
    for (int x = (int)x0; x0 < x1 || x == (int)x0; x++) {
        const double end = fmin(x + 1, x1), share = x1 > x0 ? (end - x0) / (x1 - x0) : 1, part = rise * share;
        const double right = (x0 + end) / 2 - x;
        areas[x] += part * (1 - right);
        areas[x + 1] += part * right;
        rise -= part;
        x0 = end;
        if (x0 >= x1) return;
    }
}

static void add_line(OutlineTracer *outline, Point from, Point to) {
    const Tracer *tracer = (const Tracer *)outline;
    const double sign = from.y < to.y ? 1 : -1;
    const Point high = sign > 0 ? from : to, low = sign > 0 ? to : from;
    if (from.y == to.y) return;
    const double slope = (low.x - high.x) / (low.y - high.y);
    for (int row = (int)high.y; row < tracer->height && row < low.y; row++) {
        const double y0 = fmax(row, high.y), y1 = fmin(row + 1, low.y);
        const double a = high.x + slope * (y0 - high.y), b = high.x + slope * (y1 - high.y);
        const double x0 = fmin(fmax(fmin(a, b), 0), tracer->width), x1 = fmin(fmax(fmax(a, b), 0), tracer->width);
        add_in_row(tracer, row, x0, x1, sign * (y1 - y0));
    }
}

FontGlyph glyph_metrics(const Typeface *face, const Glyph *glyph, int pixels) {
    Tracer tracer = {.outline = {font_place, font_widen, PARTS}, .scale = (double)pixels / type_units};
    FontGlyph metrics = {.code = glyph->code};
    metrics.advance = (short)floor(OUTLINE_UNIT * glyph->advance * tracer.scale + 0.5);
    if (glyph->steps == 0) return metrics;
    tracer.x0 = tracer.y0 = HUGE_VAL, tracer.x1 = tracer.y1 = -HUGE_VAL;
    outline_trace(&tracer.outline, face, glyph);
    metrics.left = (short)floor(tracer.x0), metrics.top = (short)-floor(tracer.y0);
    metrics.width = (short)(ceil(tracer.x1) - floor(tracer.x0));
    metrics.height = (short)(ceil(tracer.y1) - floor(tracer.y0));
    return metrics;
}

bool glyph_draw(const Typeface *face, const Glyph *glyph, int pixels, const FontGlyph *metrics, uint8_t *bitmap) {
    const int width = metrics->width, height = metrics->height;
    Tracer tracer = {.outline = {font_place, add_line, PARTS},
                     .scale = (double)pixels / type_units,
                     .left = metrics->left,
                     .top = metrics->top,
                     .width = width,
                     .height = height};
    if (width == 0 || height == 0) return true;
    tracer.areas = calloc((size_t)height * (size_t)(width + 2), sizeof *tracer.areas);
    if (tracer.areas == NULL) return false;
    outline_trace(&tracer.outline, face, glyph);
    for (int y = 0; y < height; y++) {
        double area = 0;
        for (int x = 0; x < width; x++) {
            area += tracer.areas[y * (width + 2) + x];
            bitmap[y * width + x] = (uint8_t)((int)(fmin(fabs(area), 1) * LEVELS + 0.5) * LEVEL);
        }
    }
    free(tracer.areas);
    return true;
}

enum { PEN_UNIT = 64 }; /* pen positions are in 1/64 pixel, so that rounding errors of glyphs do not accumulate */
#define ELLIPSIS "\xE2\x80\xA6"

Font font_pick(FontFace face, double pixels) {
    static const Typeface *const faces[FONT_FACES] = {&type_regular, &type_semibold};
    Font font = {0};
    for (int i = 0; i < FONT_SIZES; i++)
        if (font_sizes[i] <= pixels) font = (Font){font_glyphs[face][i], faces[face], font_sizes[i]};
    return font;
}

static int compare_code(const void *code, const void *glyph) {
    const unsigned wanted = *(const unsigned *)code, found = ((const FontGlyph *)glyph)->code;
    return (wanted > found) - (wanted < found);
}

/* NULL if the atlas lacks the character. */
static const FontGlyph *find_in_atlas(const Font *font, unsigned code) {
    return bsearch(&code, font->glyphs, FONT_GLYPHS, sizeof *font->glyphs, compare_code);
}

/* The next character of a text. `outline` is NULL if the bitmap is in the atlas. */
static FontGlyph next_glyph(const Font *font, const char **text, const Glyph **outline) {
    const unsigned code = type_next_code(text);
    const FontGlyph *glyph = find_in_atlas(font, code);
    *outline = glyph == NULL ? type_find(font->face, code) : NULL;
    if (*outline != NULL) return glyph_metrics(font->face, *outline, font->pixels);
    return glyph != NULL ? *glyph : *find_in_atlas(font, '?');
}

static int next_advance(const Font *font, const char **text) {
    const Glyph *outline;
    return next_glyph(font, text, &outline).advance;
}

static int font_advance(const Font *font, const char *text) {
    int pen = 0;
    while (font->glyphs != NULL && *text != '\0') pen += next_advance(font, &text);
    return pen;
}

static int to_pixels(int pen) { return (pen + PEN_UNIT - 1) / PEN_UNIT; }

int font_width(const Font *font, const char *text) { return to_pixels(font_advance(font, text)); }

static void draw_bitmap(Drawing *drawing, const Font *font, const Glyph *outline, const FontGlyph *glyph,
                        uint32_t *index) {
    uint8_t *bitmap = drawing_add_bitmap(drawing, (size_t)glyph->width * (size_t)glyph->height, index);
    if (bitmap != NULL && !glyph_draw(font->face, outline, font->pixels, glyph, bitmap)) drawing->failed = true;
}

/* Adds the characters before `end` and returns the pen. */
static int add_font(Drawing *drawing, const Font *font, const char *text, const char *end, int x, int baseline,
                    uint32_t color) {
    int pen = 0;
    while (text < end) {
        const Glyph *outline;
        const FontGlyph glyph = next_glyph(font, &text, &outline);
        int left = x + (pen + PEN_UNIT / 2) / PEN_UNIT + glyph.left;
        GlyphInstance instance = {{left, baseline - glyph.top, glyph.width, glyph.height}, glyph.offset, color};
        if (outline != NULL) draw_bitmap(drawing, font, outline, &glyph, &instance.bitmap);
        if (glyph.width > 0) drawing_add_glyph(drawing, &instance);
        pen += glyph.advance;
    }
    return x + to_pixels(pen);
}

int font_add(Drawing *drawing, const Font *font, const char *text, int x, int baseline, uint32_t color) {
    if (font->glyphs == NULL) return x;
    return add_font(drawing, font, text, text + strlen(text), x, baseline, color);
}

int font_add_fitting(Drawing *drawing, const Font *font, const char *text, int x, int baseline, int max_width,
                     uint32_t color) {
    if (font_width(font, text) <= max_width) return font_add(drawing, font, text, x, baseline, color);
    int room = (max_width - font_width(font, ELLIPSIS)) * PEN_UNIT, pen = 0;
    if (room < 0) return x;
    const char *end = text, *next = text;
    while (*next != '\0' && (pen += next_advance(font, &next)) <= room) end = next;
    while (end > text && end[-1] == ' ') end--;
    int end_x = add_font(drawing, font, text, end, x, baseline, color);
    return font_add(drawing, font, ELLIPSIS, end_x, baseline, color);
}
