/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "training/checks.h"

#include "training/network_config.h"

#include <string.h>

static bool check_shape(const Dataset *dataset, const TrainingOptions *options, Error *error) {
    if (options->layers < 1 || options->layers > NETWORK_MAX_LAYERS)
        return error_input(error, "layers", "must be 1 to %d weight layers (got %d)", NETWORK_MAX_LAYERS,
                           options->layers);
    int first = options->widths[0], last = options->widths[options->layers];
    if (first != dataset_inputs(dataset))
        return error_input(error, "layers", "the first width must be %d, the inputs of a pair (got %d)",
                           dataset_inputs(dataset), first);
    if (pair_output_names(dataset->view, dataset->target, last) == NULL)
        return error_input(
            error, "layers", "for the target %s the last width must be %s (got %d)", pair_target_names[dataset->target],
            dataset->target == TARGET_POINTS ? "4 (both points)" : "2 (relative velocity) or 6 (both bodies)", last);
    if (options->iterations < 0)
        return error_input(error, "iterations", "must be 0 or more (got %d)", options->iterations);
    return true;
}

static bool check_rows(const Dataset *dataset, Error *error) {
    int64_t test_rows = 0;
    for (int64_t row = 0; row < dataset->rows; row++) test_rows += dataset_is_test(dataset, row);
    if (test_rows > 0 && test_rows < dataset->rows) return true;
    return error_input(error, "dataset", "needs at least one training row and one test row (got %lld and %lld)",
                       (long long)(dataset->rows - test_rows), (long long)test_rows);
}

static bool check_start(const Dataset *dataset, const TrainingOptions *options, Error *error) {
    const Network *start = options->start;
    if (start == NULL) return true;
    if (strcmp(start->inputs, pair_views[dataset->view].inputs) != 0)
        return error_input(error, "dataset", "the start network was trained on other inputs (%.80s)", start->inputs);
    if (strcmp(start->target, pair_target_names[dataset->target]) != 0)
        return error_input(error, "dataset", "the start network was trained for another target (%.80s)", start->target);
    bool fits = start->layers == options->layers;
    for (int l = 0; fits && l <= options->layers; l++) fits = start->widths[l] == options->widths[l];
    if (!fits) return error_input(error, "layers", "the start network has other widths");
    return network_config_matches(start, options, error);
}

bool training_check(const Dataset *dataset, const TrainingOptions *options, Error *error) {
    return check_shape(dataset, options, error) && check_rows(dataset, error) &&
           (!law_weights_any(&options->laws) ||
            laws_check(dataset, options->widths[options->layers], &options->laws, error)) &&
           check_start(dataset, options, error);
}
