/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/stability_figures.h"

#include "chart/gnuplot_sheet.h"
#include "stability/stability_borders.h"
#include "stability/stability_map.h"

#include <stdlib.h>

/* Gathers every map and, if `draw`, draws it. A first pass without drawing detects errors before anything is drawn. */
static bool process_maps(const MapTable *table, const char *folder, bool draw, Error *error) {
    MapPanels *map = malloc(sizeof *map);
    bool ok = map != NULL || error_memory(error, folder);
    for (int row = 0; ok && row < table->count;) {
        ok = map_panels_gather(map, table, &row, error);
        if (!ok || !draw) continue;
        GnuplotSheet sheet = {0};
        ok = gnuplot_sheet_open(&sheet, folder, error);
        if (ok) map_panels_write(map, &sheet.page);
        ok = ok && gnuplot_sheet_close(&sheet, folder, error) &&
             gnuplot_sheet_draw(&sheet, folder, "map-", map->first->map, error);
        gnuplot_sheet_free(&sheet);
    }
    free(map);
    return ok;
}

static bool draw_borders(const BorderTable *table, const char *folder, Error *error) {
    if (table->count == 0) return true;
    GnuplotSheet sheet = {0};
    bool ok = gnuplot_sheet_open(&sheet, folder, error) && stability_borders_write(table, &sheet.page, error) &&
              gnuplot_sheet_close(&sheet, folder, error) && gnuplot_sheet_draw(&sheet, folder, "", "borders", error);
    gnuplot_sheet_free(&sheet);
    return ok;
}

bool stability_figures_write(const char *folder, Error *error) {
    MapTable maps = {0};
    BorderTable borders = {0};
    bool ok = border_table_read(&borders, folder, error) && map_table_read(&maps, folder, error) &&
              process_maps(&maps, folder, false, error) && draw_borders(&borders, folder, error) &&
              process_maps(&maps, folder, true, error);
    map_table_free(&maps);
    border_table_free(&borders);
    return ok;
}
