/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The data of a chart of one scene: its lines, its marks, and what is left out. */
#include "base/base.h"
#include "base/csv.h"
#include "figures/sketch.h"
#include "methods/methods.h"
#include "pictures/colours.h"
#include "pixels/type.h"
#include "scenes/scenes.h"
#include "studies/chart_data.h"
#include "studies/chart_plot.h"
#include "studies/chart_table.h"
#include "studies/error_curve.h"

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

/* "scene-net:scene-stack" of "scene-net:network=scenes/networks/scene-stack.npz"; of a program its setting `name`. */
void chart_line_name(const char *key, char name[CHART_TEXT_SIZE]) {
    char text[CHART_FAMILY_SIZE] = "";
    const MethodDescription *method = method_describe(key);
    const char *given = method != NULL && method->external ? strstr(key, ",name=") : NULL;
    const char *network = strstr(key, "network=");
    if (given != NULL) {
        given += strlen(",name=");
        text_add(text, sizeof text, "%.*s", (int)strcspn(given, ","), given);
    } else if (network != NULL && network > key && (network[-1] == ':' || network[-1] == ',')) {
        const char *file = network + strlen("network="), *rest = file + strcspn(file, ",");
        for (const char *at = file; at < rest; at++)
            if (*at == '/') file = at + 1;
        size_t length = (size_t)(rest - file);
        if (length > 4 && strncmp(rest - 4, ".npz", 4) == 0) length -= 4;
        text_add(text, sizeof text, "%.*s%.*s%s", (int)(network - key), key, (int)length, file, rest);
    } else
        text_add(text, sizeof text, "%s", key);
    chart_plain(name, text);
}

static int find_line(const Chart *chart, const char *key) {
    int i = 0;
    while (i < chart->line_count && strcmp(chart->lines[i].key, key) != 0) i++;
    return i;
}

static bool add_lines(Chart *chart, const CsvTable *table, const char *scene, const char *path, Error *error) {
    char key[CHART_FAMILY_SIZE];
    for (int i = 0; i < table->count; i++) {
        const ChartRow *row = chart_row(table, i);
        if (strcmp(row->scene, scene) != 0) continue;
        chart_row_family(row, key);
        if (find_line(chart, key) < chart->line_count) continue;
        if (chart->line_count == CHART_MAX_LINES)
            return error_input(error, path, "a chart can show at most %d methods", CHART_MAX_LINES);
        ChartLine *line = &chart->lines[chart->line_count++];
        *line = (ChartLine){.method = row->method, .description = method_describe(row->method)};
        strcpy(line->key, key);
        chart_line_name(key, line->name);
        line->competes = line->description == NULL || line->description->role == METHOD_COMPETES;
    }
    return true;
}

bool chart_colour(Chart *chart, const ColourChoices *choices, Error *error) {
    const char *keys[CHART_MAX_LINES];
    RunColours colours[CHART_MAX_LINES];
    for (int i = 0; i < chart->line_count; i++) keys[i] = chart->lines[i].key;
    const ColourChoices these = colours_of_these(choices, keys, chart->line_count);
    if (!colours_assign(keys, chart->line_count, &these, colours, error)) return false;
    for (int i = 0; i < chart->line_count; i++) chart->lines[i].colours = colours[i];
    return true;
}

bool chart_colours_check(const ColourChoices *choices, const ChartRow *rows, int count, Error *error) {
    char keys[CHART_MAX_LINES][CHART_FAMILY_SIZE];
    const char *methods[CHART_MAX_LINES];
    RunColours colours[CHART_MAX_LINES];
    int lines = 0;
    for (int i = 0; i < count && lines < CHART_MAX_LINES; i++) {
        int k = 0;
        chart_row_family(&rows[i], keys[lines]);
        while (k < lines && strcmp(keys[k], keys[lines]) != 0) k++;
        if (k == lines) methods[lines] = keys[lines], lines++;
    }
    return colours_assign(methods, lines, choices, colours, error);
}

/* The panel of a row, or -1. */
static int panel_of(const ChartRow *row, const char *scene) {
    if (row->protocol != PROTOCOL_CLOSED || row->phase == PHASE_REST || strcmp(row->scene, scene) != 0) return -1;
    return row->phase == PHASE_IMPACT ? 0 : 1;
}

