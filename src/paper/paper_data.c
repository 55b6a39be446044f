/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tables of the study, and the datasets that its parts train on. */
#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
#include "base/machine.h"
#include "learning/dataset.h"
#include "learning/pair_training.h"
#include "methods/pair.h"
#include "paper/paper_internal.h"
#include "scenes/scenes.h"
#include "studies/closed_loop.h"
#include "studies/piece_tables.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A value beyond these limits is an error in the file. */
#define ERROR_MOST 1e30
#define TIME_MOST 1e12 /* us */
#define STEPS_MOST 1e9
#define SEED_MOST 1e10      /* --seed is below 2^32 */
#define SHARE_MOST 1.000001 /* and what its sum rounds to */

/* Enough for every integer that is written. */
enum { INTEGER_DIGITS = 10, VALUE_SIZE = 256 };

const char *const paper_law_words[LAW_WORDS + 1] = {
    [LAW_MOMENTUM] = "momentum", [LAW_ENERGY] = "energy", [LAW_APPROACH] = "approach", [LAW_CONE] = "cone",
    [LAW_SET_ALL] = "all",       [LAW_SET_NONE] = "none", [LAW_SET_ENGINE] = "engine"};
const char *const paper_optimizer_words[PAPER_OPTIMIZERS + 1] = {"adam", "gd", "bfgs", "lm", NULL};
static const char *const paper_phase_words[RATE_PHASES + 1] = {
    [PHASE_IMPACT] = "impact", [PHASE_AFTER] = "after", [PHASE_REST] = "rest", [RATE_ALL] = "all"};
static const char *const start_words[] = {"scratch", "transfer", NULL};

static const char *const rate_definition_names[RATE_DEFINITIONS + 1] = {"range", "absolute", "bodies"};

static const CsvColumn score_columns[] = {
    CSV_MEMBER(ScoreRow, network, CSV_NAME),
    CSV_MEMBER(ScoreRow, seed, CSV_NUMBER, .maximum = SEED_MOST, .digits = INTEGER_DIGITS),
    CSV_MEMBER(ScoreRow, target, CSV_WORD, .words = pair_target_names),
    CSV_MEMBER(ScoreRow, optimizer, CSV_WORD, .words = paper_optimizer_words),
    CSV_MEMBER(ScoreRow, iteration, CSV_NUMBER, .maximum = 1e9, .digits = INTEGER_DIGITS),
    {"test_range2", CSV_OPTIONAL, .offset = offsetof(ScoreRow, test), .maximum = ERROR_MOST},
    {"train_range2", CSV_OPTIONAL, .offset = offsetof(ScoreRow, train), .maximum = ERROR_MOST},
    {"constant_range2", CSV_OPTIONAL, .offset = offsetof(ScoreRow, constant), .maximum = ERROR_MOST},
};

static const CsvColumn trained_columns[] = {
    CSV_MEMBER(TrainedRow, network, CSV_NAME),
    CSV_MEMBER(TrainedRow, factor, CSV_NAME),
    CSV_MEMBER(TrainedRow, value, CSV_NAME, .quoted = true),
    CSV_MEMBER(TrainedRow, inputs, CSV_NAME),
    CSV_MEMBER(TrainedRow, data, CSV_NAME),
    CSV_MEMBER(TrainedRow, labels, CSV_NAME),
    CSV_MEMBER(TrainedRow, target, CSV_WORD, .words = pair_target_names),
    CSV_MEMBER(TrainedRow, layers, CSV_NAME),
    CSV_MEMBER(TrainedRow, hidden, CSV_NAME),
    CSV_MEMBER(TrainedRow, output, CSV_NAME),
    CSV_MEMBER(TrainedRow, scale, CSV_NAME),
    CSV_MEMBER(TrainedRow, optimizer, CSV_NAME),
    CSV_MEMBER(TrainedRow, loss, CSV_NAME),
    CSV_MEMBER(TrainedRow, seed, CSV_NUMBER, .maximum = SEED_MOST, .digits = INTEGER_DIGITS),
    CSV_MEMBER(TrainedRow, iterations, CSV_OPTIONAL, .maximum = 1e9, .digits = INTEGER_DIGITS),
    CSV_MEMBER(TrainedRow, parameters, CSV_OPTIONAL, .maximum = 1e9, .digits = INTEGER_DIGITS),
    {"test_range2", CSV_OPTIONAL, .offset = offsetof(TrainedRow, test), .maximum = ERROR_MOST},
    {"train_range2", CSV_OPTIONAL, .offset = offsetof(TrainedRow, train), .maximum = ERROR_MOST},
    {"constant_range2", CSV_OPTIONAL, .offset = offsetof(TrainedRow, constant), .maximum = ERROR_MOST},
    CSV_MEMBER(TrainedRow, ratio, CSV_OPTIONAL, .maximum = ERROR_MOST),
    {"ratio_single", CSV_OPTIONAL, .offset = offsetof(TrainedRow, ratio_of[0]), .maximum = ERROR_MOST},
    {"ratio_stack", CSV_OPTIONAL, .offset = offsetof(TrainedRow, ratio_of[1]), .maximum = ERROR_MOST},
    CSV_MEMBER(TrainedRow, largest, CSV_OPTIONAL, .maximum = SHARE_MOST),
    CSV_MEMBER(TrainedRow, accuracy, CSV_OPTIONAL, .maximum = 1),
};

