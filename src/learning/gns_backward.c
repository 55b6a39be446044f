/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The backward pass of gns: the steps of the forward pass in reverse. */
#include "learning/gns_backward.h"

#include "base/base.h"
#include "methods/gns_graph.h"
#include "nets/kernels.h"
#include "nets/kinds.h"

#include <stdlib.h>
#include <string.h>

/* What all steps of a pass need. */
typedef struct Back {
    GnsBackward *space;
    const GnsKernels *kernels;
    const GnsPass *pass;
    const GnsGraph *graph;
    const float *parameters, *transposed;
    float *gradient;
    int width;
} Back;

void gns_backward_free(GnsBackward *back) {
    free(back->numbers);
    *back = (GnsBackward){0};
}

static void transpose(const float *from, float *to, int rows, int columns) {
    for (int r = 0; r < rows; r++)
        for (int c = 0; c < columns; c++) to[(ptrdiff_t)c * rows + r] = from[(ptrdiff_t)r * columns + c];
}

static void transpose_mlp(const GnsMlp *mlp, const float *parameters, float *transposed) {
    for (int part = 0; part + mlp->width <= mlp->inputs; part += mlp->width) {
        const int at = mlp->weights[0] + part * mlp->width;
        transpose(parameters + at, transposed + at, mlp->width, mlp->width);
    }
    transpose(parameters + mlp->weights[1], transposed + mlp->weights[1], mlp->width, mlp->width);
    transpose(parameters + mlp->weights[2], transposed + mlp->weights[2], mlp->width, mlp->outputs);
}

void gns_transpose(const GnsLayout *layout, const float *parameters, float *transposed) {
    transpose_mlp(&layout->nodes, parameters, transposed);
    transpose_mlp(&layout->edges, parameters, transposed);
    for (int m = 0; m < layout->rounds; m++) {
        transpose_mlp(&layout->edge_rounds[m], parameters, transposed);
        transpose_mlp(&layout->node_rounds[m], parameters, transposed);
    }
    transpose_mlp(&layout->decoder, parameters, transposed);
}

static void add_columns(float *sums, const float *rows, int count, int width) {
    for (int r = 0; r < count; r++)
        for (int j = 0; j < width; j++) sums[j] += rows[(ptrdiff_t)r * width + j];
}

/* Where the unit was cut off, nothing passes. */
static void relu_back(float *slopes, const float *values, int count) {
    for (int i = 0; i < count; i++) slopes[i] = values[i] > 0.0f ? slopes[i] : 0.0f;
}

/* From slopes[rows, outputs], which change, to space->first: d loss / d (sums of the first layer). */
static void mlp_back(const Back *back, const GnsMlp *mlp, const GnsLayerTape *tape, int rows, float *slopes) {
    const GnsKernels *kernels = back->kernels;
    const int width = mlp->width;
    const size_t bytes = (size_t)rows * (size_t)width * sizeof(float);
    float *gradient = back->gradient, *second = back->space->second, *first = back->space->first;
    if (mlp->gain >= 0) { /* the layer norm */
        for (int r = 0; r < rows; r++)
            for (int j = 0; j < mlp->outputs; j++)
                gradient[mlp->gain + j] +=
                    slopes[(ptrdiff_t)r * mlp->outputs + j] * tape->normalised[(ptrdiff_t)r * mlp->outputs + j];
        add_columns(gradient + mlp->offset, slopes, rows, mlp->outputs);
        kernels->normalise_back(slopes, tape->normalised, tape->inverse, back->parameters + mlp->gain, rows,
                                mlp->outputs);
    }
    kernels->add_gradient(gradient + mlp->weights[2], tape->second, slopes, rows, width, mlp->outputs);
    add_columns(gradient + mlp->biases[2], slopes, rows, mlp->outputs);
    memset(second, 0, bytes);
    kernels->multiply(second, slopes, back->transposed + mlp->weights[2], NULL, rows, mlp->outputs, width);
    relu_back(second, tape->second, rows * width);
    kernels->add_gradient(gradient + mlp->weights[1], tape->first, second, rows, width, width);
    add_columns(gradient + mlp->biases[1], second, rows, width);
    memset(first, 0, bytes);
    kernels->multiply(first, second, back->transposed + mlp->weights[1], NULL, rows, width, width);
    relu_back(first, tape->first, rows * width);
}

/* One part of the inputs of a first layer: its weights' gradient from in[rows, width] and sums[rows, width]; adds the
   slopes of `in` to of_in. */
static void part_back(const Back *back, const GnsMlp *mlp, int part, const float *in, const float *sums, int rows,
                      float *of_in) {
    const int width = back->width;
    const ptrdiff_t at = mlp->weights[0] + (ptrdiff_t)part * width * width;
    back->kernels->add_gradient(back->gradient + at, in, sums, rows, width, width);
    back->kernels->multiply(of_in, sums, back->transposed + at, NULL, rows, width, width);
}

