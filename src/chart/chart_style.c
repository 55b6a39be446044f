/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "chart/chart_style.h"

/* The hues of picture/theme.c; `ink` is darker, for text. */
static const struct {
    const char *colour, *ink;
} colours[METHOD_COLOURS] = {
    [METHOD_BLACK] = {"#000000", "#000000"},  [METHOD_VERMILION] = {"#D55E00", "#A84A00"},
    [METHOD_BLUE] = {"#0072B2", "#005A8C"},   [METHOD_GREEN] = {"#009E73", "#00704F"},
    [METHOD_PURPLE] = {"#CC79A7", "#95457A"}, [METHOD_SKY] = {"#56B4E9", "#20719F"},
    [METHOD_ORANGE] = {"#E69F00", "#8F6200"}, [METHOD_WINE] = {"#882255", "#882255"},
};

/* For series that are no methods. */
static const MethodColour order[] = {METHOD_BLACK,  METHOD_VERMILION, METHOD_BLUE,  METHOD_GREEN,
                                     METHOD_PURPLE, METHOD_SKY,       METHOD_ORANGE};

/* Of gnuplot, filled; each open one is its number less one. */
static const int symbols[METHOD_SYMBOLS] = {
    [METHOD_CIRCLE] = 7,   [METHOD_SQUARE] = 5,    [METHOD_TRIANGLE] = 9,
    [METHOD_DIAMOND] = 13, [METHOD_PENTAGON] = 15, [METHOD_INVERTED_TRIANGLE] = 11};

/* For series that are no methods: filled, then open; then crosses. */
static const int symbol_order[] = {7, 5, 9, 13, 11, 15, 6, 4, 8, 12, 10, 14, 1, 2, 3};

static const char *const dashes[] = {"solid", "(7,3)", "(2,2)", "(7,2,1.5,2)", "(12,3)", "(4,2,4,5)"};

enum {
    ORDER = sizeof order / sizeof *order,
    SYMBOLS = sizeof symbol_order / sizeof *symbol_order,
    DASHES = sizeof dashes / sizeof *dashes
};

static ChartStyle style_of(MethodColour colour, int symbol, const char *dash) {
    return (ChartStyle){symbol, symbol < 4 ? 0 : symbol | 1, colours[colour].colour, colours[colour].ink, dash};
}

ChartStyle chart_style(int i) {
    return style_of(order[i % ORDER], symbol_order[i % SYMBOLS], dashes[i % (DASHES - 1)]);
}

const char *chart_method_colour(MethodColour colour) { return colours[colour].colour; }

/* The looks of one colour in the order in which they are tried: the symbol, filled, then open; then the other symbols. */
enum { VARIANTS = 2 * METHOD_SYMBOLS };

static ChartStyle variant_of(MethodLook look, int variant) {
    const int symbol = ((int)look.symbol + variant / 2) % METHOD_SYMBOLS;
    return style_of(look.colour, symbols[symbol] - variant % 2, dashes[symbol]);
}

static bool is_taken(const ChartStyle *styles, int count, const ChartStyle *style) {
    for (int i = 0; i < count; i++)
        if (styles[i].symbol == style->symbol && styles[i].colour == style->colour) return true;
    return false;
}

void chart_method_styles(const MethodDescription *const *methods, int count, ChartStyle *styles) {
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

void chart_write_line(FILE *script, char data, int number, const ChartStyle *style) {
    fprintf(script, ", $%c%d with lines lc rgb '%s' dt %s lw 1.6", data, number, style->colour, style->dashes);
}

/* White marks, slightly larger, separate the marks from the lines and marks below. */
void chart_write_marks(FILE *script, char data, int number, const ChartStyle *style) {
    if (style->filled != 0)
        fprintf(script, ", $%c%d with points pt %d ps 1.1 lc rgb 'white'", data, number, style->filled);
    fprintf(script, ", $%c%d with points pt %d ps 0.8 lw 1.6 lc rgb '%s'", data, number, style->symbol, style->colour);
}
