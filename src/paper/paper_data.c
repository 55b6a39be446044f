/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
#include "base/machine.h"
#include "learning/dataset.h"
#include "learning/pair_training.h"
#include "methods/pair.h"
#include "paper/paper.h"
#include "paper/paper_internal.h"
#include "scenes/scenes.h"
#include "studies/chart.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* A value beyond these limits is an error in the file. */
#define ERROR_MOST 1e30
#define TIME_MOST 1e12 /* us */
#define SEED_MOST 1e10 /* --seed is below 2^32 */

/* Enough for every integer that is written. */
enum { INTEGER_DIGITS = 10, VALUE_SIZE = 256 };

const char *const paper_law_words[LAW_WORDS + 1] = {
    [LAW_MOMENTUM] = "momentum", [LAW_ENERGY] = "energy", [LAW_APPROACH] = "approach", [LAW_CONE] = "cone",
    [LAW_SET_ALL] = "all",       [LAW_SET_NONE] = "none", [LAW_SET_ENGINE] = "engine"};
const char *const paper_optimizer_words[PAPER_OPTIMIZERS + 1] = {"adam", "gd", "bfgs", "lm", NULL};
const char *const paper_phase_words[RATE_PHASES + 1] = {
    [PHASE_IMPACT] = "impact", [PHASE_AFTER] = "after", [PHASE_REST] = "rest", [RATE_ALL] = "all"};
static const char *const start_words[] = {"scratch", "transfer", NULL};

static const CsvColumn score_columns[] = {
    {"network", CSV_NAME, .offset = offsetof(ScoreRow, network)},
    {"target", CSV_WORD, .offset = offsetof(ScoreRow, target), .words = pair_target_names},
    {"optimizer", CSV_WORD, .offset = offsetof(ScoreRow, optimizer), .words = paper_optimizer_words},
    {"iteration", CSV_NUMBER, .offset = offsetof(ScoreRow, iteration), .maximum = 1e9, .digits = INTEGER_DIGITS},
    {"test", CSV_OPTIONAL, .offset = offsetof(ScoreRow, test), .maximum = ERROR_MOST},
    {"train", CSV_OPTIONAL, .offset = offsetof(ScoreRow, train), .maximum = ERROR_MOST},
    {"constant", CSV_OPTIONAL, .offset = offsetof(ScoreRow, constant), .maximum = ERROR_MOST},
};

static const CsvColumn trained_columns[] = {
    {"network", CSV_NAME, .offset = offsetof(TrainedRow, network)},
    {"factor", CSV_NAME, .offset = offsetof(TrainedRow, factor)},
    {"value", CSV_NAME, .offset = offsetof(TrainedRow, value), .quoted = true},
    {"inputs", CSV_NAME, .offset = offsetof(TrainedRow, inputs)},
    {"data", CSV_NAME, .offset = offsetof(TrainedRow, data)},
    {"labels", CSV_NAME, .offset = offsetof(TrainedRow, labels)},
    {"target", CSV_WORD, .offset = offsetof(TrainedRow, target), .words = pair_target_names},
    {"layers", CSV_NAME, .offset = offsetof(TrainedRow, layers)},
    {"hidden", CSV_NAME, .offset = offsetof(TrainedRow, hidden)},
    {"output", CSV_NAME, .offset = offsetof(TrainedRow, output)},
    {"scale", CSV_NAME, .offset = offsetof(TrainedRow, scale)},
    {"optimizer", CSV_NAME, .offset = offsetof(TrainedRow, optimizer)},
    {"loss", CSV_NAME, .offset = offsetof(TrainedRow, loss)},
    {"iterations", CSV_OPTIONAL, .offset = offsetof(TrainedRow, iterations), .maximum = 1e9, .digits = INTEGER_DIGITS},
    {"parameters", CSV_OPTIONAL, .offset = offsetof(TrainedRow, parameters), .maximum = 1e9, .digits = INTEGER_DIGITS},
    {"test", CSV_OPTIONAL, .offset = offsetof(TrainedRow, test), .maximum = ERROR_MOST},
    {"train", CSV_OPTIONAL, .offset = offsetof(TrainedRow, train), .maximum = ERROR_MOST},
    {"constant", CSV_OPTIONAL, .offset = offsetof(TrainedRow, constant), .maximum = ERROR_MOST},
    {"ratio", CSV_OPTIONAL, .offset = offsetof(TrainedRow, ratio), .maximum = ERROR_MOST},
    {"accuracy", CSV_OPTIONAL, .offset = offsetof(TrainedRow, accuracy), .maximum = 1},
};

