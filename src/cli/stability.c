/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/stability.h"

#include "cli/commands.h"
#include "cli/installed.h"
#include "cli/options.h"
#include "cli/progress_bar.h"
#include "cli/stability_clip.h"
#include "cli/stability_print.h"
#include "stability/stability_case.h"
#include "stability/stability_figures.h"
#include "stability/stability_studies.h"

#include <stdio.h>
#include <stdlib.h>

enum { CLIP_WIDTH = 1280, CLIP_HEIGHT = 720 };

typedef struct Options {
    StabilityOptions study;
    const char *clip; /* or NULL */
} Options;

static const Option option_table[] = {
    {"--output", 'o', "DIR",
     "Folder for stability.csv, maps.csv, refusals.csv, fallbacks.csv, rest.csv and the figures",
     OPTION_TEXT(Options, study.folder), .needed = "-o DIR is needed"},
    {"--methods", 0, "LIST",
     "Methods, separated by commas; a name alone makes as many sweeps as the scene sets (default: all that the study "
     "does not report as left out)",
     OPTION_TEXT(Options, study.methods)},
    {"--study", 0, "NAME", "Only this study or map (may be repeated; default: all)",
     OPTION_TEXTS(Options, study.names, study.name_count)},
    {"--scenes", 0, "DIR",
     "Folder whose subfolder stability/ has the scenes (default: scenes, or the installed scenes)",
     OPTION_TEXT(Options, study.scenes)},
    {"--quick", 0, NULL, "Few studies, small maps: under two minutes", OPTION_FLAG(Options, study.quick)},
    {"--clip", 0, "CELL",
     "Only make a video of a map's cell, MAP:METHOD:X,Y, beside a method that holds there; DIR must have the map",
     OPTION_TEXT(Options, clip)},
    {0}};

static const CommandSpec spec = {
    .options = option_table,
    .help =
        "Find where each method fails. Along one parameter of a scene (height of a stack, mass ratio, time step, ...): "
        "every border between holding and failing, and how it fails there. Over two parameters: maps. A run holds if "
        "it settles, sways or creeps. Takes up to twenty minutes on two cores. An interrupted run continues where it "
        "stopped.\v"
        "Example: twinbox stability -o out/stability\n"
        "         twinbox stability --study stack_height --methods engine,momentum:k=20 -o out/height\n"
        "         twinbox stability -o out/stability --clip height_iterations:engine:15,5"};

static bool make_clip(const Options *options, Error *error) {
    char(*paths)[STABILITY_PATH_SIZE] = malloc((size_t)stability_map_count * sizeof *paths);
    ClipMap *maps = malloc((size_t)stability_map_count * sizeof *maps);
    bool ok = (paths != NULL && maps != NULL) || error_memory(error, options->clip);
    for (int i = 0; ok && i < stability_map_count; i++) {
        const StabilityMap *map = &stability_maps[i];
        ok = stability_path(paths[i], &(StabilityPlace){options->study.scenes, map->scene}, error);
        maps[i] = (ClipMap){map->name, paths[i], map->x.parameter, map->y.parameter};
    }
    const ClipOptions clip = {options->study.folder, options->clip, maps, stability_map_count, CLIP_WIDTH, CLIP_HEIGHT};
    if (ok) ok = stability_clip(&clip, error);
    free(paths);
    free(maps);
    return ok;
}

static bool study(const StabilityOptions *options, Error *error) {
    bool ok = stability_run(options, progress_bar_begin("stability"), error);
    progress_bar_end();
    ok = ok && stability_figures_write(options->folder, error) && stability_print(options->folder, error);
    const NameList left_out = contenders_left_out(STUDY_STABILITY);
    if (ok && options->methods == NULL && left_out.text[0] != '\0')
        printf("left out unless named in --methods: %s\n", left_out.text);
    return ok;
}

bool command_stability(int argc, char **argv, Error *error) {
    Options options = {.study.scenes = installed_path("scenes")};
    if (!options_parse(&spec, argc, argv, &options, error)) return false;
    return options.clip != NULL ? make_clip(&options, error) : study(&options.study, error);
}
