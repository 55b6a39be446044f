/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Times one part of learning and prints seconds, one figure per line, for the script "run" in this folder:

       time_learn predict NET.npz PAIRS         per pair: "name seconds" for each of the kernels, and one by one
       time_learn train DATA.npz ITERATIONS     per iteration
       time_learn record THREADS SCENE.yaml...  for 201 launches of every scene, in memory */
#include "base/machine.h"
#include "nets/kernels.h"
#include "learning/pair_training.h"

#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The buffers of a prediction. */
typedef struct Batch {
    int pairs, inputs, outputs;
    float *in, *out, *scratch;
} Batch;

static void predict_by(const Kernels *kernels, const Network *network, const Batch *batch) {
    for (int first = 0; first < batch->pairs; first += TILE_ROWS) {
        int left = batch->pairs - first;
        kernels->predict(network, batch->in, batch->scratch, batch->out, batch->pairs, first,
                         left < TILE_ROWS ? left : TILE_ROWS);
    }
}

static void predict_singly(const Network *network, const Batch *batch) {
    for (int r = 0; r < batch->pairs; r++)
        network_predict(network, batch->in + r * batch->inputs, batch->scratch, batch->out + r * batch->outputs);
}

/* Seconds per pair; kernels NULL: one by one. Repeated for about 2 ms, far above the resolution of the clock. */
static double time_prediction(const Kernels *kernels, const Network *network, const Batch *batch) {
    int repeats = 2000000 / (batch->pairs * 10) + 1;
    double start = clock_seconds();
    for (int i = 0; i < repeats; i++) {
        if (kernels != NULL)
            predict_by(kernels, network, batch);
        else
            predict_singly(network, batch);
    }
    return (clock_seconds() - start) / repeats / batch->pairs;
}

static bool predict(const char *path, int pairs, Error *error) {
    Network *network = network_read(path, error);
    if (network == NULL) return false;
    Batch batch = {.pairs = pairs, .inputs = network->widths[0], .outputs = network->widths[network->layers]};
    batch.in = malloc((size_t)(pairs * batch.inputs) * sizeof *batch.in);
    batch.out = malloc((size_t)(pairs * batch.outputs) * sizeof *batch.out);
    batch.scratch = malloc(network_batch_scratch(network) * sizeof *batch.scratch);
    bool ok = (batch.in != NULL && batch.out != NULL && batch.scratch != NULL) || error_memory(error, "benchmark");
    if (ok) {
        for (int i = 0; i < pairs * batch.inputs; i++) batch.in[i] = (float)(i * 7 % 401) / 50 - 4;
        const Kernels *list[KERNELS_MAX + 1];
        kernels_list(list);
        for (int k = 0; list[k] != NULL; k++)
            printf("%s %.4g\n", list[k]->name, time_prediction(list[k], network, &batch));
        printf("single %.4g\n", time_prediction(NULL, network, &batch));
    }
    free(batch.in);
    free(batch.out);
    free(batch.scratch);
    network_destroy(network);
    return ok;
}

/* The times at which the first and the last iteration ended. */
typedef struct Span {
    double start, end;
} Span;

static bool note_time(void *context, double done, double total) {
    Span *span = context;
    if (done == 0) span->start = clock_seconds();
    if (done == total) span->end = clock_seconds();
    return true;
}

static bool train(const char *path, int iterations, Error *error) {
    Dataset *dataset = dataset_read(path, error);
    if (dataset == NULL) return false;
    TrainingOptions options = {
        .layers = 2, .widths = {10, 10, 2}, .optimizer = "adam", .iterations = iterations, .seed = 1};
    Span span = {0};
    Progress progress = {note_time, &span};
    Network *network = training_run(dataset, &options, &progress, error);
    bool ok = network != NULL;
    if (ok) printf("%.6g\n", (span.end - span.start) / iterations);
    network_destroy(network);
    dataset_destroy(dataset);
    return ok;
}

static bool record(int threads, const char *const *scenes, int count, Error *error) {
    omp_set_num_threads(threads);
    const DatasetOptions options = {
        .scenes = scenes, .scene_count = count, .bomb_x = {.first = -5, .step = 0.05, .count = 201}, .seed = 1};
    double start = clock_seconds();
    Dataset *dataset = dataset_record(&options, NULL, error);
    if (dataset == NULL) return false;
    printf("%.6g\n", clock_seconds() - start);
    dataset_destroy(dataset);
    return true;
}

int main(int argc, char **argv) {
    Error error = {0};
    bool ok = false;
    if (argc == 4 && strcmp(argv[1], "predict") == 0)
        ok = predict(argv[2], atoi(argv[3]), &error);
    else if (argc == 4 && strcmp(argv[1], "train") == 0)
        ok = train(argv[2], atoi(argv[3]), &error);
    else if (argc >= 4 && strcmp(argv[1], "record") == 0)
        ok = record(atoi(argv[2]), (const char *const *)argv + 3, argc - 3, &error);
    if (!ok) fprintf(stderr, "time_learn: %s\n", error.message);
    return ok ? 0 : 1;
}
