/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/stability_figures.h"

#include "stability/stability_borders.h"
#include "stability/stability_map.h"

#include <stdlib.h>

static bool go_on(int done, int total, const char *folder, const Progress *progress, Error *error) {
    return progress_report(progress, done, total) ||
           error_interrupted(error, folder, "stopped; the tables are finished");
}

/* Gathers every map and, if `draw`, draws it. A first pass without drawing detects errors before anything is drawn. */
static bool process_maps(const MapTable *table, const char *folder, bool draw, const Progress *progress, Error *error) {
    MapPanels *map = malloc(sizeof *map);
    bool ok = map != NULL || error_memory(error, folder);
    for (int row = 0; ok && row < table->count;) {
        ok = go_on(row, table->count, folder, progress, error) && map_panels_gather(map, table, &row, error);
        if (!ok || !draw) continue;
        PlotPage page = {0};
        map_panels_write(map, &page);
        ok = plot_page_write(&page, folder, "map-", map->first->map, error);
        plot_page_free(&page);
    }
    free(map);
    return ok;
}

static bool draw_borders(const BorderTable *table, const char *folder, const Progress *progress, Error *error) {
    if (table->count == 0) return true;
    PlotPage page = {0};
    bool ok = go_on(0, 1, folder, progress, error) && stability_borders_write(table, &page, error) &&
              plot_page_write(&page, folder, "", "borders", error);
    plot_page_free(&page);
    return ok;
}

bool stability_figures_write(const char *folder, const Progress *progress, Error *error) {
    MapTable maps = {0};
    BorderTable borders = {0};
    bool ok = border_table_read(&borders, folder, error) && map_table_read(&maps, folder, error) &&
              process_maps(&maps, folder, false, NULL, error) && draw_borders(&borders, folder, progress, error) &&
              process_maps(&maps, folder, true, progress, error);
    map_table_free(&maps);
    border_table_free(&borders);
    return ok;
}
