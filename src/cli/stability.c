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

enum { METHODS = 256, STUDY, SCENES, QUICK, CLIP, CLIP_WIDTH = 1280, CLIP_HEIGHT = 720 };

typedef struct Options {
    StabilityOptions study;
    const char *clip; /* or NULL */
} Options;

static const struct argp_option option_table[] = {
    {"output", 'o', "DIR", 0,
     "Folder for stability.csv, maps.csv, refusals.csv, fallbacks.csv, rest.csv and the figures", 0},
    {"methods", METHODS, "LIST", 0,
     "Methods, separated by commas; a name alone makes as many sweeps as the scene sets (default: all that the study "
     "does not report as left out)",
     0},
    {"study", STUDY, "NAME", 0, "Only this study or map (may be repeated; default: all)", 0},
    {"scenes", SCENES, "DIR", 0,
     "Folder whose subfolder stability/ has the scenes (default: scenes, or the installed scenes)", 0},
    {"quick", QUICK, NULL, 0, "Few studies, small maps: under two minutes", 0},
    {"clip", CLIP, "CELL", 0,
     "Only make a video of a map's cell, MAP:METHOD:X,Y, beside a method that holds there; DIR must have the map", 0},
    {0}};

static error_t parse(int key, char *value, struct argp_state *state) {
    Options *all = state->input;
    StabilityOptions *options = &all->study;
    switch (key) {
    case 'o': options->folder = value; break;
    case METHODS: options->methods = value; break;
    case STUDY:
        if (options->name_count == STABILITY_MAX_NAMES) argp_error(state, "at most %d studies", STABILITY_MAX_NAMES);
        options->names[options->name_count++] = value;
        break;
    case SCENES: options->scenes = value; break;
    case QUICK: options->quick = true; break;
    case CLIP: all->clip = value; break;
    case ARGP_KEY_ARG: argp_error(state, "'%s' is not expected", value); break;
    case ARGP_KEY_END:
        if (options->folder == NULL) argp_error(state, "-o DIR is needed");
        break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

static const struct argp argp = {
    option_table,
    parse,
    "",
    "Find where each method fails. Along one parameter of a scene (height of a stack, mass ratio, time step, ...): "
    "every border between holding and failing, and how it fails there. Over two parameters: maps. A run holds if it "
    "settles, sways or creeps. Takes up to twenty minutes on two cores. An interrupted run continues where it "
    "stopped.\v"
    "Example: twinbox stability -o out/stability\n"
    "         twinbox stability --study stack_height --methods engine,momentum:k=20 -o out/height\n"
    "         twinbox stability -o out/stability --clip height_iterations:engine:15,5",
    NULL,
    NULL,
    NULL};

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
    ProgressBar bar;
    progress_bar_begin(&bar, "stability");
    bool ok = stability_run(options, &bar.progress, error);
    progress_bar_end(&bar);
    ok = ok && stability_figures_write(options->folder, error) && stability_print(options->folder, error);
    const NameList left_out = contenders_left_out(STUDY_STABILITY);
    if (ok && options->methods == NULL && left_out.text[0] != '\0')
        printf("left out unless named in --methods: %s\n", left_out.text);
    return ok;
}

int command_stability(int argc, char **argv, Error *error) {
    Options options = {.study.scenes = installed_path("scenes")};
    if (!options_parse(&argp, argc, argv, &options)) return STATUS_DIFFERENT;
    bool ok = options.clip != NULL ? make_clip(&options, error) : study(&options.study, error);
    return ok ? STATUS_SAME : STATUS_DIFFERENT;
}
