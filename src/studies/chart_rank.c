/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which lines of a chart are in colour: a reader takes in six, not twenty. */
#include "base/base.h"
#include "methods/methods.h"
#include "studies/chart_data.h"
#include "studies/chart_plot.h"
#include "studies/chart_table.h"
#include "studies/error_curve.h"

#include <stdlib.h>
#include <string.h>

bool chart_is_program(const ChartLine *line) { return line->description != NULL && line->description->external; }

const char *chart_twin_word(const ChartLine *line) {
    const MethodDescription *method = line->description;
    const char *word = method != NULL && method->twin != NULL ? method->twin + strcspn(method->twin, ":") : "";
    const char *found = word[0] == ':' ? strstr(line->key, word + 1) : NULL;
    const bool whole = found != NULL && found > line->key && (found[-1] == ':' || found[-1] == ',') &&
                       strchr(",", found[strlen(word + 1)]) != NULL;
    return whole ? word + 1 : NULL;
}

static int count_coloured(const Chart *chart) {
    int count = 0;
    for (int i = 0; i < chart->line_count; i++) count += chart->lines[i].rank == CHART_COLOURED;
    return count;
}

/* As far as there is room. */
static void colour(Chart *chart, int line) {
    if (line >= 0 && count_coloured(chart) < CHART_LOUD) chart->lines[line].rank = CHART_COLOURED;
}

/* The first line of a method, but for its silenced twins; -1: none. */
static int chart_rank_find(const Chart *chart, const char *method) {
    for (int i = 0; i < chart->line_count; i++)
        if (strcmp(chart->lines[i].method, method) == 0 && chart_twin_word(&chart->lines[i]) == NULL) return i;
    return -1;
}

/* As in the table or as in the picture. */
static bool is_named(const ChartLine *line, const char *name) {
    return strcmp(line->key, name) == 0 || strcmp(line->name, name) == 0;
}

/* Whether the list, names separated by commas, has line i; a method alone stands for its first line. */
static bool is_listed(const Chart *chart, int i, const char *highlight) {
    char name[CHART_FAMILY_SIZE];
    for (const char *next = highlight; next != NULL && *next != '\0';) {
        const size_t length = strcspn(next, ",");
        snprintf(name, sizeof name, "%.*s", (int)length, next);
        if (is_named(&chart->lines[i], name) || chart_rank_find(chart, name) == i) return true;
        next += length + (next[length] == ',');
    }
    return false;
}

static void chart_rank_ask(Chart *chart, const char *highlight) {
    for (int i = 0; i < chart->line_count; i++) {
        chart->lines[i].asked = is_listed(chart, i, highlight);
        if (chart->lines[i].asked) colour(chart, i);
    }
}

/* Notes the names of a row's line; returns whether it is the one. */
static bool check_row(const ChartRow *row, const char *name, NameList *known) {
    ChartLine line = {.method = row->method};
    chart_row_family(row, line.key);
    chart_line_name(line.key, line.name);
    name_list_add(known, line.name);
    return is_named(&line, name) || strcmp(line.method, name) == 0;
}

bool chart_highlight_check(const char *highlight, const ChartRow *rows, int count, Error *error) {
    char name[CHART_FAMILY_SIZE];
    int names = 0;
    for (const char *next = highlight; next != NULL && *next != '\0'; names++) {
        const size_t length = strcspn(next, ",");
        NameList known = {0};
        bool found = false;
        snprintf(name, sizeof name, "%.*s", (int)length, next);
        for (int i = 0; i < count; i++) found |= check_row(&rows[i], name, &known);
        if (!found) return error_unknown(error, "--highlight", name, "a method of this chart", &known);
        next += length + (next[length] == ',');
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

/* Adds the corners that each line has in the front of such methods. False if out of memory. */
static bool count_corners(const Chart *chart, int panel, int corners[CHART_MAX_LINES]) {
    const ChartPanel *all = &chart->panels[panel];
    int count;
    CurvePoint *front = chart_front(chart, panel, is_rival, &count);
    for (int i = 0; front != NULL && i < all->count; i++)
        if (is_rival(&chart->lines[all->marks[i].line]))
            corners[all->marks[i].line] += chart_mark_is_on(&all->marks[i], front, count);
    free(front);
    return front != NULL;
}

static bool find_rival(const Chart *chart, int *rival) {
    int corners[CHART_MAX_LINES] = {0};
    *rival = -1;
    for (int p = 0; p < CHART_PANELS; p++)
        if (!count_corners(chart, p, corners)) return false;
    for (int i = 0; i < chart->line_count; i++)
        if (corners[i] > 0 && (*rival < 0 || corners[i] > corners[*rival])) *rival = i;
    return true;
}

/* Whether the twin has the settings of the line, beside its word. */
static bool is_twin_of(const ChartLine *twin, const ChartLine *line) {
    char key[CHART_FAMILY_SIZE];
    const char *word = chart_twin_word(twin);
    if (word == NULL || strcmp(twin->method, line->method) != 0) return false;
    const char *at = strstr(twin->key, word);
    const size_t before = (size_t)(at - twin->key) - 1;
    snprintf(key, sizeof key, "%.*s%s", (int)before, twin->key, at + strlen(word));
    return strcmp(key, line->key) == 0;
}

static int find_twin(const Chart *chart, int line) {
    for (int i = 0; i < chart->line_count; i++)
        if (is_twin_of(&chart->lines[i], &chart->lines[line])) return i;
    return -1;
}

static bool is_on_front(const Chart *chart, int line) {
    for (int p = 0; p < CHART_PANELS; p++)
        for (int i = 0; i < chart->panels[p].count; i++)
            if (chart->panels[p].marks[i].line == line && chart->panels[p].marks[i].on_front) return true;
    return false;
}

/* Lines of a learned method with a word in its setting, "sain:engine=off", are there to be compared with it. */
static void hide_variants(Chart *chart) {
    for (int i = 0; i < chart->line_count; i++) {
        ChartLine *line = &chart->lines[i];
        const bool learned = line->description != NULL && line->description->twin != NULL;
        const bool variant = chart_rank_find(chart, line->method) != i && chart_rank_find(chart, line->method) >= 0;
        if (learned && variant && line->rank == CHART_GREY && !is_on_front(chart, i)) line->rank = CHART_HIDDEN;
    }
}

bool chart_rank(Chart *chart, const char *highlight, const char *path, Error *error) {
    int rival;
    chart_rank_ask(chart, highlight);
    if (!find_rival(chart, &rival)) return error_memory(error, path);
    for (int i = 0; i < chart->line_count; i++)
        if (chart_is_program(&chart->lines[i])) colour(chart, i);
    colour(chart, chart_rank_find(chart, "engine"));
    colour(chart, chart_rank_find(chart, "interior"));
    colour(chart, rival);
    colour(chart, chart_rank_find(chart, "scene-net"));
    for (int i = 0; i < chart->line_count; i++)
        if (chart->lines[i].rank == CHART_COLOURED) colour(chart, find_twin(chart, i));
    hide_variants(chart);
    return true;
}
