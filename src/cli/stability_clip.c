/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/stability_clip.h"

#include "cli/draw_panels.h"
#include "cli/stability_cell.h"
#include "common/file.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

enum { TITLE_SIZE = 320 };

static const MapCell *find_cell(const ClipOptions *options, const MapTable *table, Error *error) {
    StabilityCell cell;
    if (!stability_cell_parse(&cell, options->cell, error)) return NULL;
    const MapCell *row = stability_cell_find(table, &cell, error);
    if (row == NULL || row->verdict < VERDICTS) return row;
    error_input(error, "--clip", "'%s' is not applicable", options->cell);
    return NULL;
}

static const ClipMap *find_map(const ClipOptions *options, const MapCell *row, Error *error) {
    for (int i = 0; i < options->map_count; i++)
        if (strcmp(options->maps[i].name, row->map) == 0) return &options->maps[i];
    error_input(error, "--clip", "map %s has no scene", row->map);
    return NULL;
}

static bool draw(const ClipOptions *options, CellRuns *runs, Error *error) {
    const MapCell *own = runs->rows[runs->count - 1];
    char name[MAP_CLIP_SIZE], folder[PATH_MAX], video[PATH_MAX], title[TITLE_SIZE];
    char notes[2][CELL_NOTE_SIZE];
    map_cell_clip(name, own);
    if (!file_path(folder, sizeof folder, error, "%s/%s", options->folder, name) ||
        !file_path(video, sizeof video, error, "%s.mp4", folder))
        return false;
    snprintf(title, sizeof title, "%s %.4g %s, %s %.4g %s", own->x_parameter, own->x, own->x_unit, own->y_parameter,
             own->y, own->y_unit);
    RenderOptions render = draw_panels_defaults(folder);
    render.width = options->width;
    render.height = options->height;
    render.title = title;
    for (int i = 0; i < runs->count; i++) {
        cell_note(notes[i], runs->rows[i], runs->dt);
        render.notes[i] = notes[i];
    }
    const DrawVideos videos = {1, {video}};
    RenderResult result;
    if (!file_make_directory(folder, error) || !draw_videos_check(&videos, render.width, render.height, false, error) ||
        !draw_panels(&runs->panels, &render, &videos, NULL, &result, error))
        return false;
    printf("%s: %s -> %s, %s/frame_%06d.png ... frame_%06d.png\n", options->cell, notes[runs->count - 1], video, folder,
           result.first, result.last);
    return true;
}

bool stability_clip(const ClipOptions *options, Error *error) {
    MapTable table;
    if (!map_table_read(&table, options->folder, error)) return false;
    CellRuns runs = {.count = 0};
    const MapCell *row = find_cell(options, &table, error);
    const ClipMap *map = row != NULL ? find_map(options, row, error) : NULL;
    bool ok = map != NULL && cell_runs_make(&runs, map, &table, row, options->cell, NULL, error) &&
              draw(options, &runs, error);
    cell_runs_free(&runs);
    map_table_free(&table);
    return ok;
}
