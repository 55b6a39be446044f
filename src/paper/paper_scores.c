/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Transfer, laws in the loss, and the scores of the study's networks in a scene. */
#include "base/base.h"
#include "base/file.h"
#include "base/machine.h"
#include "learning/dataset.h"
#include "learning/pair_training.h"
#include "methods/methods.h"
#include "methods/pair.h"
#include "nets/nets.h"
#include "paper/paper.h"
#include "paper/paper_internal.h"
#include "studies/chart.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

bool law_study_train(const Dataset *dataset, const LawStudy *study, LawResult *result, const Progress *progress,
                     Error *error) {
    TrainingOptions options = {.layers = 3,
                               .widths = {dataset_inputs(dataset), 8, 8, PAIR_CHANGES},
                               .optimizer = "adam",
                               .iterations = study->iterations,
                               .seed = study->seed};
    if (!law_weights_named(study->laws, study->weight, &options.laws, error)) return false;
    Network *network = whole_training(dataset, &options, progress, error);
    TrainingScore score;
    bool ok = network != NULL && training_score(dataset, network, NULL, &score, error) &&
              laws_measure(dataset, network, &result->violations, error);
    if (ok) result->test = score.test, result->constant = score.constant_test;
    network_destroy(network);
    return ok;
}

bool law_study_labels(const Dataset *dataset, LawResult *result, Error *error) {
    result->test = result->constant = NAN;
    return laws_measure(dataset, NULL, &result->violations, error);
}

/* One scene's study in progress. */
typedef struct Scores {
    const PaperScoring *scoring;
    Launched launched;
    PairRates *rates;   /* [count + 1]; the last is the warm start's */
    ClosedLoop *closed; /* [count] */
} Scores;

/* A network of single impulses with inputs by contact would need impulses at points: it cannot take a step. */
static bool takes_steps(const PaperNetwork *network) {
    return network->target != TARGET_IMPULSE || !pair_views[network->view].by_contact;
}

static bool network_path(const PaperScoring *scoring, int i, char path[PAPER_PATH_SIZE], Error *error) {
    return file_path(path, PAPER_PATH_SIZE, error, "%s/%s.npz", scoring->folder, scoring->networks[i].name);
}

static bool sample_launch(void *context, int i, Error *error) {
    Scores *scores = context;
    return snapshots_add(&scores->launched.states[i], &scores->launched.launches[i], &scores->scoring->sampling, error);
}

static bool rate_network(void *context, int i, Error *error) {
    Scores *scores = context;
    const PaperScoring *scoring = scores->scoring;
    char path[PAPER_PATH_SIZE];
    const bool warm = i == scoring->count;
    if (!warm && !network_path(scoring, i, path, error)) return false;
    return pair_rates_measure(warm ? NULL : path, scores->launched.scene, scores->launched.states,
                              scores->launched.count, &scoring->sampling, &scores->rates[i], error);
}

static bool write_rates(const PaperScoring *scoring, int network, const PairRates *rates, FILE *lines, Error *error) {
    RateRow row = {.network = network < scoring->count ? scoring->networks[network].name : "warm-start",
                   .scene = scoring->scene};
    for (row.definition = 0; row.definition < RATE_DEFINITIONS; row.definition++)
        for (row.phase = 0; row.phase < RATE_PHASES; row.phase++) {
            memcpy(row.share, rates->share[row.definition][row.phase], sizeof row.share);
            if (!piece_tables_print(lines, &paper_rate_layout, -1, &row, error)) return false;
        }
    return true;
}

bool paper_rates_write(void *context, FILE *lines, const Progress *progress, Error *error) {
    const PaperScoring *scoring = context;
    Scores scores = {.scoring = scoring};
    if (!launched_begin(&scores.launched, scoring->path, scoring->rate_launches, error)) return false;
    scores.rates = calloc((size_t)scoring->count + 1, sizeof *scores.rates);
    const ParallelWork sampling = {sample_launch, &scores}, rating = {rate_network, &scores};
    bool ok = (scores.rates != NULL || error_memory(error, "rates")) &&
              parallel_for(&sampling, scores.launched.count, "sampled launches", NULL, error) &&
              parallel_for(&rating, scoring->count + 1, "rated networks", progress, error);
    for (int i = 0; ok && i <= scoring->count; i++) ok = write_rates(scoring, i, &scores.rates[i], lines, error);
    free(scores.rates);
    launched_free(&scores.launched);
    return ok;
}

static bool method_of(const PaperScoring *scoring, int i, Method *method, Error *error) {
    char path[PAPER_PATH_SIZE];
    const char *name = scoring->networks[i].target == TARGET_POINTS ? "contact-net" : "pair-net";
    return network_path(scoring, i, path, error) && method_with_network(method, name, path, error);
}

static bool close_network(void *context, int i, Error *error) {
    Scores *scores = context;
    Method method;
    if (!takes_steps(&scores->scoring->networks[i])) return true;
    return method_of(scores->scoring, i, &method, error) &&
           closed_loop_run(&method, scores->launched.launches, scores->launched.count, &scores->closed[i], error);
}

static bool time_network(const Scores *scores, int i, FILE *lines, Error *error) {
    const PaperScoring *scoring = scores->scoring;
    const ClosedLoop *closed = &scores->closed[i];
    ClosedLoopRow row = {.network = scoring->networks[i].name,
                         .scene = scoring->scene,
                         .frames_until_apart = closed->frames_until_apart,
                         .penetration_max = closed->penetration_max,
                         .momentum_error = closed->momentum_error,
                         .energy_ratio = closed->energy_ratio};
    Method method;
    return method_of(scoring, i, &method, error) &&
           closed_loop_time(&method, &scores->launched.states[0], scoring->repetitions, &row.us_step,
                            &row.us_step_engine, error) &&
           piece_tables_print(lines, &paper_closed_loop_layout, -1, &row, error);
}

/* One after the other. */
static bool time_networks(const Scores *scores, FILE *lines, Error *error) {
    bool ok = true;
    for (int i = 0; ok && i < scores->scoring->count; i++)
        if (takes_steps(&scores->scoring->networks[i])) ok = time_network(scores, i, lines, error);
    return ok;
}

bool paper_closed_loop_write(void *context, FILE *lines, const Progress *progress, Error *error) {
    const PaperScoring *scoring = context;
    Scores scores = {.scoring = scoring};
    if (!launched_begin(&scores.launched, scoring->path, scoring->closed_launches, error)) return false;
    scores.closed = calloc((size_t)scoring->count, sizeof *scores.closed);
    const ParallelWork closing = {close_network, &scores};
    bool ok = (scores.closed != NULL || error_memory(error, "closed loop")) &&
              parallel_for(&closing, scoring->count, "networks in closed loop", progress, error) &&
              sample_launch(&scores, 0, error) && time_networks(&scores, lines, error);
    free(scores.closed);
    launched_free(&scores.launched);
    return ok;
}
