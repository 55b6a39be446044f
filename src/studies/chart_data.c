/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The data of a chart of one scene: its lines, its marks, and what is left out. */
#include "base/base.h"
#include "base/csv.h"
#include "figures/sketch.h"
#include "methods/methods.h"
#include "pixels/type.h"
#include "scenes/scenes.h"
#include "studies/chart.h"
#include "studies/chart_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void chart_make_plain(char *text) {
    char *out = text;
    for (const char *next = text; *next != '\0';) {
        const char *from = next;
        const bool plain = csv_plain_length(from) > 0;
        if (type_find(&type_regular, type_next_code(&next)) != NULL && plain) {
            memmove(out, from, (size_t)(next - from));
            out += next - from;
        } else
            *out++ = '?';
    }
    *out = '\0';
}

void chart_plain(char out[CHART_TEXT_SIZE], const char *text) {
    const size_t room = CHART_TEXT_SIZE - 1;
    const bool cut = strlen(text) > room;
    snprintf(out, CHART_TEXT_SIZE, "%.*s%s", (int)utf8_cut(text, cut ? room - 3 : room), text, cut ? "..." : "");
    chart_make_plain(out);
}

static bool is_set(const char *setting, const char *key) {
    const char *found = strstr(setting, key);
    return found != NULL && (found == setting || found[-1] == ',') && found[strlen(key)] == '=';
}

/* What sets a row apart from those with a fixed number of sweeps. */
static const char *rule_of(const ChartRow *row) {
    const MethodDescription *method = method_describe(row->method);
    const bool near = is_set(row->setting, "near") && method != NULL && settings_known(method->settings, "k");
    return near ? "near" : "";
}

static void name_row(const ChartRow *row, char key[CHART_KEY_SIZE], char label[CHART_TEXT_SIZE]) {
    char numbers[2 * CHART_SETTING_SIZE] = "", words[2 * CHART_SETTING_SIZE] = "";
    strcpy(words, rule_of(row));
    chart_split_setting(row->setting, numbers, words);
    snprintf(key, CHART_KEY_SIZE, "%s%s%s", row->method, words[0] != '\0' ? ":" : "", words);
    chart_plain(label, numbers);
}

static int find_line(const Chart *chart, const char *key) {
    int i = 0;
    while (i < chart->line_count && strcmp(chart->lines[i].key, key) != 0) i++;
    return i;
}

static bool add_lines(Chart *chart, const CsvTable *table, const char *path, Error *error) {
    const MethodDescription *methods[CHART_MAX_LINES];
    PlotStyle styles[CHART_MAX_LINES];
    char key[CHART_KEY_SIZE], label[CHART_TEXT_SIZE];
    for (int i = 0; i < table->count; i++) {
        name_row(chart_row(table, i), key, label);
        if (find_line(chart, key) < chart->line_count) continue;
        if (chart->line_count == CHART_MAX_LINES)
            return error_input(error, path, "a chart can show at most %d methods", CHART_MAX_LINES);
        const MethodDescription *method = methods[chart->line_count] = method_describe(chart_row(table, i)->method);
        ChartLine *line = &chart->lines[chart->line_count++];
        strcpy(line->key, key);
        chart_plain(line->name, key);
        line->no_push_out = method != NULL && method->no_push_out;
        line->competes = method == NULL || method->role == METHOD_COMPETES;
    }
    plot_method_styles(methods, chart->line_count, styles);
    for (int i = 0; i < chart->line_count; i++) chart->lines[i].style = styles[i];
    return true;
}

/* The panel of a row, or -1. */
static int panel_of(const ChartRow *row, const char *scene) {
    if (row->protocol != PROTOCOL_CLOSED || row->phase == PHASE_REST || strcmp(row->scene, scene) != 0) return -1;
    return row->phase == PHASE_IMPACT ? 0 : 1;
}

static bool can_be_drawn(const ChartRow *row) {
    return row->us_solver_q1 > 0 && row->us_solver > 0 && row->us_solver_q3 > 0 && !isnan(row->error_mean);
}

