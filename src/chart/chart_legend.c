/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "chart/chart_layout.h"

#include "chart/chart_labels.h"
#include "chart/chart_script.h"
#include "chart/chart_style.h"
#include "study/pareto.h"

#include <stddef.h>
#include <string.h>

static const char front_name[] = "Pareto front of solvers";

/* mm */
static const double sample = 8, text_from = 9.2, letter = 1.2;

static bool is_drawn(const ChartLine *line) { return line->marks[0] + line->marks[1] > 0; }

/* What is not drawn or not exact. */
static bool has_counts(const Chart *chart) {
    int count = chart->floored;
    for (int i = 0; i < chart->line_count; i++) count += chart->lines[i].left_out + chart->lines[i].lost;
    return count > 0;
}

static bool has_no_push_out(const Chart *chart) {
    bool any = false;
    for (int i = 0; i < chart->line_count; i++) any |= chart->lines[i].no_push_out && is_drawn(&chart->lines[i]);
    return any;
}

static bool has_beyond(const Chart *chart) {
    bool any = false;
    for (int i = 0; i < chart->line_count; i++) any |= chart->lines[i].beyond > 0;
    return any;
}

void chart_lay_out_legend(ChartLayout *layout) {
    size_t longest = strlen(front_name);
    int entries = 1;
    for (int i = 0; i < layout->chart->line_count; i++) {
        const ChartLine *line = &layout->chart->lines[i];
        if (!is_drawn(line)) continue;
        if (strlen(line->name) > longest) longest = strlen(line->name);
        entries++;
    }
    double room = CHART_WIDTH - LEFT_MARGIN - RIGHT_MARGIN;
    layout->columns = (int)(room / (text_from + letter * (double)longest + 1));
    if (layout->columns < 1) layout->columns = 1;
    layout->rows = (entries + layout->columns - 1) / layout->columns;
    /* The fewest columns for this number of rows: the legend fills its width. */
    layout->columns = (entries + layout->rows - 1) / layout->rows;
    layout->column_width = room / layout->columns;
    layout->foot_rows = has_counts(layout->chart) + has_no_push_out(layout->chart) + has_beyond(layout->chart) +
                        (layout->chart->times[0] != '\0');
}

static double entry_left(const ChartLayout *layout, int entry) {
    return LEFT_MARGIN + (entry % layout->columns) * layout->column_width;
}

static double entry_middle(const ChartLayout *layout, int entry) {
    return layout->legend_top - LEGEND_ROW * (entry / layout->columns);
}

/* A sample from the left, then the text. */
static void write_entry(const ChartLayout *layout, int entry, const char *text) {
    const double left = entry_left(layout, entry), y = entry_middle(layout, entry);
    FILE *script = layout->script;
    fprintf(script, "set label '%s' at first %.3f,%.3f left font ',7.5'\n", text, left + text_from, y);
    fprintf(script, "$l%d << END\n%.3f %.3f\n%.3f %.3f\nEND\n", entry, left, y, left + sample, y);
    fprintf(script, "$m%d << END\n%.3f %.3f\nEND\n", entry, left + sample / 2, y);
}

/* Lists the lines with a nonzero counter (at `offset` in ChartLine), as far as there is room. */
static void write_counts(const ChartLayout *layout, const char *why, size_t offset) {
    enum { ROOM = 52 };
    const char *separator = why;
    size_t length = 0;
    for (int i = 0; i < layout->chart->line_count; i++) {
        const ChartLine *line = &layout->chart->lines[i];
        int count;
        memcpy(&count, (const char *)line + offset, sizeof count);
        if (count == 0) continue;
        length += strlen(line->name) + 6;
        if (length > ROOM) {
            fprintf(layout->script, " and others. ");
            return;
        }
        fprintf(layout->script, "%s%s (%d)", separator, line->name, count);
        separator = ", ";
    }
    if (separator != why) fprintf(layout->script, ". ");
}

static void begin_note(const ChartLayout *layout) { fprintf(layout->script, "set label '"); }

/* row: from the bottom. */
static void end_note(const ChartLayout *layout, int row) {
    fprintf(layout->script, "' at first %.3f,%.3f left font ',%g'\n", LEFT_MARGIN, FOOT_ROW * (row + 0.5),
            LABEL_POINTS);
}

