/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The data of a chart of one scene: its lines, their ranks, its marks, and what is left out. */
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
#include "studies/statistics.h"

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
static void name_line(const char *key, char name[CHART_TEXT_SIZE]) {
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

/* The Pareto front of a panel, of the lines that count and have not lost the scene; to be freed. NULL if out of
   memory. */
static CurvePoint *find_front(const Chart *chart, int p, bool (*counts)(const ChartLine *line), int *count) {
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

static bool is_on(const ChartMark *mark, const CurvePoint *front, int count) {
    for (int k = 0; k < count; k++)
        if (mark->us == front[k].us && mark->error == front[k].error) return true;
    return false;
}

/* Which lines are in colour: a reader takes in six, not twenty. */

bool chart_is_program(const ChartLine *line) { return line->description != NULL && line->description->external; }

const char *chart_twin_word(const ChartLine *line) {
    const MethodDescription *method = line->description;
    const char *word = method != NULL && method->twin != NULL ? method->twin + strcspn(method->twin, ":") : "";
    const char *found = word[0] == ':' ? strstr(line->key, word + 1) : NULL;
    const bool whole = found != NULL && found > line->key && (found[-1] == ':' || found[-1] == ',') &&
                       strchr(",", found[strlen(word + 1)]) != NULL;
    return whole ? word + 1 : NULL;
}

/* As far as there is room. */
static void colour(Chart *chart, int line) {
    int count = 0;
    for (int i = 0; i < chart->line_count; i++) count += chart->lines[i].rank == CHART_COLOURED;
    if (line >= 0 && count < CHART_LOUD) chart->lines[line].rank = CHART_COLOURED;
}

/* The first line of a method, but for its silenced twins; -1: none. */
static int first_of(const Chart *chart, const char *method) {
    for (int i = 0; i < chart->line_count; i++)
        if (strcmp(chart->lines[i].method, method) == 0 && chart_twin_word(&chart->lines[i]) == NULL) return i;
    return -1;
}

/* As in the table or as in the picture. */
static bool is_named(const ChartLine *line, const char *name) {
    return strcmp(line->key, name) == 0 || strcmp(line->name, name) == 0;
}

/* The next of names that are separated by commas; false at the end. */
static bool next_name(const char **rest, char name[CHART_FAMILY_SIZE]) {
    if (*rest == NULL || **rest == '\0') return false;
    const size_t length = strcspn(*rest, ",");
    snprintf(name, CHART_FAMILY_SIZE, "%.*s", (int)length, *rest);
    *rest += length + ((*rest)[length] == ',');
    return true;
}

bool chart_highlight_check(const char *highlight, const ChartRow *rows, int count, Error *error) {
    char name[CHART_FAMILY_SIZE];
    int names = 0;
    for (const char *rest = highlight; next_name(&rest, name); names++) {
        NameList known = {0};
        bool found = false;
        for (int i = 0; i < count; i++) {
            ChartLine line = {.method = rows[i].method};
            chart_row_family(&rows[i], line.key);
            name_line(line.key, line.name);
            name_list_add(&known, line.name);
            found |= is_named(&line, name) || strcmp(line.method, name) == 0;
        }
        if (!found) return error_unknown(error, "--highlight", name, "a method of this chart", &known);
    }
    return names <= CHART_LOUD ||
           error_input(error, "--highlight", "a chart has at most %d methods in colour (got %d)", CHART_LOUD, names);
}

/* A method that learns nothing, beside the engine and interior, which are in colour anyway. */
static bool is_rival(const ChartLine *line) {
    const MethodDescription *method = line->description;
    return line->competes && !chart_is_program(line) && strcmp(line->method, "engine") != 0 &&
           strcmp(line->method, "interior") != 0 &&
           (method == NULL || (method->twin == NULL && !method->needs_network));
}

/* The rival with most corners in the front of rivals, both panels together; -1: none. False if out of memory. */
static bool find_rival(const Chart *chart, int *rival) {
    int corners[CHART_MAX_LINES] = {0};
    *rival = -1;
    for (int p = 0; p < CHART_PANELS; p++) {
        const ChartPanel *panel = &chart->panels[p];
        int count;
        CurvePoint *front = find_front(chart, p, is_rival, &count);
        if (front == NULL) return false;
        for (int i = 0; i < panel->count; i++)
            if (is_rival(&chart->lines[panel->marks[i].line]))
                corners[panel->marks[i].line] += is_on(&panel->marks[i], front, count);
        free(front);
    }
    for (int i = 0; i < chart->line_count; i++)
        if (corners[i] > 0 && (*rival < 0 || corners[i] > corners[*rival])) *rival = i;
    return true;
}

/* The line with the same settings whose learned part is switched off; -1: none. */
static int find_twin(const Chart *chart, const ChartLine *line) {
    for (int i = 0; i < chart->line_count; i++) {
        const ChartLine *twin = &chart->lines[i];
        const char *word = chart_twin_word(twin);
        char key[CHART_FAMILY_SIZE];
        if (word == NULL || strcmp(twin->method, line->method) != 0) continue;
        const char *at = strstr(twin->key, word);
        snprintf(key, sizeof key, "%.*s%s", (int)(at - twin->key) - 1, twin->key, at + strlen(word));
        if (strcmp(key, line->key) == 0) return i;
    }
    return -1;
}

/* Sets the rank of each line, given all its marks: in colour are what the reader asks for, programs of others, the
   engine, interior, the strongest rival and scene-net; then the silenced twins of these. False if out of memory. */
static bool rank(Chart *chart, const ChartLook *look) {
    int rival;
    if (!find_rival(chart, &rival)) return false;
    for (int i = 0; i < chart->line_count; i++) {
        ChartLine *line = &chart->lines[i];
        char name[CHART_FAMILY_SIZE];
        for (const char *rest = look->highlight; next_name(&rest, name);)
            line->asked |= is_named(line, name) || first_of(chart, name) == i;
        if (line->asked) colour(chart, i);
    }
    for (int i = 0; look->chosen && i < chart->line_count; i++)
        if (chart_twin_word(&chart->lines[i]) == NULL) colour(chart, i);
    for (int i = 0; i < chart->line_count; i++)
        if (chart_is_program(&chart->lines[i])) colour(chart, i);
    colour(chart, first_of(chart, "engine"));
    colour(chart, first_of(chart, "interior"));
    colour(chart, rival);
    colour(chart, first_of(chart, "scene-net"));
    for (int i = 0; i < chart->line_count; i++)
        if (chart->lines[i].rank == CHART_COLOURED) colour(chart, find_twin(chart, &chart->lines[i]));
    /* Lines of a learned method with a word in its setting, "gns:net=off", are there to be compared with it. */
    for (int i = 0; i < chart->line_count; i++) {
        ChartLine *line = &chart->lines[i];
        const int first = first_of(chart, line->method);
        bool on_front = false;
        for (int p = 0; p < CHART_PANELS; p++)
            for (int k = 0; k < chart->panels[p].count; k++)
                on_front |= chart->panels[p].marks[k].line == i && chart->panels[p].marks[k].on_front;
        if (line->description != NULL && line->description->twin != NULL && first != i && first >= 0 &&
            line->rank == CHART_GREY && !on_front)
            line->rank = CHART_HIDDEN;
    }
    return true;
}

static void widen(Chart *chart, const ChartMark *mark) {
    chart->us_least = fmin(chart->us_least, mark->us);
    chart->us_most = fmax(chart->us_most, mark->us);
    chart->error_least = fmin(chart->error_least, mark->error);
    chart->error_most = fmax(chart->error_most, mark->error);
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

/* Adds the lines and marks of a scene's rows by one protocol. Those of a method that lost the scene are marks until the
   ranks are known. */
static bool add_rows(Chart *chart, const CsvTable *table, const char *scene, const char *path, Error *error) {
    const ChartProtocol protocol = chart->frozen ? PROTOCOL_FROZEN : PROTOCOL_CLOSED;
    for (int i = 0; i < table->count; i++) {
        const ChartRow *row = chart_row(table, i);
        const MethodDescription *method = method_describe(row->method);
        const int p = row->phase == PHASE_IMPACT ? 0 : 1;
        char key[CHART_FAMILY_SIZE];
        int k = 0;
        if (strcmp(row->scene, scene) != 0) continue;
        chart_row_family(row, key);
        while (k < chart->line_count && strcmp(chart->lines[k].key, key) != 0) k++;
        ChartLine *line = &chart->lines[k];
        if (k == CHART_MAX_LINES)
            return error_input(error, path, "a chart can show at most %d methods", CHART_MAX_LINES);
        if (k == chart->line_count) {
            chart->line_count++;
            *line = (ChartLine){.method = row->method, .description = method};
            strcpy(line->key, key);
            name_line(key, line->name);
            line->competes = method == NULL || method->role == METHOD_COMPETES;
        }
        if (row->protocol != protocol || row->phase == PHASE_REST) continue;
        if (row->floor > PARETO_RESOLUTION) chart->floor[p] = row->floor;
        const bool own_clock = isnan(row->us_solver) && !isnan(row->us_engine);
        const ChartMark mark = {.line = k,
                                .us = own_clock ? row->us_engine : row->us_solver,
                                .error = fmax(row->error_mean, chart_row_resolution(row)),
                                .floored = row->error_mean < PARETO_RESOLUTION && !(row->floor > PARETO_RESOLUTION),
                                .lost = !chart->frozen && chart_row_lost(table->rows, table->count, row),
                                .baseline = method != NULL && method->baseline && row->setting[0] == '\0',
                                .method = row->method,
                                .setting = row->setting};
        if (!mark.lost && row->launches > chart->launches) chart->launches = row->launches;
        if (mark.us > 0 && !isnan(row->error_mean))
            chart->panels[p].marks[chart->panels[p].count++] = mark;
        else
            line->left_out += !mark.lost;
    }
    return true;
}

/* The reference is a solver, too: what it reaches is reached. */
static bool is_solver(const ChartLine *line) {
    return !chart_is_program(line) &&
           (line->competes || (line->description != NULL && line->description->role == METHOD_REFERENCE));
}

static int compare_marks(const void *left, const void *right) {
    const ChartMark *a = left, *b = right;
    if (a->line != b->line) return a->line - b->line;
    if (a->us != b->us) return a->us < b->us ? -1 : 1;
    return (a->error > b->error) - (a->error < b->error);
}

/* Ten times as quick or accurate is worth a place; three times as slow or wrong is not. */
static bool is_far(double value, double least, double most) { return value < least / 10 || value > most * 3; }

/* The coloured lines set the axes: a method a thousand times as quick as they are would push them into a corner. */
static void fit_axes(Chart *chart) {
    for (int p = 0; p < CHART_PANELS; p++)
        for (int i = 0; i < chart->panels[p].count; i++) {
            const ChartMark *mark = &chart->panels[p].marks[i];
            if (chart->lines[mark->line].rank == CHART_COLOURED && !mark->beaten && !mark->lost) widen(chart, mark);
        }
    for (int p = 0; p < CHART_PANELS; p++)
        if (chart->floor[p] > 0) chart->error_least = fmin(chart->error_least, chart->floor[p]);
    const Chart alone = *chart;
    const bool any = alone.us_most > 0;
    for (int p = 0; p < CHART_PANELS; p++) {
        ChartPanel *panel = &chart->panels[p];
        int kept = 0;
        for (int i = 0; i < panel->count; i++) {
            const ChartMark mark = panel->marks[i];
            ChartLine *line = &chart->lines[mark.line];
            /* Of what is beaten only defaults of coloured lines. */
            const bool standard = mark.baseline || (line->rank == CHART_COLOURED && chart_mark_is_default(&mark));
            line->lost += mark.lost && !line->asked;
            if (line->rank == CHART_HIDDEN || (mark.beaten && !standard) || (mark.lost && !line->asked)) continue;
            if (any && (is_far(mark.us, alone.us_least, alone.us_most) ||
                        is_far(mark.error, alone.error_least, alone.error_most))) {
                const bool first = line->beyond++ == 0;
                line->beyond_us[0] = first ? mark.us : fmin(line->beyond_us[0], mark.us);
                line->beyond_us[1] = first ? mark.us : fmax(line->beyond_us[1], mark.us);
                line->beyond_error[0] = first ? mark.error : fmin(line->beyond_error[0], mark.error);
                line->beyond_error[1] = first ? mark.error : fmax(line->beyond_error[1], mark.error);
                continue;
            }
            line->marks[p]++;
            chart->floored += mark.floored;
            widen(chart, &mark);
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

/* Whether all marks of the line with the same keys have this setting, "k=20". */
static bool is_common(const Chart *chart, const ChartMark *mark, const char *part) {
    char own[CHART_SETTING_SIZE], keys[CHART_SETTING_SIZE], all[CHART_SETTING_SIZE + 2], wanted[CHART_SETTING_SIZE + 2];
    keys_of(mark->setting, own);
    snprintf(wanted, sizeof wanted, ",%s,", part);
    for (int p = 0; p < CHART_PANELS; p++)
        for (int i = 0; i < chart->panels[p].count; i++) {
            const ChartMark *other = &chart->panels[p].marks[i];
            if (other->line != mark->line) continue;
            keys_of(other->setting, keys);
            snprintf(all, sizeof all, ",%s,", other->setting);
            if (strcmp(own, keys) == 0 && strstr(all, wanted) == NULL) return false;
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

bool chart_gather(Chart *chart, const CsvTable *table, const char *scene, const char *path, const ChartLook *look,
                  Error *error) {
    *chart = (Chart){.us_least = INFINITY, .error_least = INFINITY, .frozen = look->frozen};
    chart_times_note(chart->times, table->rows, table->count);
    chart_make_plain(chart->times);
    bool room = true, ok = true;
    for (int p = 0; p < CHART_PANELS; p++) {
        chart->panels[p].marks = calloc((size_t)table->count + 1, sizeof(ChartMark));
        room = room && chart->panels[p].marks != NULL;
    }
    if (room) ok = add_rows(chart, table, scene, path, error);
    for (int p = 0; ok && room && p < CHART_PANELS; p++) {
        /* The front is that of all solvers, whether they are drawn or not. */
        ChartPanel *panel = &chart->panels[p];
        chart->front[p] = find_front(chart, p, is_solver, &chart->front_count[p]);
        room = chart->front[p] != NULL;
        for (int i = 0; room && i < panel->count; i++)
            panel->marks[i].on_front = is_on(&panel->marks[i], chart->front[p], chart->front_count[p]);
        /* Those that another setting of the line beats in both. */
        for (int i = 0; i < panel->count; i++)
            for (int k = 0; k < panel->count; k++) {
                const ChartMark *mark = &panel->marks[i], *other = &panel->marks[k];
                if (mark->line == other->line && !mark->lost && !other->lost && other->us <= mark->us &&
                    other->error <= mark->error && (other->us < mark->us || other->error < mark->error))
                    panel->marks[i].beaten = true;
            }
    }
    room = room && (!ok || rank(chart, look));
    ok = ok && (room || error_memory(error, path));
    if (ok) {
        fit_axes(chart);
        for (int p = 0; p < CHART_PANELS; p++)
            qsort(chart->panels[p].marks, (size_t)chart->panels[p].count, sizeof(ChartMark), compare_marks);
        for (int p = 0; p < CHART_PANELS; p++)
            for (int i = 0; i < chart->panels[p].count; i++) label_mark(chart, &chart->panels[p].marks[i]);
        ok = chart->panels[0].count + chart->panels[1].count > 0 ||
             error_input(error, path, "no row of the scene '%s' %s has a time and an error", scene,
                         chart->frozen ? "on recorded steps" : "in closed loop");
    }
    const char *keys[CHART_MAX_LINES];
    RunColours colours[CHART_MAX_LINES];
    for (int i = 0; i < chart->line_count; i++) keys[i] = chart->lines[i].key;
    const ColourChoices these = colours_of_these(&look->colours, keys, chart->line_count);
    ok = ok && colours_assign(keys, chart->line_count, &these, colours, error);
    for (int i = 0; ok && i < chart->line_count; i++) chart->lines[i].colours = colours[i];
    if (!ok) chart_free(chart);
    return ok;
}

void chart_free(Chart *chart) {
    for (int p = 0; p < CHART_PANELS; p++) {
        free(chart->panels[p].marks);
        free(chart->front[p]);
        chart->panels[p] = (ChartPanel){.count = 0};
        chart->front[p] = NULL;
    }
}
