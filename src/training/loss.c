/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sums over all rows in parallel. Own loops instead of BLAS: the same bits on any machine, and as fast for layers of
   ten units (products of 10^6 rows of 10-10-2: 0.033 s; OpenBLAS: 0.043 s). */
#include "training/loss.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Enough chunks to keep many cores busy. Large networks have fewer, because each chunk stores a gradient. */
enum { MAX_CHUNKS = 32, MAX_GRADIENT_NUMBERS = 1 << 23 };

/* A range of rows, summed by one thread. */
typedef struct Chunk {
    NetworkBlock *block;
    double *gradient; /* [parameters] */
    double sum;       /* of the losses */
} Chunk;

struct Loss {
    int parameters, outputs, last; /* last: index of the last layer */
    double *thresholds;            /* [outputs] |d| beyond which the loss is linear; infinity for mse */
    int chunk_count;
    Chunk chunks[MAX_CHUNKS];
};

/* Returns the loss of one error and replaces the error by half the loss's slope: the error, clamped to the threshold.
   An infinite threshold gives exactly the square and the error. */
static double error_loss(double *error, double threshold) {
    double size = fabs(*error), inner = size < threshold ? size : threshold;
    *error = copysign(inner, *error);
    return inner * (2 * size - inner);
}

static bool set_thresholds(Loss *loss, const Network *shape, LossKind kind) {
    loss->thresholds = malloc((size_t)loss->outputs * sizeof *loss->thresholds);
    for (int k = 0; loss->thresholds != NULL && k < loss->outputs; k++)
        loss->thresholds[k] = kind == LOSS_MSE ? INFINITY : SMOOTH_L1_THRESHOLD * (double)shape->output.scale[k];
    return loss->thresholds != NULL;
}

Loss *loss_create(const Network *shape, LossKind kind, Error *error) {
    Loss *loss = calloc(1, sizeof *loss);
    if (loss == NULL) return error_memory(error, "training"), NULL;
    loss->parameters = network_parameter_count(shape);
    loss->last = shape->layers - 1;
    loss->outputs = shape->widths[shape->layers];
    if (!set_thresholds(loss, shape, kind)) return error_memory(error, "training"), loss_destroy(loss), NULL;
    int affordable = MAX_GRADIENT_NUMBERS / loss->parameters;
    loss->chunk_count = affordable < 1 ? 1 : affordable < MAX_CHUNKS ? affordable : MAX_CHUNKS;
    for (int c = 0; c < loss->chunk_count; c++) {
        loss->chunks[c].block = network_block_create(shape, error);
        loss->chunks[c].gradient = calloc((size_t)loss->parameters, sizeof(double));
        if (loss->chunks[c].block == NULL || loss->chunks[c].gradient == NULL)
            return error_memory(error, "training"), loss_destroy(loss), NULL;
    }
    return loss;
}

void loss_destroy(Loss *loss) {
    if (loss == NULL) return;
    for (int c = 0; c < loss->chunk_count; c++) {
        network_block_destroy(loss->chunks[c].block);
        free(loss->chunks[c].gradient);
    }
    free(loss->thresholds);
    free(loss);
}

void loss_forward(NetworkBlock *block, const Samples *samples, int64_t b, const double *parameters) {
    int count = samples->inputs * BLOCK_ROWS;
    const float *x = samples->x + b * count;
    for (int i = 0; i < count; i++) block->values[0][i] = (double)x[i];
    network_forward(block, parameters);
}

/* Returns the sum of the losses. errors[outputs, BLOCK_ROWS] = half the loss's slope with respect to each prediction
   (for mse: prediction - target), 0 in padding rows. */
