/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "particles/gns_forward.h"

#include "common/array.h"

#include <stdlib.h>
#include <string.h>

/* Rows that pass a perceptron together: 64 rows of 16 numbers in four arrays stay in the L1 cache. */
enum { TILE = 64 };

void gns_pass_free(GnsPass *pass) {
    free(pass->numbers);
    *pass = (GnsPass){.tape = pass->tape};
}

static float *take(float *numbers, size_t *used, size_t count) {
    float *at = numbers != NULL ? numbers + *used : NULL;
    *used += (count + 7) & ~(size_t)7;
    return at;
}

static GnsLayerTape take_layer(float *numbers, size_t *used, size_t rows, size_t width) {
    GnsLayerTape layer;
    layer.first = take(numbers, used, rows * width);
    layer.second = take(numbers, used, rows * width);
    layer.normalised = take(numbers, used, rows * width);
    layer.inverse = take(numbers, used, rows);
    return layer;
}

/* Places the arrays in `numbers`, or with NULL only counts them. */
static size_t place(GnsPass *pass, float *numbers, const GnsLayout *layout, const GnsGraph *graph) {
    const size_t nodes = (size_t)graph->nodes, edges = (size_t)graph->edges, width = (size_t)layout->width;
    const bool tape = pass->tape;
    size_t used = 0;
    for (int m = 0; m <= layout->rounds; m++) {
        const bool own = tape || m == 0;
        pass->node[m] = own ? take(numbers, &used, nodes * width) : pass->node[0];
        pass->edge[m] = own ? take(numbers, &used, edges * width) : pass->edge[0];
        if (m == layout->rounds) break;
        pass->sum[m] = own ? take(numbers, &used, nodes * width) : pass->sum[0];
        pass->edge_rounds[m] = own ? take_layer(numbers, &used, tape ? edges : TILE, width) : pass->edge_rounds[0];
        pass->node_rounds[m] = tape ? take_layer(numbers, &used, nodes, width) : pass->edge_rounds[0];
    }
    pass->nodes = tape ? take_layer(numbers, &used, nodes, width) : pass->edge_rounds[0];
    pass->edges = tape ? take_layer(numbers, &used, edges, width) : pass->edge_rounds[0];
    pass->decoder = tape ? take_layer(numbers, &used, nodes, width) : pass->edge_rounds[0];
    pass->outputs = take(numbers, &used, nodes * GNS_OUTPUTS);
    pass->from_receiver = take(numbers, &used, nodes * width);
    pass->from_sender = take(numbers, &used, nodes * width);
    pass->change = take(numbers, &used, TILE * width);
    return used;
}

/* The rows from `row` on, of a perceptron with a tape; without one, the tile. */
static GnsLayerTape rows_of(const GnsPass *pass, const GnsLayerTape *layer, int row, int width) {
    if (!pass->tape) return *layer;
    const ptrdiff_t at = (ptrdiff_t)row * width;
    return (GnsLayerTape){layer->first + at, layer->second + at, layer->normalised + at, layer->inverse + row};
}

/* The rest of a perceptron, from the sums of its first layer on. */
static void finish(const GnsKernels *kernels, const GnsMlp *mlp, const float *parameters, const GnsLayerTape *tape,
                   int rows, float *out) {
    const int width = mlp->width;
    float *last = mlp->gain >= 0 ? tape->normalised : out;
    kernels->relu(tape->first, rows * width);
    kernels->multiply(tape->second, tape->first, parameters + mlp->weights[1], parameters + mlp->biases[1], rows, width,
                      width);
    kernels->relu(tape->second, rows * width);
    kernels->multiply(last, tape->second, parameters + mlp->weights[2], parameters + mlp->biases[2], rows, width,
                      mlp->outputs);
    if (mlp->gain >= 0)
        kernels->normalise(last, tape->inverse, out, parameters + mlp->gain, parameters + mlp->offset, rows, width);
}

static int tile_rows(int first, int rows) { return rows - first < TILE ? rows - first : TILE; }

/* out[rows, mlp->outputs] of in[rows, mlp->inputs] */
static void apply(const GnsPass *pass, const GnsMlp *mlp, const float *parameters, const GnsLayerTape *tape,
                  const float *in, int rows, float *out) {
    for (int first = 0; first < rows; first += TILE) {
        const int count = tile_rows(first, rows);
        const GnsLayerTape at = rows_of(pass, tape, first, mlp->width);
        pass->kernels->multiply(at.first, in + (ptrdiff_t)first * mlp->inputs, parameters + mlp->weights[0],
                                parameters + mlp->biases[0], count, mlp->inputs, mlp->width);
        finish(pass->kernels, mlp, parameters, &at, count, out + (ptrdiff_t)first * mlp->outputs);
    }
}

