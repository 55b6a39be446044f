/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/stability_pages.h"

#include "cli/page_set.h"
#include "cli/progress_bar.h"
#include "simulate/method.h"
#include "stability/map_pages.h"
#include "stability/stability_html.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TITLE_SIZE = 320 };

/* s that are shown before the frame that decided the verdict. */
static const double shown_before = 6;

typedef struct Pages {
    const StabilityPages *options;
    PageSet set;
    MapTable table;
    MapPanels *map; /* the current one, */
    int panel;      /* and method */
    int first, row; /* the map's first part; the row of the table behind it */
} Pages;

static const ClipMap *find_map(const Pages *pages, const char *name) {
    for (int i = 0; i < pages->options->map_count; i++)
        if (strcmp(pages->options->maps[i].name, name) == 0) return &pages->options->maps[i];
    return NULL;
}

/* Its name is that of the cell's clip. */
static bool write_page(Pages *pages, const CellRuns *runs, const MapCell *cell, PageFile *file, Error *error) {
    const Trajectory *const *shown = (const Trajectory *const *)runs->panels.runs;
    char clip[MAP_CLIP_SIZE], title[TITLE_SIZE];
    map_cell_clip(clip, cell);
    snprintf(title, sizeof title, "%s %.4g%s%s, %s %.4g%s%s", cell->x_parameter, cell->x,
             cell->x_unit[0] != '\0' ? " " : "", cell->x_unit, cell->y_parameter, cell->y,
             cell->y_unit[0] != '\0' ? " " : "", cell->y_unit);
    const double first = floor((cell->frame * runs->dt - shown_before) / (double)shown[0]->dt);
    const int last = shown[0]->frames - 1;
    const PlayerOptions options = {.first = first > last ? last
                                            : first > 0  ? (int)first
                                                         : 0,
                                   .last = -1,
                                   .title = title,
                                   .describe = method_describe};
    return page_set_write(&pages->set, strrchr(clip, '/') + 1, shown, runs->panels.count, &options, file, error);
}

static bool write_cell(Pages *pages, const MapCell *cell, FILE *rows, const Progress *progress, Error *error) {
    const ClipMap *map = find_map(pages, cell->map);
    CellRuns runs;
    PageFile file;
    if (map == NULL) return error_input(error, "--pages", "map %s has no scene", cell->map);
    bool ok = cell_runs_make(&runs, map, &pages->table, cell, cell->map, progress, error) &&
              write_page(pages, &runs, cell, &file, error);
    cell_runs_free(&runs);
    if (!ok) return false;
    const int body = isnan(cell->body) ? -1 : (int)cell->body;
    char link[PAGE_LINK_SIZE];
    page_set_link(link, &file, cell->frame * runs.dt, body, runs.count - 1);
    const MapPage row = {.map = cell->map,
                         .method = cell->method,
                         .setting = cell->setting,
                         .x = cell->x,
                         .y = cell->y,
                         .time = cell->frame * runs.dt,
                         .frame = (int)cell->frame,
                         .body = body,
                         .page = link,
                         .bytes = file.bytes};
    return piece_tables_print(rows, &map_page_layout, -1, &row, error);
}

/* Parts are the methods of map after map, and come in this order. */
static bool enter(Pages *pages, int part, Error *error) {
    while (part >= pages->first + pages->map->panel_count) {
        pages->first += pages->map->panel_count;
        if (!map_panels_gather(pages->map, &pages->table, &pages->row, error)) return false;
    }
    pages->panel = part - pages->first;
    return true;
}

/* The pages of a method in a map. */
static bool write_method(void *context, int part, FILE *rows, const Progress *progress, Error *error) {
    Pages *pages = context;
    MapPlace places[MAP_PAGES_EACH];
    if (!enter(pages, part, error)) return false;
    const int count = map_pages_choose(pages->map, pages->panel, places);
    for (int i = 0; i < count; i++) {
        const MapCell *cell = map_panels_cell(pages->map, &pages->table, pages->panel, places[i]);
        ProgressStage stage = {progress, (double)i / count, 1.0 / count, false};
        if (!write_cell(pages, cell, rows, &(Progress){progress_stage, &stage}, error)) return false;
    }
    return true;
}

static int count_methods(const MapTable *table) {
    int count = 0;
    for (int i = 0; i < table->count; i++)
        count += i == 0 || strcmp(table->cells[i].map, table->cells[i - 1].map) != 0 ||
                 !map_cell_same_method(&table->cells[i], &table->cells[i - 1]);
    return count;
}

bool stability_pages_write(const StabilityPages *options, uint64_t key, Error *error) {
    Pages pages = {
        .options = options,
        .map = calloc(1, sizeof *pages.map),
        .set = {.folder = options->folder, .layout = &map_page_layout, .write = write_method, .context = &pages}};
    if (pages.map == NULL) return error_memory(error, "pages");
    bool ok = map_table_read(&pages.table, options->folder, error);
    if (ok) pages.set.parts = count_methods(&pages.table);
    ok = ok && page_set_make(&pages.set, key, progress_bar_begin("pages"), error) &&
         stability_html_write(options->folder, error) && page_set_end(&pages.set, error);
    progress_bar_end();
    map_table_free(&pages.table);
    free(pages.map);
    if (ok) page_set_print(&pages.set, "stability.html");
    return ok;
}
