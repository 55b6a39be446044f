/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "chart/gnuplot_page.h"

#include "common/memory_stream.h"
#include "common/utf8.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double sample_length = 8, half_upright = 1.3; /* mm, samples of the legend */

GnuplotLook gnuplot_look(int i, const char *name) { return (GnuplotLook){name, chart_style(i), 1.6, true, 0, false}; }

GnuplotLook gnuplot_look_dashed(const char *name) {
    return (GnuplotLook){name, {.colour = GNUPLOT_GREY, .ink = GNUPLOT_GREY, .dashes = "(5,3)"}, 2.0, false, 0, false};
}

GnuplotLook gnuplot_look_thin(GnuplotLook look) {
    look.line = 0.6;
    look.style.dashes = "solid";
    look.marks = false;
    return look;
}

GnuplotLook gnuplot_look_marks(GnuplotLook look) {
    look.line = 0;
    return look;
}

void gnuplot_page_begin(GnuplotPage *page, double width, double height) {
    page->width = width;
    page->height = height;
    fprintf(page->script, "set key off\nset multiplot\n");
}

void gnuplot_page_end(GnuplotPage *page) {
    fprintf(page->script, "unset multiplot\n");
    if (page->beyond) fprintf(page->caption, " Values beyond an axis are drawn at its edge.");
    fprintf(page->caption, "\n");
}

static void write_margins(GnuplotPage *page, GnuplotBox box) {
    fprintf(page->script, "set lmargin at screen %.6f\nset rmargin at screen %.6f\n", box.left / page->width,
            (box.left + box.width) / page->width);
    fprintf(page->script, "set bmargin at screen %.6f\nset tmargin at screen %.6f\n", box.bottom / page->height,
            (box.bottom + box.height) / page->height);
}

void gnuplot_panel_begin(GnuplotPage *page, GnuplotBox box, const char *title) {
    fprintf(page->script, "unset label\nunset logscale\nunset xlabel\nunset ylabel\nset format\nset border lw 0.8\n"
                          "set tics nomirror font ',7.5'\n");
    write_margins(page, box);
    gnuplot_text(page, box.left, box.bottom + box.height + 2.5, "left", 8, title);
    page->plot = memory_stream(&page->plot_text, &page->plot_size);
    if (page->plot == NULL) page->no_memory = true;
}

void gnuplot_panel_end(GnuplotPage *page) {
    if (page->plot == NULL) return;
    if (ferror(page->plot)) page->no_memory = true;
    if (fclose(page->plot) != 0) page->no_memory = true;
    fprintf(page->script, "plot NaN%s\n", page->no_memory ? "" : page->plot_text);
    free(page->plot_text);
    page->plot = NULL;
}

/* In single quotes, '' stands for one quote. */
static void write_quoted(GnuplotPage *page, const char *text) {
    fputc('\'', page->script);
    for (; *text != '\0'; text++) {
        if (*text == '\'') fputc('\'', page->script);
        fputc(*text, page->script);
    }
    fputc('\'', page->script);
}

void gnuplot_axis_label(GnuplotPage *page, char letter, const char *label) {
    fprintf(page->script, "set %clabel ", letter);
    write_quoted(page, label);
    fprintf(page->script, " offset %s\n", letter == 'x' ? "0,0.6" : "0.6,0");
}

void gnuplot_linear_axis(GnuplotPage *page, char letter, double low, double high, const char *tics, const char *label) {
    fprintf(page->script, "set %crange [%.8g:%.8g]\n", letter, low, high);
    if (tics != NULL && tics[0] == '\0')
        fprintf(page->script, "unset %ctics\n", letter);
    else
        fprintf(page->script, "set %ctics scale 0.6,0.35 %s\n", letter, tics != NULL ? tics : "autofreq");
    if (label != NULL) gnuplot_axis_label(page, letter, label);
}

void gnuplot_series_begin(GnuplotPage *page) {
    page->points = 0;
    page->bars = false;
    fprintf(page->script, "$d%d << END\n", ++page->block);
}

void gnuplot_point(GnuplotPage *page, double x, double y) {
    if (isnan(x) || isnan(y)) return;
    fprintf(page->script, "%.8g %.8g\n", x, y);
    page->points++;
}

void gnuplot_gap(GnuplotPage *page) { fprintf(page->script, "\n"); }