static void nodes_back(const Back *back, const GnsMlp *mlp, int m) {
    GnsBackward *space = back->space;
    const int nodes = back->graph->nodes;
    const size_t bytes = (size_t)nodes * (size_t)back->width * sizeof(float);
    memcpy(space->slopes, space->of_node, bytes);
    mlp_back(back, mlp, &back->pass->node_rounds[m], nodes, space->slopes);
    add_columns(back->gradient + mlp->biases[0], space->first, nodes, back->width);
    memset(space->of_sum, 0, bytes);
    part_back(back, mlp, 0, back->pass->node[m], space->first, nodes, space->of_node);
    part_back(back, mlp, 1, back->pass->sum[m], space->first, nodes, space->of_sum);
}

static void messages_back(const Back *back, const GnsMlp *mlp, int m) {
    GnsBackward *space = back->space;
    const GnsGraph *graph = back->graph;
    const int width = back->width;
    const size_t bytes = (size_t)graph->nodes * (size_t)width * sizeof(float);
    memcpy(space->slopes, space->of_edge, (size_t)graph->edges * (size_t)width * sizeof(float));
    back->kernels->add_rows(space->slopes, space->of_sum, graph->receiver, graph->edges, width);
    mlp_back(back, mlp, &back->pass->edge_rounds[m], graph->edges, space->slopes);
    part_back(back, mlp, 0, back->pass->edge[m], space->first, graph->edges, space->of_edge);
    memset(space->of_receiver, 0, bytes);
    memset(space->of_sender, 0, bytes);
    back->kernels->add_to_rows(space->of_receiver, space->first, graph->receiver, graph->edges, width);
    back->kernels->add_to_rows(space->of_sender, space->first, graph->sender, graph->edges, width);
    add_columns(back->gradient + mlp->biases[0], space->of_receiver, graph->nodes, width);
    part_back(back, mlp, 1, back->pass->node[m], space->of_receiver, graph->nodes, space->of_node);
    part_back(back, mlp, 2, back->pass->node[m], space->of_sender, graph->nodes, space->of_node);
}

static void encoder_back(const Back *back, const GnsMlp *mlp, const GnsLayerTape *tape, const float *in, int rows,
                         float *slopes) {
    mlp_back(back, mlp, tape, rows, slopes);
    back->kernels->add_gradient(back->gradient + mlp->weights[0], in, back->space->first, rows, mlp->inputs,
                                mlp->width);
    add_columns(back->gradient + mlp->biases[0], back->space->first, rows, mlp->width);
}

bool gns_backward(GnsBackward *space, const GnsPass *pass, const GnsLayout *layout, const float *parameters,
                  const float *transposed, const GnsGraph *graph, const float *output_slopes, float *gradient) {
    enum { ARRAYS = 8 };
    float **arrays[ARRAYS] = {&space->of_node,   &space->of_edge, &space->of_sum, &space->of_receiver,
                              &space->of_sender, &space->slopes,  &space->second, &space->first};
    const size_t most = (size_t)(graph->nodes > graph->edges ? graph->nodes : graph->edges) * (size_t)layout->width;
    if (!array_reserve((void **)&space->numbers, &space->capacity, ARRAYS * most, sizeof *space->numbers)) return false;
    for (int i = 0; i < ARRAYS; i++) *arrays[i] = space->numbers + (size_t)i * most;
    const Back back = {space, pass->kernels, pass, graph, parameters, transposed, gradient, layout->width};
    const size_t width = (size_t)layout->width * sizeof(float);
    memcpy(space->slopes, output_slopes, (size_t)graph->nodes * GNS_OUTPUTS * sizeof(float));
    encoder_back(&back, &layout->decoder, &pass->decoder, pass->node[layout->rounds], graph->nodes, space->slopes);
    memset(space->of_node, 0, (size_t)graph->nodes * width);
    memset(space->of_edge, 0, (size_t)graph->edges * width);
    pass->kernels->multiply(space->of_node, space->first, transposed + layout->decoder.weights[0], NULL, graph->nodes,
                            layout->width, layout->width);
    for (int m = layout->rounds - 1; m >= 0; m--) {
        nodes_back(&back, &layout->node_rounds[m], m);
        messages_back(&back, &layout->edge_rounds[m], m);
    }
    encoder_back(&back, &layout->nodes, &pass->nodes, graph->node_inputs, graph->nodes, space->of_node);
    encoder_back(&back, &layout->edges, &pass->edges, graph->edge_inputs, graph->edges, space->of_edge);
    return true;
}