static const CsvColumn constant_columns[] = {
    CSV_MEMBER(ConstantRow, target, CSV_WORD, .words = pair_target_names),
    CSV_MEMBER(ConstantRow, seed, CSV_NUMBER, .maximum = SEED_MOST, .digits = INTEGER_DIGITS),
    CSV_MEMBER(ConstantRow, rows, CSV_NUMBER, .maximum = STEPS_MOST, .digits = INTEGER_DIGITS),
    {"test_range2", CSV_NUMBER, .offset = offsetof(ConstantRow, test), .maximum = ERROR_MOST},
    {"train_range2", CSV_NUMBER, .offset = offsetof(ConstantRow, train), .maximum = ERROR_MOST},
    {"single_range2", CSV_NUMBER, .offset = offsetof(ConstantRow, test_of[0]), .maximum = ERROR_MOST},
    {"stack_range2", CSV_NUMBER, .offset = offsetof(ConstantRow, test_of[1]), .maximum = ERROR_MOST},
    CSV_MEMBER(ConstantRow, largest, CSV_NUMBER, .maximum = SHARE_MOST),
};

static const CsvColumn rate_columns[] = {
    CSV_MEMBER(RateRow, network, CSV_NAME),
    CSV_MEMBER(RateRow, seed, CSV_OPTIONAL, .maximum = SEED_MOST, .digits = INTEGER_DIGITS),
    CSV_MEMBER(RateRow, scene, CSV_WORD, .words = paper_scene_names),
    CSV_MEMBER(RateRow, definition, CSV_WORD, .words = rate_definition_names),
    CSV_MEMBER(RateRow, phase, CSV_WORD, .words = paper_phase_words),
    {"rate", CSV_OPTIONAL, .offset = offsetof(RateRow, share[RATE_NETWORK]), .maximum = 1},
    {"constant", CSV_OPTIONAL, .offset = offsetof(RateRow, share[RATE_CONSTANT]), .maximum = 1},
    {"engine1", CSV_OPTIONAL, .offset = offsetof(RateRow, share[RATE_ENGINE1]), .maximum = 1},
    {"engine4", CSV_OPTIONAL, .offset = offsetof(RateRow, share[RATE_ENGINE4]), .maximum = 1},
    {"engine10", CSV_OPTIONAL, .offset = offsetof(RateRow, share[RATE_ENGINE10]), .maximum = 1},
    CSV_MEMBER(RateRow, unconverged, CSV_OPTIONAL, .maximum = STEPS_MOST, .optional = true),
};

static const CsvColumn closed_loop_columns[] = {
    CSV_MEMBER(ClosedLoopRow, network, CSV_NAME),
    CSV_MEMBER(ClosedLoopRow, seed, CSV_OPTIONAL, .maximum = SEED_MOST, .digits = INTEGER_DIGITS),
    CSV_MEMBER(ClosedLoopRow, scene, CSV_WORD, .words = paper_scene_names),
    CSV_MEMBER(ClosedLoopRow, frames_until_apart, CSV_OPTIONAL, .maximum = CLOSED_LOOP_FRAMES),
    CSV_MEMBER(ClosedLoopRow, penetration_max, CSV_OPTIONAL, .maximum = ERROR_MOST),
    CSV_MEMBER(ClosedLoopRow, momentum_error, CSV_OPTIONAL, .maximum = ERROR_MOST),
    CSV_MEMBER(ClosedLoopRow, energy_ratio, CSV_OPTIONAL, .maximum = ERROR_MOST),
    CSV_MEMBER(ClosedLoopRow, unconverged, CSV_OPTIONAL, .maximum = LAUNCHED_MAX, .optional = true),
    CSV_MEMBER(ClosedLoopRow, us_step, CSV_OPTIONAL, .maximum = TIME_MOST),
    CSV_MEMBER(ClosedLoopRow, us_step_engine, CSV_OPTIONAL, .minimum = 1e-6, .maximum = TIME_MOST),
};

