/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sketch/plot_style.h"

#include <math.h>

/* The hues of picture/theme.c; `ink` is darker, for text. */
static const struct {
    uint32_t colour, ink;
} colours[METHOD_COLOURS] = {
    [METHOD_BLACK] = {0x000000, 0x000000},  [METHOD_VERMILION] = {0xD55E00, 0xA84A00},
    [METHOD_BLUE] = {0x0072B2, 0x005A8C},   [METHOD_GREEN] = {0x009E73, 0x00704F},
    [METHOD_PURPLE] = {0xCC79A7, 0x95457A}, [METHOD_SKY] = {0x56B4E9, 0x20719F},
    [METHOD_ORANGE] = {0xE69F00, 0x8F6200}, [METHOD_WINE] = {0x882255, 0x882255},
};

/* For series that are no methods. */
static const MethodColour order[] = {METHOD_BLACK,  METHOD_VERMILION, METHOD_BLUE,  METHOD_GREEN,
                                     METHOD_PURPLE, METHOD_SKY,       METHOD_ORANGE};

/* For series that are no methods: filled, then open; then crosses. */
enum { SHAPES = 6, STYLES = 2 * SHAPES + 3 };
static const int shapes[SHAPES] = {
    METHOD_CIRCLE, METHOD_SQUARE, METHOD_TRIANGLE, METHOD_DIAMOND, METHOD_INVERTED_TRIANGLE, METHOD_PENTAGON};

static const char *const dashes[] = {NULL, "(5,2.5)", "(1.6,1.6)", "(6,1.8,1.4,1.8)", "(9,2.5)", "(3.2,1.8,3.2,4)"};

enum { ORDER = sizeof order / sizeof *order, DASHES = sizeof dashes / sizeof *dashes };

PlotStyle plot_style(int i) {
    const int place = i % STYLES;
    const MethodColour colour = order[i % ORDER];
    return (PlotStyle){place < 2 * SHAPES ? shapes[place % SHAPES] : PLOT_PLUS + place - 2 * SHAPES,
                       place >= SHAPES && place < 2 * SHAPES, colours[colour].colour, colours[colour].ink,
                       dashes[i % (DASHES - 1)]};
}

uint32_t plot_method_colour(MethodColour colour) { return colours[colour].colour; }

/* The looks of one colour in the order in which they are tried: the symbol, filled, then open; then the other symbols. */
enum { VARIANTS = 2 * METHOD_SYMBOLS };

static PlotStyle variant_of(MethodLook look, int variant) {
    const int symbol = ((int)look.symbol + variant / 2) % METHOD_SYMBOLS;
    return (PlotStyle){symbol, variant % 2 == 1, colours[look.colour].colour, colours[look.colour].ink, dashes[symbol]};
}

static bool is_taken(const PlotStyle *styles, int count, const PlotStyle *style) {
    for (int i = 0; i < count; i++)
        if (styles[i].symbol == style->symbol && styles[i].open == style->open && styles[i].colour == style->colour)
            return true;
    return false;
}

void plot_method_styles(const MethodDescription *const *methods, int count, PlotStyle *styles) {
    for (int i = 0, unknown = 0; i < count; i++) {
        MethodLook look = methods[i] != NULL ? methods[i]->look : (MethodLook){METHOD_NO_COLOUR, METHOD_CIRCLE};
        const bool stated = look.colour != METHOD_NO_COLOUR;
        do {
            if (!stated)
                look = (MethodLook){(MethodColour)(1 + unknown % (METHOD_COLOURS - 1)),
                                    (MethodSymbol)(METHOD_PENTAGON - unknown % METHOD_SYMBOLS)};
            unknown += !stated;
            for (int variant = 0; variant < VARIANTS; variant++) {
                styles[i] = variant_of(look, variant);
                if (!is_taken(styles, i, &styles[i])) break;
            }
        } while (!stated && is_taken(styles, i, &styles[i]));
    }
}

/* Corners, the angle of the first one and the radius, such that all look equally large. */
static const struct {
    int corners;
    double first, radius;
} polygons[METHOD_SYMBOLS] = {
    [METHOD_CIRCLE] = {24, 0, 1},     [METHOD_SQUARE] = {4, 45, 1.25},   [METHOD_TRIANGLE] = {3, 90, 1.35},
    [METHOD_DIAMOND] = {4, 90, 1.27}, [METHOD_PENTAGON] = {5, 90, 1.15}, [METHOD_INVERTED_TRIANGLE] = {3, -90, 1.35}};

static void draw_polygon(Sketch *sketch, Point at, int symbol, double radius, const Pen *pen) {
    Point corners[24];
    const int count = polygons[symbol].corners;
    for (int i = 0; i < count; i++) {
        const double angle = polygons[symbol].first * M_PI / 180 + 2 * M_PI * i / count;
        const double reach = radius * polygons[symbol].radius;
        corners[i] = (Point){at.x + reach * cos(angle), at.y + reach * sin(angle)};
    }
    sketch_shape(sketch, corners, count, pen);
}

static void draw_strokes(Sketch *sketch, Point at, const PlotStyle *style, double radius, double line) {
    const Pen pen = pen_line(style->colour, line, NULL);
    for (int i = 0; i < 4; i++) {
        if ((style->symbol == PLOT_PLUS && i % 2 == 1) || (style->symbol == PLOT_CROSS && i % 2 == 0)) continue;
        const double x = radius * cos(M_PI / 4 * i), y = radius * sin(M_PI / 4 * i);
        sketch_line(sketch, (Point){at.x - x, at.y - y}, (Point){at.x + x, at.y + y}, &pen);
    }
}

static void draw_bar(Sketch *sketch, Point at, const PlotStyle *style, double radius) {
    const double across = 0.4 * radius; /* an upright bar is seen behind a dot */
    const double x = style->symbol == PLOT_LEVEL ? 1.4 * radius : across;
    const double y = style->symbol == PLOT_LEVEL ? across : 2 * radius;
    sketch_rectangle(sketch, (Point){at.x - x, at.y - y}, (Point){at.x + x, at.y + y},
                     &(Pen){style->colour, 1, NO_COLOUR, 0, NULL});
}

void plot_mark(Sketch *sketch, Point at, const PlotStyle *style, double radius, double line) {
    if (style->symbol >= PLOT_UPRIGHT)
        draw_bar(sketch, at, style, radius);
    else if (style->symbol >= METHOD_SYMBOLS)
        draw_strokes(sketch, at, style, radius, line);
    else if (style->open) {
        const Pen pen = {NO_COLOUR, 1, style->colour, line, NULL};
        draw_polygon(sketch, at, style->symbol, radius - line * LINE_UNIT / 2, &pen);
    } else
        draw_polygon(sketch, at, style->symbol, radius, &(Pen){style->colour, 1, NO_COLOUR, 0, NULL});
}

void plot_marks(Sketch *sketch, const Point *points, int count, const PlotStyle *style) {
    const double halo = 0.22; /* mm */
    for (int i = 0; i < count && style->symbol < METHOD_SYMBOLS; i++)
        draw_polygon(sketch, points[i], style->symbol, MARK_RADIUS + halo, &(Pen){0xFFFFFF, 1, NO_COLOUR, 0, NULL});
    for (int i = 0; i < count; i++) plot_mark(sketch, points[i], style, MARK_RADIUS, 1.6);
}
