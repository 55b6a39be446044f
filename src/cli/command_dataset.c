/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox dataset: records contact problems with their solutions. */
#include "base/base.h"
#include "base/file.h"
#include "cli/cli.h"
#include "cli/options.h"
#include "cli/output_checks.h"
#include "cli/progress_bar.h"
#include "learning/dataset.h"
#include "methods/pair.h"
#include "scenes/scenes.h"

#include <inttypes.h>

typedef struct Options {
    DatasetOptions dataset;
    const char *scenes[DATASET_MAX_SCENES];
    const char *output;
} Options;

static const char *view_names[PAIR_VIEWS + 1]; /* of pair_views, in the order of PairView */

static const Option option_table[] = {
    {"--output", 'o', "DATA.npz", "Dataset to write", OPTION_BINARY(Options, output),
     .needed = "-o DATA.npz is needed"},
    {"--bomb-x", 0, "A:B:STEP",
     "Launches of each scene: x from A to B in steps of STEP, m (default: 201 of the scene's family; none with only "
     "--random)",
     OPTION_RANGE(Options, dataset.bomb_x)},
    {"--launches", 0, "FILE.csv", "Launches of each scene instead: a table with any of the columns x,rotation,spin",
     OPTION_PATH(Options, dataset.table_path)},
    {"--random", 0, "N",
     "Further, random launches of each scene: x within +-15 m, rotation +-1.5 rad, spin +-20 rad/s (default: 0)",
     OPTION_INT(Options, dataset.random, 1, DATASET_MAX_LAUNCHES)},
    {"--inputs", 0, "NAME",
     "Inputs of a pair: relative (default); raw; raw-unturned, without rotations; contact, in the frame of its contact "
     "after the warm start; neighbours, the same and the next impulses of neighbouring contacts",
     OPTION_ENUM(Options, dataset.view, view_names)},
    {"--target", 0, "NAME",
     "What to record: pair (default), velocity changes by the pair's own impulses in the step; net, by all impulses on "
     "its bodies; impulse, by one visit of the pair in one sweep; points (with contact or neighbours), impulses at its "
     "points beyond the warm start",
     OPTION_ENUM(Options, dataset.target, pair_target_names)},
    {"--labels", 0, "NAME",
     "Solver that is recorded: engine (default) or the converged reference, without the steps in which it does not "
     "converge",
     OPTION_ENUM(Options, dataset.labels, dataset_label_names)},
    {"--context", 0, NULL, "Also record masses, normals, friction and lever arms, which train --laws needs",
     OPTION_FLAG(Options, dataset.context)},
    {"--seed", 0, "N",
     "Seed of the launches of --random and of the fifth of all launches that is held out (default: 1)",
     OPTION_SEED(Options, dataset.seed)},
    {0}};

static const CommandSpec spec = {
    .options = option_table,
    .input = {.value = "SCENE...",
              .needed = "a scene file is needed",
              OPTION_PATHS(Options, scenes, dataset.scene_count)},
    .inputs = {1, DATASET_MAX_SCENES, "scene"},
    .help =
        "Record a dataset to train on: for every touching pair in every step of every launch, positions, rotations and "
        "velocities before the solve, and what the solve changed.\v"
        "Example: twinbox dataset single stack -o pairs.npz\n"
        "         twinbox dataset single -o impulses.npz --inputs raw --target impulse"};

static bool record_dataset(const Options *options, Error *error) {
    Dataset *dataset = dataset_record(&options->dataset, progress_bar_begin("recording launches"), error);
    progress_bar_end();
    const bool ok = dataset != NULL && dataset_write(dataset, options->output, error);
    if (ok)
        printf("%" PRId64 " rows of %d launch%s -> %s\n", dataset->rows, dataset->launches,
               plural_es(dataset->launches), options->output);
    if (ok && options->dataset.labels == DATASET_BY_REFERENCE)
        printf("    steps left out, as the reference does not converge: %" PRId64 "\n", dataset->unconverged);
    dataset_destroy(dataset);
    return ok;
}

bool command_dataset(int argc, char **argv, Error *error) {
    Options options = {.dataset.seed = 1};
    for (int v = 0; v < PAIR_VIEWS; v++) view_names[v] = pair_views[v].name;
    if (!options_parse(&spec, argc, argv, &options, error)) return false;
    if (!output_check_npz(options.output, "dataset", error)) return false;
    options.dataset.scenes = options.scenes;
    if (options.dataset.table_path == NULL) return record_dataset(&options, error);
    if (options.dataset.bomb_x.count + options.dataset.random > 0)
        return error_input(error, "--launches", "cannot be combined with --bomb-x or --random");
    LaunchTable table;
    if (!launches_read(&table, options.dataset.table_path, error)) return false;
    options.dataset.table = &table;
    const bool ok = record_dataset(&options, error);
    launches_free(&table);
    return ok;
}