static double block_errors(const Loss *loss, const NetworkBlock *block, const Samples *samples, int64_t b,
                           double *errors) {
    const double *prediction = block->values[block->shape->layers];
    const float *target = samples->y + b * samples->outputs * BLOCK_ROWS;
    int rows = samples_in_block(samples, b);
    double sum = 0;
    for (int k = 0; k < samples->outputs; k++)
        for (int r = 0; r < BLOCK_ROWS; r++) {
            int i = k * BLOCK_ROWS + r;
            errors[i] = r < rows ? prediction[i] - (double)target[i] : 0;
            sum += error_loss(&errors[i], loss->thresholds[k]);
        }
    return sum;
}

/* The first block of chunk c; chunk c ends where chunk c + 1 starts. */
static int64_t chunk_start(const Loss *loss, const Samples *samples, int c) {
    return samples->blocks * c / loss->chunk_count;
}

static void sum_chunk(const Loss *loss, Chunk *chunk, const Samples *samples, const Laws *laws, int c,
                      const double *parameters, bool with_gradient) {
    double *errors = chunk->block->deltas[loss->last];
    chunk->sum = 0;
    memset(chunk->gradient, 0, (size_t)loss->parameters * sizeof(double));
    for (int64_t b = chunk_start(loss, samples, c); b < chunk_start(loss, samples, c + 1); b++) {
        loss_forward(chunk->block, samples, b, parameters);
        chunk->sum += block_errors(loss, chunk->block, samples, b, errors);
        if (laws != NULL) chunk->sum += laws_add(laws, chunk->block, b, samples_in_block(samples, b), errors);
        if (!with_gradient) continue;
        network_backward(chunk->block, parameters);
        network_add_gradient(chunk->block, chunk->gradient);
    }
}

static double sum_chunks(Loss *loss, const Samples *samples, const Laws *laws, const double *parameters,
                         bool with_gradient) {
    /* With less than one block per chunk, waking threads costs more than it saves. */
#pragma omp parallel for schedule(dynamic, 1) if (samples->blocks >= loss->chunk_count)
    for (int c = 0; c < loss->chunk_count; c++)
        sum_chunk(loss, &loss->chunks[c], samples, laws, c, parameters, with_gradient);
    double sum = 0;
    for (int c = 0; c < loss->chunk_count; c++) sum += loss->chunks[c].sum;
    return sum / ((double)samples->rows * loss->outputs);
}

double loss_value(Loss *loss, const Samples *samples, const Laws *laws, const double *parameters) {
    return sum_chunks(loss, samples, laws, parameters, false);
}

double loss_gradient(Loss *loss, const Samples *samples, const Laws *laws, const double *parameters, double *gradient) {
    double value = sum_chunks(loss, samples, laws, parameters, true);
    /* 2: the chunks summed half slopes. */
    double factor = 2 / ((double)samples->rows * loss->outputs);
    for (int p = 0; p < loss->parameters; p++) {
        double sum = 0;
        for (int c = 0; c < loss->chunk_count; c++) sum += loss->chunks[c].gradient[p];
        gradient[p] = factor * sum;
    }
    return value;
}

void loss_residuals(Loss *loss, const Samples *samples, const double *parameters, double *residuals) {
#pragma omp parallel for schedule(dynamic, 1) if (samples->blocks >= loss->chunk_count)
    for (int c = 0; c < loss->chunk_count; c++)
        for (int64_t b = chunk_start(loss, samples, c); b < chunk_start(loss, samples, c + 1); b++) {
            loss_forward(loss->chunks[c].block, samples, b, parameters);
            block_errors(loss, loss->chunks[c].block, samples, b, residuals + b * loss->outputs * BLOCK_ROWS);
        }
}

double loss_of_constant(const Loss *loss, const Samples *samples, const double *constant) {
    double sum = 0;
    for (int64_t b = 0; b < samples->blocks; b++)
        for (int k = 0; k < samples->outputs; k++)
            for (int r = 0; r < samples_in_block(samples, b); r++) {
                double error = (double)samples->y[(b * samples->outputs + k) * BLOCK_ROWS + r] - constant[k];
                sum += error_loss(&error, loss->thresholds[k]);
            }
    return sum / ((double)samples->rows * samples->outputs);
}
