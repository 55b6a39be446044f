/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Forward and backward pass in double, for training: a block of rows at a time, with the rows innermost, so that the
   compiler vectorises the sums without changing their order. Rumelhart, Hinton, Williams, "Learning representations by
   back-propagating errors" (1986).

   Parameters are one vector in the order of the network's own block: weights_0 [widths[1], widths[0]], biases_0,
   weights_1, ... The same input gives the same bits for any number of threads. */
#pragma once
#include "network/network.h"

#include <stddef.h>

/* A multiple of 8. 128 rows of 10-10-2 take 40 kB, which stay in the L1 and L2 caches. */
enum { BLOCK_ROWS = 128 };

typedef struct NetworkBlock {
    const Network *shape;                   /* widths and activations; its weights are not used */
    double *values[NETWORK_MAX_LAYERS + 1]; /* [widths[l], BLOCK_ROWS]: normalised inputs, then each layer's outputs */
    double *deltas[NETWORK_MAX_LAYERS];     /* [widths[l + 1], BLOCK_ROWS]: d loss / d (sum before layer l's
                                           activation) */
} NetworkBlock;

/* The shape must outlive the block. */
NetworkBlock *network_block_create(const Network *shape, Error *error);
void network_block_destroy(NetworkBlock *block);

/* Forward pass: from values[0] to values[layers]. */
void network_forward(NetworkBlock *block, const double *parameters);

/* Backward pass, after a forward pass: from d loss / d output, which the caller has written to deltas[layers - 1], to
   the deltas of all layers. */
void network_backward(NetworkBlock *block, const double *parameters);

/* After a backward pass: fills slopes[widths[0], BLOCK_ROWS], d loss / d (normalised) inputs. */
void network_backward_to_inputs(const NetworkBlock *block, const double *parameters, double *slopes);

/* After a backward pass: adds d loss / d parameters, summed over the rows, to gradient. Unused rows must have d loss /
   d output = 0. */
void network_add_gradient(const NetworkBlock *block, double *gradient);

/* Sum over the rows of a[BLOCK_ROWS] * b[BLOCK_ROWS], in one order on every machine. */
double network_block_dot(const double *a, const double *b);
