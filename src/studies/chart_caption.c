/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The caption of a chart: what its axes, curves and lines are, what was left out, and what its words mean. */
#include "base/base.h"
#include "methods/methods.h"
#include "studies/chart_data.h"
#include "studies/statistics.h"
#include "studies/figure_words.h"

#include <stddef.h>
#include <string.h>

typedef struct Caption {
    const Chart *chart;
    char *text;
    size_t size;
} Caption;

static bool is_drawn(const ChartLine *line) { return line->marks[0] + line->marks[1] > 0; }

/* The lines with a nonzero counter (at `offset` in ChartLine). */
static void add_counts(const Caption *caption, const char *why, size_t offset) {
    const char *separator = why;
    for (int i = 0; i < caption->chart->line_count; i++) {
        const ChartLine *line = &caption->chart->lines[i];
        int count;
        memcpy(&count, (const char *)line + offset, sizeof count);
        if (count == 0) continue;
        text_add(caption->text, caption->size, "%s%s (%d)", separator, line->name, count);
        separator = ", ";
    }
    if (separator != why) text_add(caption->text, caption->size, ".");
}

/* "0.14 to 0.28 m/s"; one number if both are equal. */
static void add_range(const Caption *caption, const double range[2], const char *unit) {
    text_add(caption->text, caption->size, range[0] < 100 ? "%.2g" : "%.0f", range[0]);
    if (range[1] > range[0]) text_add(caption->text, caption->size, range[1] < 100 ? " to %.2g" : " to %.0f", range[1]);
    text_add(caption->text, caption->size, " %s", unit);
}

static void add_beyond(const Caption *caption) {
    const char *separator = " Beyond the axes: ";
    for (int i = 0; i < caption->chart->line_count; i++) {
        const ChartLine *line = &caption->chart->lines[i];
        if (line->beyond == 0) continue;
        text_add(caption->text, caption->size, "%s%s (", separator, line->name);
        add_range(caption, line->beyond_us, "µs,");
        text_add(caption->text, caption->size, " ");
        if (line->beyond_error[1] <= PARETO_RESOLUTION) text_add(caption->text, caption->size, "below ");
        add_range(caption, line->beyond_error, "m/s)");
        separator = ", ";
    }
    if (separator[0] == ',') text_add(caption->text, caption->size, ".");
}

/* Names of the drawn lines for which `is` holds, and what is said of them. */
static void add_names(const Caption *caption, bool (*is)(const ChartLine *), const char *said) {
    const char *separator = " ";
    for (int i = 0; i < caption->chart->line_count; i++) {
        if (!is(&caption->chart->lines[i]) || !is_drawn(&caption->chart->lines[i])) continue;
        text_add(caption->text, caption->size, "%s%s", separator, caption->chart->lines[i].name);
        separator = ", ";
    }
    if (separator[0] == ',') text_add(caption->text, caption->size, ": %s", said);
}

static bool is_without_push_out(const ChartLine *line) {
    return line->description != NULL && line->description->no_push_out;
}

static void add_curves(const Caption *caption) {
    const Chart *chart = caption->chart;
    const ChartLine *baseline = NULL;
    bool lost = false, twin = false, hidden = false;
    for (int p = 0; p < CHART_PANELS; p++)
        for (int i = 0; i < chart->panels[p].count; i++) {
            const ChartMark *mark = &chart->panels[p].marks[i];
            if (mark->baseline && baseline == NULL) baseline = &chart->lines[mark->line];
            lost |= mark->lost;
        }
    for (int i = 0; i < chart->line_count; i++) {
        const ChartLine *line = &chart->lines[i];
        hidden |= line->rank == CHART_HIDDEN;
        twin |= line->rank == CHART_COLOURED && chart_twin_word(line) != NULL && is_drawn(line);
    }
    text_add(
        caption->text, caption->size,
        " A curve joins the settings of a method that no other of its settings beats in both time and error; chart.csv "
        "has all. Shaded: what no solver reaches.");
    if (baseline != NULL)
        text_add(caption->text, caption->size,
                 " Ring and dotted lines: %s with as many sweeps as the scene sets, with whose time and error the "
                 "others are compared.",
                 baseline->name);
    add_names(caption, chart_is_program, "an external program, by its own clock, whose errors have the same measure.");
    if (lost) text_add(caption->text, caption->size, " Crosses: the method lost the scene before the impact.");
    if (twin) text_add(caption->text, caption->size, " Dashed, open: the method with its learned part switched off.");
    if (hidden) text_add(caption->text, caption->size, " Switched-off variants of grey methods are in the table only.");
}

static void add_floors(const Caption *caption) {
    static const char *const where[CHART_PANELS] = {"at the impact", "in the frames after it"};
    const char *separator = " Line with the name floor: ";
    for (int p = 0; p < CHART_PANELS; p++) {
        if (!(caption->chart->floor[p] > 0)) continue;
        text_add(caption->text, caption->size, "%s%.2g m/s %s", separator, caption->chart->floor[p], where[p]);
        separator = ", ";
    }
    if (separator[0] == ',')
        text_add(caption->text, caption->size,
                 "; the error of other answers that satisfy the laws of contact as well. Errors below it are drawn on "
                 "it, and are not ranked.");
}

void chart_caption(const Chart *chart, const char *title, const bool *named, char *text, size_t size) {
    const Caption caption = {chart, text, size};
    WordList words = {0};
    snprintf(
        text, size,
        "Speed against accuracy: %s. At the impact: the first frames after the bomb touches a box. Velocity error: "
        "difference from the converged solution of the same step%s, RMS over the boxes; mean over all launches.",
        title, chart->frozen ? " of the engine's run, on which every method is tried" : "");
    add_curves(&caption);
    add_names(&caption, is_without_push_out,
              "error against the solution without the velocity that pushes overlapping boxes apart.");
    add_beyond(&caption);
    const char *separator = " Without room for a name: ";
    for (int i = 0; i < chart->line_count; i++) {
        if (named[i] || !is_drawn(&chart->lines[i])) continue;
        text_add(text, size, "%s%s", separator, chart->lines[i].name);
        separator = ", ";
    }
    if (separator[0] == ',') text_add(text, size, ".");
    add_counts(&caption, " Unstable before the impact, and left out: ", offsetof(ChartLine, lost));
    add_counts(&caption, " Without time or error: ", offsetof(ChartLine, left_out));
    add_floors(&caption);
    if (chart->floored > 0) text_add(text, size, " Errors below %g m/s are drawn there.", PARETO_RESOLUTION);
    if (chart->times[0] != '\0') text_add(text, size, " %s", chart->times);
    for (int settings = 0; settings < 2; settings++) /* methods, then keys of settings */
        for (int p = 0; p < CHART_PANELS; p++)
            for (int i = 0; i < chart->panels[p].count; i++) {
                const ChartMark *mark = &chart->panels[p].marks[i];
                if (settings == 0)
                    words_add_method(&words, mark->method);
                else if (chart->lines[mark->line].rank == CHART_COLOURED)
                    words_add_settings(&words, mark->method, mark->setting);
            }
    words_join(&words, text, size);
}
