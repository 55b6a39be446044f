/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/panel_costs.h"

#include "study/chart_csv.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

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
