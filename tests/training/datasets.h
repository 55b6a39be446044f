/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Datasets for tests, made by hand. */
#pragma once
#include "testing.h"

#include "dataset/dataset.h"
#include "network/network.h"
#include "training/training.h"

/* Numbers in [-1, 1) from a linear congruential sequence. */
static inline float next_number(uint32_t *sequence) {
    *sequence = *sequence * 1664525u + 1013904223u;
    return (float)(int32_t)*sequence / 2147483648.0f;
}

/* Five launches, row r of launch r mod 5, the last of them held out. Inputs are random, changes 0. */
static inline Dataset *make_dataset(int rows) {
    Dataset *dataset = calloc(1, sizeof *dataset);
    assert_non_null(dataset);
    dataset->rows = rows;
    dataset->inputs = calloc((size_t)rows * PAIR_INPUTS, sizeof(float));
    dataset->changes = calloc((size_t)rows * PAIR_CHANGES, sizeof(float));
    dataset->launch = calloc((size_t)rows, sizeof(int32_t));
    dataset->launches = 5;
    dataset->launch_test = calloc(5, 1);
    assert_true(dataset->inputs && dataset->changes && dataset->launch && dataset->launch_test);
    dataset->launch_test[4] = 1;
    uint32_t sequence = 3;
    for (int r = 0; r < rows; r++) dataset->launch[r] = r % 5;
    for (int i = 0; i < rows * PAIR_INPUTS; i++) dataset->inputs[i] = next_number(&sequence);
    return dataset;
}

/* Changes are the outputs of a 10-4-2 network of sigmoids, as changes of b's velocity: a network of that
   shape can learn them, to the last digit but for the min-max normalisation. */
static inline Dataset *make_taught_dataset(int rows) {
    Error error = {0};
    Dataset *dataset = make_dataset(rows);
    Network *teacher = network_create(2, (const int[]){PAIR_INPUTS, 4, 2}, &error);
    assert_ok(teacher != NULL, error);
    teacher->activations[0] = teacher->activations[1] = ACTIVATION_SIGMOID;
    uint32_t sequence = 11;
    for (int p = 0; p < network_parameter_count(teacher); p++) teacher->weights[0][p] = 3 * next_number(&sequence);
    for (int r = 0; r < rows; r++) {
        float scratch[2 * PAIR_INPUTS];
        network_predict(teacher, dataset->inputs + r * PAIR_INPUTS, scratch, dataset->changes + r * PAIR_CHANGES + 3);
    }
    network_destroy(teacher);
    return dataset;
}

/* To train a 10-4-2 network. */
static inline TrainingOptions small(const char *optimizer, int iterations) {
    return (TrainingOptions){
        .layers = 2, .widths = {PAIR_INPUTS, 4, 2}, .optimizer = optimizer, .iterations = iterations, .seed = 1};
}
