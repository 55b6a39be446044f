/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The networks of the study, each trained, scored and stored. */
#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/machine.h"
#include "learning/dataset.h"
#include "learning/pair_training.h"
#include "methods/pair.h"
#include "nets/nets.h"
#include "paper/paper_internal.h"
#include "studies/piece_tables.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const data_names[PAPER_DATA] = {"swept", "random", "mixed", "swept, more rows"};

#define SEARCHED(form) \
    { .name = "layers-" form, .factor = "layers", .value = form, .layers = form }

/* Searched widths are around 6, the mean of ten inputs and two outputs. The networks of the factor "best" are the best
   that a search with Adam found for each target within 500 parameters, among 20 to 40 layouts with inputs of all views.
   */
const PaperNetwork paper_networks[] = {
    {.name = "baseline", .factor = "baseline", .value = "10-10-2", .quick = true},
    {.name = "inputs-raw", .factor = "inputs", .value = "raw", .view = PAIR_RAW, .layers = "12-10-2", .quick = true},
    {.name = "inputs-raw-unturned", .factor = "inputs", .value = "raw-unturned", .view = PAIR_RAW_UNTURNED},
    {.name = "outputs-six", .factor = "outputs", .value = "six", .layers = "10-10-6", .output = "sigmoid"},
    {.name = "outputs-six-two-layers",
     .factor = "outputs",
     .value = "six, 10-8-8-6",
     .layers = "10-8-8-6",
     .output = "linear",
     .quick = true},
    {.name = "target-net", .factor = "target", .value = "net", .target = TARGET_NET, .quick = true},
    {.name = "target-impulse", .factor = "target", .value = "impulse", .target = TARGET_IMPULSE, .quick = true},
    {.name = "data-random", .factor = "data", .value = "random", .data = DATA_RANDOM},
    {.name = "data-mixed", .factor = "data", .value = "mixed", .data = DATA_MIXED},
    {.name = "labels-reference",
     .factor = "labels",
     .value = "reference",
     .labels = DATASET_BY_REFERENCE,
     .quick = true},
    {.name = "scaling-linear", .factor = "scaling", .value = "min-max, linear", .output = "linear", .scale = "minmax"},
    {.name = "scaling-standard", .factor = "scaling", .value = "standard, linear", .output = "linear", .quick = true},
    {.name = "hidden-tanh", .factor = "hidden", .value = "tanh", .hidden = "tanh"},
    {.name = "hidden-relu", .factor = "hidden", .value = "relu", .hidden = "relu"},
    SEARCHED("10-4-2"),
    SEARCHED("10-6-2"),
    SEARCHED("10-8-2"),
    SEARCHED("10-4-4-2"),
    SEARCHED("10-6-6-2"),
    SEARCHED("10-8-8-2"),
    SEARCHED("10-4-4-4-2"),
    SEARCHED("10-6-6-6-2"),
    SEARCHED("10-8-8-8-2"),
    SEARCHED("10-4-4-4-4-2"),
    SEARCHED("10-6-6-6-6-2"),
    SEARCHED("10-8-8-8-8-2"),
    {.name = "optimizer-gd", .factor = "optimizer", .value = "gd", .optimizer = "gd"},
    {.name = "optimizer-bfgs", .factor = "optimizer", .value = "bfgs", .optimizer = "bfgs"},
    {.name = "optimizer-lm", .factor = "optimizer", .value = "lm", .optimizer = "lm", .quick = true},
    {.name = "net-gd", .factor = "optimizer", .value = "gd", .target = TARGET_NET, .optimizer = "gd"},
    {.name = "net-bfgs", .factor = "optimizer", .value = "bfgs", .target = TARGET_NET, .optimizer = "bfgs"},
    {.name = "net-lm", .factor = "optimizer", .value = "lm", .target = TARGET_NET, .optimizer = "lm"},
    {.name = "impulse-gd", .factor = "optimizer", .value = "gd", .target = TARGET_IMPULSE, .optimizer = "gd"},
    {.name = "impulse-bfgs", .factor = "optimizer", .value = "bfgs", .target = TARGET_IMPULSE, .optimizer = "bfgs"},
    {.name = "impulse-lm", .factor = "optimizer", .value = "lm", .target = TARGET_IMPULSE, .optimizer = "lm"},
    {.name = "best-pair",
     .factor = "best",
     .value = "pair",
     .data = DATA_DENSE,
     .iterations = 1000,
     .view = PAIR_NEIGHBOURS,
     .layers = "32-12-6-2",
     .hidden = "tanh",
     .output = "linear"},
    {.name = "best-net",
     .factor = "best",
     .value = "net",
     .data = DATA_DENSE,
     .iterations = 1000,
     .view = PAIR_NEIGHBOURS,
     .target = TARGET_NET,
     .layers = "32-12-6-2",
     .hidden = "tanh",
     .output = "linear"},
    {.name = "best-impulse",
     .factor = "best",
     .value = "impulse",
     .data = DATA_DENSE,
     .iterations = 1000,
     .view = PAIR_CONTACT,
     .target = TARGET_IMPULSE,
     .layers = "20-21-2",
     .hidden = "relu",
     .output = "linear"},
    {.name = "contact-net",
     .factor = "contact-net",
     .value = "contact-net",
     .view = PAIR_NEIGHBOURS,
     .target = TARGET_POINTS,
     .layers = "32-24-12-4",
     .hidden = "relu",
     .output = "linear",
     .loss = "smooth-l1",
     .quick = true},
};