static const CsvColumn rate_columns[] = {
    {"network", CSV_NAME, .offset = offsetof(RateRow, network)},
    {"scene", CSV_WORD, .offset = offsetof(RateRow, scene), .words = paper_scene_names},
    {"definition", CSV_WORD, .offset = offsetof(RateRow, definition), .words = rate_definition_names},
    {"phase", CSV_WORD, .offset = offsetof(RateRow, phase), .words = paper_phase_words},
    {"rate", CSV_OPTIONAL, .offset = offsetof(RateRow, share[RATE_NETWORK]), .maximum = 1},
    {"constant", CSV_OPTIONAL, .offset = offsetof(RateRow, share[RATE_CONSTANT]), .maximum = 1},
    {"engine1", CSV_OPTIONAL, .offset = offsetof(RateRow, share[RATE_ENGINE1]), .maximum = 1},
    {"engine4", CSV_OPTIONAL, .offset = offsetof(RateRow, share[RATE_ENGINE4]), .maximum = 1},
    {"engine10", CSV_OPTIONAL, .offset = offsetof(RateRow, share[RATE_ENGINE10]), .maximum = 1},
};

static const CsvColumn closed_loop_columns[] = {
    {"network", CSV_NAME, .offset = offsetof(ClosedLoopRow, network)},
    {"scene", CSV_WORD, .offset = offsetof(ClosedLoopRow, scene), .words = paper_scene_names},
    {"frames_until_apart", CSV_NUMBER, .offset = offsetof(ClosedLoopRow, frames_until_apart),
     .maximum = CLOSED_LOOP_FRAMES},
    {"penetration_max", CSV_OPTIONAL, .offset = offsetof(ClosedLoopRow, penetration_max), .maximum = ERROR_MOST},
    {"momentum_error", CSV_OPTIONAL, .offset = offsetof(ClosedLoopRow, momentum_error), .maximum = ERROR_MOST},
    {"energy_ratio", CSV_OPTIONAL, .offset = offsetof(ClosedLoopRow, energy_ratio), .maximum = ERROR_MOST},
    {"us_step", CSV_OPTIONAL, .offset = offsetof(ClosedLoopRow, us_step), .maximum = TIME_MOST},
    {"us_step_engine", CSV_OPTIONAL, .offset = offsetof(ClosedLoopRow, us_step_engine), .minimum = 1e-6,
     .maximum = TIME_MOST},
};

static const CsvColumn law_columns[] = {
    {"laws", CSV_WORD, .offset = offsetof(LawRow, laws), .words = paper_law_words},
    {"weight", CSV_OPTIONAL, .offset = offsetof(LawRow, weight), .maximum = 1e12},
    {"seed", CSV_OPTIONAL, .offset = offsetof(LawRow, seed), .maximum = SEED_MOST, .digits = INTEGER_DIGITS},
    {"test", CSV_OPTIONAL, .offset = offsetof(LawRow, test), .maximum = ERROR_MOST},
    {"constant", CSV_OPTIONAL, .offset = offsetof(LawRow, constant), .minimum = 1e-30, .maximum = ERROR_MOST},
    {"momentum", CSV_OPTIONAL, .offset = offsetof(LawRow, violation[LAW_MOMENTUM]), .maximum = ERROR_MOST},
    {"energy", CSV_OPTIONAL, .offset = offsetof(LawRow, violation[LAW_ENERGY]), .maximum = ERROR_MOST},
    {"approach", CSV_OPTIONAL, .offset = offsetof(LawRow, violation[LAW_APPROACH]), .maximum = ERROR_MOST},
    {"cone", CSV_OPTIONAL, .offset = offsetof(LawRow, violation[LAW_CONE]), .maximum = ERROR_MOST},
};

static const CsvColumn transfer_columns[] = {
    {"start", CSV_WORD, .offset = offsetof(TransferRow, transfer), .words = start_words},
    {"seed", CSV_NUMBER, .offset = offsetof(TransferRow, seed), .maximum = SEED_MOST, .digits = INTEGER_DIGITS},
    {"launches", CSV_NUMBER, .offset = offsetof(TransferRow, launches), .minimum = 1, .maximum = PAPER_MAX_LAUNCHES,
     .digits = INTEGER_DIGITS},
    {"error", CSV_OPTIONAL, .offset = offsetof(TransferRow, error), .maximum = 1e6},
    {"constant", CSV_OPTIONAL, .offset = offsetof(TransferRow, constant), .maximum = 1e6},
};