static void chart_data_widen(Chart *chart, const ChartMark *mark) {
    chart->us_least = fmin(chart->us_least, mark->us_q1);
    chart->us_most = fmax(chart->us_most, mark->us_q3);
    chart->error_least = fmin(chart->error_least, mark->error);
    chart->error_most = fmax(chart->error_most, mark->error);
}

static bool is_shipped(const ChartRow *row) {
    const MethodDescription *method = method_describe(row->method);
    return method != NULL && method->shipped != NULL && strcmp(method->shipped, row->setting) == 0;
}

/* The help of a key says "(default: 0.002)". */
static bool is_standard(const MethodDescription *method, const char *part) {
    const size_t key = strcspn(part, "=,");
    for (const SettingSpec *known = method->settings; known != NULL && known->key != NULL; known++) {
        const char *standard = strstr(known->summary, "(default: ");
        if (strlen(known->key) != key || strncmp(known->key, part, key) != 0 || standard == NULL) continue;
        standard += strlen("(default: ");
        const size_t length = strcspn(standard, ";,)");
        return part[key] == '=' && strcspn(part + key + 1, ",") == length &&
               strncmp(part + key + 1, standard, length) == 0;
    }
    return false;
}

bool chart_mark_is_default(const ChartMark *mark) {
    const MethodDescription *method = method_describe(mark->method);
    char numbers[2 * CHART_SETTING_SIZE] = "", words[2 * CHART_SETTING_SIZE] = "";
    chart_split_setting(mark->setting, numbers, words);
    for (const char *part = numbers; *part != '\0'; part += strcspn(part, ","), part += *part == ',')
        if (method == NULL || !is_standard(method, part)) return false;
    return true;
}

/* A program has no quartiles: it reports one time a step. */
static ChartMark make_mark(const Chart *chart, const ChartRow *row) {
    char key[CHART_FAMILY_SIZE];
    const bool own_clock = isnan(row->us_solver) && !isnan(row->us_engine);
    chart_row_family(row, key);
    return (ChartMark){.line = find_line(chart, key),
                       .us = own_clock ? row->us_engine : row->us_solver,
                       .us_q1 = own_clock ? row->us_engine : row->us_solver_q1,
                       .us_q3 = own_clock ? row->us_engine : row->us_solver_q3,
                       .error = fmax(row->error_mean, PARETO_RESOLUTION),
                       .floored = row->error_mean<PARETO_RESOLUTION, .varies = row->us_varies> 0,
                       .shipped = is_shipped(row),
                       .method = row->method,
                       .setting = row->setting};
}

static bool can_be_drawn(const ChartRow *row, const ChartMark *mark) {
    return mark->us_q1 > 0 && mark->us > 0 && mark->us_q3 > 0 && !isnan(row->error_mean);
}

/* Adds a scene's rows in closed loop. Those of a method that lost the scene are marks until the ranks are known. */
static void add_rows(Chart *chart, const CsvTable *table, const char *scene) {
    for (int i = 0; i < table->count; i++) {
        const ChartRow *row = chart_row(table, i);
        const int p = panel_of(row, scene);
        if (p < 0) continue;
        ChartMark mark = make_mark(chart, row);
        mark.lost = chart_row_lost(table->rows, table->count, row);
        if (!mark.lost && row->launches > chart->launches) chart->launches = row->launches;
        if (!can_be_drawn(row, &mark))
            chart->lines[mark.line].left_out += !mark.lost;
        else
            chart->panels[p].marks[chart->panels[p].count++] = mark;
    }
}

/* The reference is a solver, too: what it reaches is reached. */
static bool is_solver(const ChartLine *line) {
    return !chart_is_program(line) &&
           (line->competes || (line->description != NULL && line->description->role == METHOD_REFERENCE));
}

CurvePoint *chart_front(const Chart *chart, int p, bool (*counts)(const ChartLine *line), int *count) {
    const ChartPanel *panel = &chart->panels[p];
    CurvePoint *front = malloc((size_t)panel->count * sizeof *front + 1);
    *count = 0;
    for (int i = 0; front != NULL && i < panel->count; i++) {
        const ChartMark *mark = &panel->marks[i];
        if (counts(&chart->lines[mark->line]) && !mark->lost) front[(*count)++] = (CurvePoint){mark->us, mark->error};
    }
    if (front != NULL) *count = error_curve_front(front, *count);
    return front;
}

