/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox stability: the cells of its maps, the runs that show them, the command. */
#include "base/base.h"
#include "base/file.h"
#include "base/machine.h"
#include "cli/cli.h"
#include "cli/common_options.h"
#include "cli/installed.h"
#include "cli/larger_commands.h"
#include "cli/options.h"
#include "cli/output_checks.h"
#include "cli/panels.h"
#include "cli/progress_bar.h"
#include "pictures/picture.h"
#include "pictures/render.h"
#include "runs/pieces.h"
#include "runs/trajectory.h"
#include "runs/verdict.h"
#include "scenes/scenes.h"
#include "studies/contenders.h"
#include "studies/stability.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

const MapCell *stability_cell_holder(const CsvTable *table, const MapCell *row) {
    for (int i = 0; i < table->count; i++) {
        const MapCell *other = map_cell(table, i);
        if (strcmp(other->map, row->map) == 0 && other->x == row->x && other->y == row->y &&
            other->verdict < VERDICTS && verdict_holds((Verdict)other->verdict))
            return other;
    }
    return NULL;
}

/* s that are shown after the frame that decided the verdict. */
static const double shown_after = 3;

/* Hz: a scene with more steps per second is thinned to this rate. */
static const double shown_rate = 60;

typedef struct Making {
    CellRuns *runs;
    const CellMap *map;
    const char *input;
    const Progress *progress;
} Making;

static Scene *read_scene(const Making *making, Error *error) {
    SceneSetting settings[2] = {{.value = making->runs->rows[0]->x}, {.value = making->runs->rows[0]->y}};
    snprintf(settings[0].name, sizeof settings[0].name, "%s", making->map->x_parameter);
    snprintf(settings[1].name, sizeof settings[1].name, "%s", making->map->y_parameter);
    return scene_read_with(making->map->scene, settings, settings[1].name[0] != '\0' ? 2 : 1, error);
}

