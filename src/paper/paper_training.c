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

static const char *const data_names[PAPER_DATA] = {
    "swept", "random", "mixed", "swept finely", "swept most finely", "swept as in the paper"};

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
    {.name = "data-paper", .factor = "data", .value = "201 launches", .data = DATA_PAPER},
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
     .data = DATA_FINE,
     .view = PAIR_NEIGHBOURS,
     .layers = "32-12-6-2",
     .hidden = "tanh",
     .output = "linear"},
    {.name = "best-net",
     .factor = "best",
     .value = "net",
     .data = DATA_FINE,
     .view = PAIR_NEIGHBOURS,
     .target = TARGET_NET,
     .layers = "32-12-6-2",
     .hidden = "tanh",
     .output = "linear"},
    {.name = "best-impulse",
     .factor = "best",
     .value = "impulse",
     .data = DATA_FINEST,
     .view = PAIR_CONTACT,
     .target = TARGET_IMPULSE,
     .layers = "20-21-2",
     .hidden = "relu",
     .output = "linear"},
    {.name = "contact-net",
     .factor = "contact-net",
     .value = "contact-net",
     .data = DATA_FINE,
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
    if (network.iterations == 0) network.iterations = 2000;
    return network;
}

/* The share of test rows for which all outputs are within 5% of their range over the training rows; NaN without test
   rows. The paper does not define the accuracy of its gate (section 3: 90%); this is a guess. False with error set when
   memory is short. */
static bool find_accuracy(const Network *network, const Dataset *dataset, double *accuracy, Error *error) {
    const double near_share = 0.05; /* of the outputs' range */
    const int outputs = network->widths[network->layers], inputs = network->widths[0];
    double near[PAIR_CHANGES];
    float *scratch = malloc(2 * (size_t)network_scratch_width(network) * sizeof *scratch), output[PAIR_CHANGES];
    if (scratch == NULL) return error_memory(error, "paper");
    for (int k = 0; k < outputs; k++) {
        double least = INFINITY, most = -INFINITY;
        for (int64_t row = 0; row < dataset->rows; row++) {
            if (dataset_is_test(dataset, row)) continue;
            least = fmin(least, (double)dataset_target(dataset, row, outputs, k));
            most = fmax(most, (double)dataset_target(dataset, row, outputs, k));
        }
        near[k] = near_share * (most - least);
    }
    int64_t rows = 0, right = 0;
    for (int64_t row = 0; row < dataset->rows; row++) {
        if (!dataset_is_test(dataset, row)) continue;
        network_predict(network, dataset->inputs + row * inputs, scratch, output);
        bool is_right = true;
        for (int k = 0; k < outputs; k++)
            is_right &= fabs((double)output[k] - (double)dataset_target(dataset, row, outputs, k)) <= near[k];
        right += is_right;
        rows++;
    }
    free(scratch);
    *accuracy = rows > 0 ? (double)right / (double)rows : NAN;
    return true;
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

bool paper_network_path(const PaperPlan *plan, int i, char path[PAPER_PATH_SIZE], Error *error) {
    return file_path(path, PAPER_PATH_SIZE, error, "%s/%s.npz", plan->networks_folder, plan->networks[i].name);
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
    if (!paper_network_path(plan, part->index, path, error)) return false;
    if (print_note(note, path, &reason)) *there = strstr(lines, note) != NULL;
    if (reason.kind == ERROR_NONE || reason.kind == ERROR_INPUT) return true;
    *error = reason;
    return false;
}

/* Writes the scores of a training. */
typedef struct ScoreWriter {
    FILE *lines;
    const PaperNetwork *network;
    TrainingScore last;
    bool ok;
    Error *error;
} ScoreWriter;

static void write_score(void *context, const TrainingScore *score) {
    ScoreWriter *writer = context;
    const PaperNetwork *network = writer->network;
    const ScoreRow row = {.network = network->name,
                          .target = (int)network->target,
                          .optimizer = csv_word(paper_optimizer_words, network->optimizer),
                          .iteration = score->iteration,
                          .test = score->test,
                          .train = score->train,
                          .constant = score->constant_test};
    writer->last = *score;
    writer->ok = writer->ok && piece_tables_print(writer->lines, &paper_score_layout, -1, &row, writer->error);
}

static bool score_and_store(const PaperPlan *plan, const PaperPart *part, const Dataset *dataset, Network *network,
                            int iterations, FILE *lines, Error *error) {
    const PaperNetwork *of = &plan->networks[part->index];
    TrainingScore score = {0}; /* of the weights that are kept, which are not the last ones */
    double accuracy = NAN;
    if (!training_score(dataset, network, of->loss, &score, error) ||
        !find_accuracy(network, dataset, &accuracy, error))
        return false;
    const TrainedRow row = {.network = of->name,
                            .factor = of->factor,
                            .value = of->value,
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
                            .test = score.test,
                            .train = score.train,
                            .constant = score.constant_test,
                            .ratio = score.test / score.constant_test,
                            .accuracy = accuracy};
    char path[PAPER_PATH_SIZE], note[NOTE_SIZE];
    snprintf(network->command, sizeof network->command, "twinbox paper: %s", of->name);
    if (!piece_tables_print(lines, &paper_trained_layout, -1, &row, error) ||
        !paper_network_path(plan, part->index, path, error) || !network_write(network, path, error) ||
        !print_note(note, path, error))
        return false;
    fputs(note, lines);
    return true;
}

bool paper_training_write(PaperPlan *plan, const PaperPart *part, FILE *lines, const Progress *progress, Error *error) {
    const PaperNetwork *of = &plan->networks[part->index];
    const Dataset *dataset = paper_dataset(&plan->datasets, of, error);
    if (dataset == NULL) return false;
    ScoreWriter writer = {lines, of, {0}, true, error};
    TrainingOptions options = {.layers = -1,
                               .optimizer = of->optimizer,
                               .iterations = of->iterations,
                               .seed = plan->datasets.seed,
                               .hidden = of->hidden,
                               .output_activation = of->output,
                               .scale = of->scale,
                               .loss = of->loss,
                               .on_score = write_score,
                               .context = &writer};
    /* "10-10-2" */
    for (char *rest = (char *)of->layers; *rest != '\0'; rest += *rest == '-')
        options.widths[++options.layers] = (int)strtol(rest, &rest, 10);
    Network *network = whole_training(dataset, &options, progress, error);
    if (network == NULL) return false;
    const bool ok = writer.ok && score_and_store(plan, part, dataset, network, writer.last.iteration, lines, error);
    network_destroy(network);
    return ok;
}
