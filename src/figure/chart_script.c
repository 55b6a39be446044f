/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two panels side by side and a legend below, laid out in mm. */
#include "figure/chart_script.h"

#include "figure/chart_labels.h"
#include "figure/chart_style.h"
#include "figure/log_axis.h"

#include <stdlib.h>
#include <string.h>

/* mm */
static const double left_margin = 13, right_margin = 2, gap = 5, top_margin = 5.5, axis_room = 9, legend_row = 3.7,
                    foot_row = 3.4;

static const char *const panel_titles[CHART_PANELS] = {"Impact frames", "The 60 frames after"};

static const char front_name[] = "unbeaten front", front_colour[] = "#C8C8C8";

typedef struct Layout {
    const Chart *chart;
    const char *title;
    LogAxis x[CHART_PANELS], y;
    int columns, rows;   /* of the legend */
    double column_width; /* mm */
    double legend_top;   /* mm from the page's bottom, to the middle of the first row */
    int left_out;
    FILE *script;
} Layout;

static bool is_drawn(const ChartLine *line) { return line->marks[0] + line->marks[1] > 0; }

static void lay_out_legend(Layout *layout) {
    size_t longest = strlen(front_name);
    int entries = 1;
    for (int i = 0; i < layout->chart->line_count; i++) {
        const ChartLine *line = &layout->chart->lines[i];
        layout->left_out += line->left_out;
        if (!is_drawn(line)) continue;
        if (strlen(line->name) > longest) longest = strlen(line->name);
        entries++;
    }
    double room = CHART_WIDTH - left_margin - right_margin;
    layout->columns = (int)(room / (13 + 1.35 * (double)longest));
    if (layout->columns < 1) layout->columns = 1;
    layout->rows = (entries + layout->columns - 1) / layout->columns;
    /* As few columns as so many rows need: the legend then fills its width. */
    layout->columns = (entries + layout->rows - 1) / layout->rows;
    layout->column_width = room / layout->columns;
}

static Layout lay_out(const Chart *chart, const char *title, FILE *script) {
    Layout layout = {.chart = chart, .title = title, .script = script};
    lay_out_legend(&layout);
    double foot = layout.left_out > 0 ? foot_row : 0;
    layout.legend_top = foot + legend_row * (layout.rows - 0.5) + 0.5;
    layout.y = log_axis(chart->error_least, chart->error_most);
    layout.y.from = layout.legend_top + legend_row / 2 + axis_room;
    layout.y.to = CHART_HEIGHT - top_margin;
    double width = (CHART_WIDTH - left_margin - gap - right_margin) / CHART_PANELS;
    for (int p = 0; p < CHART_PANELS; p++) {
        layout.x[p] = log_axis(chart->us_least, chart->us_most);
        layout.x[p].from = left_margin + p * (width + gap);
        layout.x[p].to = layout.x[p].from + width;
    }
    return layout;
}

static void put_end(const Layout *layout) { fprintf(layout->script, "END\n"); }

/* The front as a staircase from the top of the panel to its right. */
static void put_front(const Layout *layout, const ChartPanel *panel, const int *order, int corners) {
    fprintf(layout->script, "$front << END\n");
    for (int i = 0; i < corners; i++) {
        const ChartMark *mark = &panel->marks[order[i]];
        double from = i == 0 ? layout->y.high : panel->marks[order[i - 1]].error;
        fprintf(layout->script, "%.8g %.8g\n%.8g %.8g\n", mark->us, from, mark->us, mark->error);
    }
    if (corners > 0) fprintf(layout->script, "%.8g %.8g\n", layout->x[0].high, panel->marks[order[corners - 1]].error);
    put_end(layout);
}

/* A bar shorter than its mark would only blur it. */
static bool bar_shows(const Layout *layout, const ChartMark *mark) {
    const LogAxis *x = &layout->x[0];
    double middle = log_axis_place(x, mark->us);
    return log_axis_place(x, mark->us_q3) - middle > MARK_RADIUS ||
           middle - log_axis_place(x, mark->us_q1) > MARK_RADIUS;
}

/* $m<line>: a line's marks. $q<line>: its quartile bars. $ring: the engine as shipped. Tells which lines have
   bars. */
