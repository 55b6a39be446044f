/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/commands.h"
#include "cli/options.h"
#include "cli/progress_bar.h"
#include "dataset/dataset.h"

#include <stdio.h>

enum { BOMB_X = 256, SEED };

static const struct argp_option option_table[] = {
    {"output", 'o', "DATA.npz", 0, "Where the dataset goes", 0},
    {"bomb-x", BOMB_X, "A:B:STEP", 0, "Launches of each scene, m (default: -5:5:0.05, the paper's)", 0},
    {"seed", SEED, "N", 0, "Draws the fifth of the launches that is held out for testing (default: 1)", 0},
    {0}};

typedef struct Options {
    DatasetOptions dataset;
    const char *scenes[DATASET_MAX_SCENES];
    const char *output, *bomb_x, *seed;
} Options;

static error_t parse(int key, char *value, struct argp_state *state) {
    Options *options = state->input;
    switch (key) {
    case 'o': options->output = value; break;
    case BOMB_X: options->bomb_x = value; break;
    case SEED: options->seed = value; break;
    case ARGP_KEY_ARG:
        if (options->dataset.scene_count == DATASET_MAX_SCENES)
            argp_error(state, "at most %d scenes", DATASET_MAX_SCENES);
        options->scenes[options->dataset.scene_count++] = value;
        break;
    case ARGP_KEY_END:
        if (options->dataset.scene_count == 0) argp_error(state, "a scene file is needed");
        if (options->output == NULL) argp_error(state, "-o DATA.npz is needed");
        break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

static const struct argp argp = {
    option_table,
    parse,
    "SCENE...",
    "Record, for every touching pair in every step of every launch, relative position, velocities, angular "
    "velocities and rotations before the solve, and the change that the pair's impulses made.\v"
    "Example: twinbox dataset scenes/single.yaml scenes/stack.yaml -o pairs.npz",
    NULL,
    NULL,
    NULL};

int command_dataset(int argc, char **argv, Error *error) {
    Options options = {.bomb_x = "-5:5:0.05", .seed = "1"};
    if (!options_parse(&argp, argc, argv, &options)) return STATUS_DIFFERENT;
    options.dataset.scenes = options.scenes;
    if (!option_range("--bomb-x", options.bomb_x, &options.dataset.bomb_x, error) ||
        !option_seed("--seed", options.seed, &options.dataset.seed, error))
        return STATUS_DIFFERENT;
    ProgressBar bar;
    progress_bar_begin(&bar, "recording launches");
    Dataset *dataset = dataset_record(&options.dataset, &bar.progress, error);
    progress_bar_end(&bar);
    bool ok = dataset != NULL && dataset_write(dataset, options.output, error);
    if (ok) printf("%lld pairs of %d launches -> %s\n", (long long)dataset->rows, dataset->launches, options.output);
    dataset_destroy(dataset);
    return ok ? STATUS_SAME : STATUS_DIFFERENT;
}