static const CsvColumn law_columns[] = {
    CSV_MEMBER(LawRow, laws, CSV_WORD, .words = paper_law_words),
    CSV_MEMBER(LawRow, weight, CSV_OPTIONAL, .maximum = 1e12),
    CSV_MEMBER(LawRow, seed, CSV_OPTIONAL, .maximum = SEED_MOST, .digits = INTEGER_DIGITS),
    {"test_deviation2", CSV_OPTIONAL, .offset = offsetof(LawRow, test), .maximum = ERROR_MOST},
    {"constant_deviation2", CSV_OPTIONAL, .offset = offsetof(LawRow, constant), .minimum = 1e-30,
     .maximum = ERROR_MOST},
    {"momentum", CSV_OPTIONAL, .offset = offsetof(LawRow, violation[LAW_MOMENTUM]), .maximum = ERROR_MOST},
    {"energy", CSV_OPTIONAL, .offset = offsetof(LawRow, violation[LAW_ENERGY]), .maximum = ERROR_MOST},
    {"approach", CSV_OPTIONAL, .offset = offsetof(LawRow, violation[LAW_APPROACH]), .maximum = ERROR_MOST},
    {"cone", CSV_OPTIONAL, .offset = offsetof(LawRow, violation[LAW_CONE]), .maximum = ERROR_MOST},
};

static const CsvColumn transfer_columns[] = {
    {"start", CSV_WORD, .offset = offsetof(TransferRow, transfer), .words = start_words},
    CSV_MEMBER(TransferRow, seed, CSV_NUMBER, .maximum = SEED_MOST, .digits = INTEGER_DIGITS),
    CSV_MEMBER(TransferRow, launches, CSV_NUMBER, .minimum = 1, .maximum = PAPER_MAX_LAUNCHES,
               .digits = INTEGER_DIGITS),
    {"error_m_s", CSV_OPTIONAL, .offset = offsetof(TransferRow, error), .maximum = 1e6},
    {"constant_m_s", CSV_OPTIONAL, .offset = offsetof(TransferRow, constant), .maximum = 1e6},
};

static const CsvColumn fact_columns[] = {
    CSV_MEMBER(FactRow, key, CSV_TEXT, .maximum = VALUE_SIZE),
    CSV_MEMBER(FactRow, value, CSV_TEXT, .maximum = VALUE_SIZE),
};

#define LAYOUT(name, columns, Row, most) CSV_LAYOUT(name, columns, Row, .min_rows = 1, .max_rows = most)

const CsvLayout paper_score_layout = LAYOUT("table1", score_columns, ScoreRow, PAPER_MAX_ROWS);
const CsvLayout paper_trained_layout = LAYOUT("networks", trained_columns, TrainedRow, PAPER_MAX_NETWORKS);
const CsvLayout paper_constant_layout = LAYOUT("constants", constant_columns, ConstantRow, PAPER_MAX_ROWS);
const CsvLayout paper_rate_layout = LAYOUT("rates", rate_columns, RateRow, PAPER_MAX_ROWS);
const CsvLayout paper_closed_loop_layout = LAYOUT("closed_loop", closed_loop_columns, ClosedLoopRow, PAPER_MAX_LOOPS);
const CsvLayout paper_law_layout = LAYOUT("laws", law_columns, LawRow, PAPER_MAX_ROWS);
const CsvLayout paper_transfer_layout = LAYOUT("transfer", transfer_columns, TransferRow, PAPER_MAX_ROWS);
const CsvLayout paper_fact_layout = LAYOUT("study", fact_columns, FactRow, PAPER_MAX_ROWS);

const struct PublishedScore published_scores[PUBLISHED_SCORES] = {
    {0, 0.105798, 0.106044},   {10, 0.051244, 0.051222},   {50, 0.015246, 0.015388},
    {100, 0.007767, 0.007789}, {1000, 0.001212, 0.001225}, {2000, 0.000728, 0.000730},
};

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

/* The dataset of `count` scenes from `first` on, with launches of bomb_x, if not NULL: recorded before, or now. */
static const Dataset *find_or_record(PaperDatasets *datasets, int first, int count, const char *bomb_x,
                                     DatasetOptions options, Error *error) {
    const char *scenes[PAPER_SCENES];
    /* Ranges are constants of this program and always valid. */
    if (bomb_x != NULL) parse_range(bomb_x, DATASET_MAX_LAUNCHES, &options.bomb_x);
    for (int i = 0; i < datasets->count; i++) {
        const StoredDataset *stored = &datasets->items[i];
        const DatasetOptions *of = &stored->options;
        if (stored->first == first && stored->count == count && of->view == options.view &&
            of->target == options.target && of->labels == options.labels && of->random == options.random &&
            of->every == options.every && of->context == options.context &&
            memcmp(&of->bomb_x, &options.bomb_x, sizeof of->bomb_x) == 0)
            return stored->dataset;
    }
    if (datasets->count == PAPER_DATASETS_MAX)
        return error_input(error, "study", "more than %d datasets", PAPER_DATASETS_MAX), NULL;
    StoredDataset *stored = &datasets->items[datasets->count];
    *stored = (StoredDataset){first, count, options, NULL};
    for (int i = 0; i < count; i++) scenes[i] = datasets->scenes[first + i];
    options.scenes = scenes;
    options.scene_count = count;
    options.seed = datasets->seed;
    stored->dataset = dataset_record(&options, NULL, error);
    datasets->count += stored->dataset != NULL;
    return stored->dataset;
}