/* "falls at 4.22 s (0.53 m, body 7)" */
static void cell_note(char note[CELL_NOTE_SIZE], const MapCell *cell, double dt) {
    snprintf(note, CELL_NOTE_SIZE, "%s", verdict_words[cell->verdict]);
    if (verdict_holds((Verdict)cell->verdict) || isnan(cell->frame)) return;
    text_add(note, CELL_NOTE_SIZE, " at %.2f s", cell->frame * dt);
    if (isnan(cell->value)) return;
    text_add(note, CELL_NOTE_SIZE, " (%.3g %s", cell->value, cell->unit);
    if (!isnan(cell->body) && cell->body >= 0) text_add(note, CELL_NOTE_SIZE, ", body %.0f", cell->body);
    text_add(note, CELL_NOTE_SIZE, ")");
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
    scene->frames = row->verdict >= VERDICT_NON_FINITE && decided > 1 ? decided - 1 : shown;
    if (add_run(making, scene, row, &failure)) return true;
    if (row->verdict != VERDICT_EXPLODES || failure.failure == FAILURE_NONE || decided >= shown)
        return *error = failure, false;
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

bool cell_runs_make(CellRuns *runs, const CellMap *map, const MapCell *holder, const MapCell *cell, const char *input,
                    const Progress *progress, Error *error) {
    const Making making = {runs, map, input, progress};
    *runs = (CellRuns){.count = 0};
    if (holder != NULL && !verdict_holds((Verdict)cell->verdict)) runs->rows[runs->count++] = holder;
    runs->rows[runs->count++] = cell;
    return run_all(&making, error) && thin_out(runs, error);
}

void cell_runs_free(CellRuns *runs) { panels_free(&runs->panels); }

const CellMap *cell_map_find(const CellMap *maps, int count, const char *name, Error *error) {
    for (int i = 0; i < count; i++)
        if (strcmp(maps[i].name, name) == 0) return &maps[i];
    return error_input(error, "--pages", "map %s has no scene", name), NULL;
}

/* One parameter more than can be varied, which stability_own_make() then refuses. */
enum { VARY_TEXTS = STABILITY_MAX_VARY + 1 };

typedef struct Options {
    StabilityOptions study;
    bool pages, plan;
    const char *shard; /* or NULL */
    const char *scene; /* or NULL */
    int vary_count;
    const char *vary[VARY_TEXTS];
} Options;

/* Of studies and maps, for completion. */
static const char *study_names[64];

static void list_names(void) {
    enum { MOST = sizeof study_names / sizeof *study_names - 1 };
    int count = 0;
    for (int i = 0; i < stability_study_count && count < MOST; i++) study_names[count++] = stability_studies[i].name;
    for (int i = 0; i < stability_map_count && count < MOST; i++) study_names[count++] = stability_maps[i].name;
}

static const Option option_table[] = {
    {"--output", 'o', "DIR",
     "Folder for stability.csv, maps.csv, refusals.csv, fallbacks.csv, rest.csv, unconverged.csv and the figures",
     OPTION_TEXT(Options, study.folder)},
    {"--methods", 0, "LIST",
     "Methods, separated by commas; a name alone makes as many sweeps as the scene sets (default: all that the study "
     "does not report as left out)",
     OPTION_METHOD(Options, study.methods)},
    {"--vary", 0, "NAME[=FROM:TO[:STEP]]",
     "Vary a parameter of SCENE, by default between its bounds, or what every scene has: iterations, dt, friction, "
     "bomb_x, bomb_y, bomb_mass, bomb_speed; with STEP at every such value, up to 128; two of them also give their map",
     OPTION_TEXTS(Options, vary, vary_count)},
    {"--study", 0, "NAME", "Only this study or map (may be repeated; default: all)",
     OPTION_TEXTS(Options, study.names, study.name_count), .names = study_names},
    {"--scenes", 0, "DIR",
     "Folder whose subfolder stability/ has the scenes (default: scenes, or the installed scenes)",
     OPTION_TEXT(Options, study.scenes)},
    {"--quick", 0, NULL, "Few studies, small maps: under two minutes; of SCENE: few values",
     OPTION_FLAG(Options, study.quick)},
    {"--pages", 0, NULL,
     "Also write stability.html: borders and maps whose failing cells link to pages that play what happened there",
     OPTION_FLAG(Options, pages)},
    {OPTION_SHARD(Options, shard)},
    {"--plan", 0, NULL, "Only measure some of the pieces, and print what all take on 1 to 100,000 cores; needs no -o",
     OPTION_FLAG(Options, plan)},
    {0}};

static const CommandSpec spec = {
    .options = option_table,
    .input = {.value = "[SCENE]", OPTION_PATH(Options, scene)},
    .inputs = {0, 1, "scene"},
    .help =
        "Find where each method fails. Along one parameter of a scene (height of a stack, mass ratio, time step, "
        "...): every border between holding and failing, and how it fails there. Over two parameters: maps. A run "
        "holds if it settles, moves or creeps; where a bomb or a moving body strikes, if as many boxes fall as in the "
        "converged run: none, fewer than half, or more. Takes up to twenty minutes on two cores. An interrupted run "
        "continues where it stopped.\n"
        "With SCENE: the same along one or two parameters, of that scene or of every scene. A parameter takes 13 runs "
        "of every method and about ten more for each border, a map 100, each as long as the scene's frames.\n"
        "With --pages, the first failing value of each border and up to 8 failing cells of each method in each map "
        "get a page, which shows at most nine seconds of the run beside the first method that holds there; all pages "
        "together take at most 256 MB.\v"
        "Example: twinbox stability -o out/stability\n"
        "         twinbox new wall.yaml --like wall\n"
        "         twinbox stability wall.yaml --vary pairs --vary bomb_mass -o out/wall\n"
        "         twinbox stability stack --vary iterations --quick -o out/borders\n"
        "         twinbox stability --study stack_height --methods engine -o out/height"};

/* Frees with free_maps(), also after a failure. */
typedef struct CellMaps {
    CellMap *items; /* [count] */
    int count;
    char (*paths)[STABILITY_PATH_SIZE];
} CellMaps;

static void free_maps(CellMaps *maps) {
    free(maps->paths);
    free(maps->items);
}

static bool list_maps(CellMaps *maps, const Options *options, Error *error) {
    const StabilityOwn *own = options->study.own;
    const StabilityMap *table = own != NULL ? own->maps : stability_maps;
    maps->count = own != NULL ? own->map_count : stability_map_count;
    maps->paths = malloc(((size_t)maps->count + 1) * sizeof *maps->paths);
    maps->items = malloc(((size_t)maps->count + 1) * sizeof *maps->items);
    if (maps->paths == NULL || maps->items == NULL) return error_memory(error, "maps");
    for (int i = 0; i < maps->count; i++) {
        const StabilityMap *map = &table[i];
        const StabilityPlace place = {options->study.scenes, map->scene, map->file};
        if (!stability_path(maps->paths[i], &place, error)) return false;
        maps->items[i] = (CellMap){map->name, maps->paths[i], map->x.parameter, map->y.parameter};
    }
    return true;
}

static bool write_pages(const Options *options, uint64_t key, Error *error) {
    CellMaps maps = {0};
    bool ok = list_maps(&maps, options, error);
    const StabilityPages pages = {&options->study, maps.items, maps.count};
    ok = ok && stability_pages_write(&pages, key, error);
    free_maps(&maps);
    return ok;
}

static bool stability_draw(void *context, uint64_t key, Error *error) {
    const Options *options = context;
    const bool drawn =
        stability_figures_write(options->study.folder, options->study.own, progress_bar_begin("maps"), error);
    progress_bar_end();
    return drawn && (!options->pages || write_pages(options, key, error));
}

static bool stability_study(const StabilityOptions *options, Error *error) {
    Pieces pieces = {0};
    bool ok = stability_run(options, &pieces, progress_bar_begin("stability"), error);
    progress_bar_end();
    if (ok && pieces.mode == PIECES_SHARD) {
        shard_option_print(&pieces, options->folder);
        return true;
    }
    ok = ok && stability_print(options->folder, error);
    const NameList left_out = contenders_left_out(STUDY_STABILITY);
    if (ok && options->methods == NULL && left_out.text[0] != '\0')
        printf("left out unless named in --methods: %s\n", left_out.text);
    return ok;
}

static bool estimate(const StabilityOptions *options, Error *error) {
    PiecesEstimate result;
    const bool ok = stability_estimate(options, &result, progress_bar_begin("plan"), error);
    progress_bar_end();
    if (ok) stability_plan_print(&result);
    return ok;
}

/* SCENE and --vary go together, and neither with what chooses studies of the table. */
static bool check_options(const Options *options, Error *error) {
    if (options->study.folder == NULL && !options->plan) return error_input(error, "-o", "-o DIR is needed");
    if (options->plan && (options->pages || options->shard != NULL))
        return error_input(error, "--plan", "writes nothing; it cannot be combined with --pages or --shard");
    if (options->scene == NULL)
        return options->vary_count == 0 || error_input(error, "--vary", "a scene is needed: its parameters are varied");
    if (options->vary_count == 0)
        return error_input(error, options->scene,
                           "--vary NAME is needed: a parameter of the scene, or iterations, dt, friction, bomb_x, "
                           "bomb_y, bomb_mass or bomb_speed");
    return options->study.name_count == 0 ||
           error_input(error, "--study", "is for the studies without SCENE; '%s' is given", options->scene);
}

bool command_stability(int argc, char **argv, Error *error) {
    Options options = {.study = {.scenes = installed_path("scenes"), .draw = stability_draw}};
    StabilityOwn own;
    PiecesRun run;
    list_names();
    if (!options_parse(&spec, argc, argv, &options, error) || !check_options(&options, error)) return false;
    if (options.scene != NULL) {
        if (!stability_own_make(&own, options.scene, options.vary, options.vary_count, options.study.quick, error))
            return false;
        options.study.own = &own;
    }
    options.study.draw_context = &options;
    options.study.run = &run;
    if (options.plan) return estimate(&options.study, error);
    if (!shard_option_take(&run, options.shard, argc, argv, error)) return false;
    return output_check_folder(options.study.folder, error) && stability_study(&options.study, error);
}
