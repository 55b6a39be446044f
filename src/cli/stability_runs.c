/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/stability_runs.h"

#include "cli/simulate_verdict.h"
#include "cli/stability_cell.h"

#include <math.h>
#include <stdio.h>

/* s that are shown after the frame that decided the verdict. */
static const double shown_after = 3;

/* Hz: a scene with more steps per second is thinned to this rate. */
static const double shown_rate = 60;

typedef struct Making {
    CellRuns *runs;
    const ClipMap *map;
    const char *input;
    const Progress *progress;
} Making;

static void choose_rows(CellRuns *runs, const MapTable *table, const MapCell *cell) {
    const MapCell *holder = verdict_holds((Verdict)cell->verdict) ? NULL : stability_cell_holder(table, cell);
    if (holder != NULL) runs->rows[runs->count++] = holder;
    runs->rows[runs->count++] = cell;
}

static Scene *read_scene(const Making *making, Error *error) {
    SceneSetting settings[2] = {{.value = making->runs->rows[0]->x}, {.value = making->runs->rows[0]->y}};
    snprintf(settings[0].name, sizeof settings[0].name, "%s", making->map->x_parameter);
    snprintf(settings[1].name, sizeof settings[1].name, "%s", making->map->y_parameter);
    return scene_read_with(making->map->scene, settings, 2, error);
}

static bool add_run(const Making *making, const Scene *scene, const MapCell *row, Error *error) {
    Panels *panels = &making->runs->panels;
    char method[MAP_METHOD_SIZE], note[CELL_NOTE_SIZE];
    map_cell_method(method, row);
    if (!panels_add_watched(panels, scene, method, making->input, making->progress, error)) return false;
    Trajectory *run = panels->runs[panels->count - 1];
    cell_note(note, row, (double)scene->dt);
    trajectory_judge(run, note, !isnan(row->frame) && row->frame < run->frames ? (int)row->frame : -1,
                     !isnan(row->body) && row->body < run->bodies ? (int)row->body : -1);
    return true;
}

/* After an explosion, states may become NaN or infinite in the seconds that follow: then these are left out. */
static bool run_row(const Making *making, Scene *scene, const MapCell *row, int shown, Error *error) {
    Error failure = {0};
    int decided = isnan(row->frame) || row->frame < 1 ? shown : (int)row->frame;
    scene->frames = row->verdict == VERDICT_NON_FINITE && decided > 1 ? decided - 1 : shown;
    if (add_run(making, scene, row, &failure)) return true;
    if (row->verdict != VERDICT_EXPLODES || failure.kind != ERROR_INPUT || decided >= shown) {
        *error = failure;
        return false;
    }
    scene->frames = decided;
    return add_run(making, scene, row, error);
}

static bool run_all(const Making *making, Error *error) {
    CellRuns *runs = making->runs;
    Scene *scene = read_scene(making, error);
    if (scene == NULL) return false;
    const MapCell *own = runs->rows[runs->count - 1];
    double shown = (isnan(own->frame) ? scene->frames : own->frame) + ceil(shown_after / (double)scene->dt);
    runs->dt = (double)scene->dt;
    bool ok = true;
    for (int i = 0, frames = scene->frames; ok && i < runs->count; i++)
        ok = run_row(making, scene, runs->rows[i], shown < frames ? (int)shown : frames, error);
    scene_destroy(scene);
    return ok;
}

static bool thin_out(CellRuns *runs, Error *error) {
    int every = (int)(1 / (shown_rate * runs->dt) + 0.01);
    for (int i = 0; every > 1 && i < runs->panels.count; i++) {
        Trajectory *thin = trajectory_every(runs->panels.runs[i], every, error);
        if (thin == NULL) return false;
        trajectory_destroy(runs->panels.runs[i]);
        runs->panels.runs[i] = thin;
    }
    return true;
}

bool cell_runs_make(CellRuns *runs, const ClipMap *map, const MapTable *table, const MapCell *cell, const char *input,
                    const Progress *progress, Error *error) {
    const Making making = {runs, map, input, progress};
    *runs = (CellRuns){.count = 0};
    choose_rows(runs, table, cell);
    return run_all(&making, error) && thin_out(runs, error);
}

void cell_runs_free(CellRuns *runs) { panels_free(&runs->panels); }

void cell_note(char note[CELL_NOTE_SIZE], const MapCell *cell, double dt) {
    size_t used = (size_t)snprintf(note, CELL_NOTE_SIZE, "%s", verdict_words[cell->verdict]);
    if (verdict_holds((Verdict)cell->verdict) || isnan(cell->frame)) return;
    used += (size_t)snprintf(note + used, CELL_NOTE_SIZE - used, " at %.2f s", cell->frame * dt);
    if (isnan(cell->value)) return;
    used += (size_t)snprintf(note + used, CELL_NOTE_SIZE - used, " (%.3g %s", cell->value, cell->unit);
    if (!isnan(cell->body) && cell->body >= 0)
        used += (size_t)snprintf(note + used, CELL_NOTE_SIZE - used, ", body %.0f", cell->body);
    snprintf(note + used, CELL_NOTE_SIZE - used, ")");
}
