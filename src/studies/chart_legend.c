/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/base.h"
#include "figures/sketch.h"
#include "pixels/png.h"
#include "pixels/type.h"
#include "studies/chart_internal.h"

#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

static const char front_name[] = "Pareto front of solvers";

static bool is_drawn(const ChartLine *line) { return line->marks[0] + line->marks[1] > 0; }

static void append(ChartNote *note, const char *format, ...) PRINTF_LIKE(2, 3);
static void append(ChartNote *note, const char *format, ...) {
    const size_t length = strlen(note->text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(note->text + length, sizeof note->text - length, format, arguments);
    va_end(arguments);
}

/* Lists the lines with a nonzero counter (at `offset` in ChartLine), as far as there is room. */
static void write_counts(ChartNote *note, const Chart *chart, const char *why, size_t offset) {
    enum { ROOM = 52 };
    const char *separator = why;
    size_t length = 0;
    for (int i = 0; i < chart->line_count; i++) {
        const ChartLine *line = &chart->lines[i];
        int count;
        memcpy(&count, (const char *)line + offset, sizeof count);
        if (count == 0) continue;
        length += strlen(line->name) + 6;
        if (length > ROOM) {
            append(note, " and others. ");
            return;
        }
        append(note, "%s%s (%d)", separator, line->name, count);
        separator = ", ";
    }
    if (separator != why) append(note, ". ");
}

/* "0.14 to 0.28 m/s"; one number if both are equal. */
static void write_range(ChartNote *note, const double range[2], const char *unit) {
    append(note, range[0] < 100 ? "%.2g" : "%.0f", range[0]);
    if (range[1] > range[0]) append(note, range[1] < 100 ? " to %.2g" : " to %.0f", range[1]);
    append(note, " %s", unit);
}

static void write_times(ChartNote *note, const Chart *chart) { append(note, "%s", chart->times); }

static void write_beyond(ChartNote *note, const Chart *chart) {
    const char *separator = "Beyond the axes: ";
    for (int i = 0; i < chart->line_count; i++) {
        const ChartLine *line = &chart->lines[i];
        if (line->beyond == 0) continue;
        append(note, "%s%s (", separator, line->name);
        write_range(note, line->beyond_us, "µs,");
        append(note, " ");
        if (line->beyond_error[1] <= PARETO_RESOLUTION) append(note, "below ");
        write_range(note, line->beyond_error, "m/s)");
        separator = ", ";
    }
}

static void write_no_push_out(ChartNote *note, const Chart *chart) {
    const char *separator = "";
    for (int i = 0; i < chart->line_count; i++) {
        if (!chart->lines[i].no_push_out || !is_drawn(&chart->lines[i])) continue;
        append(note, "%s%s", separator, chart->lines[i].name);
        separator = ", ";
    }
    if (separator[0] != '\0')
        append(note, ": error against the solution without the velocity that pushes overlapping boxes apart.");
}

static void write_all_counts(ChartNote *note, const Chart *chart) {
    write_counts(note, chart, "Unstable before the impact: ", offsetof(ChartLine, lost));
    write_counts(note, chart, "Without time or error: ", offsetof(ChartLine, left_out));
    if (chart->floored > 0) append(note, "Errors below %g m/s are drawn there.", PARETO_RESOLUTION);
}

/* From the bottom; those with nothing to say have no row. */
static void write_notes(ChartLayout *layout) {
    static void (*const notes[CHART_NOTES])(ChartNote *, const Chart *) = {write_all_counts, write_no_push_out,
                                                                           write_beyond, write_times};
    for (int i = 0; i < CHART_NOTES; i++) {
        ChartNote *note = &layout->notes[layout->foot_rows];
        note->text[0] = '\0';
        notes[i](note, layout->chart);
        text_fit(note->text, sizeof note->text, LABEL_POINTS, CHART_WIDTH - LEFT_MARGIN - 1);
        layout->foot_rows += note->text[0] != '\0';
    }
}

void chart_lay_out_legend(ChartLayout *layout) {
    double longest = type_width(front_name, LEGEND_POINTS);
    int entries = 1;
    for (int i = 0; i < layout->chart->line_count; i++) {
        const ChartLine *line = &layout->chart->lines[i];
        if (!is_drawn(line)) continue;
        longest = fmax(longest, type_width(line->name, LEGEND_POINTS));
        entries++;
    }
    const double room = CHART_WIDTH - LEFT_MARGIN;
    layout->columns = (int)(room / (LEGEND_SAMPLE + LEGEND_GAP + longest + 1));
    if (layout->columns < 1) layout->columns = 1;
    layout->rows = (entries + layout->columns - 1) / layout->columns;
    /* The fewest columns for this number of rows: the legend fills its width. */
    layout->columns = (entries + layout->rows - 1) / layout->rows;
    write_notes(layout);
}

void chart_draw_legend(const ChartLayout *layout, Sketch *sketch) {
    PlotLook looks[CHART_MAX_LINES + 1];
    int count = 0;
    for (int i = 0; i < layout->chart->line_count; i++) {
        const ChartLine *line = &layout->chart->lines[i];
        if (!is_drawn(line)) continue;
        const bool joined = line->marks[0] > 1 || line->marks[1] > 1;
        looks[count++] = (PlotLook){.name = line->name, .style = line->style, .line = joined ? 1.6 : 0, .marks = true};
    }
    looks[count++] = (PlotLook){.name = front_name, .style = {.colour = PARETO_COLOUR}, .line = 6};
    plot_legend(sketch, looks, count, layout->columns, LEFT_MARGIN, layout->legend_top);
    for (int i = 0; i < layout->foot_rows; i++)
        plot_text(sketch, (Point){LEFT_MARGIN, FOOT_ROW * (i + 0.5)}, TEXT_LEFT, LABEL_POINTS, layout->notes[i].text);
}