/* One thread records; another that needs the same dataset waits. */
static const Dataset *record(PaperDatasets *datasets, int first, int count, const char *bomb_x, DatasetOptions options,
                             Error *error) {
    const Dataset *dataset;
#pragma omp critical(paper_record)
    dataset = find_or_record(datasets, first, count, bomb_x, options, error);
    return dataset;
}

static const Dataset *dataset_of(PaperDatasets *datasets, const PaperNetwork *network, int every, Error *error) {
    const PaperDataSize *size = datasets->size;
    DatasetOptions options = {
        .view = network->view, .target = network->target, .labels = network->labels, .every = every};
    const char *const ranges[PAPER_DATA] = {
        [DATA_SWEPT] = size->swept, [DATA_DENSE] = size->swept, [DATA_MIXED] = size->mixed};
    if (network->data == DATA_RANDOM) options.random = size->random;
    if (network->data == DATA_MIXED) options.random = size->mixed_random;
    return record(datasets, 0, PAPER_TRAINING_SCENES, ranges[network->data], options, error);
}

const Dataset *paper_dataset(PaperDatasets *datasets, const PaperNetwork *network, Error *error) {
    const PaperDataSize *size = datasets->size;
    const bool dense = network->data == DATA_DENSE, impulse = network->target == TARGET_IMPULSE;
    const int every = dense ? size->dense_every : size->every,
              impulse_every = dense ? size->impulse_dense_every : size->impulse_every;
    return dataset_of(datasets, network, impulse ? impulse_every : every, error);
}

const Dataset *paper_dataset_whole(PaperDatasets *datasets, const PaperNetwork *network, Error *error) {
    return dataset_of(datasets, network, network->target == TARGET_IMPULSE ? datasets->size->every : 1, error);
}

bool split_begin(SplitDataset *split, const Dataset *whole, uint64_t seed, Error *error) {
    *split = (SplitDataset){.test = NULL};
    if (whole == NULL) return false;
    split->test = malloc((size_t)whole->launches * sizeof *split->test);
    if (split->test == NULL) return error_memory(error, "paper");
    split->dataset = *whole;
    split->dataset.launch_test = split->test;
    if (dataset_split(whole, seed, split->test, error)) return true;
    split_free(split);
    return false;
}

void split_free(SplitDataset *split) {
    free(split->test);
    split->test = NULL;
}

bool paper_laws_write(PaperPlan *plan, const PaperPart *part, FILE *lines, const Progress *progress, Error *error) {
    const PaperDataSize *size = plan->datasets.size;
    const DatasetOptions options = {.context = true, .every = size->every}; /* with the pairs' context */
    const Dataset *whole = record(&plan->datasets, 0, PAPER_TRAINING_SCENES, size->swept, options, error);
    SplitDataset split;
    LawRow row;
    if (!split_begin(&split, whole, part->laws.seed, error)) return false;
    const bool ok = law_study_run(&split.dataset, &part->laws, &row, progress, error) &&
                    piece_tables_print(lines, &paper_law_layout, -1, &row, error);
    split_free(&split);
    return ok;
}

bool paper_transfer_write(PaperPlan *plan, const PaperPart *part, FILE *lines, const Progress *progress, Error *error) {
    const PaperDataSize *size = plan->datasets.size;
    SplitDataset splits[TRANSFER_SCENES] = {{.test = NULL}};
    const Dataset *data[TRANSFER_SCENES];
    TransferRow row;
    bool ok = true;
    for (int i = 0; ok && i < TRANSFER_SCENES; i++) {
        const Dataset *whole =
            record(&plan->datasets, i, 1, size->transfer, (DatasetOptions){.every = size->every}, error);
        ok = split_begin(&splits[i], whole, part->transfer.seed, error);
        data[i] = &splits[i].dataset;
    }
    ok = ok && transfer_study_run(data, &part->transfer, &row, progress, error) &&
         piece_tables_print(lines, &paper_transfer_layout, -1, &row, error);
    for (int i = 0; i < TRANSFER_SCENES; i++) split_free(&splits[i]);
    return ok;
}