const int paper_network_count = sizeof paper_networks / sizeof paper_networks[0];

PaperNetwork paper_network(int i) {
    PaperNetwork network = paper_networks[i];
    if (network.layers == NULL) network.layers = "10-10-2";
    if (network.hidden == NULL) network.hidden = "sigmoid";
    if (network.output == NULL) network.output = "sigmoid";
    if (network.scale == NULL) network.scale = strcmp(network.output, "linear") == 0 ? "standard" : "minmax";
    if (network.optimizer == NULL) network.optimizer = "adam";
    if (network.loss == NULL) network.loss = "mse";
    /* A step of Levenberg-Marquardt costs as much as 35 of the others, and passes hundreds of them. */
    if (network.iterations == 0) network.iterations = strcmp(network.optimizer, "lm") == 0 ? 100 : 2000;
    return network;
}

bool row_errors_find(RowErrors *errors, const Network *network, const Dataset *dataset, int outputs, bool ranged,
                     Error *error) {
    const double near_share = 0.05;
    const int inputs = dataset_inputs(dataset);
    double mean[PAIR_CHANGES] = {0}, range[PAIR_CHANGES];
    float output[PAIR_CHANGES], *scratch = NULL;
    *errors = (RowErrors){.right = 0};
    if (network != NULL && (scratch = malloc(2 * (size_t)network_scratch_width(network) * sizeof *scratch)) == NULL)
        return error_memory(error, "paper");
    for (int k = 0; k < outputs; k++) {
        double least = INFINITY, most = -INFINITY, count = 0;
        for (int64_t row = 0; row < dataset->rows; row++) {
            if (dataset_is_test(dataset, row)) continue;
            const double value = (double)dataset_target(dataset, row, outputs, k);
            least = fmin(least, value);
            most = fmax(most, value);
            mean[k] += value;
            count++;
        }
        mean[k] /= count;
        range[k] = ranged && most > least ? most - least : 1;
    }
    for (int64_t row = 0; row < dataset->rows; row++) {
        double of_network = 0, of_constant = 0;
        bool is_right = true;
        if (network != NULL) network_predict(network, dataset->inputs + row * inputs, scratch, output);
        for (int k = 0; k < outputs; k++) {
            const double target = (double)dataset_target(dataset, row, outputs, k);
            const double constant = (mean[k] - target) / range[k],
                         e = network != NULL ? ((double)output[k] - target) / range[k] : constant;
            of_network += e * e / outputs;
            of_constant += constant * constant / outputs;
            is_right &= fabs(e) <= near_share;
        }
        const bool test = dataset_is_test(dataset, row);
        const int kind = test ? dataset->launch_scene[dataset->launch[row]] : TRAIN_ROWS;
        errors->network[kind] += of_network;
        errors->constant[kind] += of_constant;
        errors->rows[kind]++;
        errors->right += test && is_right;
        for (int i = 0; test && i < LARGEST; i++) {
            if (of_network <= errors->largest[i]) continue;
            memmove(errors->largest + i + 1, errors->largest + i, (size_t)(LARGEST - 1 - i) * sizeof *errors->largest);
            errors->largest[i] = of_network;
            break;
        }
    }
    free(scratch);
    return true;
}