static void put_data(const Layout *layout, const ChartPanel *panel, bool *bars) {
    for (int line = 0; line < layout->chart->line_count; line++) {
        fprintf(layout->script, "$m%d << END\n", line);
        for (int i = 0; i < panel->count; i++)
            if (panel->marks[i].line == line)
                fprintf(layout->script, "%.8g %.8g\n", panel->marks[i].us, panel->marks[i].error);
        put_end(layout);
        fprintf(layout->script, "$q%d << END\n", line);
        bars[line] = false;
        for (int i = 0; i < panel->count; i++) {
            const ChartMark *mark = &panel->marks[i];
            if (mark->line != line || !bar_shows(layout, mark)) continue;
            bars[line] = true;
            fprintf(layout->script, "%.8g %.8g\n%.8g %.8g\n\n", mark->us_q1, mark->error, mark->us_q3, mark->error);
        }
        put_end(layout);
    }
    fprintf(layout->script, "$ring << END\n");
    for (int i = 0; i < panel->count; i++)
        if (panel->marks[i].shipped) fprintf(layout->script, "%.8g %.8g\n", panel->marks[i].us, panel->marks[i].error);
    put_end(layout);
}

static void put_line(FILE *script, char data, int number, const ChartStyle *style) {
    fprintf(script, ", $%c%d with lines lc rgb '%s' dt %s lw 1.6", data, number, style->colour, style->dashes);
}

/* Marks upon white ones, a little larger, so that they stand out from the lines and marks that they cover. */
static void put_marks(FILE *script, int number, const ChartStyle *style) {
    if (style->filled != 0) fprintf(script, ", $m%d with points pt %d ps 1.1 lc rgb 'white'", number, style->filled);
    fprintf(script, ", $m%d with points pt %d ps 0.8 lw 1.6 lc rgb '%s'", number, style->symbol, style->colour);
}

/* Front, lines, bars, marks, ring: each above the ones before. What is empty must not be plotted, or gnuplot fails. */
static void put_plot(const Layout *layout, int p, int corners, const bool *bars) {
    const ChartLine *lines = layout->chart->lines;
    int count = layout->chart->line_count;
    bool ring = false;
    for (int i = 0; i < layout->chart->panels[p].count; i++) ring |= layout->chart->panels[p].marks[i].shipped;
    fprintf(layout->script, "plot NaN");
    if (corners > 0) fprintf(layout->script, ", $front with lines lc rgb '%s' lw 6", front_colour);
    for (int line = 0; line < count; line++) {
        ChartStyle style = chart_style(line);
        if (lines[line].marks[p] > 1) put_line(layout->script, 'm', line, &style);
        if (bars[line]) fprintf(layout->script, ", $q%d with lines lc rgb '%s' lw 1.6", line, style.colour);
    }
    for (int line = 0; line < count; line++) {
        ChartStyle style = chart_style(line);
        if (lines[line].marks[p] > 0) put_marks(layout->script, line, &style);
    }
    if (ring) fprintf(layout->script, ", $ring with points pt 6 ps 2.4 lw 2.4 lc rgb 'black'");
    fprintf(layout->script, "\n");
}

static void put_axes(const Layout *layout, int p) {
    const LogAxis *x = &layout->x[p], *y = &layout->y;
    FILE *script = layout->script;
    fprintf(script, "unset label\nunset arrow\n");
    fprintf(script, "set lmargin at screen %.5f\nset rmargin at screen %.5f\n", x->from / CHART_WIDTH,
            x->to / CHART_WIDTH);
    fprintf(script, "set bmargin at screen %.5f\nset tmargin at screen %.5f\n", y->from / CHART_HEIGHT,
            y->to / CHART_HEIGHT);
    fprintf(script, "set xrange [%.8g:%.8g]\nset yrange [%.8g:%.8g]\n", x->low, x->high, y->low, y->high);
    log_axis_put_tics(x, 'x', true, script);
    log_axis_put_tics(y, 'y', p == 0, script);
    fprintf(script, "set xlabel 'Solver time per step (µs)' offset 0,0.6\n");
    fprintf(script, "set ylabel '%s' offset 0.6,0\n", p == 0 ? "Mean velocity error (m/s)" : "");
    double top = (CHART_HEIGHT - top_margin / 2) / CHART_HEIGHT;
    fprintf(script, "set label '%s' at screen %.5f,%.5f left\n", panel_titles[p], x->from / CHART_WIDTH, top);
    if (p + 1 == CHART_PANELS)
        fprintf(script, "set label '%s' at screen %.5f,%.5f right font ',7.5' tc rgb '#505050'\n", layout->title,
                x->to / CHART_WIDTH, top);
}

