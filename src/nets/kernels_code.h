/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kernels' code; included once by each kernels_*.c, which defines VECTOR_BYTES, the size of a register. First those
   of layers: rows are innermost and independent, so the compiler vectorises
   them without changing the order of sums. In the gradient, each forward step is next to its backward step; B stands
   for BLOCK_ROWS. */
#include "nets/kernels.h"
#include "nets/nets.h"

/* One register, loaded from any address. Explicit, because the compiler keeps an array of sums in memory. */
typedef float Floats __attribute__((vector_size(VECTOR_BYTES), aligned(sizeof(float)), may_alias));
typedef double Doubles __attribute__((vector_size(VECTOR_BYTES), aligned(sizeof(double)), may_alias));

/* ---- Inference: float32. T stands for TILE_ROWS; a tile is always computed whole, so that the compiler knows the
   length of every loop. */

/* Registers for the sums of one output: enough to hide the latency of additions. */
enum { FLOATS = VECTOR_BYTES / sizeof(float), GROUP = 4, GROUP_ROWS = GROUP * FLOATS };
_Static_assert(TILE_ROWS % GROUP_ROWS == 0, "a tile must consist of whole groups");

/* out[outputs, T] = weights[outputs, inputs] in[inputs, T] + biases[outputs] */
static void tile_sums(const float *restrict weights, const float *restrict biases, int inputs, int outputs,
                      const float *restrict in, float *restrict out) {
    for (int j = 0; j < outputs; j++)
        for (int t = 0; t < TILE_ROWS; t += GROUP_ROWS) {
            Floats sums[GROUP];
            for (int v = 0; v < GROUP; v++) sums[v] = biases[j] - (Floats){0};
            for (int i = 0; i < inputs; i++)
                for (int v = 0; v < GROUP; v++)
                    sums[v] += weights[j * inputs + i] * ((const Floats *)(in + i * TILE_ROWS + t))[v];
            for (int v = 0; v < GROUP; v++) ((Floats *)(out + j * TILE_ROWS + t))[v] = sums[v];
        }
}

static void tile_activations(Activation activation, float *values, int count) {
    if (activation == ACTIVATION_SIGMOID)
        for (int i = 0; i < count; i++) values[i] = sigmoid_float(values[i]);
    if (activation == ACTIVATION_TANH)
        for (int i = 0; i < count; i++) values[i] = tanh_float(values[i]);
    if (activation == ACTIVATION_RELU)
        for (int i = 0; i < count; i++) values[i] = relu_float(values[i]);
}

static void predict(const Network *network, const float *inputs, float *scratch, float *outputs, int rows, int first,
                    int count) {
    /* Aligned: a vector across two cache lines takes two loads. NOLINTNEXTLINE(performance-no-int-to-ptr) */
    float *in = (float *)(((uintptr_t)scratch + CACHE_LINE - 1) & ~(uintptr_t)(CACHE_LINE - 1));
    float *out = in + network_scratch_width(network) * TILE_ROWS;
    for (int i = 0; i < network->widths[0]; i++) {
        const float *from = inputs + (size_t)i * (size_t)rows + first;
        const float offset = network->input.offset[i], scale = network->input.scale[i];
        for (int t = 0; t < count; t++) in[i * TILE_ROWS + t] = (from[t] - offset) * scale;
        for (int t = count; t < TILE_ROWS; t++) in[i * TILE_ROWS + t] = 0;
    }
    for (int l = 0; l < network->layers; l++) {
        const int outs = network->widths[l + 1];
        tile_sums(network->weights[l], network->biases[l], network->widths[l], outs, in, out);
        tile_activations(network->activations[l], out, outs * TILE_ROWS);
        float *swap = in;
        in = out;
        out = swap;
    }
    for (int k = 0; k < network->widths[network->layers]; k++) {
        float *to = outputs + (size_t)k * (size_t)rows + first;
        const float offset = network->output.offset[k], scale = network->output.scale[k];
        for (int t = 0; t < count; t++) to[t] = in[k * TILE_ROWS + t] / scale + offset;
    }
}

/* ---- Training: double. */

/* Partial sums of a sum over rows, and the number of sums computed together: the same on every machine, in one to four
   registers. */
enum { LANES = 8, DOUBLES = VECTOR_BYTES / sizeof(double), PARTS = LANES / DOUBLES };

static size_t parameter_count(const Network *shape, int l) {
    return (size_t)shape->widths[l + 1] * (size_t)(shape->widths[l] + 1);
}

/* sums[B] = start + sum over k of weights[k * weight_step] * values[k, B] */
static void weighted_sum(double *restrict sums, double start, const double *restrict weights, int weight_step,
                         const double *restrict values, int count) {
    for (int r = 0; r < BLOCK_ROWS; r += 2 * LANES) {
        Doubles part[2 * PARTS];
        for (int v = 0; v < 2 * PARTS; v++) part[v] = start - (Doubles){0};
        for (int k = 0; k < count; k++) {
            double weight = weights[(size_t)k * (size_t)weight_step];
            const Doubles *value = (const Doubles *)(values + (size_t)k * BLOCK_ROWS + r);
            for (int v = 0; v < 2 * PARTS; v++) part[v] += weight * value[v];
        }
        for (int v = 0; v < 2 * PARTS; v++) ((Doubles *)(sums + r))[v] = part[v];
    }
}