/* The sum over the scenes' test rows. */
static double of_scenes(const double sums[ROW_KINDS]) {
    double sum = 0;
    for (int i = 0; i < PAPER_TRAINING_SCENES; i++) sum += sums[i];
    return sum;
}

static double share_of_largest(const RowErrors *errors) {
    double sum = 0;
    for (int i = 0; i < LARGEST; i++) sum += errors->largest[i];
    return sum / of_scenes(errors->network);
}

bool paper_constants_write(PaperPlan *plan, const PaperPart *part, FILE *lines, const Progress *progress,
                           Error *error) {
    const int splits = plan->size->constant_splits, outputs = 2;
    const PaperNetwork network = {.target = (PairTarget)part->index};
    const Dataset *dataset = paper_dataset_whole(&plan->datasets, &network, error);
    bool ok = dataset != NULL;
    for (int i = 0; ok && i < splits; i++) {
        SplitDataset split;
        RowErrors errors;
        const uint64_t seed = plan->options->seed + (uint64_t)i;
        ok = split_begin(&split, dataset, seed, error);
        if (!ok) break;
        ok = row_errors_find(&errors, NULL, &split.dataset, outputs, true, error);
        split_free(&split);
        ConstantRow row = {.target = part->index,
                           .seed = (double)seed,
                           .rows = of_scenes(errors.rows),
                           .test = of_scenes(errors.constant) / of_scenes(errors.rows),
                           .train = errors.constant[TRAIN_ROWS] / errors.rows[TRAIN_ROWS],
                           .largest = share_of_largest(&errors)};
        for (int scene = 0; scene < PAPER_TRAINING_SCENES; scene++)
            row.test_of[scene] = errors.constant[scene] / errors.rows[scene];
        ok = ok && piece_tables_print(lines, &paper_constant_layout, -1, &row, error) &&
             (progress_report(progress, i + 1, splits) || error_interrupted(error, "constants", "stopped"));
    }
    return ok;
}

typedef struct Watch {
    const Progress *progress;
    bool stopped;
} Watch;

static bool watch_training(void *context, double done, double total) {
    Watch *watch = context;
    if (!progress_report(watch->progress, done, total)) watch->stopped = true;
    return !watch->stopped;
}

Network *whole_training(const Dataset *dataset, const TrainingOptions *options, const Progress *progress,
                        Error *error) {
    Watch watch = {.progress = progress};
    const Progress watched = {watch_training, &watch};
    Network *network = training_run(dataset, options, &watched, error);
    if (network == NULL || !watch.stopped) return network;
    network_destroy(network);
    return error_interrupted(error, "training", "stopped"), NULL;
}

bool paper_network_path(const PaperPlan *plan, int i, uint64_t seed, char path[PAPER_PATH_SIZE], Error *error) {
    return file_path(path, PAPER_PATH_SIZE, error, "%s/%s-%llu.npz", plan->networks_folder, plan->networks[i].name,
                     (unsigned long long)seed);
}

enum { NOTE_SIZE = 64, NETWORK_MAX_SIZE = 1 << 26 };

/* The note that tells a network from one of the same name. */
static bool print_note(char note[NOTE_SIZE], const char *path, Error *error) {
    size_t size;
    char *data = file_read(path, NETWORK_MAX_SIZE, &size, error);
    if (data == NULL) return false;
    snprintf(note, NOTE_SIZE, "# network %016" PRIx64 "\n", hash_xxh3(data, size));
    free(data);
    return true;
}

bool paper_training_whole(const PaperPlan *plan, const PaperPart *part, const char *lines, bool *there, Error *error) {
    char path[PAPER_PATH_SIZE], note[NOTE_SIZE];
    Error reason = {0};
    *there = false;
    if (!paper_network_path(plan, part->index, part->seed, path, error)) return false;
    if (print_note(note, path, &reason)) *there = strstr(lines, note) != NULL;
    if (reason.kind == ERROR_NONE || reason.kind == ERROR_INPUT) return true;
    *error = reason;
    return false;
}