void gnuplot_segment(GnuplotPage *page, double x0, double y0, double x1, double y1) {
    gnuplot_point(page, x0, y0);
    gnuplot_point(page, x1, y1);
    gnuplot_gap(page);
}

void gnuplot_bar(GnuplotPage *page, double x0, double y0, double x1, double y1) {
    if (isnan(x0 + y0 + x1 + y1)) return;
    fprintf(page->script, "%.8g %.8g %.8g %.8g %.8g %.8g\n", x0, y0, x0, x1, y0, y1);
    page->points++;
    page->bars = true;
}

/* gnuplot fails on empty data, so it is not plotted. */
void gnuplot_series_end(GnuplotPage *page, const GnuplotLook *look) {
    fprintf(page->script, "END\n");
    if (page->points == 0 || page->plot == NULL) return;
    if (page->bars)
        fprintf(page->plot, ", $d%d with boxxyerror fs solid noborder lc rgb '%s'", page->block, look->style.colour);
    else if (look->line > 0)
        fprintf(page->plot, ", $d%d with lines lc rgb '%s' dt %s lw %g", page->block, look->style.colour,
                look->style.dashes, look->line);
    if (look->marks) chart_write_marks(page->plot, 'd', page->block, &look->style);
}

static void write_text(GnuplotPage *page, double x, double y, const char *align, double points, const char *text) {
    fprintf(page->script, "set label ");
    write_quoted(page, text);
    fprintf(page->script, " at screen %.6f,%.6f %s noenhanced font ',%g'", x / page->width, y / page->height, align,
            points);
}

void gnuplot_text(GnuplotPage *page, double x, double y, const char *align, double points, const char *text) {
    write_text(page, x, y, align, points, text);
    fprintf(page->script, "\n");
}

void gnuplot_text_in(GnuplotPage *page, double x, double y, const char *align, double points, const char *text,
                     GnuplotInk ink) {
    write_text(page, x, y, align, points, text);
    fprintf(page->script, " front tc rgb '%s' rotate by %g\n", ink.colour, ink.degrees);
}

void gnuplot_link(GnuplotPage *page, GnuplotBox box, const char *target, const char *title) {
    if (page->links == NULL) return;
    fprintf(page->links, "<a xlink:href=\"%s\"><title>%s</title>", target, title);
    fprintf(page->links, "<rect x=\"%.3f\" y=\"%.3f\" width=\"%.3f\" height=\"%.3f\" fill-opacity=\"0\"/></a>\n",
            box.left, page->height - box.bottom - box.height, box.width, box.height);
}

void gnuplot_truncate(char *text, size_t most) {
    if (strlen(text) > most) strcpy(text + utf8_cut(text, most - 3), "...");
}

static void write_sample(GnuplotPage *page, const GnuplotLook *look, double left, double y) {
    GnuplotLook line = *look, marks = gnuplot_look_marks(*look);
    line.marks = false;
    double middle = left + sample_length / 2;
    double across = look->upright ? look->bar / 2 : sample_length / 2,
           up = look->upright ? half_upright : look->bar / 2;
    gnuplot_series_begin(page);
    if (look->bar > 0)
        gnuplot_bar(page, middle - across, y - up, middle + across, y + up);
    else
        gnuplot_segment(page, middle - across, y, middle + across, y);
    gnuplot_series_end(page, &line);
    gnuplot_series_begin(page);
    gnuplot_point(page, middle, y);
    gnuplot_series_end(page, &marks);
}

void gnuplot_page_panel_begin(GnuplotPage *page) {
    gnuplot_panel_begin(page, (GnuplotBox){0, 0, page->width, page->height}, "");
    fprintf(page->script, "unset border\nunset tics\nset xrange [0:%g]\nset yrange [0:%g]\n", page->width,
            page->height);
}

void gnuplot_legend(GnuplotPage *page, const GnuplotLook *looks, int count, int columns, double left, double top) {
    gnuplot_page_panel_begin(page);
    double width = (page->width - left) / columns;
    for (int i = 0; i < count; i++) {
        double x = left + width * (i % columns), y = top - GNUPLOT_LEGEND_ROW * (i / columns);
        write_sample(page, &looks[i], x, y);
        gnuplot_text(page, x + sample_length + 1.2, y, "left", 7.5, looks[i].name);
    }
    gnuplot_panel_end(page);
}