static void widen(Chart *chart, const ChartMark *mark) {
    chart->us_least = fmin(chart->us_least, mark->us_q1);
    chart->us_most = fmax(chart->us_most, mark->us_q3);
    chart->error_least = fmin(chart->error_least, mark->error);
    chart->error_most = fmax(chart->error_most, mark->error);
}

static bool is_shipped(const ChartRow *row) {
    const MethodDescription *method = method_describe(row->method);
    return method != NULL && method->shipped != NULL && strcmp(method->shipped, row->setting) == 0;
}

static void add_mark(Chart *chart, const ChartRow *row, bool on_front, int panel) {
    ChartMark mark = {.us = row->us_solver,
                      .us_q1 = row->us_solver_q1,
                      .us_q3 = row->us_solver_q3,
                      .method = row->method,
                      .setting = row->setting};
    char key[CHART_KEY_SIZE];
    name_row(row, key, mark.label);
    mark.line = find_line(chart, key);
    mark.error = fmax(row->error_mean, PARETO_RESOLUTION);
    mark.floored = row->error_mean < PARETO_RESOLUTION;
    mark.varies = row->us_varies > 0;
    mark.on_front = on_front;
    mark.shipped = is_shipped(row);
    ChartLine *line = &chart->lines[mark.line];
    chart->launches = row->launches > chart->launches ? row->launches : chart->launches;
    if (!can_be_drawn(row)) {
        line->left_out++;
        return;
    }
    chart->panels[panel].marks[chart->panels[panel].count++] = mark;
}

static int compare_marks(const void *left, const void *right) {
    const ChartMark *a = left, *b = right;
    if (a->line != b->line) return a->line - b->line;
    if (a->us != b->us) return a->us < b->us ? -1 : 1;
    return (a->error > b->error) - (a->error < b->error);
}

static bool is_far(double value, double least, double most) { return value < least / 10 || value > most * 10; }

static void leave_out(ChartLine *line, const ChartMark *mark) {
    if (line->beyond++ == 0) {
        line->beyond_us[0] = line->beyond_us[1] = mark->us;
        line->beyond_error[0] = line->beyond_error[1] = mark->error;
    }
    line->beyond_us[0] = fmin(line->beyond_us[0], mark->us), line->beyond_us[1] = fmax(line->beyond_us[1], mark->us);
    line->beyond_error[0] = fmin(line->beyond_error[0], mark->error);
    line->beyond_error[1] = fmax(line->beyond_error[1], mark->error);
}

/* A baseline a thousand times faster than all others would push these into a corner. */
static void fit_axes(Chart *chart) {
    for (int p = 0; p < CHART_PANELS; p++)
        for (int i = 0; i < chart->panels[p].count; i++)
            if (chart->lines[chart->panels[p].marks[i].line].competes) widen(chart, &chart->panels[p].marks[i]);
    const Chart alone = *chart;
    const bool any = alone.us_most > 0;
    for (int p = 0; p < CHART_PANELS; p++) {
        ChartPanel *panel = &chart->panels[p];
        int kept = 0;
        for (int i = 0; i < panel->count; i++) {
            const ChartMark mark = panel->marks[i];
            ChartLine *line = &chart->lines[mark.line];
            if (any && (is_far(mark.us, alone.us_least, alone.us_most) ||
                        is_far(mark.error, alone.error_least, alone.error_most))) {
                leave_out(line, &mark);
                continue;
            }
            line->marks[p]++;
            line->varying += mark.varies;
            chart->floored += mark.floored;
            widen(chart, &mark);
            panel->marks[kept++] = mark;
        }
        panel->count = kept;
    }
}

