/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/render_look.h"

#include "common/names.h"
#include "picture/picture.h"
#include "study/chart_csv.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { COMPARE = 512, SHOW, CAMERA, THEME, COSTS };

static const struct argp_option option_table[] = {
    {NULL, 0, NULL, 0, "Look:", 2},
    {"compare", COMPARE, "KIND", 0,
     "split: a panel for each run (default); overlay: one panel, all runs but the first as outlines; difference: boxes "
     "coloured by their distance from the first run's",
     0},
    {"show", SHOW, "LIST", 0,
     "Any of ghosts (outlines of the first run), distance (colours), trails, contacts, impulses, velocities (arrows), "
     "timeline (distance from the first run over time), separated by commas",
     0},
    {"camera", CAMERA, "KIND", 0,
     "fit: fixed (default); bomb: follows the bomb; divergence: zooms in where the distance first exceeds 1 mm", 0},
    {"theme", THEME, "light|dark", 0, "Colours (default: light)", 0},
    {"costs", COSTS, "FILE.csv", 0, "Add the time per step to the captions, from a chart.csv of 'twinbox chart'", 0},
    {0}};

static error_t parse(int key, char *value, struct argp_state *state) {
    RenderLookOptions *options = state->input;
    switch (key) {
    case COMPARE: options->compare = value; break;
    case SHOW: options->show = value; break;
    case CAMERA: options->camera = value; break;
    case THEME: options->theme = value; break;
    case COSTS: options->costs = value; break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

const struct argp render_look_argp = {option_table, parse, NULL, NULL, NULL, NULL, NULL};

/* The index of a name of `length` characters in a list, or -1. */
static int find(const char *const *names, const char *name, size_t length) {
    for (int i = 0; names[i] != NULL; i++)
        if (strlen(names[i]) == length && strncmp(names[i], name, length) == 0) return i;
    return -1;
}

static bool unknown(const char *option, const char *name, size_t length, const char *const *names, Error *error) {
    NameList known = {0};
    for (int i = 0; names[i] != NULL; i++) name_list_add(&known, names[i]);
    char shown[64];
    snprintf(shown, sizeof shown, "%.*s", (int)(length < sizeof shown ? length : sizeof shown), name);
    return error_unknown(error, option, shown, "a valid value", &known);
}

/* NULL leaves *index unchanged. */
static bool read_name(const char *option, const char *name, const char *const *names, int *index, Error *error) {
    if (name == NULL) return true;
    *index = find(names, name, strlen(name));
    return *index >= 0 || unknown(option, name, strlen(name), names, error);
}

static bool read_list(const char *option, const char *list, const char *const *names, unsigned *bits, Error *error) {
    while (list != NULL) {
        size_t length = strcspn(list, ",");
        int i = find(names, list, length);
        if (i < 0) return unknown(option, list, length, names, error);
        *bits |= 1u << i;
        list = list[length] == ',' ? list + length + 1 : NULL;
    }
    return true;
}

bool render_look_read(const RenderLookOptions *options, RenderLook *look, Error *error) {
    int compare = 0, camera = 0, theme = 0;
    if (!read_name("--compare", options->compare, look_compare_names, &compare, error) ||
        !read_name("--camera", options->camera, look_camera_names, &camera, error) ||
        !read_name("--theme", options->theme, look_theme_names, &theme, error) ||
        !read_list("--show", options->show, look_show_names, &look->show, error))
        return false;
    look->compare = (LookCompare)compare;
    look->camera = (LookCamera)camera;
    look->theme = (LookTheme)theme;
    return true;
}

/* "momentum:k=20" is method "momentum" with setting "k=20". The chart has no setting for the network. */
static const char *settings_of(const Trajectory *run) {
    const char *colon = strchr(run->method, ':');
    return colon == NULL || strncmp(colon + 1, "network=", 8) == 0 ? "" : colon + 1;
}

static bool is_of(const ChartRow *row, const Trajectory *run) {
    size_t length = strcspn(run->method, ":");
    return strncmp(row->method, run->method, length) == 0 && row->method[length] == '\0';
}

/* The row with these settings. A run without settings uses the scene's, which a trajectory does not store; if no row has
   none, the only row of the method counts. NULL if there is no row. */
static const ChartRow *find_cost(const ChartTable *table, const Trajectory *run) {
    const ChartRow *found = NULL;
    const char *settings = settings_of(run);
    int fitting = 0;
    for (int i = 0; i < table->count; i++) {
        const ChartRow *row = &table->rows[i];
        if (strcmp(row->scene, run->scene) != 0 || row->protocol != PROTOCOL_CLOSED || row->phase != PHASE_IMPACT ||
            isnan(row->us_solver) || !is_of(row, run))
            continue;
        if (strcmp(row->setting, settings) == 0) return row;
        found = row;
        fitting++;
    }
    return settings[0] == '\0' && fitting == 1 ? found : NULL;
}

static bool read_costs(RenderLookOptions *options, RenderLook *look, const Panels *panels, Error *error) {
    ChartTable table;
    if (!chart_csv_read(&table, options->costs, error)) return false;
    int found = 0;
    for (int i = 0; i < panels->count; i++) {
        const ChartRow *row = find_cost(&table, panels->runs[i]);
        if (row == NULL) continue;
        const int decimals = row->us_solver < 1 ? 2 : row->us_solver < 100 ? 1 : 0;
        snprintf(options->cost_texts[i], sizeof options->cost_texts[i], "%.*f \xC2\xB5s a step at the impact", decimals,
                 row->us_solver);
        look->costs[i] = options->cost_texts[i];
        found++;
    }
    chart_csv_free(&table);
    return found > 0 ||
           error_input(error, options->costs, "has no closed-loop time at the impact for any of these runs");
}

bool render_look_apply(RenderLookOptions *options, RenderLook *look, const Panels *panels, Error *error) {
    return look_check(look, (const Trajectory *const *)panels->runs, panels->count, error) &&
           (options->costs == NULL || read_costs(options, look, panels, error));
}
