/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fully connected networks: layers, normalisation, files; inference that gives the same bits everywhere.

   Numbers are float32. A layer's sums run over the inputs in rising order, without BLAS and without
   contraction; activations are those of activation.h. */
#pragma once
#include "common/error.h"

#include <stddef.h>
#include <stdint.h>

enum { NETWORK_VERSION = 3, NETWORK_MAX_LAYERS = 8, NETWORK_MAX_WIDTH = 4096, NETWORK_TEXT_SIZE = 512 };

typedef enum Activation { ACTIVATION_LINEAR, ACTIVATION_SIGMOID, ACTIVATION_TANH, ACTIVATION_RELU } Activation;

/* x -> (x - offset) * scale, number by number: min-max or standardisation. Undone on outputs:
   y / scale + offset. */
typedef struct Normalisation {
    float *offset, *scale; /* [width]; scale > 0 */
} Normalisation;

/* All numbers are one block that begins at weights[0]: weights_0, biases_0, weights_1, ...,
   normalisations. */
typedef struct Network {
    int layers;                         /* of weights: 2 for 10-10-2 */
    int widths[NETWORK_MAX_LAYERS + 1]; /* inputs, hidden ..., outputs */
    Activation activations[NETWORK_MAX_LAYERS];
    float *weights[NETWORK_MAX_LAYERS]; /* [widths[l + 1], widths[l]] */
    float *biases[NETWORK_MAX_LAYERS];  /* [widths[l + 1]] */
    Normalisation input, output;
    float *output_mean; /* [outputs] of the data it was trained on, in their units: what a constant would say */
    char inputs[NETWORK_TEXT_SIZE];  /* what goes in: "dx dy v1x v1y ..." */
    char outputs[NETWORK_TEXT_SIZE]; /* what comes out: "dvx dvy" */
    char target[NETWORK_TEXT_SIZE];  /* and of what: "pair" */
    char command[NETWORK_TEXT_SIZE]; /* the command that made it */
} Network;

/* Weights, biases zero; normalisations the identity. widths has layers + 1 numbers. */
Network *network_create(int layers, const int *widths, Error *error);
Network *network_copy(const Network *network, Error *error);
void network_destroy(Network *network);

/* Number of weights and biases. */
int network_parameter_count(const Network *network);

/* Outputs in the units of the data for inputs in the units of the data. input[widths[0]], output[last width];
   scratch holds at least 2 * network_scratch_width() floats. */
int network_scratch_width(const Network *network);
void network_predict(const Network *network, const float *input, float *scratch, float *output);

/* The same for many rows at once, faster, with the same bits: inputs[widths[0], rows], number by number, as vector
   instructions take them; outputs[last width, rows]. scratch holds at least network_batch_scratch() floats. */
size_t network_batch_scratch(const Network *network);
void network_predict_batch(const Network *network, const float *inputs, float *scratch, float *outputs, int rows);

bool network_write(const Network *network, const char *path, Error *error);

/* ERROR_INPUT, naming the file, for what is damaged, of another version, of widths out of range or that do
   not fit, or holds a number that is not finite. */
Network *network_read(const char *path, Error *error);