/* Writes the scores of a training, if they are in the units of its table. */
typedef struct ScoreWriter {
    FILE *lines;
    const PaperNetwork *network;
    uint64_t seed;
    TrainingScore last;
    bool ok;
    Error *error;
} ScoreWriter;

static void write_score(void *context, const TrainingScore *score) {
    ScoreWriter *writer = context;
    const PaperNetwork *network = writer->network;
    const ScoreRow row = {.network = network->name,
                          .seed = (double)writer->seed,
                          .target = (int)network->target,
                          .optimizer = csv_word(paper_optimizer_words, network->optimizer),
                          .iteration = score->iteration,
                          .test = score->test,
                          .train = score->train,
                          .constant = score->constant_test};
    writer->last = *score;
    if (strcmp(network->scale, "minmax") == 0 && strcmp(network->loss, "mse") == 0)
        writer->ok = writer->ok && piece_tables_print(writer->lines, &paper_score_layout, -1, &row, writer->error);
}

static bool score_and_store(const PaperPlan *plan, const PaperPart *part, const Dataset *dataset, Network *network,
                            int iterations, FILE *lines, Error *error) {
    const PaperNetwork *of = &plan->networks[part->index];
    RowErrors errors;
    if (!row_errors_find(&errors, network, dataset, network->widths[network->layers], true, error)) return false;
    const double rows = of_scenes(errors.rows);
    TrainedRow row = {.network = of->name,
                      .factor = of->factor,
                      .value = of->value,
                      .seed = (double)part->seed,
                      .inputs = pair_views[of->view].name,
                      .data = data_names[of->data],
                      .labels = dataset_label_names[of->labels],
                      .target = (int)of->target,
                      .layers = of->layers,
                      .hidden = of->hidden,
                      .output = of->output,
                      .scale = of->scale,
                      .optimizer = of->optimizer,
                      .loss = of->loss,
                      .iterations = iterations,
                      .parameters = network_parameter_count(network),
                      .test = of_scenes(errors.network) / rows,
                      .train = errors.network[TRAIN_ROWS] / errors.rows[TRAIN_ROWS],
                      .constant = of_scenes(errors.constant) / rows,
                      .ratio = of_scenes(errors.network) / of_scenes(errors.constant),
                      .largest = share_of_largest(&errors),
                      .accuracy = errors.right / rows};
    for (int scene = 0; scene < PAPER_TRAINING_SCENES; scene++)
        row.ratio_of[scene] = errors.network[scene] / errors.constant[scene];
    char path[PAPER_PATH_SIZE], note[NOTE_SIZE];
    snprintf(network->command, sizeof network->command, "twinbox paper: %s", part->name);
    if (!piece_tables_print(lines, &paper_trained_layout, -1, &row, error) ||
        !paper_network_path(plan, part->index, part->seed, path, error) || !network_write(network, path, error) ||
        !print_note(note, path, error))
        return false;
    fputs(note, lines);
    return true;
}

bool paper_training_write(PaperPlan *plan, const PaperPart *part, FILE *lines, const Progress *progress, Error *error) {
    const PaperNetwork *of = &plan->networks[part->index];
    SplitDataset split;
    if (!split_begin(&split, paper_dataset(&plan->datasets, of, error), part->seed, error)) return false;
    ScoreWriter writer = {lines, of, part->seed, {0}, true, error};
    TrainingOptions options = {.layers = -1,
                               .optimizer = of->optimizer,
                               .iterations = of->iterations,
                               .patience = of->iterations / 4,
                               .seed = part->seed,
                               .hidden = of->hidden,
                               .output_activation = of->output,
                               .scale = of->scale,
                               .loss = of->loss,
                               .on_score = write_score,
                               .context = &writer};
    /* "10-10-2" */
    for (char *rest = (char *)of->layers; *rest != '\0'; rest += *rest == '-')
        options.widths[++options.layers] = (int)strtol(rest, &rest, 10);
    Network *network = whole_training(&split.dataset, &options, progress, error);
    const bool ok = network != NULL && writer.ok &&
                    score_and_store(plan, part, &split.dataset, network, writer.last.iteration, lines, error);
    network_destroy(network);
    split_free(&split);
    return ok;
}