static bool put_panel(const Layout *layout, int p) {
    const ChartPanel *panel = &layout->chart->panels[p];
    bool bars[CHART_MAX_LINES];
    int *order = malloc((size_t)panel->count * sizeof *order + 1);
    if (order == NULL) return false;
    int corners = chart_front(panel, order);
    put_front(layout, panel, order, corners);
    put_data(layout, panel, bars);
    free(order);
    put_axes(layout, p);
    bool labelled = chart_put_labels(panel, layout->chart, &layout->x[p], &layout->y, layout->script);
    put_plot(layout, p, corners, bars);
    return labelled;
}

/* A sample of 8 mm from `left`, and the text behind it. */
static void put_entry(const Layout *layout, int entry, const char *text) {
    double left = left_margin + (entry % layout->columns) * layout->column_width;
    double y = layout->legend_top - legend_row * (entry / layout->columns);
    FILE *script = layout->script;
    fprintf(script, "set label '%s' at first %.3f,%.3f left font ',7.5'\n", text, left + 9.2, y);
    fprintf(script, "$l%d << END\n%.3f %.3f\n%.3f %.3f\nEND\n", entry, left, y, left + 8, y);
    fprintf(script, "$m%d << END\n%.3f %.3f\nEND\n", entry, left + 4, y);
}

static void put_foot(const Layout *layout) {
    if (layout->left_out == 0) return;
    fprintf(layout->script, "set label 'Not drawn, for want of a time or an error that a logarithmic axis can show:");
    const char *separator = " ";
    for (int i = 0; i < layout->chart->line_count; i++) {
        const ChartLine *line = &layout->chart->lines[i];
        if (line->left_out == 0) continue;
        fprintf(layout->script, "%s%s (%d)", separator, line->name, line->left_out);
        separator = ", ";
    }
    fprintf(layout->script, "' at first %.3f,%.3f left font ',%g'\n", left_margin, foot_row / 2, LABEL_POINTS);
}

/* A third plot over the whole page, its axes in mm. */
static void put_legend(const Layout *layout) {
    FILE *script = layout->script;
    int entry = 0, styles[CHART_MAX_LINES];
    fprintf(script, "unset label\nunset arrow\nunset logscale\nunset xlabel\nunset ylabel\nunset tics\nunset border\n");
    fprintf(script, "set lmargin 0\nset rmargin 0\nset tmargin 0\nset bmargin 0\nset origin 0,0\nset size 1,1\n");
    fprintf(script, "set xrange [0:%g]\nset yrange [0:%g]\n", CHART_WIDTH, CHART_HEIGHT);
    for (int i = 0; i < layout->chart->line_count; i++) {
        if (!is_drawn(&layout->chart->lines[i])) continue;
        styles[entry] = i;
        put_entry(layout, entry++, layout->chart->lines[i].name);
    }
    put_entry(layout, entry, front_name);
    put_foot(layout);
    fprintf(script, "plot $l%d with lines lc rgb '%s' lw 6", entry, front_colour);
    for (int i = 0; i < entry; i++) {
        ChartStyle style = chart_style(styles[i]);
        if (layout->chart->lines[styles[i]].marks[0] > 1 || layout->chart->lines[styles[i]].marks[1] > 1)
            put_line(script, 'l', i, &style);
        put_marks(script, i, &style);
    }
    fprintf(script, "\n");
}

bool chart_script(const Chart *chart, const char *title, FILE *script) {
    Layout layout = lay_out(chart, title, script);
    fprintf(script, "set termoption noenhanced\nset key off\nset border lw 0.8\nset tics nomirror font ',7.5'\n");
    fprintf(script, "set logscale xy\nset multiplot\n");
    bool whole = true;
    for (int p = 0; p < CHART_PANELS; p++) whole = put_panel(&layout, p) && whole;
    put_legend(&layout);
    fprintf(script, "unset multiplot\n");
    return whole;
}