/* "0.14 to 0.28 m/s"; one number if both are equal. */
static void write_range(FILE *script, const double range[2], const char *unit) {
    fprintf(script, range[0] < 100 ? "%.2g" : "%.0f", range[0]);
    if (range[1] > range[0]) fprintf(script, range[1] < 100 ? " to %.2g" : " to %.0f", range[1]);
    fprintf(script, " %s", unit);
}

static void write_beyond(const ChartLayout *layout, int row) {
    const char *separator = "Beyond the axes: ";
    begin_note(layout);
    for (int i = 0; i < layout->chart->line_count; i++) {
        const ChartLine *line = &layout->chart->lines[i];
        if (line->beyond == 0) continue;
        fprintf(layout->script, "%s%s (", separator, line->name);
        write_range(layout->script, line->beyond_us, "µs,");
        fputc(' ', layout->script);
        if (line->beyond_error[1] <= PARETO_RESOLUTION) fprintf(layout->script, "below ");
        write_range(layout->script, line->beyond_error, "m/s)");
        separator = ", ";
    }
    end_note(layout, row);
}

static void write_notes(const ChartLayout *layout) {
    const Chart *chart = layout->chart;
    int row = 0;
    if (has_counts(chart)) {
        begin_note(layout);
        write_counts(layout, "Unstable before the impact: ", offsetof(ChartLine, lost));
        write_counts(layout, "Without time or error: ", offsetof(ChartLine, left_out));
        if (chart->floored > 0) fprintf(layout->script, "Errors below %g m/s are drawn there.", PARETO_RESOLUTION);
        end_note(layout, row++);
    }
    if (has_no_push_out(chart)) {
        const char *separator = "";
        begin_note(layout);
        for (int i = 0; i < chart->line_count; i++) {
            if (!chart->lines[i].no_push_out || !is_drawn(&chart->lines[i])) continue;
            fprintf(layout->script, "%s%s", separator, chart->lines[i].name);
            separator = ", ";
        }
        fprintf(layout->script,
                ": error against the solution without the velocity that pushes overlapping boxes apart.");
        end_note(layout, row++);
    }
    if (has_beyond(chart)) write_beyond(layout, row++);
    if (chart->times[0] != '\0') {
        begin_note(layout);
        fputs(chart->times, layout->script);
        end_note(layout, row++);
    }
}

/* A third plot over the whole page, with axes in mm. */
void chart_write_legend(const ChartLayout *layout) {
    FILE *script = layout->script;
    int entry = 0, styles[CHART_MAX_LINES];
    fprintf(script, "unset label\nunset arrow\nunset logscale\nunset xlabel\nunset ylabel\nunset tics\nunset border\n");
    fprintf(script, "set lmargin 0\nset rmargin 0\nset tmargin 0\nset bmargin 0\nset origin 0,0\nset size 1,1\n");
    fprintf(script, "set xrange [0:%g]\nset yrange [0:%g]\n", CHART_WIDTH, CHART_HEIGHT);
    for (int i = 0; i < layout->chart->line_count; i++) {
        if (!is_drawn(&layout->chart->lines[i])) continue;
        styles[entry] = i;
        write_entry(layout, entry++, layout->chart->lines[i].name);
    }
    write_entry(layout, entry, front_name);
    write_notes(layout);
    /* A box, as gnuplot 5.4 draws thick lines with a pointed start. */
    const double left = entry_left(layout, entry), y = entry_middle(layout, entry), half = 0.5;
    fprintf(script, "$front << END\n%.3f %.3f %.3f %.3f %.3f %.3f\nEND\n", left, y, left, left + sample, y - half,
            y + half);
    fprintf(script, "plot $front with boxxyerror fs solid noborder lc rgb '%s'", PARETO_COLOUR);
    for (int i = 0; i < entry; i++) {
        const ChartStyle style = layout->chart->lines[styles[i]].style;
        if (layout->chart->lines[styles[i]].marks[0] > 1 || layout->chart->lines[styles[i]].marks[1] > 1)
            chart_write_line(script, 'l', i, &style);
        chart_write_marks(script, 'm', i, &style);
    }
    fprintf(script, "\n");
}
