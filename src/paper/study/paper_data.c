/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/study/paper_data.h"

#include "common/file.h"

#include <stdio.h>

const char *const paper_scene_names[PAPER_SCENES + 1] = {"single", "stack", "pyramid", "pyramid_settled"};

bool paper_datasets_begin(PaperDatasets *datasets, const char *scenes, const PaperDataSize *size, uint64_t seed,
                          Error *error) {
    datasets->size = size;
    datasets->seed = seed;
    for (int i = 0; i < PAPER_SCENES; i++)
        if (!file_path(datasets->scenes[i], PAPER_PATH_SIZE, error, "%s/%s.yaml", scenes, paper_scene_names[i]))
            return false;
    return true;
}

void paper_datasets_free(PaperDatasets *datasets) {
    for (int i = 0; i < datasets->count; i++) dataset_destroy(datasets->items[i].dataset);
    datasets->count = 0;
}

/* Ranges are constants of this program and always valid. */
static FloatRange range_of(const char *text) {
    FloatRange range = {0};
    parse_range(text, DATASET_MAX_LAUNCHES, &range);
    return range;
}

static Dataset *record(const PaperDatasets *datasets, const PaperNetwork *network, Error *error) {
    const PaperDataSize *size = datasets->size;
    const char *const scenes[PAPER_TRAINING_SCENES] = {datasets->scenes[0], datasets->scenes[1]};
    DatasetOptions options = {.scenes = scenes,
                              .scene_count = PAPER_TRAINING_SCENES,
                              .view = network->view,
                              .target = network->target,
                              .labels = network->labels,
                              .seed = datasets->seed};
    switch (network->data) {
    case DATA_RANDOM: options.random = size->random; break;
    case DATA_MIXED:
        options.bomb_x = range_of(size->mixed);
        options.random = size->mixed_random;
        break;
    case DATA_FINE: options.bomb_x = range_of(size->fine); break;
    case DATA_FINEST: options.bomb_x = range_of(size->finest); break;
    case DATA_PAPER: options.bomb_x = range_of(size->paper); break;
    default: options.bomb_x = range_of(size->swept); break;
    }
    if (network->target == TARGET_IMPULSE)
        options.every = network->data == DATA_FINEST ? size->finest_every : size->impulse_every;
    return dataset_record(&options, NULL, error);
}

Dataset *paper_scene_dataset(const PaperDatasets *datasets, int scene, const char *bomb_x, Error *error) {
    const char *const scenes[1] = {datasets->scenes[scene]};
    const DatasetOptions options = {
        .scenes = scenes, .scene_count = 1, .bomb_x = range_of(bomb_x), .seed = datasets->seed};
    return dataset_record(&options, NULL, error);
}

Dataset *paper_context_dataset(const PaperDatasets *datasets, Error *error) {
    const char *const scenes[PAPER_TRAINING_SCENES] = {datasets->scenes[0], datasets->scenes[1]};
    const DatasetOptions options = {.scenes = scenes,
                                    .scene_count = PAPER_TRAINING_SCENES,
                                    .bomb_x = range_of(datasets->size->swept),
                                    .context = true,
                                    .seed = datasets->seed};
    return dataset_record(&options, NULL, error);
}

const Dataset *paper_dataset(PaperDatasets *datasets, const PaperNetwork *network, Error *error) {
    for (int i = 0; i < datasets->count; i++) {
        const StoredDataset *stored = &datasets->items[i];
        if (stored->data == network->data && stored->labels == network->labels && stored->view == network->view &&
            stored->target == network->target)
            return stored->dataset;
    }
    if (datasets->count == PAPER_DATASETS_MAX) {
        error_input(error, "study", "more than %d datasets", PAPER_DATASETS_MAX);
        return NULL;
    }
    Dataset *dataset = record(datasets, network, error);
    if (dataset == NULL) return NULL;
    datasets->items[datasets->count++] =
        (StoredDataset){network->data, network->labels, network->view, network->target, dataset};
    return dataset;
}