bool chart_mark_is_on(const ChartMark *mark, const CurvePoint *front, int count) {
    for (int k = 0; k < count; k++)
        if (mark->us == front[k].us && mark->error == front[k].error) return true;
    return false;
}

/* The front is that of all solvers, whether they are drawn or not. */
static bool find_front(Chart *chart, int p) {
    ChartPanel *panel = &chart->panels[p];
    chart->front[p] = chart_front(chart, p, is_solver, &chart->front_count[p]);
    if (chart->front[p] == NULL) return false;
    for (int i = 0; i < panel->count; i++)
        panel->marks[i].on_front = chart_mark_is_on(&panel->marks[i], chart->front[p], chart->front_count[p]);
    return true;
}

/* Those that another setting of the line beats in both. */
static void find_beaten(ChartPanel *panel) {
    for (int i = 0; i < panel->count; i++)
        for (int k = 0; k < panel->count; k++) {
            const ChartMark *mark = &panel->marks[i], *other = &panel->marks[k];
            if (mark->line == other->line && !mark->lost && !other->lost && other->us <= mark->us &&
                other->error <= mark->error && (other->us < mark->us || other->error < mark->error))
                panel->marks[i].beaten = true;
        }
}

static int compare_marks(const void *left, const void *right) {
    const ChartMark *a = left, *b = right;
    if (a->line != b->line) return a->line - b->line;
    if (a->us != b->us) return a->us < b->us ? -1 : 1;
    return (a->error > b->error) - (a->error < b->error);
}

/* Ten times as quick or accurate is worth a place; three times as slow or wrong is not. */
static bool is_far(double value, double least, double most) { return value < least / 10 || value > most * 3; }

static void leave_out(ChartLine *line, const ChartMark *mark) {
    if (line->beyond++ == 0) {
        line->beyond_us[0] = line->beyond_us[1] = mark->us;
        line->beyond_error[0] = line->beyond_error[1] = mark->error;
    }
    line->beyond_us[0] = fmin(line->beyond_us[0], mark->us), line->beyond_us[1] = fmax(line->beyond_us[1], mark->us);
    line->beyond_error[0] = fmin(line->beyond_error[0], mark->error);
    line->beyond_error[1] = fmax(line->beyond_error[1], mark->error);
}

/* Of what is beaten only defaults of coloured lines. */
static bool is_drawn(ChartLine *line, const ChartMark *mark) {
    const bool standard = mark->shipped || (line->rank == CHART_COLOURED && chart_mark_is_default(mark));
    line->lost += mark->lost && !line->asked;
    return line->rank != CHART_HIDDEN && (!mark->beaten || standard) && (!mark->lost || line->asked);
}

/* The coloured lines set the axes: a method a thousand times as quick as they are would push them into a corner. */
static void fit_axes(Chart *chart) {
    for (int p = 0; p < CHART_PANELS; p++)
        for (int i = 0; i < chart->panels[p].count; i++) {
            const ChartMark *mark = &chart->panels[p].marks[i];
            if (chart->lines[mark->line].rank == CHART_COLOURED && !mark->beaten && !mark->lost)
                chart_data_widen(chart, mark);
        }
    const Chart alone = *chart;
    const bool any = alone.us_most > 0;
    for (int p = 0; p < CHART_PANELS; p++) {
        ChartPanel *panel = &chart->panels[p];
        int kept = 0;
        for (int i = 0; i < panel->count; i++) {
            const ChartMark mark = panel->marks[i];
            ChartLine *line = &chart->lines[mark.line];
            if (!is_drawn(line, &mark)) continue;
            if (any && (is_far(mark.us, alone.us_least, alone.us_most) ||
                        is_far(mark.error, alone.error_least, alone.error_most))) {
                leave_out(line, &mark);
                continue;
            }
            line->marks[p]++;
            line->varying += mark.varies;
            chart->floored += mark.floored;
            chart_data_widen(chart, &mark);
            panel->marks[kept++] = mark;
        }
        panel->count = kept;
    }
}

