/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Synthetic datasets. */
#pragma once
#include "made.h"

#include "learning/dataset.h"
#include "learning/pair_training.h"

/* Numbers in [-1, 1) from a linear congruential sequence. */
static inline float next_number(uint32_t *sequence) {
    *sequence = *sequence * 1664525u + 1013904223u;
    return (float)(int32_t)*sequence / 2147483648.0f;
}

/* Five launches, row r of launch r mod 5, the last of them held out. Inputs are random, changes 0. */
static inline Dataset *make_dataset(int rows) {
    Dataset *dataset = calloc(1, sizeof *dataset);
    assert_non_null(dataset);
    assert_true(dataset_make_launches(dataset, 5) && dataset_make_rows(dataset, rows, true));
    memset(dataset->changes, 0, (size_t)rows * PAIR_CHANGES * sizeof *dataset->changes);
    dataset->context = NULL;
    dataset->launch_test[4] = 1;
    uint32_t sequence = 3;
    for (int r = 0; r < rows; r++) dataset->launch[r] = r % 5;
    for (int i = 0; i < rows * PAIR_INPUTS; i++) dataset->inputs[i] = next_number(&sequence);
    return dataset;
}

/* Changes of b's velocity are the outputs of a 10-4-2 network of sigmoids: a network of that shape can learn them
   exactly, except for the min-max normalisation. */
static inline Dataset *make_taught_dataset(int rows) {
    Dataset *dataset = make_dataset(rows);
    Network *teacher = network_sized(2, (const int[]){PAIR_INPUTS, 4, 2});
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

/* A random pair context: masses of 2 to 10 kg, every third pair with a static a, every seventh with a static b. */
static inline void draw_context(uint32_t *sequence, int row, float context[PAIR_CONTEXT]) {
    for (int i = 0; i < PAIR_CONTEXT; i++) context[i] = next_number(sequence);
    for (int i = CONTEXT_INV_MASS_A; i <= CONTEXT_INV_INERTIA_B; i++) context[i] = 0.3f + 0.2f * context[i];
    if (row % 3 == 0) context[CONTEXT_INV_MASS_A] = context[CONTEXT_INV_INERTIA_A] = 0;
    if (row % 3 != 0 && row % 7 == 0) context[CONTEXT_INV_MASS_B] = context[CONTEXT_INV_INERTIA_B] = 0;
    const float angle = 3.0f * context[CONTEXT_NORMAL];
    context[CONTEXT_NORMAL] = cosf(angle);
    context[CONTEXT_NORMAL + 1] = sinf(angle);
    context[CONTEXT_FRICTION] = 0.4f + 0.3f * context[CONTEXT_FRICTION];
}

/* Six changes and a context; the inputs contain its normal and velocities. The impulses are equal and opposite and
   within the friction cone; changes of spin are random. */
static inline Dataset *make_pushed_dataset(int rows) {
    Dataset *dataset = make_dataset(rows);
    dataset->context = dataset->changes + rows * PAIR_CHANGES; /* which make_dataset() leaves */
    uint32_t sequence = 17;
    for (int r = 0; r < rows; r++) {
        float *context = dataset->context + r * PAIR_CONTEXT, *change = dataset->changes + r * PAIR_CHANGES;
        draw_context(&sequence, r, context);
        memcpy(dataset->inputs + r * PAIR_INPUTS, context + CONTEXT_NORMAL, 2 * sizeof(float));
        memcpy(dataset->inputs + r * PAIR_INPUTS + 2, context + CONTEXT_VELOCITIES, PAIR_CHANGES * sizeof(float));
        const float along = 2 + next_number(&sequence),
                    across = along * context[CONTEXT_FRICTION] * next_number(&sequence);
        const float n[2] = {context[CONTEXT_NORMAL], context[CONTEXT_NORMAL + 1]};
        const float impulse[2] = {along * n[0] + across * n[1], along * n[1] - across * n[0]};
        for (int i = 0; i < 2; i++) {
            change[i] = -context[CONTEXT_INV_MASS_A] * impulse[i];
            change[3 + i] = context[CONTEXT_INV_MASS_B] * impulse[i];
        }
        change[2] = context[CONTEXT_INV_INERTIA_A] * next_number(&sequence);
        change[5] = context[CONTEXT_INV_INERTIA_B] * next_number(&sequence);
    }
    return dataset;
}

/* A 10-4-2 network. */
static inline TrainingOptions small(const char *optimizer, int iterations) {
    return (TrainingOptions){
        .layers = 2, .widths = {PAIR_INPUTS, 4, 2}, .optimizer = optimizer, .iterations = iterations, .seed = 1};
}
