/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "network/network_gradient.h"

#include "network/kernels.h"

#include <stdlib.h>
#include <string.h>

NetworkBlock *network_block_create(const Network *shape, Error *error) {
    size_t widths = (size_t)shape->widths[0];
    for (int l = 0; l < shape->layers; l++) widths += 2 * (size_t)shape->widths[l + 1];
    NetworkBlock *block = calloc(1, sizeof *block);
    size_t size = widths * BLOCK_ROWS * sizeof(double);
    double *numbers = aligned_alloc(CACHE_LINE, size);
    if (block == NULL || numbers == NULL) return error_memory(error, "network"), free(block), free(numbers), NULL;
    memset(numbers, 0, size);
    block->shape = shape;
    for (int l = 0; l <= shape->layers; l++) {
        block->values[l] = numbers;
        numbers += shape->widths[l] * BLOCK_ROWS;
    }
    for (int l = 0; l < shape->layers; l++) {
        block->deltas[l] = numbers;
        numbers += shape->widths[l + 1] * BLOCK_ROWS;
    }
    return block;
}

void network_block_destroy(NetworkBlock *block) {
    if (block == NULL) return;
    free(block->values[0]);
    free(block);
}

void network_forward(NetworkBlock *block, const double *parameters) { kernels_best()->forward(block, parameters); }

void network_backward(NetworkBlock *block, const double *parameters) { kernels_best()->backward(block, parameters); }

void network_backward_to_inputs(const NetworkBlock *block, const double *parameters, double *slopes) {
    kernels_best()->backward_to_inputs(block, parameters, slopes);
}

void network_add_gradient(const NetworkBlock *block, double *gradient) {
    kernels_best()->add_gradient(block, gradient);
}

double network_block_dot(const double *a, const double *b) { return kernels_best()->dot(a, b); }