static void add(float *out, const float *a, const float *b, int count) {
    for (int i = 0; i < count; i++) out[i] = a[i] + b[i];
}

/* The first layer's sums over a node's numbers are the same for all its edges, and made once. */
static void pass_messages(const GnsPass *pass, const GnsMlp *mlp, const float *parameters, const GnsGraph *graph,
                          int m) {
    const GnsKernels *kernels = pass->kernels;
    const int width = mlp->width, square = width * width;
    const float *weights = parameters + mlp->weights[0];
    memset(pass->sum[m], 0, (size_t)graph->nodes * (size_t)width * sizeof(float));
    memset(pass->from_sender, 0, (size_t)graph->nodes * (size_t)width * sizeof(float));
    kernels->multiply(pass->from_receiver, pass->node[m], weights + square, parameters + mlp->biases[0], graph->nodes,
                      width, width);
    kernels->multiply(pass->from_sender, pass->node[m], weights + 2 * (ptrdiff_t)square, NULL, graph->nodes, width,
                      width);
    for (int first = 0; first < graph->edges; first += TILE) {
        const int count = tile_rows(first, graph->edges);
        const ptrdiff_t at = (ptrdiff_t)first * width;
        const GnsLayerTape tape = rows_of(pass, &pass->edge_rounds[m], first, width);
        memset(tape.first, 0, (size_t)count * (size_t)width * sizeof(float));
        kernels->add_rows(tape.first, pass->from_receiver, graph->receiver + first, count, width);
        kernels->add_rows(tape.first, pass->from_sender, graph->sender + first, count, width);
        kernels->multiply(tape.first, pass->edge[m] + at, weights, NULL, count, width, width);
        finish(kernels, mlp, parameters, &tape, count, pass->change);
        kernels->add_to_rows(pass->sum[m], pass->change, graph->receiver + first, count, width);
        add(pass->edge[m + 1] + at, pass->edge[m] + at, pass->change, count * width);
    }
}

static void update_nodes(const GnsPass *pass, const GnsMlp *mlp, const float *parameters, int nodes, int m) {
    const GnsKernels *kernels = pass->kernels;
    const int width = mlp->width;
    for (int first = 0; first < nodes; first += TILE) {
        const int count = tile_rows(first, nodes);
        const ptrdiff_t at = (ptrdiff_t)first * width;
        const GnsLayerTape tape = rows_of(pass, &pass->node_rounds[m], first, width);
        kernels->multiply(tape.first, pass->node[m] + at, parameters + mlp->weights[0], parameters + mlp->biases[0],
                          count, width, width);
        kernels->multiply(tape.first, pass->sum[m] + at, parameters + mlp->weights[0] + (ptrdiff_t)width * width, NULL,
                          count, width, width);
        finish(kernels, mlp, parameters, &tape, count, pass->change);
        add(pass->node[m + 1] + at, pass->node[m] + at, pass->change, count * width);
    }
}

bool gns_forward(GnsPass *pass, const GnsLayout *layout, const float *parameters, const GnsGraph *graph) {
    const size_t needed = place(pass, NULL, layout, graph);
    if (!array_reserve((void **)&pass->numbers, &pass->capacity, needed, sizeof *pass->numbers)) return false;
    place(pass, pass->numbers, layout, graph);
    if (pass->kernels == NULL) pass->kernels = gns_kernels_best();
    apply(pass, &layout->nodes, parameters, &pass->nodes, graph->node_inputs, graph->nodes, pass->node[0]);
    apply(pass, &layout->edges, parameters, &pass->edges, graph->edge_inputs, graph->edges, pass->edge[0]);
    for (int m = 0; m < layout->rounds; m++) {
        pass_messages(pass, &layout->edge_rounds[m], parameters, graph, m);
        update_nodes(pass, &layout->node_rounds[m], parameters, graph->nodes, m);
    }
    apply(pass, &layout->decoder, parameters, &pass->decoder, pass->node[layout->rounds], graph->nodes, pass->outputs);
    return true;
}