/* "k,near,more" of "k=2,near=0.1,more=400". */
static void keys_of(const char *setting, char keys[CHART_SETTING_SIZE]) {
    keys[0] = '\0';
    for (const char *part = setting; *part != '\0'; part += strcspn(part, ","), part += *part == ',')
        text_add(keys, CHART_SETTING_SIZE, "%s%.*s", keys[0] != '\0' ? "," : "", (int)strcspn(part, "=,"), part);
}

static bool has_part(const char *setting, const char *part) {
    char all[CHART_SETTING_SIZE + 2], wanted[CHART_SETTING_SIZE + 2];
    snprintf(all, sizeof all, ",%s,", setting);
    snprintf(wanted, sizeof wanted, ",%s,", part);
    return strstr(all, wanted) != NULL;
}

/* Whether all marks of the line with the same keys have this setting, "k=20". */
static bool is_common(const Chart *chart, const ChartMark *mark, const char *part) {
    char own[CHART_SETTING_SIZE], keys[CHART_SETTING_SIZE];
    keys_of(mark->setting, own);
    for (int p = 0; p < CHART_PANELS; p++)
        for (int i = 0; i < chart->panels[p].count; i++) {
            const ChartMark *other = &chart->panels[p].marks[i];
            if (other->line != mark->line) continue;
            keys_of(other->setting, keys);
            if (strcmp(own, keys) == 0 && !has_part(other->setting, part)) return false;
        }
    return true;
}

/* Of several settings, those in which marks of the line differ. */
static void label_mark(const Chart *chart, ChartMark *mark) {
    char numbers[2 * CHART_SETTING_SIZE] = "", words[2 * CHART_SETTING_SIZE] = "", own[2 * CHART_SETTING_SIZE] = "",
                     *rest;
    chart_split_setting(mark->setting, numbers, words);
    chart_plain(mark->label, numbers);
    if (strchr(numbers, ',') == NULL) return;
    for (char *part = strtok_r(numbers, ",", &rest); part != NULL; part = strtok_r(NULL, ",", &rest))
        if (!is_common(chart, mark, part)) text_add(own, sizeof own, "%s%s", own[0] != '\0' ? "," : "", part);
    if (own[0] != '\0') chart_plain(mark->label, own);
}

static bool add_marks(Chart *chart, const CsvTable *table, const char *scene, const char *path, const char *highlight,
                      Error *error) {
    bool room = true;
    for (int p = 0; p < CHART_PANELS; p++) {
        chart->panels[p].marks = calloc((size_t)table->count, sizeof(ChartMark));
        room = room && chart->panels[p].marks != NULL;
    }
    if (room) add_rows(chart, table, scene);
    for (int p = 0; room && p < CHART_PANELS; p++) room = find_front(chart, p);
    if (!room) return error_memory(error, path);
    for (int p = 0; p < CHART_PANELS; p++) find_beaten(&chart->panels[p]);
    if (!chart_rank(chart, highlight, path, error)) return false;
    fit_axes(chart);
    for (int p = 0; p < CHART_PANELS; p++)
        qsort(chart->panels[p].marks, (size_t)chart->panels[p].count, sizeof(ChartMark), compare_marks);
    for (int p = 0; p < CHART_PANELS; p++)
        for (int i = 0; i < chart->panels[p].count; i++) label_mark(chart, &chart->panels[p].marks[i]);
    return true;
}

bool chart_gather(Chart *chart, const CsvTable *table, const char *scene, const char *path, const char *highlight,
                  Error *error) {
    *chart = (Chart){.us_least = INFINITY, .error_least = INFINITY};
    chart_times_note(chart->times, table->rows, table->count);
    chart_make_plain(chart->times);
    bool gathered =
        add_lines(chart, table, scene, path, error) && chart_colour(chart, NULL, error) &&
        add_marks(chart, table, scene, path, highlight, error) &&
        (chart->panels[0].count + chart->panels[1].count > 0 ||
         error_input(error, path, "no row of the scene '%s' in closed loop has a time and an error", scene));
    if (!gathered) chart_free(chart);
    return gathered;
}

void chart_free(Chart *chart) {
    for (int p = 0; p < CHART_PANELS; p++) {
        free(chart->panels[p].marks);
        free(chart->front[p]);
        chart->panels[p] = (ChartPanel){.count = 0};
        chart->front[p] = NULL;
    }
}
