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
#include "paper/paper_internal.h"
#include "studies/closed_loop.h"
#include "studies/piece_tables.h"
#include "studies/rollout.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COMPONENTS = 2 };

bool transfer_study_run(const Dataset *const data[TRANSFER_SCENES], const TransferStudy *study, TransferRow *row,
                        const Progress *progress, Error *error) {
    enum { PYRAMID = TRANSFER_SCENES - 1 };
    *row = (TransferRow){study->transfer, (double)study->seed, study->launches, NAN, NAN};
    Dataset *drawn = dataset_draw_subset(data[PYRAMID], study->launches, study->seed, error);
    Network *network = NULL;
    bool ok = drawn != NULL;
    for (int stage = study->transfer ? 0 : PYRAMID; ok && stage <= PYRAMID; stage++) {
        const Dataset *dataset = stage == PYRAMID ? drawn : data[stage];
        const TrainingOptions options = {.layers = 2,
                                         .widths = {dataset_inputs(dataset), 10, COMPONENTS},
                                         .optimizer = "adam",
                                         .output_activation = "linear",
                                         .iterations = study->iterations,
                                         .seed = study->seed,
                                         .start = network};
        Network *next = whole_training(dataset, &options, progress, error);
        network_destroy(network);
        network = next;
        ok = network != NULL;
    }
    RowErrors errors;
    ok = ok && row_errors_find(&errors, network, drawn, COMPONENTS, false, error);
    if (ok) row->error = sqrt(errors.network[0] / errors.rows[0]); /* of one scene */
    if (ok) row->constant = sqrt(errors.constant[0] / errors.rows[0]);
    network_destroy(network);
    dataset_destroy(drawn);
    return ok;
}

bool law_study_run(const Dataset *dataset, const LawStudy *study, LawRow *row, const Progress *progress, Error *error) {
    TrainingOptions options = {.layers = 3,
                               .widths = {dataset_inputs(dataset), 8, 8, PAIR_CHANGES},
                               .optimizer = "adam",
                               .iterations = study->iterations,
                               .seed = study->seed};
    const bool labels = study->laws == NULL;
    Network *network = NULL;
    TrainingScore score = {.test = NAN, .constant_test = NAN};
    LawNumbers violations;
    const bool ok = (labels || (law_weights_named(study->laws, study->weight, &options.laws, error) &&
                                (network = whole_training(dataset, &options, progress, error)) != NULL &&
                                training_score(dataset, network, NULL, &score, error))) &&
                    laws_measure(dataset, network, &violations, error);
    network_destroy(network);
    if (!ok) return false;
    *row = (LawRow){.laws = labels ? LAW_SET_ENGINE : csv_word(paper_law_words, study->laws),
                    .weight = labels ? NAN : study->weight,
                    .seed = labels ? NAN : (double)study->seed,
                    .test = score.test,
                    .constant = score.constant_test};
    memcpy(row->violation, violations.of, sizeof row->violation);
    return true;
}

/* What solvers reach beside the networks in closed loop: the engine with its own and with ten times as many sweeps, and
   the most accurate one. */
static const char *const solvers[] = {"engine:k=10", "engine:k=100", "interior"};

enum { SOLVERS = sizeof solvers / sizeof *solvers };

/* One scene's study in progress. */
typedef struct Scores {
    const PaperPlan *plan;
    Launched launched;
    int networks;             /* of all scored splits: those of the first network first */
    PairRates *rates;         /* [networks + 1]; the last is the warm start's */
    ConvergedLogs *converged; /* [launches] */
    ClosedLoop *closed;       /* [networks + SOLVERS] */
} Scores;

static bool begin_scores(Scores *scores, const PaperPlan *plan, int scene, int launches, Error *error) {
    *scores = (Scores){.plan = plan, .networks = plan->network_count * plan->size->scored_splits};
    return launched_begin(&scores->launched, plan->datasets.scenes[scene], launches, error);
}

/* Of scored network i; and which split it is of, from 0. */
static const PaperNetwork *network_of(const Scores *scores, int i) {
    return &scores->plan->networks[i / scores->plan->size->scored_splits];
}

static int split_of(const Scores *scores, int i) { return i % scores->plan->size->scored_splits; }

static uint64_t seed_of(const Scores *scores, int i) {
    return scores->plan->options->seed + (uint64_t)split_of(scores, i);
}

static bool path_of(const Scores *scores, int i, char path[PAPER_PATH_SIZE], Error *error) {
    return paper_network_path(scores->plan, i / scores->plan->size->scored_splits, seed_of(scores, i), path, error);
}

static bool sample_launch(void *context, int i, Error *error) {
    Scores *scores = context;
    return snapshots_add(&scores->launched.states[i], &scores->launched.launches[i], &scores->plan->size->sampling,
                         error);
}

static bool rate_network(void *context, int i, Error *error) {
    Scores *scores = context;
    char path[PAPER_PATH_SIZE];
    const bool warm = i == scores->networks;
    if (!warm && !path_of(scores, i, path, error)) return false;
    return pair_rates_measure(warm ? NULL : path, scores->launched.scene, scores->launched.states,
                              scores->launched.count, &scores->plan->size->sampling, &scores->rates[i], error);
}

