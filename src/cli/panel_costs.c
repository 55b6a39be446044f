/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/panel_costs.h"

#include "simulate/method.h"
#include "study/chart_csv.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool is_of(const ChartRow *row, const Trajectory *run) {
    size_t length = strcspn(run->method, ":");
    return strncmp(row->method, run->method, length) == 0 && row->method[length] == '\0';
}

/* All settings of `some` are in `all` with the same value; a network only has to be if `all` has one. */
static bool contains(const Settings *all, const Settings *some) {
    for (int i = 0; i < some->count; i++) {
        const char *key = some->items[i].key, *value = settings_get(all, key);
        if (value == NULL ? strcmp(key, "network") != 0 : strcmp(value, some->items[i].value) != 0) return false;
    }
    return true;
}

/* In any order, and whether given or not: "engine" is "engine:k=10" in a scene with 10 iterations. The chart has no setting
   for the network that the scene names. */
static bool has_settings(const ChartRow *row, const Trajectory *run) {
    char text[METHOD_TEXT_SIZE];
    Settings charted, own;
    if (snprintf(text, sizeof text, "%s%s%s", row->method, row->setting[0] != '\0' ? ":" : "", row->setting) >=
            (int)sizeof text ||
        !method_all_settings(&charted, text, run->iterations) ||
        !method_all_settings(&own, run->method, run->iterations))
        return false;
    return contains(&charted, &own) && contains(&own, &charted);
}

/* The row with the settings of the run. A run without settings that does not state its scene's iterations is the only row
   of its method. NULL if there is no row. */
static const ChartRow *find_cost(const ChartTable *table, const Trajectory *run) {
    const ChartRow *found = NULL;
    int fitting = 0;
    for (int i = 0; i < table->count; i++) {
        const ChartRow *row = &table->rows[i];
        if (strcmp(row->scene, run->scene) != 0 || row->protocol != PROTOCOL_CLOSED || row->phase != PHASE_IMPACT ||
            isnan(row->us_solver) || !is_of(row, run))
            continue;
        if (has_settings(row, run)) return row;
        found = row;
        fitting++;
    }
    return strchr(run->method, ':') == NULL && run->iterations == 0 && fitting == 1 ? found : NULL;
}

bool panel_costs_read(PanelCosts *costs, const char *path, const Panels *panels, RenderLook *look, Error *error) {
    ChartTable table;
    if (!chart_csv_read(&table, path, error)) return false;
    int found = 0;
    for (int i = 0; i < panels->count; i++) {
        const ChartRow *row = find_cost(&table, panels->runs[i]);
        if (row == NULL) continue;
        const int decimals = row->us_solver < 1 ? 2 : row->us_solver < 100 ? 1 : 0;
        snprintf(costs->texts[i], sizeof costs->texts[i], "%.*f \xC2\xB5s a step at the impact", decimals,
                 row->us_solver);
        look->costs[i] = costs->texts[i];
        found++;
    }
    chart_csv_free(&table);
    return found > 0 || error_input(error, path, "has no closed-loop time at the impact for any of these runs");
}
