/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/commands.h"
#include "cli/installed.h"
#include "cli/options.h"
#include "cli/progress_bar.h"
#include "common/names.h"
#include "dataset/dataset.h"

#include <stdio.h>
#include <string.h>

enum { BOMB_X = 256, RANDOM, INPUTS, TARGET, LABELS, CONTEXT, SEED };

static const struct argp_option option_table[] = {
    {"output", 'o', "DATA.npz", 0, "Dataset to write", 0},
    {"bomb-x", BOMB_X, "A:B:STEP", 0,
     "Launches of each scene: x from A to B in steps of STEP, m (default: -5:5:0.05, as in the paper; none with only "
     "--random)",
     0},
    {"random", RANDOM, "N", 0,
     "Further, random launches of each scene: x within +-15 m, rotation +-1.5 rad, spin +-20 rad/s (default: 0)", 0},
    {"inputs", INPUTS, "NAME", 0,
     "Inputs of a pair: relative (default); raw; raw-unturned, without rotations; contact, in the frame of its contact "
     "after the warm start; neighbours, the same and the next impulses of neighbouring contacts",
     0},
    {"target", TARGET, "NAME", 0,
     "What to record: pair (default), velocity changes by the pair's own impulses in the step; net, by all impulses on "
     "its bodies; impulse, by one visit of the pair in one sweep; points (with contact or neighbours), impulses at its "
     "points beyond the warm start",
     0},
    {"labels", LABELS, "NAME", 0, "Solver that is recorded: engine (default) or the converged reference", 0},
    {"context", CONTEXT, NULL, 0, "Also record masses, normals, friction and lever arms, which train --laws needs", 0},
    {"seed", SEED, "N", 0,
     "Seed of the launches of --random and of the fifth of all launches that is held out (default: 1)", 0},
    {0}};

typedef struct Options {
    DatasetOptions dataset;
    const char *scenes[DATASET_MAX_SCENES];
    const char *output, *bomb_x, *random, *inputs, *target, *labels, *seed;
} Options;

static error_t parse(int key, char *value, struct argp_state *state) {
    Options *options = state->input;
    switch (key) {
    case 'o': options->output = value; break;
    case BOMB_X: options->bomb_x = value; break;
    case RANDOM: options->random = value; break;
    case INPUTS: options->inputs = value; break;
    case TARGET: options->target = value; break;
    case LABELS: options->labels = value; break;
    case CONTEXT: options->dataset.context = true; break;
    case SEED: options->seed = value; break;
    case ARGP_KEY_ARG:
        if (options->dataset.scene_count == DATASET_MAX_SCENES)
            argp_error(state, "at most %d scenes", DATASET_MAX_SCENES);
        options->scenes[options->dataset.scene_count++] = installed_path(value);
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
    "Record a dataset to train on: for every touching pair in every step of every launch, positions, rotations and "
    "velocities before the solve, and what the solve changed.\v"
    "Example: twinbox dataset scenes/single.yaml scenes/stack.yaml -o pairs.npz\n"
    "         twinbox dataset scenes/single.yaml -o impulses.npz --random 200 --inputs raw --target impulse",
    NULL,
    NULL,
    NULL};

/* The place of a word in a list; the message names them all. */
static bool find_word(const char *option, const char *word, const char *const *words, int count, int *place,
                      Error *error) {
    NameList known = {0};
    for (*place = 0; *place < count; ++*place) {
        if (strcmp(words[*place], word) == 0) return true;
        name_list_add(&known, words[*place]);
    }
    return error_unknown(error, option, word, "a valid value", &known);
}

static bool choose(Options *options, Error *error) {
    DatasetOptions *dataset = &options->dataset;
    const char *views[PAIR_VIEWS];
    int view = 0, target = 0, labels = 0;
    for (int v = 0; v < PAIR_VIEWS; v++) views[v] = pair_views[v].name;
    if (options->bomb_x == NULL && options->random == NULL) options->bomb_x = "-5:5:0.05";
    bool ok = (options->bomb_x == NULL || option_range("--bomb-x", options->bomb_x, &dataset->bomb_x, error)) &&
              (options->random == NULL ||
               option_int("--random", options->random, 1, DATASET_MAX_LAUNCHES, &dataset->random, error)) &&
              find_word("--inputs", options->inputs, views, PAIR_VIEWS, &view, error) &&
              find_word("--target", options->target, pair_target_names, PAIR_TARGETS, &target, error) &&
              find_word("--labels", options->labels, dataset_label_names, DATASET_LABELS, &labels, error) &&
              option_seed("--seed", options->seed, &dataset->seed, error);
    dataset->view = (PairView)view;
    dataset->target = (PairTarget)target;
    dataset->labels = (DatasetLabels)labels;
    return ok;
}

int command_dataset(int argc, char **argv, Error *error) {
    Options options = {.inputs = "relative", .target = "pair", .labels = "engine", .seed = "1"};
    if (!options_parse(&argp, argc, argv, &options)) return STATUS_DIFFERENT;
    options.dataset.scenes = options.scenes;
    if (!choose(&options, error)) return STATUS_DIFFERENT;
    ProgressBar bar;
    progress_bar_begin(&bar, "recording launches");
    Dataset *dataset = dataset_record(&options.dataset, &bar.progress, error);
    progress_bar_end(&bar);
    bool ok = dataset != NULL && dataset_write(dataset, options.output, error);
    if (ok) printf("%lld rows of %d launches -> %s\n", (long long)dataset->rows, dataset->launches, options.output);
    dataset_destroy(dataset);
    return ok ? STATUS_SAME : STATUS_DIFFERENT;
}
