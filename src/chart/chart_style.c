/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "chart/chart_style.h"

/* Okabe and Ito 2008, "Color Universal Design", without yellow, which is too light for lines; `ink` is darker, for
   text. */
static const struct {
    const char *colour, *ink;
} colours[] = {{"#000000", "#000000"}, {"#D55E00", "#A84A00"}, {"#0072B2", "#005A8C"}, {"#009E73", "#00704F"},
               {"#CC79A7", "#95457A"}, {"#56B4E9", "#20719F"}, {"#E69F00", "#8F6200"}};

/* gnuplot's circle, square, triangle, diamond, inverted triangle, pentagon: filled, then open; then crosses. */
static const int symbols[] = {7, 5, 9, 13, 11, 15, 6, 4, 8, 12, 10, 14, 1, 2, 3};

static const char *const dashes[] = {"solid", "(7,3)", "(2,2)", "(7,2,1.5,2)", "(12,3)"};

enum {
    COLOURS = sizeof colours / sizeof *colours,
    SYMBOLS = sizeof symbols / sizeof *symbols,
    DASHES = sizeof dashes / sizeof *dashes
};

ChartStyle chart_style(int i) {
    int symbol = symbols[i % SYMBOLS];
    int filled = symbol < 4 ? 0 : symbol | 1;
    return (ChartStyle){symbol, filled, colours[i % COLOURS].colour, colours[i % COLOURS].ink, dashes[i % DASHES]};
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