/* Adds a scene's closed-loop rows. Rows of a method that lost the scene are only counted. */
static void add_rows(Chart *chart, const CsvTable *table, const char *scene, ChartRow *rows, bool *on_front) {
    int count = 0;
    for (int i = 0; i < table->count; i++) {
        char key[CHART_KEY_SIZE], label[CHART_TEXT_SIZE];
        if (panel_of(chart_row(table, i), scene) < 0) continue;
        name_row(chart_row(table, i), key, label);
        if (chart_row_lost(table->rows, table->count, chart_row(table, i)))
            chart->lines[find_line(chart, key)].lost++;
        else
            rows[count++] = *chart_row(table, i);
    }
    pareto_mark(rows, count, on_front);
    for (int i = 0; i < count; i++) add_mark(chart, &rows[i], on_front[i], panel_of(&rows[i], scene));
}

/* Whether all marks of the line have this setting, "k=20". */
static bool is_common(const Chart *chart, int line, const char *part) {
    bool common = true;
    for (int p = 0; p < CHART_PANELS; p++)
        for (int i = 0; i < chart->panels[p].count; i++) {
            const ChartMark *mark = &chart->panels[p].marks[i];
            char setting[CHART_SETTING_SIZE + 2], wanted[CHART_SETTING_SIZE + 2];
            snprintf(setting, sizeof setting, ",%s,", mark->setting);
            snprintf(wanted, sizeof wanted, ",%s,", part);
            common = common && (mark->line != line || strstr(setting, wanted) != NULL);
        }
    return common;
}

/* Of several settings, names those in which the marks of its line differ. */
static void shorten_label(Chart *chart, ChartMark *mark) {
    char numbers[2 * CHART_SETTING_SIZE] = "", words[2 * CHART_SETTING_SIZE] = "";
    char own[2 * CHART_SETTING_SIZE] = "", common[3 * CHART_SETTING_SIZE] = "", *rest;
    chart_split_setting(mark->setting, numbers, words);
    if (strchr(numbers, ',') == NULL) return;
    for (char *part = strtok_r(numbers, ",", &rest); part != NULL; part = strtok_r(NULL, ",", &rest))
        if (is_common(chart, mark->line, part))
            text_add(common, sizeof common, "%s%s", common[0] != '\0' ? ", " : "", part);
        else
            text_add(own, sizeof own, "%s%s", own[0] != '\0' ? "," : "", part);
    chart_plain(mark->label, own);
    chart_plain(chart->lines[mark->line].common, common);
}

static bool add_marks(Chart *chart, const CsvTable *table, const char *scene, const char *path, Error *error) {
    bool *on_front = malloc((size_t)table->count * sizeof *on_front);
    ChartRow *rows = malloc((size_t)table->count * sizeof *rows);
    bool room = on_front != NULL && rows != NULL;
    for (int p = 0; p < CHART_PANELS; p++) {
        chart->panels[p].marks = calloc((size_t)table->count, sizeof(ChartMark));
        room = room && chart->panels[p].marks != NULL;
    }
    if (room) {
        add_rows(chart, table, scene, rows, on_front);
        fit_axes(chart);
        for (int p = 0; p < CHART_PANELS; p++)
            qsort(chart->panels[p].marks, (size_t)chart->panels[p].count, sizeof(ChartMark), compare_marks);
        for (int p = 0; p < CHART_PANELS; p++)
            for (int i = 0; i < chart->panels[p].count; i++) shorten_label(chart, &chart->panels[p].marks[i]);
    }
    free(rows);
    free(on_front);
    return room || error_memory(error, path);
}

bool chart_gather(Chart *chart, const CsvTable *table, const char *scene, const char *path, Error *error) {
    *chart = (Chart){.us_least = INFINITY, .error_least = INFINITY};
    chart_times_note(chart->times, table->rows, table->count);
    chart_make_plain(chart->times);
    bool gathered =
        add_lines(chart, table, path, error) && add_marks(chart, table, scene, path, error) &&
        (chart->panels[0].count + chart->panels[1].count > 0 ||
         error_input(error, path, "no row of the scene '%s' in closed loop has a time and an error", scene));
    if (!gathered) chart_free(chart);
    return gathered;
}

void chart_free(Chart *chart) {
    for (int p = 0; p < CHART_PANELS; p++) {
        free(chart->panels[p].marks);
        chart->panels[p] = (ChartPanel){.count = 0};
    }
}