static const CsvColumn fact_columns[] = {
    {"key", CSV_TEXT, .offset = offsetof(FactRow, key), .maximum = VALUE_SIZE},
    {"value", CSV_TEXT, .offset = offsetof(FactRow, value), .maximum = VALUE_SIZE},
};

#define LAYOUT(name, columns, Row, most) CSV_LAYOUT(name, columns, Row, .min_rows = 1, .max_rows = most)

const CsvLayout paper_score_layout = LAYOUT("table1", score_columns, ScoreRow, PAPER_MAX_ROWS);
const CsvLayout paper_trained_layout = LAYOUT("networks", trained_columns, TrainedRow, PAPER_MAX_NETWORKS);
const CsvLayout paper_rate_layout = LAYOUT("rates", rate_columns, RateRow, PAPER_MAX_ROWS);
const CsvLayout paper_closed_loop_layout = LAYOUT("closed_loop", closed_loop_columns, ClosedLoopRow, PAPER_MAX_LOOPS);
const CsvLayout paper_law_layout = LAYOUT("laws", law_columns, LawRow, PAPER_MAX_ROWS);
const CsvLayout paper_transfer_layout = LAYOUT("transfer", transfer_columns, TransferRow, PAPER_MAX_ROWS);
const CsvLayout paper_fact_layout = LAYOUT("study", fact_columns, FactRow, PAPER_MAX_ROWS);

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

/* Launches of one scene, with the target pair. The caller destroys it. */
static Dataset *paper_scene_dataset(const PaperDatasets *datasets, int scene, const char *bomb_x, Error *error) {
    const char *const scenes[1] = {datasets->scenes[scene]};
    const DatasetOptions options = {
        .scenes = scenes, .scene_count = 1, .bomb_x = range_of(bomb_x), .seed = datasets->seed};
    return dataset_record(&options, NULL, error);
}

/* The same for the sweep of both training scenes, with the pairs' context (dataset.h). */
static Dataset *paper_context_dataset(const PaperDatasets *datasets, Error *error) {
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

void paper_outlook_free(PaperOutlook *outlook) {
    dataset_destroy(outlook->laws);
    for (int i = 0; i < 3; i++) dataset_destroy(outlook->scenes[i]);
}

bool paper_laws_write(void *context, FILE *lines, const Progress *progress, Error *error) {
    PaperLaws *part = context;
    PaperOutlook *outlook = part->outlook;
    if (outlook->laws == NULL) outlook->laws = paper_context_dataset(outlook->datasets, error);
    if (outlook->laws == NULL) return false;
    LawResult result;
    const LawStudy *study = &part->study;
    const bool labels = study->laws == NULL;
    if (!(labels ? law_study_labels(outlook->laws, &result, error)
                 : law_study_train(outlook->laws, study, &result, progress, error)))
        return false;
    LawRow row = {.laws = labels ? LAW_SET_ENGINE : csv_word(paper_law_words, study->laws),
                  .weight = labels ? NAN : study->weight,
                  .seed = labels ? NAN : (double)study->seed,
                  .test = result.test,
                  .constant = result.constant};
    memcpy(row.violation, result.violations.of, sizeof row.violation);
    return piece_tables_print(lines, &paper_law_layout, -1, &row, error);
}

bool paper_transfer_write(void *context, FILE *lines, const Progress *progress, Error *error) {
    PaperTransfer *part = context;
    PaperOutlook *outlook = part->outlook;
    for (int i = 0; i < 3; i++) {
        if (outlook->scenes[i] == NULL)
            outlook->scenes[i] = paper_scene_dataset(outlook->datasets, i, outlook->bomb_x[i], error);
        if (outlook->scenes[i] == NULL) return false;
    }
    const TransferData data = {outlook->scenes[0], outlook->scenes[1], outlook->scenes[2]};
    const TransferStudy *study = &part->study;
    TransferResult result;
    if (!transfer_study_run(&data, study, &result, progress, error)) return false;
    const TransferRow row = {study->transfer, (double)study->seed, study->launches, result.error, result.constant};
    return piece_tables_print(lines, &paper_transfer_layout, -1, &row, error);
}
