/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The gnuplot script of a chart: two panels side by side and a legend below, laid out in mm. */
#include "chart/chart_script.h"

#include "chart/chart_labels.h"
#include "chart/chart_layout.h"
#include "chart/chart_style.h"

#include <stdlib.h>

/* mm */
static const double gap = 8, top_margin = 5.5, axis_room = 9;

const char *const chart_panel_titles[CHART_PANELS] = {"Impact frames", "The 60 frames after"};

static ChartLayout lay_out(const Chart *chart, const char *title, FILE *script) {
    ChartLayout layout = {.chart = chart, .title = title, .script = script};
    chart_lay_out_legend(&layout);
    const double foot = FOOT_ROW * layout.foot_rows;
    layout.legend_top = foot + LEGEND_ROW * (layout.rows - 0.5) + 0.5;
    layout.y = log_axis(chart->error_least, chart->error_most);
    layout.y.from = layout.legend_top + LEGEND_ROW / 2 + axis_room;
    layout.y.to = CHART_HEIGHT - top_margin;
    double width = (CHART_WIDTH - LEFT_MARGIN - gap - RIGHT_MARGIN) / CHART_PANELS;
    for (int p = 0; p < CHART_PANELS; p++) {
        layout.x[p] = log_axis(chart->us_least, chart->us_most);
        layout.x[p].from = LEFT_MARGIN + p * (width + gap);
        layout.x[p].to = layout.x[p].from + width;
    }
    return layout;
}

static void write_end(const ChartLayout *layout) { fprintf(layout->script, "END\n"); }

/* The front as a staircase, from the top of the panel to its right edge. */
static void write_front(const ChartLayout *layout, const ChartPanel *panel, const int *order, int corners) {
    fprintf(layout->script, "$front << END\n");
    for (int i = 0; i < corners; i++) {
        const ChartMark *mark = &panel->marks[order[i]];
        double from = i == 0 ? layout->y.high : panel->marks[order[i - 1]].error;
        fprintf(layout->script, "%.8g %.8g\n%.8g %.8g\n", mark->us, from, mark->us, mark->error);
    }
    if (corners > 0) fprintf(layout->script, "%.8g %.8g\n", layout->x[0].high, panel->marks[order[corners - 1]].error);
    write_end(layout);
}

/* A bar shorter than its mark would only blur it. */
static bool bar_shows(const ChartLayout *layout, const ChartMark *mark) {
    const LogAxis *x = &layout->x[0];
    double middle = log_axis_place(x, mark->us);
    return log_axis_place(x, mark->us_q3) - middle > MARK_RADIUS ||
           middle - log_axis_place(x, mark->us_q1) > MARK_RADIUS;
}

/* Data blocks: $m<line>, a line's marks; $q<line>, its quartile bars; $ring, settings as shipped. bars[line]: the
   line has bars. */
static void write_data(const ChartLayout *layout, const ChartPanel *panel, bool *bars) {
    for (int line = 0; line < layout->chart->line_count; line++) {
        fprintf(layout->script, "$m%d << END\n", line);
        for (int i = 0; i < panel->count; i++)
            if (panel->marks[i].line == line)
                fprintf(layout->script, "%.8g %.8g\n", panel->marks[i].us, panel->marks[i].error);
        write_end(layout);
        fprintf(layout->script, "$q%d << END\n", line);
        bars[line] = false;
        for (int i = 0; i < panel->count; i++) {
            const ChartMark *mark = &panel->marks[i];
            if (mark->line != line || !bar_shows(layout, mark)) continue;
            bars[line] = true;
            fprintf(layout->script, "%.8g %.8g\n%.8g %.8g\n\n", mark->us_q1, mark->error, mark->us_q3, mark->error);
        }
        write_end(layout);
    }
    fprintf(layout->script, "$ring << END\n");
    for (int i = 0; i < panel->count; i++)
        if (panel->marks[i].shipped) fprintf(layout->script, "%.8g %.8g\n", panel->marks[i].us, panel->marks[i].error);
    write_end(layout);
}