static double total(const Doubles part[PARTS]) {
    const double *lane = (const double *)part;
    return ((lane[0] + lane[1]) + (lane[2] + lane[3])) + ((lane[4] + lane[5]) + (lane[6] + lane[7]));
}

/* Sum of a[B] */
static double row_sum(const double *a) {
    Doubles part[PARTS] = {{0}};
    for (int r = 0; r < BLOCK_ROWS; r += LANES)
        for (int v = 0; v < PARTS; v++) part[v] += ((const Doubles *)(a + r))[v];
    return total(part);
}

static double dot(const double *a, const double *b) {
    Doubles part[PARTS] = {{0}};
    for (int r = 0; r < BLOCK_ROWS; r += LANES)
        for (int v = 0; v < PARTS; v++) part[v] += ((const Doubles *)(a + r))[v] * ((const Doubles *)(b + r))[v];
    return total(part);
}

/* y = activation(x), in place */
static void activation_forward(Activation activation, double *values, size_t count) {
    if (activation == ACTIVATION_SIGMOID)
        for (size_t i = 0; i < count; i++) values[i] = sigmoid(values[i]);
    if (activation == ACTIVATION_TANH)
        for (size_t i = 0; i < count; i++) values[i] = tangent(values[i]);
    if (activation == ACTIVATION_RELU)
        for (size_t i = 0; i < count; i++) values[i] = relu(values[i]);
}

/* d loss / dx = d loss / dy * dy / dx, in place; all derivatives follow from y alone. That of ReLU at 0 is 0. */
static void activation_backward(Activation activation, const double *restrict values, double *restrict deltas,
                                size_t count) {
    if (activation == ACTIVATION_SIGMOID)
        for (size_t i = 0; i < count; i++) deltas[i] *= values[i] * (1 - values[i]);
    if (activation == ACTIVATION_TANH)
        for (size_t i = 0; i < count; i++) deltas[i] *= 1 - values[i] * values[i];
    if (activation == ACTIVATION_RELU)
        for (size_t i = 0; i < count; i++) deltas[i] = values[i] > 0 ? deltas[i] : 0;
}

/* out[outputs, B] = weights[outputs, inputs] in[inputs, B] + biases[outputs] */
static void layer_forward(const double *parameters, int inputs, int outputs, const double *in, double *out) {
    const double *biases = parameters + (size_t)outputs * (size_t)inputs;
    for (int j = 0; j < outputs; j++)
        weighted_sum(out + (size_t)j * BLOCK_ROWS, biases[j], parameters + (size_t)j * (size_t)inputs, 1, in, inputs);
}

/* delta_in[inputs, B] = weights^T[inputs, outputs] delta_out[outputs, B] */
static void layer_backward(const double *parameters, int inputs, int outputs, const double *delta_out,
                           double *delta_in) {
    for (int i = 0; i < inputs; i++)
        weighted_sum(delta_in + (size_t)i * BLOCK_ROWS, 0, parameters + i, inputs, delta_out, outputs);
}

static void forward(NetworkBlock *block, const double *parameters) {
    const Network *shape = block->shape;
    for (int l = 0; l < shape->layers; l++) {
        layer_forward(parameters, shape->widths[l], shape->widths[l + 1], block->values[l], block->values[l + 1]);
        activation_forward(shape->activations[l], block->values[l + 1], (size_t)shape->widths[l + 1] * BLOCK_ROWS);
        parameters += parameter_count(shape, l);
    }
}

static void backward(NetworkBlock *block, const double *parameters) {
    const Network *shape = block->shape;
    for (int l = 0; l < shape->layers; l++) parameters += parameter_count(shape, l);
    for (int l = shape->layers - 1; l >= 0; l--) {
        parameters -= parameter_count(shape, l);
        activation_backward(shape->activations[l], block->values[l + 1], block->deltas[l],
                            (size_t)shape->widths[l + 1] * BLOCK_ROWS);
        if (l > 0)
            layer_backward(parameters, shape->widths[l], shape->widths[l + 1], block->deltas[l], block->deltas[l - 1]);
    }
}

static void backward_to_inputs(const NetworkBlock *block, const double *parameters, double *slopes) {
    layer_backward(parameters, block->shape->widths[0], block->shape->widths[1], block->deltas[0], slopes);
}

static void add_gradient(const NetworkBlock *block, double *gradient) {
    const Network *shape = block->shape;
    for (int l = 0; l < shape->layers; l++) {
        const double *delta = block->deltas[l];
        for (int j = 0; j < shape->widths[l + 1]; j++)
            for (int i = 0; i < shape->widths[l]; i++)
                *gradient++ += dot(delta + (size_t)j * BLOCK_ROWS, block->values[l] + (size_t)i * BLOCK_ROWS);
        for (int j = 0; j < shape->widths[l + 1]; j++) *gradient++ += row_sum(delta + (size_t)j * BLOCK_ROWS);
    }
}

#include "nets/gns_kernels_code.h"
#include "nets/row_kernels_code.h"

const Kernels KERNELS = {KERNELS_NAME,
                         predict,
                         forward,
                         backward,
                         backward_to_inputs,
                         add_gradient,
                         dot,
                         {add, combine, row_multiply, spread, apply_tanh},
                         {gns_multiply, gns_add_gradient, add_rows, add_to_rows, gns_relu, normalise, normalise_back}};
