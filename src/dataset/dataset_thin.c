/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dataset/dataset_thin.h"

#include <string.h>

void dataset_thin(Dataset *dataset, int every) {
    const size_t inputs = (size_t)dataset_inputs(dataset), changes = (size_t)pair_change_count(dataset->target);
    int64_t to = 0;
    for (int64_t row = 0; row < dataset->rows; row += every, to++) {
        memmove(dataset->inputs + (size_t)to * inputs, dataset->inputs + (size_t)row * inputs, inputs * sizeof(float));
        memmove(dataset->changes + (size_t)to * changes, dataset->changes + (size_t)row * changes,
                changes * sizeof(float));
        dataset->launch[to] = dataset->launch[row];
        dataset->frame[to] = dataset->frame[row];
        memmove(dataset->bodies + 2 * to, dataset->bodies + 2 * row, 2 * sizeof *dataset->bodies);
    }
    dataset->rows = to;
}