bool paper_rates_write(PaperPlan *plan, const PaperPart *part, FILE *lines, const Progress *progress, Error *error) {
    Scores scores;
    const Launched *launched = &scores.launched;
    if (!begin_scores(&scores, plan, part->index, plan->size->rate_launches, error)) return false;
    const int networks = scores.networks;
    scores.rates = calloc((size_t)networks + 1, sizeof *scores.rates);
    const ParallelWork sampling = {sample_launch, &scores}, rating = {rate_network, &scores};
    bool ok = (scores.rates != NULL || error_memory(error, "rates")) &&
              parallel_for(&sampling, launched->count, "sampled launches", NULL, error) &&
              parallel_for(&rating, networks + 1, "rated networks", progress, error);
    for (int i = 0; ok && i <= networks; i++) {
        RateRow row = {.network = i < networks ? network_of(&scores, i)->name : "warm-start",
                       .seed = i < networks ? (double)seed_of(&scores, i) : NAN,
                       .scene = part->index};
        for (int k = 0; k < launched->count; k++) row.unconverged += launched->states[k].unconverged;
        for (row.definition = 0; ok && row.definition < RATE_DEFINITIONS; row.definition++)
            for (row.phase = 0; ok && row.phase < RATE_PHASES; row.phase++) {
                memcpy(row.share, scores.rates[i].share[row.definition][row.phase], sizeof row.share);
                ok = piece_tables_print(lines, &paper_rate_layout, -1, &row, error);
            }
    }
    free(scores.rates);
    launched_free(&scores.launched);
    return ok;
}

/* Of a network, or of the solvers behind them. */
static bool method_of(const Scores *scores, int i, Method *method, Error *error) {
    char path[PAPER_PATH_SIZE];
    if (i >= scores->networks) return method_parse(method, solvers[i - scores->networks], error);
    const char *name = network_of(scores, i)->target == TARGET_POINTS ? "contact-net" : "pair-net";
    return path_of(scores, i, path, error) && method_with_network(method, name, path, error);
}

static bool is_closed(const Scores *scores, int i) {
    return i >= scores->networks || network_takes_steps(network_of(scores, i)->target, network_of(scores, i)->view);
}

static bool log_launch(void *context, int i, Error *error) {
    Scores *scores = context;
    Scene launched = scores->launched.launches[i];
    launched.frames = CLOSED_LOOP_FRAMES;
    return closed_loop_log_converged(&scores->converged[i], &launched, error);
}

static bool close_method(void *context, int i, Error *error) {
    Scores *scores = context;
    const Launched *launched = &scores->launched;
    Method method;
    if (!is_closed(scores, i)) return true;
    return method_of(scores, i, &method, error) &&
           closed_loop_run(&method, launched->launches, scores->converged, launched->count, &scores->closed[i], error);
}

bool paper_closed_loop_write(PaperPlan *plan, const PaperPart *part, FILE *lines, const Progress *progress,
                             Error *error) {
    Scores scores;
    if (!begin_scores(&scores, plan, part->index, plan->size->closed_launches, error)) return false;
    const int methods = scores.networks + SOLVERS, launches = scores.launched.count;
    scores.closed = calloc((size_t)methods, sizeof *scores.closed);
    scores.converged = calloc((size_t)launches, sizeof *scores.converged);
    const ParallelWork logging = {log_launch, &scores}, closing = {close_method, &scores};
    bool ok = ((scores.closed != NULL && scores.converged != NULL) || error_memory(error, "closed loop")) &&
              parallel_for(&logging, launches, "converged runs", NULL, error) &&
              parallel_for(&closing, methods, "networks in closed loop", progress, error) &&
              sample_launch(&scores, 0, error);
    /* Times are taken one after the other. */
    for (int i = 0; ok && i < methods; i++) {
        if (!is_closed(&scores, i)) continue;
        const ClosedLoop *closed = &scores.closed[i];
        const bool network = i < scores.networks;
        ClosedLoopRow row = {.network = network ? network_of(&scores, i)->name : solvers[i - scores.networks],
                             .seed = network ? (double)seed_of(&scores, i) : NAN,
                             .scene = part->index,
                             .frames_until_apart = closed->frames_until_apart,
                             .penetration_max = closed->penetration_max,
                             .momentum_error = closed->momentum_error,
                             .energy_ratio = closed->energy_ratio,
                             .unconverged = closed->unconverged,
                             .us_step = NAN,
                             .us_step_engine = NAN};
        Method method;
        ok = (network && split_of(&scores, i) > 0) ||
             (method_of(&scores, i, &method, error) &&
              closed_loop_time(&method, &scores.launched.states[0], plan->size->repetitions, &row.us_step,
                               &row.us_step_engine, error));
        ok = ok && piece_tables_print(lines, &paper_closed_loop_layout, -1, &row, error);
    }
    for (int i = 0; scores.converged != NULL && i < launches; i++) converged_logs_free(&scores.converged[i]);
    free(scores.converged);
    free(scores.closed);
    launched_free(&scores.launched);
    return ok;
}
