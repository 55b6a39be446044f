/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/stability.h"

#include "cli/commands.h"
#include "cli/options.h"
#include "cli/progress_bar.h"
#include "cli/stability_print.h"

#include <stdio.h>

enum { METHODS = 256, STUDY, SCENES, QUICK };

static const struct argp_option option_table[] = {
    {"output", 'o', "DIR", 0, "Where stability.csv, maps.csv, refusals.csv and fallbacks.csv go", 0},
    {"methods", METHODS, "LIST", 0,
     "Methods, separated by commas; a name alone has as many iterations as the scene says (default: the engine, "
     "momentum, substepping, nncg, the reference, pair-net, contact-net and scene-net)",
     0},
    {"study", STUDY, "NAME", 0, "One of the studies or maps (may be repeated; default: all)", 0},
    {"scenes", SCENES, "DIR", 0, "Folder in which stability/ holds the scenes (default: scenes)", 0},
    {"quick", QUICK, NULL, 0, "Few studies, small maps: under two minutes", 0},
    {0}};

static error_t parse(int key, char *value, struct argp_state *state) {
    StabilityOptions *options = state->input;
    switch (key) {
    case 'o': options->folder = value; break;
    case METHODS: options->methods = value; break;
    case STUDY:
        if (options->name_count == STABILITY_MAX_NAMES) argp_error(state, "at most %d studies", STABILITY_MAX_NAMES);
        options->names[options->name_count++] = value;
        break;
    case SCENES: options->scenes = value; break;
    case QUICK: options->quick = true; break;
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
    "Find where each method fails: along one number of a scene (height of a stack, mass ratio, time step, ...) every "
    "border between holding and failing, and how it fails there; and maps of two numbers. A run holds where it "
    "settles, "
    "sways or creeps. Takes up to twenty minutes on two cores; what is cut off goes on where it stopped.\v"
    "Example: twinbox stability -o out/stability\n"
    "         twinbox stability --study stack_height --methods engine,momentum:k=20 -o out/height",
    NULL,
    NULL,
    NULL};

int command_stability(int argc, char **argv, Error *error) {
    StabilityOptions options = {.scenes = "scenes"};
    if (!options_parse(&argp, argc, argv, &options)) return STATUS_DIFFERENT;
    ProgressBar bar;
    progress_bar_begin(&bar, "stability");
    bool ok = stability_run(&options, &bar.progress, error);
    progress_bar_end(&bar);
    return ok && stability_print(options.folder, error) ? STATUS_SAME : STATUS_DIFFERENT;
}