/* From bottom to top: front, lines, bars, marks, ring. gnuplot fails on empty data, so it is not plotted. */
static void write_plot_command(const ChartLayout *layout, int p, int corners, const bool *bars) {
    const ChartLine *lines = layout->chart->lines;
    int count = layout->chart->line_count;
    bool ring = false;
    for (int i = 0; i < layout->chart->panels[p].count; i++) ring |= layout->chart->panels[p].marks[i].shipped;
    fprintf(layout->script, "plot NaN");
    if (corners > 0) fprintf(layout->script, ", $front with lines lc rgb '%s' lw 6", PARETO_COLOUR);
    for (int line = 0; line < count; line++) {
        const ChartStyle style = lines[line].style;
        if (lines[line].marks[p] > 1) chart_write_line(layout->script, 'm', line, &style);
        if (bars[line]) fprintf(layout->script, ", $q%d with lines lc rgb '%s' lw 1.6", line, style.colour);
    }
    for (int line = 0; line < count; line++) {
        const ChartStyle style = lines[line].style;
        if (lines[line].marks[p] > 0) chart_write_marks(layout->script, 'm', line, &style);
    }
    if (ring) fprintf(layout->script, ", $ring with points pt 6 ps 2.4 lw 2.4 lc rgb 'black'");
    fprintf(layout->script, "\n");
}

static void write_axes(const ChartLayout *layout, int p) {
    const LogAxis *x = &layout->x[p], *y = &layout->y;
    FILE *script = layout->script;
    fprintf(script, "unset label\nunset arrow\n");
    fprintf(script, "set lmargin at screen %.5f\nset rmargin at screen %.5f\n", x->from / CHART_WIDTH,
            x->to / CHART_WIDTH);
    fprintf(script, "set bmargin at screen %.5f\nset tmargin at screen %.5f\n", y->from / CHART_HEIGHT,
            y->to / CHART_HEIGHT);
    fprintf(script, "set xrange [%.8g:%.8g]\nset yrange [%.8g:%.8g]\n", x->low, x->high, y->low, y->high);
    log_axis_write_tics(x, 'x', true, script);
    log_axis_write_tics(y, 'y', p == 0, script);
    fprintf(script, "set xlabel 'Solver time per step (µs)' offset 0,0.6\n");
    fprintf(script, "set ylabel '%s' offset 0.6,0\n", p == 0 ? "Mean velocity error (m/s)" : "");
    double top = (CHART_HEIGHT - top_margin / 2) / CHART_HEIGHT;
    fprintf(script, "set label '%s' at screen %.5f,%.5f left\n", chart_panel_titles[p], x->from / CHART_WIDTH, top);
    if (p + 1 == CHART_PANELS)
        fprintf(script, "set label '%s' at screen %.5f,%.5f right font ',7.5' tc rgb '#505050'\n", layout->title,
                x->to / CHART_WIDTH, top);
}

static bool write_panel(const ChartLayout *layout, int p) {
    const ChartPanel *panel = &layout->chart->panels[p];
    bool bars[CHART_MAX_LINES];
    int *order = malloc((size_t)panel->count * sizeof *order + 1);
    if (order == NULL) return false;
    int corners = chart_pareto_corners(panel, order);
    write_front(layout, panel, order, corners);
    write_data(layout, panel, bars);
    free(order);
    write_axes(layout, p);
    bool labelled = chart_write_labels(panel, layout->chart, &layout->x[p], &layout->y, layout->script);
    write_plot_command(layout, p, corners, bars);
    return labelled;
}

void chart_mark_place(const Chart *chart, int panel, const ChartMark *mark, double *left, double *top) {
    const ChartLayout layout = lay_out(chart, "", NULL);
    *left = log_axis_place(&layout.x[panel], mark->us) / CHART_WIDTH;
    *top = 1 - log_axis_place(&layout.y, mark->error) / CHART_HEIGHT;
}

bool chart_script(const Chart *chart, const char *title, FILE *script) {
    ChartLayout layout = lay_out(chart, title, script);
    fprintf(script, "set termoption noenhanced\nset key off\nset border lw 0.8\nset tics nomirror font ',7.5'\n");
    fprintf(script, "set logscale xy\nset multiplot\n");
    bool whole = true;
    for (int p = 0; p < CHART_PANELS; p++) whole = write_panel(&layout, p) && whole;
    chart_write_legend(&layout);
    fprintf(script, "unset multiplot\n");
    return whole;
}
