/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/study/transfer_study.h"

#include "dataset/dataset_subset.h"
#include "paper/study/whole_training.h"

#include <math.h>
#include <stdlib.h>

enum { COMPONENTS = 2 };

/* Change of the velocity of b relative to a: the label of the two outputs. */
static double label(const Dataset *dataset, int64_t row, int k) {
    const float *changes = dataset->changes + row * PAIR_CHANGES;
    return (double)(changes[k + 3] - changes[k]);
}

static void mean_label(const Dataset *dataset, double mean[COMPONENTS]) {
    int64_t count = 0;
    mean[0] = mean[1] = 0;
    for (int64_t row = 0; row < dataset->rows; row++) {
        if (dataset_is_test(dataset, row)) continue;
        for (int k = 0; k < COMPONENTS; k++) mean[k] += label(dataset, row, k);
        count++;
    }
    for (int k = 0; k < COMPONENTS; k++) mean[k] /= (double)count;
}

static bool score(const Dataset *dataset, const Network *network, TransferResult *result, Error *error) {
    float *scratch = malloc(2 * (size_t)network_scratch_width(network) * sizeof *scratch), output[COMPONENTS];
    if (scratch == NULL) return error_memory(error, "study");
    double mean[COMPONENTS], squares = 0, squares_constant = 0;
    int64_t count = 0;
    mean_label(dataset, mean);
    for (int64_t row = 0; row < dataset->rows; row++) {
        if (!dataset_is_test(dataset, row)) continue;
        network_predict(network, dataset->inputs + row * dataset_inputs(dataset), scratch, output);
        for (int k = 0; k < COMPONENTS; k++) {
            const double right = label(dataset, row, k), e = (double)output[k] - right, c = mean[k] - right;
            squares += e * e;
            squares_constant += c * c;
            count++;
        }
    }
    free(scratch);
    *result = (TransferResult){sqrt(squares / (double)count), sqrt(squares_constant / (double)count)};
    return true;
}

/* Trains on `count` datasets one after the other, each network starting from the one before. */
static Network *train_stages(const Dataset *const *datasets, int count, const TransferStudy *study,
                             const Progress *progress, Error *error) {
    Network *network = NULL;
    for (int stage = 0; stage < count; stage++) {
        const TrainingOptions options = {.layers = 2,
                                         .widths = {dataset_inputs(datasets[stage]), 10, COMPONENTS},
                                         .optimizer = "adam",
                                         .output_activation = "linear",
                                         .iterations = study->iterations,
                                         .seed = study->seed,
                                         .start = network};
        Network *next = whole_training(datasets[stage], &options, progress, error);
        network_destroy(network);
        network = next;
        if (network == NULL) break;
    }
    return network;
}

bool transfer_study_run(const TransferData *data, const TransferStudy *study, TransferResult *result,
                        const Progress *progress, Error *error) {
    Dataset *drawn = dataset_draw_subset(data->pyramid, study->launches, study->seed, error);
    if (drawn == NULL) return false;
    const Dataset *const stages[] = {data->single, data->stack, drawn};
    const int first = study->transfer ? 0 : 2;
    Network *network = train_stages(stages + first, 3 - first, study, progress, error);
    const bool ok = network != NULL && score(drawn, network, result, error);
    network_destroy(network);
    dataset_destroy(drawn);
    return ok;
}
