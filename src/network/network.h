/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fully connected networks: layers, normalisation, files, and inference with the same bits on every machine.

   Numbers are float32. A layer's sums run over the inputs in rising order, without BLAS and without fused multiply-add;
   activations are those of activation.h. */
#pragma once
#include "common/error.h"

#include <stddef.h>
#include <stdint.h>

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
