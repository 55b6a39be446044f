/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Networks of layers: inference, gradients, files.

       Network *network = network_read("pair-net.npz", error);
       network_predict(network, input, scratch, output); // scratch: 2 network_scratch_width() floats
*/
#pragma once
#include "base/base.h"
#include "nets/activation.h"
#include "nets/net_file.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* Fully connected networks: layers, normalisation, files, and inference with the same bits on every machine.

   Numbers are float32. A layer's sums run over the inputs in rising order, without BLAS and without fused multiply-add;
   activations are those of nets/activation.h. */

enum { NETWORK_VERSION = 3, NETWORK_MAX_LAYERS = 8, NETWORK_MAX_WIDTH = 4096, NETWORK_TEXT_SIZE = 512 };

typedef enum Activation { ACTIVATION_LINEAR, ACTIVATION_SIGMOID, ACTIVATION_TANH, ACTIVATION_RELU } Activation;

/* Min-max normalisation or standardisation: x -> (x - offset) * scale, inverted for outputs: y / scale + offset. */
typedef struct Normalisation {
    float *offset, *scale; /* [width]; scale > 0 */
} Normalisation;

/* All numbers are in one block that begins at weights[0]: weights_0, biases_0, weights_1, ..., normalisations. */
typedef struct Network {
    int layers;                         /* of weights: 2 for 10-10-2 */
    int widths[NETWORK_MAX_LAYERS + 1]; /* inputs, hidden ..., outputs */
    Activation activations[NETWORK_MAX_LAYERS];
    float *weights[NETWORK_MAX_LAYERS]; /* [widths[l + 1], widths[l]] */
    float *biases[NETWORK_MAX_LAYERS];  /* [widths[l + 1]] */
    Normalisation input, output;
    float *output_mean;              /* [outputs] mean of the training data, in their units: the constant predictor */
    char inputs[NETWORK_TEXT_SIZE];  /* names of the inputs: "dx dy v1x v1y ..." */
    char outputs[NETWORK_TEXT_SIZE]; /* names of the outputs: "dvx dvy" */
    char target[NETWORK_TEXT_SIZE];  /* the target: "pair" */
    char command[NETWORK_TEXT_SIZE]; /* the command that made it */
} Network;

/* Weights and biases are 0, normalisations the identity. widths has layers + 1 numbers. */
Network *network_create(int layers, const int *widths, Error *error);
Network *network_copy(const Network *network, Error *error);
void network_destroy(Network *network);

/* Number of weights and biases. */
int network_parameter_count(const Network *network);

/* Inference; inputs and outputs in the units of the data. input[widths[0]], output[last width]; scratch holds at least
   2 * network_scratch_width() floats. */
int network_scratch_width(const Network *network);
void network_predict(const Network *network, const float *input, float *scratch, float *output);

/* The same for many rows at once, faster, with the same bits. Rows are innermost: inputs[widths[0], rows], outputs[last
   width, rows]. scratch holds at least network_batch_scratch() floats. */
size_t network_batch_scratch(const Network *network);
void network_predict_batch(const Network *network, const float *inputs, float *scratch, float *outputs, int rows);

bool network_write(const Network *network, const char *path, Error *error);

/* ERROR_INPUT, naming the file, if it is damaged, of another version, has widths that are out of range or inconsistent,
   or holds a NaN or infinite number. */
Network *network_read(const char *path, Error *error);

/* Forward and backward pass in double, for training: a block of rows at a time, with the rows innermost, so that the
   compiler vectorises the sums without changing their order. Rumelhart, Hinton, Williams, "Learning representations by
   back-propagating errors" (1986).

   Parameters are one vector in the order of the network's own block: weights_0 [widths[1], widths[0]], biases_0,
   weights_1, ... The same input gives the same bits for any number of threads. */

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
