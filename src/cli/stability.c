/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/stability.h"

#include "cli/commands.h"
#include "cli/installed.h"
#include "cli/options.h"
#include "cli/progress_bar.h"
#include "cli/shard_option.h"
#include "cli/stability_clip.h"
#include "cli/stability_pages.h"
#include "cli/stability_plan_print.h"
#include "cli/stability_print.h"
#include "npz/output_check.h"
#include "stability/stability_case.h"
#include "stability/stability_figures.h"
#include "stability/stability_studies.h"

#include <stdio.h>
#include <stdlib.h>

/* One parameter more than can be varied, which stability_own_make() then refuses. */
enum { CLIP_WIDTH = 1280, CLIP_HEIGHT = 720, VARY_TEXTS = STABILITY_MAX_VARY + 1 };

typedef struct Options {
    StabilityOptions study;
    bool pages, plan;
    const char *shard; /* or NULL */
    const char *clip;  /* or NULL */
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
     "Folder for stability.csv, maps.csv, refusals.csv, fallbacks.csv, rest.csv and the figures",
     OPTION_TEXT(Options, study.folder)},
    {"--methods", 0, "LIST",
     "Methods, separated by commas; a name alone makes as many sweeps as the scene sets (default: all that the study "
     "does not report as left out)",
     OPTION_TEXT(Options, study.methods)},
    {"--vary", 0, "NAME[=FROM:TO[:STEP]]",
     "Parameter of SCENE to vary, by default between its bounds; with STEP at every such value, up to 128; two "
     "parameters give their map, too",
     OPTION_TEXTS(Options, vary, vary_count)},
    {"--study", 0, "NAME", "Only this study or map (may be repeated; default: all)",
     OPTION_TEXTS(Options, study.names, study.name_count), .names = study_names},
    {"--scenes", 0, "DIR",
     "Folder whose subfolder stability/ has the scenes (default: scenes, or the installed scenes)",
     OPTION_TEXT(Options, study.scenes)},
    {"--quick", 0, NULL, "Few studies, small maps: under two minutes; of SCENE: few values",
     OPTION_FLAG(Options, study.quick)},
    {"--pages", 0, NULL,
     "Also write stability.html: maps whose cells at a border link to pages that play what happened there",
     OPTION_FLAG(Options, pages)},
    {"--clip", 0, "CELL",
     "Only make a video of a map's cell, MAP:METHOD:X,Y, beside a method that holds there; DIR must have the map",
     OPTION_TEXT(Options, clip)},
    {OPTION_SHARD(Options, shard)},
    {"--plan", 0, NULL, "Only measure some of the pieces, and print what all take on 1 to 100,000 cores; needs no -o",
     OPTION_FLAG(Options, plan)},
    {0}};

static const CommandSpec spec = {
    .options = option_table,
    .input = {.value = "[SCENE]", OPTION_PATH(Options, scene)},
    .inputs = {0, 1, "scene"},
    .help =
        "Find where each method fails. Along one parameter of a scene (height of a stack, mass ratio, time step, ...): "
        "every border between holding and failing, and how it fails there. Over two parameters: maps. A run holds if "
        "it settles, sways or creeps. Takes up to twenty minutes on two cores. An interrupted run continues where it "
        "stopped.\n"
        "With SCENE: the same along one or two of the parameters of that scene. A parameter takes 13 runs of every "
        "method and about ten more for each border, a map 100, each as long as the scene's frames.\n"
        "With --pages, up to 8 failing cells of each method in each map get a page, which shows at most nine seconds "
        "of the run beside the first method that holds there; all pages together take at most 256 MB.\v"
        "Example: twinbox stability -o out/stability\n"
        "         twinbox stability wall.yaml --vary rows --vary mass=1:100 -o out/wall\n"
        "         twinbox stability --study stack_height --methods engine,momentum:k=20 -o out/height\n"
        "         twinbox stability -o out/stability --clip height_iterations:engine:15,5"};

/* Frees with free_maps(), also after a failure. */
typedef struct ClipMaps {
    ClipMap *items; /* [count] */
    int count;
    char (*paths)[STABILITY_PATH_SIZE];
} ClipMaps;

static void free_maps(ClipMaps *maps) {
    free(maps->paths);
    free(maps->items);
}

static bool list_maps(ClipMaps *maps, const Options *options, Error *error) {
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
        maps->items[i] = (ClipMap){map->name, maps->paths[i], map->x.parameter, map->y.parameter};
    }
    return true;
}

static bool make_clip(const Options *options, Error *error) {
    ClipMaps maps = {0};
    bool ok = list_maps(&maps, options, error);
    const ClipOptions clip = {options->study.folder, options->clip, maps.items, maps.count, CLIP_WIDTH, CLIP_HEIGHT};
    ok = ok && stability_clip(&clip, error);
    free_maps(&maps);
    return ok;
}

static bool write_pages(const Options *options, uint64_t key, Error *error) {
    ClipMaps maps = {0};
    bool ok = list_maps(&maps, options, error);
    const StabilityPages pages = {options->study.folder, maps.items, maps.count};
    ok = ok && stability_pages_write(&pages, key, error);
    free_maps(&maps);
    return ok;
}

static bool draw(void *context, uint64_t key, Error *error) {
    const Options *options = context;
    const bool drawn = stability_figures_write(options->study.folder, progress_bar_begin("maps"), error);
    progress_bar_end();
    return drawn && (!options->pages || write_pages(options, key, error));
}

static bool study(const StabilityOptions *options, Error *error) {
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
    if (options->plan && (options->pages || options->clip != NULL || options->shard != NULL))
        return error_input(error, "--plan", "writes nothing; it cannot be combined with --pages, --clip or --shard");
    if (options->pages && options->clip != NULL) return error_input(error, "--pages", "cannot be combined with --clip");
    if (options->scene == NULL)
        return options->vary_count == 0 || error_input(error, "--vary", "a scene is needed: its parameters are varied");
    if (options->vary_count == 0)
        return error_input(error, options->scene, "--vary NAME is needed: the parameter of the scene to vary");
    return options->study.name_count == 0 ||
           error_input(error, "--study", "is for the studies without SCENE; '%s' is given", options->scene);
}

bool command_stability(int argc, char **argv, Error *error) {
    Options options = {.study = {.scenes = installed_path("scenes"), .draw = draw}};
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
    if (options.clip != NULL) return make_clip(&options, error);
    return output_check_folder(options.study.folder, error) && study(&options.study, error);
}
