/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Dataset rows -> normalised blocks. */
#include "training/samples.h"

#include <math.h>
#include <stdlib.h>

static float input_at(const Dataset *dataset, int64_t row, int column) {
    return dataset->inputs[row * dataset_inputs(dataset) + column];
}

static float target_at(const Dataset *dataset, int64_t row, int outputs, int column) {
    const float *changes = dataset->changes + row * pair_change_count(dataset->target);
    return outputs == pair_change_count(dataset->target) ? changes[column] : changes[column + 3] - changes[column];
}

typedef struct Spread {
    double minimum, maximum, mean, deviation;
} Spread;

/* Over the training rows; outputs == 0 selects an input column. Two passes: with one, the rounding of the squares would
   swamp the deviation of a column far from 0. */
static Spread column_spread(const Dataset *dataset, int outputs, int column) {
    Spread spread = {.minimum = INFINITY, .maximum = -INFINITY};
    for (int pass = 0; pass < 2; pass++) {
        double sum = 0;
        int64_t count = 0;
        for (int64_t row = 0; row < dataset->rows; row++) {
            if (dataset_is_test(dataset, row)) continue;
            double x = outputs == 0 ? input_at(dataset, row, column) : target_at(dataset, row, outputs, column);
            spread.minimum = fmin(spread.minimum, x);
            spread.maximum = fmax(spread.maximum, x);
            sum += pass == 0 ? x : (x - spread.mean) * (x - spread.mean);
            count++;
        }
        if (pass == 0)
            spread.mean = sum / (double)count;
        else
            spread.deviation = sqrt(sum / (double)count);
    }
    return spread;
}

/* A constant column has a width of exactly 0: sums of equal float32 are exact in double. */
static void set_scale(Normalisation *normalisation, int column, double offset, double width) {
    float scale = (float)(1 / width);
    normalisation->offset[column] = (float)offset;
    normalisation->scale[column] = isfinite(scale) && scale > 0 ? scale : 1;
}

void samples_fit_normalisation(const Dataset *dataset, OutputScale scale, Network *network) {
    int outputs = network->widths[network->layers];
    for (int i = 0; i < network->widths[0]; i++) {
        Spread spread = column_spread(dataset, 0, i);
        set_scale(&network->input, i, spread.mean, spread.deviation);
    }
    for (int k = 0; k < outputs; k++) {
        Spread spread = column_spread(dataset, outputs, k);
        network->output_mean[k] = (float)spread.mean;
        if (scale == SCALE_STANDARD)
            set_scale(&network->output, k, spread.mean, spread.deviation);
        else
            set_scale(&network->output, k, spread.minimum, spread.maximum - spread.minimum);
    }
}

/* The same float32 expression as in network_predict(), so that training and inference see the same inputs. */
static float normalise(const Normalisation *normalisation, int column, float x) {
    return (x - normalisation->offset[column]) * normalisation->scale[column];
}

static void store_row(Samples *samples, int64_t to, const Dataset *dataset, int64_t row, const Network *network) {
    int64_t b = to / BLOCK_ROWS, r = to % BLOCK_ROWS;
    for (int i = 0; i < samples->inputs; i++)
        samples->x[(b * samples->inputs + i) * BLOCK_ROWS + r] =
            normalise(&network->input, i, input_at(dataset, row, i));
    for (int k = 0; k < samples->outputs; k++)
        samples->y[(b * samples->outputs + k) * BLOCK_ROWS + r] =
            normalise(&network->output, k, target_at(dataset, row, samples->outputs, k));
}

Samples *samples_create(const Dataset *dataset, const Network *network, bool test, Error *error) {
    Samples *samples = calloc(1, sizeof *samples);
    if (samples == NULL) return error_memory(error, "training"), NULL;
    samples->inputs = network->widths[0];
    samples->outputs = network->widths[network->layers];
    for (int64_t row = 0; row < dataset->rows; row++) samples->rows += dataset_is_test(dataset, row) == test;
    samples->blocks = (samples->rows + BLOCK_ROWS - 1) / BLOCK_ROWS;
    size_t padded = (size_t)samples->blocks * BLOCK_ROWS;
    samples->x = calloc(padded * (size_t)samples->inputs, sizeof *samples->x);
    samples->y = calloc(padded * (size_t)samples->outputs, sizeof *samples->y);
    if (samples->x == NULL || samples->y == NULL)
        return error_memory(error, "training"), samples_destroy(samples), NULL;
    int64_t to = 0;
    for (int64_t row = 0; row < dataset->rows; row++)
        if (dataset_is_test(dataset, row) == test) store_row(samples, to++, dataset, row, network);
    return samples;
}

void samples_destroy(Samples *samples) {
    if (samples == NULL) return;
    free(samples->x);
    free(samples->y);
    free(samples);
}

static const float *target_column(const Samples *samples, int64_t b, int k) {
    return samples->y + (b * samples->outputs + k) * BLOCK_ROWS;
}

void samples_mean(const Samples *samples, double *mean) {
    for (int k = 0; k < samples->outputs; k++) {
        double sum = 0;
        for (int64_t b = 0; b < samples->blocks; b++)
            for (int r = 0; r < samples_in_block(samples, b); r++) sum += target_column(samples, b, k)[r];
        mean[k] = sum / (double)samples->rows;
    }
}
