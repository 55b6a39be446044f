/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Networks of layers: activations in a fixed order of operations, inference, gradients, files. */
#pragma once
#include "base/base.h"
#include "base/npz.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* Sigmoid, tanh, ReLU and e^y in a fixed sequence of operations, so that the bits do not depend on maths library,
   compiler or instruction set, and without calls or branches, so that the compiler vectorises loops over them.

   float32 for inference: within 3 units in the last place of a normal result (a sigmoid below 2^-127 is 0). In double a
   correctly rounded activation would cost more than the rest of a network. double for training: within 4e-16 of the
   result.

   e^y = 2^k e^r with k the integer nearest to y / ln 2: ln 2 is subtracted in two parts, the first short enough for its
   multiples to be exact (Cody and Waite, "Software Manual for the Elementary Functions", 1980). The polynomial is e^r =
   1 + r + r^2 g(r), g interpolated at the Chebyshev nodes of |r| <= ln 2 / 2; its error is 1.0e-8 in float32, 1.7e-17
   in double. Adding 1.5 * 2^23 (2^52 in double) rounds to an integer and leaves it in the low bits of the sum. */

/* Returns e^r - 1, and 2^k in *power; y in [-87, 88.8], where k = 128 gives infinity; NaN stays NaN. */
static inline float exp_parts_float(float y, float *power) {
    const float shift = 0x1.8p23f + 127; /* 127: the bias of the exponent */
    float sum = y * 0x1.715476p0f + shift, k = sum - shift;
    float r = (y - k * 0x1.62e4p-1f) - k * 0x1.7f7d1cp-20f;
    uint32_t bits;
    memcpy(&bits, &sum, sizeof bits);
    bits <<= 23;
    memcpy(power, &bits, sizeof bits);
    float r2 = r * r;
    float g = (0.5f + 0x1.5554dcp-3f * r) + r2 * ((0x1.555518p-5f + 0x1.120be2p-7f * r) + r2 * 0x1.6d117cp-10f);
    return r + r2 * g;
}

/* The same for y in [-700, 700]. */
static inline double exp_parts(double y, double *power) {
    const double shift = 0x1.8p52 + 1023;
    double sum = y * 0x1.71547652b82fep0 + shift, k = sum - shift;
    double r = (y - k * 0x1.62e42fefa2000p-1) - k * 0x1.9ef35793c7673p-41;
    uint64_t bits;
    memcpy(&bits, &sum, sizeof bits);
    bits <<= 52;
    memcpy(power, &bits, sizeof bits);
    double r2 = r * r, r4 = r2 * r2;
    double g0 = (0.5 + 0x1.5555555555556p-3 * r) + r2 * (0x1.5555555553d37p-5 + 0x1.11111111109a6p-7 * r);
    double g4 =
        (0x1.6c16c1789d1d7p-10 + 0x1.a01a01a7cebcdp-13 * r) + r2 * (0x1.a019b8ca26fcfp-16 + 0x1.71de0d85293b8p-19 * r);
    double g8 = 0x1.2891d4ffbb0f9p-22 + 0x1.af390ba7e6f47p-26 * r;
    return r + r2 * (g0 + r4 * (g4 + r4 * g8));
}

/* e^y for y in [-700, 700], within 1.25 units in the last place; NaN stays NaN. */
static inline double exponential(double y) {
    double power, q = exp_parts(y, &power);
    return power * (1.0 + q);
}

/* Comparisons are written so that NaN propagates. */
static inline float sigmoid_float(float x) {
    float y = -x > 88.8f ? 88.8f : -x, power, q = exp_parts_float(y, &power), e = power * (1.0f + q);
    return 1.0f / (1.0f + (x > 87.0f ? 0.0f : e)); /* e^-87 is negligible beside 1 */
}

static inline double sigmoid(double x) {
    double e = exponential(-x > 700.0 ? 700.0 : -x);
    return 1.0 / (1.0 + (x > 700.0 ? 0.0 : e));
}

/* (e^y - 1) / (e^y + 1) with y = 2 |x|; e^y - 1 = 2^k (e^r - 1) + (2^k - 1) keeps full precision near 0. */
static inline float tanh_float(float x) {
    float y = 2.0f * fabsf(x), power;
    y = y > 20.0f ? 20.0f : y;
    float q = exp_parts_float(y, &power), e = power * q + (power - 1.0f);
    return copysignf(e / (e + 2.0f), x);
}

static inline double tangent(double x) {
    double y = 2.0 * fabs(x), power;
    y = y > 40.0 ? 40.0 : y;
    double q = exp_parts(y, &power), e = power * q + (power - 1.0);
    return copysign(e / (e + 2.0), x);
}

/* max(x, 0); NaN stays NaN, and -0 stays -0. */
static inline float relu_float(float x) { return x < 0.0f ? 0.0f : x; }

static inline double relu(double x) { return x < 0.0 ? 0.0 : x; }

/* Files of networks: .npz with version, kind, and the fields of the kind in the order of its list. Each kind names its
   fields once, for writing and for reading. */

/* The range of float32 numbers, which must be finite. */
typedef struct FloatBounds {
    float least, most;
    const char *words; /* "it must be ..." */
} FloatBounds;

extern const FloatBounds float_any, float_positive, float_not_negative, float_momentum;

typedef struct NetField {
    char name[24];
    NpzType type;
    int rank;
    int64_t shape[2]; /* of a text: the bytes of its array */
    void *data;       /* the network's array, at least of the shape's size; before it is created, its shape suffices */
    const FloatBounds *range; /* of float32; float64 must be finite */
    bool known;               /* only written: its reader is read_sizes */
    bool shown;               /* a text without control characters, as it is displayed */
} NetField;

enum { NET_FIELDS_MAX = 40 };

typedef struct NetFileKind {
    const char *name;
    int32_t version;
    int (*list)(void *net, NetField fields[NET_FIELDS_MAX]); /* returns their number */
    /* Reads what the shapes follow from, before memory is taken: a file can claim any shape. NULL: shapes are
       constant. */
    bool (*read_sizes)(void *net, NpzFile *file, Error *error);
    bool (*create)(void *net, Error *error);                  /* its arrays, once the file has all; NULL: they exist */
    bool (*check)(void *net, const char *path, Error *error); /* what is read; NULL: the ranges suffice */
} NetFileKind;

bool net_file_write(const NetFileKind *kind, const void *net, const char *path, Error *error);

/* ERROR_INPUT, naming the file, if it is damaged, of another kind or version, or has a field of another shape or
   range. */
bool net_file_read(const NetFileKind *kind, void *net, const char *path, Error *error);

/* The field in the file. */
NpzArray net_field_array(const NetField *field);

/* Reads fields, after a look at all their shapes; an error names the file, the field and the number. */
bool net_fields_read(NpzFile *file, const NetField *fields, int count, Error *error);

/* For read_sizes: a vector of least to most int32 numbers, of which it returns the number, or 0 with error set; a
   scalar. */
int net_file_integers(NpzFile *file, const char *name, int least, int most, int32_t *numbers, Error *error);
bool net_file_integer(NpzFile *file, const char *name, int *number, Error *error);

/* Fully connected networks: layers, normalisation, files, and inference with the same bits on every machine.

   Numbers are float32. A layer's sums run over the inputs in rising order, without BLAS and without fused multiply-add;
   activations are those above. */

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
