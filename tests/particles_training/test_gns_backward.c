/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The backward pass of gns is the slope of its forward pass. */
#include "../particles/particle_heap.h"

#include "particles_training/gns_backward.h"

#include <math.h>
#include <string.h>

typedef struct Trial {
    ParticleHeap heap;
    GnsNet net;
    GnsGraph graph;
    GnsPass pass;
    float slopes[HEAP_PARTICLES * GNS_OUTPUTS]; /* the loss is their product with the outputs */
    float *kept, *gradient;
} Trial;

static void begin(Trial *trial, int width, int rounds) {
    uint64_t random = 9;
    *trial = (Trial){.pass = {.tape = true}};
    make_heap(&trial->heap, heap_order);
    make_net(&trial->net, width, rounds);
    assert_true(gns_graph_build(&trial->graph, &trial->heap.particles, &trial->heap.ground, 1, &trial->net.scales));
    for (int i = 0; i < HEAP_PARTICLES * GNS_OUTPUTS; i++) trial->slopes[i] = random_between(&random, -1, 1);
    const size_t bytes = (size_t)trial->net.layout.parameters * sizeof(float);
    trial->kept = malloc(bytes);
    trial->gradient = calloc(1, bytes);
    assert_true(trial->kept != NULL && trial->gradient != NULL);
    memcpy(trial->kept, trial->net.parameters, bytes);
}

static void end(Trial *trial) {
    free(trial->kept);
    free(trial->gradient);
    gns_graph_free(&trial->graph);
    gns_pass_free(&trial->pass);
    gns_net_free(&trial->net);
}

static double loss(Trial *trial) {
    double sum = 0;
    assert_true(gns_forward(&trial->pass, &trial->net.layout, trial->net.parameters, &trial->graph));
    for (int i = 0; i < HEAP_PARTICLES * GNS_OUTPUTS; i++)
        sum += (double)trial->pass.outputs[i] * (double)trial->slopes[i];
    return sum;
}

static void find_gradient(Trial *trial) {
    GnsBackward back = {.capacity = 0};
    float *transposed = calloc((size_t)trial->net.layout.parameters, sizeof *transposed);
    assert_non_null(transposed);
    loss(trial);
    gns_transpose(&trial->net.layout, trial->net.parameters, transposed);
    assert_true(gns_backward(&back, &trial->pass, &trial->net.layout, trial->net.parameters, transposed, &trial->graph,
                             trial->slopes, trial->gradient));
    gns_backward_free(&back);
    free(transposed);
}

/* The loss a way along a direction within one array of parameters, all others kept. */
static double moved_loss(Trial *trial, int at, int count, const float *direction, double way) {
    for (int i = 0; i < count; i++)
        trial->net.parameters[at + i] = (float)((double)trial->kept[at + i] + way * (double)direction[i]);
    const double result = loss(trial);
    memcpy(trial->net.parameters, trial->kept, (size_t)trial->net.layout.parameters * sizeof(float));
    return result;
}

/* Short ways are lost in the rounding of float32, long ones in the kinks of ReLU: one of these must fit. */
static void check_array(Trial *trial, int at, int count, const char *what) {
    enum { LARGEST = 8192 };
    static float direction[LARGEST];
    uint64_t random = 31 + (uint64_t)at;
    double slope = 0, square = 0;
    assert_in_range(count, 1, LARGEST);
    for (int i = 0; i < count; i++) {
        /* Mostly along the gradient, so that the slope is not lost among rounding errors. */
        const float away = 0.3f * random_between(&random, -1, 1);
        const float sign = trial->gradient[at + i] < 0 ? -1.0f : 1.0f;
        direction[i] = sign * (0.7f + away);
        slope += (double)direction[i] * (double)trial->gradient[at + i];
        square += (double)direction[i] * (double)direction[i];
    }
    static const double ways[] = {3e-4, 1e-3, 3e-3, 1e-2, 3e-2};
    double best = INFINITY;
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        const double way = ways[i] / sqrt(square), ahead = moved_loss(trial, at, count, direction, way),
                     behind = moved_loss(trial, at, count, direction, -way);
        best = fmin(best, fabs((ahead - behind) / (2 * way) - slope));
    }
    if (!(best <= 0.01 * fabs(slope) + 1e-3))
        fail_msg("%s: the backward pass says %g; the slope differs by %g", what, slope, best);
}

static void check_mlp(Trial *trial, const GnsMlp *mlp, const char *what) {
    const int widths[4] = {mlp->inputs, mlp->width, mlp->width, mlp->outputs};
    for (int l = 0; l < 3; l++) {
        check_array(trial, mlp->weights[l], widths[l] * widths[l + 1], what);
        check_array(trial, mlp->biases[l], widths[l + 1], what);
    }
    if (mlp->gain < 0) return;
    check_array(trial, mlp->gain, mlp->outputs, what);
    check_array(trial, mlp->offset, mlp->outputs, what);
}

static void it_is_the_slope_of_the_forward_pass(void **state) {
    (void)state;
    static Trial trial;
    for (int width = 16; width <= 32; width += 16) {
        begin(&trial, width, width == 16 ? 2 : 1);
        find_gradient(&trial);
        const GnsLayout *layout = &trial.net.layout;
        check_mlp(&trial, &layout->nodes, "nodes");
        check_mlp(&trial, &layout->edges, "edges");
        for (int m = 0; m < layout->rounds; m++) {
            check_mlp(&trial, &layout->edge_rounds[m], "edges of a round");
            check_mlp(&trial, &layout->node_rounds[m], "nodes of a round");
        }
        check_mlp(&trial, &layout->decoder, "decoder");
        end(&trial);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(it_is_the_slope_of_the_forward_pass)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
