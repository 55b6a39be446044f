/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/study/paper_training.h"

#include "common/file.h"
#include "common/hash.h"
#include "paper/study/paper_tables.h"
#include "paper/study/whole_training.h"
#include "study/piece_tables.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double near_share = 0.05; /* of the outputs' range */

enum { NOTE_SIZE = 64, NETWORK_MAX_SIZE = 1 << 26 };

/* text: "10-10-2". */
static void read_layers(const char *text, TrainingOptions *options) {
    int count = 0;
    for (char *rest = (char *)text; *rest != '\0';) {
        options->widths[count++] = (int)strtol(rest, &rest, 10);
        if (*rest == '-') rest++;
    }
    options->layers = count - 1;
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

/* Label of output k: one of all changes, or the change of b's velocity relative to a's. */
static double change_of(const Dataset *dataset, int64_t row, int outputs, int k) {
    const int count = pair_change_count(dataset->target);
    const float *changes = dataset->changes + row * count;
    return (double)(outputs == count ? changes[k] : changes[k + 3] - changes[k]);
}

static bool held_out(const Dataset *dataset, int64_t row) { return dataset->launch_test[dataset->launch[row]] != 0; }

static void find_ranges(const Dataset *dataset, int outputs, double range[PAIR_CHANGES]) {
    for (int k = 0; k < outputs; k++) {
        double least = INFINITY, most = -INFINITY;
        for (int64_t row = 0; row < dataset->rows; row++) {
            if (held_out(dataset, row)) continue;
            least = fmin(least, change_of(dataset, row, outputs, k));
            most = fmax(most, change_of(dataset, row, outputs, k));
        }
        range[k] = most - least;
    }
}

bool paper_accuracy(const Network *network, const Dataset *dataset, double *accuracy, Error *error) {
    const int outputs = network->widths[network->layers], inputs = network->widths[0];
    double range[PAIR_CHANGES];
    float *scratch = malloc(2 * (size_t)network_scratch_width(network) * sizeof *scratch), output[PAIR_CHANGES];
    if (scratch == NULL) return error_memory(error, "paper");
    find_ranges(dataset, outputs, range);
    int64_t rows = 0, right = 0;
    for (int64_t row = 0; row < dataset->rows; row++) {
        if (!held_out(dataset, row)) continue;
        network_predict(network, dataset->inputs + row * inputs, scratch, output);
        bool near = true;
        for (int k = 0; k < outputs; k++)
            near &= fabs((double)output[k] - change_of(dataset, row, outputs, k)) <= near_share * range[k];
        right += near;
        rows++;
    }
    free(scratch);
    *accuracy = rows > 0 ? (double)right / (double)rows : NAN;
    return true;
}

static bool write_network(FILE *lines, const PaperNetwork *of, const Network *network, const TrainingScore *score,
                          double accuracy, Error *error) {
    const TrainedRow row = {.network = of->name,
                            .factor = of->factor,
                            .value = of->value,
                            .inputs = pair_views[of->view].name,
                            .data = paper_data_names[of->data],
                            .labels = dataset_label_names[of->labels],
                            .target = (int)of->target,
                            .layers = of->layers,
                            .hidden = of->hidden,
                            .output = of->output,
                            .scale = of->scale,
                            .optimizer = of->optimizer,
                            .loss = of->loss,
                            .iterations = score->iteration,
                            .parameters = network_parameter_count(network),
                            .test = score->test,
                            .train = score->train,
                            .constant = score->constant_test,
                            .ratio = score->test / score->constant_test,
                            .accuracy = accuracy};
    return piece_tables_print(lines, &paper_trained_layout, -1, &row, error);
}

static bool network_path(const PaperTraining *training, char path[PAPER_PATH_SIZE], Error *error) {
    return file_path(path, PAPER_PATH_SIZE, error, "%s/%s.npz", training->folder, training->network.name);
}

/* The note that tells a network from one of the same name. */
static bool print_note(char note[NOTE_SIZE], const char *path, Error *error) {
    size_t size;
    char *data = file_read(path, NETWORK_MAX_SIZE, &size, error);
    if (data == NULL) return false;
    snprintf(note, NOTE_SIZE, "# network %016" PRIx64 "\n", hash_xxh3(data, size));
    free(data);
    return true;
}

bool paper_training_whole(const PaperTraining *training, const char *lines, bool *there, Error *error) {
    char path[PAPER_PATH_SIZE], note[NOTE_SIZE];
    Error reason = {0};
    *there = false;
    if (!network_path(training, path, error)) return false;
    if (print_note(note, path, &reason)) *there = strstr(lines, note) != NULL;
    if (reason.kind == ERROR_NONE || reason.kind == ERROR_INPUT) return true;
    *error = reason;
    return false;
}

static bool store(const PaperTraining *training, Network *network, FILE *lines, Error *error) {
    char path[PAPER_PATH_SIZE], note[NOTE_SIZE];
    snprintf(network->command, sizeof network->command, "twinbox paper: %s", training->network.name);
    if (!network_path(training, path, error) || !network_write(network, path, error) || !print_note(note, path, error))
        return false;
    fputs(note, lines);
    return true;
}

bool paper_training_write(void *context, FILE *lines, const Progress *progress, Error *error) {
    const PaperTraining *training = context;
    const PaperNetwork *of = &training->network;
    const Dataset *dataset = paper_dataset(training->datasets, of, error);
    if (dataset == NULL) return false;
    ScoreWriter writer = {lines, of, {0}, true, error};
    TrainingOptions options = {.optimizer = of->optimizer,
                               .iterations = of->iterations,
                               .seed = training->seed,
                               .hidden = of->hidden,
                               .output_activation = of->output,
                               .scale = of->scale,
                               .loss = of->loss,
                               .on_score = write_score,
                               .context = &writer};
    read_layers(of->layers, &options);
    Network *network = whole_training(dataset, &options, progress, error);
    if (network == NULL) return false;
    /* The score of the weights that are kept, which are not the last ones. */
    TrainingScore score = {.iteration = writer.last.iteration};
    const int iterations = score.iteration;
    bool ok = writer.ok && training_score(dataset, network, of->loss, &score, error);
    score.iteration = iterations;
    double accuracy = NAN;
    ok = ok && paper_accuracy(network, dataset, &accuracy, error) &&
         write_network(lines, of, network, &score, accuracy, error) && store(training, network, lines, error);
    network_destroy(network);
    return ok;
}
